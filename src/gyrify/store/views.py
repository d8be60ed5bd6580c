"""What a history shows: the state at a growth time, pictures, and itself to other libraries."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from gyrify.base.arguments import real_number
from gyrify.errors import ConfigError
from gyrify.solve.types import FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from pyvista import UnstructuredGrid


def _shown() -> Any:
    """Pictures and tables of a run, by name: they know what a run is, which must not know them."""
    return import_module("gyrify.report.notebook")


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
        figure: Figure = _shown().plot(self, what, **options)
        return figure

    def to_dataframe(self) -> DataFrame:
        """Metrics of every state as a pandas table, one row per state; see `gyrify.report.notebook`."""
        return _shown().to_dataframe(self)

    def to_pyvista(
        self, index: int = -1, *, time: float | None = None, deformed: bool = True
    ) -> UnstructuredGrid:
        """A state as a PyVista grid with all its fields; see `gyrify.report.notebook`.

        Parameters
        ----------
        index : int
            State; negative numbers count from the end.
        time : float, optional
            Growth time, in place of the index; see `at`.
        deformed : bool
            Whether points are current ones, or reference ones that ``displacement`` warps.
        """
        return _shown().to_pyvista(self, index if time is None else self.at(time), deformed=deformed)

    def _repr_html_(self) -> str:
        return str(_shown().html(self))
