"""A run as arrays: what a journal holds, read back."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from gyrify.base.arguments import Pathlike, as_path
from gyrify.errors import HistoryError
from gyrify.mesh import Mesh
from gyrify.model.slice import Slice
from gyrify.solve.problem import TICKS
from gyrify.solve.result import Stats
from gyrify.solve.types import FloatArray
from gyrify.store.database import RERUN
from gyrify.store.journal import Journal
from gyrify.store.kept_inputs import require_mesh, stored_config
from gyrify.store.lock import has_owner
from gyrify.store.provenance import Provenance
from gyrify.store.stability_views import StabilityViews
from gyrify.store.state_numbers import Index, gathered, state_number
from gyrify.store.views import Views


class History(Views, StabilityViews, Provenance):
    """States of a run in the order of growth; increment 0 is the reference state.

    Parameters
    ----------
    journal : Journal
        The stored run.
    problem : Slice, optional
        The problem that is solved, where it is at hand; made from the journal's configuration otherwise.
    """

    def __init__(self, journal: Journal, problem: Slice | None = None) -> None:
        self.journal = journal
        self.config = (
            stored_config(journal.meta("config"), journal.path) if problem is None else problem.config
        )
        if problem is not None:
            self.__dict__["slice"] = problem
        # What was measured of stored states, which never change; see `gyrify.run.measuring`.
        self.known_measures: dict[tuple[Any, ...], Any] = {}

    @staticmethod
    def load(folder: Pathlike) -> History:
        """Read a run folder.

        Parameters
        ----------
        folder : path
            The run folder; a run may be writing into it.

        Returns
        -------
        History
            The states that are stored so far.

        Raises
        ------
        HistoryError
            If the folder holds no run, or a damaged one.
        """
        journal = as_path("folder", folder) / "journal.sqlite"
        history = History(Journal.open(journal, read_only=True))
        if len(history) == 0:
            raise HistoryError(f"The run in {folder} has no state yet.", "Continue it with `gyrify resume`.")
        if history.positions[-1] > TICKS * history.config.solver.increments:
            raise HistoryError(f"The run in {folder} holds states beyond the end of growth.", RERUN)
        return history

    @cached_property
    def slice(self) -> Slice:
        """The problem that was solved."""
        return require_mesh(Slice(self.config), self.journal)

    @property
    def mesh(self) -> Mesh:
        """Reference mesh."""
        return self.slice.mesh

    def __len__(self) -> int:
        return len(self.journal)

    def __getitem__(self, index: Index) -> FloatArray:
        return self.displacement(index)

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

    def displacement(self, index: Index = -1) -> FloatArray:
        """(n_points, 2) displacement u [mm] of a state.

        Parameters
        ----------
        index : int, slice or sequence of int
            State; negative numbers count from the end. Several make a first axis: (n_states, n_points, 2).
        """
        n_points = self.mesh.n_points
        return gathered(index, len(self), lambda number: self.state_vector(number)[:n_points], n_points)

    def axial_stretch(self, index: int = -1) -> float:
        """Total out-of-plane stretch F33 of a state: 1 in plane strain.

        Parameters
        ----------
        index : int
            State; negative numbers count from the end.
        """
        return self.slice.axial_stretch(self.state_vector(index))

    def state_vector(self, index: int = -1) -> FloatArray:
        """(n_rows, 2) all unknowns of a state [mm]: the displacement, and F33 where it is one.

        Parameters
        ----------
        index : int
            State; negative numbers count from the end.
        """
        number = state_number(index, len(self))
        found = self.journal.displacement(number)
        if found.shape != self.slice.state_shape:
            raise HistoryError(f"State {number} does not fit the mesh of its configuration.", RERUN)
        return found

    def points(self, index: Index = -1) -> FloatArray:
        """(n_points, 2) deformed coordinates x [mm] of a state.

        Parameters
        ----------
        index : int, slice or sequence of int
            As of `displacement`.
        """
        return self.mesh.points + self.displacement(index)

    def contour(self, index: Index = -1) -> FloatArray:
        """(n_contour, 2) deformed outer contour [mm] of a state.

        Parameters
        ----------
        index : int, slice or sequence of int
            As of `displacement`.
        """
        return self.points(index)[..., self.mesh.contour, :]

    def interface(self, index: Index = -1) -> FloatArray:
        """(n_interface, 2) deformed grey-white interface [mm] of a state.

        Parameters
        ----------
        index : int, slice or sequence of int
            As of `displacement`.
        """
        return self.points(index)[..., self.mesh.interface, :]

    @property
    def status(self) -> str:
        """``completed``, ``failed``, ``stopped``, ``interrupted`` or ``running``."""
        return "interrupted" if self._is_abandoned else self.journal.meta("status", "running")

    @property
    def reason(self) -> str:
        """Why the run ended early; empty when it completed."""
        return "Its process ended unexpectedly." if self._is_abandoned else self.journal.meta("reason")

    @property
    def advice(self) -> str:
        """What to try after an early end."""
        return "Continue with `gyrify resume`." if self._is_abandoned else self.journal.meta("advice")

    @property
    def _is_abandoned(self) -> bool:
        """Whether a run is recorded as going on that no process works on: it was killed."""
        path = self.journal.path
        return (
            path is not None
            and self.journal.meta("status", "running") == "running"
            and not has_owner(path.parent)
        )

    @property
    def result_hash(self) -> str:
        """SHA-256 of growth times and displacements; equal for equal runs."""
        return self.journal.result_hash

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

    def __repr__(self) -> str:
        return f"History({len(self)} states, {self.fractions[-1]:.0%} grown, {self.status})"
