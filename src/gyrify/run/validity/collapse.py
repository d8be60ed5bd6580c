"""Tissue squeezed to a small part of its grown volume, which the law of the material does not prevent."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

if TYPE_CHECKING:
    from gyrify.store.history import History

# Elastic volume ratio J_e below which a cell counts as collapsed: the pressure kappa (J_e - 1) of the law has
# then used up half of the most it can ever give, kappa.
COLLAPSED: Final = 0.5


def collapse(history: History, summary: dict[str, Any]) -> list[str]:
    """Warn of cells whose volume is below half of what they have grown to."""
    if summary["min_J_elastic"] is None or summary["min_J_elastic"] >= COLLAPSED:
        return []
    ratio = _elastic_ratio(history, len(history) - 1)
    share, lowest = float(np.mean(ratio < COLLAPSED)), float(ratio.min())
    if lowest >= COLLAPSED:
        return []
    first = next(index for index in range(len(history)) if _elastic_ratio(history, index).min() < COLLAPSED)
    nu = history.config.material.poisson_ratio
    resists = (
        'Set material.poisson_ratio = 0.49 with mesh.element = "mean_dilatation", or end growth earlier.'
        if nu < 0.49
        else "Use smaller cells (mesh.refine = 1), or end growth earlier."
    )
    return [
        f"The volume of tissue collapses: {_percent(share)} of the integration points are squeezed to less "
        f"than half of their grown volume, the worst to {lowest:.1%}, for the first time at "
        f"increment {first}, growth time {history.growth_times[first]:.4g}. The material has no barrier "
        f"against that, and real tissue does not do it. {resists}"
    ]


def _elastic_ratio(history: History, index: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """(n,) J_e of a state; where the element averages it, the mean that the energy sees."""
    problem, u, time = history.slice, history.state_vector(index), float(history.growth_times[index])
    pressure = problem.volumetric_pressure(u, time)
    if pressure is not None:
        return np.asarray(1.0 + pressure / problem.bulk_modulus)
    return np.asarray(problem.volume_ratio(u) / problem.volume_growth(time))


def _percent(share: float) -> str:
    return f"{share:.0%}" if share >= 0.1 else f"{max(share, 0.001):.1%}"
