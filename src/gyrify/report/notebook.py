"""How a run shows itself in a notebook, and what it becomes for pandas and PyVista, if these are there."""

from __future__ import annotations

import base64
import io
from html import escape
from typing import TYPE_CHECKING, Any

from gyrify.base.extras import require
from gyrify.metrics.quantities import Quantity, flat, shown_in
from gyrify.report.outputs import folded_picture
from gyrify.run.summary import metrics_rows, summarise
from gyrify.store.external import cell_type, padded
from gyrify.store.fields import fields
from gyrify.store.history import History
from gyrify.store.state_fields import POINT_FIELDS

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from pyvista import UnstructuredGrid

_DPI = 110
# The displacement of points that have moved by it already.
DONE = "displacement_done"


def html(history: History) -> str:
    """Picture of the last state and table of what the run came to, as one piece of HTML.

    Parameters
    ----------
    history : History
        The run, complete or not.

    Returns
    -------
    str
        HTML without scripts or links; everything in it is escaped.
    """
    summary = summarise(history)
    stream = io.BytesIO()
    folded_picture(history, summary).savefig(stream, format="png", dpi=_DPI)
    picture = base64.b64encode(stream.getvalue()).decode("ascii")
    rows = "".join(
        f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in _lines(summary)
    )
    return (
        '<div style="display: flex; flex-wrap: wrap; align-items: center; gap: 1em">'
        f'<img alt="The slice at the end of the run" src="data:image/png;base64,{picture}">'
        f"<table><caption>{escape(repr(history))}</caption>{rows}</table></div>"
    )


def plot(history: Any, what: str, **options: Any) -> Figure:
    """Draw a run, as `gyrify.plot` does."""
    from gyrify.report.plot import plot as draw

    return draw(history, what, **options)  # type: ignore[arg-type]


def to_dataframe(history: History) -> DataFrame:
    """Metrics of every state as a pandas table.

    Parameters
    ----------
    history : History
        The run, complete or not.

    Returns
    -------
    pandas.DataFrame
        The columns of ``metrics.csv``; the number of the increment is the index.

    Raises
    ------
    ConfigError
        If pandas is not installed.
    """
    return _library("pandas").DataFrame(metrics_rows(history)).set_index("increment")


def to_pyvista(history: History, index: int = -1, *, deformed: bool = True) -> UnstructuredGrid:
    """Return a state as a PyVista grid with all its fields.

    Parameters
    ----------
    history : History
        The run.
    index : int
        State; negative indices count from the end.
    deformed : bool
        Whether the points are the current ones, ready to be drawn. If not, they are those of the reference
        state, as in the files for ParaView, and ``displacement`` warps them to the current ones.

    Returns
    -------
    pyvista.UnstructuredGrid
        Points [mm], with z = 0 in the plane, and cells; vectors and tensors have three dimensions. Where the
        points are deformed already, the displacement is called ``displacement_done``, so that none warps them
        twice.

    Raises
    ------
    ConfigError
        If PyVista is not installed.
    HistoryError
        If there is no such state.
    """
    pyvista = _library("pyvista")
    x = history.points(index) if deformed else history.mesh.points
    cells = history.mesh.cells
    grid = pyvista.UnstructuredGrid({cell_type(history.mesh).vtk: cells}, padded(x))
    for name, values in fields(history, index).items():
        data = grid.point_data if name in POINT_FIELDS else grid.cell_data
        label = DONE if deformed and name == "displacement" else name
        data[label] = padded(values) if values.ndim == 2 else values.reshape(len(values), -1).squeeze()
    return grid


def _library(name: str) -> Any:
    return require(name, "notebook", "This")


def _lines(summary: dict[str, Any]) -> list[tuple[str, str]]:
    """What a summary says, for people: name with unit, and value."""
    values, solver = flat(summary), summary["solver"]
    return [
        ("status", " ".join(filter(None, (summary["status"], summary["reason"], summary["advice"])))),
        *(
            (_label(quantity, values), _number(values[quantity.key]))
            for quantity in shown_in("notebook", 2 if "gi_closing" in values else 3)
        ),
        ("mesh", summary["converged"]["sentence"]),
        *(("warning", sentence) for sentence in summary["warnings"]),
        ("growth time", _number(summary["growth_time"])),
        ("increments", str(solver["increments"])),
        ("time [s]", _number(solver["wall_s"])),
        ("configuration", summary["config_hash"][:12]),
        ("result", summary["result_hash"][:12]),
    ]


def _label(quantity: Quantity, values: dict[str, Any]) -> str:
    if quantity.key in ("gi_closing", "gi_area_closing"):
        return f"{quantity.label} of {values['gi_closing_radius_mm']:g} mm"
    return quantity.axis


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"
