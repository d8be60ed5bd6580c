"""An old factor serves as long as few steps with it lead to the goal, each of them cheaper than a new one."""

from __future__ import annotations

from dataclasses import dataclass

from gyrify.solve.linear import Factor

# Steps with an old factor that cost less than assembling and factorising anew.
STEPS = 3


@dataclass
class Reuse:
    """The latest factor, and how fast steps with it converge.

    Attributes
    ----------
    factor : Factor or None
        The factor; None where there is none to use again.
    contraction : float
        Residual after a step over the residual before it, as last seen [-].
    """

    factor: Factor | None = None
    contraction: float = 1.0

    def serves(self, residual: float, goal: float) -> bool:
        """Whether so few steps with the old factor can be expected to reach the goal."""
        return self.factor is not None and residual * self.contraction**STEPS <= goal

    def renew(self, factor: Factor) -> None:
        """A new factor."""
        self.factor, self.contraction = factor, 1.0

    def learn(self, before: float, after: float, step: float) -> None:
        """Residuals before and after a step; a shortened one says nothing, and so ends the use."""
        self.contraction = min(1.0, after / before) if step == 1.0 and before > 0.0 else 1.0

    def drop(self) -> None:
        """Use the factor no more."""
        self.factor, self.contraction = None, 1.0
