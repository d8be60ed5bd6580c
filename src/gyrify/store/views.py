"""What a history shows: the state at a growth time, and pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gyrify.arguments import real_number
from gyrify.errors import ConfigError
from gyrify.solve.types import FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Views:
    """Part of `History`."""

    if TYPE_CHECKING:

        @property
        def growth_times(self) -> FloatArray: ...

    def at(self, time: float) -> int:
        """Number of the stored state whose growth time is nearest; nothing is interpolated.

        ``history.points(history.at(time=310))`` are the points at growth time 310, or near it:
        ``history.growth_times`` says which times are stored.

        Parameters
        ----------
        time : float
            Growth time, from 0 to that of the last state; of two states equally near, the earlier is taken.

        Raises
        ------
        ConfigError
            If it is outside of that range.
        """
        times, wanted = self.growth_times, real_number("time", time)
        if not 0.0 <= wanted <= times[-1] * (1.0 + 1e-9):
            raise ConfigError(
                f"time = {wanted:g} is out of range: the run holds growth times 0 to {times[-1]:g}.",
                "Give a growth time in that range.",
            )
        return int(np.argmin(np.abs(times - wanted)))

    def plot(self, what: str = "folded", **options: Any) -> Figure:
        """Draw the run; see `gyrify.plot`.

        Parameters
        ----------
        what : str
            ``folded``, ``gi``, ``stress``, ``thickness``, ``energy``, ``mode`` or ``dispersion``.
        **options
            ``compare``, ``at``, ``stress`` and ``width_mm``, as of `gyrify.plot`.
        """
        from gyrify.notebook import plot

        return plot(self, what, **options)
