"""Small tables of HTML, for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape


def html_rows(caption: str, rows: Iterable[Sequence[object]], head: Sequence[str] = ()) -> str:
    """Write a table whose first column names the rows; everything in it is escaped.

    Parameters
    ----------
    caption : str
        Title of the table.
    rows : iterable of sequences
        Cells of each row.
    head : sequence of str, optional
        Names of the columns.
    """
    top = "".join(f"<th>{escape(name)}</th>" for name in head)
    body = "".join(
        f"<tr><th>{escape(str(first))}</th>{''.join(f'<td>{escape(str(cell))}</td>' for cell in rest)}</tr>"
        for first, *rest in rows
    )
    return f"<table><caption>{escape(caption)}</caption>{f'<tr>{top}</tr>' if top else ''}{body}</table>"
