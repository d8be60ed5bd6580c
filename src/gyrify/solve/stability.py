r"""Stability of a state: inertia and lowest eigenpair of the tangent stiffness K against the mass M.

.. math:: K v = \lambda M v, \quad \lambda \; \mathrm{[Pa/mm^2]}, \quad \textstyle\sum_i m_i |v_i|^2 = 1

K is the exact Hessian on the free degrees of freedom, M the lumped reference area m_i of each point. A
state is stable where K has no negative pivot. The lowest eigenvalue is found by shift-invert: where K is
indefinite it is first shifted to K + tau M, with tau doubled until no pivot is negative, so that the
eigenvalue nearest to the shift is the lowest one. Where conjugate gradients take the place of factors, it is
found by LOBPCG, and so are the negative ones that are counted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from gyrify.energy.term import Evaluation
from gyrify.errors import SolveError
from gyrify.solve.iterative.krylov import ConjugateGradients
from gyrify.solve.iterative.lowest import Modes
from gyrify.solve.linear import Factor
from gyrify.solve.shift import shifted_factor
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# Largest residual of an eigenpair, ||K v - lambda M v|| over ||K|| ||v||.
EIGEN_TOLERANCE = 1e-6
_TOLERANCE = 1e-9
_LANCZOS_VECTORS = 12


@dataclass(frozen=True, eq=False)
class Eigenpair:
    """Lowest eigenvalue of K v = lambda M v, with its vector.

    Attributes
    ----------
    eigenvalue : float
        lambda [Pa/mm^2]; negative where the state is unstable.
    vector : (n_points, n_dim) float array
        v [1/mm], with sum m_i |v_i|^2 = 1, zero where clamped; its sign is arbitrary.
    residual : float
        ||K v - lambda M v|| / (||K|| ||v||) [-], with the largest column norm of K for its norm.
    """

    eigenvalue: float
    vector: FloatArray
    residual: float


@dataclass(frozen=True, eq=False)
class Onset:
    """Where the smooth equilibrium of the tissue first loses stability, without node jitter and dissipation.

    Attributes
    ----------
    growth_time : float
        Growth time [time].
    bracket : (float, float)
        Growth times of the last stable and the first unstable state known [time].
    eigenvalue : float
        Lowest eigenvalue there [Pa/mm^2]; zero but for the tolerance of its root.
    mode_number : int
        Waves along the contour (along one period of a strip).
    wavelength : float
        Deformed length of the contour over the mode number [mm].
    displacement : (n_points, n_dim) float array
        The state [mm], from the points of the run's own mesh.
    vector : (n_points, n_dim) float array
        The mode, as in `Eigenpair` [1/mm]; where it is largest normal to the contour, it points outwards.
    kind : str
        What the mode moves; see `gyrify.run.onset.mode_kinds.Wave`.
    """

    growth_time: float
    bracket: tuple[float, float]
    eigenvalue: float
    mode_number: int
    wavelength: float
    displacement: FloatArray
    vector: FloatArray
    kind: str = "fold"


@dataclass(frozen=True)
class StabilityChange:
    """A change in the number of modes along which the smooth equilibrium is unstable.

    Attributes
    ----------
    growth_time : float
        Growth time [time]: located where stability is lost or regained, else the middle of the bracket.
    bracket : (float, float)
        Growth times between which it lies [time].
    n_before, n_after : int
        Negative eigenvalues of the stiffness there.
    kind : str
        What the mode that changes sides moves; see `gyrify.run.onset.mode_kinds.Wave`.
    mode_number : int
        Waves along the contour.
    wavelength : float
        Deformed length of the contour over the mode number [mm]; 0 where that is 0.
    """

    growth_time: float
    bracket: tuple[float, float]
    n_before: int
    n_after: int
    kind: str
    mode_number: int
    wavelength: float


class Tangent:
    """Factorised tangent stiffness of a state.

    Parameters
    ----------
    evaluations : sequence of Evaluation
        Each energy term at the state, with its exact Hessian.
    system : System
        Linear system of the free degrees of freedom.
    mass : (n_free,) float array
        Diagonal of M [mm^2].
    candidates : callable
        Couplings near the state, for the pattern.

    Attributes
    ----------
    n_negative : int
        Number of negative pivots of K, that is of negative eigenvalues. Where no factor is kept, at most
        `gyrify.solve.iterative.lowest.MOST_MODES`.

    Raises
    ------
    SolveError
        If K holds no numbers, or its lowest modes are not found where no factor is kept.
    """

    def __init__(
        self,
        evaluations: Sequence[Evaluation],
        system: System,
        mass: FloatArray,
        candidates: Callable[[], IntArray],
    ) -> None:
        self._system, self.mass = system, mass
        self._data = system.assemble(evaluations, candidates)
        self._pattern = system.pattern
        self._modes: Modes | None = None
        self.n_negative: int
        if isinstance(system.solver, ConjugateGradients):
            system.require_numbers(self._data)
            self._modes = system.solver.modes(self._data, mass)
            self.n_negative = int(np.count_nonzero(self._modes.eigenvalues < 0.0))
            if self.n_negative == 0:  # a negative one proves itself, that there is none does not
                self._checked(self._modes.vectors[:, 0])
        else:
            self.n_negative = system.factorise_data(self._data).n_negative

    @property
    def is_stable(self) -> bool:
        """Whether no pivot is negative."""
        return self.n_negative == 0

    def matrix(self) -> sp.csr_array:
        """K on the free degrees of freedom, both triangles [Pa]."""
        pattern = self._pattern
        upper = sp.csr_array((self._data, pattern.cols, pattern.indptr), shape=(self.mass.size,) * 2)
        return sp.csr_array(upper + sp.triu(upper, 1).T)

    def lowest(self, guess: float = 0.0) -> Eigenpair:
        """Lowest eigenpair.

        Parameters
        ----------
        guess : float
            About what the eigenvalue is, if known and negative [Pa/mm^2]: saves factorisations.

        Returns
        -------
        Eigenpair

        Raises
        ------
        SolveError
            If none is found to the tolerance.
        """
        if self._modes is not None:
            return self._checked(self._modes.vectors[:, 0])
        return self._nearest(self._definite(guess), "LA")

    def _nearest(self, factor: Factor, which: str) -> Eigenpair:
        """Eigenpair at one end of the spectrum of a factor's inverse."""
        root = np.sqrt(self.mass)
        n = root.size
        inverse = sla.LinearOperator((n, n), matvec=lambda x: root * factor.solve(root * x.ravel()))
        start = np.random.default_rng(0).standard_normal(n)
        try:
            _, vectors = sla.eigsh(inverse, k=1, which=which, v0=start, ncv=_LANCZOS_VECTORS, tol=_TOLERANCE)
        except sla.ArpackNoConvergence as failure:
            raise _unfound(f"the Lanczos iteration did not converge ({failure})") from failure
        v = vectors[:, 0] / root
        return self._checked(v / np.sqrt(v @ (self.mass * v)))

    def latest(self) -> Eigenpair:
        """Negative eigenvalue nearest to zero, with its vector: that of the mode which turned last.

        Raises
        ------
        SolveError
            If none is found to the tolerance, or there is none.
        """
        if self._modes is None:
            pair = self._nearest(self._system.factorise_data(self._data), "SA")
        else:
            pair = self._checked(self._modes.vectors[:, max(self.n_negative - 1, 0)])
        if pair.eigenvalue >= 0.0:
            raise _unfound("no eigenvalue is negative")
        return pair

    def _definite(self, guess: float) -> Factor:
        """Factor of K, or of K + tau M where K is not positive definite; later calls make it invalid."""
        if self._system.pattern is not self._pattern:
            raise RuntimeError("the pattern has grown since this tangent was assembled")
        if self.n_negative > 0:
            return shifted_factor(self._system, self._data, self.mass, -1.2 * guess).factor
        factor = self._system.factorise_definite(self._data)
        return self._system.factorise_data(self._data) if factor is None else factor

    def _checked(self, v: FloatArray) -> Eigenpair:
        """Eigenpair of a vector of unit mass, by its Rayleigh quotient."""
        K = self.matrix()
        force = K @ v
        eigenvalue = float(v @ force)
        scale = float(sla.norm(K, axis=0).max()) * float(np.linalg.norm(v))
        residual = float(np.linalg.norm(force - eigenvalue * self.mass * v)) / scale
        if not residual <= EIGEN_TOLERANCE:
            raise _unfound(f"its residual of {residual:.1e} is above {EIGEN_TOLERANCE:.0e}")
        full = np.zeros(self._system.n_dofs)
        full[self._system.free] = v
        return Eigenpair(eigenvalue, full.reshape(-1, self._system.n_dim), residual)


def _unfound(reason: str) -> SolveError:
    return SolveError(
        f"The lowest eigenvalue of the stiffness was not found: {reason}.",
        "Set stability.detect = false to run without it.",
    )
