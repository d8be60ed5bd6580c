"""The states of a run that a page shows, with their fields, as deflated whole numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from gyrify.mesh import Mesh
from gyrify.report.html.packing import Coded, Payload, coded
from gyrify.report.html.shown_fields import SHOWN_IN_SPACE, ShownField, chosen, describe, scalar
from gyrify.report.html.space_mesh import space_mesh
from gyrify.run.measuring import surface_depth
from gyrify.solve.types import FloatArray
from gyrify.store.fields import FieldMaker
from gyrify.store.history import History

ALL: Final = tuple(field.name for field in SHOWN_IN_SPACE)
# Most states, and codes per value, to try in turn until the page is small enough.
PLANS: Final = ((51, 65535), (51, 4095), (34, 4095), (26, 1023), (21, 255), (13, 255))
# Bytes of the deflated arrays of one run; base 64 makes them a third larger.
BUDGET: Final = 2_000_000
# The same in space, where a run has ten times as many cells.
SPACE_PLANS: Final = ((51, 4095), (51, 1023), (51, 255), (34, 255), (26, 255), (18, 255), (13, 127))
SPACE_BUDGET: Final = 4_200_000
# Codes of the positions along an axis, in the plane and in space, where there are three times as many points.
_POSITION_CODES: Final = {2: 65535, 3: 16383}
Mode = tuple[FloatArray, FloatArray]
# Largest displacement of the critical mode as stored, over the width of the slice.
MODE_AMPLITUDE: Final = 0.03


@dataclass(frozen=True, eq=False)
class Frames:
    """Some states of a run.

    Attributes
    ----------
    indices : list of int
        Their numbers in the run.
    times : (n_frames,) float array
        Growth times [time].
    points : (n_frames, n_points, n_dim) float array
        Positions [mm].
    values : dict
        By field (n_frames, n_cells) or (n_frames, n_contour) values.
    """

    indices: list[int]
    times: FloatArray
    points: FloatArray
    values: dict[ShownField, FloatArray]

    def thinned(self, most: int) -> Frames:
        """At most so many of them."""
        keep = spread(len(self.indices), most)
        values = {field: rows[keep] for field, rows in self.values.items()}
        return Frames([self.indices[k] for k in keep], self.times[keep], self.points[keep], values)


def spread(n: int, most: int) -> list[int]:
    """At most ``most`` of the numbers below n: the first, the last, and evenly in between."""
    return sorted({int(k) for k in np.rint(np.linspace(0, n - 1, min(n, most)))})


def frames_of(history: History, most: int, names: Sequence[str] = ALL) -> Frames:
    """Evaluate at most so many states of a run again from its journal.

    Parameters
    ----------
    history : History
        The run.
    most : int
        Most states to take.
    names : sequence of str
        Fields wanted.

    Returns
    -------
    Frames
    """
    mesh, fractions, fields = history.mesh, history.fractions, chosen(names, history.mesh.n_dim)
    maker, indices = FieldMaker(history.slice), spread(len(history), most)
    points, values = [], {field: list[FloatArray]() for field in fields}
    for number in indices:
        u = history.state_vector(number)
        state = maker.state(u, float(fractions[number]), history.state_vector(max(number - 1, 0)))
        points.append(mesh.points + u[: mesh.n_points])
        for field, rows in values.items():
            if field.name == "depth":
                rows.append(surface_depth(history, number))
                continue
            found = scalar(state[field.name])
            rows.append(found if field.place == "cell" else found[mesh.contour])
    arrays = {field: np.array(rows) for field, rows in values.items()}
    return Frames(indices, history.growth_times[indices], np.array(points), arrays)


def packed_frames(
    mesh: Mesh,
    frames: Frames,
    mode: Mode | None,
    plans: Sequence[tuple[int, int]] = PLANS,
    budget: int = BUDGET,
) -> tuple[dict[str, Any], str]:
    """Frames as a page carries them: the first of the plans that fits the budget, or else the last.

    Parameters
    ----------
    mesh : Mesh
        The run's mesh.
    frames : Frames
        Its states.
    mode : (array, array), optional
        From `mode_shapes`.
    plans : sequence of (int, int)
        Most frames, and codes per value (precision).
    budget : int
        Most bytes of the deflated arrays.

    Returns
    -------
    (dict, str)
        What the arrays are, and the arrays in base 64.
    """
    for most, n_codes in plans:
        header, payload = _packed(mesh, frames.thinned(most), mode, n_codes)
        text = payload.text()
        if len(text) <= budget * 4 // 3:
            break
    return header, text


def mode_shapes(mesh: Mesh, displacement: FloatArray, vector: FloatArray) -> Mode:
    """The state that first lost stability, and the same displaced along its mode, (n_points, n_dim) [mm]."""
    x, v = mesh.points + displacement[: mesh.n_points], vector[: mesh.n_points]
    largest = float(np.linalg.norm(v[mesh.contour], axis=1).max())
    width = float(np.ptp(x[mesh.contour, 0]))
    return x, x + MODE_AMPLITUDE * width / largest * v if largest > 0.0 else x


def _packed(mesh: Mesh, frames: Frames, mode: Mode | None, n_codes: int) -> tuple[dict[str, Any], Payload]:
    payload = Payload()
    header = _mesh(mesh, payload) if mesh.n_dim == 2 else space_mesh(mesh, payload)
    header |= _positions(frames.points, mode, payload)
    header |= {
        "indices": frames.indices,
        "times": frames.times.tolist(),
        "fields": [_field(field, values, n_codes, payload) for field, values in frames.values.items()],
        "has_mode": mode is not None,
        "arrays": payload.entries,
    }
    return header, payload


def _mesh(mesh: Mesh, payload: Payload) -> dict[str, Any]:
    """Triangles to draw, tissue of the cells, and the lines, as numbers of points."""
    payload.add("triangles", mesh.triangles.astype(np.uint32), 1)
    payload.add("region", mesh.region.astype(np.uint16)[:, None], 1)
    for name, line in (("contour", mesh.contour), ("interface", mesh.interface), ("clamped", mesh.clamped)):
        payload.add(name, line.astype(np.uint32)[:, None], 1)
    start, after = mesh.points[mesh.contour[:2], 0]
    runs_right = mesh.period is not None and bool(after > start)
    return {
        "n_dim": 2,
        "n_points": mesh.n_points,
        "n_cells": mesh.n_cells,
        "triangles_per_cell": len(mesh.triangles) // mesh.n_cells,
        "period": mesh.period,
        # A ring's contour has the tissue on its left; that of a strip that runs to the right on its right.
        "inward": -1 if runs_right else 1,
    }


def _positions(points: FloatArray, mode: Mode | None, payload: Payload) -> dict[str, Any]:
    """Positions of all frames, then of the critical state without and with its mode, in one range."""
    extra = [] if mode is None else [mode[0][None], mode[1][None]]
    together = np.concatenate([points, *extra])
    low = together.min(axis=(0, 1))
    n_codes = _POSITION_CODES[points.shape[2]]
    codes: Coded = coded((together - low).reshape(1, -1), n_codes)
    rows = codes.codes.reshape(len(together), -1)
    payload.add("positions", rows[: len(points)], 2)
    if mode is not None:
        payload.add("mode", rows[len(points) :], 1)
    step = float(codes.step[0])
    return {"position": {"low": low.tolist(), "step": step, "codes": n_codes}}


def _field(field: ShownField, values: FloatArray, n_codes: int, payload: Payload) -> dict[str, Any]:
    if field.n_dim == 3:
        # over the range of all states: rows that follow each other then differ little, and take half the room
        whole = coded(values.reshape(1, -1), n_codes)
        ends = np.repeat(whole.low, len(values)), np.repeat(whole.step, len(values))
        codes = Coded(whole.codes.reshape(values.shape), *ends)
    else:
        codes = coded(values, n_codes)
    payload.add(field.name, codes.codes, 2)
    return describe(field, values) | {"low": codes.low.tolist(), "step": codes.step.tolist()}
