"""The simulations of the paper: one grid of unique cases that all tables and figures share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

SOFT: Final = 1 / 1.36
EQUAL: Final = 1.0
STANDARD_GROWTH: Final = 3.6
STANDARD_THICKNESS: Final = 1.5
BOTH: Final = (SOFT, EQUAL)
STIFFNESS: Final = (1 / 3, 1 / 2.61, 1 / 2, SOFT, EQUAL, 1.54, 2.0, 3.0)
GROWTH: Final = (1.0, STANDARD_GROWTH, 36.0, 360.0)
THICKNESS: Final = (0.75, STANDARD_THICKNESS, 3.0)
THICK: Final = (7.5, 8.0)
# Growth ratio from which the paper sees obvious folding, by stiffness ratio.
PAPER_THRESHOLD: Final = {EQUAL: 1.71, SOFT: 2.02}
# Relative error within which a threshold agrees with the paper's, and to which it is located.
AGREES: Final = 0.05
LOCATED: Final = 0.01
_FRACTIONS: Final = {1 / 3: "1/3", 1 / 2.61: "1/2.61", 1 / 2: "1/2", SOFT: "1/1.36"}


@dataclass(frozen=True, order=True)
class Case:
    """What distinguishes one simulation of the paper from another.

    Attributes
    ----------
    stiffness : float
        Stiffness ratio E_G/E_W [-].
    growth : float
        Growth ratio G_G/G_W [-].
    thickness : float
        Initial cortical thickness T [mm].
    """

    stiffness: float = EQUAL
    growth: float = STANDARD_GROWTH
    thickness: float = STANDARD_THICKNESS

    @property
    def overrides(self) -> dict[str, object]:
        """Its values by dotted key."""
        return {
            "material.stiffness_ratio": self.stiffness,
            "growth.ratio": self.growth,
            "geometry.cortical_thickness": self.thickness,
        }

    def __str__(self) -> str:
        text = f"E = {ratio_text(self.stiffness)}"
        text += f", G = {self.growth:.4g}" if self.growth != STANDARD_GROWTH else ""
        return text + (f", T = {self.thickness:g} mm" if self.thickness != STANDARD_THICKNESS else "")


def ratio_text(ratio: float) -> str:
    """A stiffness ratio as the paper writes it."""
    return _FRACTIONS.get(ratio, f"{ratio:g}")


def threshold_ends(stiffness: float) -> tuple[Case, Case]:
    """Cases at the ends of the range in which a threshold agrees with the paper's."""
    centre = PAPER_THRESHOLD[stiffness]
    return Case(stiffness, centre * (1 - AGREES)), Case(stiffness, centre * (1 + AGREES))


def series(stiffness: float) -> tuple[Case, ...]:
    """Growth ratios from 1 to 3.6 that Figures S1 and S2 show, before thresholds are located."""
    low, high = threshold_ends(stiffness)
    middle = Case(stiffness, PAPER_THRESHOLD[stiffness])
    return (
        Case(stiffness, 1.0),
        low,
        middle,
        high,
        Case(stiffness, 2.4),
        Case(stiffness, 3.0),
        Case(stiffness),
    )


# Stages in the order of what they decide for their cost; each case is in the first that needs it.
STAGES: Final[dict[str, tuple[Case, ...]]] = {
    "standard slices": tuple(Case(e) for e in (EQUAL, SOFT)),
    "soft cortex": tuple(Case(e) for e in STIFFNESS[:3]),
    "thresholds": tuple(end for e in BOTH for end in threshold_ends(e)),
    "thick cortex": tuple(Case(e, thickness=t) for t in THICK for e in BOTH),
    "thickness": tuple(Case(e, thickness=t) for t in (0.75, 3.0) for e in BOTH),
    "stiff cortex": tuple(Case(e) for e in STIFFNESS[5:]),
    "growth ratio": tuple(Case(e, g) for g in (1.0, 36.0, 360.0) for e in BOTH),
    "series": tuple(case for e in BOTH for case in series(e)[2:6] if case not in threshold_ends(e)),
}


def all_cases() -> tuple[Case, ...]:
    """Every case but those that locating thresholds adds, each once."""
    return tuple(dict.fromkeys(case for stage in STAGES.values() for case in stage))
