"""What the contact energy asks of a library that finds pairs and follows paths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from gyrify.energy.term import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class PairSum:
    """Barrier summed over the close pairs of a contour, in the degrees of freedom of its vertices.

    Attributes
    ----------
    value : float
        Energy [Pa mm^2].
    gradient : (n_vertices, n_dim) float array or None
        Its derivative [Pa mm].
    entries : tuple of arrays or None
        Rows, columns (vertex-major, n_dim each; row <= column) and values [Pa] of the Hessian.
    """

    value: float
    gradient: FloatArray | None = None
    entries: tuple[IntArray, IntArray, FloatArray] | None = None


def vertex_and_ends(pairs: IntArray, edges: IntArray) -> IntArray:
    """(2 n, 2) vertex and end of the edge, of (n, 2) pairs of a vertex and an edge."""
    vertices = np.repeat(pairs[:, :1], 2, axis=1)
    return np.stack([vertices.ravel(), edges[pairs[:, 1]].ravel()], axis=1)


class Barrier(Protocol):
    """The barrier with its activation distance and stiffness."""

    def evaluate(self, pairs: Any, vertices: FloatArray, order: int, project_psd: bool) -> PairSum | None:
        """Sum over those of the pairs that are close; None where there is none."""
        ...


class CollisionContour(Protocol):
    """A contour as one library sees it; deformed vertices are (n_vertices, n_dim) float arrays [mm]."""

    def pairs(self, vertices: FloatArray, inflation: float) -> Any:
        """Vertices and edges whose boxes meet, each grown by a distance [mm] on all sides."""
        ...

    def coupled(self, pairs: Any) -> IntArray:
        """(n, 2) vertices of the collision mesh that pairs couple: those on either side of each."""
        ...

    def is_path_free(self, start: FloatArray, end: FloatArray) -> bool:
        """Whether nothing meets on the straight path between two states."""
        ...

    def free_step(self, start: FloatArray, end: FloatArray, pairs: Any | None = None) -> float:
        """Fraction of the path, at most 1, up to which nothing meets, among the pairs or at all."""
        ...

    def barrier(self, d_hat: float, stiffness: float) -> Barrier:
        """Barrier with an activation distance [mm] and a stiffness [Pa]."""
        ...
