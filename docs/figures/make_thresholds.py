"""Draws the pictures of docs/thresholds.md from thresholds.json: `python docs/figures/make_thresholds.py`.

The numbers come from threshold_data.py; the scan and the mode are computed here, in half a minute.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gyrify import Config, simulate
from gyrify.errors import SolveError
from gyrify.threshold.stability_scan import StabilityScan

HERE = Path(__file__).parent
DATA: dict[str, Any] = json.loads((HERE / "thresholds.json").read_text(encoding="utf-8"))
# Okabe and Ito's colours, told apart by every common colour vision; markers tell them apart too.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00")
MARKERS = ("o", "s", "^", "D", "v")
STIFF = ("1/1.36", "1", "1.54", "2", "3")
SOFT = ("1/2.61", "1/3")


def panels(columns: int, height: float = 3.9) -> tuple[Figure, list[Axes]]:
    """A figure of panels side by side."""
    figure = Figure(figsize=(5.0 * columns, height), layout="constrained")
    found = list(figure.subplots(1, columns, squeeze=False)[0])
    for axes in found:
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(True, color="0.92", linewidth=0.7)
        axes.set_axisbelow(True)
    return figure, found


def family(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Points around and critical growth ratios of the circle, coarse to fine."""
    rows = []
    for key, found in DATA["circle"].items():
        mesh, stiffness = key.split(" ")
        if stiffness == name and found["value"] is not None:
            rows.append((int(mesh.split("x")[0]), found["value"]))
    return tuple(np.array(sorted(rows)).T)  # type: ignore[return-value]


def circle() -> Figure:
    """Convergence to the exact annulus, and the soft cortices that have no such limit at a finite wave."""
    figure, (left, right) = panels(2)
    for colour, marker, name in zip(COLOURS, MARKERS, STIFF, strict=True):
        around, values = family(name)
        error = 100.0 * (values / DATA["exact"][name]["value"] - 1.0)
        left.plot(around, error, marker=marker, color=colour, label=name, markersize=5)
    around = np.array([108.0, 648.0])
    left.plot(around, 12.0 * (around / 108.0) ** -2, ":", color="0.3", label="second order")
    left.axhline(1.0, color="0.5", linewidth=0.8)
    left.text(110, 0.9, "1 %", color="0.3", fontsize=9, va="top")
    left.set(xscale="log", yscale="log", xlabel="points around the contour  [–]")
    left.set_ylabel("critical growth ratio above the exact one  [%]")
    left.set_title("Circle against the exact annulus", fontsize=10)
    left.legend(title="stiffness ratio", fontsize=8, title_fontsize=8, ncols=2, loc="lower left")
    for colour, marker, name in zip(COLOURS, MARKERS, SOFT, strict=False):
        around, values = family(name)
        right.plot(1.0 / around, values, marker=marker, color=colour, label=name, markersize=5)
        exact = DATA["exact"][name]["value"]
        right.plot(0.0, exact, marker=marker, color=colour, markersize=7, fillstyle="none", clip_on=False)
    right.annotate(
        "exact: surface limit,\nwavelength zero",
        (0.0, 2.53),
        (0.0004, 2.42),
        fontsize=9,
        color="0.3",
        va="center",
    )
    right.set(xlim=(0.0, None), ylim=(2.3, 3.5), ylabel="critical growth ratio  [–]")
    ticks = [648, 432, 324, 216]
    right.set_xticks([0.0, *(1.0 / n for n in ticks)], ["∞", *map(str, ticks)])
    right.set_xlabel("points around the contour  [–], spaced by their inverse")
    right.set_title("Soft cortex: the mesh decides", fontsize=10)
    right.legend(title="stiffness ratio", fontsize=8, title_fontsize=8, loc="upper left")
    for axes in (left,):
        axes.set_xticks([108, 216, 324, 432, 648], ["108", "216", "324", "432", "648"])
        axes.minorticks_off()
        axes.set_yticks([0.2, 0.5, 1, 2, 5, 10, 20], ["0.2", "0.5", "1", "2", "5", "10", "20"])
    return figure


def dragged() -> Figure:
    """Threshold that the final state of a dragged path suggests, over the drag number."""
    figure, (axes,) = panels(1)
    for colour, marker, name in zip(COLOURS, MARKERS, ("1/1.36", "1"), strict=False):
        pairs = [
            (float(key.split(" ")[0]), v) for key, v in DATA["dragged"].items() if key.split(" ")[1] == name
        ]
        number, value = np.array(sorted(pairs)).T
        free = DATA["ellipse"][f"216x17 {name}"]["value"]
        axes.plot(number, value, marker=marker, color=colour, label=f"{name}, dragged path", markersize=5)
        axes.axhline(free, color=colour, linestyle="--", linewidth=1.0, label=f"{name}, smooth equilibrium")
    axes.axvline(1.3, color="0.6", linewidth=0.8)
    axes.text(1.25, 1.52, "reference-slice", rotation=90, fontsize=8, color="0.3", ha="right", va="bottom")
    axes.set(xscale="log", xlabel="drag number  [–]", ylabel="growth ratio at loss of stability  [–]")
    axes.set_ylim(1.5, 2.2)
    axes.set_title("A dragged path lags, and biases the threshold low", fontsize=10)
    axes.legend(
        title="stiffness ratio", fontsize=8, title_fontsize=8, loc="lower left", bbox_to_anchor=(0.0, 0.1)
    )
    return figure


def scan() -> Figure:
    """Lowest eigenvalue and inertia of the smooth branch of the standard ellipse over the growth ratio."""
    figure, (left, right) = panels(2)
    for colour, marker, name in zip(COLOURS, MARKERS, ("1/1.36", "1", "2"), strict=False):
        ratio = {"1/1.36": 1 / 1.36}.get(name, float(name) if "/" not in name else 0.0)
        config = Config.preset("reference-slice").with_overrides({"material.stiffness_ratio": ratio})
        found = StabilityScan(config, "growth.ratio")
        known = [p for p in found.scan(np.linspace(1.0, 3.0, 41).tolist()) if p.n_negative is not None]
        values = [point.value for point in known]
        left.plot(
            values,
            [found.eigenvalue(v) for v in values],
            color=colour,
            marker=marker,
            markersize=3,
            label=name,
        )
        right.plot(
            values, [p.n_negative for p in known], color=colour, marker=marker, markersize=3, label=name
        )
    left.axhline(0.0, color="0.3", linewidth=0.8)
    left.set(xlabel="growth ratio  [–]", ylabel="lowest eigenvalue  [Pa/mm²]", ylim=(-150.0, 25.0))
    left.set_title("Smooth branch of the standard slice", fontsize=10)
    right.set(xlabel="growth ratio  [–]", ylabel="negative pivots  [–]")
    right.set_title("Number of unstable modes", fontsize=10)
    left.legend(title="stiffness ratio", fontsize=8, title_fontsize=8)
    return figure


def outline(points: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Closed loop of some points."""
    return points[np.append(which, which[0])]


def branch() -> Figure:
    """The mode at onset on the smooth slice, and the stable state that leaving along it leads to."""
    values = {"mesh.node_jitter": 0.0, "dissipation.kind": "none", "stability.follow_branch": True}
    history = simulate(Config.preset("reference-slice").with_overrides(values))
    onset, mesh = history.onset, history.mesh
    if onset is None:
        raise SolveError("The standard slice did not fold.")
    figure, (left, right) = panels(2, height=4.6)
    smooth = mesh.points + onset.displacement
    mode = onset.vector * (2.5 / np.abs(onset.vector).max())
    folded = history.points()
    for axes, shape, title in (
        (left, smooth + mode, f"Onset, growth time {onset.growth_time:.1f}: mode {onset.mode_number}"),
        (right, folded, "Growth time 500, stable, without dissipation"),
    ):
        for which, width in ((mesh.contour, 1.3), (mesh.interface, 0.7), (mesh.clamped, 0.7)):
            axes.plot(*outline(shape, which).T, color=COLOURS[0], linewidth=width)
        axes.set(aspect="equal", xlabel="x  [mm]", ylabel="y  [mm]", title=title)
        axes.title.set_fontsize(10)
    left.plot(*outline(smooth, mesh.contour).T, "--", color="0.3", linewidth=1.0)
    note = "dashed: smooth state\nblue: with the mode,\n2.5 mm at most"
    left.text(0.5, 0.5, note, ha="center", va="center", transform=left.transAxes, fontsize=8, color="0.3")
    return figure


def table() -> None:
    """Write the table of the circle into the page."""
    page = HERE.parent / "thresholds.md"
    names = [*STIFF, *SOFT]
    rows = [["mesh", *names], ["---"] * (len(names) + 1)]
    meshes = sorted({key.split(" ")[0] for key in DATA["circle"]}, key=lambda mesh: int(mesh.split("x")[0]))
    for mesh in meshes:
        found = [DATA["circle"].get(f"{mesh} {name}", {"value": None}) for name in names]
        cells = ["" if f["value"] is None else f"{f['value']:.4f} ({f['mode']})" for f in found]
        rows.append([mesh.replace("x", " × "), *cells])
    exact = [DATA["exact"][name] for name in names]
    rows.append(["exact", *(f"{f['value']:.4f} ({f['mode'] or 'surface'})" for f in exact)])
    text = "\n".join("| " + " | ".join(row) + " |" for row in rows)
    before, _, rest = page.read_text(encoding="utf-8").partition("<!-- circle -->\n")
    page.write_text(
        f"{before}<!-- circle -->\n{text}\n<!-- end -->{rest.partition('<!-- end -->')[2]}", "utf-8"
    )


if __name__ == "__main__":
    for plot in (circle, dragged, scan, branch):
        plot().savefig(HERE / f"thresholds-{plot.__name__}.png", dpi=130)
    table()
