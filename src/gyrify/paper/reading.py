"""Readings of the paper: what it leaves open, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gyrify.config import Config
from gyrify.paper.cases import Case
from gyrify.paper.index import STANDARD_INDEX, Index
from gyrify.study import Point

# That of the package, fixed before any comparison: every free mesh is imperfect, and no paper says how much.
STANDARD_IMPERFECTION: Final = 1e-3
_DIAGONALS: Final = {"one": "one diagonal", "random": "random diagonals", "symmetric": "mirrored diagonals"}
# Stability is located by a threshold of its own, and costs a quarter of a run.
_PLAIN: Final = {"stability.detect": False, "stability.follow_branch": False}


@dataclass(frozen=True, order=True)
class Mechanics:
    """What of a reading changes the simulations.

    Attributes
    ----------
    out_of_plane, stretch, energy_per : str
        As in the section ``growth`` of the configuration.
    dissipation : str
        Kind of dissipation.
    number : float
        Dissipation number [-]; 0 where there is none.
    element : str
        Finite element.
    imperfection : float
        Node jitter, as a fraction of the local layer [-].
    exponent : float
        Growth along z as a power of that in the plane [-].
    course : str
        Of the dissipation over growth.
    grading, split : str
        Layers of the white matter, and diagonals of the mapped quadrilaterals.
    """

    out_of_plane: str = "blocked"
    stretch: str = "linear"
    energy_per: str = "grown"
    dissipation: str = "drag"
    number: float = 1.3
    element: str = "linear"
    imperfection: float = 1e-3
    exponent: float = 1.0
    course: str = "constant"
    grading: str = "geometric"
    split: str = "alternating"

    @classmethod
    def of(cls, config: Config) -> Mechanics:
        """That of a configuration."""
        growth, dissipation = config.growth, config.dissipation
        number = 0.0 if dissipation.kind == "none" else dissipation.number
        return cls(
            growth.out_of_plane,
            growth.stretch,
            growth.energy_per,
            dissipation.kind,
            number,
            config.mesh.element,
            config.mesh.node_jitter,
            growth.out_of_plane_exponent,
            dissipation.course,
            config.mesh.grading,
            config.mesh.split,
        )

    @property
    def overrides(self) -> dict[str, object]:
        """Its values by dotted key."""
        return {
            "growth.out_of_plane": self.out_of_plane,
            "growth.stretch": self.stretch,
            "growth.energy_per": self.energy_per,
            "dissipation.kind": self.dissipation,
            "dissipation.number": self.number,
            "mesh.element": self.element,
            "mesh.node_jitter": self.imperfection,
            "growth.out_of_plane_exponent": self.exponent,
            "dissipation.course": self.course,
            "mesh.grading": self.grading,
            "mesh.split": self.split,
        }

    @property
    def constants(self) -> tuple[str, ...]:
        """Numbers of it that can be chosen so that the result agrees, and that neither the paper nor anything
        known before the comparison gives."""
        fitted = {
            "exponent": self.exponent not in (0.0, 1.0),
            "dissipation number": self.dissipation != "none",
            "imperfection": self.imperfection not in (0.0, STANDARD_IMPERFECTION),
        }
        return tuple(name for name, is_fitted in fitted.items() if is_fitted)

    def __str__(self) -> str:
        drag = "no dissipation" if self.dissipation == "none" else f"{self.dissipation} {self.number:g}"
        drag += " reduced over growth" if self.course == "reduced" else ""
        jitter = f"imperfection {self.imperfection:g}"
        plane = self.out_of_plane + (f" to the power {self.exponent:g}" if self.exponent != 1.0 else "")
        mesh = f"{self.element} triangles"
        mesh += " in uniform layers" if self.grading == "uniform" else ""
        mesh += "" if self.split == "alternating" else f" with {_DIAGONALS[self.split]}"
        words = (plane, self.stretch, self.energy_per, drag, mesh, jitter)
        return ", ".join(words).replace("_", " ").replace("kelvin voigt", "Kelvin-Voigt")


@dataclass(frozen=True, order=True)
class Reading:
    """One reading of the paper.

    Attributes
    ----------
    mechanics : Mechanics
        What it simulates.
    gi : Index
        What it calls gyrification index, in every row.
    """

    mechanics: Mechanics = Mechanics()
    gi: Index = STANDARD_INDEX

    @property
    def constants(self) -> tuple[str, ...]:
        """Its fitted constants, by name."""
        return (*self.mechanics.constants, *self.gi.constants)

    def __str__(self) -> str:
        return f"{self.mechanics}; GI by {self.gi}"


def point_of(base: Config, mechanics: Mechanics, case: Case, seed: int) -> Point:
    """One run of a reading.

    Parameters
    ----------
    base : Config
        Everything that no reading changes.
    mechanics : Mechanics
        The reading.
    case : Case
        Which simulation of the paper.
    seed : int
        Seed of the node jitter.

    Returns
    -------
    Point
        Its parameters are what differs from the base.

    Raises
    ------
    ConfigError
        If the values do not go together.
    """
    own = Mechanics.of(base).overrides
    other = {key: value for key, value in mechanics.overrides.items() if value != own[key]}
    parameters = {**other, **_as_many_nodes(base, mechanics), **case.overrides, "seed": seed}
    # a branch is found by detection, and dissipation has none
    is_followed = (
        base.stability.follow_branch and mechanics.dissipation == "none" and mechanics.split != "symmetric"
    )
    plain = {} if is_followed else _PLAIN
    return Point(parameters, base.with_overrides({**plain, **parameters}))


def _as_many_nodes(base: Config, mechanics: Mechanics) -> dict[str, object]:
    """Half as many columns and layers where quadratic triangles take the place of others.

    They have a node in the middle of each edge, so that the paper's 216 nodes around stay 216. Folded, they
    need a resistance to inversion.
    """
    mesh = base.mesh
    if mechanics.element != "quadratic" or mesh.element == "quadratic":
        return {}
    return {
        "mesh.n_around": mesh.n_around // 2,
        "mesh.n_layers": (mesh.n_layers + 1) // 2,
        "mesh.n_cortex_layers": max(mesh.n_cortex_layers // 2, 2),
        "mesh.inversion_resistance": 0.1,
    }
