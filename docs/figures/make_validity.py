"""Prints the tables of docs/validity.md: delay of the onset by mesh, and what locking does to the index."""

from __future__ import annotations

import sys
from typing import Any

from gyrify.config import Config
from gyrify.errors import GyrifyError
from gyrify.run.simulation import simulate
from gyrify.run.summary import measure_state
from gyrify.run.validity.expected import expected_onset
from gyrify.run.validity.resolution import _SmoothMesh

CIRCLE = {"geometry.shape": "circle"}
TISSUES: dict[str, dict[str, Any]] = {
    "standard": {},
    "T = 0.5 mm": {"geometry.cortical_thickness": 0.5},
    "E ratio 5": {"material.stiffness_ratio": 5.0},
    "E ratio 0.5": {"material.stiffness_ratio": 0.5},
    "published": {
        "geometry.cortical_thickness": 1.48,
        "material.stiffness_ratio": 1 / 1.691,
        "material.poisson_ratio": 0.406,
        "growth.rate": 1.829 / 500,
        "growth.ratio": 1e4,
        "growth.law": "tangential",
    },
}
POINTS = (4, 6, 8, 12, 16, 24)
LAYERS = (2, 3, 4, 6, 8, 12)
POISSON = (0.458, 0.47, 0.48, 0.49, 0.495, 0.499)


def delay(changes: dict[str, Any]) -> str:
    """Onset of a mesh over the exact one, less one."""
    config = Config().replace(**CIRCLE, **changes)
    exact = expected_onset(config).growth_time
    assert exact is not None
    mesh, start, end = _SmoothMesh(config), 0.9 * exact, 1.1 * exact
    try:
        while mesh.is_stable(end):
            start, end = end, 1.1 * end
            if end > 3.0 * exact:
                return "> 200 %"
        while end - start > 1e-4 * exact:
            middle = 0.5 * (start + end)
            start, end = (middle, end) if mesh.is_stable(middle) else (start, middle)
    except GyrifyError:
        return "–"
    return f"{100.0 * (end / exact - 1.0):.1f} %"


def by_points() -> None:
    """Points of the contour on a wave."""
    print("| tissue | element | " + " | ".join(f"{n} points" for n in POINTS) + " |")
    print("|---|---|" + "---:|" * len(POINTS))
    for name, tissue in TISSUES.items():
        number = expected_onset(Config().replace(**CIRCLE, **tissue)).mode_number
        assert number is not None
        for element, nodes in (("linear", 1), ("mean_dilatation", 1), ("quadratic", 2)):
            columns = [max(24, 2 * round(0.5 * n * number / nodes)) for n in POINTS]
            cells = {
                "mesh.n_cortex_layers": 6 // nodes,
                "mesh.n_layers": 18 // nodes,
                "mesh.element": element,
            }
            found = [delay({**tissue, **cells, "mesh.n_around": n}) for n in columns]
            print(f"| {name} | {element.replace('_', ' ')} | " + " | ".join(found) + " |")


def by_layers() -> None:
    """Layers through the cortex, with 24 points of the contour on a wave."""
    print("| element | " + " | ".join(f"{n} layers" for n in LAYERS) + " |")
    print("|---|" + "---:|" * len(LAYERS))
    for element, columns in (("linear", 456), ("mean_dilatation", 456), ("quadratic", 228)):
        cells = {"mesh.n_around": columns, "mesh.element": element}
        found = [delay({**cells, "mesh.n_cortex_layers": n, "mesh.n_layers": 3 * n}) for n in LAYERS]
        print(f"| {element.replace('_', ' ')} | " + " | ".join(found) + " |")


def locking() -> None:
    """Gyrification index of linear triangles against those that average the volume (runs, some minutes)."""
    print("| Poisson ratio | linear | mean dilatation | difference |")
    print("|---:|---:|---:|---:|")
    for nu in POISSON:
        values = []
        for element in ("linear", "mean_dilatation"):
            changes = {"material.poisson_ratio": nu, "mesh.element": element, "solver.increments": 50}
            config = Config().replace(**changes, **{"stability.detect": False})
            values.append(measure_state(simulate(config)).gi_closing)
        print(f"| {nu:g} | {values[0]:.3f} | {values[1]:.3f} | {100 * (values[0] / values[1] - 1):.0f} % |")


if __name__ == "__main__":
    by_points()
    by_layers()
    if "--runs" in sys.argv:
        locking()
