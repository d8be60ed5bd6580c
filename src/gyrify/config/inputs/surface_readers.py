"""Triangles of a surface from the bytes of a file, by the libraries of its format."""

from __future__ import annotations

import base64
import io
import re
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from gyrify.base.extras import require
from gyrify.config.inputs.named_files import MOST_BYTES
from gyrify.errors import ConfigError

# Bytes that are unfolded at a time.
_PIECE: Final = 1_000_000

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Triangles = tuple[FloatArray, IntArray]

_EXTRA: Final = "surface"
# The first three bytes of FreeSurfer's surfaces of triangles.
_FREESURFER: Final = b"\xff\xff\xfe"
FORMATS: Final = "STL, PLY, OFF, OBJ, GIfTI (.gii) or FreeSurfer"


def read_triangles(data: bytes, name: str) -> Triangles:
    """Points and triangles as a file has them.

    Parameters
    ----------
    data : bytes
        What the file holds.
    name : str
        What it is called; the end of it tells the format, but for FreeSurfer's, which begins with a mark.

    Returns
    -------
    points : (n_points, 3) float array
        In the unit of the file.
    triangles : (n, 3) int array

    Raises
    ------
    ConfigError
        If the format is not known, or the file is damaged.
    """
    suffix = Path(name).suffix.lower()
    if data.startswith(_FREESURFER):
        reader: Callable[[bytes, str], Triangles] = _freesurfer
    elif suffix == ".gii":
        reader = _gifti
    elif suffix in (".stl", ".ply", ".off", ".obj"):
        reader = _mesh_file
    else:
        raise ConfigError(
            f'"{Path(name).name}" has an unknown format: it must be {FORMATS}.',
            "Save the surface as STL or PLY.",
        )
    try:
        points, triangles = reader(data, suffix)
    except ConfigError:
        raise
    except Exception as fault:  # readers raise whatever damaged bytes lead them to
        why = " ".join(str(fault).split())[:120] or type(fault).__name__
        raise ConfigError(
            f'"{Path(name).name}" cannot be read as a surface: it is damaged or cut short ({why}).',
            "Save it again from the program that made it.",
        ) from fault
    if triangles.size == 0 or points.shape[0] < 4:
        raise ConfigError(f'"{Path(name).name}" holds no surface: it has no triangles.', "Give another file.")
    return points, triangles


def _mesh_file(data: bytes, suffix: str) -> Triangles:
    trimesh = require("trimesh", _EXTRA, "A surface from a file")
    _require_whole(data, suffix)
    loaded = trimesh.load(
        io.BytesIO(data), file_type=suffix[1:], process=False, force="mesh", skip_materials=True
    )
    return _arrays(loaded.vertices, loaded.faces)


def _require_whole(data: bytes, suffix: str) -> None:
    """A binary STL says how many triangles it has."""
    if suffix != ".stl" or data[:80].lstrip()[:5].lower() == b"solid":
        return
    counted = int.from_bytes(data[80:84], "little")
    if len(data) < 84 or len(data) < 84 + 50 * counted:
        raise ValueError(f"it tells of {counted} triangles and has room for {max(len(data) - 84, 0) // 50}")


def _gifti(data: bytes, _: str) -> Triangles:
    nibabel = require("nibabel", _EXTRA, "A surface from a GIfTI file")
    _require_bounded(data)
    image = nibabel.GiftiImage.from_bytes(data)
    found = [image.get_arrays_from_intent(f"NIFTI_INTENT_{name}") for name in ("POINTSET", "TRIANGLE")]
    if not all(found):
        raise ValueError("it has no points and triangles")
    return _arrays(found[0][0].data, found[1][0].data)


def _require_bounded(data: bytes) -> None:
    """Blocks of a GIfTI file are deflated: a small one may hold more than fits into the memory."""
    room = MOST_BYTES
    for block in re.finditer(rb"<Data>([^<]*)</Data>", data):
        try:
            packed = base64.b64decode(block[1])
        except ValueError:
            continue  # a text of numbers, which is no larger than it looks
        unpacked = zlib.decompressobj()
        while packed and room >= 0:
            try:
                room -= len(unpacked.decompress(packed, _PIECE))
            except zlib.error:
                break
            packed = unpacked.unconsumed_tail
        if room < 0:
            raise ValueError(f"it unfolds to more than {MOST_BYTES / 1e6:.0f} MB")


def _freesurfer(data: bytes, _: str) -> Triangles:
    from tempfile import TemporaryDirectory

    freesurfer = require("nibabel.freesurfer", _EXTRA, "A surface from a FreeSurfer file", "nibabel")
    with TemporaryDirectory(prefix="gyrify-") as folder:  # it reads from paths only
        path = Path(folder) / "surface"
        path.write_bytes(data)
        return _arrays(*freesurfer.read_geometry(str(path)))


def _arrays(points: Any, triangles: Any) -> Triangles:
    points = np.ascontiguousarray(points, dtype=np.float64).reshape(-1, 3)
    triangles = np.ascontiguousarray(triangles, dtype=np.int64).reshape(-1, 3)
    if triangles.size and not (triangles.min() >= 0 and triangles.max() < points.shape[0]):
        raise ValueError("a triangle names a point that is not there")
    return points, triangles
