"""What objects say of themselves, states by growth time, pictures from a history, units in files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

import gyrify
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.report.outputs import write_outputs
from gyrify.run.simulation import simulate
from gyrify.run.summary import measure_state, metrics_rows, summarise
from gyrify.run.units import unit_of
from gyrify.store import History
from gyrify.verify import verify


@pytest.fixture(scope="module")
def history(tiny: Config) -> History:
    return simulate(tiny)


def test_the_nearest_stored_state_is_taken(history: History) -> None:
    times = history.growth_times
    assert [history.at(time) for time in times] == list(range(len(history)))
    step = times[1] - times[0]
    assert history.at(time=times[3] + 0.4 * step) == 3
    assert history.at(time=times[3] + 0.6 * step) == 4
    assert history.at(np.float64(times[3] + 0.5 * step)) == 3  # the earlier of two
    assert np.array_equal(history.points(history.at(time=times[3])), history.points(3))
    for wrong in (-1.0, times[-1] + step, float("nan")):
        with pytest.raises(ConfigError, match="holds growth times 0 to 500"):
            history.at(time=wrong)


def test_a_history_draws_itself(history: History) -> None:
    figure = history.plot()
    assert len(figure.axes) == 1
    assert len(history.plot("gi").axes) == 3
    assert figure._repr_png_().startswith(b"\x89PNG")  # type: ignore[attr-defined]
    with pytest.raises(ConfigError, match="Choose one of: folded"):
        history.plot("nonsense")


def test_a_state_by_its_growth_time_for_pyvista(history: History) -> None:
    pytest.importorskip("pyvista")
    by_time, by_index = history.to_pyvista(time=history.growth_times[4]), history.to_pyvista(4)
    assert np.array_equal(by_time.points, by_index.points)


def test_metrics_say_what_matters_in_a_line(history: History) -> None:
    measures = measure_state(history)
    told = repr(measures)
    assert told.startswith(f"Measures(GI {measures.gi_closing:.3f} (closing of 10 mm)")
    assert "\n" not in told
    html = measures._repr_html_()
    assert all(f"<th>{name}</th>" in html for name in measures.flat())


def test_thresholds_and_convergence_say_what_they_found(tiny: Config, tmp_path: Path) -> None:
    found = gyrify.critical_growth(tiny, "growth.time", range=(100.0, 500.0), points=4)
    value = found.critical_value
    told = repr(found)
    assert told.startswith("Threshold(growth.time")
    assert (f"= {value:.6g}" if value is not None else "nothing is critical") in told
    assert len(told) < 160
    assert "<table>" in found._repr_html_()
    result = gyrify.converge(
        tiny.with_overrides({"solver.increments": 2}), tmp_path, levels=2, of=["increments"]
    )
    assert repr(result).startswith(
        "Convergence(completed; converged within 0.02 by refinement of increments:"
    )
    assert result._repr_html_().count("<tr>") == 1 + len(result.families[0].verdicts)


@pytest.fixture(scope="module")
def study_result(tiny: Config, tmp_path_factory: pytest.TempPathFactory) -> gyrify.study.StudyResult:  # type: ignore[name-defined]
    base = tiny.with_overrides({"solver.increments": 2}).to_dict()
    parameter = {"key": "geometry.cortical_thickness", "values": [1.5, 2.0]}
    study = gyrify.Study.from_mapping({"base": base, "design": {"kind": "grid", "parameter": [parameter]}})
    assert repr(study) == "Study(grid of geometry.cortical_thickness: 2 points, keep final)"
    return gyrify.run_study(study, tmp_path_factory.mktemp("study"))


def test_a_study_says_what_it_came_to(study_result) -> None:
    folder = study_result.folder
    told = f"StudyResult(completed: 2 of 2 runs completed, 2 of them computed now, in {folder})"
    assert repr(study_result) == told
    html = study_result._repr_html_()
    assert "geometry.cortical_thickness" in html
    assert html.count("<tr>") == 3


def test_columns_of_results_carry_their_units(study_result) -> None:
    schema = pq.read_schema(study_result.folder / "results.parquet")
    units = {field.name: (field.metadata or {}).get(b"unit", b"").decode() for field in schema}
    assert units["sulcal_depth_mm_max"] == units["geometry.cortical_thickness"] == "mm"
    assert units["growth_time"] == "growth time"
    assert units["onset_eigenvalue"] == "Pa/mm²"
    assert units["status"] == ""
    numbers = [field.name for field in schema if str(field.type) in ("double", "int64")]
    assert [name for name in numbers if not units[name] and "." not in name] == []
    assert not {name for name in units if name.startswith(("parameters", "units"))}
    table = gyrify.read_results(study_result.folder)
    assert table.schema.field("gi_closing").metadata == {b"unit": b"1"}


def test_the_summary_has_parameters_and_units(tiny: Config, history: History) -> None:
    summary = summarise(history)
    assert summary["parameters"]["growth.ratio"] == 3.6
    assert summary["parameters"]["mesh.n_layers"] == tiny.mesh.n_layers
    assert "metrics.samples" not in summary["parameters"]  # the default
    other = summarise(simulate(tiny.with_overrides({"metrics.samples": 1000, "solver.increments": 2})))
    assert other["parameters"]["metrics.samples"] == 1000
    assert summary["units"]["sulcal_depth_mm_max"] == "mm"
    assert all(unit == unit_of(name) != "" for name, unit in summary["units"].items())
    json.dumps(summary, allow_nan=False)


def test_every_number_of_the_metrics_has_a_unit(history: History) -> None:
    row = metrics_rows(history)[-1]
    numbers = [name for name, value in row.items() if isinstance(value, float | int) and value is not True]
    lacking = [name for name in numbers if not unit_of(name) and not isinstance(row[name], bool)]
    assert lacking == ["increment"]


def test_summaries_without_the_new_keys_still_verify(tiny: Config, tmp_path: Path) -> None:
    history = simulate(tiny, tmp_path / "run")
    write_outputs(history, tmp_path / "run")
    path = tmp_path / "run" / "summary.json"
    summary = json.loads(path.read_text())
    for key in ("parameters", "units"):
        del summary[key]
    path.write_text(json.dumps(summary))
    checks = {check.name: check for check in verify(tmp_path / "run").checks}
    assert checks["summary.json"].passed, checks["summary.json"]
    path.write_text(json.dumps({**summary, "n_gyri": 99}))
    checks = {check.name: check for check in verify(tmp_path / "run").checks}
    assert not checks["summary.json"].passed
