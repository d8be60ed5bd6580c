"""The sections that say how a run is solved, measured, written and limited."""

from __future__ import annotations

from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator, model_validator

from gyrify.config.base import Section, setting

OutputField = Literal[
    "displacement",
    "region",
    "growth_stretch",
    "J",
    "J_elastic",
    "J_growth",
    "cauchy_stress",
    "von_mises",
    "mean_stress",
    "circumferential_stress",
    "thickness",
    "curvature",
    "contact_force",
]
ALL_FIELDS: Final[tuple[OutputField, ...]] = OutputField.__args__  # type: ignore[attr-defined]


def _whole(value: Any) -> Any:
    """Refuse what equals a whole number without being one, such as True or 1.0."""
    if type(value) is not int:
        raise ValueError("write a whole number")
    return value


Sign = Annotated[Literal[1, -1], BeforeValidator(_whole)]
SchemaVersion = Annotated[Literal[1], BeforeValidator(_whole)]


# Lengths of measuring that suit the standard slice [mm], and the bounds of those of other bodies.
STANDARD_RADIUS: Final = 10.0
STANDARD_PROMINENCE: Final = 0.3
SHORTEST: Final = 1e-300
LONGEST: Final = 1e5
_SCALED: Final = {"closing_radius": STANDARD_RADIUS, "gyrus_prominence": STANDARD_PROMINENCE}


class Solver(Section):
    """Growth increments and Newton's method."""

    increments: int = setting(100, "Growth increments planned.", ge=1, le=100_000)
    min_increment: float = setting(
        1e-6, "Smallest increment before a run fails.", unit="fraction of duration", gt=0, le=1
    )
    tolerance: float = setting(
        1e-6, "Largest nodal force allowed at convergence.", unit="E_G × mean cortical edge", gt=0, le=1e-2
    )
    max_newton: int = setting(
        60, "Newton iterations per increment; reaching it is a failure, never acceptance.", ge=1, le=10_000
    )
    regularisation: Literal["shift", "projection"] = setting(
        "shift",
        "Where the stiffness is indefinite: shift it by the mass, or project it cell by cell (slower).",
    )
    linear_solver: Literal["auto", "pardiso", "superlu", "cg"] = setting(
        "auto",
        "Sparse direct solver, or conjugate gradients (cg, in space), which keep no factor; auto takes "
        "PARDISO where it is installed, else SuperLU, and cg where it is faster or a factor would not fit "
        "into the memory.",
    )


class Stability(Section):
    """Detection of buckling."""

    detect: bool = setting(True, "Whether the loss of stability is looked for.")
    follow_branch: bool = setting(False, "Whether to step onto the buckled branch at the loss of stability.")
    sign: Sign = setting(1, "Side of the buckled branch to follow.")


class Metrics(Section):
    """How folding is measured."""

    closing_radius: float = setting(
        None,
        "Radius of the morphological closing that outlines the exposed surface; "
        f"{STANDARD_RADIUS:g} mm times the scale of the body when not given.",
        unit="mm",
        follows=f"{STANDARD_RADIUS:g} mm × scale of the body",
        gt=0,
        le=LONGEST,
    )
    gyrus_prominence: float = setting(
        None,
        "Height from which an outward bump counts as a gyrus; "
        f"{STANDARD_PROMINENCE:g} mm times the scale of the body when not given.",
        unit="mm",
        follows=f"{STANDARD_PROMINENCE:g} mm × scale of the body",
        gt=0,
        le=LONGEST,
    )
    samples: int = setting(2000, "Points of the contour resampled by arc length.", ge=100, le=1_000_000)

    @model_validator(mode="after")
    def _of_the_standard_slice(self) -> Metrics:
        """State numbers even without a body; they do not count as given."""
        for key in _SCALED:
            if self.__dict__[key] is None:
                self.__dict__[key] = _SCALED[key]
        return self

    def scaled(self, scale: float) -> Metrics:
        """Return a copy whose lengths fit a body, where they are not given.

        Parameters
        ----------
        scale : float
            Size of the body over that of the standard slice [-].

        Returns
        -------
        Metrics
            Lengths that were not given still do not count as given, and follow the next body.
        """
        fitted = self.model_copy()
        for key, standard in _SCALED.items():
            if key not in self.model_fields_set:
                fitted.__dict__[key] = min(max(standard * scale, SHORTEST), LONGEST)
        return fitted


class Output(Section):
    """What is written; no influence on the result or on its hash."""

    every: int = setting(1, "Increments between two steps of the derived history.", ge=1, le=100_000)
    fields: tuple[OutputField, ...] = setting(ALL_FIELDS, "Fields of the derived history.", strict=False)


class Limits(Section):
    """When to stop early; no influence on the hash."""

    wall_time: float = setting(
        0.0, "Wall time after which a run stops cleanly; 0 = none.", unit="s", ge=0, le=1e9
    )
    memory: float = setting(0.0, "Memory at which a run stops cleanly; 0 = none.", unit="MB", ge=0, le=1e9)
