"""Draws the definitions of docs/metrics.md on one folded slice: `python docs/figures/make_metrics.py`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import shapely
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.signal import peak_prominences

from gyrify import Config, History, gyrification_index, simulate
from gyrify.metrics import Folds, closing_outline, find_folds, low_mode_shape
from gyrify.metrics.contour import as_contour

HERE = Path(__file__).parent
RADIUS = 10.0
# Okabe-Ito.
BLUE, ORANGE, GREEN, PINK = "#0072b2", "#d55e00", "#009e73", "#cc79a7"
TISSUE, INK = "#e3e3e3", "#1f1f1f"
Points = NDArray[np.float64]


def closed(points: Points) -> Points:
    """The first point again at the end."""
    return np.concatenate([points, points[:1]])


def tissue(axes: Axes, contour: Points) -> None:
    """The slice, its contour, and a scale bar."""
    axes.fill(*contour.T, color=TISSUE, lw=0)
    axes.plot(*closed(contour).T, color=INK, lw=1.0)
    axes.set_aspect("equal")
    axes.set_axis_off()


def scale_bar(axes: Axes, x: float, y: float, length: float = 10.0) -> None:
    """Scale bar from a point on [mm]."""
    axes.plot([x, x + length], [y, y], color=INK, lw=2.5, solid_capstyle="butt")
    axes.text(x + length / 2, y, f"{length:g} mm", ha="center", va="bottom", fontsize=8)


def exposed_parts(contour: Points, radius: float) -> list[Points]:
    """Pieces of the contour on the closing's outline: those that a disc can touch from outside."""
    offset = shapely.Polygon(contour).buffer(radius, quad_segs=64)
    ring = shapely.segmentize(shapely.linearrings(contour), 0.05)
    points = shapely.get_coordinates(ring)
    on = shapely.distance(shapely.points(points), offset.exterior) < radius * (1 + 1e-3)
    return [np.asarray(run) for run in _runs(points, on)]


def _runs(points: Points, on: NDArray[np.bool_]) -> list[Points]:
    ends = np.flatnonzero(np.diff(on.astype(int))) + 1
    return [part for part, keep in zip(np.split(points, ends), np.split(on, ends), strict=True) if keep[0]]


def indices(contour: Points) -> Figure:
    """The three exposed lengths."""
    figure = Figure(figsize=(9.6, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    hull = shapely.get_coordinates(shapely.Polygon(contour).convex_hull.exterior)
    outline = closing_outline(contour, RADIUS)
    lines = {"hull": ([hull], BLUE), "closing": ([closed(outline)], ORANGE)}
    lines["exposed"] = (exposed_parts(contour, RADIUS), GREEN)
    for axes, (name, (parts, colour)) in zip(
        figure.subplots(1, 3, sharex=True, sharey=True), lines.items(), strict=True
    ):
        tissue(axes, contour)
        for part in parts:
            axes.plot(*part.T, color=colour, lw=2.2)
        value = gyrification_index(contour, name, RADIUS)  # type: ignore[arg-type]
        axes.set_title(f"{name}: GI = {value:.2f}", fontsize=11)
    scale_bar(axes, 30.0, contour[:, 1].min() - 4.0, 20.0)
    return figure


def closing(contour: Points) -> Figure:
    """The disc, and what it cannot reach."""
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    outline = closing_outline(contour, RADIUS)
    axes.fill(*outline.T, color="#f6d9b8", lw=0)
    tissue(axes, contour)
    axes.plot(*closed(outline).T, color=ORANGE, lw=2.0, label="outline of the closing")
    for part in exposed_parts(contour, RADIUS):
        axes.plot(*part.T, color=GREEN, lw=3.0)
    axes.plot([], [], color=GREEN, lw=3.0, label="exposed part of the contour")
    offset = shapely.Polygon(contour).buffer(RADIUS, quad_segs=64).exterior
    fundus, mouth = _deepest(contour)
    centre = np.array(shapely.get_coordinates(offset.interpolate(offset.project(shapely.Point(mouth))))[0])
    angle = np.linspace(0, 2 * np.pi, 200)
    axes.plot(*(centre[:, None] + RADIUS * np.array([np.cos(angle), np.sin(angle)])), color=BLUE, lw=1.5)
    axes.annotate(
        "", tuple(centre + np.array([RADIUS, 0.0])), centre, arrowprops={"arrowstyle": "->", "color": BLUE}
    )
    axes.text(centre[0] + RADIUS / 2, centre[1] + 0.5, "r = 10 mm", color=BLUE, ha="center", fontsize=9)
    foot = shapely.get_coordinates(shapely.shortest_line(shapely.Point(fundus), shapely.linearrings(outline)))
    axes.plot(*foot.T, color=PINK, lw=2.0, label="sulcal depth")
    axes.plot(*fundus, "o", color=PINK, ms=5)
    axes.set_xlim(centre[0] - 24, centre[0] + 24)
    axes.set_ylim(centre[1] - 26, centre[1] + 11)
    scale_bar(axes, centre[0] - 23, centre[1] - 25)
    axes.legend(loc="lower right", fontsize=8, frameon=False)
    return figure


def _deepest(contour: Points) -> tuple[Points, Points]:
    """Fundus of the deepest sulcus in the upper half, and the nearest place on the outline."""
    outline = shapely.linearrings(closing_outline(contour, RADIUS))
    fundi = find_folds(contour).fundus_points
    fundi = fundi[(fundi[:, 1] > 20.0)]
    depth = shapely.distance(shapely.points(fundi), outline)
    line = shapely.get_coordinates(shapely.shortest_line(shapely.Point(fundi[depth.argmax()]), outline))
    return line[0], line[1]


def gyri(contour: Points) -> Figure:
    """Overall shape, normal displacement, crowns and fundi, prominence."""
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.5])
    folds, shape = find_folds(contour), low_mode_shape(contour)
    tissue(left, contour)
    left.plot(*closed(shape.contour()).T, "--", color=BLUE, lw=1.5, label="overall shape (low modes)")
    left.plot(*folds.crown_points.T, "^", color=ORANGE, ms=5, label="crowns")
    left.plot(*folds.fundus_points.T, "v", color=PINK, ms=5, label="fundi")
    scale_bar(left, 28.0, contour[:, 1].min() - 4.0, 20.0)
    left.legend(loc="center", fontsize=8, frameon=False)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(folds.points, axis=0), axis=1))])
    right.plot(along, folds.displacement, color=INK, lw=1.0)
    right.axhline(0.0, ls="--", color=BLUE, lw=1.0)
    right.plot(along[folds.crowns], folds.displacement[folds.crowns], "^", color=ORANGE, ms=5)
    right.plot(along[folds.fundi], folds.displacement[folds.fundi], "v", color=PINK, ms=5)
    _prominence(right, along, folds)
    right.set(xlabel="arc length [mm]", ylabel="normal displacement [mm]", xlim=(0, along[-1]))
    right.set_title(f"{folds.n_gyri} gyri", fontsize=11)
    return figure


def _prominence(axes: Axes, along: Points, folds: Folds) -> None:
    """How far the least prominent crown stands out above the higher of the sulci that bound it."""
    lowest = int(folds.displacement.argmin())
    turned = np.roll(folds.displacement, -lowest)
    found, _, _ = peak_prominences(turned, (folds.crowns - lowest) % turned.size)
    number = int(found.argmin())
    at, top = along[folds.crowns[number]], folds.displacement[folds.crowns[number]]
    low = top - found[number]
    axes.annotate(
        "",
        (at, low),
        (at, top),
        arrowprops={"arrowstyle": "<->", "color": GREEN, "lw": 1.6, "shrinkA": 0, "shrinkB": 0},
    )
    axes.plot([at - 22, at + 22], [low, low], color=GREEN, lw=1.0, ls=":")
    axes.text(at, 2.0, f"prominence {found[number]:.1f} mm", color=GREEN, fontsize=9, ha="center")
    axes.set_ylim(top=3.5)


def thickness(history: History) -> Figure:
    """Shortest ways from crowns and fundi to the interface."""
    figure = Figure(figsize=(6.4, 3.8), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    contour, interface = as_contour(history.contour(-1)), as_contour(history.interface(-1))
    axes.fill(*contour.T, color="#bdbdbd", lw=0)
    axes.fill(*interface.T, color="#f4f4f4", lw=0)
    axes.plot(*closed(contour).T, color=INK, lw=1.0)
    axes.plot(*closed(interface).T, color=INK, lw=0.8, ls=(0, (4, 2)))
    folds, line = find_folds(contour), shapely.linearrings(interface)
    for points, colour, name in (
        (folds.crown_points, ORANGE, "at crowns"),
        (folds.fundus_points, PINK, "at fundi"),
    ):
        ways = [shapely.get_coordinates(shapely.shortest_line(shapely.Point(p), line)) for p in points]
        for number, way in enumerate(ways):
            axes.plot(*way.T, "-o", color=colour, lw=1.8, ms=3, label=name if number == 0 else None)
    fundus, _ = _deepest(contour)
    axes.set_xlim(fundus[0] - 18, fundus[0] + 18)
    axes.set_ylim(fundus[1] - 8, fundus[1] + 15)
    axes.set_aspect("equal")
    axes.set_axis_off()
    scale_bar(axes, fundus[0] - 17, fundus[1] - 7, 5.0)
    axes.legend(loc="lower right", fontsize=9, frameon=False, title="cortical thickness", title_fontsize=9)
    return figure


if __name__ == "__main__":
    run = simulate(Config.preset("reference-slice"))
    folded = as_contour(run.contour(-1))
    pictures = {
        "indices": indices(folded),
        "closing": closing(folded),
        "gyri": gyri(folded),
        "thickness": thickness(run),
    }
    for name, picture in pictures.items():
        picture.savefig(HERE / f"metrics-{name}.png", dpi=150, metadata={"Software": None})
