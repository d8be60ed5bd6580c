"""Hold-out slices of the phenotype classifier: runs them and draws docs/figures/paper-holdout.png.

``python docs/figures/paper_holdout.py FOLDER [WORKERS]``; the folder keeps the runs. The labels by eye were
written down from the picture without labels, before the classifier was asked.
"""

from __future__ import annotations

import sys
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from gyrify import Config
from gyrify.phenotype import classify, grown_thickness
from gyrify.report.figures import save_figure
from gyrify.report.layout import FONT
from gyrify.report.paper_figures import Outlines, draw_slice
from gyrify.study import Point, StoredPoint, run_points
from gyrify.study.results import flat

COARSE = {"mesh.n_around": 108, "mesh.n_layers": 10, "mesh.n_cortex_layers": 4}
RATIO_E, THICK = "material.stiffness_ratio", "geometry.cortical_thickness"
DRAG, KIND, RATIO = "dissipation.number", "dissipation.kind", "growth.ratio"
# What differs from reference-slice, and the label by eye.
SLICES: tuple[tuple[dict[str, object], str], ...] = (
    ({"mesh.element": "quadratic", **COARSE}, "normal"),
    ({KIND: "none", RATIO_E: "1/1.36"}, "normal"),
    ({"growth.out_of_plane": "none", "growth.stretch": "exponential", DRAG: 0.13, RATIO_E: 0.5}, "smooth"),
    ({"growth.law": "tangential", "seed": 3}, "polymicrogyria"),
    ({THICK: 1.0, RATIO_E: 2.0, DRAG: 0.13}, "sinusoidal"),
    ({RATIO: 2.0, DRAG: 0.13, "seed": 1}, "pachygyria"),
    ({"geometry.shape": "circle", RATIO_E: 3.0, "seed": 2}, "sinusoidal"),
    ({THICK: 5.0, DRAG: 0.13}, "pachygyria"),
    ({"mesh.element": "mean_dilatation", THICK: 0.6, RATIO_E: "1/1.36"}, "polymicrogyria"),
    ({RATIO: 2.6, "growth.energy_per": "reference"}, "smooth"),
    ({RATIO_E: "1/2.61", DRAG: 0.4}, "pachygyria"),
)


def points() -> list[Point]:
    """The runs."""
    base = Config.preset("reference-slice")
    return [Point(dict(o), base.with_overrides({"stability.detect": False, **o})) for o, _ in SLICES]


def draw(slices: list[tuple[Outlines, str, str]], path: Path) -> None:
    """Each slice in a panel, with the label by eye and by rule."""
    figure = Figure(figsize=(7.6, 6.4), facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(3, 4).ravel()
    for axes in panels:
        axes.set_axis_off()
    for number, (axes, (outline, eye, label)) in enumerate(zip(panels, slices, strict=False), start=1):
        draw_slice(axes, outline)
        axes.set_aspect("equal")
        told = label if label == eye else f"{label}\n(by eye: {eye})"
        axes.set_title(f"{number}: {told}", fontsize=7.5, family=FONT)
    save_figure(figure, path, dpi=150)


def main(folder: Path, workers: int) -> None:
    """Run, classify, draw, and print the table."""
    result = run_points(points(), folder, workers=workers)
    shown = []
    for point, (overrides, eye) in zip(points(), SLICES, strict=True):
        stored: StoredPoint = result.point(point.key)
        found = classify(flat(stored.summary), grown_thickness(point.config))
        x, mesh = stored.points, stored.mesh
        outline = Outlines(x[mesh.contour], x[mesh.interface], x[mesh.clamped])
        shown.append((outline, eye, found.label))
        print(overrides, "|", eye, "|", found.label, "|", found.because)
    draw(shown, Path(__file__).parent / "paper-holdout.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1)
