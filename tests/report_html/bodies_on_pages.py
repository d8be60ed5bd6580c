"""What a page shows of a body in space, computed anew."""

from __future__ import annotations

from typing import Any

import numpy as np

from gyrify.report.html.shown_fields import scalar
from gyrify.report.surface_drawing import cut_cells
from gyrify.run.measuring import surface_depth
from gyrify.store import History
from gyrify.store.fields import fields

VIEWER = "gyrify.panel.viewer"
AXES = "xyz"


def stored(history: History, index: int, name: str) -> np.ndarray:
    """Values of a field as the page has them: of cells, or of the points of the surface."""
    if name == "depth":
        return surface_depth(history, index)
    found = scalar(fields(history, index, [name])[name])
    return found[history.mesh.contour] if found.size == history.mesh.n_points else found


def cut(opened: Any, axis: str, part: float = 0.5) -> float:
    """Cut the body open; the position of the plane [mm]."""
    opened.run(f"document.querySelector('.cut-bar input[value={axis}]').click()")
    opened.page.get_by_label("position of the cut").fill(str(round(1000 * part)))
    return float(opened.run(f"{VIEWER}.state.place"))


def section(history: History, axis: int, place: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Middles of the polygons of a section, from the largest on; their cells and sizes [mm, mm2]."""
    polygons, cells = cut_cells(history.points(), history.mesh.cells, axis, place)
    sizes = np.array([area(polygon) for polygon in polygons])
    order = np.argsort(-sizes)
    middles = np.array([np.insert(polygons[k].mean(axis=0), axis, place) for k in order])
    return middles, cells[order], sizes[order]


def area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
