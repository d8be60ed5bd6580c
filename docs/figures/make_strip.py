"""Draws strip-onset.png and strip-folded.png, and prints the onset table of docs/strip.md."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "tests" / "verification"))

from strip_onset import StripMesh, onset, theory  # noqa: E402

from gyrify import Config, simulate  # noqa: E402
from gyrify.report import save_figure  # noqa: E402
from gyrify.report.outputs import folded_picture  # noqa: E402
from gyrify.run.summary import summarise  # noqa: E402

RATIOS = {"1/1.36": 1 / 1.36, "1": 1.0, "1.54": 1.54, "2": 2.0, "3": 3.0}
NAMES = {"isotropic": "isotropic growth, z blocked", "uniaxial": "growth in x only"}
REFINEMENTS = (1 / 3, 0.5, 2 / 3, 1.0, 1.5, 2.0)
# Okabe-Ito, with a marker each.
STYLES = (("#0072b2", "o"), ("#e69f00", "s"), ("#009e73", "^"), ("#cc79a7", "D"), ("#d55e00", "v"))


def results() -> dict[tuple[str, str], list[float]]:
    """Critical g of every reading and stiffness ratio on every mesh."""
    return {
        (loading, name): [onset(ratio, loading, StripMesh().refined(f)) for f in REFINEMENTS]
        for loading in NAMES
        for name, ratio in RATIOS.items()
    }


def print_table(found: dict[tuple[str, str], list[float]]) -> None:
    """Markdown table of the standard mesh, the finest, and the limit by Richardson's rule."""
    standard = REFINEMENTS.index(1.0)
    print("| growth | stiffness ratio | theory g | 48 columns | error | 96 columns | error | extrapolated |")
    print("|---|---|---|---|---|---|---|---|")
    for (loading, name), values in found.items():
        exact = theory(RATIOS[name], loading).load
        one, two = values[standard], values[-1]
        limit = two - (one - two) / 3
        print(
            f"| {NAMES[loading]} | {name} | {exact:.4f} | {one:.4f} | {one / exact - 1:+.2%} "
            f"| {two:.4f} | {two / exact - 1:+.2%} | {limit:.4f} |"
        )


def draw(found: dict[tuple[str, str], list[float]]) -> Figure:
    """Critical g over stiffness ratio with the theory, and its error over the cell size."""
    figure = Figure(figsize=(9.2, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    fine = np.geomspace(0.7, 3.3, 40)
    standard = REFINEMENTS.index(1.0)
    for loading, line, marker in (("isotropic", "-", "o"), ("uniaxial", "--", "s")):
        left.plot(
            fine,
            [theory(b, loading).load for b in fine],
            line,
            color="#1f1f1f",
            lw=1.0,
            label=f"theory, {NAMES[loading]}",
        )
        ours = [found[loading, name][standard] for name in RATIOS]
        left.plot(
            list(RATIOS.values()), ours, marker, color="#d55e00", mfc="none", label=f"strip, {NAMES[loading]}"
        )
    left.set(xscale="log", xlabel="stiffness ratio $E_G/E_W$", ylabel="critical growth stretch $g$")
    left.set_xticks(list(RATIOS.values()), list(RATIOS))
    left.minorticks_off()
    left.legend(frameon=False, fontsize=8)
    left.set_title("48 columns per wavelength", fontsize=10)
    size = np.array([1 / (48 * f) for f in REFINEMENTS])
    for (name, ratio), (colour, marker) in zip(RATIOS.items(), STYLES, strict=True):
        for loading, line, face in (("isotropic", "-", colour), ("uniaxial", "--", "white")):
            error = np.array(found[loading, name]) / theory(ratio, loading).load - 1
            right.loglog(
                size,
                error,
                line,
                marker=marker,
                color=colour,
                mfc=face,
                ms=4.5,
                lw=1.0,
                label=name if loading == "isotropic" else None,
            )
    right.loglog(size, 3.0 * size**2, ":", color="#1f1f1f", lw=1.2, label="slope 2")
    right.axhline(0.01, color="#8a8a8a", lw=0.8)
    right.text(size[-1], 0.0105, "1 %", fontsize=8, color="#5a5a5a")
    columns = [round(1 / s) for s in size]
    right.set_xticks(size, [f"1/{c}" for c in columns])
    right.minorticks_off()
    right.set(xlabel="column width / wavelength", ylabel="relative error of $g$")
    right.legend(frameon=False, fontsize=8, title="stiffness ratio", title_fontsize=8, loc="lower right")
    right.set_title("filled: isotropic, z blocked; open: growth in x only", fontsize=10)
    return figure


def fold() -> None:
    """Fold a strip with a cortex three times as stiff as white matter, and draw it."""
    history = simulate(Config(geometry={"shape": "strip"}, material={"stiffness_ratio": 3.0}))
    save_figure(folded_picture(history, summarise(history)), HERE / "strip-folded.png", dpi=150)


if __name__ == "__main__":
    fold()
    values = results()
    print_table(values)
    draw(values).savefig(HERE / "strip-onset.png", dpi=130, metadata={"Software": None})
