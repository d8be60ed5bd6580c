"""What is read from each run of a study of convergence."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gyrify.metrics.quantities import Quantity, shown_in
from gyrify.run.onset.visible_time import visible_time
from gyrify.run.summary import measure_state
from gyrify.store.history import History

_UNITS: Final = {"1": "", "growth time": "time"}


@dataclass(frozen=True)
class Metric:
    """A number that is compared between levels.

    Attributes
    ----------
    key : str
        Its name in files.
    name : str
        Its name for people.
    unit : str
        Its unit; empty for pure numbers.
    digits : int
        Digits after the point where it is shown.
    is_count : bool
        Whether it is a whole number, which is converged only when it repeats.
    least : float
        Size below which errors are relative to this instead of the value, in a body as large as the standard
        slice.
    """

    key: str
    name: str
    unit: str = ""
    digits: int = 3
    is_count: bool = False
    least: float = 0.0


def metrics(n_dim: int = 2) -> tuple[Metric, ...]:
    """What is compared of bodies in the plane (2) or in space (3), with any quantity registered later."""
    return tuple(
        Metric(q.key, _name(q), _UNITS.get(q.unit, q.unit), q.decimals or 0, q.type is int, q.least)
        for q in shown_in("converge", n_dim)
    )


def _name(quantity: Quantity) -> str:
    return quantity.label.removesuffix(" at time")


METRICS: Final = metrics()


def measured(history: History) -> dict[str, float | None]:
    """Metrics of a complete run.

    Parameters
    ----------
    history : History
        The run.

    Returns
    -------
    dict
        By the keys of `metrics`; None where there is none. ``visible_growth_time`` is the growth time at
        which the index by the closing, in space of areas, passes
        `gyrify.run.onset.visible_time.VISIBLE`, interpolated between increments; ``onset_growth_time`` that
        at which the smooth equilibrium loses stability.
    """
    measures, onset, n_dim = measure_state(history), history.onset, history.mesh.n_dim
    energy = "elastic_energy_mJ_per_mm" if n_dim == 2 else "elastic_energy_mJ"
    known: dict[str, float | None] = {
        **measures.flat(),
        "visible_growth_time": visible_time(history),
        "onset_growth_time": None if onset is None else onset.growth_time,
        energy: elastic_energy(history),
    }
    return {metric.key: _finite(known[metric.key]) for metric in metrics(n_dim)}


def elastic_energy(history: History) -> float:
    """Elastic energy of the last state [mJ per mm out of the plane], that is [N]; in space [mJ]."""
    time = float(history.growth_times[-1])
    energy = history.slice.elastic_energy(history.slice.kinematics(time))
    return 1e-6 * float(energy.evaluate(history.state_vector(), 0).value)


def _finite(value: float | None) -> float | None:
    """Nothing where an index is infinite, since no part of the contour is exposed."""
    return None if value is None or math.isinf(value) else float(value)
