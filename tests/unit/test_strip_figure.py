"""The picture of a strip: one period from frame to frame, the cells of the seam in their place."""

from __future__ import annotations

import numpy as np
import pytest
from bodies import periodic_strip

from gyrify.mesh.layered_grid import Layers
from gyrify.metrics.periodic import strip_closing_outline
from gyrify.report import folded_figure
from gyrify.report.drawn_slice import periodic_slice

PERIOD = 30.0


def waved() -> tuple[np.ndarray, object]:
    """Mesh of a strip and its points, raised by waves of 2 mm at the surface, across the seam."""
    mesh = periodic_strip(PERIOD, 12.0, 1.5, Layers(n_around=60, n_layers=9, n_cortex_layers=3))
    x, y = mesh.points.T
    phase = 2 * np.pi * 3 * x / PERIOD + 0.9
    return np.stack([x + 0.8 * np.cos(phase) * y / 12, y + 2 * np.sin(phase) * y / 12], axis=1), mesh


def test_cells_lie_in_one_piece_and_cover_the_frame() -> None:
    points, mesh = waved()
    drawing = periodic_slice(points, mesh.cells, mesh.region, mesh.contour, mesh.interface, 10.0, PERIOD)
    corners = drawing.points[drawing.cells]
    assert np.ptp(corners[:, :, 0], axis=1).max() < 2.0
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert area.min() > 0
    # three periods of the same area
    thirds = area.reshape(3, -1).sum(axis=1)
    assert thirds == pytest.approx(thirds[0], rel=1e-12)
    assert corners[:, :, 0].min() < drawing.low[0]
    assert corners[:, :, 0].max() > drawing.high[0]
    assert drawing.high[0] - drawing.low[0] == pytest.approx(PERIOD)


def test_exposed_outline_spans_the_frame_above_the_contour() -> None:
    points, mesh = waved()
    (outline,) = strip_closing_outline(points[mesh.contour], PERIOD, 10.0)
    assert np.ptp(outline[:, 0]) == pytest.approx(1.2 * PERIOD, rel=1e-6)
    # arcs of 10 mm in chords of 0.5 mm are low by 3 um
    assert outline[:, 1].max() == pytest.approx(points[mesh.contour, 1].max(), abs=5e-3)
    # bridged: nowhere as deep as the troughs
    assert outline[:, 1].min() > points[mesh.contour, 1].min() + 1.0


def test_figure_of_a_strip_is_drawn_to_scale() -> None:
    points, mesh = waved()
    figure = folded_figure(
        points, mesh.cells, mesh.region, mesh.contour, mesh.interface, gi=1.2, n_gyri=3, period=PERIOD
    )
    axes = figure.axes[0]
    assert np.ptp(axes.get_xlim()) == pytest.approx(1.02 * PERIOD)
    assert axes.get_aspect() == 1.0
    floor = [line for line in axes.lines if np.all(line.get_ydata() == 0)]
    assert len(floor) == 1
    assert np.ptp(floor[0].get_xdata()) > np.ptp(axes.get_xlim())
