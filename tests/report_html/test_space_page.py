"""What a browser makes of the report of a body in space: it turns and is cut open, on any screen."""

from __future__ import annotations

import re

import matplotlib as mpl
import numpy as np
import pytest
from bodies_on_pages import AXES, VIEWER, cut, section, stored
from reading import changed
from screens import SCREENS

from gyrify.report.html import run_page
from gyrify.report.layout import COLOURS
from gyrify.store import History


@pytest.fixture(scope="module")
def text(lump: History) -> str:
    return run_page(lump, "a body")


@pytest.fixture
def opened(browser, text):
    found = browser.open(text)
    yield found
    assert found.errors == []
    assert len(found.requests) == 1, "only the file itself"
    assert found.requests[0].startswith("file://")


def drag(opened, dx: float, dy: float) -> None:
    box = opened.page.locator("canvas").bounding_box()
    mouse = opened.page.mouse
    mouse.move(box["x"] + 200, box["y"] + 200)
    mouse.down()
    mouse.move(box["x"] + 200 + dx, box["y"] + 200 + dy, steps=3)
    mouse.up()


# --- turning -------------------------------------------------------------------------------------


def test_a_drag_and_the_arrows_turn_it(opened) -> None:
    before = opened.pixels()
    azimuth = opened.run(f"{VIEWER}.camera.azimuth")
    drag(opened, 100, 0)
    assert opened.run(f"{VIEWER}.camera.azimuth") == pytest.approx(azimuth - 40.0)
    turned = opened.pixels()
    assert changed(before, turned) > 0.05
    opened.page.locator("canvas").focus()
    frame = opened.run("gyrify.panel.player.frame")
    for _ in range(3):
        opened.page.keyboard.press("ArrowRight")
    assert opened.run(f"{VIEWER}.camera.azimuth") == pytest.approx(azimuth - 62.5)
    assert opened.run("gyrify.panel.player.frame") == frame, "the arrows are the scene's here"
    assert changed(turned, opened.pixels()) > 0.02
    opened.page.keyboard.press("ArrowDown")
    assert opened.run(f"{VIEWER}.camera.elevation") > 22.0
    for _ in range(30):
        opened.page.keyboard.press("ArrowDown")
    assert opened.run(f"{VIEWER}.camera.elevation") == 90.0
    opened.page.locator("h1").click()
    opened.run("document.activeElement.blur()")
    opened.page.keyboard.press("ArrowLeft")
    assert opened.run("gyrify.panel.player.frame") == frame - 1


@pytest.mark.parametrize(
    ("view", "right", "up"), [("side", "x", "z"), ("above", "x", "y"), ("front", "y", "z")]
)
def test_it_is_seen_from_where_the_buttons_say(opened, view: str, right: str, up: str) -> None:
    opened.page.get_by_role("button", name=view, exact=True).click()
    origin = np.array(opened.on_screen(0, 0, 0))
    scale = opened.run(f"{VIEWER}.camera.scale")
    for axis, step in ((right, (1.0, 0.0)), (up, (0.0, -1.0))):
        unit = np.eye(3)[AXES.index(axis)]
        assert np.array(opened.on_screen(*unit)) - origin == pytest.approx(scale * np.array(step), abs=1e-9)


def test_the_scale_bar_is_true(opened) -> None:
    opened.page.get_by_role("button", name="side", exact=True).click()
    opened.pixels()
    said = float(opened.page.locator(".scale-bar").inner_text().split()[0])
    width = opened.page.locator(".scale-line").bounding_box()["width"]
    ends = [np.array(opened.on_screen(x, 0, 0)) for x in (0.0, said)]
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(width, abs=1.0)


def test_wheel_keys_and_fingers_zoom(browser, text: str) -> None:
    opened = browser.open(text, has_touch=True)
    before = opened.pixels()
    box = opened.page.locator("canvas").bounding_box()
    scale = opened.run(f"{VIEWER}.camera.scale")
    opened.page.mouse.move(box["x"] + 300, box["y"] + 200)
    opened.page.mouse.wheel(0, -300)
    opened.wait(f"{VIEWER}.camera.scale > {1.1 * scale}")
    assert changed(before, opened.pixels()) > 0.05
    opened.page.locator("canvas").focus()
    opened.page.keyboard.press("0")
    assert opened.run(f"{VIEWER}.camera.scale") == pytest.approx(scale)
    touch = opened.page.context.new_cdp_session(opened.page)
    for kind, apart in (("touchStart", 50), ("touchMove", 75), ("touchMove", 100)):
        points = [
            {"x": box["x"] + 300 + side * apart, "y": box["y"] + 200, "id": n}
            for n, side in enumerate((-1, 1))
        ]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    assert opened.run(f"{VIEWER}.camera.scale") == pytest.approx(2.0 * scale, rel=1e-3)
    assert opened.errors == []


# --- cutting -------------------------------------------------------------------------------------


@pytest.mark.parametrize("axis", AXES)
def test_a_cut_shows_grey_and_white_matter(opened, lump: History, axis: str) -> None:
    opened.choose("region")
    whole = opened.pixels()
    place = cut(opened, axis, 0.55)
    k = AXES.index(axis)
    low, high = opened.run(f"[{VIEWER}.model.bounds.low[{k}], {VIEWER}.model.bounds.high[{k}]]")
    assert place == pytest.approx(low + 0.55 * (high - low))
    assert f"{axis} = " in opened.page.locator(".cut-place").inner_text()
    picture = opened.pixels()
    assert changed(whole, picture) > 0.1
    middles, cells, _ = section(lump, k, place)
    tissue = [np.array(mpl.colors.to_rgb(COLOURS[name])) * 255 for name in ("white", "grey")]
    seen = set()
    for middle, cell in list(zip(middles, cells, strict=True))[:40]:
        px, py = opened.on_screen(*middle)
        region = int(lump.mesh.region[cell])
        assert np.abs(picture[int(py), int(px)] - tissue[region]).max() < 3.0
        seen.add(region)
    assert seen == {0, 1}
    # in the hole there is no tissue, but its wall
    origin = [0.0, 0.0, 0.0]
    origin[k] = place
    if abs(place) < 3.0:
        px, py = opened.on_screen(*origin)
        assert min(np.abs(picture[int(py), int(px)] - colour).max() for colour in tissue) > 3.0


def test_a_cut_has_the_colours_of_the_values(opened, lump: History) -> None:
    opened.choose("J")
    place = cut(opened, "x")
    values = stored(lump, -1, "J")
    low, high = opened.run(f"{VIEWER}.limits()")
    picture = opened.pixels()
    middles, cells, _ = section(lump, 0, place)
    for middle, cell in list(zip(middles, cells, strict=True))[:20]:
        px, py = opened.on_screen(*middle)
        part = np.clip((values[cell] - low) / (high - low), 0.0, 1.0)
        expected = 255.0 * np.array(mpl.colormaps["viridis"](part)[:3])
        assert np.abs(picture[int(py), int(px)] - expected).max() < 8.0


def test_the_cut_moves_with_its_slider(opened) -> None:
    cut(opened, "y", 0.4)
    before = opened.pixels()
    slider = opened.page.get_by_label("position of the cut")
    slider.focus()
    frame = opened.run("gyrify.panel.player.frame")
    for _ in range(100):
        opened.page.keyboard.press("ArrowRight")
    assert opened.run(f"Number({VIEWER}.bar.querySelector('input[type=range]').value)") == 500
    assert opened.run("gyrify.panel.player.frame") == frame
    assert changed(before, opened.pixels()) > 0.02
    opened.run("document.querySelector('.cut-bar input[value=whole]').click()")
    assert not slider.is_visible()


# --- the page ------------------------------------------------------------------------------------


def test_forces_and_energies_are_those_of_space(opened) -> None:
    opened.run("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    whole = opened.page.locator("body").inner_text()
    assert "Pa·mm²" in whole
    assert re.search(r"Energy mJ\s", whole)
    assert "mJ/mm" not in whole
    assert "slice" not in opened.page.locator(".hints").inner_text()


def test_everything_is_reached_by_tab_and_has_a_name(opened) -> None:
    opened.run("document.querySelector('.cut-bar input[value=x]').click()")
    opened.run("document.activeElement.blur()")
    names = []
    for _ in range(20):
        opened.page.keyboard.press("Tab")
        names.append(
            opened.run(
                "(() => { const e = document.activeElement; return e.getAttribute('aria-label') || "
                "(e.labels && e.labels.length ? e.labels[0].textContent : e.textContent); })()"
            )
        )
    wanted = (
        "dark theme",
        "von Mises",
        "mesh",
        "zoom in",
        "x",
        "position of the cut",
        "above",
        "play",
        "growth time",
    )
    assert [name for name in wanted if name not in names] == []
    assert all(name.strip() for name in names)
    label = opened.run(f"{VIEWER}.canvas.getAttribute('aria-label')")
    assert "Arrow keys turn, plus and minus zoom" in label


@pytest.mark.parametrize("screen", SCREENS)
def test_nothing_sticks_out_of_the_screen(browser, text: str, screen: str) -> None:
    opened = browser.open(text)
    width, height = SCREENS[screen]
    opened.page.set_viewport_size({"width": width, "height": height})
    cut(opened, "z")
    opened.pixels()
    assert opened.run("document.documentElement.scrollWidth") <= width
    assert opened.errors == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_and_dark(browser, text: str, scheme: str) -> None:
    opened = browser.open(text, color_scheme=scheme)
    corner = {"light": [255, 255, 255], "dark": [27, 29, 32]}[scheme]
    assert opened.pixels()[5, 5].tolist() == corner


def test_without_webgl_there_is_a_picture_and_a_reason(browser, text: str) -> None:
    context = browser._chromium.new_context
    script = (
        "const get = HTMLCanvasElement.prototype.getContext; HTMLCanvasElement.prototype.getContext = "
        "function (kind, ...more) { return kind === 'webgl2' ? null : get.call(this, kind, ...more); };"
    )

    def without(**options):
        found = context(**options)
        found.add_init_script(script)
        return found

    browser._chromium.new_context = without
    try:
        opened = browser.open(text)
    finally:
        browser._chromium.new_context = context
    assert "offers no WebGL 2" in opened.page.locator(".scene .notice").inner_text()
    opened.wait("document.querySelector('canvas.still').width > 400")
    pixels = "(() => { const c = document.querySelector('canvas.still'); const d = c.getContext('2d')"
    pixels += ".getImageData(0, 0, c.width, c.height).data; return new Set(d).size; })()"
    assert opened.run(pixels) > 20
    opened.page.keyboard.press("Home")
    assert opened.run("gyrify.panel.player.frame") == 0
    assert opened.errors == []
