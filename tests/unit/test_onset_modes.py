"""What modes move: folds, the surface, and motions of the whole slice, from displacements made up."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.mesh import Mesh
from gyrify.model.meshing import build_mesh
from gyrify.run.onset.mode_kinds import mean_thickness, wave_of
from gyrify.run.onset.relax import are_folds_kept

CIRCLE = {"geometry.shape": "circle", "mesh.n_around": 216, "mesh.node_jitter": 0.0}


def ring(**values: object) -> Mesh:
    return build_mesh(Config.preset("reference-slice").with_overrides({**CIRCLE, **values}))


def polar(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angle, outward and anticlockwise unit vectors of every point."""
    angle = np.arctan2(mesh.points[:, 1], mesh.points[:, 0])
    out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return angle, out, np.stack([-out[:, 1], out[:, 0]], axis=1)


def test_a_rotation_about_the_hole_is_a_twist() -> None:
    """With the noise of a fold in it that an argmax over waves would have taken for the mode."""
    mesh = ring()
    angle, out, around = polar(mesh)
    found = wave_of(mesh, 0.0 * mesh.points, around + 0.2 * np.cos(87 * angle)[:, None] * out)
    assert (found.kind, found.mode_number, found.wavelength) == ("twist", 0, 0.0)


def test_a_shift_is_a_translation() -> None:
    mesh = ring()
    found = wave_of(mesh, 0.1 * mesh.points, np.broadcast_to([0.6, -0.8], mesh.points.shape))
    assert (found.kind, found.mode_number) == ("translation", 1)


def test_a_uniform_wave_is_a_swelling() -> None:
    mesh = ring()
    angle, out, _ = polar(mesh)
    found = wave_of(mesh, 0.0 * mesh.points, (1.0 + 0.8 * np.cos(5 * angle))[:, None] * out)
    assert (found.kind, found.mode_number) == ("swelling", 0)


@pytest.mark.parametrize(
    ("number", "kind"), [(2, "fold"), (19, "fold"), (52, "fold"), (70, "surface"), (80, "surface")]
)
def test_waves_are_folds_until_they_are_too_short(number: int, kind: str) -> None:
    """Two cortical thicknesses are 3 mm, 75 waves on 226 mm; four points are 54 waves on 216 points."""
    mesh = ring()
    angle, out, around = polar(mesh)
    mode = np.cos(number * angle)[:, None] * out + 0.5 * np.sin(number * angle)[:, None] * around
    found = wave_of(mesh, 0.0 * mesh.points, mode)
    assert (found.kind, found.mode_number) == (kind, number)
    fine = wave_of(ring(**{"mesh.n_around": 1080}), *_waves(ring(**{"mesh.n_around": 1080}), number))
    assert fine.kind == ("surface" if number == 80 else "fold")


def _waves(mesh: Mesh, number: int) -> tuple[np.ndarray, np.ndarray]:
    angle, out, _ = polar(mesh)
    return 0.0 * mesh.points, np.cos(number * angle)[:, None] * out


def test_thickness_of_a_ring_and_of_a_strip() -> None:
    mesh = ring(**{"mesh.n_around": 864})
    exact = (36.0**2 - 34.5**2) / (2 * 36.0) * (4069.0 / np.pi) ** 0.5 / 36.0
    assert mean_thickness(mesh, 0.0 * mesh.points) == pytest.approx(exact, rel=2e-3)
    strip = build_mesh(Config(geometry={"shape": "strip"}, mesh={"node_jitter": 0.0}))
    assert mean_thickness(strip, 0.0 * strip.points) == pytest.approx(1.5)
    assert mean_thickness(strip, strip.points * [0.0, 0.5]) == pytest.approx(2.25)


def test_a_shift_of_a_strip() -> None:
    strip = build_mesh(Config(geometry={"shape": "strip"}, mesh={"node_jitter": 0.0}))
    along = np.broadcast_to([1.0, 0.0], strip.points.shape)
    assert wave_of(strip, 0.0 * strip.points, along).kind == "translation"


@pytest.mark.parametrize(
    ("held", "free", "is_kept"),
    [
        ((19, 1.411), (19, 1.399), True),
        ((19, 1.411), (18, 1.411), False),
        ((0, 1.0), (0, 1.021), False),
        ((19, 1.411), (19, 1.432), False),
        ((19, 1.411), (19, 1.390), False),
    ],
)
def test_folds_are_kept_with_as_many_gyri_and_the_index_near(
    held: tuple[int, float], free: tuple[int, float], is_kept: bool
) -> None:
    assert are_folds_kept(held, free) is is_kept
