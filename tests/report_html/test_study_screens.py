"""Reports of studies as they are used: back and forward, wide tables, hundreds of runs."""

from __future__ import annotations

import json
import re

import pytest
from screens import IS_DRAWN, SCREENS

from gyrify.report.html.assembly import safe_json


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
