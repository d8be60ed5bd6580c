"""Runs of a study of convergence: independent, kept, taken up again; failures are rows; pictures."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from gyrify import Config, History, converge, measure_state, simulate, summarise
from gyrify.convergence import METRICS, Convergence, runs
from gyrify.convergence.measured import elastic_energy, measured, visible_time
from gyrify.errors import ConfigError, SolveError
from gyrify.report.convergence_figures import (
    Shape,
    metrics_figure,
    shapes_figure,
    slices_figure,
    write_pictures,
)
from gyrify.run.running import Progress


@pytest.fixture(scope="module")
def study(tiny: Config, tmp_path_factory: pytest.TempPathFactory) -> tuple[Convergence, Path]:
    out = tmp_path_factory.mktemp("study")
    return converge(tiny, out, levels=2), out


def test_every_level_is_a_run_of_its_own_with_its_full_history(
    study: tuple[Convergence, Path], tiny: Config
) -> None:
    found, out = study
    assert found.status == "completed"
    assert [family.subject for family in found.families] == ["mesh", "increments", "contact"]
    folders = {level.folder for family in found.families for level in family.levels}
    assert {folder.name for folder in (out / "runs").iterdir()} == {folder.name for folder in folders}
    assert len(folders) == 4
    for family in found.families:
        for level in family.levels:
            history = History.load(level.folder)
            assert level.folder.name == level.config.config_hash[:12]
            assert history.config == level.config
            assert history.growth_times[0] == 0.0
            assert history.growth_times[-1] == tiny.growth.duration
    finer = found.family("mesh").levels[1]
    assert History.load(finer.folder).result_hash == simulate(finer.config).result_hash


def test_metrics_are_those_of_the_run(study: tuple[Convergence, Path]) -> None:
    level = study[0].family("mesh").levels[1]
    history = History.load(level.folder)
    summary = summarise(history)
    assert set(level.metrics) == {metric.key for metric in METRICS}
    assert level.metrics["gi_hull"] == summary["gi"]["hull"]
    assert level.metrics["n_gyri"] == summary["n_gyri"]
    assert level.metrics["sulcal_depth_mm_max"] == summary["sulcal_depth_mm"]["max"]


def test_files_hold_every_level_and_verdict(study: tuple[Convergence, Path]) -> None:
    found, out = study
    stored = json.loads((out / "convergence.json").read_text())
    assert stored == json.loads(json.dumps(found.as_dict()))
    assert stored["families"][0]["verdicts"]["gi_closing"]["sentence"]
    with (out / "convergence.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["subject"] for row in rows] == ["mesh", "mesh", "increments", "increments"] + ["contact"] * 2
    assert {row["run"] for row in rows} == {folder.name for folder in (out / "runs").iterdir()}


def test_complete_runs_are_not_run_again(
    study: tuple[Convergence, Path], tiny: Config, monkeypatch: pytest.MonkeyPatch
) -> None:
    found, out = study

    def refuse(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(runs, "_grow", refuse)
    again = converge(tiny, out, levels=2)
    assert again.status == "completed"
    assert [f.as_dict()["verdicts"] for f in again.families] == [
        f.as_dict()["verdicts"] for f in found.families
    ]


def test_an_interrupted_study_is_taken_up_where_it_ended(
    tiny: Config, study: tuple[Convergence, Path], tmp_path: Path
) -> None:
    def interrupt(progress: Progress) -> None:
        if progress.state.index == 3:
            raise KeyboardInterrupt

    folder = runs.run_folder(tiny, tmp_path / "runs")
    with pytest.raises(KeyboardInterrupt):
        simulate(tiny, folder, observers=[interrupt])
    found = converge(tiny, tmp_path, levels=2, of=["increments"])
    assert found.status == "completed"
    whole = study[0].family("mesh").levels[0]
    assert History.load(folder).result_hash == History.load(whole.folder).result_hash


def test_ctrl_c_ends_a_study_and_keeps_what_is_done(tiny: Config, tmp_path: Path) -> None:
    def stop(_: object, done: int, total: int) -> None:
        assert (done, total) == (1, 2)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        converge(tiny, tmp_path, levels=2, of=["increments"], tell=stop)
    assert len(list((tmp_path / "runs").iterdir())) == 1
    assert converge(tiny, tmp_path, levels=2, of=["increments"]).status == "completed"


def test_processes_give_the_same_bits(study: tuple[Convergence, Path], tiny: Config, tmp_path: Path) -> None:
    told = []
    found = converge(
        tiny, tmp_path, levels=2, of=["mesh"], workers=2, tell=lambda level, *_: told.append(level)
    )
    assert found.status == "completed"
    assert len(told) == 2
    for here, there in zip(study[0].family("mesh").levels, found.family("mesh").levels, strict=True):
        assert History.load(here.folder).result_hash == History.load(there.folder).result_hash
        assert here.metrics == there.metrics


def test_a_failed_run_is_a_row_with_its_reason(tiny: Config, tmp_path: Path) -> None:
    perfect = tiny.replace(
        **{"dissipation.kind": "none", "mesh.node_jitter": 0.0, "material.stiffness_ratio": 3.0}
    )
    with pytest.raises(SolveError):
        simulate(perfect)
    found = converge(perfect, tmp_path, levels=2, of=["increments"])
    assert found.status == "failed"
    family = found.family("increments")
    assert all("Buckling instability" in level.reason for level in family.levels)
    assert any("8 increments failed" in note for note in family.notes)
    assert family.verdicts["gi_hull"].converged is None
    assert json.loads((family.levels[0].folder / "summary.json").read_text())["status"] == "failed"
    assert write_pictures(found, tmp_path) == []
    assert (tmp_path / "convergence.csv").is_file()


def test_a_limit_stops_a_run_and_raising_it_continues(tiny: Config, tmp_path: Path) -> None:
    short = tiny.replace(**{"limits.wall_time": 1e-6})
    assert converge(short, tmp_path, levels=2, of=["increments"]).status == "stopped"
    assert converge(tiny, tmp_path, levels=2, of=["increments"]).status == "completed"


def test_a_folder_of_another_run_is_a_failed_row(tiny: Config, tmp_path: Path) -> None:
    simulate(tiny.replace(seed=7), runs.run_folder(tiny, tmp_path / "runs"))
    found = converge(tiny, tmp_path, levels=2, of=["increments"])
    assert found.status == "failed"
    assert "another configuration" in found.family("increments").levels[0].reason


@pytest.mark.parametrize("wrong", [{"tolerance": 0.0}, {"workers": 0}, {"levels": 9}, {"of": ["time"]}])
def test_bad_arguments_are_refused(tiny: Config, tmp_path: Path, wrong: dict[str, object]) -> None:
    with pytest.raises(ConfigError):
        converge(tiny, tmp_path / "new", **wrong)  # type: ignore[arg-type]
    assert not (tmp_path / "new").exists()


def test_folds_are_visible_between_two_increments(folded: History) -> None:
    time = visible_time(folded)
    assert time is not None
    after = int(np.searchsorted(folded.growth_times, time))
    before_index, after_index = (measure_state(folded, state).gi_closing for state in (after - 1, after))
    assert before_index <= 1.005 < after_index
    assert visible_time(folded, level=9.0) is None


def test_the_elastic_energy_is_in_millijoule_per_millimetre(folded: History) -> None:
    problem, duration = folded.slice, folded.config.growth.duration
    energy = problem.elastic_energy(problem.kinematics(duration)).evaluate(folded.state_vector(), 0).value
    assert elastic_energy(folded) == pytest.approx(1e-6 * energy)  # 1 Pa mm^2 = 1e-6 N = 1e-6 mJ / mm
    assert measured(folded)["elastic_energy_mJ_per_mm"] == elastic_energy(folded)


def test_pictures_show_every_family_and_level(study: tuple[Convergence, Path]) -> None:
    found, out = study
    files = write_pictures(found, out)
    assert {file.name for file in files} == {
        f"{subject}-{kind}.png"
        for subject in ("mesh", "increments", "contact")
        for kind in ("metrics", "shapes")
    }
    assert all(file.stat().st_size > 10_000 for file in files)
    figure = metrics_figure(found.family("mesh"))
    for axes in figure.axes:
        left, right = axes.get_xlim()
        assert left > right  # finer to the right
        assert len(axes.lines[0].get_xdata()) == 2
    assert [axes.get_title().split("\n")[0] for axes in shapes_figure(found.family("mesh")).axes] == [
        "48 × 6",
        "96 × 12",
    ]


def test_a_strip_is_drawn_down_to_its_clamped_side(tiny: Config) -> None:
    strip = tiny.replace(**{"geometry.shape": "strip", "growth.duration": 100.0, "solver.increments": 2})
    shape = Shape.of(simulate(strip))
    outline = shape.polygon(shape.contour)
    assert outline[:, 1].min() == 0.0
    assert np.ptp(outline[:, 0]) == pytest.approx(strip.geometry.length, rel=0.01)
    assert len(slices_figure([shape, shape], ["one", "two"]).axes) == 2
