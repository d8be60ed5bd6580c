"""Study files: read with fractions and bases, refused with the field, the value and what to try."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from small_study import BASE, GROWTH, TEXT

from gyrify import Config
from gyrify.errors import ConfigError
from gyrify.study import Study


def design(**changes: Any) -> dict[str, Any]:
    return {"base": BASE, "design": {"kind": "grid", "parameter": [GROWTH], **changes}}


def varying(**parameter: Any) -> dict[str, Any]:
    return design(parameter=[{"key": "growth.ratio", **parameter}])


WRONG: list[tuple[str, dict[str, Any], str]] = [
    (
        "unknown top key",
        {**design(), "desing": {}},
        "desing is not a known key of a study. Did you mean design",
    ),
    ("no design", {"base": BASE}, r"needs a table \[design\]"),
    ("unknown kind", design(kind="latin"), 'design.kind = "latin" is not allowed.*Did you mean'),
    ("kind is a number", design(kind=3), "design.kind = 3 is not allowed"),
    ("unknown key", design(sead=1), "sead is not a known key of .design.. Did you mean seed"),
    ("nothing varied", design(parameter=[]), "does not vary"),
    ("parameter is a word", design(parameter=["growth.ratio"]), "is not a table"),
    ("unknown parameter", varying(key="growth.ration", values=[1]), "Did you mean growth.ratio"),
    ("unknown section", varying(key="groth.ratio", values=[1]), "groth.ratio is not a known key"),
    ("no key", design(parameter=[{"values": [1.0]}]), "Name one"),
    ("key of no influence", varying(key="output.every", values=[1]), "output.every cannot be varied"),
    ("unknown field", varying(value=[1.0]), "value is not a known key.*Did you mean values"),
    ("neither values nor range", varying(), "either values or a range"),
    ("both", varying(values=[1.0], range=[1, 2]), "either values or a range"),
    ("empty values", varying(values=[]), r"values = \[\] is not a list"),
    ("value out of bounds", varying(values=[1.0, 0.01]), r"Point 2 .*growth.ratio = 0.01.*from 0.1"),
    ("value of a wrong type", varying(values=["soft"]), 'growth.ratio = "soft" is not allowed'),
    ("twice", varying(values=[1, 1.0]), "is given twice"),
    ("equal fractions", varying(values=["1/2", 0.5]), "is given twice"),
    ("range of words", varying(key="growth.law", range=[1, 2]), "are not numbers, so that it has no range"),
    ("range of three", varying(range=[1, 2, 3]), "is not a pair"),
    ("range downwards", varying(range=[3, 2]), "does not increase"),
    ("range of nothing", varying(range=[3, 3]), "does not increase"),
    ("range of text", varying(range=[1, "a/b"]), "is not a number"),
    ("infinite range", varying(range=[1, float("inf")]), "is not a number"),
    ("range without n", varying(range=[1, 2]), "needs a number of values"),
    ("n of one", varying(range=[1, 2], n=1), "n = 1 is not allowed"),
    ("n is true", design(n=True), "design.n = true is not allowed"),
    ("logarithm of zero", varying(key="dissipation.number", range=[0, 1], scale="log"), "must begin above 0"),
    ("unknown scale", varying(range=[1, 2], scale="ln"), 'scale = "ln"'),
    ("halves of nodes", varying(key="mesh.n_around", range=[24.5, 48]), "not whole"),
    ("varied twice", design(parameter=[GROWTH, GROWTH]), "growth.ratio is varied twice"),
    (
        "lengths",
        design(kind="zip", parameter=[GROWTH, {"key": "seed", "values": [1]}]),
        "as many of each",
    ),
    ("nothing drawn", design(kind="random"), "design.n is missing"),
    ("points in a grid", design(point=[{"seed": 1}]), "is used with kind"),
    ("empty point", {"base": BASE, "design": {"kind": "list", "point": [{}]}}, "at least one key"),
    ("unknown keep", {**design(), "keep": "some"}, 'keep = "some" is not allowed'),
    ("unknown preset", {**design(), "base": {"preset": "wang"}}, "does not exist"),
    ("two bases", {**design(), "base": {"preset": "wang2019", "config": "a.toml"}}, "Leave one out"),
    ("wrong base", {**design(), "base": {"mesh": {"n_arround": 3}}}, "Did you mean mesh.n_around"),
    ("base is a word", {**design(), "base": "wang2019"}, "is not a table"),
]


@pytest.mark.parametrize(("tables", "message"), [w[1:] for w in WRONG], ids=[w[0] for w in WRONG])
def test_what_is_wrong_is_named(tables: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=f"(?s){message}") as caught:
        Study.from_mapping(tables)
    assert caught.value.advice or "Did you mean" in caught.value.message or "default" in caught.value.message


def test_a_file_is_read_with_fractions(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(TEXT.format(increments=8))
    points = Study.from_toml(tmp_path / "study.toml").points()
    assert [point.config.dissipation.number for point in points[:2]] == [0.5, 1.3]
    assert {point.config.mesh.n_around for point in points} == {48}


def test_a_base_may_be_a_file_beside_the_study(tmp_path: Path) -> None:
    config = Config.preset("reference-slice").replace(**{"geometry.cortical_thickness": 2.0})
    (tmp_path / "slice.toml").write_text(config.to_toml())
    text = TEXT.format(increments=8).replace('preset = "reference-slice"', 'config = "slice.toml"')
    (tmp_path / "study.toml").write_text(text)
    study = Study.from_toml(tmp_path / "study.toml")
    assert study.base.geometry.cortical_thickness == 2.0
    assert study.base.mesh.n_around == 48


@pytest.mark.parametrize("text", ["[design", "keep = 'all'\nkeep = 'all'", "\0"])
def test_a_broken_file_is_named(tmp_path: Path, text: str) -> None:
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(ConfigError, match=r"The study file .* is not valid TOML"):
        Study.from_toml(tmp_path / "study.toml")
    with pytest.raises(ConfigError, match="does not exist"):
        Study.from_toml(tmp_path / "none.toml")
