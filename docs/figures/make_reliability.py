"""Draws reliability.png from reliability.jsonl: what became of every random configuration."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from gyrify.report import save_figure
from gyrify.report.plot.style import add_axes, letter, new_figure, style_axes

HERE = Path(__file__).parent
# Okabe-Ito, with a marker each, the rare ones on top.
LOOKS = {
    "completed": ("#56B4E9", "o", 6.0, "completed"),
    "stopped": ("#009E73", "s", 22.0, "stopped with a reason"),
    "exhausted": ("#D55E00", "^", 28.0, "not converged"),
    "wrong": ("#000000", "X", 36.0, "wrong or unexplained"),
}
STIFFNESS, GROWTH, THICKNESS = "material.stiffness_ratio", "growth.ratio", "geometry.cortical_thickness"
# key of x, key of y, labels, and the sensible box
PANELS = (
    (STIFFNESS, GROWTH, "stiffness ratio $E_G/E_W$", "growth ratio $G_G/G_W$", (1 / 3, 1.0, 3.0, 360.0)),
    (
        STIFFNESS,
        THICKNESS,
        "stiffness ratio $E_G/E_W$",
        "cortical thickness $T$ [mm]",
        (1 / 3, 0.75, 3.0, 8.0),
    ),
)
BELOW = 5e-4  # where no dissipation is drawn


def scatter(axes: Axes, records: list[dict[str, Any]], x: str, y: str) -> None:
    """Every run at its place, by outcome."""
    for outcome, (colour, marker, size, _) in LOOKS.items():
        mine = [record["config"] for record in records if record["outcome"] == outcome]
        at = [[max(BELOW, config[key]) for config in mine] for key in (x, y)]
        axes.scatter(*at, s=size, c=colour, marker=marker, linewidths=0.3, edgecolors="white")
    axes.set(xscale="log", yscale="log")


def draw(records: list[dict[str, Any]]) -> Figure:
    """Two cuts through the numbers, and one by dissipation."""
    figure = new_figure(180.0, 74.0)
    for number, (x, y, x_label, y_label, box) in enumerate(PANELS):
        axes = add_axes(figure, (13.0 + 58.0 * number, 19.0, 44.0, 48.0))
        scatter(axes, records, x, y)
        low = (box[0], box[1])
        wide, tall = box[2] - box[0], box[3] - box[1]
        axes.add_patch(Rectangle(low, wide, tall, fill=False, edgecolor="#1f1f1f", linewidth=0.8, zorder=3))
        style_axes(axes, x_label, y_label)
        letter(figure, number, 2.0 + 58.0 * number, 72.0)
    axes = add_axes(figure, (129.0, 19.0, 44.0, 48.0))
    scatter(axes, records, STIFFNESS, "dissipation.number")
    style_axes(axes, "stiffness ratio $E_G/E_W$", "dissipation number [–]")
    axes.set_yticks([BELOW, 1e-3, 1e-2, 0.1, 1.0, 10.0], ["none", "0.001", "0.01", "0.1", "1", "10"])
    axes.minorticks_off()
    letter(figure, 2, 118.0, 72.0)
    handles = [
        Line2D([], [], color=colour, marker=marker, linestyle="none", markersize=size**0.5, label=label)
        for outcome, (colour, marker, size, label) in LOOKS.items()
        if outcome in ("completed", "stopped", "exhausted") or any(r["outcome"] == outcome for r in records)
    ]
    handles.append(Line2D([], [], color="#1f1f1f", linewidth=0.8, label="sensible box"))
    figure.legend(handles=handles, loc="lower center", ncols=len(handles), frameon=False, fontsize=8)
    return figure


if __name__ == "__main__":
    lines = (HERE / "reliability.jsonl").read_text(encoding="utf-8").splitlines()
    save_figure(draw([json.loads(line) for line in lines]), HERE / "reliability.png")
