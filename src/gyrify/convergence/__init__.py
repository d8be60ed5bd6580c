"""Dependence on mesh, increments and contact distance: independent runs, orders, and verdicts by a rule."""

from gyrify.convergence.converge import converge
from gyrify.convergence.levels import Convergence, Family, Level
from gyrify.convergence.limit import RULE, Verdict, judge
from gyrify.convergence.measured import METRICS, Metric
from gyrify.convergence.plan import SUBJECTS, Subject

__all__ = [
    "METRICS",
    "RULE",
    "SUBJECTS",
    "Convergence",
    "Family",
    "Level",
    "Metric",
    "Subject",
    "Verdict",
    "converge",
    "judge",
]
