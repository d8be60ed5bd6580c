"""A point as a study keeps it, read back: everything that tables and pictures need, without simulating."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gyrify.config import Config
from gyrify.config.words import shorten
from gyrify.errors import HistoryError
from gyrify.mesh import Mesh
from gyrify.model.meshing import build_mesh
from gyrify.study.archive import FINAL, FinalState, Record, read_record

RUNS = "runs"
_REDO = "Run the study again to compute it again."
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
            If the run has no state, or one that does not fit its configuration.
        """
        if not self.record.final_sha256:
            raise HistoryError(f"The run {self.key} has no state: {self.record.reason}", self.record.advice)
        final = FinalState.load(self.folder / FINAL)
        n, n_dim, n_states = self.mesh.n_points, self.mesh.n_dim, final.growth_time.size
        onset = final.onset_vector.shape
        if (
            final.displacement.shape != (n, n_dim)
            or final.axial_stretch.shape != ()
            or n_states == 0
            or any(a.shape != (n_states,) for a in (final.growth_time, final.gi_closing, final.gi_hull))
            or onset not in ((0, n_dim), (n, n_dim))
            or final.onset_displacement.shape != onset
            or not np.isfinite(final.displacement).all()
        ):
            raise HistoryError(f"The final state of {self.key} does not fit its mesh.", _REDO)
        return final

    @property
    def points(self) -> FloatArray:
        """(n_points, n_dim) deformed coordinates x [mm] of the last state."""
        return self.mesh.points + self.final.displacement

    @property
    def contour(self) -> FloatArray:
        """(n_contour, n_dim) deformed outer contour, or points of the surface [mm], of the last state."""
        return self.points[self.mesh.contour]

    @property
    def interface(self) -> FloatArray:
        """(n_interface, n_dim) deformed points of the grey-white interface [mm] of the last state."""
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
    record = read_record(target) if re.fullmatch(r"[0-9a-f]{12}", key) else None
    if record is None:
        raise HistoryError(f"The study {folder} holds no complete run {shorten(key)!r}.", _REDO)
    return StoredPoint(target, record)
