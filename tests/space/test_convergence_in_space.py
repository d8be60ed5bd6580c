"""Convergence of a body in space: levels by the edges of its surface, judged as in the plane."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from solids import BALL, config

from gyrify import History
from gyrify.cli import main
from gyrify.config import Config
from gyrify.convergence import Convergence, converge
from gyrify.convergence.measured import METRICS, metrics
from gyrify.convergence.plan import plan
from gyrify.errors import ConfigError
from gyrify.report.convergence_figures import PANELS, write_pictures
from gyrify.run.validity.converged import command
from gyrify.run.validity.exact_bodies import sphere_of
from gyrify.theory import sphere_state

# Smooth and without drag: exact theory knows its energy.
GROWING = config(
    BALL,
    **{
        "mesh.edge_length": 20.0,
        "mesh.element": "mean_dilatation",
        "mesh.n_layers": 4,
        "growth.duration": 150.0,
        "dissipation.kind": "none",
        "mesh.node_jitter": 0.0,
        "solver.increments": 2,
        "metrics.closing_radius": 25.0,
    },
)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> tuple[Convergence, Path]:
    out = tmp_path_factory.mktemp("converge")
    return converge(GROWING, out, levels=2, of="mesh"), out


def test_levels_halve_edges_and_layers(study: tuple[Convergence, Path]) -> None:
    family = study[0].family("mesh")
    assert [level.name("mesh") for level in family.levels] == ["edges of 20 mm", "edges of 10 mm"]
    coarse, fine = (History.load(level.folder).mesh for level in family.levels)
    assert fine.faces.shape[0] == 4 * coarse.faces.shape[0]
    assert family.levels[1].config.mesh.refine == 1


def test_the_energy_tends_to_that_of_the_exact_sphere(study: tuple[Convergence, Path]) -> None:
    """In mJ; halving the edges divides the error by about four."""
    exact = 1e-6 * sphere_state(sphere_of(GROWING), 150.0).energy
    values = np.array([level.metrics["elastic_energy_mJ"] for level in study[0].family("mesh").levels])
    errors = np.abs(values / exact - 1.0)
    assert errors[1] < 0.02
    assert errors[0] > 2.5 * errors[1]


def test_it_compares_what_a_surface_has(study: tuple[Convergence, Path]) -> None:
    found, out = study
    verdicts = found.family("mesh").verdicts
    assert list(verdicts) == [metric.key for metric in metrics(3)]
    assert {"gi_area_hull", "gi_area_closing", "gi_sections", "n_gyri", "elastic_energy_mJ"} <= set(verdicts)
    assert not {"gi_closing", "gi_exposed", "elastic_energy_mJ_per_mm"} & set(verdicts)
    assert "elastic_energy_mJ" not in {metric.key for metric in METRICS}
    assert verdicts["gi_area_hull"].converged is True
    assert verdicts["elastic_energy_mJ"].error == pytest.approx(
        3.0 * abs(np.diff(verdicts["elastic_energy_mJ"].values).item())
    )
    rows = list(csv.DictReader((out / "convergence.csv").open(encoding="utf-8")))
    assert [row["resolution"] for row in rows] == ["20.0", "10.0"]
    assert float(rows[1]["elastic_energy_mJ"]) == verdicts["elastic_energy_mJ"].values[1]
    written = json.loads((out / "convergence.json").read_text())
    assert written["families"][0]["levels"][0]["level"] == "edges of 20 mm"
    assert "gi_area_closing" in found._repr_html_()
    assert {key for _, keys in PANELS[3] for key in keys} == set(verdicts)
    assert [path.name for path in write_pictures(found, out)] == ["mesh-metrics.png"]


def test_the_command_takes_it_up_and_prints_it(study: tuple[Convergence, Path], capsys: Any) -> None:
    (study[1] / "config.toml").write_text(GROWING.to_toml(), encoding="utf-8")
    options = ["--of", "mesh", "--levels", "2", "--workers", "1", "--out", str(study[1])]
    assert main(["converge", str(study[1] / "config.toml"), *options]) == 0
    printed, said = capsys.readouterr()
    assert "GI by area, closing" in printed
    assert "elastic energy [mJ]" in printed
    assert "edges of 10 mm mean_dilatation" in said
    # what a run advises is what was run
    assert command(GROWING) == "gyrify converge config.toml --of mesh --levels 2"
    finest = GROWING.replace(**{"mesh.refine": 4, "mesh.edge_length": 40.0})
    assert command(finest).endswith("--levels 2 --set mesh.refine=3")


def test_too_many_levels_of_a_brain_are_refused_with_a_number_that_is_not() -> None:
    brain = Config.preset("reference-brain")
    with pytest.raises(ConfigError, match=r"Level 3 of 3 is not allowed.*--levels 2"):
        plan(brain, ["mesh"], 3)
    assert len(plan(brain, ["mesh"], 2)["mesh"]) == 2
