"""Messages: near misses of keys and numbers, fixed configurations, questions to results."""

from __future__ import annotations

from pathlib import Path

import pytest

from gyrify.config import Config
from gyrify.config.faults import sections
from gyrify.config.numbers import number_advice
from gyrify.errors import ConfigError
from gyrify.study import run_study
from gyrify.study.query import query_results

MEANT = {
    "growth_ratio": "growth.ratio",
    "growth-ratio": "growth.ratio",
    "Growth.Ratio": "growth.ratio",
    "growth.growth_ratio": "growth.ratio",
    "growth.ratoi": "growth.ratio",
    "growth.time": "growth.duration",
    "thickness": "geometry.cortical_thickness",
    "geometry.thickness": "geometry.cortical_thickness",
    "cortical_thickness": "geometry.cortical_thickness",
    "growth.cortical_thickness": "geometry.cortical_thickness",
    "stiffness_ratio": "material.stiffness_ratio",
    "materials.poisson_ratio": "material.poisson_ratio",
    "poisson": "material.poisson_ratio",
    "wall_time": "limits.wall_time",
    "mesh.N_AROUND": "mesh.n_around",
    "Seed": "seed",
    "mash": "mesh",
}


@pytest.mark.parametrize("written", MEANT)
def test_the_key_that_is_meant_is_suggested(written: str) -> None:
    with pytest.raises(ConfigError, match=rf"Did you mean {MEANT[written]}\?"):
        Config().with_overrides({written: 1})


def test_every_key_is_found_whatever_separates_its_words() -> None:
    for section, kind in sections(Config).items():
        for field in kind.model_fields:
            with pytest.raises(ConfigError, match=rf"Did you mean {section}\.{field}\?"):
                Config().with_overrides({f"{section.upper()}-{field}": 1})


@pytest.mark.parametrize(
    ("key", "value", "advice"),
    [
        ("growth.ratio", "3,6", "Write a decimal point: 3.6."),
        ("geometry.cortical_thickness", "1.5mm", "Write the number without its unit: 1.5."),
        ("geometry.cortical_thickness", "1.5 mm", "Write the number without its unit: 1.5."),
        ("geometry.cortical_thickness", "0.15cm", "Write the number alone, in mm."),
        ("growth.ratio", "3", "Write the number without quotes."),
        ("growth.ratio", "many", "The default is 3.6."),
    ],
)
def test_numbers_that_are_almost_right(key: str, value: str, advice: str) -> None:
    with pytest.raises(ConfigError) as caught:
        Config().with_overrides({key: value})
    assert str(caught.value).endswith(advice)
    assert ("quotes" in str(caught.value)) == ("quotes" in advice)


@pytest.mark.parametrize(
    ("line", "advice"),
    [
        ("ratio = 3,6", "Write a decimal point: 3.6."),
        ("ratio = 1/1.36", 'Write a fraction in quotes: "1/1.36".'),
        ("ratio = 1.5 mm # thick", "Write the number without its unit: 1.5."),
        ("ratio = ", "Correct or complete that line."),
    ],
)
def test_lines_of_toml_that_are_almost_right(line: str, advice: str) -> None:
    with pytest.raises(ConfigError) as caught:
        Config.from_toml(f"seed = 1\n[growth]\n{line}\nrate = 0.001\n")
    assert advice in str(caught.value)


def test_advice_is_given_for_what_is_clear_alone() -> None:
    assert number_advice("3.6%") == ""
    assert number_advice("1,000,000") == ""
    assert number_advice("x" * 100) == ""
    assert number_advice("1/2") == ""


@pytest.mark.parametrize("name", ["seed", "growth", "ratio", "n_aroud"])
def test_a_configuration_is_fixed_and_says_how_to_make_another(name: str) -> None:
    config = Config()
    owner, key = {
        "ratio": (config.growth, "growth.ratio"),
        "n_aroud": (config.mesh, "n_around"),
    }.get(name, (config, name))
    with pytest.raises(ConfigError, match=rf"with_overrides\({{\"{key}\": 2}}|Did you mean {key}\?"):
        setattr(owner, name, 2)
    with pytest.raises(ConfigError):
        delattr(owner, name)
    assert config == Config()


def test_sections_know_their_names() -> None:
    assert all(kind.section_name() == name for name, kind in sections(Config).items())  # type: ignore[attr-defined]


@pytest.fixture(scope="module")
def results(tiny: Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study")
    base = tiny.with_overrides({"solver.increments": 2}).to_dict()
    design = {"kind": "grid", "parameter": [{"key": "growth.ratio", "values": [1.0, 1.5]}]}
    run_study({"base": base, "design": design}, folder)
    return folder


@pytest.mark.parametrize(
    ("where", "reason", "advice"),
    [
        ("status = completed", 'there is no column "completed"', "in single quotes: 'completed'"),
        ("growth.raito > 1", 'there is no column "growth.raito"', "Did you mean growth.ratio?"),
        ("gi_closin > 1", 'there is no column "gi_closin"', "Did you mean gi_closing?"),
        ("growth.ratio >", 'it cannot be read at ">"', "An example"),
        ("growth.ratio = 'abc'", "'abc' is not a number", "An example"),
        ("status", "'completed' is not true or false", "An example"),
        ("foo(n_gyri) > 1", 'there is no function "foo"', "An example"),
        ("status + 1 > 2", '"+" cannot join these columns', "An example"),
        ("sum(n_gyri) > 1", "over several rows are not possible", "An example"),
        ("'un", "a quotation mark is missing", "An example"),
        ("1 = 1; drop table x", "it must be one expression", "An example"),
        ("(select 1 from 'x.csv')", "it may not read files", "An example"),
        ("read_csv('x.csv')", 'the function "read_csv" is not allowed', "An example"),
    ],
)
def test_questions_that_are_not_understood(results: Path, where: str, reason: str, advice: str) -> None:
    with pytest.raises(ConfigError) as caught:
        query_results(results, where)
    told = str(caught.value)
    assert reason in told
    assert advice in told
    for word in ("Error:", "FROM", "GROUP BY", "arrow_object", "LINE", "DOUBLE", "VARCHAR", "Candidate"):
        assert word not in told
