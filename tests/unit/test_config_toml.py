"""TOML in and out, presets, overrides and the hash."""

from __future__ import annotations

import copy
import html
import json
import pickle
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gyrify.config import Config, parse_number, preset_about, preset_names
from gyrify.config.rows import rows
from gyrify.config.schema import json_schema
from gyrify.config.settings import LATER
from gyrify.errors import ConfigError
from gyrify.physics import materials
from gyrify.physics.materials import NEO_HOOKEAN

REFERENCE_HASH = "70e224fd81e3cc74d9599037b3e4cc1a74211c6ad31661f2af824bd0ccfb02e9"


def floats(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False)


OVERRIDES = st.fixed_dictionaries(
    {},
    optional={
        "seed": st.integers(0, 2**32 - 1),
        "geometry.shape": st.sampled_from(["ellipse", "circle", "strip"]),
        "geometry.area": floats(1000, 1e6),
        "geometry.aspect_ratio": floats(1, 3),
        "geometry.cortical_thickness": floats(1e-300, 0.9),
        "mesh.n_around": st.integers(24, 4096),
        "mesh.node_jitter": floats(0, 0.1),
        "material.young_modulus": floats(1e-5, 1e13),
        "material.stiffness_ratio": floats(0.05, 50),
        "material.poisson_ratio": floats(-0.99, 0.499),
        "material.poisson_ratio_white": floats(-0.99, 0.499),
        "growth.ratio": floats(0.1, 1e4),
        "growth.stretch": st.sampled_from(["linear", "exponential"]),
        "contact.enabled": st.booleans(),
        "contact.barrier_stiffness": st.just("auto") | floats(1e-5, 1e15),
        "dissipation.number": floats(0, 1000),
        "dissipation.course": st.sampled_from(["constant", "reduced"]),
        "solver.tolerance": floats(1e-300, 1e-2),
        "stability.sign": st.sampled_from([1, -1]),
        "output.fields": st.lists(st.sampled_from(["J", "region", "thickness"]), unique=True),
    },
)


@given(OVERRIDES)
@settings(max_examples=100, deadline=None)
def test_round_trip_is_exact(overrides: dict[str, Any]) -> None:
    config = Config().with_overrides(overrides)
    back = Config.from_toml(config.to_toml())
    assert back == config
    assert back.to_toml() == config.to_toml()
    assert back.config_hash == config.config_hash
    assert Config.from_dict(json.loads(json.dumps(config.to_dict()))) == config


@given(st.text(max_size=80) | st.from_regex(r"\[?(growth|mesh|seed)\]?\n?\w* ?= ?.{0,20}", fullmatch=True))
@settings(max_examples=200, deadline=None)
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        config = Config.from_toml(text)
    except ConfigError:
        return
    assert Config.from_toml(config.to_toml()) == config


@given(st.text(max_size=70) | st.from_regex(r"[-+.0-9eE/ ]{1,20}", fullmatch=True))
@settings(max_examples=200, deadline=None)
def test_numbers_are_read_or_refused(text: str) -> None:
    try:
        value = parse_number(text)
    except ValueError:
        return
    numerator, _, denominator = text.partition("/")
    assert value == float(numerator) / float(denominator or 1)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1/1.36", 1 / 1.36),
        ("-3", -3.0),
        (" 1e-3 ", 1e-3),
        (".5/ 2.", 0.25),
        ("1/2.61", 1 / 2.61),
        ("+7", 7.0),
    ],
)
def test_fraction(text: str, value: float) -> None:
    assert parse_number(text) == value


@pytest.mark.parametrize(
    "text",
    ["1/0", "0/0", "1/0.0e5", "", "/", "1/", "/2", "1/2/3", "1+1", "2**9", "(1)", "nan", "inf", "1_0", "0x10",
     "١/٢", "__import__('os')/1", "1;2", "1e999", "1/1e-320", "1" * 65, "1\n/2;"],
)  # fmt: skip
def test_no_fraction(text: str) -> None:
    with pytest.raises(ValueError):
        parse_number(text)


def test_fractions_and_negative_zero_in_toml() -> None:
    config = Config.from_toml('[material]\nstiffness_ratio = "1/1.36"\n[mesh]\nnode_jitter = -0.0')
    assert config.material.stiffness_ratio == 1 / 1.36
    assert config.config_hash == Config().replace(**{
        "material.stiffness_ratio": 1 / 1.36, "mesh.node_jitter": 0
    }).config_hash  # fmt: skip


def test_numbers_alone_are_not_code(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object) -> None:
        raise AssertionError("evaluated")

    monkeypatch.setattr("builtins.eval", forbidden)
    monkeypatch.setattr("builtins.exec", forbidden)
    with pytest.raises(ConfigError, match="a number looks like"):
        Config().replace(**{"growth.ratio": "__import__('os').getcwd()/1"})


def test_reference_slice_is_frozen() -> None:
    assert Config.preset("reference-slice") == Config()
    assert Config.preset("reference-slice").config_hash == REFERENCE_HASH


def test_reference_brain_is_frozen() -> None:
    brain = Config.preset("reference-brain")
    assert brain.config_hash == "e710c39234fd3e76e305502751422350231d4b6ad856f845d78933157f8fc67d"
    assert brain.growth.rate * brain.growth.duration == pytest.approx(1.829)
    nu = brain.material.poisson_ratio
    assert 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu)) == pytest.approx(5.0)  # bulk over shear modulus


@pytest.mark.parametrize("name", preset_names())
def test_presets_state_every_value_and_explain_themselves(name: str) -> None:
    about = preset_about(name)
    assert about.description.endswith(".")
    assert about.not_claimed
    stated = Config.preset(name).model_dump(exclude_unset=True)
    keys = {
        f"{s}.{k}" if isinstance(v, dict) else s
        for s, v in stated.items()
        for k in (v if isinstance(v, dict) else [s])
    }
    physics = {row.key for row in rows(Config()) if row.key.partition(".")[0] not in ("output", "limits")}
    followers = {row.key for row in rows(Config()) if row.follows}
    assert len(followers) == 3
    # what came later is at its default where it is not given
    later = {".".join(key) for key in LATER}
    assert physics - followers - later <= keys <= physics - followers
    assert set(about.sources) <= keys


def test_preset_then_file_then_overrides(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('preset = "wang2019"\n[growth]\nratio = 2.0\nrate = 0.001\n')
    config = Config.load(path).replace(**{"growth.rate": 0.003})
    assert (config.growth.ratio, config.growth.rate, config.growth.duration) == (2.0, 0.003, 500.0)
    assert Config.from_toml(path) == Config.load(str(path))


def test_preset_name_is_not_hashed() -> None:
    assert Config.from_toml('preset = "reference-slice"').config_hash == Config().config_hash


# What some keys need beside them.
BESIDE: dict[str, dict[str, Any]] = {
    "stability.follow_branch": {"dissipation.kind": "none"},
    "growth.transition": {"growth.profile": "sigmoid"},
    "mesh.edge_length": {"geometry.shape": "sphere"},
}


def changed(value: Any, key: str) -> Any:
    words = {
        "geometry.shape": "circle",
        "mesh.grading": "uniform",
        "mesh.split": "one",
        "mesh.element": "quadratic",
        "growth.out_of_plane": "none",
        "growth.stretch": "exponential",
        "growth.energy_per": "reference",
        "growth.law": "tangential",
        "growth.profile": "sigmoid",
        "boundary.clamp": "none",
        "geometry.semi_axes": (40.0, 33.0, 33.0),
        "material.law": "another",
        "contact.barrier_stiffness": 5.0,
        "dissipation.kind": "none",
        "dissipation.course": "reduced",
        "solver.regularisation": "projection",
        "solver.linear_solver": "superlu",
        "output.fields": ["J"],
        "stability.sign": -1,
    }
    if key in words:
        return words[key]
    if isinstance(value, bool):
        return not value
    return value + 1 if isinstance(value, int) else value * 1.01 + (value == 0)


# Keys that go with files; tests/space (test_surface_files, test_volumes, test_half_bodies) sees to them.
OF_FILES = {f"geometry.{key}" for key in ("file", "hole_file", "interface_file", "unit", "labels", "digest")}
OF_FILES |= {"boundary.plane"}


@pytest.mark.parametrize(
    "row",
    [r for r in rows(Config()) if r.key != "schema_version" and r.key not in OF_FILES],
    ids=lambda r: r.key,
)
def test_hash_sees_what_matters(row: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(materials, "MATERIALS", [NEO_HOOKEAN, replace(NEO_HOOKEAN, name="another")])
    free = BESIDE.get(row.key, {})
    config = Config().replace(**free, **{row.key: changed(row.value, row.key)})
    assert config != Config().replace(**free)
    unseen = row.key.partition(".")[0] in ("output", "limits")
    assert (config.config_hash == REFERENCE_HASH) == unseen


def test_configurations_are_frozen_and_travel() -> None:
    config = Config().replace(**{"growth.ratio": 2})
    with pytest.raises(ConfigError, match="never changes"):
        config.growth.ratio = 3  # type: ignore[misc]
    assert pickle.loads(pickle.dumps(config)) == copy.deepcopy(config) == config
    assert len({config, Config(), Config()}) == 2


@pytest.mark.parametrize(
    ("text", "suggestion"),
    [
        ("[growth]\nratoi=1", "growth.ratio"),
        ("[grwoth]", "growth"),
        ("sede=1", "seed"),
        ("ratio=2", "growth.ratio"),
        ("[mesh]\nclosing_radius=3", "metrics.closing_radius"),
        ("[material]\npoison_ratio=0.4", "material.poisson_ratio"),
    ],
)
def test_nearest_key(text: str, suggestion: str) -> None:
    with pytest.raises(ConfigError, match=rf"not a known key\. Did you mean {suggestion}\?"):
        Config.from_toml(text)


def test_unknown_override_names_its_neighbour() -> None:
    with pytest.raises(ConfigError, match=r"growth\.ratoi .*Did you mean growth\.ratio\?"):
        Config().replace(**{"growth.ratoi": 1})


def test_many_faults_are_counted_not_listed() -> None:
    with pytest.raises(ConfigError) as caught:
        Config.from_toml("".join(f"unknown{i} = {i}\n" for i in range(500)))
    assert 10 <= len(str(caught.value).splitlines()) <= 12


def test_file_name_given_as_text() -> None:
    with pytest.raises(ConfigError, match=r"use Config\.load"):
        Config.from_toml("slice.toml")


def test_notebook_table_is_escaped() -> None:
    shown = Config()._repr_html_()
    assert "geometry.area" in shown
    assert "mm²" in shown
    assert html.escape("E_G × mean cortical edge") in shown
    assert "<script" not in shown


def test_schema_describes_the_format() -> None:
    schema = json_schema()
    assert set(schema["properties"]) == {"preset", *Config.model_fields}
    ratio = schema["$defs"]["Growth"]["properties"]["ratio"]
    assert ratio["anyOf"][0] == {"type": "number", "minimum": 0.1, "maximum": 1e4}
    assert ratio["source"]
    assert json.loads(json.dumps(schema)) == schema


def test_toml_states_units() -> None:
    text = Config().to_toml()
    assert "area = 4069.0  # mm²" in text
    assert tomllib.loads(text)["material"]["poisson_ratio_white"] == 0.458
