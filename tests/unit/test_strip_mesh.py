"""The mesh of a strip: what it fills, how it closes across the seam, and what it refuses."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from bodies import periodic_strip

from gyrify.config import Config
from gyrify.energy.kinematics import Simplices
from gyrify.errors import ConfigError, MeshError
from gyrify.mesh import GREY, Mesh
from gyrify.mesh.layered_grid import Layers
from gyrify.model.slice import Slice, build_mesh

# 30 mm long, 12 mm deep, a film of 1.5 mm
STRIP = (30.0, 12.0, 1.5)


def strip(length: float = 30.0, **options: Any) -> Mesh:
    return periodic_strip(length, *STRIP[1:], Layers(40, 9, 3, **options))


@pytest.mark.parametrize("split", ["alternating", "one", "random"])
@pytest.mark.parametrize("node_jitter", [0.0, 0.1])
def test_cells_fill_film_and_substrate(split: str, node_jitter: float) -> None:
    mesh = strip(split=split, node_jitter=node_jitter)
    volumes = Simplices.of(mesh.cell_points, mesh.cells, mesh.n_points).volumes
    assert volumes.min() > 0
    assert volumes.sum() == pytest.approx(30 * 12, rel=1e-13)
    assert volumes[mesh.region == GREY].sum() == pytest.approx(30 * 1.5, rel=1e-13)
    assert mesh.n_cells == 2 * 40 * 9
    assert mesh.n_points == 40 * 10


def test_named_lines_run_along_x() -> None:
    mesh = strip(node_jitter=0.1)
    for line, height in ((mesh.contour, 12.0), (mesh.interface, 10.5), (mesh.clamped, 0.0)):
        assert np.all(mesh.points[line, 1] == height)
        assert line.size == 40
        assert np.all(np.diff(mesh.points[line, 0]) > 0)
        # slid, by no more than a tenth of the column width
        slide = np.abs(mesh.points[line, 0] - 30 * np.arange(40) / 40)
        assert 0 < slide.max() <= 0.1 * 0.75
    assert not mesh.is_closed
    assert mesh.period == 30.0
    assert np.all(mesh.across == [0, 1])


def test_first_white_layer_is_as_thick_as_a_cortical_one() -> None:
    mesh = strip()
    levels = np.unique(mesh.points[:, 1])
    steps = np.diff(levels)
    assert np.allclose(steps[-3:], 0.5)
    # the ratio of neighbouring layers is the same everywhere
    ratios = steps[:-4] / steps[1:-3]
    assert np.allclose(ratios, ratios[0])
    assert steps[-4] == pytest.approx(0.5)


def test_no_edge_is_a_boundary_but_those_of_contour_and_clamped_line() -> None:
    mesh = strip()
    edges = np.sort(
        np.concatenate([mesh.cells[:, [0, 1]], mesh.cells[:, [1, 2]], mesh.cells[:, [2, 0]]]), axis=1
    )
    different, count = np.unique(edges, axis=0, return_counts=True)
    free = different[count == 1]
    assert np.all(count <= 2)
    assert set(free.ravel()) == set(mesh.contour) | set(mesh.clamped)
    assert len(free) == 2 * 40


def test_cells_across_the_seam_are_unwrapped() -> None:
    mesh = strip()
    assert np.ptp(mesh.points[mesh.cells][:, :, 0], axis=1).max() > 29
    assert np.ptp(mesh.cell_points[:, :, 0], axis=1).max() == pytest.approx(0.75)


def test_uniform_stretch_has_the_same_gradient_across_the_seam() -> None:
    """A displacement linear in y alone is periodic: F = I + du/dX must be the same in all cells."""
    mesh = strip(node_jitter=0.05, split="random")
    simplices = Simplices.of(mesh.cell_points, mesh.cells, mesh.n_points)
    u = np.stack([0.3 * mesh.points[:, 1], 0.2 * mesh.points[:, 1]], axis=1)
    gradient = np.einsum("cai,caj->cij", u[mesh.cells], simplices.gradients)
    assert np.allclose(gradient, [[0, 0.3], [0, 0.2]], atol=1e-13)


def test_configured_strip() -> None:
    config = Config(geometry={"shape": "strip", "length": 24.0, "depth": 10.0}, mesh={"n_around": 48})
    mesh = build_mesh(config)
    assert mesh.period == 24.0
    assert mesh.points[:, 1].max() == 10.0
    problem = Slice(config)
    assert problem.lumped_area.sum() == pytest.approx(240.0)
    assert problem.surface.is_periodic


def test_drag_number_refers_to_the_depth() -> None:
    """Drag number c R^2 / (E_G duration) with R = 9 mm: halving R makes the drag four times as strong."""
    deep = Config(geometry={"shape": "strip", "depth": 18.0})
    shallow = deep.replace(**{"geometry.depth": 9.0})
    assert deep.geometry.drag_length == 18.0
    assert shallow.geometry.drag_length == 9.0
    assert Config().geometry.drag_length == pytest.approx(35.99, abs=0.01)


def test_thick_film_is_refused() -> None:
    with pytest.raises(MeshError, match="leaves no white matter in 12 mm"):
        periodic_strip(30.0, 12.0, 12.0, Layers(40, 9, 3))
    with pytest.raises(ConfigError, match=r"larger geometry\.depth"):
        Config(geometry={"shape": "strip", "depth": 1.5})


@pytest.mark.parametrize(
    ("length", "advice"),
    [(3000.0, r"too wide for layers of 0\.5 mm\. Raise mesh\.n_around"), (0.3, "too narrow for layers")],
)
def test_slivers_are_refused_with_the_direction_of_the_remedy(length: float, advice: str) -> None:
    with pytest.raises(MeshError) as refusal:
        strip(length)
    assert refusal.match("cells of quality")
    assert re.search(advice, str(refusal.value))
