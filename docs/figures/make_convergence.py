"""Draws the pictures and prints the tables of docs/convergence.md: `python docs/figures/make_convergence.py`.

Everything comes from convergence.json, which convergence_data.py computes.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullLocator

from gyrify.convergence import METRICS, judge
from gyrify.report.convergence_figures import Shape, slices_figure
from gyrify.report.figures import save_figure

HERE = Path(__file__).parent
DATA: dict[str, Any] = json.loads((HERE / "convergence.json").read_text(encoding="utf-8"))
RUNS: dict[str, dict[str, Any]] = DATA["runs"]
ELEMENTS = {"linear": "linear", "mean_dilatation": "mean dilatation", "quadratic": "quadratic"}
# Okabe and Ito's colours, told apart by every common colour vision; markers tell them apart too.
STYLE = {"linear": ("#0072B2", "o"), "mean_dilatation": ("#009E73", "^"), "quadratic": ("#D55E00", "s")}
PANELS = {
    "gi_closing": "GI (closing)",
    "n_gyri": "gyri",
    "visible_growth_time": "growth time of visible folds",
}
DRAG = (1.3, 0.13)
DRAGS = (1.3, 0.4, 0.13, 0.04, 0.013)
TOLERANCE = 0.02


def family(element: str, number: float, seed: int = 0) -> list[dict[str, Any]]:
    """Runs of an element on three meshes, coarse to fine, as far as they were computed."""
    names = (f"{element} {level} drag={number} seed={seed}" for level in (0, 1, 2))
    return [RUNS[name] for name in names if name in RUNS]


def sequence(element: str, number: float) -> list[dict[str, Any]]:
    """The same with the meshes of quadratic triangles between and beyond them, by resolution."""
    between = [
        run
        for name, run in RUNS.items()
        if name.startswith(element)
        and "×" in name
        and "followed" not in name
        and run["overrides"].get("dissipation.number", 1.3) == number
    ]
    runs = family(element, number) + between
    return sorted(runs, key=lambda run: -run["distance_mm"])


def followed(*, others: bool = False) -> list[dict[str, Any]]:
    """Runs without drag that follow the branch, on three meshes or on the three other ones."""
    meshes = ("72 × 7", "144 × 13", "288 × 27") if others else (0, 1, 2)
    return [RUNS[f"quadratic {mesh} branch followed"] for mesh in meshes]


def ensemble(element: str, level: int, number: float, key: str) -> list[float]:
    """A metric of one mesh over seeds."""
    names = (f"{element} {level} drag={number} seed={seed}" for seed in range(5))
    return [RUNS[name][key] for name in names if name in RUNS and RUNS[name].get(key) is not None]


def mesh_figure() -> Figure:
    """Metrics against the distance of contour nodes: elements and seeds."""
    figure, rows = panels(2, 3)
    for axes_row, number in zip(rows, DRAG, strict=True):
        for axes, (key, label) in zip(axes_row, PANELS.items(), strict=True):
            for element, (colour, marker) in STYLE.items():
                for level, run in enumerate(family(element, number)):
                    seeds = ensemble(element, level, number, key)
                    distance = [run["distance_mm"]] * len(seeds)
                    axes.plot(distance, seeds, "_", color=colour, markersize=11, alpha=0.8)
                runs = [run for run in sequence(element, number) if run.get(key) is not None]
                axes.plot(
                    [run["distance_mm"] for run in runs],
                    [run[key] for run in runs],
                    color=colour,
                    marker=marker,
                    markersize=5,
                    label=ELEMENTS[element],
                )
            if number == DRAG[-1]:
                runs = followed()
                axes.plot(
                    [run["distance_mm"] for run in runs],
                    [run[key] for run in runs],
                    color="0.2",
                    marker="D",
                    markersize=4,
                    linestyle=":",
                    label="quadratic, no drag, branch followed",
                )
            axes.set_title(f"{label}, drag number {number}", fontsize=9, loc="left")
            finer_to_the_right(axes, [run["distance_mm"] for run in family("linear", number)])
            if key == "n_gyri":
                axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    rows[0][0].legend(fontsize=8, frameon=False)
    rows[1][0].legend(handles=rows[1][0].lines[-1:], fontsize=8, frameon=False)
    figure.supxlabel("distance of contour nodes [mm] (finer to the right); dashes are seeds", fontsize=9)
    return figure


def drag_figure() -> Figure:
    """Metrics against the drag number, with what remains without drag."""
    figure, ((*found,),) = panels(1, 3)
    free = {"no drag": "--", "branch followed": ":"}
    for axes, (key, label) in zip(found, PANELS.items(), strict=True):
        names = {number: f"quadratic 1 drag={number} seed=0" for number in DRAGS}
        points = [(number, RUNS[name][key]) for number, name in names.items() if RUNS[name].get(key)]
        axes.plot(*zip(*points, strict=True), color="#D55E00", marker="s", markersize=5, label="drag")
        for number in DRAG:
            seeds = ensemble("quadratic", 1, number, key)
            axes.plot([number] * len(seeds), seeds, "_", color="#D55E00", markersize=11)
        for name, style in free.items():
            value = RUNS[f"quadratic 1 {name}"].get(key)
            if value is not None:
                axes.axhline(value, color="0.3", linestyle=style, linewidth=1.2, label=name)
        axes.set_xscale("log")
        axes.set_title(label, fontsize=9, loc="left")
        axes.set_xticks(DRAGS, [f"{number:g}" for number in DRAGS])
        axes.xaxis.set_minor_locator(NullLocator())
        if key == "n_gyri":
            axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    found[0].legend(fontsize=8, frameon=False)
    figure.supxlabel("drag number", fontsize=9)
    return figure


def shapes_figure(names: dict[str, str], columns: int) -> Figure:
    """Folded slices side by side."""
    shapes = [Shape(**{key: np.array(line) for key, line in DATA["shapes"][name].items()}) for name in names]
    titles = [
        f"{title}\nGI {RUNS[n]['gi_closing']:.2f}, {RUNS[n]['n_gyri']:.0f} gyri" for n, title in names.items()
    ]
    return slices_figure(shapes, titles, columns)


def panels(rows: int, columns: int) -> tuple[Figure, list[list[Axes]]]:
    """A figure of panels."""
    figure = Figure(figsize=(3.4 * columns, 2.9 * rows + 0.2), layout="constrained", facecolor="white")
    FigureCanvasAgg(figure)
    found = [list(row) for row in figure.subplots(rows, columns, squeeze=False)]
    for axes in (axes for row in found for axes in row):
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(True, axis="y", color="0.92", linewidth=0.7)
        axes.tick_params(labelsize=8)
    return figure, found


def finer_to_the_right(axes: Axes, distances: Sequence[float]) -> None:
    """Logarithmic abscissa with a tick at each mesh."""
    axes.set_xscale("log")
    axes.invert_xaxis()
    axes.set_xticks(distances, [f"{distance:.2f}" for distance in distances])
    axes.xaxis.set_minor_locator(NullLocator())


def verdicts(runs: Sequence[dict[str, Any]], names: Sequence[str]) -> Iterator[str]:
    """Table of every metric over the levels of a family, with its verdict."""
    yield f"| metric | {' | '.join(names)} | order | limit | verdict |"
    yield f"|---|{'---:|' * len(runs)}---:|---:|---|"
    for metric in METRICS:
        values = [run.get(metric.key) for run in runs]
        found = judge(values, TOLERANCE, is_count=metric.is_count, least=metric.least)
        cells = ["–" if value is None else f"{value:.{metric.digits}f}" for value in values]
        order = "–" if found.order is None else f"{found.order:.1f}"
        limit = "–" if found.limit is None else f"{found.limit:.{metric.digits}f}"
        name = f"{metric.name} [{metric.unit}]" if metric.unit else metric.name
        yield f"| {name} | {' | '.join(cells)} | {order} | {limit} | {found.sentence} |"


def rows(names: Sequence[str]) -> Iterator[str]:
    """Table of the metrics of single runs."""
    yield "| run | GI closing | hull | exposed | gyri | folds visible | stability lost | deepest | energy |"
    yield "|---|---:|---:|---:|---:|---:|---:|---:|---:|"
    for name in names:
        run = RUNS[name]
        cells = []
        for metric in METRICS:
            value = run.get(metric.key)
            if metric.key != "sulcal_depth_mm_mean":
                cells.append("–" if value is None else f"{value:.{metric.digits}f}")
        yield f"| {name} | {' | '.join(cells)} |" + (
            "" if run["status"] == "completed" else f" {run['reason']}"
        )


def ensembles() -> Iterator[str]:
    """Table of means over seeds."""
    yield "| element, nodes | drag | seeds | GI closing | GI hull | gyri | folds visible |"
    yield "|---|---:|---:|---:|---:|---:|---:|"
    for number in DRAG:
        for element in ELEMENTS:
            for level in (0, 1, 2):
                counts = ensemble(element, level, number, "n_gyri")
                if len(counts) < 2:
                    continue
                cells = [
                    spread(ensemble(element, level, number, key), digits)
                    for key, digits in (
                        ("gi_closing", 3),
                        ("gi_hull", 3),
                        ("n_gyri", 1),
                        ("visible_growth_time", 1),
                    )
                ]
                yield f"| {element} {108 * 2**level} | {number} | {len(counts)} | {' | '.join(cells)} |"


def spread(values: Sequence[float], digits: int) -> str:
    """Mean ± standard deviation over seeds."""
    if not values:
        return "–"
    return f"{np.mean(values):.{digits}f} ± {np.std(values, ddof=1):.{digits}f}"


def tables() -> None:
    """Print the tables of the page."""
    for number in DRAG:
        for element in ELEMENTS:
            runs = family(element, number)
            print(f"\n{element}, drag number {number}\n")
            print("\n".join(verdicts(runs, [f"{run['contour_nodes']} nodes" for run in runs])))
    print("\nNo drag, branch followed\n")
    print("\n".join(verdicts(followed(), [f"{run['contour_nodes']} nodes" for run in followed()])))
    print("\nNo drag, branch followed, other meshes\n")
    print(
        "\n".join(
            verdicts(
                followed(others=True), [f"{run['contour_nodes']} nodes" for run in followed(others=True)]
            )
        )
    )
    for title, end in (("1.3", ""), ("2.6", " drag=2.6")):
        print(f"\nOther meshes, drag number {title}\n")
        others = [f"quadratic {mesh}{end}" for mesh in ("72 × 7", "144 × 13", "288 × 27")]
        print("\n".join(verdicts([RUNS[name] for name in others], others)))
    print("\nSeeds\n")
    print("\n".join(ensembles()))
    for title, names in (
        ("Increments", ("increments 50", "standard", "increments 200")),
        ("Contact", ("standard", "contact 1/2", "contact 1/4")),
    ):
        print(f"\n{title}\n")
        print("\n".join(verdicts([RUNS[name] for name in names], names)))
    print("\nSingle runs\n")
    print("\n".join(rows([name for name in RUNS if "seed=" not in name])))
    print("\n".join(rows([f"quadratic 1 drag={number} seed=0" for number in DRAGS])))
    names = {id(run): name for name, run in RUNS.items()}
    for number in DRAG:
        print(f"\nQuadratic triangles, drag number {number}\n")
        print("\n".join(rows([names[id(run)] for run in sequence("quadratic", number)])))
    middle = ["quadratic 1 drag=1.3 seed=0", "quadratic 1 increments=200", "quadratic 1 increments=400"]
    print("\n".join(verdicts([RUNS[name] for name in middle], ("100", "200", "400"))))
    print("\nCost [s]:", DATA.get("cost_s"))


if __name__ == "__main__":
    tables()
    levels = {
        f"{element} {level} drag=1.3 seed=0": f"{element}, {108 * 2**level} nodes"
        for element in ("linear", "quadratic")
        for level in (0, 1, 2)
    }
    drags = {f"quadratic 1 drag={number} seed=0": f"drag number {number}" for number in DRAGS}
    drags |= {f"quadratic 1 {name}": name for name in ("no drag", "branch followed")}
    drags = {name: title for name, title in drags.items() if RUNS[name]["status"] == "completed"}
    save_figure(mesh_figure(), HERE / "convergence-mesh.png", dpi=130)
    save_figure(drag_figure(), HERE / "convergence-drag.png", dpi=130)
    save_figure(shapes_figure(levels, 3), HERE / "convergence-shapes.png", dpi=130)
    save_figure(shapes_figure(drags, 4), HERE / "convergence-drag-shapes.png", dpi=130)
