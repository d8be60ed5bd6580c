"""A real browser that opens reports from files, or a reason why there is none."""

from __future__ import annotations

import base64
import io
import shutil
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from gyrify.report.html.page_of_study import study_page
from gyrify.study import Study, run_study

BASE = {
    "preset": "reference-slice",
    "mesh": {"n_around": 48, "n_layers": 6, "n_cortex_layers": 2},
    "solver": {"increments": 4},
    "growth": {"duration": 600.0},
}
DESIGN = {
    "kind": "grid",
    "parameter": [
        {"key": "growth.ratio", "values": [1.5, 36.0]},
        {"key": "material.stiffness_ratio", "values": [0.5, 2.0]},
        {"key": "geometry.cortical_thickness", "values": [1.5]},
        {"key": "dissipation.number", "values": [1.3, 2.6]},
    ],
}
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
ARGUMENTS = (
    "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
)


@dataclass
class Opened:
    """A report in the browser, and what went on there.

    Attributes
    ----------
    page : playwright.sync_api.Page
        The page.
    errors, requests : list of str
        Errors in the console or uncaught, and what was asked for.
    """

    page: Any
    errors: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def run(self, script: str) -> Any:
        """Value of a piece of JavaScript."""
        return self.page.evaluate(script)

    def wait(self, script: str, seconds: float = 20.0) -> None:
        """Wait for a condition; the page's policy forbids what the browser driver would do for it."""
        end = time.monotonic() + seconds
        while not self.run(script):
            assert time.monotonic() < end, f"{script} did not come true"
            time.sleep(0.02)

    def settle(self) -> None:
        """Wait until the scene has been told its size; before, its places on the screen mean nothing."""
        self.wait(
            "(({ camera, canvas }) => camera.width >= 2 && Math.abs(camera.width - canvas.clientWidth) < 1)"
            "(gyrify.panel.viewer)"
        )

    def on_screen(self, *place: float) -> tuple[float, float]:
        """Pixels (from the left and the top of the scene) of a point of the plane or of space."""
        self.settle()
        px, py = self.run(f"gyrify.panel.viewer.camera.toScreen(...{[float(x) for x in place]})")
        return px, py

    def pixels(self) -> NDArray[np.int64]:
        """(height, width, 3) colours of the scene, drawn now."""
        self.settle()
        script = "() => { const v = gyrify.panel.viewer; v.drawNow(true); return v.canvas.toDataURL(); }"
        png = base64.b64decode(self.run(script).split(",")[1])
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=np.int64)

    def choose(self, name: str) -> None:
        """Colour by a field."""
        self.run(f"document.querySelector('input[value={name}]').click()")

    def seek(self, frame: int) -> None:
        """Go to a frame."""
        self.run(f"gyrify.panel.player.seek({frame})")

    def hover(self, *place: float) -> str:
        """Text of the tooltip over a point of the plane or of space; empty where there is none."""
        px, py = self.on_screen(*place)
        self.run("gyrify.panel.viewer.canvas.scrollIntoView({ block: 'center' })")
        box = self.page.locator("canvas").bounding_box()
        self.page.mouse.move(box["x"] + px, box["y"] + py)
        tip = self.page.locator(".tooltip")
        return str(tip.inner_text()) if tip.is_visible() else ""


class Browser:
    """Opens reports, each in a profile of its own."""

    def __init__(self, chromium: Any, folder: Path) -> None:
        self._chromium, self._folder, self._contexts = chromium, folder, []

    def open(
        self, text: str, *, wait: str = "Boolean(window.gyrify && gyrify.panel)", **options: Any
    ) -> Opened:
        """Open a report from a file and wait until it is drawn."""
        file = self._folder / f"report-{len(self._contexts)}.html"
        file.write_text(text, encoding="utf-8")
        context = self._chromium.new_context(viewport={"width": 1280, "height": 900}, **options)
        self._contexts.append(context)
        opened = Opened(context.new_page())
        page = opened.page
        page.on("console", lambda m: opened.errors.append(m.text) if m.type == "error" else None)
        page.on("pageerror", lambda error: opened.errors.append(str(error)))
        page.on("request", lambda request: opened.requests.append(request.url))
        page.goto(file.as_uri())
        opened.wait(wait)
        return opened

    def close(self) -> None:
        """Close what was opened: pages that are left open go on drawing."""
        for context in self._contexts:
            context.close()


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    """Headless Chromium."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if path is None:
        pytest.skip(f"none of the browsers {', '.join(BROWSERS)} is installed")
    with playwright.sync_playwright() as running:
        browser = running.chromium.launch(executable_path=path, args=ARGUMENTS.split())
        yield browser
        browser.close()


@pytest.fixture
def browser(chromium: Any, tmp_path: Path) -> Iterator[Browser]:
    """Opens reports from a folder of the test's own."""
    found = Browser(chromium, tmp_path)
    yield found
    found.close()


@pytest.fixture(scope="session")
def study(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The page of a small study."""
    folder = tmp_path_factory.mktemp("study") / "ratios"
    run_study(Study.from_mapping({"base": BASE, "design": DESIGN}), folder, workers=1)
    return study_page(folder, "ratios")
