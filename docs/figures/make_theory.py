"""Draws the pictures of docs/theory-onset.md and writes its tables: `python docs/figures/make_theory.py`."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import theory_curves as draw

from gyrify.theory import (
    Annulus,
    Bilayer,
    critical_growth_ratio,
    critical_growth_time,
    critical_surface,
    critical_wrinkle,
    crossings,
)

HERE = Path(__file__).parent
PAGE = HERE.parent / "theory-onset.md"
LOADINGS = ("compression", "uniaxial", "isotropic")
STIFFNESS = (1 / 3, 1 / 2.61, 1 / 2, 1 / 1.36, 1.0, 1.54, 2.0, 3.0)
READINGS: dict[str, dict[str, Any]] = {
    "blocked · linear · grown": {},
    "none · linear · grown": {"out_of_plane": "none"},
    "generalised · linear · grown": {"out_of_plane": "generalised"},
    "blocked · exponential · grown": {"stretch": "exponential"},
    "none · exponential · grown": {"out_of_plane": "none", "stretch": "exponential"},
    "blocked · linear · reference": {"energy_per": "reference"},
    "blocked · linear · grown, tangential": {"law": "tangential"},
}


def table(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def wrinkle(bilayer: Bilayer, strain: bool = False) -> str:
    """Critical load or compression with the wavelength, as `1.309 (3.62)`; `s` and `l` mark the limits."""
    onset = critical_wrinkle(bilayer)
    if not np.isfinite(onset.load):
        return "none"
    value = f"{onset.strain:.4f}" if strain else f"{onset.load:.4f}"
    if onset.is_substrate:
        return f"{value} (l)"
    return f"{value} (s)" if onset.is_surface else f"{value} ({onset.wavelength:.2f})"


def onsets(annulus: Annulus) -> str:
    """Every critical growth ratio with its mode, as `1.7595 (19)`."""
    found = critical_growth_ratio(annulus)
    return "; ".join(f"{c.value:.4f} ({c.mode_number or 's'})" for c in found) or "none"


def bilayer_tables() -> dict[str, str]:
    """Tables of the film on a half-space."""
    ratios = (0.8, 1.0, 1.54, 2.0, 3.0, 5.0, 10.0, 30.0, 100.0)
    head = ["β", "compressed: ε (L)", "growth in x: g (L)", "isotropic, z blocked: g (L)"]
    first = [
        [f"{b:g}", *(wrinkle(Bilayer(b, loading=x), strain=x == "compression") for x in LOADINGS)]
        for b in ratios
    ]
    ours = (1 / 1.36, 0.8, 1.0, 1.54, 2.0, 3.0, 5.0, 10.0, 30.0)
    second = [
        [
            draw.ratio_name(b),
            *(wrinkle(Bilayer(b, 0.458, loading=x), strain=x == "compression") for x in LOADINGS),
        ]
        for b in ours
    ]
    nus = (0.0, 0.3, 0.4, 0.458, 0.49, 0.5)
    third = []
    for nu in nus:
        loads = [critical_surface(Bilayer(1.0, nu, loading=x)).load for x in LOADINGS]
        bare = [f"{load:.4f}" if np.isfinite(load) else "none" for load in loads]
        third.append([f"{nu:g}", *bare, *(wrinkle(Bilayer(b, nu)) for b in (1.0, 3.0, 10.0))])
    variants = {
        "isotropic, z blocked": Bilayer(poisson_ratio=0.458),
        "… and the substrate grows, growth ratio 3.6": Bilayer(poisson_ratio=0.458, growth_ratio=3.6),
        "… per reference volume": Bilayer(poisson_ratio=0.458, energy_per="reference"),
        "in the plane, no growth in z": Bilayer(poisson_ratio=0.458, loading="plane"),
        "tangential, z blocked": Bilayer(poisson_ratio=0.458, loading="tangential"),
    }
    few = (1 / 1.36, 1.0, 2.0, 5.0)
    fourth = [
        [name, *(wrinkle(replace(case, stiffness_ratio=b)) for b in few)] for name, case in variants.items()
    ]
    ratios_below_one = (0.05, 0.1, 0.2, 0.35, 0.5, 0.8)
    films = (1 / 1.36, 1.0, 2.0, 5.0)
    fast = []
    for ratio in ratios_below_one:
        cases = [Bilayer(b, 0.458, growth_ratio=ratio) for b in films]
        limit = f"{critical_surface(cases[0], 'substrate').load:.4f}"
        fast.append([f"{ratio:g}", limit, *map(wrinkle, cases)])
    surfaces = [f"bare surface, {draw._LOADING_NAMES[x].split(',')[0]}" for x in LOADINGS]
    return {
        "incompressible": table(head, first),
        "ours": table(head, second),
        "poisson": table(["ν", *surfaces, *(f"film, isotropic, β = {b}: g (L)" for b in (1, 3, 10))], third),
        "fast": table(
            ["growth ratio", "substrate's surface", *(f"β = {draw.ratio_name(b)}" for b in films)], fast
        ),
        "variants": table(["film's growth", *(f"β = {draw.ratio_name(b)}" for b in few)], fourth),
    }


def annulus_tables() -> dict[str, str]:
    """Tables of the growing annulus."""
    names = [draw.ratio_name(b) for b in STIFFNESS]
    ratios = [
        [name, *(onsets(Annulus(stiffness_ratio=b, **reading)) for b in STIFFNESS)]
        for name, reading in READINGS.items()
    ]
    times = []
    for b in STIFFNESS:
        for c in critical_growth_time(Annulus(stiffness_ratio=b)):
            length = "0" if c.mode_number is None else f"{c.wavelength:.2f}"
            times.append([draw.ratio_name(b), f"{c.value:.2f}", f"{c.mode_number or 's'}", length])
    thick = [
        [f"{t:g}", *(onsets(Annulus(cortical_thickness=t, stiffness_ratio=b)) for b in (1 / 1.36, 1.0, 2.0))]
        for t in (0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0)
    ]
    return {
        "readings": table(["reading", *names], ratios),
        "times": table(["stiffness ratio", "growth time", "mode", "wavelength [mm]"], times),
        "thickness": table(["T [mm]", "1/1.36", "1", "2"], thick),
    }


def write(tables: dict[str, str]) -> None:
    """Replace the tables between their markers in the page."""
    text = PAGE.read_text(encoding="utf-8")
    for name, content in tables.items():
        pattern = rf"(<!-- {name} -->\n).*?(<!-- end -->)"
        text, count = re.subn(pattern, lambda m, c=content: f"{m[1]}{c}\n{m[2]}", text, flags=re.DOTALL)
        if count != 1:
            raise ValueError(f"The page has {count} tables named {name}.")
    PAGE.write_text(text, encoding="utf-8")


def pictures() -> None:
    """Draw every picture."""
    surface = {
        ratio: crossings(Annulus(stiffness_ratio=ratio), "growth_ratio", [2.2, 2.8])[0].value
        for ratio in (1 / 2.61, 1 / 3)
    }
    standard = Annulus()
    plots = {
        "neutral": draw.neutral_curves((0.8, 1.0, 1.54, 2.0, 3.0, 10.0, 30.0)),
        "critical": draw.critical_curves(np.geomspace(0.8, 200.0, 30).tolist()),
        "annulus-state": draw.base_states(standard, (100.0, 200.0, 300.0, 400.0, 500.0)),
        "annulus-dispersion": draw.annulus_dispersion(standard, (150.0, 200.0, 251.6, 300.0, 350.0)),
        "annulus-critical": draw.annulus_neutral_curves(
            standard,
            (3.0, 2.0, 1.0, 1 / 1.36, 1 / 2, 1 / 2.61, 1 / 3),
            surface,
            np.linspace(1.05, 3.4, 48).tolist(),
        ),
    }
    for name, figure in plots.items():
        figure.savefig(HERE / f"theory-{name}.png", dpi=130)


if __name__ == "__main__":
    pictures()
    write(bilayer_tables() | annulus_tables())
