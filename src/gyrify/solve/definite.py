"""A positive definite factor for each step of a minimisation: of the exact Hessian, or of one close to it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from gyrify.energy.term import Evaluation
from gyrify.energy.total import TotalEnergy
from gyrify.solve.linear import Factor
from gyrify.solve.shift import FIRST_SHIFT, shifted_factor
from gyrify.solve.system import System
from gyrify.solve.types import FloatArray, IntArray

# Ratio of the shifts that are tried; the first is smaller than the last step's by the same.
_GROWTH: Final = 4.0
# Shifted steps of one minimisation after which the shift may fall further. Where a barrier is stiff on fine
# cells, the first shift is far above the negative curvature of the tissue, and would stop all motion.
PATIENCE: Final = 16
_LATER: Final = 1e-12


@dataclass
class DefiniteHessian:
    """Hessian of an energy, made definite where it is not.

    Barriers are projected first: often nothing else is needed, and their negative curvature, far larger than
    that of the tissue, would take a shift that stops all motion.

    Attributes
    ----------
    total : TotalEnergy
        Whose Hessian.
    system : System
        Linear system of the free degrees of freedom.
    candidates : callable
        Couplings near a state, for the pattern.
    mass : (n_free,) float array or None
        Lumped area [mm^2], to shift by a multiple of; None to project every cell.
    tau : float
        The last shift that was needed [Pa/mm^2].
    n_shifted : int
        Steps that needed one.
    """

    total: TotalEnergy
    system: System
    candidates: Callable[[FloatArray], IntArray]
    mass: FloatArray | None
    tau: float = 0.0
    n_shifted: int = 0

    def factor(self, u: FloatArray) -> Factor:
        """Factor at a state.

        Raises
        ------
        SolveError
            If nothing makes it definite.
        """
        exact = self.total.evaluate(u, project_psd=False)
        data = self._assembled(exact, u)
        factor = self.system.factorise_definite(data)
        if factor is not None:
            return factor
        if self.mass is None:
            projected = self.total.evaluate(u, project_psd=True)
            return self.system.factorise_data(self._assembled(projected, u))
        barriers_projected = self.total.project_barriers(u, exact)
        if barriers_projected is not None:
            data = self._assembled(barriers_projected, u)
            factor = self.system.factorise_definite(data) if self.tau == 0.0 else None
        if factor is None:
            least, first = self.tau / _GROWTH, FIRST_SHIFT if self.n_shifted < PATIENCE else _LATER
            factor, self.tau = shifted_factor(self.system, data, self.mass, least, _GROWTH, first)
            self.n_shifted += 1
        return factor

    def _assembled(self, evaluations: Sequence[Evaluation], u: FloatArray) -> FloatArray:
        return self.system.assemble(evaluations, lambda: self.candidates(u))
