"""Links, pictures and the navigation of the documentation lead somewhere."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from blocks import PAGES, ROOT
from markdown_it import MarkdownIt
from markdown_it.token import Token

FIGURES = ROOT / "docs" / "figures"
SCRIPTS = [*FIGURES.glob("*.py"), *(ROOT / "benchmarks").rglob("*.py"), *(ROOT / "src").rglob("*.py")]


def targets(page: Path) -> list[tuple[str, str]]:
    """Kind (``a`` or ``img``) and target of every link and picture of a page."""
    return [*_targets(MarkdownIt("commonmark").enable("table").parse(page.read_text(encoding="utf-8")))]


def _targets(tokens: list[Token]) -> Iterator[tuple[str, str]]:
    for token in tokens:
        if token.type in ("link_open", "image"):
            yield token.tag, str(token.attrGet("href") or token.attrGet("src"))
        yield from _targets(token.children or [])


def anchors(page: Path) -> set[str]:
    """Anchors of the headings of a page, as GitHub and the site make them."""
    headings = re.findall(r"^#{1,6} (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_relative_links_resolve(page: Path) -> None:
    broken = []
    for _, target in targets(page):
        path, _, anchor = target.partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        file = (page.parent / path).resolve() if path else page
        if not file.is_file() or (anchor and anchor not in anchors(file)):
            broken.append(target)
    assert not broken


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_outside_links_are_encrypted(page: Path) -> None:
    assert [target for _, target in targets(page) if target.startswith("http:")] == []


def test_every_figure_is_used_and_made_by_a_script() -> None:
    shown = {
        (page.parent / target).resolve() for page in PAGES for kind, target in targets(page) if kind == "img"
    }
    sources = "\n".join(script.read_text(encoding="utf-8") for script in SCRIPTS)
    figures = [path for path in FIGURES.iterdir() if path.suffix in (".png", ".svg", ".gif")]
    assert len(figures) > 20
    assert [path.name for path in figures if path.resolve() not in shown] == []
    assert [path.name for path in figures if not _is_made(path.stem, sources)] == []


def _is_made(stem: str, sources: str) -> bool:
    """Whether a script names the figure, or the parts that it joins to the name (a word, or a function)."""
    first, _, rest = stem.partition("-")
    joined = re.search(rf'f"{first}-{{[\w.]+}}', sources) is not None and (
        f'"{rest}"' in sources or f"def {rest}(" in sources
    )
    return f'"{stem}' in sources or f"{stem}.png" in sources or joined


def test_every_page_is_in_the_navigation() -> None:
    pages = ("index.md", "api.md")
    index = "\n".join((ROOT / "docs" / name).read_text(encoding="utf-8") for name in pages)
    listed = {
        line for block in re.findall(r"```{toctree}\n(.*?)```", index, re.DOTALL) for line in block.split()
    }
    written = {str(page.relative_to(ROOT / "docs").with_suffix("")) for page in PAGES[1:]} - {"index"}
    assert written - listed == set()


def test_a_missing_target_is_noticed(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("# One, two\n\n[a](#one-two) [b](absent.md) ![c](absent.png)\n")
    assert targets(page) == [("a", "#one-two"), ("a", "absent.md"), ("img", "absent.png")]
    assert anchors(page) == {"one-two"}
