"""Text from names, files and configurations is shown as text; nothing of it runs, and nothing is loaded."""

from __future__ import annotations

import json

import pytest

from gyrify.config import Config
from gyrify.report.html import describe, run_page
from gyrify.report.html.assembly import safe_json
from gyrify.run.simulation import simulate
from gyrify.store import History

NAME = '<script>window.ran = 1</script>"><img src=x onerror="window.ran = 1">'
REASON = "</script><script>window.ran = 1</script><!-- ]]> \u2028 &lt;b&gt; ' onerror=window.ran=1"


@pytest.fixture(scope="module")
def hostile(tiny: Config) -> History:
    history = simulate(tiny)
    history.journal.set_meta(
        status="failed", reason=REASON, advice=NAME, versions=json.dumps({"<b>x</b>": NAME})
    )
    return history


def test_hostile_text_is_shown_and_does_not_run(
    browser, hostile: History, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(describe, "plain", lambda _: NAME)
    opened = browser.open(run_page(hostile, NAME))
    opened.run("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    page = opened.page
    assert page.locator("h1").inner_text() == NAME
    assert page.title() == f"{NAME} · gyrify"
    assert "window.ran = 1" in page.locator(".notice.early").inner_text()
    assert page.locator("table.settings .value").first.inner_text() == NAME
    assert "<b>x</b>" in page.locator("body").inner_text()
    assert opened.run("window.ran") is None
    assert opened.run("document.querySelectorAll('img, b, iframe, object').length") == 0
    assert opened.run("document.scripts.length") == 3, "document, payload, program"
    assert opened.errors == []
    assert len(opened.requests) == 1


def test_the_policy_lets_nothing_in(browser, hostile: History) -> None:
    opened = browser.open(run_page(hostile, "run"))
    refused = "(f) => { try { f(); return false; } catch { return true; } }"
    assert opened.run(f"({refused})(() => {{ document.body.innerHTML = '<b>x</b>'; }})")
    assert opened.run("fetch('data:text/plain,x').then(() => false, () => true)")
    assert (
        opened.run(
            "new Promise((done) => { const s = document.createElement('style'); "
            "s.textContent = 'h1 {color: red}';"
            "document.head.append(s); done(getComputedStyle(document.querySelector('h1')).color); })"
        )
        != "rgb(255, 0, 0)"
    )
    assert all(url.startswith(("file:", "data:")) for url in opened.requests)


def test_json_in_a_page_holds_no_markup() -> None:
    document = {"name": NAME, "reason": REASON, "lone": "\udcff", "amp": "&amp;"}
    text = safe_json(document)
    assert not set("<>&") & set(text)
    assert text.isascii()
    assert json.loads(text) == document


def test_a_failed_run_says_so_first(browser, hostile: History) -> None:
    opened = browser.open(run_page(hostile, "run"))
    early = opened.page.get_by_role("alert")
    assert "This run failed at 100 % of growth" in early.inner_text()
    top = early.bounding_box()["y"]
    assert top < opened.page.locator("canvas").bounding_box()["y"]
