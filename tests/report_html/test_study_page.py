"""What a browser makes of the report of a study: table, phase diagram, thumbnails, two runs side by side."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from gyrify.cli.app import main
from gyrify.config import Config
from gyrify.report.html.page_of_study import study_page
from gyrify.report.html.study_runs import last_frame
from gyrify.store.fields import fields
from gyrify.study import Study, final_state, read_results, run_study

DESIGN = {
    "kind": "grid",
    "parameter": [
        {"key": "growth.ratio", "values": [1.5, 12.0, 36.0]},
        {"key": "material.stiffness_ratio", "values": [0.5, 2.0]},
    ],
}
BASE = {
    "preset": "reference-slice",
    "mesh": {"n_around": 48, "n_layers": 6, "n_cortex_layers": 2},
    "solver": {"increments": 8},
    "growth": {"duration": 600.0},
}


def make_study(folder: Path, keep: str) -> Path:
    run_study(Study.from_mapping({"base": BASE, "design": DESIGN, "keep": keep}), folder, workers=1)
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_study(tmp_path_factory.mktemp("study") / "ratios", "final")


@pytest.fixture
def opened(browser, folder: Path):
    found = browser.open(study_page(folder, "<ratios>"), wait="Boolean(window.gyrify)")
    yield found
    assert found.errors == []
    assert len(found.requests) == 1


def column(opened, name: str) -> list[str]:
    """Texts of a column of the table, as shown."""
    heads = opened.page.locator("table.results thead th").all_inner_texts()
    place = next(k for k, head in enumerate(heads) if head.startswith(name))
    rows = "document.querySelectorAll('table.results tbody tr')"
    return opened.run(f"Array.from({rows}, (row) => row.children[{place}].innerText)")


def test_the_table_holds_the_results_and_sorts(opened, folder: Path) -> None:
    rows = read_results(folder).to_pylist()
    assert opened.page.locator("h1").inner_text() == "<ratios>"
    assert column(opened, "GI, closing") == [f"{row['gi_closing']:.3f}" for row in rows]
    assert column(opened, "run") == [row["key"] for row in rows]
    head = opened.page.get_by_role("button", name="GI, closing", exact=True)
    for order, is_falling in (("ascending", False), ("descending", True)):
        head.click()
        found = [float(text) for text in column(opened, "GI, closing")]
        assert found == sorted(found, reverse=is_falling)
        assert opened.page.locator(f"th[aria-sort={order}]").count() == 1


def test_the_filter_narrows_table_and_thumbnails(opened) -> None:
    assert opened.page.locator(".thumbnail").count() == 6
    opened.page.get_by_label("filter runs").fill("growth ratio 36")
    assert len(column(opened, "run")) == opened.page.locator(".thumbnail").count() == 2
    assert "2 of 6 runs" in opened.page.locator("body").inner_text()
    opened.page.get_by_label("filter runs").fill("no such run")
    assert column(opened, "run") == []


def test_the_phase_diagram_shows_every_point(opened, folder: Path) -> None:
    rows = read_results(folder).to_pylist()
    labels = opened.run(
        "[...document.querySelectorAll('.phase-mark')].map((m) => m.getAttribute('aria-label'))"
    )
    assert len(labels) == len(rows)
    for row in rows:
        told = f"growth ratio {row['growth.ratio']:g}, stiffness ratio {row['material.stiffness_ratio']:g}"
        assert any(told in label and f"{row['gi_closing']:.2f}" in label for label in labels)
    opened.page.get_by_label("quantity").select_option("n_gyri")
    assert "gyri" in opened.page.locator(".phase-mark").first.get_attribute("aria-label")


def test_warnings_and_unchecked_meshes_are_told_with_the_numbers(opened, folder: Path) -> None:
    rows = read_results(folder).to_pylist()
    said = [row["warnings"].splitlines() for row in rows]
    assert any(said)
    assert column(opened, "warnings") == [str(len(warnings)) for warnings in said]
    notice = opened.page.locator("details.notice")
    notice.locator("summary").click()
    assert f"{sum(map(bool, said))} of {len(rows)} runs have warnings" in notice.inner_text()
    counts = Counter(warning for warnings in said for warning in warnings)
    told = notice.locator("li").all_text_contents()
    assert all(f"{n} of 6 runs: {warning}" in told for warning, n in counts.items() if n > 1)
    assert len(told) == 13
    assert told[-1] == f"and {len(counts) - 12} more: open a run to see its own"
    assert opened.page.locator(".checked").inner_text() == "Meshes: 6 of 6 not checked."
    assert opened.page.get_by_label("quantity").input_value() == "gi_closing"
    opened.page.locator(".thumbnail").nth(3).click()
    opened.wait("Boolean(gyrify.panel)")
    dialog = opened.page.locator("dialog")
    assert dialog.locator(".checked").inner_text().startswith("Whether this mesh is converged is not known")
    shown = dialog.locator(".notice").all_text_contents()
    assert all(any(warning in text for text in shown) for warning in said[3])


def test_a_thumbnail_opens_its_run(opened, folder: Path) -> None:
    row = read_results(folder).to_pylist()[3]
    opened.page.locator(".thumbnail").nth(3).click()
    opened.wait("Boolean(gyrify.panel)")
    assert len(np.unique(opened.pixels().reshape(-1, 3), axis=0)) > 20
    point = final_state(folder, row["key"])
    (values,) = (v for field, v in last_frame(point).values.items() if field.name == "von_mises")
    centre = point.points[point.mesh.cells[10]].mean(axis=0)
    tip = opened.hover(*map(float, centre))
    assert "cell 10 " in tip
    shown = float(re.match(r"[\d.]+", tip).group())
    assert shown == pytest.approx(values[0, 10], abs=2e-3 * np.ptp(values))
    opened.page.keyboard.press("Escape")
    opened.wait("document.querySelector('dialog') === null")
    assert opened.page.locator("dialog").count() == 0


def test_two_runs_side_by_side(opened) -> None:
    button = opened.page.get_by_role("button", name="Show side by side")
    assert button.is_disabled()
    for place in (0, 5):
        opened.page.locator("table.results input[type=checkbox]").nth(place).click()
    button.click()
    opened.wait("Boolean(gyrify.pair) && gyrify.pair.every((v) => v.camera.width > 2)")
    limits = opened.run("gyrify.pair.map((v) => v.limits())")
    assert limits[0] == limits[1]
    opened.wait("Math.abs(gyrify.pair[0].camera.scale / gyrify.pair[1].camera.scale - 1) < 1e-3")
    box = opened.page.locator("dialog canvas").first.bounding_box()
    opened.page.mouse.move(box["x"] + 100, box["y"] + 100)
    opened.page.mouse.wheel(0, -200)
    first, second = opened.run("gyrify.pair.map((v) => [v.camera.x, v.camera.y, v.camera.scale])")
    assert first == pytest.approx(second)
    for text in ("0.5", "36"):
        assert text in opened.page.locator("table.differences").inner_text()


def test_the_last_frame_has_the_fields_of_the_run(tmp_path: Path) -> None:
    for changes in ({}, {"growth.out_of_plane": "generalised"}):
        base = Config.preset("reference-slice").with_overrides({**flat(BASE), **changes}).to_dict()
        one = {"kind": "list", "parameter": [{"key": "growth.ratio", "values": [12.0]}]}
        target = tmp_path / str(len(changes))
        run_study(Study.from_mapping({"base": base, "design": one, "keep": "all"}), target, workers=1)
        point = final_state(target, read_results(target)["key"][0].as_py())
        from gyrify.store import History

        history = History.load(point.folder)
        for field, rows in last_frame(point).values.items():
            stored = fields(history, -1, [field.name])[field.name]
            stored = stored if field.place == "cell" else stored[history.mesh.contour]
            assert np.allclose(rows[0], stored, rtol=1e-12, atol=1e-9)


def flat(tables: dict[str, object]) -> dict[str, object]:
    """Dotted keys."""
    return {f"{s}.{k}": v for s, group in tables.items() if isinstance(group, dict) for k, v in group.items()}


def test_runs_kept_whole_move_in_time(browser, tmp_path: Path) -> None:
    opened = browser.open(study_page(make_study(tmp_path / "s", "all"), "s"), wait="Boolean(window.gyrify)")
    opened.page.locator(".thumbnail").nth(5).click()
    opened.wait("Boolean(gyrify.panel)")
    late = opened.pixels()
    opened.seek(0)
    assert float((np.abs(late - opened.pixels()).max(axis=2) > 8).mean()) > 0.05
    assert opened.errors == []


def test_runs_that_did_not_complete_are_told(
    browser, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    base = {**BASE, "solver": {"increments": 8, "max_newton": 1, "min_increment": 0.1}}
    run_study(Study.from_mapping({"base": base, "design": DESIGN}), tmp_path / "s", workers=1)
    assert main(["report", str(tmp_path / "s"), "--out", str(tmp_path / "out.html")]) == 0
    assert "out.html" in capsys.readouterr().out
    page = (tmp_path / "out.html").read_text(encoding="utf-8")
    opened = browser.open(page, wait="Boolean(window.gyrify)")
    assert "6 of 6 runs did not complete" in opened.page.get_by_role("alert").inner_text()
    assert opened.page.locator(".phase-none").count() == 6
    opened.page.locator(".thumbnail").first.click()
    assert "failed" in opened.page.locator("dialog .notice.early").inner_text()
    assert opened.errors == []


def test_equal_studies_make_equal_pages(folder: Path) -> None:
    assert study_page(folder, "s") == study_page(folder, "s")
