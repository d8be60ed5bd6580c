"""Dependence on mesh, increments and contact distance: independent runs, orders, and verdicts by a rule."""

from gyrify.convergence.converge import converge
from gyrify.convergence.measured import METRICS, Metric
from gyrify.convergence.plan import SUBJECTS, Subject
from gyrify.convergence.result import Convergence, Family, Level
from gyrify.convergence.verdict import RULE, Verdict, judge

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
