"""Computes the numbers behind docs/thresholds.md: `python docs/figures/threshold_data.py [part ...]`.

Each part is kept in thresholds.json as soon as it is known; a part that is there is not computed again.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

from gyrify import Config, critical_growth, simulate
from gyrify.theory import Annulus, critical_growth_ratio

DATA = Path(__file__).with_name("thresholds.json")
STIFFNESS = {"1/3": 1 / 3, "1/2.61": 1 / 2.61, "1/1.36": 1 / 1.36, "1": 1.0, "1.54": 1.54, "2": 2.0, "3": 3.0}
MESHES = {"108x9": (108, 9, 3), "216x17": (216, 17, 6), "324x26": (324, 26, 9), "432x34": (432, 34, 12)}
FINE = {"648x51": (648, 51, 18)}
DRAG = (0.01, 0.03, 0.1, 0.3, 0.65, 1.3, 2.6)


def known() -> dict[str, Any]:
    """What is stored."""
    return json.loads(DATA.read_text(encoding="utf-8")) if DATA.exists() else {}


def keep(part: str, key: str, compute: Callable[[], Any]) -> None:
    """Store a number of a part, unless it is known."""
    if key in known().get(part, {}):
        return
    value = compute()
    print(part, key, value, flush=True)
    data = known()
    data.setdefault(part, {})[key] = value
    DATA.write_text(json.dumps(data, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def meshed(size: tuple[int, int, int], **overrides: object) -> Config:
    """The reference slice on a mesh."""
    around, layers, cortex = size
    mesh = {"mesh.n_around": around, "mesh.n_layers": layers, "mesh.n_cortex_layers": cortex}
    return Config.preset("reference-slice").with_overrides({**mesh, **overrides})


def onset(config: Config, low: float, high: float, points: int = 9) -> dict[str, Any]:
    """Threshold growth ratio with its mode."""
    found = critical_growth(config, range=(low, high), points=points, tolerance=1e-5)
    return {"value": found.critical_value, "mode": found.mode_number, "wall_s": round(found.wall_s, 1)}


def exact() -> None:
    """Growth ratios of the exact annulus."""
    for name, ratio in STIFFNESS.items():
        keep("exact", name, lambda ratio=ratio: _exact(ratio))


def _exact(ratio: float) -> dict[str, Any]:
    first = critical_growth_ratio(Annulus(stiffness_ratio=ratio))[0]
    return {"value": first.value, "mode": first.mode_number}


def circle(meshes: dict[str, tuple[int, int, int]]) -> None:
    """Growth ratios of the circle on a family of meshes."""
    exact()
    for mesh, size in meshes.items():
        for name, ratio in STIFFNESS.items():
            guess = known()["exact"][name]["value"]
            config = meshed(size, **{"geometry.shape": "circle", "material.stiffness_ratio": ratio})
            keep("circle", f"{mesh} {name}", lambda c=config, g=guess: onset(c, 0.95 * g, 1.6 * g))


def ellipse() -> None:
    """Growth ratios of the standard ellipse on two meshes."""
    for mesh in ("216x17", "432x34"):
        for name in ("1", "1/1.36"):
            config = meshed(MESHES[mesh], **{"material.stiffness_ratio": STIFFNESS[name]})
            keep("ellipse", f"{mesh} {name}", lambda c=config: onset(c, 1.5, 2.4))


def dragged() -> None:
    """Growth ratios at which the final state of a dragged path ceases to be a minimum for the tissue."""
    for name in ("1", "1/1.36"):
        for number in DRAG:
            keep("dragged", f"{number:g} {name}", lambda d=number, n=name: _dragged(d, STIFFNESS[n]))


def _dragged(number: float, ratio: float) -> float:
    config = meshed(MESHES["216x17"], **{"mesh.node_jitter": 0.0, "material.stiffness_ratio": ratio})
    config = config.with_overrides({"dissipation.number": number, "stability.detect": False})

    def eigenvalue(growth_ratio: float) -> float:
        history = simulate(config.replace(**{"growth.ratio": growth_ratio}))
        problem, u = history.slice, history.displacement()
        system = problem.system(np.empty((0, 2), dtype=np.int64))
        return problem.tangent(1.0, u, history.displacement(-2), system).lowest().eigenvalue

    # Beyond its threshold a path with little drag folds and is stable again: walk up to the first change.
    low = 1.2
    while eigenvalue(low + 0.04) > 0.0:
        low += 0.04
    return float(brentq(eigenvalue, low, low + 0.04, xtol=2e-4))


if __name__ == "__main__":
    parts = {
        "circle": lambda: circle(MESHES),
        "ellipse": ellipse,
        "dragged": dragged,
        "fine": lambda: circle(FINE),
    }
    for part in sys.argv[1:] or parts:
        parts[part]()
