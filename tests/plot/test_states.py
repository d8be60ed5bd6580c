"""Pictures of states: what is drawn equals what is stored, at the scale that the bar says."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D

import gyrify
from gyrify.errors import ConfigError
from gyrify.report.plot.shown import show
from gyrify.report.plot.thickness import Profile
from gyrify.store.fields import fields

STRESSES = ("von_mises", "mean_stress", "circumferential_stress")
PICTURES = ("folded", "stress", "thickness")
SLICES = ("linear", "quadratic", "mean_dilatation", "strip", "smooth", "failed", "stopped", "interrupted")


def filled(axes) -> PolyCollection:
    """The field in some axes."""
    (collection,) = [item for item in axes.collections if isinstance(item, PolyCollection)]
    return collection


def bar_mm(figure) -> tuple[float, str]:
    """Length that the scale bar covers in the first axes [mm], and what it says."""
    figure.canvas.draw()
    (bar,) = [item for item in figure.get_children() if isinstance(item, Line2D)]
    pixels = float(np.ptp(bar.get_xdata())) * figure.bbox.width
    one = float(np.ptp(figure.axes[0].transData.transform([(0, 0), (1, 0)])[:, 0]))
    (said,) = [text.get_text() for text in figure.texts if re.fullmatch(r"[\d.]+ mm", text.get_text())]
    return pixels / one, said


@pytest.mark.parametrize("name", SLICES)
@pytest.mark.parametrize("what", PICTURES)
def test_every_kind_of_run_is_drawn_with_a_true_scale_bar(runs, name, what, words) -> None:
    figure = gyrify.plot(runs[name], what)
    length, said = bar_mm(figure)
    assert said == f"{round(length, 6):g} mm"
    assert length == pytest.approx(float(said.split()[0]), rel=1e-6)
    told = " ".join(words(figure))
    endings = {
        "failed": "run failed at 0%",
        "stopped": "run stopped at 0%",
        "interrupted": "run interrupted at 50%",
    }
    assert endings.get(name, "E ratio 1") in told
    assert ("run " in told) == (name in endings)


@pytest.mark.parametrize("name", ["linear", "quadratic", "strip"])
def test_stresses_in_colour_are_the_stored_ones(history, name) -> None:
    run = history(name)
    figure = gyrify.plot(run, "stress")
    slices, bars = figure.axes[:3], figure.axes[3:]
    stored = fields(run, -1, STRESSES)
    per_cell = {"linear": 1, "quadratic": 4, "strip": 3}[name]
    for axes, bar, field in zip(slices, bars, STRESSES, strict=True):
        drawn = np.asarray(filled(axes).get_array())
        images = drawn.reshape(per_cell, -1) if name == "strip" else drawn.reshape(-1, per_cell).T
        for image in images:
            assert image == pytest.approx(1e-3 * stored[field])
        assert bar.get_xlabel().endswith("[kPa]")
    low, high = filled(slices[1]).get_clim()
    assert low == pytest.approx(-high)  # a signed stress is white where it vanishes


def test_one_stress_of_three_is_one_panel(history) -> None:
    figure = gyrify.plot(history("linear"), "stress", stress="mean")
    assert len(figure.axes) == 2
    assert figure.axes[1].get_xlabel() == "mean stress [kPa]"


def test_an_earlier_state_is_the_stored_one_nearest_to_the_time(history, words) -> None:
    run = history("linear")
    index = 3
    figure = gyrify.plot(run, "folded", at=float(run.growth_times[index]) + 5.0)
    contour = figure.axes[0].lines[-1].get_xydata()
    assert contour[:-1] == pytest.approx(run.contour(index))
    assert any("growth time" in text for text in words(figure))


@pytest.mark.parametrize("name", ["linear", "quadratic", "strip"])
def test_thickness_along_the_contour_is_the_stored_one(history, name) -> None:
    run = history(name)
    axes = gyrify.plot(run, "thickness").axes[1]
    arc, thickness = axes.lines[0].get_xydata().T
    stored = fields(run, -1, ("thickness",))["thickness"][run.mesh.contour]
    assert thickness[:-1] == pytest.approx(stored)
    assert thickness[-1] == thickness[0]
    assert arc[-1] == pytest.approx(gyrify.measure_state(run).contour_length)
    assert axes.get_xlabel() == "arc length along the contour [mm]"
    assert axes.get_ylabel() == "cortical thickness [mm]"


def test_crowns_and_fundi_are_as_many_as_the_gyri(folded, history) -> None:
    for run in (folded, history("strip")):
        (state,) = show([run])
        profile = Profile.of(state)
        assert state.measures.n_gyri > 2
        assert len(profile.crowns) == len(profile.fundi) == state.measures.n_gyri
        crown, fundus = (
            float(np.interp(places, profile.arc, profile.thickness).mean())
            for places in (profile.crowns, profile.fundi)
        )
        assert fundus < crown
        # measured between the points of the contour, too, where the stored thickness is interpolated
        assert crown == pytest.approx(state.measures.thickness_crown, rel=0.02)
        assert fundus == pytest.approx(state.measures.thickness_fundus, rel=0.02)


def test_thickness_in_colour_is_that_of_the_contour_beside(folded) -> None:
    figure = gyrify.plot(folded, "thickness")
    drawn = filled(figure.axes[0]).get_array()
    cortex = folded.mesh.region == 1
    assert np.array_equal(np.ma.getmaskarray(drawn), ~cortex)
    stored = fields(folded, -1, ("thickness",))["thickness"][folded.mesh.contour]
    assert drawn.min() >= stored.min()
    assert drawn.max() <= stored.max()
    column = folded.mesh.patch[cortex] % folded.mesh.contour.size
    values = np.asarray(drawn[cortex])
    by_column = [np.ptp(values[column == number]) for number in np.unique(column)]
    assert max(by_column) < 0.05 * np.ptp(stored)


def test_the_mode_is_drawn_from_the_onset(history) -> None:
    run = history("linear")
    figure = gyrify.plot(run, "mode")
    before = run.mesh.points + run.onset.displacement[: run.mesh.n_points]
    dashed = figure.axes[0].lines[2].get_xydata()
    assert dashed[:-1] == pytest.approx(before[run.mesh.contour])
    moved = figure.axes[0].lines[3].get_xydata()[:-1] - dashed[:-1]
    mode = run.onset.vector[run.mesh.contour]
    assert moved * np.abs(mode).max() == pytest.approx(mode * np.abs(moved).max(), abs=1e-9)


def test_there_is_no_mode_without_an_onset(runs: dict[str, Path]) -> None:
    with pytest.raises(ConfigError, match=r"no onset was found up to growth time 500"):
        gyrify.plot(runs["smooth"], "mode")
    with pytest.raises(ConfigError, match=r"not looked for \(stability.detect = false\)"):
        gyrify.plot(runs["unseen"], "mode")
