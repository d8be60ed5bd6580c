"""Code blocks of the README and the documentation, with the notes that stand before them.

A comment before a block says how it is tested, and nothing shows on the page:

- ``<!-- block: slow -->``: takes more than a few seconds; blocks that build on it are slow too.
- ``<!-- block: exits 3 -->``: the last command of the block ends with this code.
- ``<!-- block: file runs/first/summary.json -->``: a sample of this file; else of what was printed last.
- ``<!-- block: as shown: reason -->``: cannot be repeated; the reason is required.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt

ROOT = Path(__file__).parents[2]
_DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(_DOCS.glob("*.md")), *sorted((_DOCS / "api").glob("*.md"))]
# Directives of the site, which its build executes.
DIRECTIVES = {"{eval-rst}", "{include}", "{toctree}"}
LANGUAGES = {"sh", "python", "toml", "json", "csv", "text", "bibtex"}
_NOTE = re.compile(r"<!-- block: (.+?) -->", re.DOTALL)
_NOTES = re.compile(r"slow|exits \d+|file \S+|as shown: .{10,}", re.DOTALL)


@dataclass(frozen=True)
class Block:
    """One block of code.

    Attributes
    ----------
    page : Path
        Its page.
    line : int
        Line of the page that it begins at.
    language : str
        Language tag; empty if it has none.
    text : str
        What it holds.
    notes : tuple of str
        Notes before it.
    """

    page: Path
    line: int
    language: str
    text: str
    notes: tuple[str, ...] = ()

    @property
    def place(self) -> str:
        """Page and line."""
        return f"{self.page.relative_to(ROOT)}:{self.line}"

    @property
    def is_slow(self) -> bool:
        """Whether it is left to the slow tests."""
        return "slow" in self.notes

    @property
    def is_as_shown(self) -> bool:
        """Whether it cannot be repeated."""
        return any(note.startswith("as shown") for note in self.notes)

    def value(self, note: str) -> str | None:
        """What follows the word of a note, if there is such a note."""
        found = [own.removeprefix(note).strip() for own in self.notes if own.startswith(f"{note} ")]
        return found[0] if found else None


def blocks(page: Path) -> list[Block]:
    """All code blocks of a page, in order, those inside lists and quotes too."""
    found, notes = [], ()
    for token in MarkdownIt("commonmark").enable("table").parse(page.read_text(encoding="utf-8")):
        if token.type == "html_block":
            notes = tuple(" ".join(note.split()) for note in _NOTE.findall(token.content))
        elif token.type in ("fence", "code_block"):
            language = token.info.split()[0] if token.info.strip() else ""
            found.append(Block(page, (token.map or [0])[0] + 1, language, token.content, notes))
            notes = ()
        elif token.type not in ("inline",):
            notes = ()
    return found


def faults(block: Block) -> list[str]:
    """What is wrong with a block whatever it does: an unknown language or note."""
    wrong = []
    if block.language not in LANGUAGES | DIRECTIVES:
        wrong.append(f"{block.place}: language {block.language!r} is not one of {sorted(LANGUAGES)}")
    wrong += [f"{block.place}: unknown note {note!r}" for note in block.notes if not _NOTES.fullmatch(note)]
    return wrong
