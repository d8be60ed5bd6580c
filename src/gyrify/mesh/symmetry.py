"""Mirror symmetry of a mesh: which point is the image of which, and fields that are their own image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Mirror:
    """A line across which a mesh is its own mirror image.

    Attributes
    ----------
    axis : int
        Component of a vector that changes its sign.
    image : (n_points,) int array
        Image of each point; its own where it lies on the line.
    """

    axis: int
    image: IntArray

    def __post_init__(self) -> None:
        self.image.flags.writeable = False

    def of(self, vectors: FloatArray) -> FloatArray:
        """Mirror image (n, n_dim) of vectors at the points; rows after those of the points stay.

        Parameters
        ----------
        vectors : (n, n_dim) float array
            Displacements [mm], say.
        """
        mirrored = vectors.copy()
        mirrored[: self.image.size] = vectors[self.image]
        mirrored[: self.image.size, self.axis] *= -1.0
        return mirrored


def representatives(mirrors: Sequence[Mirror], n_points: int, n_dim: int) -> tuple[IntArray, FloatArray]:
    """From which component of which point each component of a symmetric vector field follows.

    Parameters
    ----------
    mirrors : sequence of Mirror
        Lines that are perpendicular to one another.
    n_points, n_dim : int
        Shape of the field.

    Returns
    -------
    source : (n_points * n_dim,) int array
        Component that is the first of its images.
    sign : (n_points * n_dim,) float array
        Its sign, 1 or -1; 0 where a component must vanish on a line.
    """
    own = np.arange(n_points * n_dim)
    source, sign = own, np.ones(own.size)
    vanishes = np.zeros(own.size, dtype=bool)
    for chosen in product((False, True), repeat=len(mirrors)):
        point, flip = np.arange(n_points), np.ones(n_dim)
        for mirror in (mirror for mirror, is_used in zip(mirrors, chosen, strict=True) if is_used):
            point = mirror.image[point]
            flip[mirror.axis] *= -1.0
        image = (point[:, None] * n_dim + np.arange(n_dim)).ravel()
        flips = np.tile(flip, n_points)
        vanishes |= (image == own) & (flips < 0.0)
        first = image < source
        source, sign = np.where(first, image, source), np.where(first, flips, sign)
    return source, np.where(vanishes, 0.0, sign)


def symmetric_field(mirrors: Sequence[Mirror], vectors: FloatArray) -> FloatArray:
    """The field (n_points, n_dim) that has the given values at the first of each point and its images.

    It is its own mirror image to the last bit, for only signs are changed.
    """
    source, sign = representatives(mirrors, *vectors.shape)
    # adding zero turns -0.0 into 0.0
    return np.asarray((sign * vectors.ravel()[source] + 0.0).reshape(vectors.shape))


def row_image(row: IntArray, half_turn: bool) -> IntArray:
    """Image of each point of a closed row of evenly spaced points, whose first point lies on a line.

    Parameters
    ----------
    row : (n,) int array
        Points in order.
    half_turn : bool
        Whether the line is the one that stands upright on that through the first point.
    """
    n = row.size
    return np.asarray(row[(n // 2 * half_turn - np.arange(n)) % n])


def with_middles(image: IntArray, edges: IntArray) -> IntArray:
    """Image of points and of the middles of edges, which come after them in the order of the edges.

    Parameters
    ----------
    image : (n_points,) int array
        Image of each point.
    edges : (n_edges, 2) int array
        Points of each edge, the smaller first, sorted.
    """
    ends = np.sort(image[edges], axis=1)
    number = np.searchsorted(edges[:, 0] * image.size + edges[:, 1], ends[:, 0] * image.size + ends[:, 1])
    return np.concatenate([image, image.size + number])
