"""Strip: a grey film on a deep white substrate, periodic along x, clamped below and free above."""

from __future__ import annotations

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.layered_grid import Layers, build_sheet
from gyrify.mesh.mesh import FloatArray, IntArray, Mesh
from gyrify.mesh.quality import require_quality
from gyrify.mesh.symmetry import Mirror

# The sheet's layers run counter-clockwise, with the outside on the right; in the strip it is on the left.
_MIRRORED = {3: [0, 2, 1], 6: [0, 2, 1, 5, 4, 3]}


def periodic_strip(length: float, depth: float, cortical_thickness: float, layers: Layers) -> Mesh:
    """Mesh the rectangle 0 <= x < length, 0 <= y <= depth, with the interface at y = depth - T.

    The last column of cells joins the first column of points again, one period further. The contour
    y = depth and the interface run towards +x; the outward direction is +y.

    Parameters
    ----------
    length : float
        Period in x [mm].
    depth : float
        Height of the contour above the clamped line [mm], cortex included.
    cortical_thickness : float
        Thickness T of the grey layer [mm].
    layers : Layers
        How the strip is divided; an odd ``n_around`` breaks the alternating split at the seam. Jitter slides
        points of the contour, the interface and the clamped line along x only.

    Returns
    -------
    Mesh
        Open (``is_closed`` is false), with ``period`` equal to the length.

    Raises
    ------
    MeshError
        If no white matter is left, or a cell would be a sliver.
    """
    T = cortical_thickness
    if not 0.0 < T < depth:
        raise MeshError(
            f"geometry.cortical_thickness = {T:g} mm leaves no white matter in {depth:.4g} mm.",
            f"Choose a thickness between 0 and {0.95 * depth:.4g} mm, or a larger geometry.depth.",
        )
    white = depth - T
    sheet = build_sheet(layers, T / white, (white, T), length)
    height = np.minimum(sheet.depth, 1.0) * white + np.maximum(sheet.depth - 1.0, 0.0) * T
    points = np.stack([length * sheet.along, height], axis=1)
    mirrors = tuple(Mirror(0, image) for image in sheet.images)
    mesh = Mesh(
        points=_symmetric(points, length, mirrors[0].image) if mirrors else points,
        cells=np.ascontiguousarray(sheet.cells[:, _MIRRORED[sheet.cells.shape[1]]]),
        region=sheet.region,
        contour=sheet.rows[-1],
        interface=sheet.rows[sheet.interface_row],
        clamped=sheet.rows[0],
        across=np.tile([0.0, 1.0], (sheet.cells.shape[0], 1)),
        patch=sheet.patch,
        is_closed=False,
        period=length,
        mirrors=mirrors,
        along=sheet.along,
        depth=sheet.depth,
    )
    # One point of each row: jitter puts the others a little above or below it.
    levels = np.sort(height[[row[0] for row in sheet.rows]])
    require_quality(mesh, length / sheet.rows[-1].size, np.diff(levels))
    return mesh


def _symmetric(points: FloatArray, length: float, image: IntArray) -> FloatArray:
    """Points of which each is at x = length less that of its image, exactly, and as high."""
    own, unit = np.arange(image.size), np.spacing(length)
    # on this grid the difference to the length has no rounding
    x, y = np.round(points[:, 0] / unit) * unit, points[:, 1]
    x = np.where(own < image, x, length - x[image])
    middle = np.where(points[:, 0] < 0.25 * length, 0.0, 0.5 * length)
    return np.stack([np.where(own == image, middle, x), np.where(own < image, y, y[image])], axis=1)
