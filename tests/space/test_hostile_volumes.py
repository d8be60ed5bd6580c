"""Volumes from files that cannot be used: every refusal names what and where."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
from test_volumes import CELLS, FORMATS, MIDDLE, POINTS, _meshio
from written_volumes import config, plain

from gyrify.config.inputs.volume_readers import read_tetrahedra
from gyrify.errors import ConfigError, MeshError
from gyrify.metrics.tetrahedra import signed_volumes
from gyrify.model.meshing import build_mesh
from gyrify.run.validity import config_warnings

FAULTS: list[tuple[str, dict[str, Any], type[Exception], str]] = [
    (
        "labels",
        {"geometry.labels": {"grey": [1], "white": [4]}},
        ConfigError,
        "label 3, which .* nowhere",
    ),
    ("labels", {"geometry.labels": {"grey": [1, 3]}}, ConfigError, "no tetrahedron of .* white matter"),
    ("labels", {"geometry.labels": {"white": [1, 3]}}, ConfigError, "no tetrahedron of .* grey matter"),
    ("labels", {"geometry.labels": {"grey": [1], "white": [1, 3]}}, ConfigError, "names the label 1 twice"),
    ("labels", {"geometry.labels": {"grey": [1], "hole": [1], "white": [3]}}, ConfigError, "label 1 twice"),
    ("bare", {"geometry.labels": {"grey": [1], "white": [3]}}, ConfigError, "have no labels"),
    ("plain", {"geometry.hole_file": "plain"}, ConfigError, "hole_file is not allowed"),
    ("plain", {"geometry.interface_file": "plain"}, ConfigError, "interface_file is not allowed"),
    ("plain", {"mesh.refine_cortex": 1}, ConfigError, "refine_cortex = 1 is not allowed"),
    ("plain", {"mesh.refine": 4}, ConfigError, "about .* cells are not allowed"),
    ("plain", {"mesh.element": "quadratic"}, ConfigError, "quadratic"),
    ("plain", {"geometry.unit": "m"}, ConfigError, "geometry.unit"),
]


@pytest.mark.parametrize(("name", "overrides", "kind", "words"), FAULTS)
def test_what_does_not_fit_is_refused(
    name: str, overrides: dict[str, Any], kind: type[Exception], words: str, tmp_path: Path
) -> None:
    paths = {
        "plain": plain(tmp_path / "a.mesh", POINTS, CELLS),
        "labels": plain(tmp_path / "b.mesh", POINTS, CELLS, np.where(MIDDLE > 12.0, 1, 3)),
        "bare": _meshio(tmp_path / "c.vtu"),
    }
    given = {key: str(paths["plain"]) if value == "plain" else value for key, value in overrides.items()}
    with pytest.raises(kind, match=words):
        build_mesh(config(paths[name], **given))


BROKEN: dict[str, tuple[Any, str]] = {
    "flat": (
        lambda p, c: (np.where(np.arange(len(p))[:, None] == c[0, 0], p[c[0, 1]], p), c),
        "without volume",
    ),
    "repeated": (lambda p, c: (p, np.concatenate([c, c[:1]])), "more than two tetrahedra"),
    "infinite": (lambda p, c: (np.where(np.arange(len(p))[:, None] == 5, np.inf, p), c), "not finite"),
    "pinched": (
        lambda p, c: (
            np.concatenate([p, 2.0 * p[[0]] - p]),
            np.concatenate([c, np.where(c == 0, 0, c + len(p))]),
        ),
        "touches itself at 1 points",
    ),
    "crossing": (
        lambda p, c: (np.where(p[:, :1] > 14.0, p * np.array([-1.3, 1.0, 1.0]), p), c),
        "crosses itself",
    ),
}


def test_a_body_without_white_matter_is_refused(tmp_path: Path) -> None:
    path = plain(tmp_path / "a.mesh", POINTS[CELLS[0]] * 3.0, np.arange(4)[None])
    with pytest.raises(MeshError, match=r"No tetrahedron of the volume is white matter: .* edges are"):
        build_mesh(config(path, **{"geometry.cortical_thickness": 0.2}))


@pytest.mark.parametrize("fault", BROKEN)
def test_broken_bodies_are_refused_with_a_place(fault: str, tmp_path: Path) -> None:
    change, words = BROKEN[fault]
    path = plain(tmp_path / "a.mesh", *change(POINTS, CELLS))
    with pytest.raises(MeshError, match=words):
        build_mesh(config(path, **{"dissipation.number": 0.2}))


@pytest.mark.parametrize("name", ["a.mesh", "b.mesh", "a.vtu", "a.msh"])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.99])
def test_a_file_that_is_cut_short_is_refused(name: str, share: float, tmp_path: Path) -> None:
    data = FORMATS[name](tmp_path / name).read_bytes()
    with pytest.raises(ConfigError, match=r"damaged|holds no tetrahedra"):
        read_tetrahedra(data[: int(share * len(data))], name)


def test_other_cells_and_formats_are_refused(tmp_path: Path) -> None:
    meshio.Mesh(POINTS, [("hexahedron", CELLS[:4].reshape(2, 8))]).write(tmp_path / "a.vtu")
    with pytest.raises(ConfigError, match="cells of the type hexahedron"):
        read_tetrahedra((tmp_path / "a.vtu").read_bytes(), "a.vtu")
    with pytest.raises(ConfigError, match="unknown format"):
        read_tetrahedra(b"", "a.step")
    data = plain(tmp_path / "a.mesh", POINTS, CELLS).read_bytes()
    with pytest.raises(ConfigError, match="3 numbers follow its end"):
        read_tetrahedra(data + b"0\n1 2 3\n", "a.mesh")


@pytest.mark.parametrize(
    "rest", ["1e300 1 2 3 4", "1 99999999999999999999 2 3 4", "nan 1 2 3 4", "-inf 1 2 3 4"]
)
def test_numbers_out_of_all_bounds_are_refused(rest: str, recwarn: pytest.WarningsRecorder) -> None:
    text = f"4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1\n{rest}\n"
    with pytest.raises(ConfigError, match="damaged"):
        read_tetrahedra(text.encode(), "a.mesh")
    assert not recwarn.list


def test_a_reader_does_not_speak_to_the_terminal(capfd: pytest.CaptureFixture[str]) -> None:
    """The one document of --json stands alone."""
    for data in (b"", b"MeshVersionFormatted 2\nDimension 2\nVertices\n1\n0 0 0\nEnd\n", b"nothing"):
        with pytest.raises(ConfigError):
            read_tetrahedra(data, "a.mesh")
    assert capfd.readouterr() == ("", "")


def test_points_that_coincide_are_joined_and_turned_cells_accepted(tmp_path: Path) -> None:
    apart = POINTS[CELLS].reshape(-1, 3)
    cells = np.arange(len(apart)).reshape(-1, 4)
    cells[::3] = cells[::3][:, [1, 0, 2, 3]]
    mesh = build_mesh(config(plain(tmp_path / "a.mesh", apart, cells)))
    assert mesh.n_points == len(POINTS)
    assert signed_volumes(mesh.cell_points).min() > 0.0
    (told,) = [text for text in config_warnings(config(tmp_path / "a.mesh")) if "joined" in text]
    assert told.startswith("The volume of geometry.file: ")
