"""Onset of folding of random circles and strips against exact theory.

    python tools/random_onset.py --count 200 --workers 2    adds what is missing to docs/figures/onset.jsonl
    python tools/random_onset.py --page                     writes the table of docs/thresholds.md from it

A circle is held against the growing annulus, a strip against the film on a half-space. Each is meshed with
quadratic cells, ten points of the contour to the critical wavelength of the theory. Its onset must agree to
`TOLERANCE`, on this mesh or after its error, which one or two finer ones tell; or there must be a reason,
which the row holds.
"""

from __future__ import annotations

import argparse
import json
import re
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, Final

import numpy as np

from gyrify.config import Config
from gyrify.errors import ConfigError, MeshError, SolveError
from gyrify.model.slice import Slice
from gyrify.run.onset.onset_search import MARKS, OnsetSearch
from gyrify.solve.stability import Onset
from gyrify.theory import Annulus, Bilayer, critical_growth_time, critical_wrinkle

ROOT: Final = Path(__file__).resolve().parents[1]
ROWS: Final = ROOT / "docs" / "figures" / "onset.jsonl"
PAGE: Final = ROOT / "docs" / "thresholds.md"
TOLERANCE: Final = 2e-3
POINTS_PER_WAVE: Final = 10
# Error of quadratic cells: falls with the fourth power of their size.
ORDER: Final = 4.0
FINER: Final = 1.5
MOST_POINTS: Final = 520
TIMES: Final = np.linspace(0.0, 500.0, 26).tolist()
# Waves shorter than this many thicknesses are those of the surface, whose limit has no wavelength.
SHORT: Final = 2.0


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A number between two, by its logarithm."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def one_of(rng: np.random.Generator, *values: Any) -> Any:
    """One of some values."""
    return values[int(rng.integers(len(values)))]


def circle(rng: np.random.Generator) -> tuple[dict[str, Any], Annulus]:
    """Values of a configuration, and the annulus that it is."""
    hole, radius = float(rng.uniform(0.1, 0.9)), 36.0
    reading = {
        "out_of_plane": one_of(rng, "blocked", "blocked", "none", "generalised"),
        "stretch": one_of(rng, "linear", "exponential"),
        "energy_per": one_of(rng, "grown", "grown", "reference"),
        "law": one_of(rng, "isotropic", "tangential"),
    }
    thickness = min(log_uniform(rng, 0.9, 5.0), 0.6 * radius * (1.0 - hole))
    material = {
        "stiffness_ratio": log_uniform(rng, 0.6, 6.0),
        "poisson_ratio": float(rng.uniform(0.2, 0.47)),
        "poisson_ratio_white": float(rng.uniform(0.2, 0.47)),
    }
    ratio = log_uniform(rng, 1.3, 30.0)
    annulus = Annulus(
        inner_radius=hole * radius,
        outer_radius=radius,
        cortical_thickness=thickness,
        growth_ratio=ratio,
        **material,
        **reading,
    )
    values = {
        "geometry.shape": "circle",
        "geometry.area": float(np.pi * radius**2),
        "geometry.hole_fraction": hole,
        "geometry.cortical_thickness": thickness,
        "growth.ratio": ratio,
        **{f"material.{key}": value for key, value in material.items()},
        **{f"growth.{key}": value for key, value in reading.items()},
    }
    return values, annulus


def strip(rng: np.random.Generator) -> tuple[dict[str, Any], Bilayer]:
    """Values of a strip of two critical wavelengths, three deep, and the bilayer that it is."""
    loading = one_of(rng, "isotropic", "uniaxial")
    ratio, poisson = log_uniform(rng, 0.75, 10.0), float(rng.uniform(0.3, 0.48))
    bilayer = Bilayer(ratio, poisson, loading=loading, growth_ratio=1e4)
    values = {
        "geometry.shape": "strip",
        "material.stiffness_ratio": ratio,
        "material.poisson_ratio": poisson,
        "growth.ratio": 1e4,
        "growth.out_of_plane": "blocked" if loading == "isotropic" else "none",
        "growth.law": "isotropic" if loading == "isotropic" else "tangential",
    }
    return values, bilayer


def drawn(number: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Values of a configuration, and what theory says: growth time, mode number, wavelength."""
    rng = np.random.default_rng([14, number])
    values: dict[str, Any]
    if number % 10 < 7:
        values, annulus = circle(rng)
        found = critical_growth_time(annulus, TIMES)
        first = found[0] if found else None
        exact = {
            "time": first.value if first else None,
            "mode": first.mode_number if first else None,
            "is_surface": first is not None and first.mode_number is None,
        }
        values["mesh.n_layers"], values["mesh.n_cortex_layers"] = 20, 4
    else:
        values, bilayer = strip(rng)
        wrinkle = critical_wrinkle(bilayer)
        wavelength = 2.0 * np.pi * 1.5 / wrinkle.scaled_thickness
        time = (wrinkle.load - 1.0) / 0.002
        exact = {"time": time if time < 500.0 else None, "mode": 2, "is_surface": False}
        values |= {"geometry.length": 2.0 * wavelength, "geometry.depth": 1.5 + 3.0 * wavelength}
        values |= {"mesh.n_layers": 20, "mesh.n_cortex_layers": 5}
    values["dissipation.number"] = log_uniform(rng, 0.01, 30.0)
    values["mesh.element"] = "quadratic"
    values["seed"] = number
    return values, exact


def first_onset(config: Config) -> tuple[Onset | None, float | None]:
    """Onset as a run of the configuration stores it, and where the smooth branch is lost."""
    search = OnsetSearch(Slice(config))
    for mark in range(1, MARKS + 1):
        search.follow(mark / MARKS)
        if search.onset is not None or search.lost_at is not None:
            break
    return search.onset, search.lost_at


def meshed(values: dict[str, Any], waves: int, factor: float) -> Config:
    """Configuration with a mesh for a number of waves, finer by a factor."""
    points = max(48, round(POINTS_PER_WAVE * factor * waves))
    layers = {key: round(factor * values[key]) for key in ("mesh.n_layers", "mesh.n_cortex_layers")}
    return Config.preset("reference-slice").with_overrides({**values, "mesh.n_around": points, **layers})


def row(number: int) -> dict[str, Any]:
    """One configuration: theory, ours, and the verdict."""
    values, exact = drawn(number)
    found = {"number": number, "shape": values["geometry.shape"], "values": values, "exact": exact}
    waves = exact["mode"] if exact["mode"] else 24
    if POINTS_PER_WAVE * waves > MOST_POINTS:
        return {
            **found,
            "verdict": "reason",
            "reason": f"{waves} waves need too fine a mesh for this campaign",
        }
    try:
        onset, lost = first_onset(meshed(values, waves, 1.0))
        found["ours"] = None if onset is None else [onset.growth_time, onset.mode_number, onset.kind]
        if exact["time"] is None or exact["is_surface"]:
            return {**found, **_without_a_wave(exact, onset, lost)}
        if onset is None:
            reason = f"the smooth branch was followed to growth time {lost:.6g}" if lost else ""
            return {**found, "verdict": "reason" if reason else "wrong", "reason": reason}
        error = onset.growth_time / exact["time"] - 1.0
        found["error"] = error
        if abs(error) <= TOLERANCE:
            return {**found, "verdict": "agrees", "reason": ""}
        return {**found, **_after_the_mesh(values, waves, [error], exact["time"])}
    except (ConfigError, MeshError, SolveError) as fault:
        return {**found, "verdict": "reason", "reason": str(fault)}


def _after_the_mesh(values: dict[str, Any], waves: int, errors: list[float], time: float) -> dict[str, Any]:
    """Verdict from finer meshes: their errors, and what is left of the last two at the order of the cells."""
    found: dict[str, Any] = {}
    for name in ("finer", "finest"):
        onset, _ = first_onset(meshed(values, waves, FINER ** len(errors)))
        if onset is None:
            return {**found, "verdict": "wrong", "reason": f"the {name} mesh finds no onset"}
        errors.append(onset.growth_time / time - 1.0)
        left = errors[-1] - (errors[-2] - errors[-1]) / (FINER**ORDER - 1.0)
        found |= {name: errors[-1], "left": left}
        if min(abs(errors[-1]), abs(left)) <= TOLERANCE:
            return {**found, "verdict": "agrees", "reason": "after the error of the mesh"}
    return {**found, "verdict": "wrong", "reason": "after the error of the mesh"}


def _without_a_wave(exact: dict[str, Any], onset: Onset | None, lost: float | None) -> dict[str, Any]:
    """Verdict where theory has no critical wave: none before growth ends, or that of the surface."""
    if exact["time"] is None:
        if onset is None:
            return {"verdict": "agrees", "reason": "stable to the end in both"}
        return {"verdict": "wrong", "reason": "theory is stable to the end"}
    if onset is None:
        return {"verdict": "agrees", "reason": f"surface limit at {exact['time']:.6g}, beyond this mesh"}
    is_late = onset.growth_time > 0.998 * exact["time"]
    reason = f"surface limit at {exact['time']:.6g}: the mesh decides ({onset.kind}, lost {lost})"
    return {"verdict": "agrees" if is_late else "wrong", "reason": reason}


def known() -> dict[int, dict[str, Any]]:
    """Rows on file, by number."""
    lines = ROWS.read_text(encoding="utf-8").splitlines() if ROWS.is_file() else []
    return {found["number"]: found for found in map(json.loads, lines)}


def compute(count: int, workers: int) -> None:
    """Add the rows that are missing."""
    rows = known()
    with ProcessPoolExecutor(workers) as pool:
        for found in pool.map(row, [number for number in range(count) if number not in rows]):
            rows[found["number"]] = found
            text = "".join(json.dumps(rows[number]) + "\n" for number in sorted(rows))
            ROWS.write_text(text, encoding="utf-8")
            print(found["number"], found["verdict"], found.get("error"), found["reason"], flush=True)


def page() -> None:
    """Write the table into the page."""
    rows = list(known().values())
    lines = [
        "| shape | configurations | agree on the first mesh | after its error | no wave | reason | wrong |"
    ]
    lines.append("|---|---|---|---|---|---|---|")
    for shape in ("circle", "strip"):
        own = [r for r in rows if r["shape"] == shape]
        first = [r for r in own if r["verdict"] == "agrees" and abs(r.get("error", 1.0)) <= TOLERANCE]
        after = [r for r in own if r["verdict"] == "agrees" and "left" in r]
        none = [r for r in own if r["verdict"] == "agrees" and "error" not in r]
        counts = [len(own), len(first), len(after), len(none)]
        counts += [sum(r["verdict"] == verdict for r in own) for verdict in ("reason", "wrong")]
        lines.append(f"| {shape} | " + " | ".join(map(str, counts)) + " |")
    errors = [abs(r["error"]) for r in rows if "error" in r]
    lines += ["", f"Median error on the first mesh {np.median(errors):.2%}, largest {max(errors):.2%}."]
    text = PAGE.read_text(encoding="utf-8")
    block = "<!-- random -->\n" + "\n".join(lines) + "\n<!-- end -->"
    PAGE.write_text(re.sub(r"<!-- random -->.*?<!-- end -->", block, text, flags=re.S), encoding="utf-8")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    page() if given.page else compute(given.count, given.workers)
