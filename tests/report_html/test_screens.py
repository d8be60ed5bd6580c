"""Reports as they are used: by finger and mouse, on small and wide screens, in light and dark, many runs."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

from gyrify.report.html import run_page
from gyrify.report.html.page import safe_json
from gyrify.report.html.study import study_page
from gyrify.report.plot import plot
from gyrify.store import History
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
SCREENS = {"phone": (390, 844), "desk": (1440, 900), "wide": (2560, 1440)}
IS_DRAWN = "Boolean(window.gyrify)"
# The smallest text on the page [px], as large as it is on the screen.
SMALLEST = """(() => {
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const host = walker.currentNode.parentElement;
    if (!walker.currentNode.textContent.trim() || !host.getClientRects().length) continue;
    if (['SCRIPT', 'STYLE', 'TITLE', 'NOSCRIPT', 'OPTION'].includes(host.tagName.toUpperCase())) continue;
    const svg = host.closest('svg');
    const wide = svg ? svg.viewBox.baseVal.width : 0;
    const scale = wide ? svg.getBoundingClientRect().width / wide : 1;
    found.push([parseFloat(getComputedStyle(host).fontSize) * scale, walker.currentNode.textContent]);
  }
  return found.sort((a, b) => a[0] - b[0])[0];
})()"""


@pytest.fixture(scope="module")
def text(folded: History) -> str:
    return run_page(folded, "a folded slice")


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp("study") / "ratios"
    run_study(Study.from_mapping({"base": BASE, "design": DESIGN}), folder, workers=1)
    return study_page(folder, "ratios")


@pytest.fixture(scope="module")
def many(study: str) -> str:
    """The page of 200 runs: those of the small study over and over, each under a name of its own."""
    data = re.search(r'id="document">(.*?)</script>', study, re.DOTALL)
    assert data is not None
    document = json.loads(data[1])
    runs = document["study"]["runs"]
    document["study"]["runs"] = [
        {**runs[k % len(runs)], "name": f"{k:012x}", "values": {**runs[k % len(runs)]["values"], "n_gyri": k}}
        for k in range(200)
    ]
    return study.replace(data[1], safe_json(document))


def contrast(a: np.ndarray, b: np.ndarray) -> float:
    """Ratio of contrast of two colours (WCAG): 1 for equal ones, 21 for black and white."""

    def luminance(colour: np.ndarray) -> float:
        c = np.asarray(colour, dtype=np.float64) / 255.0
        linear = np.where(c <= 0.03928, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


# --- the critical mode ---------------------------------------------------------------------------


def test_with_the_critical_mode_everything_says_what_the_scene_shows(
    browser, text: str, folded: History
) -> None:
    opened = browser.open(text)
    assert folded.onset is not None
    opened.choose("von_mises")
    opened.seek(3)
    before = opened.page.locator("output.time").inner_text()
    box = opened.page.get_by_label("critical mode", exact=True)
    box.click()
    assert opened.run("document.querySelector('.choice input:checked').value") == "region"
    opened.wait("document.querySelector('.bar-title').innerText === 'tissue'")
    time = opened.page.locator("output.time").inner_text()
    assert time.startswith("onset, t ")
    assert float(re.findall(r"[\d.]+", time)[0]) == pytest.approx(folded.onset.growth_time, rel=1e-3)
    part = opened.run("gyrify.panel.player.slider.value / gyrify.panel.player.slider.max")
    assert part == pytest.approx(
        np.interp(folded.onset.growth_time, folded.growth_times, np.linspace(0, 1, len(folded))), abs=1e-2
    )
    assert "critical mode at onset" in opened.run("gyrify.panel.viewer.canvas.getAttribute('aria-label')")
    box.click()
    assert opened.run("document.querySelector('.choice input:checked').value") == "von_mises"
    assert opened.page.locator("output.time").inner_text() == before
    assert opened.run("[gyrify.panel.player.frame, Number(gyrify.panel.player.slider.value)]") == [3, 3]
    box.click()
    opened.choose("J")  # another field leaves the mode
    assert not opened.page.locator(".mode-bar").is_visible()
    assert opened.run("document.querySelector('.choice input:checked').value") == "J"
    assert opened.page.locator("output.time").inner_text() == before
    assert opened.errors == []


def test_the_mode_fits_its_box_on_a_phone(browser, text: str) -> None:
    opened = browser.open(text)
    opened.page.set_viewport_size({"width": 390, "height": 844})
    opened.page.get_by_label("critical mode", exact=True).click()
    bar, slider = (opened.page.locator(place).bounding_box() for place in (".mode-bar", ".mode-bar input"))
    assert slider["x"] + slider["width"] <= bar["x"] + bar["width"]


# --- colours -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["von_mises", "mean_stress", "circumferential_stress"])
def test_the_colours_of_a_state_are_those_of_plot(browser, text: str, folded: History, name: str) -> None:
    opened = browser.open(text)
    opened.choose(name)
    opened.page.get_by_label("colours of this state").click()
    found = np.array(opened.run("gyrify.panel.viewer.limits()"))
    stress = {"von_mises": "von_mises", "mean_stress": "mean", "circumferential_stress": "circumferential"}[
        name
    ]
    drawn = plot(folded, "stress", stress=stress)
    np.testing.assert_allclose(found, 1e3 * np.array(drawn.axes[0].collections[0].get_clim()), rtol=1e-3)


def test_the_bar_is_pointed_where_values_lie_beyond_it(browser, text: str, folded: History) -> None:
    opened = browser.open(text)
    opened.choose("von_mises")
    (low, high), (least, most) = opened.run("[gyrify.panel.viewer.limits(), gyrify.panel.viewer.extremes()]")
    assert most > high
    assert opened.page.locator(".bar-tip.above").is_visible()
    assert opened.page.locator(".bar-tip.below").is_visible() == (least < low)
    opened.choose("mean_stress")
    opened.wait("document.querySelector('.bar-title').textContent.startsWith('mean')")
    (low, high), (least, most) = opened.run("[gyrify.panel.viewer.limits(), gyrify.panel.viewer.extremes()]")
    assert least < low
    assert opened.page.locator(".bar-tip.above").is_visible() == (most > high)
    assert opened.page.locator(".bar-tip.below").is_visible()
    opened.choose("growth_stretch")
    opened.wait("document.querySelector('.bar-title').textContent.startsWith('growth')")
    assert opened.page.locator(".bar-tip:visible").count() == 0
    from gyrify.store.fields import fields

    values = fields(folded, -1, ["von_mises"])["von_mises"]
    opened.page.get_by_label("colours of this state").click()
    opened.choose("von_mises")
    assert opened.run("gyrify.panel.viewer.extremes()") == pytest.approx([values.min(), values.max()])


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("field", ["region", "von_mises", "curvature"])
def test_the_contour_stands_out_from_the_page(browser, text: str, scheme: str, field: str) -> None:
    opened = browser.open(text, color_scheme=scheme)
    opened.choose(field)
    picture = opened.pixels()
    background = picture[3, 3]
    row = picture[picture.shape[0] // 2]
    edge = int(np.flatnonzero(np.abs(row - background).max(axis=1) > 30)[0])
    assert max(contrast(colour, background) for colour in row[edge : edge + 4]) > 4.5


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_curvature_is_seen(browser, text: str, scheme: str) -> None:
    opened = browser.open(text, color_scheme=scheme)
    opened.choose("curvature")
    picture = opened.pixels()
    redness = picture[..., 0] - picture[..., 2]
    strong = (np.abs(redness) > 60).sum()
    assert (redness > 60).sum() > 0.5 * strong  # crowns, most of the contour
    assert (redness < -60).sum() > 0  # sulci
    assert strong > 4000


# --- fingers -------------------------------------------------------------------------------------


def test_a_tap_shows_the_value_and_a_drag_does_not(browser, text: str, folded: History) -> None:
    opened = browser.open(text, has_touch=True)
    opened.page.set_viewport_size({"width": 390, "height": 844})
    opened.choose("J")
    canvas = opened.page.locator("canvas")
    canvas.scroll_into_view_if_needed()
    tip = opened.page.locator(".tooltip")
    for cell in (40, 900):
        x = folded.points()[folded.mesh.cells[cell]].mean(axis=0)
        px, py = opened.run(f"gyrify.panel.viewer.camera.toScreen({x[0]}, {x[1]})")
        box = canvas.bounding_box()
        opened.page.touchscreen.tap(box["x"] + px, box["y"] + py)
        opened.wait("!document.querySelector('.tooltip').hidden")
        assert re.search(r"cell \d+ ", tip.inner_text())
        found = tip.bounding_box()
        assert found["x"] >= box["x"] - 0.5
        assert found["x"] + found["width"] <= box["x"] + box["width"] + 0.5
    opened.page.locator("h1").scroll_into_view_if_needed()
    opened.page.touchscreen.tap(20, 20)
    opened.wait("document.querySelector('.tooltip').hidden")


def test_plots_let_a_finger_scroll_the_page(browser, text: str) -> None:
    opened = browser.open(text, has_touch=True)
    assert opened.run("getComputedStyle(document.querySelector('svg.plot')).touchAction") == "pan-y"


# --- text and lines ------------------------------------------------------------------------------


@pytest.mark.parametrize("screen", SCREENS)
@pytest.mark.parametrize("page", ["run", "study"])
def test_no_text_is_smaller_than_11_pixels(browser, text: str, study: str, screen: str, page: str) -> None:
    opened = browser.open(text if page == "run" else study, wait=IS_DRAWN)
    width, height = SCREENS[screen]
    opened.page.set_viewport_size({"width": width, "height": height})
    if page == "study":
        opened.page.locator(".thumbnail").first.click()
        opened.wait("Boolean(gyrify.panel)")
    opened.page.wait_for_timeout(200)
    size, where = opened.run(SMALLEST)
    assert size >= 11.0 - 1e-6, where


def test_the_lines_of_the_plots_have_a_legend(browser, text: str, folded: History) -> None:
    opened = browser.open(text)
    keys = opened.page.locator(".line-keys").inner_text()
    assert "growth time on view" in keys
    assert f"onset: stability lost at {folded.onset.growth_time:.4g}" in keys
    assert opened.page.locator(".line-keys .onset-key").count() == 1
    styles = [
        opened.run(f"getComputedStyle(document.querySelector('{line}')).strokeDasharray")
        for line in ("svg.plot .onset", ".onset-key")
    ]
    assert styles[0] == styles[1] != "none"


# --- studies -------------------------------------------------------------------------------------


def test_back_closes_what_was_opened_and_forward_opens_it_again(browser, study: str) -> None:
    opened = browser.open(study, wait=IS_DRAWN)
    page, dialogs = opened.page, "document.querySelectorAll('dialog').length"
    page.locator(".thumbnail").nth(1).click()
    opened.wait("Boolean(gyrify.panel)")
    name = page.locator("dialog h2").inner_text()
    page.go_back()
    opened.wait(f"{dialogs} === 0")
    assert page.locator("h1").inner_text() == "ratios"
    page.go_forward()
    opened.wait(f"{dialogs} === 1")
    assert page.locator("dialog h2").inner_text() == name
    page.keyboard.press("Escape")
    opened.wait(f"{dialogs} === 0 && location.hash === ''")
    page.locator(".thumbnail").nth(2).click()
    opened.wait(f"{dialogs} === 1")
    assert page.locator("dialog h2").inner_text() != name
    page.get_by_label("close").click()
    opened.wait(f"{dialogs} === 0 && location.hash === ''")
    for place in (0, 3):
        page.locator("table.results input[type=checkbox]").nth(place).click()
    page.get_by_role("button", name="Show side by side").click()
    opened.wait("Boolean(gyrify.pair)")
    page.go_back()
    opened.wait(f"{dialogs} === 0")
    assert opened.errors == []


def test_the_address_of_a_run_opens_it(browser, study: str) -> None:
    opened = browser.open(study, wait=IS_DRAWN)
    name = opened.run("gyrify.report.study.runs[2].name")
    opened.page.goto(f"{opened.page.url}#run={name}")
    opened.page.reload()
    opened.wait("document.querySelectorAll('dialog').length === 1")
    opened.page.keyboard.press("Escape")
    opened.wait("document.querySelectorAll('dialog').length === 0 && location.hash === ''")
    assert opened.page.locator("h1").inner_text() == "ratios"
    opened.page.goto(f"{opened.page.url.partition('#')[0]}#run=%E0%A4%A")  # no run, and no text
    assert opened.page.locator("dialog").count() == 0
    assert opened.errors == []


@pytest.mark.parametrize("screen", SCREENS)
def test_every_column_is_in_sight_or_said_to_be_further_right(browser, study: str, screen: str) -> None:
    opened = browser.open(study, wait=IS_DRAWN)
    width, height = SCREENS[screen]
    opened.page.set_viewport_size({"width": width, "height": height})
    opened.page.wait_for_timeout(200)
    heads = opened.page.locator("table.results thead th")
    assert heads.count() >= 14
    assert opened.run("document.documentElement.scrollWidth") == width
    last, hint = heads.last.bounding_box(), opened.page.locator(".scroll-hint")
    is_in_sight = last["x"] + last["width"] <= width
    assert is_in_sight or hint.is_visible()
    assert is_in_sight == (not hint.is_visible())
    assert is_in_sight or screen == "phone"
    if not is_in_sight:
        opened.run("document.querySelector('.scroll').scrollLeft = 1e5")
        opened.wait("document.querySelector('.scroll-hint').hidden")


def test_hundreds_of_runs_come_in_pages(browser, many: str) -> None:
    opened = browser.open(many, wait=IS_DRAWN)
    page = opened.page
    page.set_viewport_size({"width": 1440, "height": 900})
    rows, shapes = page.locator("table.results tbody tr"), page.locator(".thumbnail")
    assert opened.run("document.documentElement.scrollHeight") < 4000
    assert rows.count() == shapes.count() == 24
    pager = page.locator(".pager").first
    assert "1 to 24 of 200" in pager.inner_text()
    assert pager.get_by_label("previous runs").is_disabled()
    for _ in range(8):
        pager.get_by_label("next runs").click()
    assert "193 to 200 of 200" in pager.inner_text()
    assert rows.count() == shapes.count() == 8
    assert pager.get_by_label("next runs").is_disabled()
    page.get_by_role("button", name="gyri", exact=True).click()
    page.get_by_role("button", name="gyri", exact=True).click()
    assert "1 to 24 of 200" in pager.inner_text()  # sorted anew: from the first one
    assert rows.first.locator("th").inner_text() == f"{199:012x}"
    pager.get_by_label("runs on a page").select_option("all on one page")
    assert rows.count() == 200
    page.get_by_label("filter runs").fill("000000000007")
    assert rows.count() == 1
    assert not pager.is_visible()
    assert opened.errors == []
