"""What must hold with SciPy's solver alone as well as with PARDISO."""

from __future__ import annotations

from importlib.metadata import distributions

import numpy as np
import pytest

from gyrify import Config, ConfigError, measure_state, simulate
from gyrify.solve.linear import linear_solver

HAS_PARDISO = any(d.name == "mkl" for d in distributions())
SMALL = {"mesh.n_around": 96, "mesh.n_layers": 10, "mesh.n_cortex_layers": 4, "solver.increments": 40}


def small(**overrides: object) -> Config:
    return Config().with_overrides({**SMALL, **overrides})


def test_auto_takes_the_fast_solver_where_it_is_installed() -> None:
    assert linear_solver("auto").name == ("pardiso" if HAS_PARDISO else "superlu")


@pytest.mark.skipif(HAS_PARDISO, reason="needs an environment without PARDISO")
def test_asking_for_a_missing_solver_says_how_to_get_it() -> None:
    with pytest.raises(ConfigError, match="pip install mkl"):
        linear_solver("pardiso")


@pytest.mark.parametrize("name", ["superlu", "auto"])
def test_a_coarse_slice_folds(name: str) -> None:
    history = simulate(small(**{"solver.linear_solver": name}))
    measures = measure_state(history)
    assert history.status == "completed"
    assert measures.n_gyri >= 8
    assert measures.gi_closing > 1.1
    assert not measures.self_intersecting
    assert np.all(history.residuals[1:] <= history.slice.stepping.criterion.force)


@pytest.mark.skipif(not HAS_PARDISO, reason="needs PARDISO")
def test_both_solvers_find_the_same_folds() -> None:
    ends = [simulate(small(**{"solver.linear_solver": name})).points() for name in ("superlu", "pardiso")]
    assert np.abs(ends[0] - ends[1]).max() < 1e-3
