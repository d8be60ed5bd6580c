"""Computes the numbers of docs/convergence.md: `python docs/figures/convergence_data.py FOLDER [WORKERS]`.

The runs are kept in FOLDER, and what is complete there is not run again; metrics go to convergence.json. In
all they take about half an hour of one core. A third argument is a part of names: those cases alone are
computed, and laid over the rest. `cost` in place of FOLDER measures what elements cost.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

from gyrify import Config, History, simulate
from gyrify.convergence.plan import contour_nodes, resolution
from gyrify.convergence.runs import complete_all

DATA = Path(__file__).with_name("convergence.json")
# Coarsest level of each element: as many contour nodes for all, halved twice.
COARSEST = {"linear": (108, 9, 3), "mean_dilatation": (108, 9, 3), "quadratic": (54, 5, 2)}
# Meshes of quadratic triangles between and beyond these levels.
BETWEEN = ((72, 7, 3), (144, 13, 5), (288, 27, 11))
DRAG = (1.3, 0.13)
# Twice the drag of the reference slice, to see whether more of it brings a limit nearer.
STRONG = 2.6
SEEDS = (1, 2, 3, 4)
# Runs whose shape is drawn.
SHAPES = (
    *(f"{element} {level} drag=1.3 seed=0" for element in ("linear", "quadratic") for level in (0, 1, 2)),
    *(f"quadratic 1 drag={number} seed=0" for number in (1.3, 0.4, 0.13, 0.04, 0.013)),
    "quadratic 1 no drag",
    "quadratic 1 branch followed",
)


def meshed(size: tuple[int, int, int], element: str, **others: object) -> dict[str, object]:
    """Overrides for a mesh."""
    around, layers, cortex = size
    mesh = {"mesh.n_around": around, "mesh.n_layers": layers, "mesh.n_cortex_layers": cortex}
    resistance = {"mesh.inversion_resistance": 0.1} if element == "quadratic" else {}
    return {"mesh.element": element, **mesh, **resistance, **others}


def cases() -> dict[str, dict[str, object]]:
    """Overrides of the reference slice, by the name of the case."""
    found: dict[str, dict[str, object]] = {}
    for number in DRAG:
        for seed in (0, *SEEDS):
            for element, size in COARSEST.items():
                for level in (0, 1, 2):
                    if not is_computed(element, level, number, seed):
                        continue
                    others = {"mesh.refine": level, "dissipation.number": number, "seed": seed}
                    found[f"{element} {level} drag={number} seed={seed}"] = meshed(size, element, **others)
    return found | singles()


def singles() -> dict[str, dict[str, object]]:
    """Cases outside the ensembles: increments, contact, drag, jitter, other meshes."""
    found: dict[str, dict[str, object]] = {"standard": {}}
    found |= {f"increments {n}": {"solver.increments": n} for n in (50, 200)}
    found |= {f"contact 1/{n}": {"contact.activation_fraction": 0.0667 / n} for n in (2, 4)}
    middle: dict[str, object] = meshed(COARSEST["quadratic"], "quadratic", **{"mesh.refine": 1})
    for number in (0.4, 0.04, 0.013):
        found[f"quadratic 1 drag={number} seed=0"] = {**middle, "dissipation.number": number}
    free: dict[str, object] = {**middle, "dissipation.kind": "none"}
    found["quadratic 1 no drag"] = free
    perfect: dict[str, object] = {"dissipation.kind": "none", "mesh.node_jitter": 0.0}
    for level in (0, 1, 2):
        followed = {"mesh.refine": level, "stability.follow_branch": True, **perfect}
        found[f"quadratic {level} branch followed"] = meshed(COARSEST["quadratic"], "quadratic", **followed)
    for jitter in (1e-4, 1e-2):
        for number in DRAG:
            others = {"mesh.node_jitter": jitter, "dissipation.number": number}
            found[f"quadratic 1 drag={number} jitter={jitter:g}"] = {**middle, **others}
    for increments in (200, 400):
        found[f"quadratic 1 increments={increments}"] = {**middle, "solver.increments": increments}
    fine = {**middle, "solver.increments": 400, "mesh.node_jitter": 1e-2}
    found["quadratic 1 increments=400 jitter=0.01"] = fine
    found["quadratic 1 cortex refined"] = {**middle, "mesh.refine_cortex": 1}
    for level in (0, 1, 2):
        strong: dict[str, object] = {"mesh.refine": level, "dissipation.number": STRONG}
        found[f"quadratic {level} drag={STRONG} seed=0"] = meshed(
            COARSEST["quadratic"], "quadratic", **strong
        )
    for size in BETWEEN:
        name = f"quadratic {size[0]} × {size[1]}"
        found[name] = meshed(size, "quadratic")
        found[f"{name} drag={STRONG}"] = meshed(size, "quadratic", **{"dissipation.number": STRONG})
        found[f"{name} branch followed"] = meshed(
            size, "quadratic", **perfect, **{"stability.follow_branch": True}
        )
        if size[0] < 288:
            found[f"{name} drag=0.13"] = meshed(size, "quadratic", **{"dissipation.number": 0.13})
    return found


def is_computed(element: str, level: int, number: float, seed: int) -> bool:
    """What the ensembles hold: fine levels cost too much to have them all."""
    if seed == 0:
        return True
    if level < 2:
        return element != "mean_dilatation"
    return element == "quadratic" and number == 1.3 and seed == 1


def configured(overrides: dict[str, object]) -> Config:
    """Configuration of a case."""
    return Config.preset("reference-slice").with_overrides(overrides)


def measure(folder: Path, workers: int, some: str = "") -> None:
    """Bring every run to its end, and store what was measured; with a part of names, those cases alone."""
    configs = {name: configured(overrides) for name, overrides in cases().items() if some in name}
    unique = list({config.config_hash: config for config in configs.values()}.values())
    total = len(unique)
    done: list[str] = []

    def tell(level: Any) -> None:
        done.append(level.folder.name)
        print(f"{len(done)} of {total}: {level.folder.name} {level.status} {level.reason}", flush=True)

    levels = complete_all(unique, folder, workers, tell)
    rows = {}
    for name, config in configs.items():
        level = levels[config.config_hash]
        rows[name] = {
            "overrides": cases()[name],
            "status": level.status,
            "reason": level.reason,
            "contour_nodes": contour_nodes(config),
            "distance_mm": round(resolution(config, "mesh"), 4),
            **{key: value if value is None else round(value, 5) for key, value in level.metrics.items()},
        }
    shapes = {name: lines(levels[configs[name].config_hash].folder) for name in SHAPES if name in configs}
    known = json.loads(DATA.read_text(encoding="utf-8")) if some else {"runs": {}, "shapes": {}}
    keep(runs={**known["runs"], **rows}, shapes={**known["shapes"], **shapes})


def lines(folder: Path) -> dict[str, Any]:
    """Contour, interface and hole of the last state of a run, to a hundredth of a millimetre."""
    history = History.load(folder)
    x, mesh = history.points().round(2), history.mesh
    return {
        "contour": x[mesh.contour].tolist(),
        "interface": x[mesh.interface].tolist(),
        "clamped": x[mesh.clamped].tolist(),
    }


def cost() -> None:
    """CPU time of runs in this process, in turn, each the best of two."""
    configs = {
        "linear 216 × 17": configured({}),
        "quadratic 108 × 9": configured(meshed((108, 9, 3), "quadratic")),
    }
    for config in configs.values():
        simulate(config.replace(**{"growth.duration": 5.0, "solver.increments": 1}))  # kernels are compiled
    best = dict.fromkeys(configs, float("inf"))
    for _ in range(2):
        for name, config in configs.items():
            begun = time.process_time()
            simulate(config)
            best[name] = min(best[name], time.process_time() - begun)
            print(name, best[name], flush=True)
    keep(cost_s={name: round(seconds, 2) for name, seconds in best.items()})


def keep(**parts: object) -> None:
    """Store parts of the data."""
    known = json.loads(DATA.read_text(encoding="utf-8")) if DATA.exists() else {}
    DATA.write_text(json.dumps({**known, **parts}, sort_keys=True) + "\n", encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1] == "cost":
        cost()
    else:
        measure(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1, "".join(sys.argv[3:4]))
