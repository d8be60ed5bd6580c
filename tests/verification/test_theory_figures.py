"""The pictures of the theory draw what was computed, with a unit on every axis."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from gyrify.theory import Annulus, critical_wrinkle
from gyrify.theory.bilayer import Bilayer

_PATH = Path(__file__).parents[2] / "docs" / "figures" / "theory_curves.py"
_SPEC = importlib.util.spec_from_file_location("theory_curves", _PATH)
assert _SPEC is not None
assert _SPEC.loader is not None
draw = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(draw)


@pytest.mark.slow
def test_pictures_have_units_and_curves() -> None:
    standard = Annulus()
    drawn = [
        draw.neutral_curves((3.0,)),
        draw.critical_curves((2.0, 20.0), (0.5,)),
        draw.annulus_dispersion(standard, (200.0,), last_mode=8),
        draw.annulus_neutral_curves(standard, (3.0,), {3.0: 2.5}, (1.1, 1.5)),
        draw.base_states(standard, (100.0, 500.0)),
    ]
    for figure in drawn:
        for axes in figure.axes:
            assert "[" in axes.get_xlabel()
            assert "[" in axes.get_ylabel()
            assert axes.lines or axes.collections


def test_the_marked_minimum_is_the_lowest_of_the_curve() -> None:
    axes = draw.neutral_curves((3.0,)).axes[0]
    curve, mark = axes.lines[0], axes.lines[1]
    assert mark.get_ydata()[0] == pytest.approx(np.min(curve.get_ydata()), abs=1e-4)
    assert mark.get_ydata()[0] == critical_wrinkle(Bilayer(3.0)).load


def test_ratios_are_written_as_people_do() -> None:
    assert [draw.ratio_name(r) for r in (1 / 3, 1 / 1.36, 0.8, 1.0, 1.54)] == [
        "1/3",
        "1/1.36",
        "0.8",
        "1",
        "1.54",
    ]
