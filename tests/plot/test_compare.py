"""Runs side by side: one scale, one scale bar, one map of colours, a letter for each panel."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

import gyrify
from gyrify.errors import ConfigError, HistoryError

PAIR = ("linear", "softer", "interrupted")


@pytest.mark.parametrize("what", ["folded", "stress", "thickness"])
def test_panels_share_frame_and_colours(runs, what, words) -> None:
    first, *others = (runs[name] for name in PAIR)
    figure = gyrify.plot(first, what, compare=others)
    slices = [axes for axes in figure.axes if not axes.axison]
    assert len(slices) == (9 if what == "stress" else 3)
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in slices}) == 1
    assert len({round(axes.get_position().width, 9) for axes in slices}) == 1
    columns = [slices[column::3] for column in range(3)] if what == "stress" else [slices]
    for column in columns:
        scales = {c.get_clim() for axes in column for c in axes.collections if c.get_array() is not None}
        assert len(scales) == (0 if what == "folded" else 1)
    told = words(figure)
    letters = [text for text in told if len(text) == 1]
    assert letters == list("abcdefghi"[: len(letters)])
    assert len(letters) == {"folded": 3, "stress": 9, "thickness": 6}[what]
    assert sum(text in ("10 mm", "20 mm") for text in told) == 1
    assert any("run interrupted at 50% of growth" in text for text in told)


def test_runs_are_named_by_what_they_differ_in(runs, words) -> None:
    figure = gyrify.plot(runs["linear"], "folded", compare=[runs["softer"]])
    assert {"stiffness ratio 1", "stiffness ratio 0.7"} <= set(words(figure))
    many = gyrify.plot(runs["linear"], "folded", compare=[runs["strip"], runs["softer"]])
    assert {"linear", "strip", "softer"} <= set(words(many))


@pytest.mark.parametrize(("what", "panels"), [("gi", 3), ("energy", 4), ("dispersion", 1)])
def test_curves_of_runs_share_their_axes(runs, what, panels, words) -> None:
    figure = gyrify.plot(runs["linear"], what, compare=[runs["softer"]])
    assert len(figure.axes) == panels
    names = {text for text in words(figure) if text.startswith("stiffness ratio")}
    assert names == {"stiffness ratio 1", "stiffness ratio 0.7"}
    lines = [line for line in figure.axes[0].lines if line.get_label() in names]
    assert len({line.get_color() for line in lines}) == 2
    assert not np.array_equal(lines[0].get_ydata(), lines[1].get_ydata())


def test_modes_of_runs_have_one_scale(runs) -> None:
    figure = gyrify.plot(runs["linear"], "mode", compare=[runs["mean_dilatation"]])
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in figure.axes}) == 1


def test_a_name_with_dollars_is_no_formula(runs, tmp_path, words) -> None:
    folder = shutil.copytree(runs["strip"], tmp_path / "c$^$<b>")
    for what in ("gi", "folded"):
        figure = gyrify.plot(runs["linear"], what, compare=[folder, runs["softer"]])
        assert r"c\$^\$<b>" in words(figure)  # drawn as it is: as a formula, it would be refused


@pytest.mark.parametrize(
    ("what", "options", "message"),
    [
        ("nonsense", {}, r"Choose one of: folded, gi, stress, thickness, energy, mode, dispersion"),
        ("folded", {"at": 501.0}, r"at = 501 is out of range: linear holds growth times 0 to 500"),
        ("gi", {"at": -1.0}, "out of range"),
        ("mode", {"at": 100.0}, "no meaning for mode"),
        ("dispersion", {"at": 100.0}, "no meaning for dispersion"),
        ("stress", {"stress": "shear"}, "Choose one of: von_mises, mean, circumferential"),
        ("gi", {"stress": "mean"}, "no meaning for gi"),
        ("gi", {"width_mm": 20.0}, "60 to 300 mm"),
        ("gi", {"compare": ["x"] * 8}, "a picture of gi holds at most 7 more"),
    ],
)
def test_what_cannot_be_drawn_is_refused(runs, what, options, message) -> None:
    with pytest.raises(ConfigError, match=message):
        gyrify.plot(runs["linear"], what, **options)


def test_a_folder_without_a_run_is_refused(tmp_path) -> None:
    with pytest.raises(HistoryError, match="There is no journal"):
        gyrify.plot(tmp_path, "gi")
