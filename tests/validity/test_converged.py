"""Whether a mesh is known to be converged, against what the study of convergence measured."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from validity_cases import COARSE, case

from gyrify.config import Config
from gyrify.convergence import judge
from gyrify.convergence.plan import plan
from gyrify.run.simulation import simulate
from gyrify.run.summary import summarise
from gyrify.run.validity.converged import LIMITS, command, convergence, limit_of, mark

MEASURED = Path(__file__).parents[2] / "docs" / "figures" / "convergence.json"
FAMILIES = (
    ("quadratic 72 × 7", "quadratic 144 × 13", "quadratic 288 × 27"),
    ("quadratic 0 drag=1.3 seed=0", "quadratic 1 drag=1.3 seed=0", "quadratic 2 drag=1.3 seed=0"),
    ("quadratic 0 branch followed", "quadratic 1 branch followed", "quadratic 2 branch followed"),
    (
        "quadratic 72 × 7 branch followed",
        "quadratic 144 × 13 branch followed",
        "quadratic 288 × 27 branch followed",
    ),
)


@pytest.mark.parametrize(("family", "number"), [*zip(FAMILIES, (0, 0, 1, 1), strict=True)])
def test_the_limits_are_those_that_were_measured(family: tuple[str, ...], number: int) -> None:
    runs = json.loads(MEASURED.read_text(encoding="utf-8"))["runs"]
    found = [runs[name]["gi_closing"] for name in family]
    verdict, limit = judge(found, 0.03), LIMITS[number]
    assert verdict.converged
    assert verdict.order is not None
    assert verdict.limit == pytest.approx(limit.gi_closing, abs=limit.uncertainty)
    assert found[-1] == pytest.approx(limit.gi_closing, rel=0.03)


def test_the_reference_slice_is_known_not_to_be_converged() -> None:
    found = convergence(Config(), 1.411, is_complete=True)
    assert found["known"] is True
    assert found["converged"] is False
    assert found["error"] == pytest.approx(0.233, abs=1e-3)
    assert "1.74 ± 0.03" in found["sentence"]
    assert "23% above" in found["sentence"]
    assert convergence(Config(), 1.411, is_complete=False)["known"] is False


def test_a_fine_mesh_of_the_same_tissue_is_converged() -> None:
    fine = case({"mesh.element": "quadratic", "mesh.n_around": 288, "mesh.n_layers": 27})
    assert convergence(fine, 1.730, is_complete=True)["converged"] is True
    assert convergence(fine, 1.698, is_complete=True)["converged"] is True
    assert convergence(fine, 1.652, is_complete=True)["converged"] is False


@pytest.mark.parametrize(
    "change",
    [
        {"material.stiffness_ratio": 1.01},
        {"growth.ratio": 3.5},
        {"geometry.cortical_thickness": 1.6},
        {"dissipation.number": 0.13},
        {"dissipation.course": "reduced"},
        {"growth.out_of_plane_exponent": 0.9},
        {"dissipation.kind": "none"},
        {"contact.enabled": False},
        {"metrics.closing_radius": 9.0},
    ],
)
def test_of_other_tissue_nothing_is_known(change: dict[str, object]) -> None:
    assert limit_of(case(change)) is None
    found = convergence(case(change), 1.411, is_complete=True)
    assert (found["known"], found["converged"], found["error"]) == (False, None, None)
    assert "not checked" in found["sentence"]


def test_the_followed_branch_has_a_limit_of_its_own() -> None:
    followed = case({"dissipation.kind": "none", "stability.follow_branch": True})
    assert limit_of(followed).gi_closing == 1.60


@pytest.mark.parametrize("refine", range(5))
def test_the_command_is_one_that_converge_accepts(refine: int) -> None:
    words = command(case(COARSE, **{"mesh.refine": refine})).split()
    assert words[:3] == ["gyrify", "converge", "config.toml"]
    changes = dict(word.split("=") for word in words if "=" in word)
    start = case(COARSE, **{"mesh.refine": int(changes.get("mesh.refine", refine))})
    assert len(plan(start, ["mesh"], 3)["mesh"]) == 3


def test_a_summary_says_it_and_counts_its_warnings() -> None:
    quick = {"solver.increments": 5, "stability.detect": False, "growth.duration": 200.0}
    summary = summarise(simulate(case(COARSE, quick)))
    assert summary["converged"]["known"] is False
    assert mark(summary["converged"], 2) == "mesh not checked; 2 warnings, see summary.json"
    assert mark({"converged": False}) == "mesh not converged"
    assert mark({"converged": True}, 1) == "mesh converged; 1 warning, see summary.json"
