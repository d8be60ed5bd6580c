"""Conjugate gradients in the place of factors: the same states and onset; chosen if one is too large."""

from __future__ import annotations

from itertools import takewhile
from pathlib import Path

import numpy as np
import pytest
from solids import BALL, BRAIN, PATCH, config

from gyrify import simulate
from gyrify.cli.run import _solved_with
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.model import solver_choice
from gyrify.model.slice import Slice
from gyrify.model.solver_choice import factor_memory, machine_memory
from gyrify.run.onset.onset_search import OnsetSearch
from gyrify.run.running import Progress
from gyrify.run.simulation import resume, stored_run
from gyrify.run.summary import summarise
from gyrify.solve.iterative.inexact import InexactHessian
from gyrify.solve.iterative.krylov import ConjugateGradients
from gyrify.solve.problem import State
from gyrify.solve.quasistatic import grow
from gyrify.store import History

CG = {"solver.linear_solver": "cg"}
SMALL = {"solver.increments": 3, "mesh.edge_length": 14.0, "mesh.n_layers": 4}


def grown(given: Config, fraction: float) -> tuple[Slice, list[State]]:
    """States up to a fraction of growth."""
    problem = Slice(given)
    states = grow(problem, problem.stepping, problem.reference_state())
    end = fraction * problem.stepping.end
    return problem, list(takewhile(lambda state: state.position <= end, states))


@pytest.fixture(scope="module")
def both() -> dict[str, tuple[Slice, list[State]]]:
    """The small brain past its first buckling, with walls of sulci in contact: with factors and without."""
    return {name: grown(config(BRAIN, **{"solver.linear_solver": name}), 0.36) for name in ("auto", "cg")}


def test_states_are_those_of_factors(both: dict[str, tuple[Slice, list[State]]]) -> None:
    """To the tolerance of the increments, which both keep, through states that are indefinite."""
    (problem, factors), (_, states) = both["auto"], both["cg"]
    assert [s.position for s in states] == [s.position for s in factors]
    goal = problem.stepping.criterion.force
    for state, other in zip(states, factors, strict=True):
        assert 0.0 < state.residual <= goal
        assert np.abs(state.u - other.u).max() < 1e-4 * np.abs(other.u).max()
    assert np.abs(states[-1].u).max() > 10.0


def test_a_shift_costs_no_factor(both: dict[str, tuple[Slice, list[State]]]) -> None:
    assert both["cg"][1][-1].stats.factorizations == 0
    with_factors = both["auto"][1][-1].stats
    assert with_factors.factorizations > with_factors.newton_iterations


def test_the_same_bytes_each_time(both: dict[str, tuple[Slice, list[State]]]) -> None:
    again = grown(config(BRAIN, **CG), 0.22)[1]
    assert [s.u.tobytes() for s in again] == [s.u.tobytes() for s in both["cg"][1][: len(again)]]


def test_a_direction_leads_down_where_the_hessian_is_indefinite(
    both: dict[str, tuple[Slice, list[State]]],
) -> None:
    """And where it is not, it is the exact one up to what is asked for."""
    problem, states = both["cg"]
    state = states[3]
    system = problem.increment_system(state.couplings)
    assert isinstance(system.solver, ConjugateGradients)
    total = problem.energy((state.position + state.span) / problem.stepping.end, state, 0.0)
    gradient = system.gather(total.slope(state.u)[1])
    hessian = InexactHessian(total, system, system.solver, problem.candidates, problem.shift_mass, 1e-9)
    direction = hessian.factor(state.u).solve(gradient)
    assert hessian.tau > 0.0
    assert direction @ gradient > 0.0
    first = hessian.tau
    hessian.factor(state.u).solve(gradient)
    assert hessian.tau <= first  # begun below the last one


def test_projection_is_an_alternative_to_the_shift(both: dict[str, tuple[Slice, list[State]]]) -> None:
    problem, states = both["cg"]
    state = states[3]
    system = problem.increment_system(state.couplings)
    assert isinstance(system.solver, ConjugateGradients)
    total = problem.energy((state.position + state.span) / problem.stepping.end, state, 0.0)
    gradient = system.gather(total.slope(state.u)[1])
    hessian = InexactHessian(total, system, system.solver, problem.candidates, None, 1e-9)
    assert hessian.factor(state.u).solve(gradient) @ gradient > 0.0
    assert hessian.tau == 0.0


def test_the_onset_is_that_of_negative_pivots() -> None:
    """Of a patch: time, mode, kind and the number of negative eigenvalues at each change."""
    base = config(
        PATCH, **{"growth.law": "area", "material.stiffness_ratio": 3.0, "dissipation.kind": "none"}
    )
    found = []
    for name in ("auto", "cg"):
        search = OnsetSearch(Slice(base.replace(**{"solver.linear_solver": name})))
        search.follow(0.6)
        found.append(search)
    factors, without = found
    assert factors.onset is not None
    assert without.onset is not None
    assert without.onset.growth_time == pytest.approx(factors.onset.growth_time, rel=1e-6)
    assert without.onset.mode_number == factors.onset.mode_number
    changes = [[(c.n_before, c.n_after, c.kind) for c in search.changes] for search in found]
    assert changes[0] == changes[1]
    assert len(changes[0]) >= 2


def test_the_lowest_mode_of_a_ball_is_that_of_factors() -> None:
    """A free ball, held at as many points as prevent its rigid motions."""
    given = {
        "geometry.semi_axes": (12.0, 12.0, 12.0),
        "geometry.cortical_thickness": 2.0,
        "mesh.edge_length": 5.0,
        "growth.law": "area",
        "dissipation.kind": "none",
    }
    found = []
    for name in ("auto", "cg"):
        ball = Slice(config(BALL, **given, **{"solver.linear_solver": name}))
        system = ball.system(np.empty((0, 2), dtype=np.int64))
        u = np.zeros_like(ball.mesh.points)
        tangents = [ball.tangent(fraction, u, u, system) for fraction in (0.0, 0.05)]
        found.append([(tangent.n_negative, tangent.lowest().eigenvalue) for tangent in tangents])
    (stable, unstable), without = found
    assert stable[0] == 0 < unstable[0]
    for ours, theirs in zip(without, (stable, unstable), strict=True):
        assert ours[0] == theirs[0]
        assert ours[1] == pytest.approx(theirs[1], rel=1e-5)


def test_auto_keeps_a_factor_where_it_fits(monkeypatch: pytest.MonkeyPatch) -> None:
    assert machine_memory() > 100.0
    base = config(BALL, **SMALL)
    shape = Slice(base).state_shape
    direct = Slice(base).linear_solver
    assert direct in ("pardiso", "superlu")
    needed = factor_memory(direct, int(np.prod(shape)))
    for memory, expected in ((2.1 * needed, direct), (1.9 * needed, "cg")):
        monkeypatch.setattr(solver_choice, "machine_memory", lambda memory=memory: memory)
        assert Slice(base).linear_solver == expected
    # the limit of the run counts, too, and in the plane a factor always fits
    assert Slice(base.replace(**{"limits.memory": 0.9 * needed})).linear_solver == "cg"
    assert Slice(Config().with_overrides({"mesh.n_around": 40})).linear_solver == direct


def test_auto_takes_conjugate_gradients_where_they_are_faster(monkeypatch: pytest.MonkeyPatch) -> None:
    fitting = {**SMALL, "stability.detect": False, "dissipation.kind": "drag", "dissipation.number": 0.2}
    base = config(BALL, **{**fitting, "material.poisson_ratio": 0.4})
    direct = Slice(base).linear_solver
    assert direct in ("pardiso", "superlu")  # it is small
    monkeypatch.setattr(solver_choice, "_MANY", 10)
    assert Slice(base).linear_solver == "cg"
    for other in (
        {"stability.detect": True},
        {"dissipation.kind": "none"},
        {"material.poisson_ratio": 0.47},
        {"mesh.element": "quadratic"},
        {"solver.linear_solver": direct},
    ):
        assert Slice(base.replace(**other)).linear_solver == direct


def test_a_factor_grows_faster_than_the_mesh() -> None:
    """PARDISO told 2.2 GB for 305 445 unknowns, and SuperLU took 1.25 GB for 19 224."""
    assert 2200.0 < factor_memory("pardiso", 305_445) < 4400.0
    assert factor_memory("superlu", 19_224) == pytest.approx(1250.0)
    assert factor_memory("pardiso", 8000) == pytest.approx(16.0 * factor_memory("pardiso", 1000))


def test_what_was_chosen_is_told_and_kept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A run that was begun without a factor is continued without one, whatever the machine."""
    base = config(BALL, **SMALL)
    monkeypatch.setattr(solver_choice, "machine_memory", lambda: 0.01)
    whole = simulate(base, tmp_path / "whole")
    told = summarise(whole)
    assert whole.linear_solver == told["solver"]["linear_solver"] == "cg"
    assert "a factor would take longer or not fit" in _solved_with(told)
    assert _solved_with({**told, "parameters": {"solver.linear_solver": "cg"}}) == "conjugate gradients"

    def stop(progress: object) -> None:  # noqa: ARG001
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(base, tmp_path / "part", observers=[stop])
    monkeypatch.undo()
    with stored_run(tmp_path / "part") as run:
        assert run.problem.linear_solver != "cg"
        run.grow()
        assert run.history.linear_solver == "cg"
        assert run.history.result_hash == whole.result_hash


def test_the_plane_has_factors() -> None:
    with pytest.raises(ConfigError, match="not allowed in the plane"):
        Config().with_overrides(CG)


def test_the_default_is_not_in_the_hash() -> None:
    base = config(BALL)
    assert base.config_hash == base.replace(**{"solver.linear_solver": "auto"}).config_hash
    assert base.config_hash != base.replace(**CG).config_hash


def test_a_run_resumes_to_the_same_bytes(tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(progress: Progress) -> None:
        if progress.state.index == 4:
            raise Enough

    given = config(BRAIN, **CG, **{"solver.increments": 7, "growth.duration": 250.0})
    whole = simulate(given, tmp_path / "whole")
    with pytest.raises(Enough):
        simulate(given, tmp_path / "cut", observers=[stop])
    assert len(History.load(tmp_path / "cut")) < len(whole)
    assert resume(tmp_path / "cut").result_hash == whole.result_hash
