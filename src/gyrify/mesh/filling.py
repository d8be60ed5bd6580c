"""Tetrahedra inside closed surfaces, by Netgen: the surfaces are kept as they are, and cells grow inwards."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.base.extras import require
from gyrify.errors import MeshError
from gyrify.mesh.mesh import FloatArray, IntArray

# Rounds of optimisation, and how quickly cells grow with the distance from the surfaces (0 not, 1 at once).
_ROUNDS: Final = 5
GRADING: Final = 0.4
# Part of the volume that rounding may leave between the cells and the surfaces.
_EMPTY: Final = 1e-6


def filled(points: FloatArray, triangles: IntArray, largest: float) -> tuple[FloatArray, IntArray]:
    """Fill what lies between surfaces.

    Parameters
    ----------
    points : (n_points, 3) float array
        Corners of the surfaces [mm].
    triangles : (n, 3) int array
        Counter-clockwise seen from outside of what is filled: those of a hole are turned round.
    largest : float
        Longest edge of a cell, about [mm].

    Returns
    -------
    more : (n, 3) float array
        Points inside, which come after those of the surfaces [mm].
    cells : (n_cells, 4) int array
        Positive corners.

    Raises
    ------
    MeshError
        If Netgen does not fill it.
    ConfigError
        If Netgen is not installed.
    """
    netgen = require("netgen.meshing", "surface", "A body from a surface", "netgen-mesher")
    mesh = netgen.Mesh(dim=3)
    mesh.AddPoints(np.ascontiguousarray(points))
    face = mesh.Add(netgen.FaceDescriptor(bc=1, domin=1, domout=0, surfnr=1))
    mesh.AddElements(dim=2, index=face, data=np.ascontiguousarray(triangles, dtype=np.int32), base=0)
    mesh.SetMaterial(1, "white")
    try:
        mesh.GenerateVolumeMesh(netgen.MeshingParameters(maxh=largest, grading=GRADING, optsteps3d=_ROUNDS))
    except Exception as fault:  # Netgen has exceptions of its own
        raise MeshError(
            f"Netgen did not fill the white matter with cells ({' '.join(str(fault).split())[:120]}).",
            "Smooth the surface, lower geometry.cortical_thickness, or give geometry.interface_file.",
        ) from fault
    every = np.array(mesh.Coordinates(), dtype=np.float64)
    n = points.shape[0]
    if every.shape[0] < n or not np.array_equal(every[:n], points):
        raise MeshError("Netgen moved points of the interface.", "Smooth the surface.")
    cells = np.array(mesh.Elements3D().NumPy()["nodes"][:, :4], dtype=np.int64) - 1
    cells = np.ascontiguousarray(cells[:, [0, 1, 3, 2]])
    _require_full(every, cells, points[triangles])
    return every[n:], cells


def _require_full(points: FloatArray, cells: IntArray, corners: FloatArray) -> None:
    """Netgen may give up without a word, and leave a part empty."""
    inside = float(np.linalg.det(corners).sum()) / 6.0
    edges = points[cells[:, 1:]] - points[cells[:, :1]] if cells.size else np.empty((0, 3, 3))
    found = float(np.linalg.det(edges).sum()) / 6.0
    if not abs(found - inside) <= _EMPTY * abs(inside):
        raise MeshError(
            f"Netgen filled {found:.4g} of the {inside:.4g} mm³ of white matter, and gave up.",
            "Smooth the surface, lower geometry.cortical_thickness, or give geometry.interface_file.",
        )
