"""What a configuration puts into the energies of a slice, number by number."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.energy.viscous import DragEnergy, KelvinVoigtEnergy
from gyrify.mesh import GREY, WHITE
from gyrify.model.slice import Slice
from gyrify.physics.materials.neo_hookean import lame_parameters
from gyrify.solve.problem import State


def problem(tiny: Config, **overrides) -> Slice:
    return Slice(tiny.replace(**{key.replace("__", "."): value for key, value in overrides.items()}))


def only(values: np.ndarray) -> float:
    """The one value of an array."""
    assert np.ptp(values) == 0.0
    return float(values[0])


def test_moduli_by_hand() -> None:
    """E = 9, nu = 0.25: mu = 9 / 2.5 = 3.6, kappa = 9 / (3 x 0.5) = 6."""
    assert lame_parameters(9.0, 0.25) == pytest.approx((3.6, 6.0), rel=1e-15)


def test_each_tissue_has_its_moduli(tiny: Config) -> None:
    """E_G = 9 is 1.36 times softer than E_W at ratio 1/1.36: E_W = 9 x 1.36 = 12.24."""
    slice_ = problem(
        tiny,
        material__young_modulus=9.0,
        material__stiffness_ratio=1 / 1.36,
        material__poisson_ratio=0.25,
        material__poisson_ratio_white=0.4,
    )
    grey, white = slice_.mesh.region == GREY, slice_.mesh.region == WHITE
    assert only(slice_.parameters[0][grey]) == pytest.approx(3.6)
    assert only(slice_.bulk_modulus[grey]) == pytest.approx(6.0)
    assert only(slice_.parameters[0][white]) == pytest.approx(12.24 / 2.8)
    assert only(slice_.bulk_modulus[white]) == pytest.approx(12.24 / 0.6)


def test_each_tissue_has_its_growth(tiny: Config) -> None:
    """G_G = 0.002, growth ratio 4: G_W = 0.0005; at time 300, lambda = 1.6 and 1.15."""
    slice_ = problem(tiny, growth__ratio=4.0)
    grey, white = slice_.mesh.region == GREY, slice_.mesh.region == WHITE
    assert only(slice_.growth.rate[grey]) == 0.002
    assert only(slice_.growth.rate[white]) == pytest.approx(0.0005)
    k = slice_.kinematics(300.0)
    assert only(k.J_g[grey]) == pytest.approx(1.6**3)
    assert only(k.J_g[white]) == pytest.approx(1.15**3)
    assert only(k.f33[grey]) == pytest.approx(1 / 1.6)
    assert only(problem(tiny, growth__out_of_plane="none").kinematics(300.0).f33) == 1.0


def test_tangential_growth_is_that_of_the_cortex_only(tiny: Config) -> None:
    """det F_g = lambda x 1 x lambda in grey cells, and nothing grows across: F_e = F_g^-1 leaves N alone."""
    slice_ = problem(tiny, growth__law="tangential", growth__ratio=4.0)
    grey = slice_.mesh.region == GREY
    k = slice_.kinematics(300.0)
    assert k.J_g[grey] == pytest.approx(1.6**2)
    assert k.J_g[~grey] == pytest.approx(1.15**3)
    N = slice_.mesh.across[grey]
    assert np.einsum("cij,cj->ci", k.base[grey], N) == pytest.approx(N, abs=1e-14)
    along = np.stack([-N[:, 1], N[:, 0]], axis=1)
    assert np.einsum("cij,cj->ci", k.base[grey], along) == pytest.approx(along / 1.6, abs=1e-14)


@pytest.mark.parametrize(("per", "power"), [("grown", 3), ("reference", 0)])
def test_energy_counts_grown_or_reference_volume(tiny: Config, per: str, power: int) -> None:
    slice_ = problem(tiny, growth__energy_per=per)
    weight = slice_.elastic_energy(slice_.kinematics(300.0)).weight / slice_.simplices.volumes
    assert weight[slice_.mesh.region == GREY] == pytest.approx(1.6**power)


@pytest.mark.parametrize(("start", "end"), [(0.0, 0.25), (0.5, 0.55)])
def test_drag_has_its_coefficient(tiny: Config, start: float, end: float) -> None:
    """c R^2 / (E duration) = number, c / dt = number E / (R^2 span): pi R^2 = 4069, R^2 = 1295.2."""
    slice_ = problem(tiny, dissipation__number=2.0)
    (drag,) = (t for t in slice_.energy(end, _at_rest(slice_), start).terms if isinstance(t, DragEnergy))
    c_over_dt = 2.0 * 9210.87 / (4069.0 / np.pi) / (end - start)
    assert drag.weight == pytest.approx(c_over_dt * slice_.lumped_area, rel=1e-12)
    assert slice_.lumped_area.sum() == pytest.approx(slice_.simplices.volumes.sum())


def test_kelvin_voigt_has_its_coefficient_and_its_strain(tiny: Config) -> None:
    """eta / (E duration) = number, eta / dt = number E / span, per grown volume; strain at the old growth."""
    slice_ = problem(tiny, dissipation__kind="kelvin_voigt", dissipation__number=0.1)
    terms = slice_.energy(0.6, _at_rest(slice_), 0.5).terms
    (viscous,) = (t for t in terms if isinstance(t, KelvinVoigtEnergy))
    grey = slice_.mesh.region == GREY
    # at 0.6 of 500, lambda = 1.6; the span is 0.1
    expected = 0.1 * 9210.87 / 0.1 * 1.6**3 * slice_.simplices.volumes[grey]
    assert viscous.weight[grey] == pytest.approx(expected)
    # undisplaced at 0.5: F_e = I / 1.5, E = (1/2.25 - 1) / 2
    assert viscous.previous_strain[grey] == pytest.approx(
        np.broadcast_to((1 / 2.25 - 1) / 2 * np.eye(2), (grey.sum(), 2, 2))
    )


@pytest.mark.parametrize("overrides", [{"dissipation__kind": "none"}, {"dissipation__number": 0.0}])
def test_without_dissipation_there_is_no_such_term(tiny: Config, overrides: dict) -> None:
    slice_ = problem(tiny, **overrides)
    terms = slice_.energy(0.5, _at_rest(slice_), 0.4).terms
    assert not any(isinstance(term, DragEnergy | KelvinVoigtEnergy) for term in terms)


def test_contact_has_its_distance_and_stiffness(tiny: Config) -> None:
    """0.0667 x 1.5 = 0.10005 mm on a coarse contour; half the shortest edge on a fine one; 0.1 E."""
    coarse = problem(tiny).contact_energy(np.zeros_like(problem(tiny).mesh.points))
    assert coarse.d_hat == pytest.approx(0.10005)
    fine = problem(tiny, mesh__n_around=400, contact__activation_fraction=0.5)
    x = fine.mesh.points[fine.mesh.contour]
    shortest = np.linalg.norm(x - np.roll(x, 1, axis=0), axis=1).min()
    assert shortest < 2 * 0.75
    assert fine.contact_energy(np.zeros_like(fine.mesh.points)).d_hat == pytest.approx(shortest / 2)
    assert problem(tiny).barrier_stiffness == pytest.approx(921.087)
    assert problem(tiny, contact__barrier_stiffness=5.0).barrier_stiffness == 5.0


def test_contact_distance_follows_no_collapsing_edge(tiny: Config) -> None:
    """An edge shrunk to 1/50 of the shortest one counts as 1/10 of it: d_hat is 1/20 and acts."""
    slice_ = problem(tiny, contact__activation_fraction=0.5)
    points, contour = slice_.mesh.points, slice_.mesh.contour
    shortest = slice_.surface.shortest_edge(np.zeros_like(points))
    first, second = points[contour[0]], points[contour[1]]
    u = np.zeros_like(points)
    u[contour[1]] = (first - second) * (1.0 - 0.02 * shortest / np.linalg.norm(first - second))
    assert slice_.surface.shortest_edge(u) == pytest.approx(0.02 * shortest)
    energy = slice_.contact_energy(u)
    assert energy.d_hat == pytest.approx(0.05 * shortest)
    force = energy.evaluate(u, order=1).gradient[contour[1]]
    assert np.dot(force, second - first) < 0.0  # the energy falls as the edge grows again


def test_contact_off_is_off(tiny: Config) -> None:
    slice_ = problem(tiny, contact__enabled=False)
    assert not any(hasattr(term, "d_hat") for term in slice_.energy(0.5, _at_rest(slice_), 0.4).terms)
    through = slice_.mesh.points * -2.0
    assert slice_.is_path_admissible(0.0 * through, through)


def test_paths_through_the_contour_are_refused(tiny: Config) -> None:
    """One point of the contour moves through the slice and out on the other side."""
    slice_ = problem(tiny)
    u = np.zeros_like(slice_.mesh.points)
    u[slice_.mesh.contour[0]] = [-200.0, 0.0]
    assert not slice_.is_path_admissible(np.zeros_like(u), u)
    assert slice_.is_path_admissible(np.zeros_like(u), -0.01 * u)


def test_tolerance_is_per_stiffness_and_edge(tiny: Config) -> None:
    """tolerance x E x mean length of the edges of grey triangles."""
    slice_ = problem(tiny, solver__tolerance=1e-5)
    corners = slice_.mesh.points[slice_.mesh.cells[slice_.mesh.region == GREY]]
    pairs = [(0, 1), (1, 2), (2, 0)]
    mean = np.mean([np.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in pairs])
    assert slice_.stepping.criterion.force == pytest.approx(1e-5 * 9210.87 * mean)


def _at_rest(slice_: Slice) -> State:
    return State.reference(slice_.mesh.n_points, 2)
