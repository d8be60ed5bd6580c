"""Assembly of a page: one HTML file with its styles, its scripts and its data, and leave for nothing else.

Data are JSON in which no character can end the element that holds them; scripts put them on the page as text
only. The page's own policy lets a browser run the scripts and styles of these digests, and load nothing.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from gyrify.store.disk_faults import storage_faults
from gyrify.store.files import whole_file

STYLES: Final = ("base.css", "viewer.css", "sections.css", "study.css")
_SHARED: Final = (
    "dom.js",
    "numbers.js",
    "payload.js",
    "values.js",
    "colour.js",
    "glass.js",
    "camera-moves.js",
    "stage.js",
    "overlays.js",
    "pointer.js",
    "player.js",
    "controls.js",
    "plots.js",
    "panel.js",
    "theme.js",
)
# Both have the functions by which the rest knows a scene: loadModel, createCamera, createPainter,
# createViewer, probe.
_PLANE: Final = ("model.js", "webgl.js", "lines.js", "camera.js", "pick.js", "viewer.js")
_SPACE: Final = (
    "space-model.js",
    "space-webgl.js",
    "space-camera.js",
    "space-cut.js",
    "space-pick.js",
    "space-controls.js",
    "space-viewer.js",
)
RUN_SCRIPTS: Final = (*_SHARED, *_PLANE, "tables.js", "run.js")
SPACE_SCRIPTS: Final = (*_SHARED, *_SPACE, "tables.js", "run.js")
STUDY_SCRIPTS: Final = (
    *_SHARED,
    *_PLANE,
    "tables.js",
    "study-outline.js",
    "study-table.js",
    "study-phase.js",
    "study-open.js",
    "study-compare.js",
    "study-routes.js",
    "study.js",
)
# Characters with a meaning in HTML, and those that end a line in old JavaScript.
_ESCAPES: Final = {ord(c): f"\\u{ord(c):04x}" for c in "<>&\u2028\u2029"}


def page(document: Mapping[str, Any], payloads: Mapping[str, str], scripts: Sequence[str]) -> str:
    """Return a page.

    Parameters
    ----------
    document : mapping
        What the scripts read; any text in it is shown as text.
    payloads : mapping
        Arrays in base 64 by the ``id`` of their element.
    scripts : sequence of str
        Files of the scripts, in order.

    Returns
    -------
    str
        HTML.
    """
    style = _joined("css", STYLES)
    script = '(() => {\n"use strict";\n' + _joined("js", scripts) + "})();\n"
    policy = (
        f"default-src 'none'; script-src '{_digest(script)}'; style-src '{_digest(style)}'; "
        "base-uri 'none'; form-action 'none'; require-trusted-types-for 'script'; trusted-types 'none'"
    )
    data = "".join(
        f'<script type="text/plain" id="{key}">{text}</script>\n' for key, text in payloads.items()
    )
    template = files("gyrify.report.html").joinpath("page.html").read_text(encoding="utf-8")
    parts = {
        "POLICY": policy,
        "STYLE": style,
        "DOCUMENT": safe_json(document),
        "DATA": data,
        "SCRIPT": script,
    }
    pieces = template.split("@@")
    return "".join(parts[piece] if number % 2 else piece for number, piece in enumerate(pieces))


def safe_json(document: Mapping[str, Any]) -> str:
    """JSON that may stand in an HTML element: pure ASCII, without ``<``, ``>`` and ``&``."""
    return json.dumps(document, ensure_ascii=True, allow_nan=False, separators=(",", ":")).translate(_ESCAPES)


def write_page(text: str, path: Path) -> None:
    """Write a page by atomic rename.

    Raises
    ------
    HistoryError
        If the file cannot be written.
    """
    with storage_faults(path.parent, str(path)), whole_file(path) as partial:
        partial.write_text(text, encoding="utf-8", newline="\n")


def _joined(folder: str, names: Iterable[str]) -> str:
    home = files("gyrify.report.html").joinpath(folder)
    return "\n".join(home.joinpath(name).read_text(encoding="utf-8") for name in names)


def _digest(text: str) -> str:
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode("ascii")
