"""A point as a study keeps it, read back: everything that tables and pictures need, without simulating."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.mesh import Mesh
from gyrify.meshing import build_mesh
from gyrify.study.archive import FINAL, FinalState, Record, read_record

RUNS = "runs"
FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StoredPoint:
    """A run of a study.

    Attributes
    ----------
    folder : Path
        Its folder; a whole run folder where the study keeps all.
    record : Record
        How it ended, its configuration and its summary.
    """

    folder: Path
    record: Record

    @property
    def key(self) -> str:
        """Name of its folder."""
        return self.folder.name

    @property
    def status(self) -> str:
        """``completed``, ``failed`` or ``stopped``."""
        return self.record.status

    @property
    def summary(self) -> dict[str, Any]:
        """As ``summary.json``; empty where the run has no state."""
        return self.record.summary or {}

    @cached_property
    def config(self) -> Config:
        """Every number of the run."""
        return Config.from_dict(self.record.config)

    @cached_property
    def mesh(self) -> Mesh:
        """Reference mesh, built anew."""
        return build_mesh(self.config)

    @cached_property
    def final(self) -> FinalState:
        """Last displacement, course of the index, and onset.

        Raises
        ------
        HistoryError
            If the run has no state.
        """
        if not self.record.final_sha256:
            raise HistoryError(f"The run {self.key} has no state: {self.record.reason}", self.record.advice)
        return FinalState.load(self.folder / FINAL)

    @property
    def points(self) -> FloatArray:
        """(n_points, 2) deformed coordinates x [mm] of the last state."""
        return self.mesh.points + self.final.displacement

    @property
    def contour(self) -> FloatArray:
        """(n_contour, 2) deformed outer contour [mm] of the last state."""
        return self.points[self.mesh.contour]

    @property
    def interface(self) -> FloatArray:
        """(n_interface, 2) deformed grey-white interface [mm] of the last state."""
        return self.points[self.mesh.interface]


def final_state(folder: str | Path, key: str) -> StoredPoint:
    """A run of a study, as it is stored.

    Parameters
    ----------
    folder : path
        Study folder.
    key : str
        First 12 digits of the configuration's hash, the ``key`` of its row.

    Returns
    -------
    StoredPoint

    Raises
    ------
    HistoryError
        If there is none, or a damaged one.
    """
    target = Path(folder) / RUNS / key
    record = read_record(target)
    if record is None:
        raise HistoryError(
            f"There is no whole run {key[:60]!r} in the study {folder}.", "Run the study again to redo it."
        )
    return StoredPoint(target, record)
