"""Draws the pictures of docs/pictures.md from standard runs: `python docs/figures/make_pictures.py`."""

from __future__ import annotations

import tempfile
from pathlib import Path

from gyrify import Config, animate, plot, simulate
from gyrify.report import save_figure

HERE = Path(__file__).parent
DPI = 150
RATIOS = {"soft": 0.5, "stiff": 3.0}


def main() -> None:
    """Fold three slices, and draw every picture."""
    standard = Config.preset("reference-slice")
    with tempfile.TemporaryDirectory() as parent:
        runs = {"standard": simulate(standard, Path(parent, "standard"))}
        for name, ratio in RATIOS.items():
            changed = standard.with_overrides({"material.stiffness_ratio": ratio})
            runs[name] = simulate(changed, Path(parent, name))
        run, others = runs["standard"], [runs[name] for name in RATIOS]
        for what in ("gi", "stress", "thickness", "energy", "mode", "dispersion"):
            save_figure(plot(run, what), HERE / f"pictures-{what}.png", dpi=DPI)
        save_figure(plot(run, "folded", compare=others), HERE / "pictures-compare.png", dpi=DPI)
        animate(run, HERE / "growth.gif", fps=10, seconds=4, width=360)


if __name__ == "__main__":
    main()
