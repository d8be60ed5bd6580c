"""What is told of runs that ended smooth, locked, crushed or as a sawtooth."""

from __future__ import annotations

import numpy as np
import pytest
from validity_cases import COARSE, PUBLISHED, case

from gyrify.run.simulation import simulate
from gyrify.run.summary import summarise
from gyrify.run.validity.before import config_warnings
from gyrify.run.validity.collapse import COLLAPSED, collapse
from gyrify.run.validity.folding import sawtooth, smooth_against_theory
from gyrify.run.validity.inverted_cells import inversion
from gyrify.run.validity.locking import locking
from gyrify.store.history import History

QUICK = {"solver.increments": 25, "stability.detect": False}


@pytest.fixture(scope="module")
def crushed() -> History:
    """The published parameters on a coarse mesh: smooth, and crushed."""
    return simulate(case(COARSE, PUBLISHED, QUICK))


@pytest.fixture(scope="module")
def serrated() -> History:
    """Nearly incompressible linear triangles."""
    changes = {"material.poisson_ratio": 0.4999, "mesh.n_around": 72}
    return simulate(case(changes, QUICK, **{"mesh.n_layers": 8, "mesh.n_cortex_layers": 3}))


def test_a_smooth_end_where_theory_folds_is_told(crushed: History) -> None:
    summary = summarise(crushed)
    assert summary["n_gyri"] == 0
    (sentence,) = smooth_against_theory(crushed, summary)
    assert "122.8" in sentence
    assert sentence in summary["warnings"]
    assert summary["expected"]["growth_time"] == pytest.approx(122.8, abs=0.1)
    assert summary["expected"]["mode_number"] == 41


def test_a_smooth_end_is_not_told_where_theory_is_smooth_too() -> None:
    history = simulate(case(COARSE, QUICK, **{"growth.duration": 200.0}))
    summary = summarise(history)
    assert summary["n_gyri"] == 0
    assert smooth_against_theory(history, summary) == []
    assert summary["expected"]["growth_time"] is None
    # Gyri where none are expected are told.
    assert "finer mesh" in smooth_against_theory(history, {**summary, "n_gyri": 3})[0]


def test_nothing_disturbs_a_perfect_mesh() -> None:
    history = simulate(case(COARSE, PUBLISHED, QUICK, **{"mesh.node_jitter": 0.0}))
    assert "mesh.node_jitter = 0.001" in smooth_against_theory(history, summarise(history))[0]


def test_drag_is_named_where_little_growth_is_left() -> None:
    late = case(COARSE, QUICK, **{"growth.duration": 270.0})
    history = simulate(late)
    assert "Dissipation holds folds back" in smooth_against_theory(history, summarise(history))[0]


def test_crushed_tissue_is_told_with_its_share_and_the_first_increment(crushed: History) -> None:
    summary = summarise(crushed)
    (sentence,) = collapse(crushed, summary)
    problem = crushed.slice
    lowest = [
        float((problem.volume_ratio(crushed.state_vector(i)) / problem.volume_growth(t)).min())
        for i, t in enumerate(crushed.growth_times)
    ]
    first = int(np.argmax(np.array(lowest) < COLLAPSED))
    assert lowest[-1] == pytest.approx(summary["min_J_elastic"])
    assert f"{lowest[-1]:.1%}" in sentence
    assert f"increment {first}," in sentence
    assert sentence in summary["warnings"]


def test_the_advice_against_crushing_works(crushed: History) -> None:
    assert 'material.poisson_ratio = 0.49 with mesh.element = "mean_dilatation"' in "".join(
        collapse(crushed, summarise(crushed))
    )
    advised = crushed.config.replace(**{"material.poisson_ratio": 0.49, "mesh.element": "mean_dilatation"})
    history = simulate(advised)
    assert collapse(history, summarise(history)) == []


def test_a_sawtooth_is_told_and_not_counted(serrated: History) -> None:
    summary = summarise(serrated)
    assert summary["gi"]["closing"] > 1.05
    assert summary["n_gyri"] <= 3
    (sentence,) = sawtooth(serrated, summary)
    assert sentence in summary["warnings"]
    assert "not folds" in sentence
    assert smooth_against_theory(serrated, summary) == []


def test_quadratic_cells_that_may_be_inverted_are_told_before_the_run() -> None:
    """Only where folds are expected, and nothing resists."""
    folding = case({"mesh.element": "quadratic"})
    (sentence,) = inversion(folding)
    assert sentence in config_warnings(folding)
    assert "mesh.inversion_resistance = 0.1" in sentence
    assert inversion(folding.replace(**{"mesh.inversion_resistance": 0.1})) == []
    assert inversion(folding.replace(**{"mesh.element": "linear"})) == []
    assert inversion(folding.replace(**{"growth.duration": 100.0})) == []


def test_locking_is_told_before_the_run(serrated: History) -> None:
    (sentence,) = locking(serrated.config)
    assert "0.4999" in sentence
    for element in ("mean_dilatation", "quadratic"):
        assert f'"{element}"' in sentence
        assert locking(serrated.config.replace(**{"mesh.element": element})) == []


def test_locking_is_told_of_white_matter_and_not_of_the_paper() -> None:
    assert locking(case()) == []
    assert locking(case({"material.poisson_ratio": 0.469})) == []
    assert len(locking(case({"material.poisson_ratio": 0.47}))) == 1
    (sentence,) = locking(case({"material.poisson_ratio_white": 0.49}))
    assert "poisson_ratio_white = 0.49" in sentence
    generalised = case({"material.poisson_ratio": 0.49, "growth.out_of_plane": "generalised"})
    assert "mean_dilatation" not in locking(generalised)[0]
