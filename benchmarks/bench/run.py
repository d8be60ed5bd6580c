"""Runs benchmarks, shows their figures, and adds them to the history."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console

from bench.cases import CASES
from bench.figures import Figures, append, record
from bench.table import show


def run(names: Sequence[str], *, quick: bool, keep: bool) -> int:
    """Measure, print one table, and append one record; 1 if a benchmark failed."""
    console = Console()
    found: dict[str, Figures] = {}
    failed = False
    for name in names:
        console.print(f"[dim]{name}: {CASES[name].title}[/dim]")
        try:
            found[name] = CASES[name].measure(quick)
        except Exception as error:  # the others still count
            console.print(f"[red]{name} failed: {error}[/red]")
            failed = True
    show(found, console)
    if keep and found:
        append(record(found, quick=quick))
    return 1 if failed else 0
