"""Draw ``report*.png``: the reports of a standard run and of a study, as Chromium shows them.

``python docs/figures/make_report.py`` simulates what it needs in a temporary folder (about a minute).
"""

from __future__ import annotations

import shutil
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
)


def main() -> None:
    """Write every picture."""
    program = shutil.which("chromium") or shutil.which("google-chrome")
    with tempfile.TemporaryDirectory() as name, sync_playwright() as playwright:
        folder = Path(name)
        run = simulate(Config.preset("reference-slice"))
        write_page(run_page(run, "reference-slice"), folder / "run.html")
        run_study(Study.from_mapping(STUDY), folder / "study")
        write_page(study_page(folder / "study", "growth and stiffness"), folder / "study.html")
        browser = playwright.chromium.launch(executable_path=program, args=ARGUMENTS)
        for file, page, scheme, action, is_whole in PICTURES:
            _take(browser, folder / f"{page}.html", HERE / file, scheme, action, is_whole)
        browser.close()


def _take(browser: Browser, source: Path, target: Path, scheme: Any, action: str, is_whole: bool) -> None:
    # Without motion, so that the critical mode stands still at its largest.
    page = browser.new_page(viewport=SIZE, color_scheme=scheme, reduced_motion="reduce")
    page.goto(source.as_uri())
    page.wait_for_timeout(1500)
    if action:
        page.evaluate(f"() => {{ {action} }}")
        page.wait_for_timeout(1500)
    page.screenshot(path=target, full_page=is_whole)
    page.close()


if __name__ == "__main__":
    main()
