"""Onset of folding of a strip on a mesh: growth at which the smooth state gets its first negative pivot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gyrify.config import Config
from gyrify.model.slice import Slice
from gyrify.solve.equilibrium import find_equilibrium
from gyrify.solve.newton import Criterion
from gyrify.solve.result import Result
from gyrify.theory import Bilayer, Wrinkle, critical_wrinkle

THICKNESS = 1.5
# The substrate does not grow, up to this ratio of growth strains.
GROWTH_RATIO = 1e4
READINGS = {
    "isotropic": {"out_of_plane": "blocked", "law": "isotropic"},
    "uniaxial": {"out_of_plane": "none", "law": "tangential"},
}


@dataclass(frozen=True)
class StripMesh:
    """Mesh of a strip that holds some critical wavelengths of the theory and is as deep as some.

    Attributes
    ----------
    columns : int
        Quadrilaterals along one wavelength.
    n_cortex_layers, n_layers : int
        Layers of the film, and of all.
    waves : int
        Wavelengths in the period.
    depth_waves : float
        Depth of the substrate in wavelengths.
    """

    columns: int = 48
    n_cortex_layers: int = 12
    n_layers: int = 40
    waves: int = 2
    depth_waves: float = 3.0

    def refined(self, factor: float) -> StripMesh:
        """The same strip with cells smaller by a factor."""
        return StripMesh(
            round(self.columns * factor),
            round(self.n_cortex_layers * factor),
            round(self.n_layers * factor),
            self.waves,
            self.depth_waves,
        )


def theory(stiffness_ratio: float, loading: str) -> Wrinkle:
    """Exact onset on a half-space of the paper's tissue."""
    return critical_wrinkle(Bilayer(stiffness_ratio, 0.458, loading=loading, growth_ratio=GROWTH_RATIO))


def strip(stiffness_ratio: float, loading: str, mesh: StripMesh) -> Config:
    """Strip without jitter, dissipation and contact; growth time runs from 0 to 1, and g = 1 + time."""
    wavelength = 2 * np.pi * THICKNESS / theory(stiffness_ratio, loading).scaled_thickness
    return Config(
        geometry={
            "shape": "strip",
            "length": mesh.waves * wavelength,
            "depth": THICKNESS + mesh.depth_waves * wavelength,
            "cortical_thickness": THICKNESS,
        },
        mesh={
            "n_around": mesh.waves * mesh.columns,
            "n_layers": mesh.n_layers,
            "n_cortex_layers": mesh.n_cortex_layers,
            "node_jitter": 0.0,
        },
        material={"stiffness_ratio": stiffness_ratio},
        growth={"rate": 1.0, "duration": 1.0, "ratio": GROWTH_RATIO, **READINGS[loading]},
        dissipation={"kind": "none"},
        contact={"enabled": False},
    )


class SmoothStrip:
    """The smooth state of a strip as a function of the growth stretch g of its film."""

    def __init__(self, config: Config) -> None:
        self.problem = Slice(config)
        self.system = self.problem.system(np.empty((0, 2), dtype=np.int64))
        self.u = np.zeros_like(self.problem.mesh.points)

    def tangent(self, g: float):
        """Tangent stiffness at the smooth equilibrium, which is found from the last one."""
        problem = self.problem
        energy = problem.tissue_energy(g - 1.0, self.u)
        force = 1e-9 * problem.config.material.young_modulus
        found = find_equilibrium(energy, self.u, self.system, Criterion(force, 60), problem.candidates)
        assert found.result is Result.CONVERGED, found
        self.u = found.u
        return problem.tangent(g - 1.0, self.u, self.u, self.system)

    def onset(self, expected: float, tolerance: float = 1e-5) -> float:
        """Critical g by bisection, to a relative tolerance in g - 1, from 10 % below the expected one on."""
        low, high = 1 + 0.9 * (expected - 1), expected
        assert self.tangent(low).is_stable
        while self.tangent(high).is_stable:
            low, high = high, 1 + 1.05 * (high - 1)
        while high - low > tolerance * (high - 1):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.tangent(middle).is_stable else (low, middle)
        return 0.5 * (low + high)


def onset(stiffness_ratio: float, loading: str, mesh: StripMesh) -> float:
    """Critical g of a strip."""
    return SmoothStrip(strip(stiffness_ratio, loading, mesh)).onset(theory(stiffness_ratio, loading).load)
