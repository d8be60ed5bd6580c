"""A closed surface: repaired where that is safe, refused with a reason and a place where it is not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gyrify.base.places import place
from gyrify.config.inputs import triangle_topology as topology
from gyrify.config.inputs.triangle_topology import FloatArray, IntArray
from gyrify.errors import MeshError
from gyrify.metrics.surface_pairs import contains

# Points this much nearer to each other than the surface is long are one.
_SAME: Final = 1e-7
# Smallest angle of a triangle that cells can stand on [degrees].
_NARROWEST: Final = 0.5
MOST_TRIANGLES: Final = 1_000_000
# Parts with less of the whole volume than this are specks of a segmentation.
_SPECK: Final = 1e-3


@dataclass(frozen=True, eq=False)
class TriangleSurface:
    """One or several closed surfaces, none inside another, outwards counter-clockwise.

    Attributes
    ----------
    points : (n_points, 3) float array
        [mm].
    triangles : (n, 3) int array
    part : (n,) int array
        Closed surface that each triangle belongs to.
    notes : tuple of str
        What was repaired, as sentences.
    source : (n_points,) int array
        Number of each point in the file.
    """

    points: FloatArray
    triangles: IntArray
    part: IntArray
    notes: tuple[str, ...]
    source: IntArray

    def __post_init__(self) -> None:
        for array in (self.points, self.triangles, self.part, self.source):
            array.flags.writeable = False

    @property
    def volume(self) -> float:
        """Inside all parts [mm^3]."""
        return float(volumes_of_parts(self.points, self.triangles, self.part).sum())

    @property
    def area(self) -> float:
        """[mm^2]."""
        a, b, c = (self.points[self.triangles[:, k]] for k in range(3))
        return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())

    @property
    def extents(self) -> FloatArray:
        """(3,) sizes along x, y and z [mm]."""
        return np.asarray(np.ptp(self.points, axis=0))

    @property
    def n_parts(self) -> int:
        """How many closed surfaces there are."""
        return int(self.part.max()) + 1

    @property
    def mean_edge(self) -> float:
        """Mean length of the sides of the triangles [mm]."""
        sides = self.points[np.roll(self.triangles, -1, axis=1)] - self.points[self.triangles]
        return float(np.linalg.norm(sides, axis=2).mean())

    @property
    def roundness(self) -> float:
        """Smallest over largest distance of the surface from its middle: 1 for a sphere [-]."""
        a, b, c = (self.points[self.triangles[:, k]] for k in range(3))
        weight = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        middle = (weight[:, None] * (a + b + c)).sum(axis=0) / (3.0 * weight.sum())
        away = np.linalg.norm(self.points - middle, axis=1)
        return float(away.min() / away.max())


def closed_surface(points: FloatArray, triangles: IntArray, name: str) -> TriangleSurface:
    """Repair and check a surface.

    Parameters
    ----------
    points : (n_points, 3) float array
        [mm].
    triangles : (n, 3) int array
        As a file has them.
    name : str
        What to call it in messages.

    Returns
    -------
    TriangleSurface

    Raises
    ------
    MeshError
        If it is open, has more than two triangles at an edge, touches itself at a point, has only one side,
        is too thin somewhere, or is a surface inside another.
    """
    if triangles.shape[0] > MOST_TRIANGLES:
        raise MeshError(
            f"{name} has {triangles.shape[0]} triangles; at most {MOST_TRIANGLES} can be meshed.",
            "Make it coarser in the program that it comes from.",
        )
    if not np.isfinite(points).all():
        bad = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise MeshError(
            f"{name} has coordinates that are not finite numbers, first at its point {bad}.",
            "Save it again from the program that made it.",
        )
    points, triangles, source, notes = _cleaned(points, triangles, name)
    require_two_at_each_edge(points, triangles, name)
    turned = topology.oriented(triangles)
    if turned is None:
        raise MeshError(f"{name} has no inside: it has one side only, like a Klein bottle.", "Repair it.")
    triangles, n_turned = turned
    part = topology.parts_of(triangles)
    volumes = volumes_of_parts(points, triangles, part)
    inverted = volumes < 0.0
    triangles = np.where(inverted[part][:, None], triangles[:, ::-1], triangles)
    if n_turned:
        notes.append(f"{n_turned} triangles were turned so that all have the same side outwards")
    if inverted.any():
        notes.append("the inside was out, and was turned in")
    surface = TriangleSurface(points, triangles, part, tuple(notes), source)
    _require_shape(surface, np.abs(volumes), name)
    return surface


def _cleaned(
    points: FloatArray, triangles: IntArray, name: str
) -> tuple[FloatArray, IntArray, IntArray, list[str]]:
    """Points once each, triangles with three corners, each once; and what was done."""
    notes = []
    first = topology.welded(points, _SAME * float(np.ptp(points[np.unique(triangles)], axis=0).max()))
    n_welded = int((first != np.arange(first.size)).sum())
    triangles = first[triangles]
    is_whole = (np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)
    triangles, n_repeated, n_walls = topology.single(triangles[is_whole])
    if triangles.size == 0:
        raise MeshError(f"{name} holds no triangle with three different corners.", "Give another file.")
    used, triangles = np.unique(triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3).astype(np.int64)
    # every STL has each point once for each triangle: that is no fault
    if n_welded and n_welded < 0.5 * first.size:
        notes.append(f"{n_welded} points that lay on others were joined with them")
    if n_flat := int((~is_whole).sum()):
        notes.append(f"{n_flat} triangles without area were left out")
    if n_repeated:
        notes.append(f"{n_repeated} repeated triangles were left out")
    if n_walls:
        notes.append(
            f"{n_walls} pairs of triangles back to back were left out, so that what lay on both sides of "
            "these walls is joined"
        )
    return points[used], triangles, used.astype(np.int64), notes


def require_two_at_each_edge(points: FloatArray, triangles: IntArray, name: str) -> None:
    edges, number = topology.edges_of(triangles)
    counts = np.bincount(number)
    border, many = np.flatnonzero(counts == 1), np.flatnonzero(counts > 2)
    if border.size:
        where = place(points[edges[border[0]]].mean(axis=0))
        raise MeshError(
            f"{name} is not closed: {border.size} edges have a triangle on one side only, first at {where}.",
            "Close its holes, or give the whole surface: half a surface has no inside.",
        )
    if many.size:
        where = place(points[edges[many[0]]].mean(axis=0))
        raise MeshError(
            f"{name} is not a surface: {many.size} edges have more than two triangles, first at {where}.",
            "Repair it there, for example by a Boolean union of its parts.",
        )
    pinched = topology.pinched_points(triangles, points.shape[0])
    if pinched.size:
        raise MeshError(
            f"{name} touches itself at {pinched.size} points, first at {place(points[pinched[0]])}.",
            "Repair it there: move the parts apart or join them along edges.",
        )


def _require_shape(surface: TriangleSurface, volumes: FloatArray, name: str) -> None:
    points, triangles = surface.points, surface.triangles
    corners = points[triangles]
    angles = _smallest_angles(corners)
    worst = int(np.argmin(angles))
    if angles[worst] < _NARROWEST:
        raise MeshError(
            f"{name} has a triangle with an angle of {angles[worst]:.2g} degrees, at "
            f"{place(corners[worst].mean(axis=0))}; cells on it need {_NARROWEST:g} at least.",
            "Mesh the surface anew in the program that it comes from.",
        )
    order = np.argsort(-volumes, kind="stable")
    speck = np.flatnonzero(volumes < _SPECK * volumes.sum())
    first = [int(np.flatnonzero(surface.part == k)[0]) for k in range(surface.n_parts)]
    if speck.size:
        raise MeshError(
            f"{name} has {speck.size} small parts beside the others, first at "
            f"{place(corners[first[speck[0]], 0])} with {volumes[speck[0]]:.3g} mm³.",
            "Remove them: keep the large parts alone.",
        )
    for k, large in enumerate(order):
        own = corners[surface.part == large]
        for small in order[k + 1 :]:
            if contains(own, corners[first[small], 0]):
                raise MeshError(
                    f"{name} has one surface inside another, at {place(corners[first[small], 0])}.",
                    "Give the outer surface alone, and a cavity by geometry.hole_file.",
                )


def volumes_of_parts(points: FloatArray, triangles: IntArray, part: IntArray) -> FloatArray:
    """Signed volume inside each part [mm^3], about the middle of all."""
    corners = points[triangles] - points.mean(axis=0)
    own = np.einsum("ni,ni->n", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    return np.asarray(np.bincount(part, own))


def _smallest_angles(corners: FloatArray) -> FloatArray:
    """(n,) [degrees]."""
    found = np.full(corners.shape[0], 180.0)
    for k in range(3):
        a, b = (corners[:, (k + n) % 3] - corners[:, k] for n in (1, 2))
        turn = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("ni,ni->n", a, b))
        found = np.minimum(found, np.degrees(turn))
    return found
