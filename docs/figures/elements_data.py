"""Computes the numbers of docs/elements.md: `python docs/figures/elements_data.py`, five minutes of one core.

They are those that tests/convergence holds the elements to, on more levels.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "tests" / "convergence"))

from cook import tip_deflection  # noqa: E402
from growing_circle import circle_errors, configured  # noqa: E402
from manufactured import Manufactured  # noqa: E402
from panels import ELEMENTS, Panel, square, straight_square  # noqa: E402
from test_circle_rates import CASES  # noqa: E402
from test_manufactured import pressure_errors, ring  # noqa: E402
from test_onset_rates import relative_error  # noqa: E402

DATA = HERE / "elements.json"
RATIOS = (0.3, 0.458, 0.4999)


def family(name: str) -> tuple[Callable[[int, str], Panel], float, dict[bool, tuple[int, ...]]]:
    """Mesh of a level and element, size of the solution, and levels of quadratic and other elements."""
    squares = {True: (4, 8, 16, 32), False: (8, 16, 32, 64)}
    if name == "distorted":
        return square, 1.0, squares
    if name == "ring":
        return ring, 2.0, {True: (1, 2, 4), False: (1, 2, 4, 8)}
    return lambda n, element: straight_square(n, element, name), 1.0, squares


def manufactured() -> Iterable[tuple[str, Any]]:
    """Points and errors of every family, Poisson's ratio, element and level."""
    for name in ("distorted", "ring", "parallel", "alternating"):
        build, size, levels = family(name)
        for nu in RATIOS:
            for element in ELEMENTS:
                rows = []
                for level in levels[element == "quadratic"]:
                    panel = build(level, element)
                    rows.append([len(panel.points), *Manufactured(nu, size).errors(panel)])
                yield f"{name} {nu} {element}", rows


def pressures() -> Iterable[tuple[str, Any]]:
    """Errors of the pressure of mean dilatation, per quadrilateral and per four."""
    for name in ("parallel", "alternating"):
        yield name, [[n, *pressure_errors(n, name)] for n in (8, 16, 32, 64)]


def panels() -> Iterable[tuple[str, Any]]:
    """Tip deflections of Cook's panel."""
    for nu in RATIOS[1:]:
        for element in ELEMENTS:
            squares = (4, 8, 16, 32, 64) if element == "quadratic" else (8, 16, 32, 64)
            if nu == RATIOS[-1]:
                squares = squares[:-1]
            per_side = 2 if element == "quadratic" else 1
            rows = [[(per_side * n + 1) ** 2, tip_deflection(n, element, nu)] for n in squares]
            yield f"{nu} {element}", rows


def circles() -> Iterable[tuple[str, Any]]:
    """Errors on the growing circle."""
    for out_of_plane in ("blocked", "generalised"):
        for case, (ratio, duration) in CASES.items():
            for element in ELEMENTS:
                if out_of_plane == "generalised" and (case == "uniform" or element == "mean_dilatation"):
                    continue
                growth = {
                    "growth.ratio": ratio,
                    "growth.duration": duration,
                    "growth.out_of_plane": out_of_plane,
                }
                levels = (1, 2, 4, 8) if element == "quadratic" and case == "uniform" else (1, 2, 4)
                levels = levels if element == "quadratic" else (2, 4, 8)
                rows = [[level, *circle_errors(configured(level, element, **growth))] for level in levels]
                yield f"{out_of_plane} {case} {element}", rows


def onsets() -> Iterable[tuple[str, Any]]:
    """Relative errors of the critical growth ratio."""
    for element, meshes in (
        ("quadratic", ((144, 8, 4), (216, 12, 6), (288, 16, 8))),
        ("mean_dilatation", ((216, 12, 6), (288, 16, 8), (432, 24, 12))),
        ("linear", ((216, 12, 6), (288, 16, 8), (432, 24, 12))),
    ):
        yield f"1 {element}", [[mesh[0], relative_error(mesh, element=element)] for mesh in meshes]
    yield "1/1.36 quadratic", [[n, relative_error((n, n // 18, n // 36), 1 / 1.36)] for n in (216, 288)]


def main() -> None:
    """Compute the parts named on the command line, or all."""
    parts = {
        "manufactured": manufactured,
        "pressures": pressures,
        "panels": panels,
        "circles": circles,
        "onsets": onsets,
    }
    data = json.loads(DATA.read_text(encoding="utf-8")) if DATA.exists() else {}
    for name in sys.argv[1:] or parts:
        data[name] = {}
        for key, rows in parts[name]():
            data[name][key] = np.asarray(rows, dtype=float).tolist()
            print(name, key, flush=True)
        DATA.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
