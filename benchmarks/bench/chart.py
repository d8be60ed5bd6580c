"""The picture of docs/planning-3d.md: seconds and memory over the number of tetrahedra, and beyond."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from bench.environment import ROOT
from bench.figures import HISTORY, Figure, latest

PICTURE = ROOT / "docs" / "figures" / "planning-3d.png"
MILLION = 995_328
# Okabe and Ito's colours, which all readers tell apart, and a mark for each.
LINES = {
    "pardiso": ("PARDISO, factorisation", "factorisation", "#0072B2", "o"),
    "superlu": ("SuperLU, factorisation", "factorisation", "#D55E00", "s"),
    "multigrid": ("multigrid set-up", "setup", "#009E73", "^"),
    "multigrid solve": ("multigrid, residual $10^{-4}$", "seconds, loose", "#CC79A7", "v"),
}
MEMORY = {name: (LINES[name][0].split(",")[0].removesuffix(" set-up"), "memory", *LINES[name][2:]) for name in
          ("pardiso", "superlu", "multigrid")}  # fmt: skip


def draw(history: Path = HISTORY, picture: Path = PICTURE) -> None:
    """Draw what the latest measurement in space found; nothing where there is none."""
    found = latest(history)
    if "space" not in found:
        return
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figures = found["space"][1]
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.0), layout="constrained")
    for axis, lines, label, scale in zip(
        axes, (LINES, MEMORY), ("time on one thread (s)", "memory (GB)"), (1.0, 1e-3), strict=True
    ):
        for name, (title, quantity, colour, mark) in lines.items():
            _line(axis, figures, name.split()[0], quantity, scale, title, colour, mark)
        axis.set(xscale="log", yscale="log", xlabel="tetrahedra", ylabel=label)
        axis.grid(True, which="major", linewidth=0.4, color="0.85")
        axis.legend(fontsize=8, frameon=False, loc="upper left")
    axes[0].set_title("filled: measured; open: extrapolated", fontsize=9, loc="left")
    figure.savefig(picture, dpi=160, metadata={"Software": None})
    plt.close(figure)


def _line(axis, figures, name, quantity, scale, title, colour, mark) -> None:  # type: ignore[no-untyped-def]
    cells, values = points(figures, name, quantity)
    beyond = figures.get(f"{name}, a million: {quantity}")
    if not cells.size or beyond is None:
        return
    axis.plot(cells, scale * values, mark, linestyle="-", color=colour, label=title, markersize=5)
    ends = (cells[-1], MILLION), (scale * values[-1], scale * beyond.value)
    axis.plot(*ends, linestyle=":", color=colour)
    axis.plot(MILLION, scale * beyond.value, mark, color=colour, markerfacecolor="white", markersize=6)


def points(figures: dict[str, Figure], name: str, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Sizes and values of one measured quantity."""
    wanted = re.compile(rf"{re.escape(name)}, (\d+) cells: {re.escape(quantity)}$")
    pairs = [(int(m[1]), f.value) for n, f in figures.items() if (m := wanted.match(n))]
    array = np.array(sorted(pairs)).reshape(-1, 2)
    return array[:, 0], array[:, 1]
