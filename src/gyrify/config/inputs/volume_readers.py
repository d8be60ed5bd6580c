"""Tetrahedra from the bytes of a file: the plain format of folding codes, and whatever meshio reads."""

from __future__ import annotations

from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gyrify.base.extras import require
from gyrify.errors import ConfigError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
# Points, tetrahedra and the label of each tetrahedron, if there are labels.
Tetrahedra = tuple[FloatArray, IntArray, IntArray | None]

_EXTRA: Final = "export"
SUFFIXES: Final = (".mesh", ".vtk", ".vtu", ".msh", ".inp", ".nas", ".bdf", ".su2", ".avs")
FORMATS: Final = "MESH (plain or Medit), VTK, VTU, MSH, INP, NAS, BDF, SU2 or AVS"
# What programs call the labels of cells; gyrify's own files have the last one.
_LABELS: Final = ("medit:ref", "gmsh:physical", "cell_tags", "nastran:ref", "su2:tag", "avsucd:material")
_OTHER_LABELS: Final = ("label", "labels", "material", "region")
# Numbers of points and labels are below this.
_LARGEST: Final = 2.0**53
# Cells that a surface or a curve in the same file has.
_IGNORED: Final = frozenset({"vertex", "line", "line3", "triangle", "triangle6"})


def read_tetrahedra(data: bytes, name: str) -> Tetrahedra:
    """Points, tetrahedra and labels as a file has them.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        What it is called; the end of it tells the format.

    Returns
    -------
    points : (n_points, 3) float array
        In the unit of the file.
    cells : (n_cells, 4) int array
    labels : (n_cells,) int array or None

    Raises
    ------
    ConfigError
        If the format is not known, the file is damaged, or holds other cells.
    """
    suffix = Path(name).suffix.lower()
    if suffix not in SUFFIXES:
        raise ConfigError(
            f'"{Path(name).name}" has an unknown format: it must be {FORMATS}.',
            "Save the tetrahedra as VTU.",
        )
    is_plain = suffix == ".mesh" and data.lstrip()[:1].isdigit()
    try:
        points, cells, labels = _plain(data) if is_plain else _by_meshio(data, suffix)
        return _checked(points, cells, labels)
    except ConfigError:
        raise
    except Exception as fault:  # readers raise whatever damaged bytes lead them to
        why = " ".join(str(fault).split())[:120] or type(fault).__name__
        raise ConfigError(
            f'"{Path(name).name}" cannot be read as tetrahedra: it is damaged or cut short ({why}).',
            "Save it again from the program that made it.",
        ) from fault


def _plain(data: bytes) -> Tetrahedra:
    """Points, tetrahedra with their labels, and triangles, each after their number."""
    numbers = np.array(data.split(), dtype=np.float64)
    at, blocks = 0, []
    for width in (3, 5, 4):
        if at == numbers.size and width == 4:
            break  # triangles may be left out
        count = int(numbers[at])
        end = at + 1 + width * count
        if count < 0 or count != numbers[at] or end > numbers.size:
            raise ValueError(f"it tells of {numbers[at]:g} rows of {width} numbers and has not as many")
        blocks.append(numbers[at + 1 : end].reshape(-1, width))
        at = end
    if at != numbers.size:
        raise ValueError(f"{numbers.size - at} numbers follow its end")
    if not np.all(np.abs(blocks[1]) < _LARGEST):
        raise ValueError("a tetrahedron has a number that is far too large")
    whole = blocks[1].astype(np.int64)
    if np.any(whole != blocks[1]):
        raise ValueError("a tetrahedron names a point by a number with a fraction")
    return blocks[0].copy(), np.ascontiguousarray(whole[:, 1:] - 1), whole[:, 0].copy()


def _by_meshio(data: bytes, suffix: str) -> Tetrahedra:
    meshio = require("meshio", _EXTRA, "A volume from a file")
    with TemporaryDirectory(prefix="gyrify-") as folder:  # some of its readers read from paths only
        path = Path(folder) / f"volume{suffix}"
        path.write_bytes(data)
        told = StringIO()  # it speaks to the terminal
        with redirect_stdout(told), redirect_stderr(told):
            try:
                mesh = meshio.read(path)
            except SystemExit:
                raise ValueError(told.getvalue() or "the reader gave up") from None
    kinds = [block.type for block in mesh.cells]
    other = sorted(set(kinds) - _IGNORED - {"tetra"})
    if other:
        raise ConfigError(
            f"The volume has cells of the type {other[0]}: bodies are made of straight tetrahedra alone.",
            "Mesh it with tetrahedra of four points.",
        )
    own = [number for number, kind in enumerate(kinds) if kind == "tetra"]
    if not own:
        return np.asarray(mesh.points), np.empty((0, 4), dtype=np.int64), None
    cells = np.concatenate([mesh.cells[number].data for number in own])
    return np.asarray(mesh.points), cells, _labels(mesh.cell_data, own)


def _labels(cell_data: dict[str, Any], own: list[int]) -> IntArray | None:
    """Labels by one of the usual names, or the only whole numbers that there are."""
    known = {
        name: np.concatenate([np.asarray(arrays[number]) for number in own])
        for name, arrays in cell_data.items()
    }
    # some programs write labels as numbers with a point
    whole = {
        name: array
        for name, array in known.items()
        if array.ndim == 1
        and array.dtype.kind in "iuf"
        and np.all(np.abs(array.astype(np.float64)) < _LARGEST)
        and np.array_equal(array, np.round(array))
    }
    chosen = [str(name) for name in (*_LABELS, *_OTHER_LABELS) if name in whole][:1]
    if not chosen and len(whole) == 1:
        chosen = list(whole)
    return whole[chosen[0]].astype(np.int64) if chosen else None


def _checked(points: Any, cells: Any, labels: IntArray | None) -> Tetrahedra:
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError("its points do not lie in space")
    cells = np.ascontiguousarray(cells, dtype=np.int64).reshape(-1, 4)
    if cells.size == 0:
        raise ConfigError("The volume holds no tetrahedra.", "Give a file with tetrahedra, not a surface.")
    if not (cells.min() >= 0 and cells.max() < points.shape[0]):
        raise ValueError("a tetrahedron names a point that is not there")
    if labels is not None and labels.size != cells.shape[0]:
        raise ValueError("there are not as many labels as tetrahedra")
    return points, cells, labels
