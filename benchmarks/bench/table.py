"""The figures of a run as one table in the terminal."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

from bench.cases import CASES
from bench.figures import Figure, Figures


def number(value: float, unit: str = "") -> str:
    """A number to read: three digits, more for what is counted or has a meaning beyond them."""
    if unit in ("s", "ms", "us", "ns", "x", "%", "h", "MB"):
        return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"
    if float(value).is_integer():
        return f"{value:,.0f}".replace(",", " ")
    return f"{value:.4g}"


def text(figure: Figure) -> str:
    """Value with its unit, its quartiles, and whether it was extrapolated."""
    words = f"{'≈ ' if figure.is_extrapolated else ''}{number(figure.value, figure.unit)}"
    sign = {"x": " ×", "us": " µs", "": ""}.get(figure.unit, f" {figure.unit}")
    if figure.low is None or figure.high is None:
        return words + sign
    spread = f"{number(figure.low, figure.unit)}–{number(figure.high, figure.unit)}"
    return f"{words}{sign} ({spread})"


def show(found: dict[str, Figures], console: Console) -> None:
    """Print one table."""
    table = Table("", "value", "quartiles", title="gyrify benchmarks, one thread", title_justify="left")
    for case, figures in found.items():
        table.add_section()
        table.add_row(f"[bold]{CASES[case].title}[/bold] [dim]({case})[/dim]")
        for figure in figures:
            value, _, quartiles = text(figure).partition(" (")
            table.add_row(f"  {figure.name}", value, quartiles.rstrip(")"))
    console.print(table)
    console.print("≈: calculated from measured constants, not measured.")
