"""Studies: many runs from one file, computed in parallel, resumed, and gathered in one tidy table."""

from gyrify.study.archive import FinalState, Record
from gyrify.study.definition import Point, Study
from gyrify.study.design import Design
from gyrify.study.driver import run_points, run_study
from gyrify.study.outcome import StudyProgress, StudyResult
from gyrify.study.parameter import Parameter
from gyrify.study.results import read_results
from gyrify.study.stored_point import StoredPoint, final_state

__all__ = [
    "Design",
    "FinalState",
    "Parameter",
    "Point",
    "Record",
    "StoredPoint",
    "Study",
    "StudyProgress",
    "StudyResult",
    "final_state",
    "read_results",
    "run_points",
    "run_study",
]
