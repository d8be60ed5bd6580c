"""Draw ``report*.png`` and ``space-report.png``: reports of runs and of a study, as Chromium shows them.

``python docs/figures/make_report.py`` simulates what it needs in a temporary folder (a few minutes); names of
pictures after it draw these alone.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, sync_playwright

from gyrify.config import Config
from gyrify.report.html import run_page, write_page
from gyrify.report.html.page_of_study import study_page
from gyrify.run.simulation import simulate
from gyrify.study import Study, run_study

HERE = Path(__file__).parent
ARGUMENTS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-sync", "--no-first-run"]
SIZE = {"width": 1360, "height": 900}
# As high as the panel of a body in space with all that is below its scene.
HEIGHTS = {"body.html": 1040}
STUDY: dict[str, Any] = {
    "base": {
        "preset": "reference-slice",
        "mesh": {"n_around": 160, "n_layers": 12, "n_cortex_layers": 5},
        "solver": {"increments": 40},
    },
    "design": {
        "kind": "grid",
        "parameter": [
            {"key": "growth.ratio", "values": [1.0, 2.0, 3.6, 12.0]},
            {"key": "material.stiffness_ratio", "values": [0.5, "1/1.36", 1.0, 2.0]},
        ],
    },
}
# The first brain of docs/space.md.
BODY: dict[str, Any] = {
    "geometry": {
        "shape": "ellipsoid",
        "semi_axes": [24.0, 20.0, 18.0],
        "hole_fraction": 0.0,
        "cortical_thickness": 3.0,
    },
    "mesh": {
        "edge_length": 3.3,
        "n_layers": 6,
        "n_cortex_layers": 2,
        "element": "mean_dilatation",
        "node_jitter": 0.02,
    },
    "growth": {"law": "area", "profile": "sigmoid", "rate": 0.0036, "ratio": 1e4},
    "material": {"stiffness_ratio": 3.0},
    "dissipation": {"number": 0.2},
    "solver": {"increments": 20},
    "stability": {"detect": False},
}
# File, page, colour scheme, what to do before the picture is taken, whether to take the whole page.
PICTURES = (
    ("report.png", "run", "light", "", False),
    (
        "report-dark.png",
        "run",
        "dark",
        "document.querySelector('input[value=circumferential_stress]').click()",
        False,
    ),
    ("report-mode.png", "run", "light", "document.querySelectorAll('.options input')[2].click()", False),
    ("report-study.png", "study", "light", "", True),
    (
        "report-side-by-side.png",
        "study",
        "light",
        "[8, 10].forEach((k) => document.querySelectorAll('table.results input')[k].click());"
        "Array.from(document.querySelectorAll('.plain'))[0].click()",
        False,
    ),
    (
        "space-report.png",
        "body",
        "light",
        "document.querySelector('input[value=region]').click();"
        "document.querySelector('.cut-bar input[value=x]').click()",
        False,
    ),
)


def main() -> None:
    """Write every picture."""
    program = shutil.which("chromium") or shutil.which("google-chrome")
    chosen = [picture for picture in PICTURES if picture[0] in (sys.argv[1:] or [picture[0]])]
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        folder = Path(name)
        for page in {picture[1] for picture in chosen}:
            write_page(_page(page, folder), folder / f"{page}.html")
        browser = playwright.chromium.launch(executable_path=program, args=ARGUMENTS)
        for file, page, scheme, action, is_whole in chosen:
            _take(browser, folder / f"{page}.html", HERE / file, scheme, action, is_whole)
        browser.close()


def _page(name: str, folder: Path) -> str:
    """A page, and what it needs."""
    if name == "study":
        run_study(Study.from_mapping(STUDY), folder / "study")
        return study_page(folder / "study", "growth and stiffness")
    if name == "body":
        return run_page(simulate(Config.from_dict(BODY)), "a small brain")
    return run_page(simulate(Config.preset("reference-slice")), "reference-slice")


def _take(browser: Browser, source: Path, target: Path, scheme: Any, action: str, is_whole: bool) -> None:
    # Without motion, so that the critical mode stands still at its largest.
    size: Any = {**SIZE, "height": HEIGHTS.get(source.name, SIZE["height"])}
    page = browser.new_page(viewport=size, color_scheme=scheme, reduced_motion="reduce")
    page.goto(source.as_uri())
    page.wait_for_timeout(1500)
    if action:
        page.evaluate(f"() => {{ {action} }}")
        page.wait_for_timeout(1500)
    page.screenshot(path=target, full_page=is_whole)
    page.close()


if __name__ == "__main__":
    main()
