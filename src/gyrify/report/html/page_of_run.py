"""The page of one run."""

from __future__ import annotations

from gyrify.config.plane_only import require_plane
from gyrify.report.html.assembly import RUN_SCRIPTS, page
from gyrify.report.html.colours import colour_maps
from gyrify.report.html.describe import about
from gyrify.report.html.frames import PLANS, frames_of, mode_shapes, packed_frames
from gyrify.report.html.series import plots
from gyrify.run.summary import summarise
from gyrify.store.history import History


def run_page(history: History, name: str) -> str:
    """Everything about a run in one HTML page.

    Parameters
    ----------
    history : History
        The run, complete or not.
    name : str
        What to call it; any text.

    Returns
    -------
    str
        HTML that needs no network and no other file; equal runs and names give equal pages.
    """
    require_plane(history.config, "A report")
    mesh, onset = history.mesh, history.onset
    mode = None if onset is None else mode_shapes(mesh, onset.displacement, onset.vector)
    header, payload = packed_frames(mesh, frames_of(history, PLANS[0][0]), mode)
    document = {
        "kind": "run",
        "colours": colour_maps(),
        "run": {**about(history, name, summarise(history)), "frames": header, "plots": plots(history)},
    }
    return page(document, {"payload-0": payload}, RUN_SCRIPTS)
