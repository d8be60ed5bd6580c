"""The tetrahedra of a body from a file, in mm: checked, and refused with a reason and a place."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gyrify.base.places import place
from gyrify.config.inputs import triangle_topology as topology
from gyrify.config.inputs.body_surface import UNITS, require_size
from gyrify.config.inputs.closed_surface import (
    TriangleSurface,
    closed_surface,
    require_two_at_each_edge,
    volumes_of_parts,
)
from gyrify.config.inputs.named_files import content
from gyrify.config.inputs.volume_readers import FloatArray, IntArray, read_tetrahedra
from gyrify.config.small_tables import Labels
from gyrify.errors import ConfigError, MeshError
from gyrify.metrics.tetrahedra import faces_by_cells, faces_of_one_cell, signed_volumes

# Points this much nearer to each other than the body is long are one; a cell of less volume is flat.
_SAME: Final = 1e-7
_FLAT: Final = 1e-12


@dataclass(frozen=True, eq=False)
class TetrahedronVolume:
    """A body of tetrahedra.

    Attributes
    ----------
    points : (n_points, 3) float array
        [mm]; each is a corner of a cell.
    cells : (n_cells, 4) int array
        Positive.
    grey : (n_cells,) bool array or None
        Which are grey matter by their labels; None without labels.
    notes : tuple of str
        What was repaired, as sentences.
    name : str
        What to call it in messages.
    """

    points: FloatArray
    cells: IntArray
    grey: NDArray[np.bool_] | None
    notes: tuple[str, ...]
    name: str

    def __post_init__(self) -> None:
        for array in (self.points, self.cells):
            array.flags.writeable = False

    @cached_property
    def _sides(self) -> tuple[IntArray, IntArray]:
        """Triangles of the outer boundary, and of holes, outwards as seen from the cells."""
        faces = faces_of_one_cell(self.cells)
        require_two_at_each_edge(self.points, faces, f"The outside of {self.name}")
        part = topology.parts_of(faces)
        is_hole = (volumes_of_parts(self.points, faces, part) < 0.0)[part]
        return faces[~is_hole], faces[is_hole]

    @cached_property
    def outer(self) -> TriangleSurface:
        """The outer boundary.

        Raises
        ------
        MeshError
            If it is no closed surface.
        """
        return closed_surface(self.points, self._sides[0], f"The outside of {self.name}")

    @cached_property
    def hole(self) -> TriangleSurface | None:
        """The surface of holes, or None."""
        sides = self._sides[1]
        return closed_surface(self.points, sides, f"The hole in {self.name}") if sides.size else None


@lru_cache(maxsize=4)
def body_volume(path: str, unit: str, _digest: str, labels: Labels) -> TetrahedronVolume:
    """Tetrahedra that ``geometry.file`` names.

    Parameters
    ----------
    path : str
        The file.
    unit : str
        Unit of its coordinates.
    _digest : str
        Of the files of the configuration, to which what was read belongs.
    labels : Labels
        Of the grey and white matter and of the hole; none: cells are grey by their depth.

    Returns
    -------
    TetrahedronVolume

    Raises
    ------
    ConfigError
        If the file cannot be read, its size is not that of a body, or labels are not those of the file.
    MeshError
        If its cells are no body.
    """
    name = f"geometry.file ({Path(path).name})"
    points, cells, found = read_tetrahedra(content("file", path), path)
    points = points * UNITS[unit]
    _require_finite(points[np.unique(cells)], name)
    require_size(float(np.ptp(points[np.unique(cells)], axis=0).max()), unit, name)
    notes: list[str] = []
    grey: NDArray[np.bool_] | None = None
    if labels != Labels():
        cells, grey = _labelled(cells, found, labels, name, notes)
    points, cells = _joined(points, cells, notes)
    cells = _positive(points, cells, name)
    _require_one_behind_each_face(points, cells, name)
    return TetrahedronVolume(points, cells, grey, tuple(notes), name)


def _require_finite(points: FloatArray, name: str) -> None:
    if not np.isfinite(points).all():
        raise MeshError(f"{name} has coordinates that are not finite numbers.", "Save it again.")


def _labelled(
    cells: IntArray, found: IntArray | None, labels: Labels, name: str, notes: list[str]
) -> tuple[IntArray, NDArray[np.bool_]]:
    """Cells of the body, and which of them are grey."""
    if found is None:
        raise ConfigError(
            f"geometry.labels is given, but the tetrahedra of {name} have no labels.",
            "Leave geometry.labels out: cells are then grey by their depth.",
        )
    twice = sorted(
        {*labels.grey} & {*labels.white} | {*labels.grey} & {*labels.hole} | {*labels.white} & {*labels.hole}
    )
    if twice:
        raise ConfigError(
            f"geometry.labels names the label {twice[0]} twice.", "Name each label once: grey, white or hole."
        )
    known = np.unique(found)
    wanted = {*labels.grey, *labels.white, *labels.hole}
    other = [int(label) for label in known if label not in wanted]
    if other:
        raise ConfigError(
            f"{name} has tetrahedra with the label {other[0]}, which geometry.labels names nowhere; its "
            f"labels are {', '.join(str(int(label)) for label in known[:20])}.",
            "Name each label of the file once: grey, white or hole.",
        )
    if absent := sorted(wanted - {int(label) for label in known}):
        notes.append(f"no tetrahedron has the label {absent[0]} of geometry.labels")
    is_grey, is_hole = np.isin(found, labels.grey), np.isin(found, labels.hole)
    for role, count in (("grey", is_grey.sum()), ("white", (~is_grey & ~is_hole).sum())):
        if count == 0:
            raise ConfigError(
                f"geometry.labels makes no tetrahedron of {name} {role} matter; its labels are "
                f"{', '.join(str(int(label)) for label in known[:20])}.",
                f"Name at least one of them as {role}.",
            )
    return cells[~is_hole], np.asarray(is_grey[~is_hole])


def _joined(points: FloatArray, cells: IntArray, notes: list[str]) -> tuple[FloatArray, IntArray]:
    """Points once each, and those alone that cells have."""
    used = np.unique(cells)
    size = float(np.ptp(points[used], axis=0).max())
    number = np.full(points.shape[0], -1, dtype=np.int64)
    number[used] = used[topology.welded(points[used], _SAME * size)]
    n_joined = int((number[used] != used).sum())
    if n_joined:
        notes.append(f"{n_joined} points that lay on others were joined with them")
    kept, joined = np.unique(number[cells], return_inverse=True)
    return np.ascontiguousarray(points[kept]), joined.reshape(-1, 4).astype(np.int64)


def _positive(points: FloatArray, cells: IntArray, name: str) -> IntArray:
    """Cells turned so that all have positive volume."""
    volumes = signed_volumes(points[cells])
    size = float(np.ptp(points, axis=0).max())
    flat = np.flatnonzero(np.abs(volumes) <= _FLAT * size**3)
    if flat.size:
        raise MeshError(
            f"{name} has {flat.size} tetrahedra without volume, first at "
            f"{place(points[cells[flat[0]]].mean(axis=0))}.",
            "Mesh the body anew in the program that it comes from.",
        )
    turned = cells.copy()
    turned[volumes < 0.0, 2], turned[volumes < 0.0, 3] = cells[volumes < 0.0, 3], cells[volumes < 0.0, 2]
    return turned


def _require_one_behind_each_face(points: FloatArray, cells: IntArray, name: str) -> None:
    faces, order, first = faces_by_cells(cells)
    many = np.flatnonzero(np.diff(first) > 2)
    if many.size:
        where = place(points[faces[order[first[many[0]]]]].mean(axis=0))
        raise MeshError(
            f"{name} has {many.size} faces with more than two tetrahedra, first at {where}.",
            "Remove repeated or overlapping cells.",
        )
