"""Onset of folding in runs against the exact annulus: every hole, every drag number, both laws of growth.

A state that drag holds back is no equilibrium of the tissue. Judged there, a slice with a hole of a fifth and
drag number 1.3 lost stability at growth time 7.5, by a rotation about its hole.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.model.slice import Slice
from gyrify.run.onset.onset_search import OnsetSearch
from gyrify.run.simulation import simulate
from gyrify.solve.stability import Onset
from gyrify.theory import Annulus, critical_growth_time

RADIUS = 36.0
TIMES = np.linspace(0.0, 500.0, 11).tolist()


def circle(hole: float, **values: object) -> Config:
    """A circle of the reference tissue."""
    given = {key.replace("__", "."): value for key, value in values.items()}
    return Config.preset("reference-slice").with_overrides(
        {
            "geometry.shape": "circle",
            "geometry.area": np.pi * RADIUS**2,
            "geometry.hole_fraction": hole,
            "mesh.n_layers": 24,
            **given,
        }
    )


def exact(hole: float, law: str = "isotropic") -> tuple[float, int | None]:
    """Growth time and mode number of the annulus."""
    found = critical_growth_time(Annulus(inner_radius=hole * RADIUS, outer_radius=RADIUS, law=law), TIMES)  # type: ignore[arg-type]
    return found[0].value, found[0].mode_number


def onset(config: Config) -> Onset:
    """Onset on the mesh of a configuration."""
    found = OnsetSearch(Slice(config)).onset_by(1.0)
    assert found is not None
    return found


@pytest.mark.parametrize(("drag", "hole"), [(1.3, 0.2), (5.0, 0.4), (13.0, 0.5), (1.3, 0.5), (30.0, 0.1)])
def test_a_run_stores_the_onset_of_the_annulus(drag: float, hole: float) -> None:
    """At about the resolution of the paper, whose own error is 5 to 9 %; the mode is a fold, no rotation."""
    config = circle(hole, dissipation__number=drag, growth__duration=320.0, solver__increments=16)
    history = simulate(config)
    time, number = exact(hole)
    assert history.onset is not None
    assert history.onset.kind == "fold"
    assert history.onset.growth_time == pytest.approx(time, rel=0.1)
    assert history.onset.growth_time > time  # linear triangles are too stiff
    assert history.onset.mode_number == pytest.approx(number, abs=3)


@pytest.mark.parametrize(("hole", "law"), [(0.1, "isotropic"), (0.9, "tangential")])
def test_quadratic_cells_give_the_onset_of_the_annulus(hole: float, law: str) -> None:
    assert quadratic_errors(hole, law) == (pytest.approx(0.0, abs=2e-3), pytest.approx(0.0, abs=1))


def quadratic_errors(hole: float, law: str) -> tuple[float, int]:
    """Relative error of the growth time at onset, and error of the mode number."""
    time, number = exact(hole, law)
    values = {"mesh__n_around": 9 * number, "growth__law": law, "growth__duration": 1.1 * time}
    found = onset(circle(hole, mesh__element="quadratic", **values))
    return found.growth_time / time - 1.0, found.mode_number - number


@pytest.mark.parametrize(("reading", "exponent"), [("blocked", 0.5), ("generalised", 0.3)])
def test_growth_along_z_moves_the_onset_as_theory_says(reading: str, exponent: float) -> None:
    own = Annulus(18.0, RADIUS, out_of_plane=reading, out_of_plane_exponent=exponent, growth_ratio=8.0)  # type: ignore[arg-type]
    first, full = (
        critical_growth_time(annulus, TIMES)[0] for annulus in (own, replace(own, out_of_plane_exponent=1.0))
    )
    assert abs(first.value / full.value - 1.0) > 0.02
    assert first.mode_number is not None
    values = {
        "growth__out_of_plane": reading,
        "growth__out_of_plane_exponent": exponent,
        "growth__ratio": 8.0,
        "mesh__n_around": 10 * first.mode_number,
    }
    found = onset(circle(0.5, mesh__element="quadratic", **values))
    assert found.growth_time == pytest.approx(first.value, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("hole", [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8])
@pytest.mark.parametrize("law", ["isotropic", "tangential"])
def test_quadratic_cells_for_every_hole(hole: float, law: str) -> None:
    assert quadratic_errors(hole, law) == (pytest.approx(0.0, abs=2e-3), pytest.approx(0.0, abs=1))


@pytest.mark.slow
@pytest.mark.parametrize("hole", [0.1, 0.3, 0.5, 0.7, 0.9])
@pytest.mark.parametrize("law", ["isotropic", "tangential"])
def test_linear_cells_after_the_error_of_the_mesh(hole: float, law: str) -> None:
    """The error falls with the square of the cell size; what is left of it by extrapolation is below 2 %."""
    time, _ = exact(hole, law)
    coarse, fine = (
        onset(circle(hole, mesh__refine=level, growth__law=law, growth__duration=1.4 * time)).growth_time
        for level in (0, 1)
    )
    assert abs(fine - time) < 0.4 * abs(coarse - time)
    assert fine - (coarse - fine) / 3.0 == pytest.approx(time, rel=0.02)
