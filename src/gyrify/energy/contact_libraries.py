"""Which libraries find pairs and follow paths for the contact energy, and which of them is used."""

from __future__ import annotations

from typing import Final, Literal

from gyrify.energy.collision import CollisionContour
from gyrify.energy.periodic_line import Polyline
from gyrify.energy.term import FloatArray

LibraryName = Literal["auto", "ipctk", "gyrify"]
# The kernels of `gyrify.energy.planar` need no other package.
OWN: Final = "gyrify"


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
