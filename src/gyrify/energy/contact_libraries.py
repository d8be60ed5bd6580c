"""Which libraries find pairs and follow paths for the contact energy, and which of them is used."""

from __future__ import annotations

from typing import Final, Literal

from gyrify.energy.collision import CollisionContour
from gyrify.energy.term import FloatArray, IntArray

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
    reference: FloatArray,
    edges: IntArray,
    n_own: int | None,
    name: LibraryName,
    faces: IntArray,
    source: IntArray,
) -> CollisionContour:
    """Contour of a library.

    Parameters
    ----------
    reference : (n_vertices, n_dim) float array
        Undeformed vertices [mm].
    edges : (n_edges, 2) int array
        Vertices of each edge.
    n_own : int or None
        Number of vertices of a periodic contour, which come first, its images after them; None where it is
        not periodic.
    name : str
        Library.
    faces : (n_faces, 3) int array
        Vertices of each triangle of a surface; none in the plane.
    source : (n_vertices,) int array
        Which vertices are images of one another: those of one number.

    Raises
    ------
    ImportError
        If contact in space is asked for where the IPC Toolkit is not installed.
    """
    if contact_library(name) == OWN:
        if faces.size:
            raise ImportError("contact in space needs the IPC Toolkit (ipctk)")
        from gyrify.energy.planar import PlanarContour

        return PlanarContour(reference, edges, n_own)
    if faces.size:
        from gyrify.energy.toolkit_surface import ToolkitSurface

        return ToolkitSurface(reference, edges, faces, n_own, source)
    from gyrify.energy.toolkit import ToolkitContour

    return ToolkitContour(reference, edges, n_own)
