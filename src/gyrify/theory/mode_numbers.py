"""Circumferential modes of the growing annulus: the second variation about its smooth state.

In mode n the increment is U(R) cos n Theta radially and V(R) sin n Theta along the circle; its gradient is
F_11: U', F_22: (U + n V)/R, F_12: -(n U + V)/R, F_21: V' (1 radial, 2 circumferential). The state is stable
where int (gradient . A . gradient) R dR is positive for every (U, V) that vanishes at the clamp.

Mode 0 has two parts that do not see each other: U(R) radially, with the change of F_33 where that is free,
and the twist V(R) about the clamped hole, which is the mode (U sin n Theta, -V cos n Theta) at n = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, solve_triangular

from gyrify.errors import ConfigError
from gyrify.theory.annulus import Annulus, BaseState, base_state
from gyrify.theory.sphere import SphereState
from gyrify.theory.wave import half_space_stiffness, lowest_stiffness, state_matrix

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Mode:
    """The softest increment of one mode number.

    Attributes
    ----------
    number : int
        n [-].
    eigenvalue : float
        Lowest ratio of the second variation to int |u|^2 dA [Pa/mm^2]; negative means unstable.
    nodes : (n_nodes,) float array
        Reference radii [mm].
    radial, circumferential : (n_nodes,) float array
        U and V at the nodes, scaled so that the largest is 1 [-].
    """

    number: int
    eigenvalue: float
    nodes: FloatArray
    radial: FloatArray
    circumferential: FloatArray


@dataclass(frozen=True, eq=False)
class SecondVariation:
    """The quadratic forms of all modes, K_n = K_0 + n K_1 + n^2 K_2, of one axisymmetric state.

    Attributes
    ----------
    state : BaseState
        The axisymmetric state.
    powers : (3, n_unknowns, n_unknowns) float array
        K_0, K_1, K_2, whitened by the mass so that the mass is the identity [Pa/mm^2].
    root : (n_nodes - 1, n_nodes - 1) float array
        Lower Cholesky factor of the mass of one component [mm].
    axial : (n_nodes - 1,) float array or None
        Whitened coupling of U in mode 0 to a free F_33, over the root of the stiffness of F_33 itself: its
        square is what relaxing F_33 takes away; None where F_33 is held.
    """

    state: BaseState
    powers: FloatArray
    root: FloatArray
    axial: FloatArray | None = None

    @classmethod
    def of(cls, state: BaseState) -> SecondVariation:
        """Assemble about a state."""
        line = state.line
        area = line.weights * line.points
        values, slopes = line.values[:, 1:], line.slopes[:, 1:]
        root = np.asarray(np.linalg.cholesky(values.T @ (area[:, None] * values)), dtype=np.float64)
        # Whitened shape functions make the mass the identity; areas enter as their square roots.
        values, slopes = (
            solve_triangular(root, (np.sqrt(area)[:, None] * shape).T, lower=True).T
            for shape in (values, slopes)
        )
        hoop, none = values / line.points[:, None], np.zeros_like(values)
        fixed = np.stack(
            [np.hstack(row) for row in ([slopes, none], [hoop, none], [none, -hoop], [none, slopes])]
        )
        turning = np.stack(
            [np.hstack(row) for row in ([none, none], [none, hoop], [-hoop, none], [none, none])]
        )
        response = state.response(line.points)
        tangent = np.moveaxis(response.in_plane, 0, -1)
        axial = None
        if state.annulus.out_of_plane == "generalised":
            axial = _axial_coupling(response.moduli, slopes, hoop, area)
        return cls(state, quadratic_forms(fixed, turning, tangent), root, axial)

    def matrix(self, number: int) -> FloatArray:
        """Whitened second variation [Pa/mm^2] of mode `number`, radial unknowns first.

        In mode 0 the two components are not coupled, and a free F_33 follows the radial one.
        """
        matrix: FloatArray = self.powers[0] + number * self.powers[1] + number**2 * self.powers[2]
        if number == 0 and self.axial is not None:
            size = len(self.root)
            matrix[:size, :size] -= np.outer(self.axial, self.axial)
        return matrix

    def lowest(self, number: int) -> float:
        """Lowest eigenvalue [Pa/mm^2] of mode `number`."""
        values = eigh(self.matrix(number), eigvals_only=True, subset_by_index=[0, 0], check_finite=False)
        return float(values[0])

    def mode(self, number: int) -> Mode:
        """The softest increment of mode `number`."""
        value, vector = eigh(self.matrix(number), subset_by_index=[0, 0])
        fields = np.zeros((2, len(self.root) + 1))
        fields[:, 1:] = solve_triangular(self.root.T, vector.reshape(2, -1).T).T
        radial, circumferential = fields / fields.flat[np.argmax(np.abs(fields))]
        return Mode(number, float(value[0]), self.state.line.nodes, radial, circumferential)


def quadratic_forms(fixed: FloatArray, turning: FloatArray, tangent: FloatArray) -> FloatArray:
    """K_0, K_1, K_2 of gradients `fixed` + n `turning`, each (4, n_points, n_unknowns)."""
    stress_fixed = np.einsum("ijq,jqa->iqa", tangent, fixed)
    stress_turning = np.einsum("ijq,jqa->iqa", tangent, turning)
    mixed = np.tensordot(turning, stress_fixed, axes=([0, 1], [0, 1]))
    return np.stack(
        [
            np.tensordot(fixed, stress_fixed, axes=([0, 1], [0, 1])),
            mixed + mixed.T,
            np.tensordot(turning, stress_turning, axes=([0, 1], [0, 1])),
        ]
    )


def _axial_coupling(moduli: FloatArray, slopes: FloatArray, hoop: FloatArray, area: FloatArray) -> FloatArray:
    """(n_unknowns,) coupling of the whitened U to F_33, over the root of the stiffness of F_33.

    The stiffness is that of the tissue at a uniform change of F_33; a law that made it negative would be
    unstable without any other motion.
    """
    stiffness = float(area @ moduli[:, 2, 2])
    force = np.sqrt(area) * moduli[:, :2, 2].T
    return np.asarray((force[0] @ slopes + force[1] @ hoop) / np.sqrt(stiffness))


def surface_limit(state: BaseState | SphereState) -> float:
    """Stiffness of the free surface against waves much shorter than the cortex is thick.

    Such a wave sees a half-space in the stretch of the surface; where this vanishes is Biot's instability.

    Parameters
    ----------
    state : BaseState or SphereState
        The smooth state.

    Returns
    -------
    float
        Lowest eigenvalue of the surface stiffness / shear modulus of the cortex [-]; negative means unstable.
    """
    body = state.sphere if isinstance(state, SphereState) else state.annulus
    tangent = state.response(body.outer_radius).in_plane[0]
    stiffness = half_space_stiffness(state_matrix(tangent))
    return float(lowest_stiffness(stiffness)) / body.moduli_grey[0]


def lowest_eigenvalue(annulus: Annulus, growth_time: float, mode_number: int) -> float:
    """Lowest eigenvalue of the second variation in one mode.

    Parameters
    ----------
    annulus : Annulus
        The parameters.
    growth_time : float
        t [time].
    mode_number : int
        n, not negative.

    Returns
    -------
    float
        min of int (grad u . A . grad u) dA / int |u|^2 dA [Pa/mm^2]; negative means unstable.

    Raises
    ------
    ConfigError
        If the mode number is negative.
    SolveError
        If the axisymmetric state is not found.
    """
    if mode_number < 0:
        raise ConfigError(f"The mode number is {mode_number}.", "It must not be negative.")
    return SecondVariation.of(base_state(annulus, growth_time)).lowest(mode_number)


def dispersion(annulus: Annulus, growth_time: float, mode_numbers: NDArray[np.int64]) -> FloatArray:
    """Lowest eigenvalues [Pa/mm^2] of several modes at one growth time (see `lowest_eigenvalue`)."""
    variation = SecondVariation.of(base_state(annulus, growth_time))
    return np.array([variation.lowest(int(number)) for number in mode_numbers])
