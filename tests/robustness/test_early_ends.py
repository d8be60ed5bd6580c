"""A run that ended early says so in status, exit code, picture and table, whatever ended it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.text
import pytest
from random_runs import STOPPED, name_of

from gyrify import Config, History, Study, run_study
from gyrify.cli import main
from gyrify.report.figures import save_figure
from gyrify.report.outputs import folded_picture
from gyrify.run.onset import detector
from gyrify.solve import branch
from gyrify.solve.increment import Increments
from gyrify.solve.problem import State
from gyrify.solve.result import Result, Solution, Stats

Capture = pytest.CaptureFixture[str]
Patch = pytest.MonkeyPatch
TINY = {"mesh.n_around": 48, "mesh.n_layers": 6, "mesh.n_cortex_layers": 2, "solver.increments": 8}
PERFECT = {"dissipation.kind": "none", "mesh.node_jitter": 0.0, "material.stiffness_ratio": 3.0}
FOLLOWED = {**PERFECT, "stability.follow_branch": True}
FROM = 3  # the increment that fails


def ends_with(result: Result) -> Callable[[Patch], None]:
    """Every attempt at an increment ends with a named result from the third on."""

    def prepare(patch: Patch) -> None:
        attempt = Increments.attempt

        def fail(increments: Increments, state: State, span: int) -> Solution:
            if state.index >= FROM - 1:
                return Solution(state.u, result, 1.0, Stats())
            return attempt(increments, state, span)

        patch.setattr(Increments, "attempt", fail)

    return prepare


def raises(error: BaseException) -> Callable[[Patch], None]:
    """The third increment raises."""

    def prepare(patch: Patch) -> None:
        attempt = Increments.attempt

        def fail(increments: Increments, state: State, span: int) -> Solution:
            if state.index >= FROM - 1:
                raise error
            return attempt(increments, state, span)

        patch.setattr(Increments, "attempt", fail)

    return prepare


def no_way_back(patch: Patch) -> None:
    """Nothing stable is found behind an unstable equilibrium."""

    def settle(*_: Any) -> None:
        raise branch._lost("no step along its lowest mode lowers the energy", "Tighten solver.tolerance.")

    patch.setattr(detector, "settle", settle)


def nothing(patch: Patch) -> None:
    """It happens by itself."""


# name: (how it is brought about, values, status, exit code, words of the reason)
ENDS: dict[str, tuple[Callable[[Patch], None], dict[str, Any], str, int, str]] = {
    **{r.name.lower(): (ends_with(r), {}, "failed", 1, r.message) for r in Result if r.message and r.advice},
    "unstable": (nothing, PERFECT, "failed", 1, "lowest eigenvalue of -"),
    "branch_lost": (
        no_way_back,
        {**PERFECT, "stability.follow_branch": True},
        "failed",
        1,
        "could not be left",
    ),
    "newton": (nothing, {"solver.max_newton": 1, "solver.min_increment": 0.05}, "failed", 1, "max_newton"),
    "memory": (raises(MemoryError()), {}, "failed", 1, "Memory ran out"),
    "memory_limit": (nothing, {"limits.memory": 1.0}, "stopped", 3, "memory limit of 1 MB"),
    "wall_time": (nothing, {"limits.wall_time": 1e-6}, "stopped", 3, "wall-time limit"),
}


@pytest.mark.parametrize("name", ENDS)
def test_a_run_says_how_it_ended(name: str, tmp_path: Path, monkeypatch: Patch, capsys: Capture) -> None:
    prepare, values, status, code, words = ENDS[name]
    prepare(monkeypatch)
    file, folder = tmp_path / "config.toml", tmp_path / "run"
    file.write_text(Config.preset("reference-slice").with_overrides({**TINY, **values}).to_toml())
    assert main(["run", str(file), "--out", str(folder), "--json", "--quiet"]) == code
    out, err = capsys.readouterr()
    summary = json.loads(out)
    assert (summary["status"], json.loads((folder / "summary.json").read_text())) == (status, summary)
    assert words in summary["reason"]
    assert summary["advice"]
    assert summary["growth_time"] < 500.0
    assert f"The run {status}: {summary['reason']}" in err
    assert f"({status} at " in written(folder, summary)
    if name not in ("memory", "memory_limit"):
        assert name_of(summary["reason"]) in ("max_newton" if name == "newton" else name)
    assert main(["verify", str(folder)]) == 0  # what it stored holds


def written(folder: Path, summary: dict[str, Any]) -> str:
    """All words in the picture of the folder, which is that of the summary."""
    figure = folded_picture(History.load(folder), summary)
    save_figure(figure, folder.parent / "again.png")
    assert (folder / "folded.png").read_bytes() == (folder.parent / "again.png").read_bytes()
    return " ".join(text.get_text() for text in figure.findobj(matplotlib.text.Text)).replace("\n", " ")


@pytest.mark.parametrize("name", ["max_newton", "unstable", "memory", "wall_time"])
def test_a_table_says_how_it_ended(name: str, tmp_path: Path, monkeypatch: Patch, capsys: Capture) -> None:
    prepare, values, status, _, words = ENDS[name]
    prepare(monkeypatch)
    base = Config.preset("reference-slice").with_overrides({**TINY, **values})
    limits = {f"limits.{key}": value for key, value in base.limits.model_dump().items() if value}
    design = {"kind": "list", "point": [{"seed": 1, **{k: v for k, v in values.items() if k not in limits}}]}
    tables = {"preset": "reference-slice", **nested({**TINY, **limits})}
    found = run_study(Study.from_mapping({"base": tables, "design": design}), tmp_path / "study")
    assert (found.status, len(found.failures)) == (status, 1)
    assert main(["table", str(tmp_path / "study"), "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["rows"]
    assert row["status"] == status
    assert words in row["reason"]
    assert (row["phenotype"], row["gi_closing"], row["n_gyri"]) == (None, None, None)  # no result, no number


def nested(values: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Tables of dotted keys."""
    tables: dict[str, dict[str, Any]] = {}
    for dotted, value in values.items():
        section, key = dotted.split(".")
        tables.setdefault(section, {})[key] = value
    return tables


def test_what_the_tissue_does_is_told_from_what_the_solver_cannot() -> None:
    assert set(STOPPED) == {"unstable"}
