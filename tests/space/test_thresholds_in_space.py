"""Thresholds of bodies in space: against exact theory, for every parameter, and where smooth states end."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from solids import BALL, PATCH, config
from written_surfaces import config as surface
from written_surfaces import ellipsoid, off

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.model.meshing import build_mesh
from gyrify.run.validity.exact_bodies import round_body
from gyrify.run.validity.expected import expected_onset
from gyrify.theory import crossings
from gyrify.threshold import Threshold, critical_growth
from gyrify.threshold.theory_value import expected_crossings

# One wave along x; across the patch the next one is much shorter.
FILM = {
    **PATCH,
    "geometry.length": 15.0,
    "geometry.width": 4.0,
    "geometry.depth": 20.0,
    "geometry.cortical_thickness": 2.0,
    "mesh.element": "mean_dilatation",
    "growth.law": "area",
    "growth.ratio": 1e4,
    "material.stiffness_ratio": 3.0,
}
# A thick cortex: the modes of degree 2 and 3 come first.
SPHERE = {
    **BALL,
    "geometry.semi_axes": (12.0, 12.0, 12.0),
    "geometry.cortical_thickness": 4.0,
    "mesh.element": "mean_dilatation",
    "mesh.edge_length": 5.0,
    "mesh.n_layers": 4,
    "growth.law": "area",
    "growth.ratio": 1e4,
    "material.stiffness_ratio": 3.0,
}


def in_time(body: Config, low: float, high: float, **options: Any) -> Threshold:
    return critical_growth(body, "growth.time", range=(low, high), points=3, tolerance=1e-4, **options)


@pytest.fixture(scope="module")
def coarse() -> Threshold:
    return in_time(config(FILM), 80.0, 130.0)


def test_a_patch_tends_to_the_film_on_a_half_space(coarse: Threshold) -> None:
    exact = expected_onset(config(FILM))
    assert exact.theory == "film on a half-space"
    assert exact.growth_time == pytest.approx(85.9, abs=0.1)
    fine = in_time(config(FILM, **{"mesh.refine": 1}), 80.0, 110.0)
    errors = [found.critical_value / exact.growth_time - 1.0 for found in (coarse, fine)]  # type: ignore[operator]
    assert 0.0 < errors[1] < 0.15
    # halving the edges divides the error by four
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.5)
    for found in (coarse, fine):
        assert (found.counted, found.mode_number) == ("waves", 1)
        assert found.wavelength_mm == pytest.approx(15.0, rel=0.04)
        assert [crossing.becomes for crossing in found.crossings] == ["unstable"]
        assert [crossing.kind for crossing in found.crossings] == ["fold"]
    assert "1 waves of 15" in repr(fine)
    # the coarse mesh says so itself
    assert any("34% apart" in said for said in coarse.warnings)


def test_linear_tetrahedra_are_later(coarse: Threshold) -> None:
    linear = in_time(config(FILM, **{"mesh.element": "linear"}), 100.0, 200.0)
    assert linear.critical_value > 1.1 * coarse.critical_value  # type: ignore[operator]


@pytest.mark.parametrize(
    ("parameter", "ends"),
    [("geometry.cortical_thickness", (1.8, 2.3)), ("material.stiffness_ratio", (2.5, 3.5))],
)
def test_every_parameter_leads_to_the_same_point(
    coarse: Threshold, parameter: str, ends: tuple[float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Grown to the critical time, the body is critical at its own thickness and stiffness."""
    monkeypatch.setattr("gyrify.threshold.critical.expected_crossings", lambda *_: None)  # takes long
    body = config(FILM, **{"growth.duration": coarse.critical_value})
    found = critical_growth(body, parameter, range=ends, points=3, tolerance=1e-4)
    section, key = parameter.split(".")
    assert found.critical_value == pytest.approx(getattr(getattr(body, section), key), rel=1e-3)
    assert found.crossings[0].becomes == "unstable"


def test_over_the_thickness_cells_stay_and_layers_move() -> None:
    mesh = {"mesh.edge_length": 2.5, "mesh.n_layers": 6}
    thick, thin = (config(SPHERE, **mesh, **{"geometry.cortical_thickness": T}) for T in (5.0, 1.0))
    own, base, moved = build_mesh(thin), build_mesh(thick), build_mesh(thin, like=thick)
    assert own.n_points != base.n_points
    assert np.array_equal(moved.contour, base.contour)
    assert {*map(tuple, np.sort(moved.cells, axis=1))} == {*map(tuple, np.sort(base.cells, axis=1))}
    assert np.linalg.norm(moved.points[moved.interface], axis=1) == pytest.approx(11.0)
    assert np.array_equal(build_mesh(thick, like=thick).points, base.points)


@pytest.mark.parametrize(
    ("parameter", "name", "values"),
    [
        ("growth.time", "growth_time", (120.0, 160.0, 200.0)),
        ("material.stiffness_ratio", "stiffness_ratio", (0.5, 2.0, 4.0)),
        ("geometry.cortical_thickness", "cortical_thickness", (2.0, 4.0, 6.0)),
    ],
)
def test_exact_theory_is_that_of_the_sphere(parameter: str, name: Any, values: tuple[float, ...]) -> None:
    body = config(SPHERE, **{"growth.duration": 190.0})
    exact = crossings(round_body(body), name, values)
    found = expected_crossings(body, parameter, values)
    assert found == pytest.approx([crossing.value for crossing in exact], abs=1e-3 * (values[-1] - values[0]))
    assert len(exact) == 1


@pytest.mark.slow
def test_the_smooth_state_of_a_sphere_ends_at_a_limit_point_that_refinement_moves() -> None:
    found = in_time(config(SPHERE), 180.0, 190.0)
    (crossing,) = found.crossings
    assert (crossing.becomes, crossing.mode_number, found.counted) == ("unstable", 2, "degree")
    assert crossing.bracket[0] < crossing.value < crossing.bracket[1]
    assert crossing.value == pytest.approx(184.8, abs=0.2)
    assert any("limit point" in note for note in found.notes)
    assert "degree 2, waves of" in repr(found)
    # exact: degree 3 at 164, degree 2 at 175
    fine = in_time(config(SPHERE, **{"mesh.refine": 1}), 174.0, 180.0)
    assert 164.0 < fine.critical_value < crossing.value  # type: ignore[operator]


def test_folds_are_seen_by_the_index_of_areas() -> None:
    jittered = {"mesh.node_jitter": 0.01, "dissipation.number": 0.01, "solver.increments": 8}
    body = config(FILM, **jittered)
    found = critical_growth(body, "growth.time", "visible", (0.0, 240.0), level=1.02)
    assert found.counted == "gyri"
    assert found.critical_value is not None
    # after the loss of stability at 115, since drag delays it
    assert 110.0 < found.critical_value < 240.0
    assert found.scan[0].gi == 1.0
    assert found.scan[-1].gi > 1.02  # type: ignore[operator]


def test_thicknesses_of_a_surface_are_no_branch(tmp_path: Path) -> None:
    given = surface(off(tmp_path / "a.off", *ellipsoid(2)))
    with pytest.raises(ConfigError, match="each thickness has another mesh"):
        critical_growth(given, "geometry.cortical_thickness", range=(2.0, 4.0), points=3)


def test_two_surfaces_have_no_smooth_branch(tmp_path: Path) -> None:
    points, triangles = ellipsoid(2)
    both = np.concatenate([points, points + np.array([90.0, 0.0, 0.0])])
    path = off(tmp_path / "two.off", both, np.concatenate([triangles, triangles + len(points)]))
    with pytest.raises(ConfigError, match="the 2 closed surfaces"):
        critical_growth(surface(path), "growth.ratio", range=(2.0, 4.0), points=3)
