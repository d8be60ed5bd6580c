"""gyrify simulates how the human cerebral cortex folds.

A configuration becomes a mesh, growth and material give each cell an energy, the total energy is minimised
at each growth increment, and the states go into a history that metrics and pictures read.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.convergence import Convergence, converge
    from gyrify.errors import (
        ConfigError,
        GyrifyError,
        HistoryError,
        InvertedCellError,
        LimitReachedError,
        MeshError,
        SolveError,
    )
    from gyrify.mesh import Mesh
    from gyrify.metrics import (
        Measures,
        cortical_thickness,
        growth_ratio_from_scaling,
        growth_ratio_from_volumes,
        gyrification_index,
        length_increase,
        measure,
    )
    from gyrify.report.animate import animate
    from gyrify.report.outputs import write_outputs
    from gyrify.report.plot import plot
    from gyrify.run.measuring import measure_state
    from gyrify.run.simulation import Progress, resume, simulate
    from gyrify.run.summary import summarise
    from gyrify.store import History
    from gyrify.study import Study, read_results, run_study
    from gyrify.threshold import Threshold, critical_growth

__version__ = "0.1.0"

# Loaded on first use, so that the command line answers at once.
_HOMES = {
    "Config": "config",
    "ConfigError": "errors",
    "Convergence": "convergence",
    "GyrifyError": "errors",
    "History": "store",
    "HistoryError": "errors",
    "InvertedCellError": "errors",
    "LimitReachedError": "errors",
    "Measures": "metrics",
    "Mesh": "mesh",
    "MeshError": "errors",
    "Progress": "run.simulation",
    "SolveError": "errors",
    "Study": "study",
    "Threshold": "threshold",
    "animate": "report.animate",
    "converge": "convergence",
    "cortical_thickness": "metrics",
    "critical_growth": "threshold",
    "growth_ratio_from_scaling": "metrics",
    "growth_ratio_from_volumes": "metrics",
    "gyrification_index": "metrics",
    "length_increase": "metrics",
    "measure": "metrics",
    "measure_state": "run.measuring",
    "read_results": "study",
    "plot": "report.plot",
    "resume": "run.simulation",
    "run_study": "study",
    "simulate": "run.simulation",
    "summarise": "run.summary",
    "write_outputs": "report.outputs",
}

__all__ = [
    "Config",
    "ConfigError",
    "Convergence",
    "GyrifyError",
    "History",
    "HistoryError",
    "InvertedCellError",
    "LimitReachedError",
    "Measures",
    "Mesh",
    "MeshError",
    "Progress",
    "SolveError",
    "Study",
    "Threshold",
    "__version__",
    "animate",
    "converge",
    "cortical_thickness",
    "critical_growth",
    "growth_ratio_from_scaling",
    "growth_ratio_from_volumes",
    "gyrification_index",
    "length_increase",
    "measure",
    "measure_state",
    "plot",
    "read_results",
    "resume",
    "run_study",
    "simulate",
    "summarise",
    "write_outputs",
]


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'gyrify' has no attribute {name!r}")
    return getattr(import_module(f"gyrify.{home}"), name)


def __dir__() -> list[str]:
    return __all__
