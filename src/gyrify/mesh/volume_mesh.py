"""The mesh of given tetrahedra: their boundaries told apart, and their depth below the outer one."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from gyrify.base.places import place
from gyrify.errors import MeshError
from gyrify.mesh.cell_clusters import edge_clusters
from gyrify.mesh.mesh import GREY, WHITE, FloatArray, IntArray, Mesh
from gyrify.mesh.offset_surface import angle_normals
from gyrify.mesh.quality import LOWEST_QUALITY, tetrahedron_quality
from gyrify.mesh.shapes.volume_body import VolumeBody
from gyrify.mesh.surface_mesh import require_no_crossing
from gyrify.mesh.volume_sides import sides_of
from gyrify.metrics.surface_pairs import distances_to
from gyrify.metrics.tetrahedra import EDGES, faces_between, signed_volumes

# The eight parts of a tetrahedron with corners 0 to 3 and middles 4 to 9 of its edges: four at the corners,
# and four about one of the three diagonals of the octahedron between them.
_AT_CORNERS: Final = np.array([[0, 4, 5, 6], [4, 1, 7, 8], [5, 7, 2, 9], [6, 8, 9, 3]])
_DIAGONALS: Final = np.array([[4, 9], [5, 8], [6, 7]])
_AROUND: Final = np.array([[5, 7, 8, 6], [4, 6, 9, 7], [4, 5, 9, 8]])
# The least quality of a cell: below, it is all but flat.
_FLATTEST: Final = 1e-4
# A cortex whose mean thickness differs from T by more than this is told.
_OTHER: Final = 0.2


def volume_mesh(body: VolumeBody, refine: int = 0) -> Mesh:
    """Mesh of a body of given tetrahedra.

    Parameters
    ----------
    body : VolumeBody
        The body.
    refine : int
        Times that each tetrahedron is cut into eight.

    Returns
    -------
    Mesh
        Each cell with its depth below the outer surface; the same bytes each time.

    Raises
    ------
    MeshError
        If the outer surface crosses itself, no tissue is left of one kind, or a cell is all but flat.
    """
    points, cells, grey = body.points, body.cells, body.grey
    for _ in range(refine):
        points, cells = _eighths(points, cells)
        grey = None if grey is None else np.tile(grey, 8)
    sides = sides_of(points, cells, body.plane)
    points, faces, contour = sides.points, sides.outer, np.unique(sides.outer)
    require_no_crossing(points, faces, "The outside of the volume")
    T, below = body.cortical_thickness, distances_to(points, points[faces])
    below[contour] = 0.0
    is_grey = below[cells].mean(axis=1) < T if grey is None else grey
    interface_faces = _interface(cells, is_grey, T, points)
    return Mesh(
        points=points,
        cells=cells,
        region=np.where(is_grey, GREY, WHITE).astype(np.int8),
        contour=contour,
        interface=np.unique(interface_faces),
        clamped=sides.hole,
        across=_across(points, cells, contour, faces, sides.on_plane),
        patch=edge_clusters(points, cells),
        depth=_depth(points, cells, below, None if grey is None else interface_faces, is_grey, body),
        faces=faces,
        interface_faces=interface_faces,
        notes=(*sides.notes, *_notes(points, cells, below[np.unique(interface_faces)], body)),
        on_plane=sides.on_plane,
    )


def _depth(
    points: FloatArray,
    cells: IntArray,
    below: FloatArray,
    interface: IntArray | None,
    is_grey: NDArray[np.bool_],
    body: VolumeBody,
) -> FloatArray:
    """(n_points,) position across the layers; see `gyrify.mesh.mesh.Mesh`.

    By the distance below the outer surface in units of T, without end; or between it and the interface of
    labelled cells, where the cortex has a thickness of its own.
    """
    T = body.cortical_thickness
    if interface is None:
        return 2.0 - below / T
    inner = distances_to(points, points[interface])
    inner[np.unique(interface)] = 0.0
    in_grey = np.zeros(points.shape[0], dtype=bool)
    in_grey[cells[is_grey]] = True
    share = below / np.where(below + inner > 0.0, below + inner, 1.0)
    return np.where(in_grey & (inner > 0.0), 2.0 - share, 1.0 - inner / T)


def _eighths(points: FloatArray, cells: IntArray) -> tuple[FloatArray, IntArray]:
    """Each tetrahedron cut into eight; the octahedron within along its shortest diagonal (Bey 1995)."""
    sides = np.sort(cells[:, EDGES].reshape(-1, 2), axis=1)
    edges, number = np.unique(sides, axis=0, return_inverse=True)
    finer = np.concatenate([points, points[edges].mean(axis=1)])
    ten = np.concatenate([cells, points.shape[0] + number.reshape(-1, 6)], axis=1)
    ends = finer[ten[:, _DIAGONALS]]
    chosen = np.argmin(np.round(np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2), 12), axis=1)
    parts = [ten[:, corners] for corners in _AT_CORNERS]
    axis, around = (np.take_along_axis(ten, table[chosen], 1) for table in (_DIAGONALS, _AROUND))
    for k in range(4):
        parts.append(np.concatenate([axis, around[:, [k, (k + 1) % 4]]], axis=1))
    every = np.concatenate(parts)
    inverted = signed_volumes(finer[every]) < 0.0
    every[inverted, 2], every[inverted, 3] = every[inverted, 3].copy(), every[inverted, 2].copy()
    return finer, every


def _interface(cells: IntArray, is_grey: NDArray[np.bool_], T: float, points: FloatArray) -> IntArray:
    faces = faces_between(cells, ~is_grey)
    if faces.size:
        return faces
    edges = points[cells[:, EDGES]]
    mean = float(np.linalg.norm(edges[:, :, 1] - edges[:, :, 0], axis=2).mean())
    tissue = "white" if is_grey.all() else "grey"
    raise MeshError(
        f"No tetrahedron of the volume is {tissue} matter: none has its middle "
        f"{'below' if tissue == 'white' else 'within'} geometry.cortical_thickness = {T:g} mm; edges are "
        f"{mean:.3g} mm long.",
        "Give another geometry.cortical_thickness or geometry.unit, or set mesh.refine = 1.",
    )


def _across(
    points: FloatArray, cells: IntArray, contour: IntArray, faces: IntArray, on_plane: IntArray
) -> FloatArray:
    """(n_cells, 3) mean of the normals at the points of the outer surface that are nearest to the corners.

    In a plane of symmetry they lie in it, as they do with the other half.
    """
    normals = angle_normals(points[contour], np.searchsorted(contour, faces))
    _, nearest = cKDTree(points[contour]).query(points)
    at_points = normals[nearest]
    if on_plane.size:
        at_points[on_plane, int(np.argmin(np.ptp(points[on_plane], axis=0)))] = 0.0
        at_points /= np.maximum(np.linalg.norm(at_points, axis=1, keepdims=True), 1e-9)
    mean = at_points[cells].sum(axis=1)
    size = np.linalg.norm(mean, axis=1, keepdims=True)
    return np.asarray(np.where(size > 1e-9, mean / np.maximum(size, 1e-9), [0.0, 0.0, 1.0]))


def _notes(points: FloatArray, cells: IntArray, depths: FloatArray, body: VolumeBody) -> tuple[str, ...]:
    """What of given tetrahedra makes a run less than it could be."""
    notes, T = [], body.cortical_thickness
    quality = tetrahedron_quality(points[cells])
    worst, n_slivers = int(np.argmin(quality)), np.count_nonzero(quality < LOWEST_QUALITY)
    where = place(points[cells[worst]].mean(axis=0))
    if not quality[worst] >= _FLATTEST:
        raise MeshError(
            f"The volume has a tetrahedron that is all but flat, at {where}.",
            "Mesh the body anew in the program that it comes from.",
        )
    if n_slivers:
        notes.append(
            f"{n_slivers} tetrahedra of the volume are slivers (quality below {LOWEST_QUALITY:g}, down to "
            f"{quality[worst]:.2g} at {where}): they are stiff, and cost iterations."
        )
    if body.grey is None:
        notes.append(
            "The volume has no labels: a tetrahedron is grey matter where its corners are less than T deep "
            f"on average, so that the interface is rough, {depths.min():.2g} to {depths.max():.2g} mm deep."
        )
    elif abs(depths.mean() - T) > _OTHER * T:
        notes.append(
            f"The grey matter of the volume is {depths.mean():.3g} mm thick on average, and "
            f"geometry.cortical_thickness is {T:g} mm: give that, for lengths of contact and of pictures "
            "follow it."
        )
    return tuple(notes)
