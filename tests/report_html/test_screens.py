"""Reports as they are used: by finger and mouse, on small and wide screens, in light and dark, many runs."""

from __future__ import annotations

import re

import numpy as np
import pytest
from screens import IS_DRAWN, SCREENS

from gyrify.report.html import run_page
from gyrify.report.plot import plot
from gyrify.store import History

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
        px, py = opened.on_screen(x[0], x[1])
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
