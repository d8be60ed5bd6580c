"""Writes docs/command-line.md from the commands themselves: `python docs/make_command_line.py`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from cyclopts import App

from gyrify.cli.app import app

PAGE = Path(__file__).parent / "command-line.md"
INTRODUCTION = """\
# Command line

<!-- Written from the commands by `python docs/make_command_line.py`; do not edit. -->

`gyrify COMMAND --help` prints the same. Numbers may be fractions, such as `1/1.36`. With `--json` exactly one
JSON document goes to stdout, and everything else to stderr.

| exit code | meaning |
|---|---|
| 0 | completed |
| 1 | a run or a check failed |
| 2 | usage or configuration |
| 3 | stopped by a limit; can be resumed |
| 130 | interrupted; can be resumed |
"""
_KINDS = {"STR": "VALUE", "INT": "N", "CHOICE": "WORD"}
_ITEM = re.compile(r"^\* `(?P<names>[^`]+)`: ?(?P<text>.*)$")


def commands(parent: App, before: str = "gyrify") -> Iterator[tuple[str, App]]:
    """Every command with its full name, those of groups in place of the group."""
    for name in parent:
        if name.startswith("-"):
            continue
        child, full = parent[name], f"{before} {name}"
        own = [inner for inner in child if not inner.startswith("-")]
        if own:
            yield from commands(child, full)
        else:
            yield full, child


def section(name: str, command: App) -> str:
    """One command: what it does, its arguments and options."""
    text = re.sub(r"\n {2,}(?=\S)", " ", command.generate_docs(output_format="markdown"))
    about = text.split("```")[2].split("**")[0].strip()
    rows = [_row(match) for match in map(_ITEM.match, text.splitlines()) if match]
    table = ["| argument or option | what it is |", "|---|---|", *rows] if rows else []
    return "\n".join([f"## {name}", "", " ".join(about.split()), *([""] if rows else []), *table, ""])


def _row(match: re.Match[str]) -> str:
    """Row of one option; switches have no negative form, and defaults stand in the text."""
    names = re.sub(r", --(?:no|empty)-[\w-]+", "", match["names"]).replace("STR...", "KEY=VALUE")
    names = re.sub(r"\b(STR|INT|CHOICE)\b(?!=)", lambda kind: _KINDS[kind[0]], names)
    choices = re.search(r"\*?\[choices: ([^\]]*)\]\*?", match["text"])
    about = re.sub(r"\s*\*+\[[^\]]*\]\*+", "", match["text"]).replace("|", "\\|")
    listed = f" One of {', '.join(f'`{c.strip()}`' for c in choices[1].split(','))}." if choices else ""
    return f"| `{names}` | {about}{listed} |"


def page() -> str:
    """The whole page."""
    return "\n".join([INTRODUCTION, *(section(*found) for found in commands(app))]).rstrip() + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
