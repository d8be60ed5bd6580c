"""The mesh of a body in space as a page carries it."""

from __future__ import annotations

from typing import Any

import numpy as np

from gyrify.mesh import Mesh
from gyrify.mesh.boundary import boundary_faces, straight_cells
from gyrify.report.html.packing import Payload


def space_mesh(mesh: Mesh, payload: Payload) -> dict[str, Any]:
    """Add tetrahedra, their tissue, the boundary and the interface, as numbers of points.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    payload : Payload
        What the arrays are added to: ``cells`` by their corners (eight parts of each
        quadratic one), ``faces`` of the boundary, those of the
        outer surface first, with the cell of each in ``face_cells``.

    Returns
    -------
    dict
        What the page must know besides.
    """
    faces, owners = boundary_faces(mesh)
    cells = straight_cells(mesh)
    payload.add("cells", cells.astype(np.uint32), 1)
    payload.add("region", mesh.region.astype(np.uint16)[:, None], 1)
    payload.add("faces", faces.astype(np.uint32), 1)
    payload.add("face_cells", owners.astype(np.uint32)[:, None], 1)
    payload.add("contour", mesh.contour.astype(np.uint32)[:, None], 1)
    payload.add("interface_faces", mesh.interface_faces.astype(np.uint32), 1)
    return {
        "n_dim": 3,
        "n_points": mesh.n_points,
        "n_cells": mesh.n_cells,
        "n_outer": len(mesh.faces),
        "parts_per_cell": len(cells) // mesh.n_cells,
        "periods": None if mesh.period is None else [mesh.period, mesh.period_y],
    }
