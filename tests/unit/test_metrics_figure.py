"""The folded picture: what is drawn, and that it is drawn the same way each time."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest

from gyrify.mesh import GREY, WHITE
from gyrify.report import folded_figure, save_figure
from gyrify.report.figures import boundary_loops
from gyrify.report.layout import _round_length

N = 96
RADII = (20.0, 30.0, 40.0, 44.0)


def slice_arrays() -> dict[str, np.ndarray]:
    """A folded ring of three layers, the outermost one cortex."""
    angle = np.arange(N) * (2 * np.pi / N)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    folds = [np.zeros(N), np.zeros(N), 3.0 * np.cos(8 * angle), 3.5 * np.cos(8 * angle)]
    points = np.concatenate([(r + w)[:, None] * circle for r, w in zip(RADII, folds, strict=True)])
    i = np.arange(N)
    j = (i + 1) % N
    cells, region = [], []
    for layer in range(3):
        low, high = layer * N, (layer + 1) * N
        cells += [
            np.column_stack([low + i, high + i, high + j]),
            np.column_stack([low + i, high + j, low + j]),
        ]
        region += [np.full(2 * N, GREY if layer == 2 else WHITE)]
    return {
        "points": points,
        "cells": np.concatenate(cells),
        "region": np.concatenate(region),
        "contour": 3 * N + i,
        "interface": 2 * N + i,
    }


def test_the_boundary_of_a_tissue_has_its_tissue_on_the_left() -> None:
    ring = slice_arrays()
    loops = boundary_loops(ring["cells"][ring["region"] == GREY])
    areas = []
    for loop in loops:
        assert len(loop) == N
        x, y = ring["points"][loop].T
        areas.append(0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)))
    assert sorted(np.sign(areas)) == [-1, 1]
    assert max(areas) > np.pi * 43.0**2
    assert sorted(set(np.concatenate(loops))) == sorted([*ring["interface"], *ring["contour"]])


def test_index_gyri_scale_and_legend_are_written_large_enough() -> None:
    figure = folded_figure(**slice_arrays(), gi=1.0449, n_gyri=8, title="A slice")
    texts = [*figure.texts, *figure.legends[0].get_texts()]
    written = [text.get_text() for text in texts]
    assert "GI 1.04 (closing, 10 mm)   8 gyri" in written
    assert {"A slice", "10 mm", "grey matter", "white matter", "exposed outline"} <= set(written)
    assert min(text.get_fontsize() for text in texts) >= 7


@pytest.mark.parametrize("title", ["", "A slice", "A slice of which a great deal has to be said, " * 3])
def test_nothing_is_cut_off_or_overlaps(title: str) -> None:
    figure = folded_figure(**slice_arrays(), gi=1.0449, n_gyri=8, title=title)
    figure.canvas.draw()
    boxes = [text.get_window_extent() for text in figure.texts] + [figure.legends[0].get_window_extent()]
    boxes.append(figure.axes[0].get_window_extent())
    for number, box in enumerate(boxes):
        assert box.x0 >= 0
        assert box.y0 >= 0
        assert box.x1 <= figure.bbox.x1
        assert box.y1 <= figure.bbox.y1
        assert not any(box.overlaps(other) for other in boxes[number + 1 :])


def test_the_scale_bar_is_as_long_as_it_says() -> None:
    figure = folded_figure(**slice_arrays())
    figure.canvas.draw()
    (bar,) = [artist for artist in figure.get_children() if isinstance(artist, mpl.lines.Line2D)]
    pixels = np.ptp(np.asarray(bar.get_xdata())) * figure.bbox.width
    x = figure.axes[0].transData.transform([(0.0, 0.0), (10.0, 0.0)])[:, 0]
    assert pixels == pytest.approx(x[1] - x[0], rel=1e-9)


@pytest.mark.parametrize(("wanted", "length"), [(22.0, 20.0), (10.0, 10.0), (4.9, 2.0), (0.07, 0.05)])
def test_lengths_of_the_bar_are_round(wanted: float, length: float) -> None:
    assert _round_length(wanted) == pytest.approx(length)


@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_the_same_picture_has_the_same_bytes(tmp_path: Path, suffix: str) -> None:
    first, second = tmp_path / f"a.{suffix}", tmp_path / f"b.{suffix}"
    save_figure(folded_figure(**slice_arrays(), gi=1.2), first)
    save_figure(folded_figure(**slice_arrays(), gi=1.2), second)
    assert first.read_bytes() == second.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == [first.name, second.name]


def test_matplotlib_is_left_as_it_was(tmp_path: Path) -> None:
    before = dict(mpl.rcParams)
    save_figure(folded_figure(**slice_arrays()), tmp_path / "folded.png")
    assert dict(mpl.rcParams) == before
