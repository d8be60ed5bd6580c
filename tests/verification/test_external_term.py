"""A term of the surroundings that a test makes up is booked as one wherever energy is told."""

from __future__ import annotations

import numpy as np
import pytest
from forging import write_outputs

import gyrify
from gyrify.config import Config
from gyrify.energy.term import Evaluation, Hessian, Pattern
from gyrify.model import terms
from gyrify.model.terms import TERMS, GrowthStep, TermKind, terms_of
from gyrify.report.html.series import energy_lines
from gyrify.run.reevaluation import reevaluated
from gyrify.run.simulation import simulate
from gyrify.verify import verify

# Stiffness at the end of growth over Young's modulus.
STIFFNESS = 0.02


class Springs:
    """Springs that pull each point of the contour to where it was, and become stiffer with growth."""

    is_barrier = False

    def __init__(self, step: GrowthStep) -> None:
        self._points = step.problem.mesh.contour
        self._stiffness = STIFFNESS * step.problem.config.material.young_modulus * (0.5 + 0.5 * step.end)
        dofs = np.sort((2 * self._points[:, None] + np.arange(2)).ravel())
        self._pattern = Pattern(dofs, dofs)

    def evaluate(self, u: np.ndarray, order: int, project_psd: bool = False) -> Evaluation:  # noqa: ARG002
        moved = u[self._points]
        gradient = np.zeros_like(u)
        gradient[self._points] = self._stiffness * moved
        hessian = Hessian(self._pattern, np.full(self._pattern.rows.size, self._stiffness))
        value = 0.5 * self._stiffness * float(np.sum(moved * moved))
        return Evaluation(value, gradient if order > 0 else None, hessian if order > 1 else None)

    def max_step(self, u: np.ndarray, du: np.ndarray) -> float:  # noqa: ARG002
        return 1.0


@pytest.fixture(scope="module")
def sprung(folding: Config, tmp_path_factory: pytest.TempPathFactory):
    """A run with springs, the same without, and in how many panels the latter's energy is drawn."""
    folder = tmp_path_factory.mktemp("external")
    config = folding.with_overrides({"growth.duration": 500.0, "solver.increments": 50})
    free = simulate(config, folder / "free")
    assert "surroundings" not in {line["label"] for line in energy_lines(free)}
    n_panels = len(gyrify.plot(free, "energy", compare=free).axes)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(terms, "TERMS", [*TERMS, TermKind("springs", "external", Springs)])
        held = simulate(config, folder / "held")
        write_outputs(held, folder / "held")
        yield held, free, folder / "held", n_panels


def test_the_solver_minimises_it_and_the_search_for_onsets_knows_it(sprung) -> None:
    held, free, *_ = sprung
    tip = [np.linalg.norm(run.state_vector()[run.mesh.contour], axis=1).mean() for run in (held, free)]
    assert tip[0] < 0.97 * tip[1]
    names = [kind.name for kind, _ in terms_of(GrowthStep(held.slice, held.state_vector(), 0.5, 1.0))]
    assert names[-1] == "springs"
    tissue = held.slice.tissue_energy(1.0, held.state_vector())
    assert any(isinstance(term, Springs) for term in tissue.terms)
    # springs load the cortex, so that it is unstable sooner
    assert held.onset.growth_time < 0.98 * free.onset.growth_time


def test_it_is_told_apart_and_the_balance_is_closed(sprung) -> None:
    held, *_ = sprung
    increments = list(reevaluated(held))
    springs = Springs(GrowthStep(held.slice, held.state_vector(), 1.0, 1.0))
    energy = springs.evaluate(held.state_vector(), 0).value
    assert sum(i.external for i in increments) == pytest.approx(energy, rel=1e-9)
    assert energy > 0.0
    work = sum(i.work for i in increments)
    assert sum(abs(i.defect) for i in increments) < 0.02 * work
    # booked anywhere else, the springs would break the balance
    assert energy > 0.05 * work


def test_verify_report_and_picture_name_it(sprung) -> None:
    held, free, folder, n_panels = sprung
    total = 1e-6 * sum(i.external for i in reevaluated(held))
    (balance,) = [check for check in verify(folder).checks if check.name == "energy balance"]
    assert balance.passed, balance
    assert "in the surroundings" in str(balance)
    lines = {line["label"]: line["values"] for line in energy_lines(held)}
    assert lines["surroundings"][-1] == pytest.approx(total, rel=1e-6)
    (axes, _) = gyrify.plot(held, "energy").axes
    (line,) = [line for line in axes.lines if line.get_label() == "in the surroundings"]
    assert line.get_ydata()[-1] == pytest.approx(total)
    both = gyrify.plot(held, "energy", compare=free).axes
    assert both[-1].get_ylabel() == "surroundings [mJ/mm]"
    assert len(both) == n_panels + 1


def test_every_term_has_a_role_and_a_name_of_its_own() -> None:
    assert {kind.role for kind in TERMS} <= set(terms.ROLES)
    assert len({kind.name for kind in TERMS}) == len(TERMS)
