"""What theory expects of a configuration, against the theory itself at its full accuracy."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from validity_cases import PUBLISHED, case

from gyrify.config import Config
from gyrify.run.validity.exact_bodies import annulus_of
from gyrify.run.validity.expected import expected_onset
from gyrify.theory import Bilayer, critical_growth_time, critical_wrinkle, neutral_curve

RINGS = {
    "reference": {},
    "thin": {"geometry.cortical_thickness": 0.5},
    "published": PUBLISHED,
    "stiff": {"material.stiffness_ratio": 5.0},
    "generalised": {"growth.out_of_plane": "generalised"},
    "exponential": {"growth.stretch": "exponential", "geometry.hole_fraction": 0.2},
    "nearly incompressible": {"material.poisson_ratio": 0.4999},
}


@pytest.mark.parametrize("name", RINGS)
def test_a_ring_is_the_annulus_of_the_same_area(name: str) -> None:
    config = case(RINGS[name])
    exact = dataclasses.replace(annulus_of(config), degree=12)
    first = critical_growth_time(exact, np.linspace(0.0, 500.0, 11).tolist())[0]
    found = expected_onset(config)
    assert found.is_known
    assert found.theory == "annulus"
    assert found.growth_time == pytest.approx(first.value, rel=1e-3)
    assert found.mode_number == first.mode_number
    assert found.wavelength_mm == pytest.approx(2 * np.pi * exact.outer_radius / found.mode_number)


def test_the_published_parameters_fold_at_growth_time_123() -> None:
    found = expected_onset(case(PUBLISHED))
    assert found.growth_time == pytest.approx(122.82, abs=0.05)
    assert found.mode_number == 41


def test_waves_much_shorter_than_the_cortex_have_no_number() -> None:
    found = expected_onset(case({"material.stiffness_ratio": 0.3, "growth.energy_per": "reference"}))
    assert found.growth_time is not None
    assert found.mode_number is None
    assert found.wavelength_mm is None


@pytest.mark.parametrize("change", [{"growth.duration": 200.0}, {"growth.rate": 0.0}, {"growth.ratio": 1.0}])
def test_stability_that_is_kept_to_the_end_has_no_onset(change: dict[str, float]) -> None:
    found = expected_onset(case(change))
    assert found.is_known
    assert found.growth_time is None


def strip(**changes: object) -> Config:
    return case({"geometry.shape": "strip", **changes})


def test_a_long_strip_is_a_film_on_a_half_space() -> None:
    wrinkle = critical_wrinkle(Bilayer(1.0, 0.458, growth_ratio=3.6))
    wavelength = 2 * np.pi * 1.5 / wrinkle.scaled_thickness
    found = expected_onset(strip(**{"geometry.length": 5 * wavelength}))
    assert found.theory == "film on a half-space"
    assert found.mode_number == 5
    assert found.growth_time == pytest.approx((wrinkle.load - 1.0) / 0.002, rel=1e-6)


def test_only_waves_that_fit_the_period_are_expected() -> None:
    wrinkle = critical_wrinkle(Bilayer(1.0, 0.458, growth_ratio=3.6))
    length = 1.4 * 2 * np.pi * 1.5 / wrinkle.scaled_thickness
    found = expected_onset(strip(**{"geometry.length": length}))
    loads = neutral_curve(Bilayer(1.0, 0.458, growth_ratio=3.6), 2 * np.pi * np.array([1, 2]) * 1.5 / length)
    assert found.mode_number == 1 + int(np.argmin(loads))
    assert found.growth_time == pytest.approx((loads.min() - 1.0) / 0.002, rel=1e-9)
    assert found.growth_time > (wrinkle.load - 1.0) / 0.002


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"growth.out_of_plane": "generalised"}, "generalised"),
        ({"growth.stretch": "exponential"}, "exponential"),
        ({"growth.law": "tangential"}, "tangential"),
        ({"geometry.depth": 4.0}, "deep white matter"),
    ],
)
def test_what_no_theory_covers_is_named(changes: dict[str, object], word: str) -> None:
    found = expected_onset(strip(**changes))
    assert not found.is_known
    assert word in found.not_covered
    assert found.growth_time is None


def test_mesh_and_solver_do_not_matter() -> None:
    assert expected_onset(case({"mesh.n_around": 24, "solver.increments": 7})) == expected_onset(Config())
