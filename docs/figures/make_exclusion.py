"""Draws docs/figures/paper-exclusion.png from exclusion.json: ``python docs/figures/make_exclusion.py``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import exclusion_data as source
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from gyrify.report.figures import save_figure
from gyrify.report.layout import FONT

# What has to hold at once, with its observations and colour (Okabe and Ito).
GROUPS: dict[str, tuple[tuple[str, ...], str]] = {
    "indices (P3, P4)": (("P3", "P4"), "#0072B2"),
    "smooth at 1/3 (P6)": (("P6",), "#E69F00"),
    "lissencephaly at 1/2.61 (P7)": (("P7",), "#CC79A7"),
    "thresholds (P12, P13)": (("P12", "P13"), "#009E73"),
    "T = 3 mm below 1.5 mm (P15, P17)": (("P15", "P17"), "#D55E00"),
    "thick cortex (P18)": (("P18",), "#56B4E9"),
}
LINES = dict(
    zip(source.ONSETS, ("#0072B2", "#009E73", "#CC79A7", "#E69F00", "#D55E00", "#56B4E9"), strict=True)
)
TITLES = {"paper": "the paper's mesh", "one diagonal": "one diagonal, uniform layers"}
COLUMNS, ROWS = 3, 2
TEXT: dict[str, Any] = {"fontsize": 8, "family": FONT}
SMALL: dict[str, Any] = {"fontsize": 7, "family": FONT}


def cell(axes: Axes, i: int, j: int, holds: dict[str, bool | None]) -> None:
    """Six squares about a point, filled where a group holds."""
    for number, (ids, colour) in enumerate(GROUPS.values()):
        row, column = divmod(number, COLUMNS)
        x, y = i + 0.26 * (column - 1), j + 0.26 * (0.5 - row)
        full = all(holds[name] for name in ids)
        box = Rectangle(
            (x - 0.115, y - 0.115),
            0.23,
            0.23,
            facecolor=colour if full else "none",
            edgecolor=colour if full else "#bbbbbb",
            linewidth=0.5,
        )
        axes.add_patch(box)


def panel(axes: Axes, data: dict[str, Any], mesh: str, course: str) -> None:
    """One mesh and course: drag to the right, exponent upwards."""
    numbers, exponents = source.FEW.get(mesh, (source.NUMBERS, source.EXPONENTS))
    for j, exponent in enumerate(exponents):
        for i, number in enumerate(numbers):
            found = data[mesh].get(f"{course} {exponent:g} {number:g}")
            if found:
                cell(axes, i, j, found[str(source.JUDGED[0])]["holds"])
    axes.set(xlim=(-0.6, len(numbers) - 0.4), ylim=(-0.6, len(exponents) - 0.4), aspect="equal", anchor="W")
    axes.set_xticks(range(len(numbers)), [f"{n:g}" if n else "none" for n in numbers], **SMALL)
    axes.set_yticks(range(len(exponents)), [f"{s:g}" for s in exponents], **SMALL)
    axes.set_title(f"{TITLES.get(mesh, mesh)}, {course} drag", loc="left", **TEXT)
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)


def onsets(axes: Axes, data: dict[str, Any]) -> None:
    """Exact growth ratio of instability, against the exponent."""
    for name, colour in LINES.items():
        values = [data["exact"].get(f"{name} {s:g}") for s in source.FINE]
        points = np.array([(v, s) for v, s in zip(values, source.FINE, strict=True) if v is not None])
        if len(points):
            axes.plot(*points.T, color=colour, linewidth=1.4, label=name)
    for paper, colour in ((1.71, LINES["E = 1"]), (2.02, LINES["E = 1/1.36"])):
        axes.axvspan(0.95 * paper, 1.05 * paper, color=colour, alpha=0.15, linewidth=0)
        axes.text(paper, 1.02, f"{paper:g} ± 5 %", ha="center", va="bottom", **SMALL)
    axes.axvline(3.6, color="#444444", linewidth=0.8, linestyle="--")
    axes.text(3.56, 0.5, "grown in the paper", rotation=90, va="center", ha="right", **SMALL)
    axes.set(xlim=(1.3, 4.2), ylim=(0, 1))
    axes.set_xlabel("exact growth ratio of instability, no drag", **TEXT)
    axes.set_ylabel("exponent of growth along z", **TEXT)
    axes.tick_params(labelsize=7)
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5), prop={"size": 7, "family": FONT})


def main() -> None:
    """Draw the diagram."""
    data = source.known()
    meshes = [mesh for mesh in source.MESHES if data.get(mesh)]
    heights = [0.5 * len(source.FEW.get(mesh, ((), source.EXPONENTS))[1]) for mesh in meshes]
    height = sum(heights) + 0.55 * len(meshes) + 3.2
    figure = Figure(figsize=(7.2, height), facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(len(meshes) + 1, 2, height_ratios=[*heights, 2.6])
    for i, mesh in enumerate(meshes):
        for j, course in enumerate(source.COURSES):
            axes = figure.add_subplot(grid[i, j])
            panel(axes, data, mesh, course)
            if j == 0:
                axes.set_ylabel("exponent of growth along z", **TEXT)
            if i == len(meshes) - 1:
                axes.set_xlabel("drag number", **TEXT)
    onsets(figure.add_subplot(grid[len(meshes), :]), data)
    handles = [Patch(facecolor=colour, label=name) for name, (_, colour) in GROUPS.items()]
    figure.legend(
        handles=handles,
        loc="outside upper center",
        ncols=3,
        frameon=False,
        prop={"size": 8, "family": FONT},
    )
    save_figure(figure, Path(__file__).with_name("paper-exclusion.png"), dpi=170)


if __name__ == "__main__":
    main()
