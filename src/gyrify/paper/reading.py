"""Readings of the paper: what it leaves open, as data."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Final

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.paper.cases import Case
from gyrify.paper.row import GI_DEFINITIONS, GiDefinition
from gyrify.study import Point

OUT_OF_PLANE: Final = ("blocked", "none", "generalised")
STRETCH: Final = ("linear", "exponential")
ENERGY_PER: Final = ("grown", "reference")
ELEMENTS: Final = ("linear", "quadratic", "mean_dilatation")
DISSIPATION: Final = (("drag", 0.13), ("drag", 1.3), ("drag", 5.0), ("kelvin_voigt", 0.1), ("none", 0.0))
# Numbers between and beside those, for the readings that are best with them.
FINER: Final = {"drag": (0.013, 0.4, 2.6), "kelvin_voigt": (0.01, 1.0), "none": ()}
# Node jitter, as a fraction of the local layer: every free mesh is imperfect, and no paper says by how much.
IMPERFECTIONS: Final = (1e-3, 1e-2, 3e-2, 1e-1)
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
        }

    def __str__(self) -> str:
        drag = "no dissipation" if self.dissipation == "none" else f"{self.dissipation} {self.number:g}"
        drag += " reduced over growth" if self.course == "reduced" else ""
        jitter = f"imperfection {self.imperfection:g}"
        plane = self.out_of_plane + (f" to the power {self.exponent:g}" if self.exponent != 1.0 else "")
        words = (plane, self.stretch, self.energy_per, drag, f"{self.element} triangles", jitter)
        return ", ".join(words).replace("_", " ").replace("kelvin voigt", "Kelvin-Voigt")


@dataclass(frozen=True, order=True)
class Reading:
    """One reading of the paper.

    Attributes
    ----------
    mechanics : Mechanics
        What it simulates.
    gi : {"closing", "hull", "exposed"}
        What it calls gyrification index, in every row.
    """

    mechanics: Mechanics = Mechanics()
    gi: GiDefinition = "closing"

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
    return Point(parameters, base.with_overrides({**_PLAIN, **parameters}))


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


def grid(element: str = "linear") -> list[Mechanics]:
    """All combinations of the axes with one element."""
    axes = product(OUT_OF_PLANE, STRETCH, ENERGY_PER, DISSIPATION)
    return [Mechanics(plane, stretch, per, kind, c, element) for plane, stretch, per, (kind, c) in axes]


def variants(mechanics: Mechanics) -> list[Mechanics]:
    """The same with one thing changed: the element, the number of its dissipation, or the imperfection."""
    return [
        *(replace(mechanics, element=element) for element in ELEMENTS if element != mechanics.element),
        *(replace(mechanics, number=c) for c in _numbers(mechanics.dissipation) if c != mechanics.number),
        *(replace(mechanics, imperfection=a) for a in IMPERFECTIONS if a != mechanics.imperfection),
    ]


def edges(mechanics: Mechanics) -> list[str]:
    """What of a reading is the least or the most that was tried, in words."""
    tried = {
        "dissipation number": (mechanics.number, _numbers(mechanics.dissipation)),
        "imperfection": (mechanics.imperfection, list(IMPERFECTIONS)),
    }
    return [
        f"{name} {value:g} is the {'smallest' if value == min(values) else 'largest'} that was tried"
        for name, (value, values) in tried.items()
        if len(values) > 1 and value in (min(values), max(values))
    ]


def _numbers(dissipation: str) -> list[float]:
    """All numbers that are tried with a kind of dissipation."""
    return sorted([*FINER[dissipation], *(c for kind, c in DISSIPATION if kind == dissipation)])


def require_gi(word: str) -> GiDefinition:
    """A definition of the index by its name.

    Raises
    ------
    ConfigError
        If there is none of that name.
    """
    for known in GI_DEFINITIONS:
        if word == known:
            return known
    raise ConfigError(f"gi = {word[:60]!r} is not known.", f"Choose one of {', '.join(GI_DEFINITIONS)}.")
