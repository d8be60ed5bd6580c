"""The page of one run."""

from __future__ import annotations

import base64
from io import BytesIO
from typing import Any, Final

from gyrify.report.html.assembly import RUN_SCRIPTS, SPACE_SCRIPTS, page
from gyrify.report.html.colours import colour_maps
from gyrify.report.html.describe import about
from gyrify.report.html.frames import (
    BUDGET,
    PLANS,
    SPACE_BUDGET,
    SPACE_PLANS,
    frames_of,
    mode_shapes,
    packed_frames,
)
from gyrify.report.html.series import plots
from gyrify.report.outputs import folded_picture
from gyrify.run.summary import summarise
from gyrify.store.history import History

# Of the picture: as sharp as a page shows it, in so few colours that it takes little room.
_DPI: Final = 110
_COLOURS: Final = 96


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
    mesh, onset, summary = history.mesh, history.onset, summarise(history)
    in_space = mesh.n_dim == 3
    mode = None if onset is None else mode_shapes(mesh, onset.displacement, onset.vector)
    room = (SPACE_PLANS, SPACE_BUDGET) if in_space else (PLANS, BUDGET)
    header, payload = packed_frames(mesh, frames_of(history, room[0][0][0]), mode, *room)
    document = {
        "kind": "run",
        "colours": colour_maps(),
        "run": {**about(history, name, summary), "frames": header, "plots": plots(history)},
    }
    payloads = {"payload-0": payload}
    if in_space:
        payloads["picture"] = _picture(history, summary)
    return page(document, payloads, SPACE_SCRIPTS if in_space else RUN_SCRIPTS)


def _picture(history: History, summary: dict[str, Any]) -> str:
    """``folded.png`` in base 64, for browsers that cannot draw the scene."""
    from PIL import Image

    drawn, stream = BytesIO(), BytesIO()
    folded_picture(history, summary).savefig(drawn, format="png", dpi=_DPI, metadata={"Software": None})
    few = Image.open(drawn).convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    few.save(stream, format="PNG", optimize=True)
    return base64.b64encode(stream.getvalue()).decode("ascii")
