"""Where the lowest eigenvalue vanishes between two states of the smooth branch, one of which is unstable."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from scipy.optimize import brentq

from gyrify.errors import SolveError
from gyrify.onset.smooth import SmoothBranch, SmoothState
from gyrify.solve.stability import Eigenpair
from gyrify.solve.system import System

# An eigenvalue counts as zero below this fraction of the smaller one at the ends of the bracket: that at the
# stable end may be of a soft mode that is no part of the crossing.
_ZERO: Final = 1e-3


@dataclass(frozen=True, eq=False)
class Root:
    """A singular state.

    Attributes
    ----------
    value : float
        Value of the branch's parameter at which the lowest eigenvalue vanishes.
    bracket : (float, float)
        Closest values known to lie on either side.
    state : SmoothState
        The computed state closest to singular.
    pair : Eigenpair
        Its lowest eigenpair.
    is_refined : bool
        Whether the root was found; else Newton's method had no answer next to it, and the value is the middle
        of the bracket.
    """

    value: float
    bracket: tuple[float, float]
    state: SmoothState
    pair: Eigenpair
    is_refined: bool


@dataclass(frozen=True, eq=False)
class LowestEigenvalue:
    """The lowest eigenvalue over the parameter of a branch; what was computed is kept.

    Attributes
    ----------
    branch : SmoothBranch
        The states.
    system : System
        Linear system of the free degrees of freedom.
    pairs : dict
        Eigenpairs by the value of the parameter.
    """

    branch: SmoothBranch
    system: System
    pairs: dict[float, Eigenpair] = field(default_factory=dict)

    def at(self, value: float) -> float:
        """Lowest eigenvalue at a value of the parameter [Pa/mm^2]."""
        if value not in self.pairs:
            self.pairs[value] = self.branch.at(value).tangent(self.system).lowest()
        return self.pairs[value].eigenvalue

    def root(self, low: float, high: float, tolerance: float, was_unstable: bool = False) -> Root:
        """Find the crossing of zero between two values.

        Parameters
        ----------
        low, high : float
            Values of the parameter.
        tolerance : float
            Of the root, in the unit of the parameter.
        was_unstable : bool
            Whether the state at the lower value is the unstable one.

        Returns
        -------
        Root

        Raises
        ------
        SolveError
            If the eigenvalue is not found at an end.
        """
        small = _ZERO * min(abs(self.at(low)), abs(self.at(high)))

        def clipped(value: float) -> float:
            """Zero once close enough: at the singular state itself Newton's method has no answer."""
            eigenvalue = self.at(value)
            return eigenvalue if abs(eigenvalue) > small else 0.0

        refined = True
        try:
            brentq(clipped, low, high, xtol=tolerance)
        except SolveError:
            refined = False
        inside = {value: self.pairs[value] for value in sorted(self.pairs) if low <= value <= high}
        before = max(v for v, pair in inside.items() if (pair.eigenvalue < 0.0) == was_unstable)
        after = min(v for v, pair in inside.items() if (pair.eigenvalue < 0.0) != was_unstable)
        start, end = inside[before].eigenvalue, inside[after].eigenvalue
        value = before + (after - before) * (start / (start - end) if refined else 0.5)
        nearest = min(inside, key=lambda v: abs(inside[v].eigenvalue))
        return Root(value, (before, after), self.branch.at(nearest), inside[nearest], refined)
