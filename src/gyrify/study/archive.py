"""What a study keeps of a point: ``point.json``, and the final state with the course of the index.

``point.json`` is written last and holds the checksum of ``final.npz``, so that a point whose files are not
whole is none.
"""

from __future__ import annotations

import hashlib
import io
import json
import re
import struct
import tokenize
import zipfile
import zlib
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, Final, Self

import numpy as np
from numpy.typing import NDArray

from gyrify.config.words import shorten
from gyrify.errors import HistoryError
from gyrify.metrics.gyrification import index_of
from gyrify.run.body_measures import surface_of
from gyrify.run.onset.visible_time import visible_index
from gyrify.run.summary import measure_state
from gyrify.store.files import read_facts, refuse_link, whole_file
from gyrify.store.history import History

FORMAT: Final = 1
STATUSES: Final = ("completed", "failed", "stopped", "interrupted")
POINT: Final = "point.json"
FINAL: Final = "final.npz"
_UNREADABLE: Final = (
    OSError,
    ValueError,
    LookupError,
    TypeError,
    AttributeError,
    EOFError,
    SyntaxError,
    MemoryError,
    OverflowError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
    tokenize.TokenError,
    struct.error,
)
FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FinalState:
    """Arrays of a run that its tables and pictures are rebuilt from.

    Attributes
    ----------
    displacement : (n_points, n_dim) float array
        u of the last state [mm].
    axial_stretch : () float array
        Total F33 of the last state [-]; 1 in plane strain.
    growth_time : (n_states,) float array
        Growth time of every state [time].
    gi_closing, gi_hull : (n_states,) float arrays
        Gyrification index of every state, of areas in space [-].
    onset_displacement, onset_vector : (n_points, n_dim) float arrays
        State where stability was lost [mm], and the mode; of no points where it was not.
    """

    displacement: FloatArray
    axial_stretch: FloatArray
    growth_time: FloatArray
    gi_closing: FloatArray
    gi_hull: FloatArray
    onset_displacement: FloatArray
    onset_vector: FloatArray

    @classmethod
    def of(cls, history: History) -> Self:
        """Read them from a run."""
        onset, n, none = history.onset, history.mesh.n_points, np.zeros((0, history.mesh.n_dim))
        closing, hull = _indices(history)
        return cls(
            history.displacement(),
            np.array(history.axial_stretch()),
            history.growth_times,
            closing,
            hull,
            none if onset is None else np.asarray(onset.displacement)[:n],
            none if onset is None else np.asarray(onset.vector)[:n],
        )

    def to_bytes(self) -> bytes:
        """NumPy's ``.npz``; equal arrays give equal bytes."""
        buffer = io.BytesIO()
        np.savez(buffer, **{field.name: getattr(self, field.name) for field in fields(self)})
        return buffer.getvalue()

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read them back.

        Raises
        ------
        HistoryError
            If the file is missing or not what `to_bytes` gives.
        """
        try:
            _refuse_packed(path)
            with np.load(path, allow_pickle=False) as arrays:
                found = {field.name: np.asarray(arrays[field.name]) for field in fields(cls)}
        except _UNREADABLE as fault:
            raise HistoryError(
                f"{path} is damaged: {_told(fault)}.", "Run the study again to compute it again."
            ) from fault
        if any(array.dtype != np.float64 for array in found.values()):
            raise HistoryError(f"{path} holds no numbers.", "Run the study again to compute it again.")
        return cls(**found)


def _told(fault: Exception) -> str:
    """What went wrong, without the addresses that a library may show."""
    return shorten(re.sub(r"<[^>]*>", "…", " ".join(str(fault).split())), 120)


def _refuse_packed(path: Path) -> None:
    """Refuse compressed members: what is small on the disk is small in memory."""
    with zipfile.ZipFile(path) as archive:
        if any(member.compress_type != zipfile.ZIP_STORED for member in archive.infolist()):
            raise ValueError("it is compressed")


def _indices(history: History) -> tuple[FloatArray, FloatArray]:
    """Gyrification index of every state, by the closing and by the hull."""
    radius = history.config.metrics.closing_radius
    if history.mesh.n_dim == 3:
        return _indices_of_areas(history)
    if history.mesh.period is not None:
        states = [measure_state(history, index) for index in range(len(history))]
        return np.array([s.gi_closing for s in states]), np.array([s.gi_hull for s in states])
    contours = [history.contour(index) for index in range(len(history))]
    closing = [index_of(contour, "closing", radius) for contour in contours]
    return np.array(closing), np.array([index_of(contour, "hull", radius) for contour in contours])


def _indices_of_areas(history: History) -> tuple[FloatArray, FloatArray]:
    """The same in space; the closing takes a second, and is spared where nothing is folded by the hull."""
    mesh, chosen, last = history.mesh, history.config.metrics, measure_state(history)
    states = [history.points(index) for index in range(len(history) - 1)]
    surfaces = [surface_of(mesh, x, chosen) for x in states]
    hull = [surface.area / surface.hull_area for surface in surfaces]
    closing = [visible_index(mesh, x, chosen) for x in states]
    return np.array([*closing, last.gi_area_closing]), np.array([*hull, last.gi_area_hull])


@dataclass(frozen=True)
class Record:
    """What ``point.json`` says.

    Attributes
    ----------
    config_hash, solver_version : str
        What the point is known by.
    status, reason, advice : str
        How it ended.
    config : dict
        The configuration, nested.
    summary : dict or None
        As ``summary.json``; None where there is no state.
    final_sha256 : str
        Checksum of ``final.npz``; empty where there is no state.
    wall_s : float
        Time that the point took [s].
    """

    config_hash: str
    solver_version: str
    status: str
    reason: str
    advice: str
    config: dict[str, Any]
    summary: dict[str, Any] | None
    final_sha256: str
    wall_s: float


def write_record(folder: Path, record: Record, final: bytes) -> None:
    """Write the files of a point, each by atomic rename, ``point.json`` last."""
    refuse_link(folder)
    folder.mkdir(parents=True, exist_ok=True)
    if final:
        _write(folder / FINAL, final)
    else:
        (folder / FINAL).unlink(missing_ok=True)
    _write(folder / POINT, (json.dumps({"format": FORMAT, **asdict(record)}, indent=1) + "\n").encode())


def read_record(folder: Path, *, check: bool = True) -> Record | None:
    """Read a point; None where there is none, or its files are not whole.

    Parameters
    ----------
    folder : Path
        Folder of the point.
    check : bool
        Whether to recompute the checksum of its arrays.

    Returns
    -------
    Record or None
    """
    try:
        told = read_facts(folder / POINT)
        if told.pop("format") != FORMAT:
            return None
        record = Record(**told)
        if not _is_plausible(record):
            return None
        if check and record.final_sha256 != sha256(_read(folder / FINAL)):
            return None
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return record


def _is_plausible(record: Record) -> bool:
    """Whether every field has its type, and the status is one that there is."""
    texts = (record.config_hash, record.solver_version, record.reason, record.advice, record.final_sha256)
    return (
        all(isinstance(text, str) for text in texts)
        and record.status in STATUSES
        and isinstance(record.config, dict)
        and isinstance(record.summary, dict | None)
        and isinstance(record.wall_s, int | float)
    )


def begin_folder(folder: Path, config_hash: str, solver_version: str) -> None:
    """Say in a folder what is going to be computed, and with what."""
    refuse_link(folder)
    folder.mkdir(parents=True, exist_ok=True)
    begun = {"format": FORMAT, "begun": [config_hash, solver_version]}
    _write(folder / POINT, (json.dumps(begun) + "\n").encode())


def was_begun(folder: Path, config_hash: str, solver_version: str) -> bool:
    """Whether a folder holds a run of this configuration by this solver, ended or not."""
    try:
        told = read_facts(folder / POINT)
        return bool(
            told.get("begun", [told.get("config_hash"), told.get("solver_version")])
            == [config_hash, solver_version]
        )
    except (OSError, ValueError):
        return False


def sha256(data: bytes) -> str:
    """Checksum of data, hexadecimal; empty for none."""
    return hashlib.sha256(data).hexdigest() if data else ""


def _read(path: Path) -> bytes:
    return path.read_bytes() if path.exists() else b""


def _write(path: Path, data: bytes) -> None:
    with whole_file(path) as partial:
        partial.write_bytes(data)
