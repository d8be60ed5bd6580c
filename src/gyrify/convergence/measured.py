"""What is read from each run of a study of convergence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gyrify.metrics import Measures
from gyrify.onset.visible import visible_time
from gyrify.store.history import History
from gyrify.summary import measure_state


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


METRICS: Final = (
    Metric("gi_closing", "GI, closing"),
    Metric("gi_hull", "GI, hull"),
    Metric("gi_exposed", "GI, exposed"),
    Metric("n_gyri", "gyri", digits=0, is_count=True),
    Metric("visible_growth_time", "folds visible", "time", 1),
    Metric("onset_growth_time", "stability lost", "time", 1),
    Metric("sulcal_depth_mm_max", "deepest sulcus", "mm", 2, least=0.1),
    Metric("sulcal_depth_mm_mean", "mean sulcal depth", "mm", 2, least=0.1),
    Metric("elastic_energy_mJ_per_mm", "elastic energy", "mJ/mm", 3),
)


def measured(history: History) -> dict[str, float | None]:
    """Metrics of a complete run.

    Parameters
    ----------
    history : History
        The run.

    Returns
    -------
    dict
        By the keys of `METRICS`; None where there is none. ``visible_growth_time`` is the growth time at
        which the index by the closing passes `gyrify.onset.visible.VISIBLE`, interpolated between increments;
        ``onset_growth_time`` that at which the tissue's stiffness loses definiteness on the path of the run,
        often late or never where node jitter unfolds the bifurcation.
    """
    measures, onset = measure_state(history), history.onset
    return {
        "gi_closing": measures.gi_closing,
        "gi_hull": measures.gi_hull,
        "gi_exposed": _finite(measures),
        "n_gyri": float(measures.n_gyri),
        "visible_growth_time": visible_time(history),
        "onset_growth_time": None if onset is None else onset.growth_time,
        "sulcal_depth_mm_max": measures.sulcal_depth_max,
        "sulcal_depth_mm_mean": measures.sulcal_depth_mean,
        "elastic_energy_mJ_per_mm": elastic_energy(history),
    }


def elastic_energy(history: History) -> float:
    """Elastic energy of the last state [mJ per mm out of the plane], that is [N]."""
    time = float(history.growth_times[-1])
    energy = history.slice.elastic_energy(history.slice.kinematics(time))
    return 1e-6 * float(energy.evaluate(history.state_vector(), 0).value)


def _finite(measures: Measures) -> float | None:
    """The exposed index, where any part of the contour is exposed."""
    return measures.gi_exposed if measures.gi_exposed < float("inf") else None
