"""Draws the pictures and prints the tables of docs/elements.md: `python docs/figures/make_elements.py`.

The numbers come from elements.json, which elements_data.py computes.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "tests" / "convergence"))

import cook  # noqa: E402

from gyrify.physics.materials.neo_hookean import lame_parameters  # noqa: E402

DATA: dict[str, Any] = json.loads((HERE / "elements.json").read_text(encoding="utf-8"))
ELEMENTS = {"linear": "linear", "mean_dilatation": "mean dilatation", "quadratic": "quadratic"}
# Okabe and Ito's colours, told apart by every common colour vision; markers tell them apart too.
STYLE = {"linear": ("#0072B2", "o"), "mean_dilatation": ("#009E73", "^"), "quadratic": ("#D55E00", "s")}


def axes_of(columns: int, rows: int = 1, height: float = 3.7) -> tuple[Figure, list[Axes]]:
    """A figure of panels, row by row."""
    figure = Figure(figsize=(4.1 * columns, height * rows), layout="constrained")
    found = list(figure.subplots(rows, columns, squeeze=False).ravel())
    for axes in found:
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(True, which="both", color="0.93", linewidth=0.7)
        axes.set_axisbelow(True)
    return figure, found


def slope_triangle(axes: Axes, x: np.ndarray, y: np.ndarray, order: int, above: bool) -> None:
    """A right triangle of a slope under, or above, the last two points of a curve."""
    right = 10 ** (0.9 * np.log10(x[-1]) + 0.1 * np.log10(x[-2]))
    left = right / 1.7
    if above:
        low = 1.5 * float(np.exp(np.interp(np.log(right), np.log(x), np.log(y))))
        low = max(low, 1.5 * float(np.exp(np.interp(np.log(left), np.log(x), np.log(y)))) / 1.7**order)
        corner, side, align = (right, low * 1.7**order), right * 1.05, "left"
    else:
        low = 0.55 * float(np.exp(np.interp(np.log(right), np.log(x), np.log(y))))
        corner, side, align = (left, low), left / 1.05, "right"
    high = low * 1.7**order
    axes.fill(
        [left, right, corner[0]], [high, low, corner[1]], facecolor="none", edgecolor="0.35", linewidth=0.9
    )
    axes.text(side, np.sqrt(low * high), str(order), ha=align, va="center", fontsize=9, color="0.35")


def curves(axes: Axes, rows: dict[str, Any], column: int, orders: tuple[int, int]) -> None:
    """Error over the nodes in one direction, of every element."""
    for element, label in ELEMENTS.items():
        colour, marker = STYLE[element]
        table = np.array(rows[element])
        x, y = np.sqrt(table[:, 0]), table[:, column]
        axes.loglog(x, y, marker=marker, color=colour, label=label, markersize=5)
        if element != "mean_dilatation":
            slope_triangle(axes, x, y, orders[element == "quadratic"], above=element == "linear")
    ticks_at(axes, np.sqrt(np.array(rows["quadratic"])[:, 0]))
    axes.set_xlabel("square root of the number of nodes")


def ticks_at(axes: Axes, places: np.ndarray) -> None:
    """Label the levels instead of powers of ten."""
    axes.set_xticks(places, [f"{place:.0f}" for place in places])
    axes.xaxis.set_minor_locator(NullLocator())


def manufactured(name: str, ratios: Sequence[str]) -> Figure:
    """Both norms over Poisson's ratio."""
    figure, found = axes_of(len(ratios), 2)
    for i, nu in enumerate(ratios):
        rows = {element: DATA["manufactured"][f"{name} {nu} {element}"] for element in ELEMENTS}
        for axes, column, orders in ((found[i], 1, (2, 3)), (found[len(ratios) + i], 2, (1, 2))):
            curves(axes, rows, column, orders)
        found[i].set_title(f"ν = {nu}", fontsize=11)
    found[0].set_ylabel("relative error of u in L2")
    found[len(ratios)].set_ylabel("relative error of ∇u in L2")
    found[0].legend(frameon=False, fontsize=9)
    for row in (found[: len(ratios)], found[len(ratios) :]):
        low, high = (f(axes.get_ylim()[k] for axes in row) for k, f in enumerate((min, max)))
        for axes in row:
            axes.set_ylim(low, high)
    return figure


def cook_panel() -> Figure:
    """The deformed panel, and its deflection over the number of nodes."""
    figure, (left, *right) = axes_of(3, height=4.2)
    body = cook.panel(12, "quadratic")
    mu, kappa = lame_parameters(1.0, 0.4999)
    u = body.solve(mu, kappa, cook.end_shear(body, cook.FORCE * mu), np.zeros_like(body.points), steps=4)
    outline = body.cells[:, [0, 3, 1, 4, 2, 5]]
    for x, style in (
        (body.points, {"facecolor": "none", "edgecolor": "0.8"}),
        (body.points + u, {"facecolor": "#F6D9C6", "edgecolor": "#D55E00"}),
    ):
        left.add_collection(PolyCollection(x[outline], linewidth=0.6, **style))
    left.set_aspect("equal")
    left.autoscale_view()
    left.grid(False)
    left.set(xlabel="mm", title="ν = 0.4999; grey: at rest")
    for axes, nu in zip(right, ("0.458", "0.4999"), strict=True):
        for element, label in ELEMENTS.items():
            colour, marker = STYLE[element]
            nodes, tip = np.array(DATA["panels"][f"{nu} {element}"]).T
            axes.semilogx(nodes, tip, marker=marker, color=colour, label=label, markersize=5)
        axes.set(xlabel="nodes", title=f"ν = {nu}", ylim=(4.7, 7.6))
    right[0].set_ylabel("deflection of the upper end [mm]")
    right[0].legend(frameon=False, fontsize=9, loc="lower right")
    return figure


def circle() -> Figure:
    """Growing circle in two cases, and the onset."""
    figure, found = axes_of(3)
    for axes, case in zip(found, ("cortex", "uniform"), strict=False):
        rows = {}
        for element in ELEMENTS:
            table = np.array(DATA["circles"][f"blocked {case} {element}"])
            per_level = 2 if element == "quadratic" else 1
            table[:, 0] = (48 * per_level * table[:, 0]) ** 2
            rows[element] = table
        curves(axes, rows, 1, (2, 3))
        axes.set_xlabel("nodes of the contour")
    found[0].set(title="growth ratio 3.6, t = 200", ylabel="relative error of u in L2")
    found[1].set_title("growth ratio 1, t = 500")
    for element in ELEMENTS:
        colour, marker = STYLE[element]
        around, error = np.array(DATA["onsets"][f"1 {element}"]).T
        nodes = around * (2 if element == "quadratic" else 1)
        found[2].loglog(nodes, 100.0 * error, marker=marker, color=colour, markersize=5)
    found[2].axhline(0.1, color="0.5", linewidth=0.8)
    found[2].set(title="onset of folding", ylabel="critical growth ratio, too high by [%]")
    found[2].set_xlabel("nodes of the contour")
    ticks_at(found[2], np.array([216, 288, 432, 576]))
    found[2].text(300, 0.107, "0.1 %", color="0.35", fontsize=9)
    found[0].legend(frameon=False, fontsize=9)
    return figure


def table(title: str, rows: dict[str, list[list[float]]]) -> None:
    """Errors as Markdown, and the order of the last refinement."""
    print(f"\n{title}")
    for key, found in rows.items():
        values = np.array(found)
        # levels are halved but for the onset, whose first column counts quadrilaterals around
        halvings = np.log2(values[-1, 0] / values[-2, 0]) if title == "onsets" else 1.0
        cells = []
        for column in values[:, 1:].T:
            if column.all():
                order = np.log2(column[-2] / column[-1]) / halvings
                cells.append(" → ".join(f"{value:.3g}" for value in column) + f" ({order:.2f})")
        print(f"| {key} | " + " | ".join(cells) + " |")


def main() -> None:
    """Draw everything, and print the tables."""
    for name, figure in (
        ("elements-square", manufactured("distorted", ("0.3", "0.458", "0.4999"))),
        ("elements-parallel", manufactured("parallel", ("0.458", "0.4999"))),
        ("elements-cook", cook_panel()),
        ("elements-circle", circle()),
    ):
        figure.savefig(HERE / f"{name}.png", dpi=130)
    for name in ("manufactured", "pressures", "panels", "circles", "onsets"):
        table(name, DATA[name])


if __name__ == "__main__":
    main()
