"""What a browser makes of the report of a run: pictures, values, keys, themes."""

from __future__ import annotations

import re

import matplotlib as mpl
import numpy as np
import pytest
from reading import changed, check_value

from gyrify.report.html import run_page
from gyrify.report.html.shown_fields import SHOWN, scalar
from gyrify.store import History
from gyrify.store.fields import fields


@pytest.fixture(scope="module")
def text(folded: History) -> str:
    return run_page(folded, "a folded slice")


@pytest.fixture
def opened(browser, text):
    found = browser.open(text)
    yield found
    assert found.errors == []
    assert len(found.requests) == 1, "only the file itself"
    assert found.requests[0].startswith("file://")


def test_the_picture_follows_growth_and_field(opened) -> None:
    opened.choose("von_mises")
    late = opened.pixels()
    opened.seek(0)
    early = opened.pixels()
    assert changed(late, early) > 0.1
    pictures = []
    for name in ("region", "J", "von_mises", "mean_stress", "circumferential_stress"):
        opened.choose(name)
        opened.seek(20)
        pictures.append(opened.pixels())
    assert all(changed(a, b) > 0.02 for k, a in enumerate(pictures) for b in pictures[:k])
    for name in ("thickness", "curvature", "contact_force"):  # on a narrow band along the contour
        opened.choose(name)
        opened.seek(20)
        pictures.append(opened.pixels())
    assert all(changed(a, b) > 0.005 for k, a in enumerate(pictures[-3:]) for b in pictures[-3:][:k])


def test_cells_have_the_colour_of_their_value(opened, folded: History) -> None:
    opened.choose("J")
    values, mesh = fields(folded, -1, ["J"])["J"], folded.mesh
    low, high = opened.run("gyrify.panel.viewer.limits()")
    picture, x = opened.pixels(), folded.points()[mesh.cells]
    # The largest cells: their centres are far from edges and lines.
    edges = x - np.roll(x, 1, axis=1)
    sizes = np.abs(edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0])
    for cell in np.argsort(sizes)[-30:]:
        centre = x[cell].mean(axis=0)
        px, py = opened.on_screen(*centre)
        part = np.clip((values[cell] - low) / (high - low), 0.0, 1.0)
        expected = 255.0 * np.array(mpl.colormaps["viridis"](part)[:3])
        assert np.abs(picture[int(py), int(px)] - expected).max() < 6.0


@pytest.mark.parametrize("field", [field for field in SHOWN if field.place == "cell"], ids=lambda f: f.name)
def test_hover_tells_the_stored_value_of_cells(opened, folded: History, field, rng) -> None:
    opened.choose(field.name)
    indices, mesh = opened.run("gyrify.report.run.frames.indices"), folded.mesh
    for frame in (len(indices) - 1, len(indices) // 2):
        opened.seek(frame)
        values = fields(folded, indices[frame], [field.name])[field.name]
        x = folded.points(indices[frame])[mesh.cells].mean(axis=1)
        for cell in rng.choice(np.arange(mesh.n_cells // 2), 6):
            tip = opened.hover(*map(float, x[cell]))
            assert f"cell {cell} " in tip
            check_value(tip, values[cell], np.ptp(values))


@pytest.mark.parametrize(
    "field", [field for field in SHOWN if field.place == "contour"], ids=lambda f: f.name
)
def test_hover_tells_the_stored_value_of_contour_nodes(opened, folded: History, field, rng) -> None:
    opened.choose(field.name)
    indices, contour = opened.run("gyrify.report.run.frames.indices"), folded.mesh.contour
    for frame in (len(indices) - 1, len(indices) // 3):
        opened.seek(frame)
        values = scalar(fields(folded, indices[frame], [field.name])[field.name])[contour]
        x = folded.contour(indices[frame])
        for node in rng.choice(contour.size, 5):
            tip = opened.hover(*map(float, x[node]))
            found = int(re.search(r"contour node (\d+)", tip).group(1))
            # In closed sulci two nodes lie under the same pixel.
            place = int(np.flatnonzero(contour == found)[0])
            assert np.linalg.norm(x[place] - x[node]) < 0.5
            check_value(tip, values[place], np.ptp(values))


def test_off_the_tissue_there_is_no_value(opened) -> None:
    opened.choose("J")
    assert opened.hover(0.0, 0.0) == ""


def test_keys_move_and_play(opened) -> None:
    last = opened.run("gyrify.panel.player.frame")
    press = opened.page.keyboard.press
    for key, frame in (("ArrowLeft", last - 1), ("Home", 0), ("ArrowRight", 1), ("End", last)):
        press(key)
        assert opened.run("gyrify.panel.player.frame") == frame
    press(" ")
    assert opened.run("gyrify.panel.player.isPlaying")
    opened.wait("gyrify.panel.player.frame > 2")
    press(" ")
    assert not opened.run("gyrify.panel.player.isPlaying")
    opened.page.locator("canvas").focus()
    scale = opened.run("gyrify.panel.viewer.camera.scale")
    press("+")
    assert opened.run("gyrify.panel.viewer.camera.scale") == pytest.approx(1.25 * scale)
    press("0")
    assert opened.run("gyrify.panel.viewer.camera.scale") == pytest.approx(scale)


def test_everything_is_reached_by_tab_and_has_a_name(opened) -> None:
    names = []
    for _ in range(16):
        opened.page.keyboard.press("Tab")
        names.append(
            opened.run(
                "(() => { const e = document.activeElement; return e.getAttribute('aria-label') || "
                "(e.labels && e.labels.length ? e.labels[0].textContent : e.textContent); })()"
            )
        )
    for wanted in ("dark theme", "von Mises", "mesh", "zoom in", "play", "growth time", "Configuration"):
        assert wanted in names, names
    assert all(name.strip() for name in names)


def test_plots_follow_and_lead(opened, folded: History) -> None:
    marker = "Number(document.querySelector('.marker').getAttribute('x1'))"
    at_end = opened.run(marker)
    opened.seek(0)
    assert opened.run(marker) < at_end - 200
    box = opened.page.locator("svg.plot").first.bounding_box()
    middle = (46 + 304 / 2) / 360 * box["width"]
    opened.page.mouse.click(box["x"] + middle, box["y"] + box["height"] / 2)
    time = opened.run("gyrify.panel.model.times[gyrify.panel.player.frame]")
    assert time == pytest.approx(0.5 * folded.config.growth.duration, rel=0.06)
    assert opened.run("document.querySelectorAll('svg.plot').length") == 3


def test_pan_and_zoom_by_pointer(opened) -> None:
    before = opened.pixels()
    box = opened.page.locator("canvas").bounding_box()
    opened.page.mouse.move(box["x"] + 200, box["y"] + 200)
    opened.page.mouse.wheel(0, -300)
    zoomed = opened.pixels()
    assert changed(before, zoomed) > 0.05
    opened.page.mouse.down()
    opened.page.mouse.move(box["x"] + 300, box["y"] + 260, steps=3)
    opened.page.mouse.up()
    assert changed(zoomed, opened.pixels()) > 0.05


def test_critical_mode_is_drawn_where_there_is_one(opened, folded: History) -> None:
    assert folded.onset is not None
    before = opened.pixels()
    opened.page.get_by_label("critical mode", exact=True).click()
    opened.page.get_by_label("amplitude of the mode").fill("1")
    out = opened.pixels()
    opened.page.get_by_label("amplitude of the mode").fill("-1")
    assert changed(before, out) > 0.05
    assert changed(out, opened.pixels()) > 0.005
    said = opened.page.locator(".mode-bar").inner_text()
    assert f"{folded.onset.mode_number} waves" in said
    opened.seek(3)
    assert not opened.page.locator(".mode-bar").is_visible()


def test_dark_and_light(browser, text: str) -> None:
    background = "getComputedStyle(document.body).backgroundColor"
    dark = browser.open(text, color_scheme="dark")
    light = browser.open(text, color_scheme="light")
    assert dark.run(background) == "rgb(19, 20, 22)"
    assert light.run(background) == "rgb(247, 246, 243)"
    assert dark.pixels()[5, 5].tolist() == [27, 29, 32]
    dark.page.get_by_label("light theme").click()
    assert dark.run(background) == light.run(background)
    assert dark.pixels()[5, 5].tolist() == [255, 255, 255]


def test_numbers_and_settings_are_those_of_the_run(opened, folded: History) -> None:
    from gyrify.run.summary import summarise

    summary = summarise(folded)
    numbers = opened.page.locator(".numbers").inner_text()
    assert f"{summary['gi']['closing']:.3f}" in numbers
    checked = opened.page.locator(".checked")
    assert checked.is_visible()
    assert (
        checked.inner_text() == f"{summary['converged']['sentence']} Check: {summary['converged']['command']}"
    )
    opened.run("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    settings = opened.page.locator("table.settings").inner_text()
    assert re.search(r"mesh\.n_around\s+168", settings)
    assert re.search(r"geometry\.area\s+4069\.0\s+mm²", settings)
    whole = opened.page.locator("body").inner_text()
    for text in (
        summary["config_hash"],
        summary["versions"]["numpy"],
        "gyrify run config.toml --out 'a folded slice'",
    ):
        assert text in whole
    assert folded.config.to_toml().strip() in opened.page.locator("pre").nth(1).inner_text()
