"""Every public function takes NumPy scalars, arrays, Path and str, and refuses other things by name."""

# A table of calls: each takes what all take.
# ruff: noqa: ARG005

from __future__ import annotations

import inspect
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gyrify
from gyrify import Config, History, Study
from gyrify.base.arguments import as_words, native, whole_number
from gyrify.errors import ConfigError, GyrifyError, HistoryError, MeshError

WHOLE = [np.int8, np.uint8, np.int32, np.int64, np.uint64, np.array]
REAL = [np.float64, np.float32, np.int64, np.array]
SMALL = {"mesh.n_around": 48, "mesh.n_layers": 6, "mesh.n_cortex_layers": 2, "solver.increments": 4}


@pytest.fixture(scope="module")
def small() -> Config:
    return Config.preset("reference-slice").with_overrides(SMALL)


@pytest.fixture(scope="module")
def run(small: Config) -> History:
    return gyrify.simulate(small)


@pytest.fixture(scope="module")
def folder(small: Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("stored") / "run"
    gyrify.simulate(small, place)
    return place


# --- configurations and studies ------------------------------------------------------------------


@pytest.mark.parametrize("kind", REAL)
def test_a_configuration_takes_numpy_numbers(small: Config, kind: Any) -> None:
    plain = small.replace(**{"growth.ratio": 2.0})
    for made in (
        small.replace(**{"growth.ratio": kind(2)}),
        Config.from_dict({**small.to_dict(), "growth": {**small.to_dict()["growth"], "ratio": kind(2)}}),
    ):
        assert made.config_hash == plain.config_hash
        assert type(made.growth.ratio) is float
        assert made.to_toml() == plain.to_toml()


@pytest.mark.parametrize("kind", WHOLE)
def test_counts_seeds_and_switches_may_be_numpy_scalars(small: Config, kind: Any) -> None:
    made = small.replace(**{"mesh.n_around": kind(60), "seed": kind(3), "contact.enabled": np.bool_(False)})
    assert made == small.replace(**{"mesh.n_around": 60, "seed": 3, "contact.enabled": False})
    assert made.with_overrides({"output.fields": np.array(["J"])}).output.fields == ("J",)
    with pytest.raises(ConfigError, match="whole number from 24 to 4096"):
        small.replace(**{"mesh.n_around": np.float64(60.5)})


def test_a_study_takes_numpy_arrays(small: Config) -> None:
    def study(array: Callable[[Any], Any]) -> tuple[str, ...]:
        grid = {"kind": "grid", "parameter": [{"key": "growth.ratio", "values": array([2.0, 3.0])}]}
        drawn = {
            "kind": "random",
            "n": array(3),
            "seed": array(1),
            "parameter": [
                {"key": "growth.ratio", "range": array([2.0, 3.0])},
                {"key": "mesh.n_around", "range": array([48, 60])},
            ],
        }
        made = [Study.from_mapping({"base": small.to_dict(), "design": design}) for design in (grid, drawn)]
        return tuple(point.key for each in made for point in each.points()) + tuple(s.to_toml() for s in made)

    assert study(np.array) == study(lambda value: value)


# --- every public function -----------------------------------------------------------------------


def as_kinds(path: Path) -> list[Any]:
    """One path as text and as a Path."""
    return [str(path), path]


# By name, calls with arguments of NumPy and of both kinds of path; and with what must be refused.
Calls = Callable[[History, Path, Path], list[Callable[[], object]]]
TAKEN: dict[str, Calls] = {
    "animate": lambda h, f, tmp: [
        lambda: gyrify.animate(f, tmp / "a.gif", fps=np.float32(2), seconds=np.array(1), width=np.int64(200)),
        lambda: gyrify.animate(str(f), str(tmp / "b.gif"), fps=2, seconds=1, width=200),
    ],
    "converge": lambda h, f, tmp: [
        lambda place=place: gyrify.converge(
            h.config,
            place,
            levels=np.int64(2),
            of=np.array(["increments"]),
            workers=np.int64(1),
            tolerance=np.float32(0.02),
        )
        for place in as_kinds(tmp / "convergence")
    ],
    "cortical_thickness": lambda h, f, tmp: [
        lambda: gyrify.cortical_thickness(h.contour().tolist(), h.interface().astype(np.float32))
    ],
    "critical_growth": lambda h, f, tmp: [
        lambda: gyrify.critical_growth(
            h.config,
            range=np.array([1.0, 2.0]),
            points=np.int64(3),
            tolerance=np.float32(1e-2),
            level=np.float64(1.1),
        )
    ],
    "growth_ratio_from_scaling": lambda h, f, tmp: [
        lambda: gyrify.growth_ratio_from_scaling(np.array(1.5), area=np.int64(4069), unit=np.str_("mm"))
    ],
    "growth_ratio_from_volumes": lambda h, f, tmp: [
        lambda: gyrify.growth_ratio_from_volumes(np.float32(4), np.array(2))
    ],
    "gyrification_index": lambda h, f, tmp: [
        lambda radius=radius: gyrify.gyrification_index(h.contour().tolist(), np.str_("closing"), radius)
        for radius in (np.int64(10), np.float32(10), np.array(10.0))
    ],
    "length_increase": lambda h, f, tmp: [lambda: gyrify.length_increase(np.int64(60), np.array(1200))],
    "measure": lambda h, f, tmp: [
        lambda: gyrify.measure(
            h.contour().tolist(), h.interface(), np.float32(10), np.array(0.3), np.int64(2000)
        )
    ],
    "measure_state": lambda h, f, tmp: [lambda: gyrify.measure_state(h, np.int64(-1))],
    "plot": lambda h, f, tmp: [
        *[lambda at=at: gyrify.plot(h, at=at) for at in (np.float64(200), np.int32(200), np.array(200.0))],
        lambda: gyrify.plot(str(f), np.str_("gi"), compare=f, width_mm=np.int64(180)),
        lambda: gyrify.plot(f, "gi", compare=str(f)),
        lambda: gyrify.plot(h, "gi", compare=h),
    ],
    "read_results": lambda h, f, tmp: [
        lambda place=place: gyrify.read_results(place) for place in as_kinds(study_of(h, tmp))
    ],
    "resume": lambda h, f, tmp: [
        lambda place=place: gyrify.resume(place, overrides={"limits.wall_time": np.float64(99)})
        for place in as_kinds(f)
    ],
    "run_study": lambda h, f, tmp: [lambda: study_of(h, tmp, workers=np.int64(1))],
    "simulate": lambda h, f, tmp: [
        lambda: gyrify.simulate(h.config, str(tmp / "a")),
        lambda: gyrify.simulate(h.config, tmp / "b"),
    ],
    "summarise": lambda h, f, tmp: [lambda: json.dumps(gyrify.summarise(h))],
    "write_outputs": lambda h, f, tmp: [
        lambda place=place: gyrify.write_outputs(History.load(place), place) for place in as_kinds(f)
    ],
}
REFUSED: dict[str, Calls] = {
    "animate": lambda h, f, tmp: [
        lambda: gyrify.animate(h, tmp / "a.gif", fps="2"),  # type: ignore[arg-type]
        lambda: gyrify.animate(h, tmp / "a.gif", width=np.array([200, 300])),  # type: ignore[arg-type]
        lambda: gyrify.animate(h, 5),  # type: ignore[arg-type]
        lambda: gyrify.animate(h, tmp / "a.gif", field=None),  # type: ignore[arg-type]
    ],
    "converge": lambda h, f, tmp: [
        lambda: gyrify.converge(h.config, tmp, levels=2.5, of="increments"),  # type: ignore[arg-type]
        lambda: gyrify.converge(h.config, tmp, tolerance="a"),  # type: ignore[arg-type]
        lambda: gyrify.converge(h.config, tmp, of=5),  # type: ignore[arg-type]
    ],
    "critical_growth": lambda h, f, tmp: [
        lambda: gyrify.critical_growth(h.config, range=3.0),  # type: ignore[arg-type]
        lambda: gyrify.critical_growth(h.config, range="12"),  # type: ignore[arg-type]
        lambda: gyrify.critical_growth(h.config, points=3.5),  # type: ignore[arg-type]
        lambda: gyrify.critical_growth(h.config, level=None),  # type: ignore[arg-type]
    ],
    "growth_ratio_from_scaling": lambda h, f, tmp: [
        lambda: gyrify.growth_ratio_from_scaling("1.5"),  # type: ignore[arg-type]
        lambda: gyrify.growth_ratio_from_scaling(np.array([1.5, 2.0])),  # type: ignore[arg-type]
    ],
    "growth_ratio_from_volumes": lambda h, f, tmp: [
        lambda: gyrify.growth_ratio_from_volumes(np.array([4.0, 5.0]))  # type: ignore[arg-type]
    ],
    "gyrification_index": lambda h, f, tmp: [
        lambda: gyrify.gyrification_index(h.contour(), np.array(["hull", "closing"])),  # type: ignore[arg-type]
        lambda: gyrify.gyrification_index(h.contour(), "closing", "10"),  # type: ignore[arg-type]
        lambda: gyrify.gyrification_index([["a", "b"]] * 3),
    ],
    "length_increase": lambda h, f, tmp: [
        lambda: gyrify.length_increase(None)  # type: ignore[arg-type]
    ],
    "measure": lambda h, f, tmp: [
        lambda: gyrify.measure(h.contour(), h.interface(), samples=2000.5),  # type: ignore[arg-type]
        lambda: gyrify.measure(h.contour(), h.interface(), [1, 2]),  # type: ignore[arg-type]
    ],
    "plot": lambda h, f, tmp: [
        lambda: gyrify.plot(h, at="200"),  # type: ignore[arg-type]
        lambda: gyrify.plot(h, at=np.array([200.0, 300.0])),  # type: ignore[arg-type]
        lambda: gyrify.plot(h, None),  # type: ignore[arg-type]
        lambda: gyrify.plot(5),  # type: ignore[arg-type]
    ],
    "read_results": lambda h, f, tmp: [lambda: gyrify.read_results(None)],  # type: ignore[arg-type]
    "resume": lambda h, f, tmp: [lambda: gyrify.resume(5)],  # type: ignore[arg-type]
    "run_study": lambda h, f, tmp: [
        lambda: study_of(h, tmp, workers="1"),
        lambda: study_of(h, tmp, workers=1.5),
    ],
    "simulate": lambda h, f, tmp: [lambda: gyrify.simulate(h.config, 5)],  # type: ignore[arg-type]
    "write_outputs": lambda h, f, tmp: [lambda: gyrify.write_outputs(h, None)],  # type: ignore[arg-type]
}


def study_of(history: History, folder: Path, workers: Any = 1) -> Path:
    """A study of one point."""
    design = {"kind": "list", "parameter": [{"key": "seed", "values": [0]}]}
    study = Study.from_mapping({"base": history.config.to_dict(), "design": design})
    gyrify.run_study(study, folder / "study", workers=workers)
    return folder / "study"


def test_no_public_function_is_left_out() -> None:
    public = {name for name in gyrify.__all__ if inspect.isfunction(getattr(gyrify, name))}
    assert public == set(TAKEN)


@pytest.mark.filterwarnings("error::DeprecationWarning")
@pytest.mark.parametrize("name", TAKEN)
def test_numpy_arguments_and_both_kinds_of_path_are_taken(
    name: str, run: History, folder: Path, tmp_path: Path
) -> None:
    for call in TAKEN[name](run, folder, tmp_path):
        assert call() is not None


@pytest.mark.parametrize("name", REFUSED)
def test_other_things_are_refused_by_name(name: str, run: History, folder: Path, tmp_path: Path) -> None:
    for call in REFUSED[name](run, folder, tmp_path):
        with pytest.raises((ConfigError, MeshError, HistoryError)) as caught:
            call()
        assert caught.value.advice


def test_folders_and_files_are_read_from_both_kinds_of_path(folder: Path) -> None:
    for place in as_kinds(folder):
        assert len(History.load(place)) == 5
    for file in as_kinds(folder / "config.toml"):
        assert Config.load(file).mesh.n_around == 48
    for wrong in (None, 5, ""):
        with pytest.raises(GyrifyError, match="is not a path"):
            History.load(wrong)  # type: ignore[arg-type]


def test_plain_values_come_out_of_every_container() -> None:
    assert native({"a": (np.int64(1), [np.float32(0.5)]), "b": np.arange(3)}) == {
        "a": (1, [0.5]),
        "b": [0, 1, 2],
    }
    assert as_words("words", np.str_("one")) == ("one",)
    for value, message in ((9, "from 1 to 8"), (0, "from 1 to 8"), (1.0, "not a whole number")):
        with pytest.raises(ConfigError, match=message):
            whole_number("n", value, 1, 8)
