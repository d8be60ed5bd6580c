"""Wang, Yao and Hu (2019): their observations as data, their simulations, and how ours compare."""

from gyrify.paper.cases import Case, all_cases
from gyrify.paper.checks import Check, Verdict
from gyrify.paper.observations import Observation, observations
from gyrify.paper.row import Row

__all__ = ["Case", "Check", "Observation", "Row", "Verdict", "all_cases", "observations"]
