"""A shape that an example adds: its mesh is exact, and a run of it is stored, read back and verified."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gyrify
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.mesh.shapes import SHAPES, shape_of
from gyrify.model.meshing import build_mesh
from gyrify.report.outputs import write_outputs
from gyrify.verify import verify


@pytest.fixture
def module(example):
    found = example("own_shape")
    SHAPES["superellipse"] = found.superellipse
    yield found
    del SHAPES["superellipse"]


def test_its_contour_and_normals_are_those_of_the_equation(module) -> None:
    config = Config().with_overrides({"geometry.shape": "superellipse", "mesh.node_jitter": 0.05})
    mesh, shape = build_mesh(config), shape_of(config.geometry)
    a, b = shape.semi_axes
    scaled = np.abs(mesh.points[mesh.contour] / [a, b]) ** module.EXPONENT
    assert scaled.sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    x, y = mesh.points[mesh.contour].T
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    assert shape.area == pytest.approx(area, rel=1e-3)
    # directions across the layers by differences of the places
    along, depth = mesh.along[mesh.contour], mesh.depth[mesh.contour]
    tangent = shape.points(along + 1e-6, depth) - shape.points(along - 1e-6, depth)
    normal = shape.normals(along, depth)
    turned = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    assert normal == pytest.approx(turned, abs=1e-5)


def test_a_run_of_it_is_read_back_and_verifies(module, tiny: Config, tmp_path: Path) -> None:  # noqa: ARG001
    config = tiny.with_overrides({"geometry.shape": "superellipse"})
    write_outputs(gyrify.simulate(config, tmp_path / "run"), tmp_path / "run")
    history = gyrify.History.load(tmp_path / "run")
    assert history.config.geometry.shape == "superellipse"
    assert verify(tmp_path / "run").passed


def test_a_shape_that_is_not_there_is_refused_with_those_that_are() -> None:
    with pytest.raises(
        ConfigError,
        match=r'geometry\.shape = "elipse" .* "ellipse", "circle", .*"surface" or "volume"',
    ) as told:
        Config().with_overrides({"geometry.shape": "elipse"})
    assert 'Did you mean "ellipse"?' in str(told.value)
