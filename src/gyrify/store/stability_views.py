"""What a history knows of stability."""

from __future__ import annotations

import numpy as np

from gyrify.solve.relaxation import Relaxation
from gyrify.solve.stability import Onset, StabilityChange
from gyrify.store.journal import Journal


class StabilityViews:
    """A part of `gyrify.store.history.History`."""

    journal: Journal

    @property
    def stable(self) -> bool | None:
        """Whether the last state keeps its folds once growth stops; None while unknown.

        It is a stable equilibrium or, with dissipation, relaxes to one with the same folds (`relaxed`).
        """
        return {"true": True, "false": False}.get(self.journal.meta("stable"))

    @property
    def onset(self) -> Onset | None:
        """Where the smooth equilibrium first loses stability; None where it does not, or none was looked for.

        It is that of the slice without node jitter and dissipation, on the run's own mesh, and the same for
        every drag number. It is known as soon as growth has passed it.
        """
        return self.journal.onset

    @property
    def stability_changes(self) -> tuple[StabilityChange, ...]:
        """Every change in the number of unstable modes of the smooth equilibrium that growth has passed."""
        return self.journal.stability_changes

    @property
    def smooth_until(self) -> float | None:
        """Growth time at which the smooth equilibrium ends or folds by degrees; None where it goes on."""
        try:
            found = float(self.journal.meta("smooth_until"))
        except ValueError:
            return None
        return found if np.isfinite(found) else None

    @property
    def relaxed(self) -> Relaxation | None:
        """What the last state of a run with dissipation relaxes to once growth stops; None while unknown."""
        return Relaxation.from_text(self.journal.meta("relaxed"))

    @property
    def negative_pivots(self) -> dict[int, int]:
        """Negative pivots of the tissue's stiffness, by the states that were looked at."""
        return self.journal.negative_pivots
