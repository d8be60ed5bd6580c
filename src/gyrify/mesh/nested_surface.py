"""Triangulated surfaces in levels: each halves the edges of the one before, and keeps its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from gyrify.mesh.mesh import FloatArray, IntArray

# Edges of the icosahedron are first divided by one of these, then halved: few, for a coarse middle.
BASES: Final = (2, 3, 5)
_ROUNDING: Final = 1e9


@dataclass(frozen=True, eq=False)
class NestedSurface:
    """Triangles of every level, coarsest first.

    Attributes
    ----------
    places : (n_points, k) float array
        Parameters of the points of the finest level: unit directions of a sphere (k = 3), or positions along
        both periods of a sheet, 0 to 1 and round again (k = 2).
    triangles : tuple of (n, 3) int arrays
        Triangles of each level, counter-clockwise seen from outside. The points of a level come first among
        those of the next.
    middles : tuple of (n, 3) int arrays
        Points of the next level in the middle of the edges 01, 12, 20 of each triangle; one level less.
    between : callable
        Parameters in the middle between two (n, k) arrays of them.
    """

    places: FloatArray
    triangles: tuple[IntArray, ...]
    middles: tuple[IntArray, ...]
    between: Callable[[FloatArray, FloatArray], FloatArray]

    @property
    def n_levels(self) -> int:
        """How many levels there are."""
        return len(self.triangles)

    def n_points(self, level: int) -> int:
        """Points of a level."""
        return int(self.triangles[level].max()) + 1


def icosphere(frequency: int) -> NestedSurface:
    """Nearly uniform triangles on the unit sphere.

    Parameters
    ----------
    frequency : int
        Parts of an edge of the icosahedron: one of `BASES`, halved any number of times. There are 20 times
        its square triangles.

    Returns
    -------
    NestedSurface
    """
    base, n_halvings = _base_of(frequency)
    return _halved(*_divided_icosahedron(base), n_halvings, _on_the_sphere)


def nearest_frequency(edge: float) -> int:
    """Frequency of the icosphere whose mean edge on the unit sphere is nearest to a length, as a ratio."""
    wanted = np.sqrt(16.0 * np.pi / (20.0 * np.sqrt(3.0))) / edge
    tried = sorted({base * 2**n for base in BASES for n in range(12)})
    return int(min(tried, key=lambda frequency: abs(np.log(frequency / wanted))))


def periodic_sheet(n_x: int, n_y: int, n_halvings: int) -> NestedSurface:
    """Triangles of a sheet that is periodic in both directions.

    Parameters
    ----------
    n_x, n_y : int
        Squares along each period on the coarsest level, even; each is cut in two, diagonals alternate.
    n_halvings : int
        Levels above the coarsest.

    Returns
    -------
    NestedSurface
    """
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n_x), np.arange(n_y), indexing="ij"))
    corner = [((i + a) % n_x) * n_y + (j + b) % n_y for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    rising = ((i + j) % 2 == 0)[:, None]
    first = np.where(
        rising, np.stack([corner[k] for k in (0, 1, 2)], 1), np.stack([corner[k] for k in (0, 1, 3)], 1)
    )
    second = np.where(
        rising, np.stack([corner[k] for k in (0, 2, 3)], 1), np.stack([corner[k] for k in (1, 2, 3)], 1)
    )
    places = np.stack([i / n_x, j / n_y], axis=1)
    triangles = np.stack([first, second], axis=1).reshape(-1, 3)
    return _halved(places, triangles, n_halvings, _on_the_sheet)


def _base_of(frequency: int) -> tuple[int, int]:
    base, n_halvings = frequency, 0
    while base % 2 == 0 and base // 2 in (*BASES, *(b * 2**n for b in BASES for n in range(1, 24))):
        base, n_halvings = base // 2, n_halvings + 1
    if base not in BASES:
        raise ValueError(f"no icosphere has the frequency {frequency}")
    return base, n_halvings


def _halved(
    places: FloatArray,
    triangles: IntArray,
    n_halvings: int,
    middle: Callable[[FloatArray, FloatArray], FloatArray],
) -> NestedSurface:
    """Halve all edges of a surface again and again."""
    levels, middles = [triangles], []
    for _ in range(n_halvings):
        coarse = levels[-1]
        ends = np.sort(np.stack([coarse, np.roll(coarse, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        edges, edge_of = np.unique(ends, axis=0, return_inverse=True)
        own = places.shape[0] + edge_of.reshape(-1, 3)
        places = np.concatenate([places, middle(places[edges[:, 0]], places[edges[:, 1]])])
        (a, b, c), (ab, bc, ca) = coarse.T, own.T
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        levels.append(np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3))
        middles.append(own)
    return NestedSurface(places, tuple(levels), tuple(middles), middle)


def _on_the_sphere(a: FloatArray, b: FloatArray) -> FloatArray:
    return _unit(a + b)


def _on_the_sheet(a: FloatArray, b: FloatArray) -> FloatArray:
    step = b - a
    return np.asarray((a + 0.5 * (step - np.round(step))) % 1.0)


def _unit(vectors: FloatArray) -> FloatArray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def _divided_icosahedron(n: int) -> tuple[FloatArray, IntArray]:
    """Points and triangles of an icosahedron whose edges are divided into n parts of equal angle."""
    corners, faces = _icosahedron()
    steps = [(i, j) for i in range(n + 1) for j in range(n + 1 - i)]
    number = {step: k for k, step in enumerate(steps)}
    weights = np.array([(n - i - j, i, j) for i, j in steps], dtype=np.float64)
    # Sines make the parts of an edge equal in angle.
    angle = np.arccos(1.0 / np.sqrt(5.0))
    points = _unit(np.einsum("sk,fkd->fsd", np.sin(weights * angle / n), corners[faces]).reshape(-1, 3))
    upwards = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i in range(n) for j in range(n - i)]
    downwards = [
        (number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i in range(n) for j in range(n - i - 1)
    ]
    local = np.array(upwards + downwards)
    triangles = (local[None] + len(steps) * np.arange(len(faces))[:, None, None]).reshape(-1, 3)
    _, first, number_of = np.unique(
        np.round(points * _ROUNDING).astype(np.int64), axis=0, return_index=True, return_inverse=True
    )
    return points[first], number_of.ravel()[triangles]


def _icosahedron() -> tuple[FloatArray, IntArray]:
    """Corners on the unit sphere, one at each pole, and faces counter-clockwise seen from outside."""
    height, ring = 1.0 / np.sqrt(5.0), 2.0 / np.sqrt(5.0)
    angle = 2.0 * np.pi * np.arange(5) / 5.0
    upper = np.stack([ring * np.cos(angle), ring * np.sin(angle), np.full(5, height)], axis=1)
    turned = angle + np.pi / 5.0
    lower = np.stack([ring * np.cos(turned), ring * np.sin(turned), np.full(5, -height)], axis=1)
    corners = np.concatenate([[[0.0, 0.0, 1.0]], upper, lower, [[0.0, 0.0, -1.0]]])
    k, after = np.arange(5), (np.arange(5) + 1) % 5
    zero = np.zeros(5, dtype=np.int64)
    faces = [
        np.stack([zero, 1 + k, 1 + after], axis=1),
        np.stack([1 + k, 6 + k, 1 + after], axis=1),
        np.stack([1 + after, 6 + k, 6 + after], axis=1),
        np.stack([zero + 11, 6 + after, 6 + k], axis=1),
    ]
    return corners, np.concatenate(faces)
