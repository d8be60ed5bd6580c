"""A run as arrays: what a journal holds, read back."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

import numpy as np

from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.mesh import Mesh
from gyrify.model import Slice
from gyrify.solve.quasistatic import TICKS
from gyrify.solve.result import Stats
from gyrify.solve.types import FloatArray
from gyrify.store.journal import Journal


class History:
    """States of a run in the order of growth; increment 0 is the reference state.

    Parameters
    ----------
    journal : Journal
        The stored run.
    """

    def __init__(self, journal: Journal) -> None:
        self.journal = journal
        self.config = Config.from_toml(journal.meta("config"))

    @staticmethod
    def load(folder: str | Path) -> History:
        """Read a run folder.

        Raises
        ------
        HistoryError
            If the folder holds no run, or a damaged one.
        """
        return History(Journal.open(Path(folder) / "journal.sqlite", read_only=True))

    @cached_property
    def slice(self) -> Slice:
        """The problem that was solved."""
        return Slice(self.config)

    @property
    def mesh(self) -> Mesh:
        """Reference mesh."""
        return self.slice.mesh

    def __len__(self) -> int:
        return len(self.journal)

    def __iter__(self) -> Iterator[FloatArray]:
        return (self.displacement(number) for number in range(len(self)))

    @cached_property
    def positions(self) -> list[int]:
        """Growth time of every state in ticks."""
        return self.journal.column("position")

    @property
    def fractions(self) -> FloatArray:
        """(n_states,) growth time over the duration of growth."""
        return np.array(self.positions) / (TICKS * self.config.solver.increments)

    @property
    def growth_times(self) -> FloatArray:
        """(n_states,) growth time [time]."""
        return self.fractions * self.config.growth.duration

    def displacement(self, index: int = -1) -> FloatArray:
        """(n_points, 2) displacement u [mm] of a state; negative indices count from the end."""
        number = index + len(self) if index < 0 else index
        if not 0 <= number < len(self):
            raise HistoryError(
                f"There is no state {index}.", f"This history holds states 0 to {len(self) - 1}."
            )
        return self.journal.displacement(number)

    def points(self, index: int = -1) -> FloatArray:
        """(n_points, 2) deformed coordinates x [mm] of a state."""
        return self.mesh.points + self.displacement(index)

    def contour(self, index: int = -1) -> FloatArray:
        """(n_contour, 2) deformed outer contour [mm] of a state."""
        return self.points(index)[self.mesh.contour]

    def interface(self, index: int = -1) -> FloatArray:
        """(n_interface, 2) deformed grey-white interface [mm] of a state."""
        return self.points(index)[self.mesh.interface]

    @property
    def status(self) -> str:
        """``completed``, ``failed``, ``stopped``, ``interrupted`` or ``running``."""
        return self.journal.meta("status", "running")

    @property
    def reason(self) -> str:
        """Why the run ended early; empty when it completed."""
        return self.journal.meta("reason")

    @property
    def advice(self) -> str:
        """What to try after an early end."""
        return self.journal.meta("advice")

    @property
    def result_hash(self) -> str:
        """SHA-256 of growth times and displacements; equal for equal runs."""
        return self.journal.result_hash

    @property
    def versions(self) -> dict[str, str]:
        """Versions of gyrify and of what it computes with."""
        return dict(json.loads(self.journal.meta("versions", "{}")))

    @property
    def stats(self) -> Stats:
        """Work done."""
        return self.journal.state(len(self) - 1).stats

    @property
    def residuals(self) -> FloatArray:
        """(n_states,) largest nodal force at convergence [Pa mm]."""
        return np.array(self.journal.column("residual"))

    @property
    def wall_s(self) -> float:
        """Time spent solving [s]."""
        return float(sum(self.journal.column("wall_s")))

    @property
    def linear_solver(self) -> str:
        """Library that factorised the stiffness matrices."""
        return self.journal.meta("linear_solver", "unknown")

    @property
    def stable(self) -> bool | None:
        """Whether the last state is a stable equilibrium of the tissue alone; None while unknown."""
        known = self.journal.meta("stable")
        return known == "true" if known else None

    def __repr__(self) -> str:
        return f"History({len(self)} states, {self.fractions[-1]:.0%} grown, {self.status})"
