"""Where the lowest eigenvalue vanishes between two states of the smooth branch, one of which is unstable."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from scipy.optimize import brentq

from gyrify.errors import SolveError
from gyrify.run.onset.smooth import SmoothBranch, SmoothState
from gyrify.solve.stability import Eigenpair
from gyrify.solve.system import System

# An eigenvalue counts as zero below this fraction of the smaller one at the ends of the bracket: that at the
# stable end may be of a soft mode that is no part of the crossing.
_ZERO: Final = 1e-3
# Where a state is not found, the bracket is narrowed from its stable end, by a half, a quarter ....
_SMALLEST_SHARE: Final = 1.0 / 64.0


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
        Whether the root was found; else Newton's method had no answer next to it, and the value is the zero
        of the line through the last two stable states, or the middle of the bracket if that lies outside.
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
            self._narrow(low, high, tolerance, was_unstable)
            refined = False
        before, after = self._bracket(low, high, was_unstable)
        if refined:
            start, end = self.at(before), self.at(after)
            value = before + (after - before) * (start / (start - end))
            nearest = min((v for v in self.pairs if low <= v <= high), key=lambda v: abs(self.at(v)))
        else:
            # A state that is stable yet may have another mode as its lowest.
            value, nearest = self._beyond(before, after, was_unstable), before if was_unstable else after
        return Root(value, (before, after), self.branch.at(nearest), self.pairs[nearest], refined)

    def _bracket(self, low: float, high: float, was_unstable: bool) -> tuple[float, float]:
        """Known values closest to the crossing, on either side."""
        inside = [value for value in self.pairs if low <= value <= high]
        before = max(v for v in inside if (self.at(v) < 0.0) == was_unstable)
        return before, min(v for v in inside if (self.at(v) < 0.0) != was_unstable)

    def _narrow(self, low: float, high: float, tolerance: float, was_unstable: bool) -> None:
        """Approach the singular state from the stable end, from which one state leads to the next.

        Past it many modes may turn within a short stretch, and Newton's method fails between them.
        """
        share = 0.5
        while share >= _SMALLEST_SHARE:
            before, after = self._bracket(low, high, was_unstable)
            stable, unstable = (after, before) if was_unstable else (before, after)
            if after - before <= tolerance:
                return
            try:
                self.at(stable + share * (unstable - stable))
            except SolveError:
                share *= 0.5

    def _beyond(self, before: float, after: float, was_unstable: bool) -> float:
        """Where the last two stable states say that the eigenvalue vanishes, if that lies in the bracket."""
        stable = sorted(v for v, pair in self.pairs.items() if pair.eigenvalue > 0.0)
        after_it, before_it = [v for v in stable if v >= after], [v for v in stable if v <= before]
        last = after_it[:2] if was_unstable else before_it[-2:]
        if len(last) == 2:
            (a, b), (f, g) = last, (self.at(v) for v in last)
            value = a - f * (b - a) / (g - f) if f != g else before
            if before < value < after:
                return value
        return 0.5 * (before + after)


def limit_point(before: float, last: float, first_eigenvalue: float, last_eigenvalue: float) -> float | None:
    """Value at which a stable branch turns back, from its last two states; None if they do not tell.

    In space the bifurcation of a symmetric body is no fork: folds inwards and outwards are not alike. A mesh
    that is less symmetric than the body turns it into a limit point, near which the square of the lowest
    eigenvalue is linear, and beyond which no smooth state is left.
    """
    if not first_eigenvalue > last_eigenvalue > 0.0:
        return None
    first, end = first_eigenvalue**2, last_eigenvalue**2
    return last + (last - before) * end / (first - end)
