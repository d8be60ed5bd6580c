"""The scoreboard and the ranking as HTML pages that need nothing but the pictures beside them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Final

from gyrify.paper.scoreboard import Scoreboard
from gyrify.report.paper_layout import LAYOUTS
from gyrify.report.paper_tables import FIRST, MARKS, SYMBOLS, by_first_rule, held, rule_told

_STYLE: Final = """
body { font: 15px/1.5 system-ui, sans-serif; color: #1f1f1f; max-width: 96rem;
  margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin-top: 2rem; }
p { max-width: 70rem; } table { border-collapse: collapse; width: 100%; font-size: 0.87rem; }
th, td { text-align: left; vertical-align: top; padding: 0.35rem 0.6rem; border-bottom: 1px solid #ddd; }
th { border-bottom: 2px solid #1f1f1f; }
td.pass { color: #005a8c; font-weight: 600; white-space: nowrap; }
td.fail { color: #b34700; font-weight: 600; white-space: nowrap; }
td.open { color: #595959; white-space: nowrap; }
figure { margin: 1.5rem 0; } img { max-width: 100%; } figcaption, .small { font-size: 0.87rem; color: #444; }
.scroll { overflow-x: auto; } td:nth-child(2) { min-width: 13rem; }
"""
_SIGNS: Final = {"pass": "✓ pass", "fail": "✗ fail", "open": "· open"}


def scoreboard_page(board: Scoreboard, figures: str = "figures") -> str:
    """The scoreboard, the sentences on what fails, the rules, and the figures.

    Parameters
    ----------
    board : Scoreboard
        What to show.
    figures : str
        Folder of the pictures, relative to the page.

    Returns
    -------
    str
        HTML.
    """
    rows = [
        (
            *(r.id, r.statement, r.paper, r.ours, MARKS[r.passed], by_first_rule(r), r.note),
            f"{rule_told(r)} ({r.where})",
        )
        for r in board.rows
    ]
    told = "Rule, and where the paper says so"
    names = ("", "The paper says", "Paper", "Ours", "", FIRST.capitalize(), "Note", told)
    pictures = (
        f'<figure id="{x.name}"><img src="{figures}/{x.name}.png" alt="{escape(x.caption)}">'
        f"<figcaption><b>{escape(x.name.replace('-', ' ').capitalize())}.</b> {escape(x.caption)} "
        f'<a href="{figures}/{x.name}.pdf">PDF</a></figcaption></figure>'
        for x in LAYOUTS
    )
    return page(
        "Wang, Yao and Hu (2019), reproduced",
        f"<p>Reading: {escape(board.reading)}. {escape(SYMBOLS)}</p><p><b>{escape(held(board))}</b></p>",
        html_table(names, rows),
        "<h2>Figures</h2>",
        *pictures,
    )


def html_table(names: Sequence[str], lines: Iterable[Sequence[object]]) -> str:
    """A table; cells that say pass, fail or open are marked."""
    head = "".join(f'<th scope="col">{escape(name)}</th>' for name in names)
    body = "\n".join("<tr>" + "".join(map(_cell, line)) + "</tr>" for line in lines)
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table></div>'


def page(title: str, *blocks: str) -> str:
    """A whole page."""
    body = "\n".join(blocks)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>\n'
        f'<meta name="viewport" content="width=device-width"><style>{_STYLE}</style></head>\n'
        f"<body><h1>{escape(title)}</h1>\n{body}\n</body></html>\n"
    )


def _cell(value: object) -> str:
    text = str(value)
    if text in _SIGNS:
        return f'<td class="{text}">{_SIGNS[text]}</td>'
    return f"<td>{escape(text)}</td>"
