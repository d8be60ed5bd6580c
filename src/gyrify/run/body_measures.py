"""Metrics of a state of a mesh, in the plane or in space."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gyrify.mesh import Mesh
from gyrify.mesh.boundary import boundary_faces
from gyrify.mesh.mesh import FloatArray
from gyrify.mesh.whole import whole_surface
from gyrify.metrics import Measures
from gyrify.metrics.measure import measure_valid

if TYPE_CHECKING:
    from gyrify.config.run_sections import Metrics
    from gyrify.metrics.measure_surface import DeformedSurface


def measured(mesh: Mesh, points: FloatArray, chosen: Metrics, *, earlier: bool = False) -> Measures:
    """Every metric of a state.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh.
    points : (n_points, n_dim) float array
        Deformed coordinates [mm].
    chosen : Metrics
        Section of the configuration.
    earlier : bool
        Whether by the rules of gyrify 0.1.0; see `gyrify.metrics.measure.measure_valid`.
    """
    if mesh.n_dim == 3:
        return Measures.of(surface_of(mesh, points, chosen))
    lengths = (chosen.closing_radius, chosen.gyrus_prominence, chosen.samples)
    return measure_valid(points[mesh.contour], points[mesh.interface], *lengths, mesh.period, earlier=earlier)


def hole_crosses_itself(mesh: Mesh, points: FloatArray) -> bool:
    """Whether the surface of a hole in space does; contact is that of the outer surface alone.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh.
    points : (n_points, 3) float array
        Deformed coordinates [mm].
    """
    from gyrify.metrics.surface_pairs import crosses_itself

    faces, _ = boundary_faces(mesh)
    return crosses_itself(points, faces[np.isin(faces, mesh.clamped).all(axis=1)])


def surface_of(mesh: Mesh, points: FloatArray, chosen: Metrics) -> DeformedSurface:
    """Outer surface and interface of a state in space, with their images behind a plane of symmetry.

    Parameters as of `measured`; points of the mesh come first.
    """
    from gyrify.metrics.measure_surface import DeformedSurface

    periods = None if mesh.period is None or mesh.period_y is None else (mesh.period, mesh.period_y)
    return DeformedSurface(
        *whole_surface(mesh, points, mesh.contour, mesh.faces),
        *whole_surface(mesh, points, mesh.interface, mesh.interface_faces),
        chosen.closing_radius,
        chosen.gyrus_prominence,
        periods,
        mesh.points[mesh.contour],
    )
