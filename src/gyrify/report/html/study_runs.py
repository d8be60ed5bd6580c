"""The runs of a study as its page shows them: outlines for all, and scenes while there is room."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import Any, Final

import numpy as np

from gyrify.errors import HistoryError
from gyrify.mesh import Mesh
from gyrify.model.slice import Slice
from gyrify.report.html.describe import subtitle
from gyrify.report.html.frames import ALL, Frames, frames_of, mode_shapes, packed_frames
from gyrify.report.html.shown_fields import chosen, scalar
from gyrify.report.study_data import Row
from gyrify.solve.types import FloatArray
from gyrify.store import History
from gyrify.store.fields import FieldMaker
from gyrify.study import StoredPoint, final_state

_FINAL_PLANS: Final = ((1, 4095), (1, 255))
_COURSE_PLANS: Final = ((26, 4095), (13, 1023), (7, 255), (2, 255))
# Contact depends on the state before too, which a study does not keep.
_OF_ONE_STATE: Final = tuple(name for name in ALL if name != "contact_force")
# Outlines are drawn small: whole numbers from 0 to this.
_OUTLINE_SIZE: Final = 1000


def described_run(folder: Path, row: Row, budget: int) -> tuple[dict[str, Any], str]:
    """A run of a study, and its arrays in base 64; none where it has no state, or the budget is 0.

    Parameters
    ----------
    folder : Path
        Study folder.
    row : mapping
        Its row of the results.
    budget : int
        Most bytes of its deflated arrays.

    Returns
    -------
    (dict, str)
    """
    about: dict[str, Any] = {key: row[key] for key in ("status", "reason", "advice")}
    about["warnings"] = warnings_of(row)
    about["mesh"] = None
    try:
        point = final_state(folder, row["key"])
        about |= {"subtitle": subtitle(point.config), "toml": point.config.to_toml()}
        about["duration"] = point.config.growth.duration
        in_space = point.mesh.n_dim == 3
        about["outline"] = None if in_space else outline(point.mesh, point.points)
    except HistoryError as fault:
        return {"subtitle": "", "toml": "", "outline": None, **about, "missing": str(fault)}, ""
    if found := point.summary.get("converged"):
        about["mesh"] = {key: found[key] for key in ("converged", "sentence", "command")}
    about |= {"onset": point.summary["onset"], "plots": _plots(point), "command": _command(point)}
    if in_space:
        about["missing"] = "A body in space is shown by its own report."
    if in_space or budget <= 0:
        return about, ""
    frames, plans = _frames(point)
    about["frames"], payload = packed_frames(point.mesh, frames, _mode(point), plans, budget)
    return about, payload


def warnings_of(row: Row) -> list[str]:
    """What a reader of a run's numbers must not overlook; results of old studies have none."""
    return str(row.get("warnings") or "").splitlines()


def outline(mesh: Mesh, points: FloatArray) -> dict[str, Any]:
    """Contour, interface and clamped side as whole numbers, y downwards, in a box as wide as the slice."""
    lines = {"contour": mesh.contour, "interface": mesh.interface, "clamped": mesh.clamped}
    together = np.concatenate([points[line] for line in lines.values()])
    low, high = together.min(axis=0), together.max(axis=0)
    scale = _OUTLINE_SIZE / float((high - low).max())
    shapes = {
        name: np.rint((points[line] - [low[0], high[1]]) * [scale, -scale]).astype(int).ravel().tolist()
        for name, line in lines.items()
    }
    size = np.rint((high - low) * scale).astype(int).tolist()
    return {**shapes, "size": size, "is_closed": mesh.period is None, "width_mm": float((high - low).max())}


def _frames(point: StoredPoint) -> tuple[Frames, tuple[tuple[int, int], ...]]:
    """States of a run that is kept whole, or its last one."""
    if (point.folder / "journal.sqlite").is_file():
        return frames_of(History.load(point.folder), _COURSE_PLANS[0][0]), _COURSE_PLANS
    return last_frame(point), _FINAL_PLANS


def last_frame(point: StoredPoint) -> Frames:
    """The last state of a run, with the fields that follow from it alone."""
    problem, final, mesh = Slice(point.config), point.final, point.mesh
    u = final.displacement
    if problem.has_axial_unknown:
        axial = (float(final.axial_stretch) - 1.0) * problem.axial_length
        u = np.concatenate([u, [[axial, 0.0]]])
    time = float(final.growth_time[-1])
    state = FieldMaker(problem).state(u, time / point.config.growth.duration, u)
    values = {}
    for field in chosen(_OF_ONE_STATE):
        if field.name == "depth":
            continue
        found = scalar(state[field.name])
        values[field] = (found if field.place == "cell" else found[mesh.contour])[None]
    return Frames([len(final.growth_time) - 1], final.growth_time[-1:], point.points[None], values)


def _mode(point: StoredPoint) -> tuple[FloatArray, FloatArray] | None:
    final = point.final
    if len(final.onset_vector) == 0:
        return None
    return mode_shapes(point.mesh, final.onset_displacement, final.onset_vector)


def _plots(point: StoredPoint) -> list[dict[str, Any]]:
    """Course of the gyrification index."""
    final = point.final
    lines = (("closing", final.gi_closing), ("hull", final.gi_hull))
    return [
        {
            "title": "Gyrification index",
            "unit": "",
            "times": final.growth_time.tolist(),
            "lines": [
                {"label": label, "values": [float(f"{v:.7g}") for v in values]} for label, values in lines
            ],
        }
    ]


def _command(point: StoredPoint) -> str:
    """How to see more of a run: from what is kept, or by running it again."""
    key = quote(point.key)
    if (point.folder / "journal.sqlite").is_file():
        return f"gyrify report runs/{key}"
    return f"gyrify run config.toml --out {key} && gyrify report {key}"
