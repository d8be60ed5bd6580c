"""What exact theory says of a scanned parameter, to hold the answer of a mesh against."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Final

import numpy as np

from gyrify.config.body_sections import PERIODIC
from gyrify.errors import GyrifyError
from gyrify.run.validity.exact_bodies import round_body
from gyrify.run.validity.expected import expected_onset
from gyrify.theory.margin import SmoothState, stability_margin
from gyrify.theory.onset import state_at
from gyrify.threshold.scanned_parameter import configured

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.threshold.crossings import Crossing

# Relative difference between a critical value of the mesh and the exact one from which it is told.
FAR: Final = 0.10
# A film on a half-space takes a quarter of a second for each value.
_VALUES_OF_A_STRIP: Final = 9
_HALVINGS: Final = 12


def expected_crossings(config: Config, parameter: str, values: Sequence[float]) -> tuple[float, ...] | None:
    """Values at which exact theory changes stability at the end of growth.

    Parameters
    ----------
    config : Config
        The other parameters; an ellipse stands as the circle of the same area and hole, an ellipsoid as the
        sphere of the same volume and hole.
    parameter : str
        As in `gyrify.threshold.critical_growth`.
    values : sequence of float
        The scanned values, increasing.

    Returns
    -------
    tuple of float or None
        In increasing order, to 0.1 % of the range; None where no theory covers the configuration.
    """
    is_flat = config.geometry.shape in PERIODIC
    if not expected_onset(config).is_known:
        return None
    scanned = np.asarray(values, dtype=np.float64)
    if is_flat:
        scanned = scanned[np.unique(np.linspace(0, len(values) - 1, _VALUES_OF_A_STRIP).round().astype(int))]
    unstable = _StripJudge(config, parameter) if is_flat else _RoundJudge(config, parameter)
    try:
        known = [unstable(float(value)) for value in scanned]
        return tuple(
            _root(unstable, float(low), float(high), before)
            for (low, high), (before, after) in zip(pairwise(scanned), pairwise(known), strict=True)
            if before != after
        )
    except GyrifyError:
        return None


class _Judge(ABC):
    """Whether the exact smooth state of a value is unstable."""

    def __init__(self, config: Config, parameter: str) -> None:
        self.config, self.parameter = config, parameter

    def at(self, value: float) -> Config:
        """Configuration of a value."""
        return configured(self.config, self.parameter, value)

    @abstractmethod
    def __call__(self, value: float) -> bool:
        """Whether the smooth state of a value is unstable."""


class _RoundJudge(_Judge):
    """By the annulus, in space by the sphere."""

    def __init__(self, config: Config, parameter: str) -> None:
        super().__init__(config, parameter)
        self._guess: SmoothState | None = None

    def __call__(self, value: float) -> bool:
        is_time = self.parameter == "growth.time"
        config = self.config if is_time else self.at(value)
        time = value if is_time else config.growth.duration
        self._guess = state_at(round_body(config), "growth_time", time, time, self._guess)
        return stability_margin(self._guess).value < 0.0


class _StripJudge(_Judge):
    """By the film on a half-space."""

    def __call__(self, value: float) -> bool:
        if self.parameter == "growth.time":
            onset = expected_onset(self.config).growth_time
            return onset is not None and value >= onset
        return expected_onset(self.at(value)).growth_time is not None


def _root(unstable: _Judge, low: float, high: float, before: bool) -> float:
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if unstable(middle) == before else (low, middle)
    return 0.5 * (low + high)


def differences(
    parameter: str, theory: str, exact: Sequence[float] | None, found: Sequence[Crossing], advice: str
) -> list[str]:
    """Warn where exact theory has a crossing that the mesh does not show, or shows elsewhere.

    Parameters
    ----------
    parameter : str
        Its key.
    theory : str
        Name of the theory.
    exact : sequence of float or None
        From `expected_crossings`.
    found : sequence of Crossing
        Those of the mesh.
    advice : str
        What to do about it.

    Returns
    -------
    list of str
    """
    if exact is None:
        return []
    if len(exact) > 0 and len(found) == 0:
        shown = ", ".join(f"{value:.4g}" for value in exact)
        return [
            f"Exact theory ({theory}) has a critical {parameter} of {shown} in this range, "
            f"and this mesh shows none: it is too coarse, or its element locks. {advice}"
        ]
    if len(found) > 0 and len(exact) == 0:
        return [
            f"Exact theory ({theory}) has no critical {parameter} in this range, but this mesh has one: it "
            f"may be the mesh's own. {advice}"
        ]
    return [
        f"The critical {parameter} of this mesh is {crossing.value:.4g}, that of exact theory ({theory}) "
        f"{nearest:.4g}: they are {abs(crossing.value / nearest - 1.0):.0%} apart. {advice}"
        for crossing in found
        for nearest in [min(exact, key=lambda value: abs(value - crossing.value))]
        if nearest != 0.0 and abs(crossing.value / nearest - 1.0) > FAR
    ]
