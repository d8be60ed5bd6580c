"""What a search of readings turns: its axes, with and without constants that are fitted."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from gyrify.paper.reading import STANDARD_IMPERFECTION, Mechanics

if TYPE_CHECKING:
    import optuna

OUT_OF_PLANE: Final = ("blocked", "none", "generalised")
STRETCH: Final = ("linear", "exponential")
ENERGY_PER: Final = ("grown", "reference")
ELEMENTS: Final = ("linear", "mean_dilatation", "quadratic")
GRADING: Final = ("geometric", "uniform")
SPLIT: Final = ("alternating", "one", "random")
DISSIPATION: Final = ("drag", "kelvin_voigt", "none")
COURSE: Final = ("constant", "reduced")
EXPONENT: Final = (0.0, 1.0)
NUMBER: Final = (0.01, 10.0)
IMPERFECTION: Final = (1e-4, 0.1)
_DIGITS: Final = 2


def mechanics_of(trial: optuna.trial.BaseTrial, *, is_fitted: bool) -> Mechanics:
    """The mechanics that a trial proposes.

    Parameters
    ----------
    trial : optuna trial
        Who suggests the values.
    is_fitted : bool
        Whether numbers are free that neither the paper nor anything known before the comparison gives: the
        exponent of growth along z, a dissipation, and the imperfection.

    Returns
    -------
    Mechanics
    """

    def one_of(name: str, choices: tuple[str, ...]) -> str:
        return str(trial.suggest_categorical(name, choices))

    plane = one_of("out_of_plane", OUT_OF_PLANE)
    found = Mechanics(
        out_of_plane=plane,
        stretch=one_of("stretch", STRETCH),
        energy_per=one_of("energy_per", ENERGY_PER),
        dissipation="none",
        number=0.0,
        element=one_of("element", ELEMENTS),
        grading=one_of("grading", GRADING),
        split=one_of("split", SPLIT),
        imperfection=_imperfection(trial, is_fitted),
        exponent=1.0 if plane == "none" else _exponent(trial, is_fitted),
    )
    kind = one_of("dissipation", DISSIPATION) if is_fitted else "none"
    if kind == "none":
        return found
    number = rounded(trial.suggest_float("number", *NUMBER, log=True))
    return replace(found, dissipation=kind, number=number, course=one_of("course", COURSE))


def parameters_of(mechanics: Mechanics) -> dict[str, object]:
    """The suggestions by which `mechanics_of` proposes a mechanics with fitted constants."""
    names = ("out_of_plane", "stretch", "energy_per", "element", "grading", "split", "dissipation")
    found: dict[str, object] = {name: getattr(mechanics, name) for name in names}
    found["perfect"] = mechanics.imperfection == 0.0
    if mechanics.imperfection:
        found["imperfection"] = mechanics.imperfection
    if mechanics.out_of_plane != "none":
        found["exponent"] = mechanics.exponent
    if mechanics.dissipation != "none":
        found |= {"number": mechanics.number, "course": mechanics.course}
    return found


def edges(mechanics: Mechanics) -> list[str]:
    """What of a reading is the least or the most that is tried, in words; no exponent lies beyond 0 and 1."""
    tried = {"imperfection": (mechanics.imperfection, IMPERFECTION)}
    if mechanics.dissipation != "none":
        tried["dissipation number"] = (mechanics.number, NUMBER)
    return [
        f"{name} {value:g} is the {'smallest' if value <= ends[0] else 'largest'} that was tried"
        for name, (value, ends) in sorted(tried.items())
        if value and not ends[0] < value < ends[1]
    ]


def _exponent(trial: optuna.trial.BaseTrial, is_fitted: bool) -> float:
    if is_fitted:
        return round(float(trial.suggest_float("exponent", *EXPONENT)), _DIGITS)
    return float(trial.suggest_categorical("exponent", EXPONENT))


def _imperfection(trial: optuna.trial.BaseTrial, is_fitted: bool) -> float:
    if trial.suggest_categorical("perfect", (False, True)):
        return 0.0
    if is_fitted:
        return rounded(trial.suggest_float("imperfection", *IMPERFECTION, log=True))
    return STANDARD_IMPERFECTION


def rounded(value: float) -> float:
    """A number that can be spoken of."""
    return float(f"{value:.{_DIGITS}g}")
