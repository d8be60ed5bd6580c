"""States are chosen by their numbers, of Python or of NumPy."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gyrify
from gyrify import Config, History
from gyrify.errors import ConfigError, HistoryError
from gyrify.run.summary import volume_extremes
from gyrify.store.export import export
from gyrify.store.fields import fields

WHOLE = [np.int8, np.uint8, np.int32, np.int64, np.uint64, np.array]
SMALL = {"mesh.n_around": 48, "mesh.n_layers": 6, "mesh.n_cortex_layers": 2, "solver.increments": 4}


@pytest.fixture(scope="module")
def run() -> History:
    return gyrify.simulate(Config.preset("reference-slice").with_overrides(SMALL))


@pytest.mark.parametrize("kind", WHOLE)
def test_a_numpy_integer_chooses_a_state_everywhere(run: History, kind: Any, tmp_path: Path) -> None:
    index = kind(2)
    for of in (run.displacement, run.points, run.contour, run.interface, run.state_vector):
        np.testing.assert_array_equal(of(index), of(2))
    np.testing.assert_array_equal(run[index], run[2])
    assert run.axial_stretch(index) == run.axial_stretch(2)
    assert gyrify.measure_state(run, index) == gyrify.measure_state(run, 2)
    assert volume_extremes(run, index) == volume_extremes(run, 2)
    for name, values in fields(run, index).items():
        np.testing.assert_array_equal(values, fields(run, 2)[name])
    (path,) = export(run, "csv", tmp_path / "a.csv", index)
    assert {row.split(",")[0] for row in path.read_text().splitlines()[1:]} == {"2"}
    assert run.journal.state(index).index == index


def test_negative_numpy_integers_count_from_the_end(run: History) -> None:
    np.testing.assert_array_equal(run.contour(np.int64(-2)), run.contour(len(run) - 2))
    np.testing.assert_array_equal(run.contour(np.argmin(run.growth_times)), run.contour(0))
    assert gyrify.measure_state(run, np.int64(-1)) == gyrify.measure_state(run)


def test_several_states_make_a_first_axis(run: History) -> None:
    everything = np.array([run.contour(k) for k in range(len(run))])
    for index in (
        slice(1, 3),
        slice(None),
        slice(None, None, -2),
        slice(np.int64(1), np.int64(-1)),
        slice(9, 9),
    ):
        np.testing.assert_array_equal(run.contour(index), everything[index])
        np.testing.assert_array_equal(run[index], np.array(list(run))[index])
        assert run.points(index).shape[1:] == (run.mesh.n_points, 2)
    np.testing.assert_array_equal(run.contour([0, -1]), everything[[0, -1]])
    np.testing.assert_array_equal(run.contour(np.array([3, 1])), everything[[3, 1]])
    late = run.growth_times > 0.3 * run.config.growth.duration
    np.testing.assert_array_equal(run.contour(late), everything[late])
    assert run.contour([]).shape == (0, run.mesh.contour.size, 2)


@pytest.mark.parametrize(
    "index", [2.0, np.float64(2), True, np.bool_(True), "1", None, slice("a", None), slice(0, 9, 0), [0, "1"]]
)
def test_what_is_no_number_of_a_state_is_refused(run: History, index: Any) -> None:
    with pytest.raises(HistoryError, match="whole number"):
        run.contour(index)


@pytest.mark.parametrize("index", [5, -6, np.int64(99), [0, 99]])
def test_a_state_that_is_not_there_is_refused_everywhere(run: History, index: Any, tmp_path: Path) -> None:
    asked: list[Callable[[], object]] = [lambda: run.contour(index)]
    if np.ndim(index) == 0:
        asked += [
            lambda: run.axial_stretch(index),
            lambda: fields(run, index),
            lambda: gyrify.measure_state(run, index),
            lambda: volume_extremes(run, index),
            lambda: export(run, "csv", tmp_path / "a.csv", index),
        ]
    for ask in asked:
        with pytest.raises(HistoryError, match=r"There is no state -?\d+\. This history holds states 0 to 4"):
            ask()


def test_fields_are_named_by_one_word_or_several(run: History) -> None:
    assert list(fields(run, -1, "J")) == ["J"]
    assert list(fields(run, -1, np.array(["J", "von_mises"]))) == ["J", "von_mises"]
    with pytest.raises(ConfigError, match=r"There is no field 'von_mise'\. Did you mean von_mises"):
        fields(run, -1, ["von_mise"])  # type: ignore[list-item]
