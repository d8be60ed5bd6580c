"""Small bodies of tetrahedra, written to files by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from gyrify.config import Config

GIVEN: dict[str, Any] = {
    "geometry.shape": "volume",
    "geometry.cortical_thickness": 6.0,
    "mesh.node_jitter": 0.0,
    "stability.detect": False,
}
# Six tetrahedra of a cube whose corners are numbered by their coordinates, 4 x + 2 y + z.
_CUBE = np.array([[0, 4, 6, 7], [0, 6, 2, 7], [0, 2, 3, 7], [0, 3, 1, 7], [0, 1, 5, 7], [0, 5, 4, 7]])


def ball(n: int, radius: float = 20.0, axes: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Any:
    """Points and tetrahedra of an ellipsoid: a cube of (2 n)^3 cubes blown up, its own mirror image."""
    points, cells = half_ball(n, radius, axes)
    return mirrored(points, cells)


def half_ball(n: int, radius: float = 20.0, axes: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> Any:
    """The half with y <= 0."""
    counts = np.array([2 * n, n, 2 * n])
    grid = np.stack(np.meshgrid(*[np.arange(k + 1) for k in counts], indexing="ij"), axis=-1)
    number = np.arange(np.prod(counts + 1)).reshape(counts + 1)
    corners = np.stack(
        [
            number[i : counts[0] + i, j : counts[1] + j, k : counts[2] + k].ravel()
            for i in (0, 1)
            for j in (0, 1)
            for k in (0, 1)
        ],
        axis=1,
    )
    x = grid.reshape(-1, 3) / n - np.array([1.0, 1.0, 1.0])
    largest = np.abs(x).max(axis=1, keepdims=True)
    size = np.linalg.norm(x, axis=1, keepdims=True)
    points = radius * x * np.where(size > 0.0, largest / np.maximum(size, 1e-300), 0.0) * np.array(axes)
    return points, corners[:, _CUBE].reshape(-1, 4)


def mirrored(points: Any, cells: Any) -> Any:
    """A half and its image about y = 0, joined there."""
    n, inside = len(points), points[:, 1] < -1e-9
    number = np.arange(n)
    number[inside] = n + np.arange(inside.sum())
    image = points[inside] * np.array([1.0, -1.0, 1.0])
    turned = number[cells][:, [0, 1, 3, 2]]
    return np.concatenate([points, image]), np.concatenate([cells, turned])


def plain(path: Path, points: Any, cells: Any, labels: Any = None) -> Path:
    """The format of folding codes: points, tetrahedra with a label, no triangles."""
    marks = np.ones(len(cells), dtype=int) if labels is None else np.asarray(labels)
    lines = [str(len(points)), *(" ".join(repr(float(x)) for x in point) for point in points)]
    lines += [str(len(cells))]
    lines += [
        f"{mark} " + " ".join(str(i + 1) for i in cell) for mark, cell in zip(marks, cells, strict=True)
    ]
    path.write_text("\n".join(lines) + "\n")
    return path


def config(path: Path, **overrides: Any) -> Config:
    """A body of the tetrahedra of a file."""
    return Config().with_overrides({**GIVEN, "geometry.file": str(path), **overrides})
