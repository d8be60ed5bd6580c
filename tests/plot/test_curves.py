"""Curves against growth time, and the exact dispersion: what is plotted equals what is stored or exact."""

from __future__ import annotations

import numpy as np
import pytest

import gyrify
from gyrify.errors import ConfigError
from gyrify.report.plot.dispersion import annulus_of, dispersion
from gyrify.run.reevaluation import reevaluated
from gyrify.run.summary import metrics_rows
from gyrify.theory import critical_growth_time, lowest_eigenvalue

TIME = "growth time [model units]"


def curve(axes, label: str) -> np.ndarray:
    """(n, 2) data of a named curve."""
    (found,) = [line for line in axes.lines if line.get_label() == label]
    return np.asarray(found.get_xydata(), dtype=float)


@pytest.mark.parametrize("name", ["linear", "strip", "stopped"])
def test_indices_are_those_of_the_metrics(history, name) -> None:
    run = history(name)
    figure = gyrify.plot(run, "gi")
    rows = metrics_rows(run)
    index, depth, gyri = figure.axes
    for axes, label, key in (
        (index, "closing, 10 mm", "gi_closing"),
        (index, "convex hull", "gi_hull"),
        (depth, "deepest", "sulcal_depth_mm_max"),
        (depth, "mean", "sulcal_depth_mm_mean"),
    ):
        drawn = curve(axes, label)
        assert drawn[:, 0] == pytest.approx([row["growth_time"] for row in rows])
        assert drawn[:, 1] == pytest.approx([row[key] for row in rows])
    assert gyri.lines[0].get_ydata() == pytest.approx([row["n_gyri"] for row in rows])
    assert [axes.get_ylabel() for axes in figure.axes] == [
        "gyrification index [–]",
        "sulcal depth [mm]",
        "gyri [count]",
    ]
    assert gyri.get_xlabel() == TIME


def test_the_onset_is_marked_where_it_was(history, words) -> None:
    run = history("linear")
    figure = gyrify.plot(run, "gi")
    for axes in figure.axes:
        assert any(list(line.get_xdata()) == [run.onset.growth_time] * 2 for line in axes.lines)
    assert "onset" in words(figure)


def test_curves_end_at_the_time_that_is_asked_for(history) -> None:
    run = history("linear")
    drawn = curve(gyrify.plot(run, "gi", at=200.0).axes[0], "convex hull")
    assert drawn[-1, 0] == run.growth_times[np.argmin(np.abs(run.growth_times - 200.0))]


def test_energy_is_the_sum_of_the_increments(history) -> None:
    run = history("linear")
    large, small = gyrify.plot(run, "energy").axes
    steps = list(reevaluated(run))
    for axes, label, key, unit in (
        (large, "work of growth", "work", 1e-6),
        (large, "stored in the tissue", "stored", 1e-6),
        (large, "dissipated", "dissipated", 1e-6),
        (small, "stored in contact", "contact", 1e-3),
    ):
        values = [0.0, *np.cumsum([unit * getattr(step, key) for step in steps])]
        assert curve(axes, label)[:, 1] == pytest.approx(values)
    assert large.get_ylabel() == "energy [mJ/mm]"
    assert small.get_ylabel() == "energy [µJ/mm]"
    parts = sum(curve(large, name)[-1, 1] for name in ("stored in the tissue", "dissipated"))
    rest = 1e-3 * sum(curve(small, name)[-1, 1] for name in ("stored in contact", "lost in jumps"))
    assert curve(large, "work of growth")[-1, 1] == pytest.approx(parts + rest)


def test_dispersion_has_the_exact_first_mode_and_its_neighbours(history) -> None:
    annulus = annulus_of(history("linear").config)
    assert annulus.outer_radius == pytest.approx(np.sqrt(4069.0 / np.pi))
    found = dispersion(annulus, [8, 14, 20, 28])
    (exact,) = critical_growth_time(annulus, [200.0, 300.0])
    assert found.critical is not None
    assert found.critical[0] == exact.mode_number
    assert found.critical[1] == pytest.approx(exact.value, rel=1e-4)
    assert {exact.mode_number - 1, exact.mode_number + 1} <= set(found.modes.tolist())
    for mode, time in zip(found.modes[:2], found.times[:2], strict=True):
        late, early = (lowest_eigenvalue(annulus, step * time, int(mode)) for step in (1.002, 0.998))
        assert late < 0.0 < early


def test_dispersion_marks_the_onset_of_the_run(history, words) -> None:
    run = history("linear")
    figure = gyrify.plot(run, "dispersion")
    (axes,) = figure.axes
    (square,) = [line for line in axes.lines if line.get_marker() == "s"]
    assert square.get_xydata().tolist() == [[run.onset.mode_number, run.onset.growth_time]]
    assert axes.get_xlabel() == "mode number n [–]"
    assert axes.get_ylabel() == "growth time at onset [model units]"
    assert any(text.startswith(f"this run: n = {run.onset.mode_number}") for text in words(figure))


def test_dispersion_says_where_nothing_is_critical(history, words) -> None:
    assert "no mode becomes unstable before growth ends" in words(
        gyrify.plot(history("smooth"), "dispersion")
    )


def test_a_strip_has_no_dispersion(history) -> None:
    with pytest.raises(ConfigError, match="A strip has no circumferential modes"):
        gyrify.plot(history("strip"), "dispersion")


@pytest.mark.parametrize("what", ["gi", "energy"])
@pytest.mark.parametrize("others", [[], ["softer", "quadratic"]])
def test_letters_of_panels_keep_clear_of_the_labels_of_axes(runs, what: str, others: list[str]) -> None:
    figure = gyrify.plot(runs["linear"], what, compare=[runs[name] for name in others])
    figure.canvas.draw()
    labels = [axes.yaxis.label.get_window_extent() for axes in figure.axes]
    letters = [text.get_window_extent() for text in figure.texts if text.get_text() in "abcd"]
    assert len(letters) == len(labels) > 1
    assert not [(a, b) for a in letters for b in labels if a.overlaps(b)]


def test_indices_stand_beside_what_is_known_of_their_meshes(runs, words) -> None:
    assert "mesh not converged" in words(gyrify.plot(runs["linear"], "gi"))
    assert "mesh not checked" in words(gyrify.plot(runs["softer"], "gi"))
    compared = gyrify.plot(runs["linear"], "gi", compare=[runs["softer"]])
    assert "meshes: 1 not converged, 1 not checked" in words(compared)
    assert any(
        "mesh not checked" in said and "stopped" in said for said in words(gyrify.plot(runs["stopped"], "gi"))
    )
