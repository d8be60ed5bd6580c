"""What the contact energy asks of a library that finds pairs and follows paths; and which ones there are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final, Literal, Protocol

from gyrify.energy.images import Polyline
from gyrify.energy.term import FloatArray, IntArray

LibraryName = Literal["auto", "ipctk", "gyrify"]
# The kernels of `gyrify.energy.planar` need no other package.
OWN: Final = "gyrify"


@dataclass(frozen=True, eq=False)
class PairSum:
    """Barrier summed over the close pairs of a contour, in the degrees of freedom of its vertices.

    Attributes
    ----------
    value : float
        Energy [Pa mm^2].
    gradient : (n_vertices, 2) float array or None
        Its derivative [Pa mm].
    entries : tuple of arrays or None
        Rows, columns (vertex-major, two each; row <= column) and values [Pa] of the Hessian.
    """

    value: float
    gradient: FloatArray | None = None
    entries: tuple[IntArray, IntArray, FloatArray] | None = None


class Barrier(Protocol):
    """The barrier with its activation distance and stiffness."""

    def evaluate(self, pairs: Any, vertices: FloatArray, order: int, project_psd: bool) -> PairSum | None:
        """Sum over those of the pairs that are close; None where there is none."""
        ...


class CollisionContour(Protocol):
    """A contour as one library sees it; deformed vertices are (n_vertices, 2) float arrays [mm]."""

    def pairs(self, vertices: FloatArray, inflation: float) -> Any:
        """Vertices and edges whose boxes meet, each grown by a distance [mm] on all sides."""
        ...

    def pair_array(self, pairs: Any) -> IntArray:
        """(n_pairs, 2) vertex and edge of each pair."""
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


def contact_library(name: LibraryName = "auto") -> LibraryName:
    """Name of the library that is used: ipctk where it is installed, else gyrify's own kernels.

    Raises
    ------
    ImportError
        If a library is asked for that is not installed.
    """
    if name == OWN:
        return OWN
    try:
        from gyrify.energy.toolkit import ToolkitContour  # noqa: F401
    except ImportError:
        if name != "auto":
            raise
        return OWN
    return "ipctk"


def collision_contour(
    reference: FloatArray, line: Polyline, n_own: int | None, name: LibraryName = "auto"
) -> CollisionContour:
    """Contour of a library.

    Parameters
    ----------
    reference : (n_vertices, 2) float array
        Undeformed vertices [mm].
    line : Polyline
        Vertices and edges.
    n_own : int or None
        Number of vertices of a periodic contour, which come first, its images after them; None where it is
        not periodic.
    name : str
        Library.
    """
    if contact_library(name) == OWN:
        from gyrify.energy.planar import PlanarContour

        return PlanarContour(reference, line.edges, n_own)
    from gyrify.energy.toolkit import ToolkitContour

    return ToolkitContour(reference, line.edges, n_own)
