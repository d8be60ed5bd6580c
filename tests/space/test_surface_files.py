"""Surfaces from files: every format, what is repaired, what is refused, and the configuration's digest."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from written_surfaces import config, ellipsoid, off, stl

from gyrify.config import Config
from gyrify.config.inputs.closed_surface import closed_surface
from gyrify.config.inputs.surface_readers import read_triangles
from gyrify.errors import ConfigError, MeshError

POINTS, TRIANGLES = ellipsoid(2, (30.0, 20.0, 10.0))


def ply(path: Path) -> Path:
    lines = ["ply", "format ascii 1.0", f"element vertex {len(POINTS)}"]
    lines += [f"property double {axis}" for axis in "xyz"]
    lines += [f"element face {len(TRIANGLES)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(repr(float(x)) for x in point) for point in POINTS]
    lines += ["3 " + " ".join(map(str, triangle)) for triangle in TRIANGLES]
    path.write_text("\n".join(lines) + "\n")
    return path


def obj(path: Path) -> Path:
    lines = [*("v " + " ".join(repr(float(x)) for x in point) for point in POINTS)]
    lines += ["f " + " ".join(str(i + 1) for i in triangle) for triangle in TRIANGLES]
    path.write_text("\n".join(lines) + "\n")
    return path


def gifti(path: Path) -> Path:
    import nibabel as nib

    arrays = [
        nib.gifti.GiftiDataArray(POINTS.astype(np.float32), intent="NIFTI_INTENT_POINTSET"),
        nib.gifti.GiftiDataArray(TRIANGLES.astype(np.int32), intent="NIFTI_INTENT_TRIANGLE"),
    ]
    nib.save(nib.gifti.GiftiImage(darrays=arrays), path)
    return path


def freesurfer(path: Path) -> Path:
    import nibabel as nib

    nib.freesurfer.write_geometry(str(path), POINTS, TRIANGLES.astype(np.int32))
    return path


FORMATS = {
    "a.off": lambda path: off(path, POINTS, TRIANGLES),
    "a.stl": lambda path: stl(path, POINTS, TRIANGLES),
    "a.ply": ply,
    "a.obj": obj,
    "a.gii": gifti,
    "lh.pial": freesurfer,
}


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_gives_the_same_body(name: str, tmp_path: Path) -> None:
    given = config(FORMATS[name](tmp_path / name), **{"geometry.cortical_thickness": 1.0})
    surface = given.geometry.surface
    assert surface.points.shape == POINTS.shape
    assert surface.notes == ()
    corners = POINTS[TRIANGLES]
    volume = np.linalg.det(corners).sum() / 6.0
    assert surface.volume == pytest.approx(volume, rel=1e-5)
    assert given.geometry.mean_radius == pytest.approx(np.cbrt(volume * 0.75 / np.pi), rel=1e-5)
    assert surface.extents == pytest.approx(np.ptp(POINTS, axis=0), rel=1e-5)


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("share", [0.0, 0.02, 0.5, 0.97])
def test_a_file_cut_short_is_refused(name: str, share: float, tmp_path: Path) -> None:
    """Text formats may be cut between lines: then the surface is open."""
    path = FORMATS[name](tmp_path / name)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    with pytest.raises((ConfigError, MeshError), match=r"empty|cut short|closed|no triangle|unknown format"):
        config(path)


def test_random_bytes_are_refused(rng: np.random.Generator, tmp_path: Path) -> None:
    for name in FORMATS:
        for _ in range(5):
            path = tmp_path / name
            path.write_bytes(rng.bytes(400))
            with pytest.raises((ConfigError, MeshError)):
                config(path)


def test_no_format_is_guessed(tmp_path: Path) -> None:
    path = off(tmp_path / "a.txt", POINTS, TRIANGLES)
    with pytest.raises(ConfigError, match=r"STL, PLY, OFF, OBJ, GIfTI"):
        config(path)


def checked(points: Any, triangles: Any) -> Any:
    return closed_surface(np.asarray(points, float), np.asarray(triangles), "It")


def test_a_sound_surface_is_kept_as_it_is() -> None:
    surface = checked(POINTS, TRIANGLES)
    assert np.array_equal(surface.points, POINTS)
    assert np.array_equal(surface.triangles, TRIANGLES)
    assert surface.notes == ()
    assert surface.n_parts == 1


def test_repairs() -> None:
    whole = checked(POINTS, TRIANGLES).volume
    inside_out = checked(POINTS, TRIANGLES[:, ::-1])
    assert inside_out.volume == pytest.approx(whole)
    assert "turned in" in inside_out.notes[0]
    some = TRIANGLES.copy()
    some[3:7] = some[3:7, ::-1]
    turned = checked(POINTS, some)
    assert turned.volume == pytest.approx(whole)
    assert turned.notes[0].startswith("4 triangles were turned")
    doubled = np.concatenate([POINTS, POINTS[:1]])
    again = np.concatenate([TRIANGLES, TRIANGLES[:1], [[0, len(POINTS), 1]]])
    again[5] = np.where(again[5] == 0, len(POINTS), again[5])
    notes = checked(doubled, again).notes
    assert any("1 points that lay on others" in note for note in notes)
    assert any("1 triangles without area" in note for note in notes)
    assert any("1 repeated triangles" in note for note in notes)


def test_a_wall_between_two_halves_is_left_out() -> None:
    """Two tetrahedra that share a face, as two hemispheres of a segmentation do, become one body."""
    points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 3], [1, 1, -3]]
    upper = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    lower = [[0, 1, 2], [1, 0, 4], [2, 1, 4], [0, 2, 4]]
    surface = checked(points, upper + lower)
    assert surface.triangles.shape == (6, 3)
    assert surface.n_parts == 1
    assert surface.volume == pytest.approx(2 * 16 * 3 / 6)
    assert "1 pairs of triangles back to back" in surface.notes[0]


def _moved(scale: float, shift: float) -> Any:
    return scale * POINTS + np.array([shift, 0.0, 0.0])


REFUSED = {
    "open": (lambda: (POINTS, TRIANGLES[1:]), r"not closed: 3 edges .* first at \("),
    "three at an edge": (
        lambda: (
            np.concatenate([POINTS, [[0.0, 0.0, 0.0]]]),
            np.concatenate([TRIANGLES, [[*TRIANGLES[0, :2], len(POINTS)]]]),
        ),
        "not closed|more than two triangles",
    ),
    "four at an edge": (
        lambda: (
            [[0, 0, 0], [0, 0, 9], [5, 0, 3], [3, 5, 4], [-5, 0, 3], [-3, -5, 4]],
            [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2], [0, 1, 4], [0, 5, 1], [0, 4, 5], [1, 5, 4]],
        ),
        r"1 edges have more than two triangles, first at \(0, 0, 4.5\)",
    ),
    "pinched": (
        lambda: (
            [[0, 0, 0], [5, 0, 9], [-4, 4, 9], [-4, -4, 9], [5, 0, -9], [-4, 4, -9], [-4, -4, -9]],
            [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3], [0, 4, 5], [0, 5, 6], [0, 6, 4], [4, 6, 5]],
        ),
        r"touches itself at 1 points, first at \(0, 0, 0\)",
    ),
    "not a number": (
        lambda: (np.where(np.arange(POINTS.size).reshape(POINTS.shape) == 7, np.nan, POINTS), TRIANGLES),
        "not finite numbers, first at its point 2",
    ),
    "nested": (
        lambda: (
            np.concatenate([POINTS, _moved(0.5, 0.0)]),
            np.concatenate([TRIANGLES, TRIANGLES + len(POINTS)]),
        ),
        "one surface inside another",
    ),
    "speck": (
        lambda: (
            np.concatenate([POINTS, _moved(0.05, 50.0)]),
            np.concatenate([TRIANGLES, TRIANGLES + len(POINTS)]),
        ),
        "1 small parts",
    ),
    "sliver": (
        lambda: (
            [[0, 0, 0], [10, 0, 0], [5, 0.01, 0], [5, 4, 6]],
            [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        ),
        "angle of 0.1",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_meshed_is_refused_with_a_place(name: str) -> None:
    make, words = REFUSED[name]
    with pytest.raises(MeshError, match=words):
        checked(*make())


def test_a_surface_with_one_side_is_refused() -> None:
    """The projective plane with six points: every edge has two triangles, and there is no inside."""
    faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 1]]
    faces += [[1, 2, 4], [2, 3, 5], [3, 4, 1], [4, 5, 2], [5, 1, 3]]
    rng = np.random.default_rng(3)
    with pytest.raises(MeshError, match="one side"):
        checked(rng.standard_normal((6, 3)), faces)


def test_wrong_units_are_told(tmp_path: Path) -> None:
    path = off(tmp_path / "a.off", 1e-3 * POINTS, TRIANGLES)
    with pytest.raises(ConfigError, match=r'Try geometry.unit = "m": it is then 57.1 mm long'):
        config(path)
    thin = {"geometry.cortical_thickness": 1.0}
    same = config(path, **thin, **{"geometry.unit": "m"}).geometry
    plain = config(off(tmp_path / "b.off", POINTS, TRIANGLES), **thin).geometry
    assert same.mean_radius == pytest.approx(plain.mean_radius)


def test_what_has_no_file_takes_none(tmp_path: Path) -> None:
    path = off(tmp_path / "a.off", POINTS, TRIANGLES)
    for key, value in (("file", str(path)), ("hole_file", str(path)), ("unit", "cm"), ("digest", 64 * "0")):
        with pytest.raises(ConfigError, match=rf"geometry\.{key} = .* is not allowed with geometry.shape"):
            Config().replace(**{f"geometry.{key}": value})


def test_what_is_not_built_for_surfaces_says_so(tmp_path: Path) -> None:
    path = off(tmp_path / "a.off", POINTS, TRIANGLES)
    thin = {"geometry.cortical_thickness": 1.0}
    with pytest.raises(ConfigError, match=r"edge_length = 3 is not allowed .* those of the file"):
        config(path, **thin, **{"mesh.edge_length": 3.0})
    with pytest.raises(ConfigError, match=r'Try mesh.element = "mean_dilatation"'):
        config(path, **thin, **{"mesh.element": "quadratic"})


def test_paths_are_relative_to_the_configuration_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    off(folder / "a.off", POINTS, TRIANGLES)
    text = '[geometry]\nshape = "surface"\nfile = "a.off"\ncortical_thickness = 1.0\n'
    (folder / "config.toml").write_text(text)
    found = Config.load(folder / "config.toml")
    assert found.geometry.file == str(folder / "a.off")
    monkeypatch.chdir(folder)
    here = Config.from_toml(text)
    monkeypatch.chdir(tmp_path)
    assert here == found
    assert Config.from_toml(text, folder) == found
    assert Config.from_toml(found.to_toml()) == found
    assert pickle.loads(pickle.dumps(found)) == found
    with pytest.raises(ConfigError, match="there is no such file"):
        Config.from_toml(text)


def test_the_hash_is_that_of_what_files_hold(tmp_path: Path) -> None:
    thin = {"geometry.cortical_thickness": 1.0}
    small = 0.3 * POINTS
    one = config(off(tmp_path / "a.off", small, TRIANGLES), **thin)
    copy = config(off(tmp_path / "b.off", small, TRIANGLES), **thin)
    other = config(off(tmp_path / "c.off", 1.01 * small, TRIANGLES), **thin)
    assert one.config_hash == copy.config_hash
    assert one.config_hash != other.config_hash
    assert one.config_hash != one.replace(**{"geometry.unit": "cm"}).config_hash
    assert one.replace(**{"geometry.file": other.geometry.file}) == other
    stated = one.replace(**{"geometry.digest": one.geometry.digest})
    assert stated.config_hash == one.config_hash
    off(tmp_path / "a.off", 1.02 * small, TRIANGLES)
    with pytest.raises(ConfigError, match="have changed"):
        stated.replace(seed=1)
    assert one.replace(seed=0).config_hash not in (one.config_hash, other.config_hash)


def test_text_stl_is_read() -> None:
    lines = ["solid a"]
    for triangle in TRIANGLES:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex " + " ".join(repr(float(x)) for x in POINTS[i]) for i in triangle]
        lines += ["endloop", "endfacet"]
    data = "\n".join([*lines, "endsolid a"]).encode()
    points, triangles = read_triangles(data, "a.stl")
    assert checked(points, triangles).triangles.shape == TRIANGLES.shape
