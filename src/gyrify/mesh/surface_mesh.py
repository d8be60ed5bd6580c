"""The mesh of a body inside a surface: layers under it, and cells that grow inwards below them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from gyrify.base.places import place
from gyrify.errors import MeshError
from gyrify.mesh.cell_clusters import edge_clusters
from gyrify.mesh.filling import filled
from gyrify.mesh.mesh import GREY, WHITE, FloatArray, IntArray, Mesh
from gyrify.mesh.offset_surface import Cortex, angle_normals, offset_surface, require_layers
from gyrify.mesh.quality import LOWEST_QUALITY, SliverError, tetrahedron_quality
from gyrify.mesh.shapes.surface_body import SurfaceBody
from gyrify.mesh.shells import prisms
from gyrify.metrics.surface_pairs import contains, crossings, distances_to

# Longest edge in the white matter over the mean radius.
_LARGEST: Final = 0.3
# Share of the thickness below which the cortex is told to be thin.
_THIN: Final = 0.9


@dataclass(frozen=True)
class SurfaceLayers:
    """How a body inside a surface is divided.

    Attributes
    ----------
    n_cortex_layers : int
        Layers of the cortex, before refinement.
    is_uniform : bool
        Whether cells inside are no larger than those at the surface.
    refine, refine_cortex : int
        Times all edges and layers, and then those of the cortex alone, are halved.
    """

    n_cortex_layers: int
    is_uniform: bool = False
    refine: int = 0
    refine_cortex: int = 0


def surface_mesh(body: SurfaceBody, layers: SurfaceLayers) -> Mesh:
    """Mesh a body inside a surface, without jitter.

    Parameters
    ----------
    body : SurfaceBody
        The surface, which is kept.
    layers : SurfaceLayers
        How it is divided.

    Returns
    -------
    Mesh
        The same bytes each time.

    Raises
    ------
    MeshError
        If a surface crosses itself or another one, the cortex does not fit, or a cell would be a sliver.
    """
    for _ in range(layers.refine + layers.refine_cortex):
        body = _halved(body)
    n_layers = layers.n_cortex_layers * 2 ** (layers.refine + layers.refine_cortex)
    require_no_crossing(body.points, body.triangles, "The surface")
    T, triangles, n = body.cortical_thickness, body.triangles, body.points.shape[0]
    if body.interface is None:
        cortex = offset_surface(body.points, triangles, T, n_layers)
    else:
        cortex = Cortex(body.interface, np.linalg.norm(body.points - body.interface, axis=1) / T)
        require_layers(body.points, cortex.inner, triangles, n_layers)
    hole_points, hole = (
        (np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)) if body.hole is None else body.hole
    )
    _require_inside(cortex.inner, triangles, hole_points, hole)
    below = np.concatenate([cortex.inner, hole_points])
    corners = cortex.inner[triangles]
    edge = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())
    largest = edge if layers.is_uniform else max(_LARGEST * body.mean_radius / 2.0**layers.refine, edge)
    more, white = filled(below, np.concatenate([triangles, hole[:, ::-1] + n]), largest)
    # the interface, the layers above it, the hole, and the points inside
    rising = np.arange(1, n_layers + 1) / n_layers
    above = [cortex.inner + (body.points - cortex.inner) * part for part in rising[:-1]]
    points = np.concatenate([cortex.inner, *above, body.points, hole_points, more])
    white = np.where(white < n, white, white + n_layers * n)
    grey = np.concatenate([prisms(triangles, k * n, (k + 1) * n, k % 2 == 1) for k in range(n_layers)])
    mesh = Mesh(
        points=points,
        cells=_positive(points, np.concatenate([grey.reshape(-1, 4), white])),
        region=np.repeat(np.array([GREY, WHITE], dtype=np.int8), [3 * grey.shape[0], white.shape[0]]),
        contour=np.arange(n_layers * n, (n_layers + 1) * n),
        interface=np.arange(n),
        clamped=np.arange((n_layers + 1) * n, (n_layers + 1) * n + hole_points.shape[0]),
        across=np.empty((0, 3)),
        patch=np.append(np.repeat(np.arange(grey.shape[0]), 3), grey.shape[0] + edge_clusters(points, white)),
        depth=_depth(cortex.inner, triangles, np.concatenate([hole_points, more]), body.wall[0], n_layers),
        faces=triangles + n_layers * n,
        interface_faces=triangles,
        notes=_notes(cortex, body),
    )
    mesh = replace(mesh, across=_across(mesh, n, n_layers))
    _require_quality(mesh)
    return mesh


def jittered(mesh: Mesh, size: float, seed: int) -> Mesh:
    """Mesh of which points are moved a little, but those of the outer surface, the interface and the hole.

    Parameters
    ----------
    mesh : Mesh
        As of `surface_mesh`.
    size : float
        Largest shift over the shortest edge at the point.
    seed : int
        Of the random shifts.
    """
    if size == 0.0:
        return mesh
    noise = size * np.random.default_rng(seed).uniform(-1.0, 1.0, size=mesh.points.shape)
    shortest = np.full(mesh.n_points, np.inf)
    for i in range(4):
        for j in range(i):
            length = np.linalg.norm(mesh.points[mesh.cells[:, i]] - mesh.points[mesh.cells[:, j]], axis=1)
            np.minimum.at(shortest, mesh.cells[:, i], length)
            np.minimum.at(shortest, mesh.cells[:, j], length)
    for kept in (mesh.contour, mesh.interface, mesh.clamped, mesh.on_plane):
        shortest[kept] = 0.0
    return replace(mesh, points=mesh.points + shortest[:, None] * noise)


def _halved(body: SurfaceBody) -> SurfaceBody:
    """The body with each triangle cut into four."""
    triangles = body.triangles
    points, finer = _quartered(body.points, triangles)
    interface = None if body.interface is None else _quartered(body.interface, triangles)[0]
    hole = None if body.hole is None else _quartered(*body.hole)
    return replace(body, points=points, triangles=finer, interface=interface, hole=hole)


def _quartered(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, number = np.unique(sides, axis=0, return_inverse=True)
    middle = points.shape[0] + number.reshape(-1, 3)
    six = np.concatenate([triangles, middle], axis=1)
    finer = six[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
    return np.concatenate([points, points[edges].mean(axis=1)]), finer


def require_no_crossing(points: FloatArray, triangles: IntArray, name: str) -> None:
    """Refuse a surface that crosses itself, with a place."""
    edges, hit = crossings(points, triangles)
    if hit.size:
        raise MeshError(
            f"{name} crosses itself: {hit.size} edges pass through triangles, first at "
            f"{place(points[edges[0]].mean(axis=0))}.",
            "Repair it there in the program that it comes from.",
        )


def _require_inside(inner: FloatArray, triangles: IntArray, hole_points: FloatArray, hole: IntArray) -> None:
    """The hole crosses neither itself nor the interface, and lies inside it."""
    if hole.size == 0:
        return
    n = inner.shape[0]
    both = np.concatenate([inner, hole_points])
    edges, hit = crossings(both, np.concatenate([triangles, hole + n]))
    sides = (hole.ravel(), np.roll(hole, 1, axis=1).ravel())
    joined = csr_array((np.ones(hole.size), sides), shape=(hole_points.shape[0],) * 2)
    _, part = connected_components(joined, directed=False)
    _, firsts = np.unique(part, return_index=True)
    outside = [k for k in firsts if not contains(inner[triangles], hole_points[k])]
    where = both[edges[0]].mean(axis=0) if hit.size else hole_points[(outside or [0])[0]]
    if hit.size or outside:
        raise MeshError(
            f"The hole is not inside the white matter: it meets itself or the interface at {place(where)}.",
            "Give another geometry.hole_file, or a smaller geometry.cortical_thickness.",
        )


def _positive(points: FloatArray, cells: IntArray) -> IntArray:
    corners = points[cells]
    inverted = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0.0
    turned = cells.copy()
    turned[inverted, 2], turned[inverted, 3] = cells[inverted, 3], cells[inverted, 2]
    return turned


def _depth(
    inner: FloatArray, triangles: IntArray, inside: FloatArray, white: float, n_layers: int
) -> FloatArray:
    """Depth of the points: 1 to 2 from the interface to the surface, below 1 inside by the distance."""
    layers = np.repeat(1.0 + np.arange(n_layers + 1) / n_layers, inner.shape[0])
    if inside.size == 0:
        return layers
    below = distances_to(inside, inner[triangles])
    return np.append(layers, np.maximum(1.0 - below / white, 0.0))


def _across(mesh: Mesh, n: int, n_layers: int) -> FloatArray:
    """(n_cells, 3) directions across the layers; inside, those of the nearest place on the interface."""
    lower = angle_normals(mesh.points[mesh.interface], mesh.interface_faces)
    upper = angle_normals(mesh.points[mesh.contour], mesh.interface_faces)
    at_points = np.empty((mesh.n_points, 3))
    for k in range(n_layers + 1):
        at_points[k * n : (k + 1) * n] = lower + (upper - lower) * (k / n_layers)
    rest = mesh.points[(n_layers + 1) * n :]
    if rest.size:
        _, nearest = cKDTree(mesh.points[mesh.interface]).query(rest)
        at_points[(n_layers + 1) * n :] = lower[nearest]
    mean = at_points[mesh.cells].sum(axis=1)
    size = np.linalg.norm(mean, axis=1, keepdims=True)
    return np.asarray(np.where(size > 1e-9, mean / np.maximum(size, 1e-9), [0.0, 0.0, 1.0]))


def _notes(cortex: Cortex, body: SurfaceBody) -> tuple[str, ...]:
    thin = cortex.share < _THIN
    if body.interface is not None or not thin.any():
        return ()
    worst, T = int(np.argmin(cortex.share)), body.cortical_thickness
    return (
        f"The cortex is thinner than {_THIN:g} T under {thin.mean():.2g} of the surface's points, down to "
        f"{cortex.share[worst] * T:.3g} mm at {place(body.points[worst])}: the surface is too sharp or too "
        "thin for more there.",
    )


def _require_quality(mesh: Mesh) -> None:
    quality = tetrahedron_quality(mesh.cell_points)
    worst = int(np.argmin(quality))
    if not quality[worst] >= LOWEST_QUALITY:
        raise SliverError(
            f"The mesh has tetrahedra of quality {quality[worst]:.2g} (1 is regular, {LOWEST_QUALITY:g} is "
            f"needed), first at {place(mesh.cell_points[worst].mean(axis=0))}.",
            "Smooth the surface there, lower mesh.n_cortex_layers, or raise geometry.cortical_thickness.",
        )
