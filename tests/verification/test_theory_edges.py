"""Answers of theory on the edge of what is searched: limits of waves, last modes, ends of ranges."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import jv, yv

import gyrify.theory.margin as margin_module
from gyrify.config import Config
from gyrify.model.slice import Slice
from gyrify.theory import (
    Annulus,
    Bilayer,
    SecondVariation,
    asymptotic_wrinkle,
    base_state,
    critical_growth_time,
    critical_surface,
    critical_wrinkle,
    crossings,
    neutral_curve,
    stability_margin,
)
from gyrify.theory.annulus import _problem

# Everywhere between these, for films as stiff as the substrate and isotropic growth, long waves come first.
FAST = (0.05, 0.1, 0.2, 0.35, 0.5)


@pytest.mark.parametrize(
    ("ratio", "nu", "loading"), list(product(FAST, (0.458, 0.5), ("isotropic", "uniaxial"))), ids=str
)
def test_a_substrate_that_grows_faster_fails_at_its_own_surface(
    ratio: float, nu: float, loading: str
) -> None:
    """The infimum over all waves is their long limit, which knows the film by its load alone."""
    bilayer = Bilayer(1.0, nu, loading=loading, growth_ratio=ratio)
    found = critical_wrinkle(bilayer)
    bare = critical_surface(Bilayer(1.0, nu, loading=loading)).load
    assert found.load == pytest.approx(1.0 + ratio * (bare - 1.0), abs=1e-10)
    assert found.is_substrate
    assert not found.is_surface
    assert found.at_edge
    assert found.scaled_thickness == 0.0
    assert found.wavelength == np.inf
    assert "substrate's own surface" in found.note
    # every wave comes later, the longer the earlier: a scan that ends at some wave names that one
    curve = neutral_curve(bilayer, [3e-4, 3e-3, 0.03])
    assert np.all(np.diff([found.load, *curve]) > 0.0)
    assert curve[0] == pytest.approx(found.load, rel=1e-3)


def test_the_case_of_a_film_three_times_as_stiff() -> None:
    """Growth ratio 0.1: 1.0501, where the longest wave of the scan alone says 1.0514."""
    bilayer = Bilayer(3.0, growth_ratio=0.1)
    assert critical_wrinkle(bilayer).load == pytest.approx(1.05012, abs=1e-5)
    assert neutral_curve(bilayer, 0.03)[0] == pytest.approx(1.05135, abs=1e-5)


def test_a_compressed_substrate_of_another_tissue_fails_first() -> None:
    """nu of 0.3 fails at a smaller compression than 0.5, below as above."""
    below = Bilayer(1.0, 0.5, poisson_ratio_substrate=0.3, loading="compression")
    above = Bilayer(1.0, 0.3, poisson_ratio_substrate=0.5, loading="compression")
    first = critical_surface(above).load
    assert first == pytest.approx(1.7632, abs=1e-4)
    assert critical_surface(below, "substrate").load == pytest.approx(first, rel=1e-12)
    assert critical_wrinkle(below).load <= first
    assert critical_wrinkle(above).load <= first


@pytest.mark.parametrize("contrast", [1e5, 1e6, 1e8])
def test_the_search_goes_on_to_waves_as_long_as_a_stiff_film_wants(contrast: float) -> None:
    """The first wave, k h = (3 / contrast)^(1/3), lies beyond the longest of the first scan, 0.03."""
    found, limit = critical_wrinkle(Bilayer(contrast, loading="compression")), asymptotic_wrinkle(contrast)
    assert found.strain == pytest.approx(limit.strain, rel=1e-3)
    assert found.wavelength == pytest.approx(limit.wavelength, rel=1e-3)
    assert not found.at_edge
    assert found.note == ""


def test_nothing_critical_names_the_largest_load_tried() -> None:
    found = critical_wrinkle(Bilayer(1.0, 0.0))
    assert found.load == np.inf
    assert found.searched == 3.0
    assert found.at_edge
    assert found.note == "Nothing is critical up to a load of 3, the largest that was tried."


def test_a_mode_beyond_the_last_scanned_number_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mode 19 comes first; a scan that ends at 12 goes on, and says so where it may not."""
    (expected,) = critical_growth_time(Annulus(), [200.0, 300.0])
    assert (expected.mode_number, expected.at_edge) == (19, False)
    monkeypatch.setattr(margin_module, "_SHORTEST", 0.5)
    (found,) = critical_growth_time(Annulus(), [200.0, 300.0])
    assert found.mode_number == 19
    assert found.value == pytest.approx(expected.value, rel=1e-9)
    monkeypatch.setattr(margin_module, "_SHORTEST_RESOLVED", 0.5)
    searched = critical_growth_time(Annulus(), [200.0, 300.0])
    assert (searched[0].mode_number, searched[0].at_edge) == (12, True)
    assert any("the last one tried, 12" in note for note in searched.notes)
    assert stability_margin(base_state(Annulus(), 290.0)).at_edge


def test_a_valley_beside_the_softest_scanned_mode_is_searched_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """At a small hole the twist is soft, and must not end the search for a fold between the scanned modes."""
    annulus = Annulus(inner_radius=3.6)
    (time,) = (found.value for found in critical_growth_time(annulus, [200.0, 300.0]))
    state = base_state(annulus, 1.0002 * time)
    variation = SecondVariation.of(state)
    assert variation.lowest(0) > 0.0
    assert stability_margin(state).value < 0.0
    monkeypatch.setattr(margin_module, "coarse_modes", lambda _: [0, 1, 2, 8, 14, 26, 120])
    assert all(variation.lowest(n) > 0.0 for n in (2, 8, 14, 26, 120))
    assert stability_margin(state).value < 0.0


def test_crossings_at_the_ends_of_the_range() -> None:
    (inside,) = critical_growth_time(Annulus(), [200.0, 300.0])
    first = critical_growth_time(Annulus(), [250.0, 260.0, 280.0])
    assert first[0].value == pytest.approx(inside.value, rel=1e-6)
    assert first.notes == ()
    begun = critical_growth_time(Annulus(), [260.0, 300.0])
    assert begun == ()
    assert "unstable already at the lowest growth time scanned (260)" in begun.notes[0]
    just = critical_growth_time(Annulus(), [0.0, 0.99999 * inside.value])
    assert just == ()
    assert "nearly vanishes at the end of the range" in just.notes[0]
    assert critical_growth_time(Annulus(), [0.0, 200.0]).notes == ()


@pytest.mark.parametrize("hole", [0.1, 0.15, 0.2])
def test_twist_about_the_clamped_hole_is_a_mode_of_number_zero(hole: float) -> None:
    """Without load: the torsional vibration of an isotropic ring, by Bessel functions."""
    annulus = Annulus(inner_radius=36.0 * hole)
    mode = SecondVariation.of(base_state(annulus, 0.0)).mode(0)
    assert mode.eigenvalue > 0.0
    assert np.abs(mode.radial).max() < 1e-12
    assert np.abs(mode.circumferential).max() == 1.0
    # lambda = mu k^2, with V = 0 at the clamp and no shear at the rim
    a, b, mu = annulus.inner_radius, annulus.outer_radius, annulus.moduli_grey[0]

    def shear(k: float) -> float:
        """R (V/R)' at the rim, of V = J1(k R) Y1(k a) - Y1(k R) J1(k a): -k times that of second order."""
        return jv(2, k * b) * yv(1, k * a) - yv(2, k * b) * jv(1, k * a)

    k = brentq(shear, 1e-3 / b, 2.0 / b)
    assert mode.eigenvalue == pytest.approx(mu * k**2, rel=1e-6)


@pytest.mark.parametrize("hole", [0.1, 0.2])
def test_twist_is_the_softest_mode_of_the_mesh_too(hole: float) -> None:
    config = Config().with_overrides(
        {
            "geometry.shape": "circle",
            "geometry.hole_fraction": hole,
            "mesh.node_jitter": 0.0,
            "mesh.n_around": 96,
            "mesh.n_layers": 24,
            "mesh.element": "quadratic",
            "contact.enabled": False,
        }
    )
    problem = Slice(config)
    u = np.zeros(problem.state_shape)
    pair = problem.tangent(0.0, u, u, problem.system(np.empty((0, 2), dtype=np.int64))).lowest()
    radius = float(np.sqrt(config.geometry.area / np.pi))
    annulus = Annulus(inner_radius=hole * radius, outer_radius=radius)
    exact = SecondVariation.of(base_state(annulus, 0.0)).lowest(0)
    assert pair.eigenvalue == pytest.approx(exact, rel=5e-3)
    points = problem.mesh.points
    outwards = points / np.linalg.norm(points, axis=1, keepdims=True)
    assert np.abs(np.sum(pair.vector * outwards, axis=1)).max() < 1e-3 * np.abs(pair.vector).max()


def test_growth_never_makes_the_twist_unstable() -> None:
    """In balance the hoop stress of growth cannot turn the ring about its hole."""
    for hole, time in product((0.1, 0.5, 0.9), (150.0, 500.0)):
        variation = SecondVariation.of(base_state(Annulus(inner_radius=36.0 * hole), time))
        size = len(variation.root)
        assert np.linalg.eigvalsh(variation.matrix(0)[size:, size:])[0] > 0.0


def test_mode_zero_relaxes_a_free_axial_stretch() -> None:
    """Its radial part is the tangent of the radial problem with F33 eliminated."""
    annulus = Annulus(out_of_plane="generalised")
    state = base_state(annulus, 400.0)
    variation, problem = SecondVariation.of(state), _problem(annulus)
    unknowns = np.append(state.displacement, state.axial_stretch - 1.0)[problem.free]
    response = annulus.response(problem.line.points, 1.0 + problem.strain @ unknowns, 400.0)
    area = problem.line.weights * problem.line.points
    tangent = np.einsum("q,qia,qij,qjb->ab", area, problem.strain, response.moduli, problem.strain)
    relaxed = tangent[:-1, :-1] - np.outer(tangent[:-1, -1], tangent[-1, :-1]) / tangent[-1, -1]
    size = len(variation.root)
    found = variation.root @ variation.matrix(0)[:size, :size] @ variation.root.T
    assert found == pytest.approx(relaxed, abs=1e-8 * np.abs(relaxed).max())
    held = SecondVariation.of(base_state(Annulus(), 400.0)).axial
    assert held is None


def test_scanned_values_still_give_a_plain_tuple() -> None:
    found = crossings(Annulus(), "growth_ratio", [1.5, 2.3])
    assert isinstance(found, tuple)
    assert len(found) == 1
