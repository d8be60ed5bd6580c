"""A term that an example adds: its derivatives, and a run with it whose balance of energy is closed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from differences import assert_derivatives

import gyrify
from gyrify.config import Config
from gyrify.energy.term import Evaluation, Hessian, Pattern
from gyrify.model import terms
from gyrify.model.slice import Slice
from gyrify.model.terms import TERMS, GrowthStep, TermKind
from gyrify.report.outputs import write_outputs
from gyrify.run.reevaluation import reevaluated
from gyrify.verify import verify

STEPS = 10.0 ** -np.arange(1.0, 9.5, 0.5)


@pytest.fixture
def module(example, monkeypatch: pytest.MonkeyPatch):
    found = example("own_term")
    kind = TermKind("fluid pressure", "external", found.FluidPressure)
    monkeypatch.setattr(terms, "TERMS", [*TERMS, kind])
    return found


def test_its_derivatives(module, tiny: Config, rng: np.random.Generator) -> None:
    problem = Slice(tiny)
    u, du = 0.1 * rng.standard_normal((2, *problem.state_shape))
    term = module.FluidPressure(GrowthStep(problem, u, 0.0, 0.1))
    found = term.evaluate(np.zeros_like(u), 1)
    assert found.value == pytest.approx(module.PRESSURE * 4069.0, rel=0.01)
    # a shift of the whole does no work
    assert np.sum(found.gradient, axis=0) == pytest.approx(0.0, abs=1e-9)
    evaluation = term.evaluate(u, 2)
    step = 1e-3
    slope = (term.evaluate(u + step * du, 0).value - term.evaluate(u - step * du, 0).value) / (2 * step)
    assert np.sum(evaluation.gradient * du) == pytest.approx(slope, rel=1e-7)
    assert_derivatives(_WithStiffness(term), u, du, STEPS)


class _WithStiffness:
    """A quadratic energy has no error of differences: with a cubic one the V is seen."""

    def __init__(self, term) -> None:
        self._term = term

    def evaluate(self, u, order: int):
        found = self._term.evaluate(u, 2)
        rows, cols = found.hessian.pattern.rows, found.hessian.pattern.cols
        # the energy squared
        gradient = 2.0 * found.value * found.gradient
        if order < 2:
            return type(found)(found.value**2, gradient)
        n = u.size
        upper = np.zeros((n, n))
        np.add.at(upper, (rows, cols), found.hessian.values)
        K = upper + np.triu(upper, 1).T
        g = found.gradient.ravel()
        full = 2.0 * (found.value * K + np.outer(g, g))
        i, j = np.triu_indices(n)
        return Evaluation(found.value**2, gradient, Hessian(Pattern(i, j), full[i, j]))


def test_a_run_with_it_is_booked_as_the_surroundings(module, folding: Config, tmp_path: Path) -> None:
    config = folding.with_overrides({"growth.duration": 500.0, "solver.increments": 50})
    history = gyrify.simulate(config, tmp_path / "run")
    write_outputs(history, tmp_path / "run")
    increments = list(reevaluated(history))
    x = history.contour()
    after = np.roll(x, -1, axis=0)
    area = 0.5 * float(np.sum(x[:, 0] * after[:, 1] - x[:, 1] * after[:, 0]))
    start = history.contour(0)
    following = np.roll(start, -1, axis=0)
    area -= 0.5 * float(np.sum(start[:, 0] * following[:, 1] - start[:, 1] * following[:, 0]))
    assert sum(i.external for i in increments) == pytest.approx(module.PRESSURE * area, rel=1e-9)
    found = verify(tmp_path / "run")
    assert found.passed, str(found)
    assert "in the surroundings" in str(found)
