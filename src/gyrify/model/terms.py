"""The only list of the terms of the total energy: what each is called, its role, and how it is made."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Final, Literal, get_args

import numpy as np

from gyrify.energy.inversion import InversionBarrier
from gyrify.energy.kinematics import ElasticKinematics
from gyrify.energy.term import EnergyTerm, FloatArray
from gyrify.energy.viscous import DragEnergy, KelvinVoigtEnergy, green_lagrange, reduction

if TYPE_CHECKING:
    from gyrify.model.slice import Slice

Role = Literal["stored", "contact", "dissipative", "external"]
ROLES: Final[tuple[Role, ...]] = get_args(Role)
# What a state of the tissue itself has, whatever the way to it dissipates.
CONSERVATIVE: Final[tuple[Role, ...]] = ("stored", "contact", "external")


@dataclass(frozen=True, eq=False)
class GrowthStep:
    """An increment of growth, as terms see it.

    Attributes
    ----------
    problem : Slice
        The growing body.
    start_u : (n_rows, n_dim) float array
        Displacement at the start of the increment [mm].
    start, end : float
        Fractions of growth at its start and its end.
    internal : mapping of str to float array
        Internal variables at the start, by name.
    """

    problem: Slice
    start_u: FloatArray
    start: float
    end: float
    internal: Mapping[str, FloatArray] = field(default_factory=dict)

    @cached_property
    def kinematics(self) -> ElasticKinematics:
        """Cells in their grown state at the end."""
        return self.problem.kinematics(self.end * self.problem.config.growth.duration)


@dataclass(frozen=True)
class TermKind:
    """A term of the energy.

    Attributes
    ----------
    name : str
        What it is called.
    role : {"stored", "contact", "dissipative", "external"}
        Where its energy is booked: stored in the tissue; in what keeps things apart, which acts on nothing
        else; dissipated over the increment; or in the surroundings.
    build : callable
        The term in a `GrowthStep`; None where the configuration has none. Of a stored and of an external
        term the energy depends on the end of the step and not on its start.
    """

    name: str
    role: Role
    build: Callable[[GrowthStep], EnergyTerm | None]


def terms_of(step: GrowthStep, roles: Iterable[Role] = ROLES) -> list[tuple[TermKind, EnergyTerm]]:
    """Terms of some roles in a step, in the order in which they are summed."""
    wanted = set(roles)
    built = ((kind, kind.build(step)) for kind in TERMS if kind.role in wanted)
    return [(kind, term) for kind, term in built if term is not None]


def _elastic(step: GrowthStep) -> EnergyTerm:
    return step.problem.elastic_energy(step.kinematics)


def _drag(step: GrowthStep) -> EnergyTerm | None:
    problem = step.problem
    if problem.config.dissipation.kind != "drag" or problem.is_conservative:
        return None
    length = problem.config.geometry.drag_length * problem.config.boundary.whole
    coefficient = _rate(step) / length**2
    return DragEnergy(coefficient, problem.lumped_area, step.start_u)


def _kelvin_voigt(step: GrowthStep) -> EnergyTerm | None:
    problem = step.problem
    if problem.config.dissipation.kind != "kelvin_voigt" or problem.is_conservative:
        return None
    start_time = step.start * problem.config.growth.duration
    strain = green_lagrange(problem.kinematics(start_time).deformation(step.start_u))
    weight = problem.weight(step.kinematics)
    return KelvinVoigtEnergy(step.kinematics, _rate(step), weight, strain, problem.pattern)


def _rate(step: GrowthStep) -> float:
    """Dissipation number times Young's modulus over the span of the step [Pa]."""
    config = step.problem.config
    number = config.dissipation.number * reduction(config.dissipation.course, step.end)
    return number * config.material.young_modulus / (step.end - step.start)


def _inversion(step: GrowthStep) -> EnergyTerm | None:
    problem = step.problem
    share, curved = problem.config.mesh.inversion_resistance, problem.simplices.curved
    if share == 0.0 or curved is None:
        return None
    first = np.searchsorted(problem.simplices.cell, np.arange(problem.mesh.n_cells))
    return InversionBarrier(curved, share * problem.config.material.young_modulus, problem.pattern, first)


def _contact(step: GrowthStep) -> EnergyTerm | None:
    return step.problem.contact_energy(step.start_u) if step.problem.config.contact.enabled else None


def _plane(step: GrowthStep) -> EnergyTerm | None:
    problem = step.problem
    is_met = problem.mesh.on_plane.size > 0 and problem.config.contact.enabled
    return problem.plane_contact(step.start_u) if is_met else None


TERMS: Final[list[TermKind]] = [
    TermKind("elasticity", "stored", _elastic),
    TermKind("drag", "dissipative", _drag),
    TermKind("Kelvin-Voigt dissipation", "dissipative", _kelvin_voigt),
    TermKind("resistance to inversion", "contact", _inversion),
    TermKind("contact", "contact", _contact),
    TermKind("contact with the plane of symmetry", "contact", _plane),
]
