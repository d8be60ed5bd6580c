"""The mesh of a body from a file: made once, and kept beside the copy of the file in a run.

A mesher of another version may make another mesh; what a run was begun on is therefore stored with it.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from collections import OrderedDict
from dataclasses import fields, replace
from pathlib import Path
from typing import Final

import numpy as np

from gyrify.config import Config
from gyrify.config.inputs.named_files import FILE_KEYS, FOLDER, MESH
from gyrify.errors import MeshError
from gyrify.mesh import Mesh
from gyrify.mesh.shapes import SurfaceBody, VolumeBody, shape_of
from gyrify.mesh.surface_mesh import SurfaceLayers, surface_mesh
from gyrify.mesh.volume_mesh import volume_mesh

_ARRAYS: Final = (
    "points",
    "cells",
    "region",
    "contour",
    "interface",
    "clamped",
    "across",
    "patch",
    "depth",
    "faces",
    "interface_faces",
    "on_plane",
)
_FORMAT: Final = 2
_MOST_BYTES: Final = 4_000_000_000
# Meshes at hand: that of a run, and that of the smooth body without jitter is the same.
_MOST_KEPT: Final = 2
_made: OrderedDict[tuple[object, ...], Mesh] = OrderedDict()


def mesh_inside(config: Config) -> Mesh:
    """Mesh of a body from a file, without jitter: the one beside its file, or a new one.

    Raises
    ------
    MeshError
        If the body cannot be meshed, or what is beside its file is damaged.
    """
    key, beside = _key(config), _beside(Path(config.geometry.file))
    about = beside.stat() if beside else None
    # the mesh of one run is not that of another one, which another Netgen may have made
    place = (key, str(beside), about.st_mtime_ns, about.st_size) if about else (key,)
    if place not in _made:
        mesh = _read(beside, key) if beside else None
        _made[place] = _new(config) if mesh is None else mesh
        while len(_made) > _MOST_KEPT:
            _made.popitem(last=False)
    _made.move_to_end(place)
    return _made[place]


def _beside(surface: Path) -> Path | None:
    """The mesh beside a run's own copy of a surface, if there is one."""
    mesh = surface.with_name(MESH)
    is_copy = mesh.parent.name == FOLDER and surface.stem == FILE_KEYS["file"]
    return mesh if is_copy and mesh.is_file() else None


def mesh_bytes(config: Config) -> bytes:
    """The mesh as a file for `mesh_inside`, the same bytes each time."""
    mesh, whole = mesh_inside(config), io.BytesIO()
    about = json.dumps({"format": _FORMAT, "key": _key(config), "notes": mesh.notes})
    arrays = {name: getattr(mesh, name) for name in _ARRAYS} | {"about": np.array(about)}
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in arrays.items():
            part = io.BytesIO()
            np.save(part, array, allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), part.getvalue(), zipfile.ZIP_DEFLATED)
    return whole.getvalue()


def mesh_digest(mesh: Mesh) -> str:
    """SHA-256 of the points and cells of a mesh."""
    whole = hashlib.sha256()
    for array in (mesh.points, mesh.cells, mesh.region):
        whole.update(np.ascontiguousarray(array).tobytes())
    return whole.hexdigest()


def _key(config: Config) -> str:
    """What makes another mesh."""
    geometry, mesh = config.geometry, config.mesh
    what = (
        _FORMAT,
        geometry.digest,
        geometry.unit,
        geometry.labels,
        config.boundary.plane if config.boundary.clamp == "plane" else None,
        geometry.cortical_thickness,
        mesh.n_cortex_layers,
        mesh.grading,
        mesh.refine,
        mesh.refine_cortex,
    )
    return hashlib.sha256(repr(what).encode()).hexdigest()


def _new(config: Config) -> Mesh:
    body, mesh = shape_of(config.geometry), config.mesh
    if isinstance(body, VolumeBody):
        is_half, plane = config.boundary.clamp == "plane", config.boundary.plane
        cut = (np.array(plane.point), np.array(plane.normal)) if is_half else None
        return volume_mesh(replace(body, plane=cut), mesh.refine)
    assert isinstance(body, SurfaceBody)
    layers = SurfaceLayers(mesh.n_cortex_layers, mesh.grading == "uniform", mesh.refine, mesh.refine_cortex)
    return surface_mesh(body, layers)


def _read(path: Path, key: str) -> Mesh | None:
    """Mesh of a file; None where it is that of another configuration."""
    try:
        with zipfile.ZipFile(path) as archive:
            if sum(part.file_size for part in archive.infolist()) > _MOST_BYTES:
                raise ValueError("it is too large")
            arrays = {
                name: np.load(io.BytesIO(archive.read(f"{name}.npy")), allow_pickle=False)
                for name in (*_ARRAYS, "about")
            }
        about = json.loads(str(arrays.pop("about")))
        if about["key"] != key:
            return None
        mesh = Mesh(**arrays, notes=tuple(map(str, about["notes"])))
        _require_sound(mesh)
    except Exception as fault:  # a damaged file raises whatever its bytes lead to
        raise MeshError(
            f"The mesh of this run, {path}, is damaged ({' '.join(str(fault).split())[:100]}).",
            "Run it again, or delete the file to have the mesh made anew by the Netgen that is installed.",
        ) from fault
    return mesh


def _require_sound(mesh: Mesh) -> None:
    """Arrays of the right types and shapes, with numbers of points that there are."""
    kinds = {field.name for field in fields(Mesh)}
    assert kinds.issuperset(_ARRAYS)
    n, n_cells = mesh.points.shape[0], mesh.cells.shape[0]
    shapes = {
        "points": (n, 3),
        "cells": (n_cells, 4),
        "region": (n_cells,),
        "across": (n_cells, 3),
        "patch": (n_cells,),
        "depth": (n,),
    }
    for name in _ARRAYS:
        array = getattr(mesh, name)
        is_real = name in ("points", "across", "depth")
        right = np.float64 if is_real else np.int8 if name == "region" else np.int64
        if array.dtype != right or array.shape != shapes.get(name, array.shape):
            raise ValueError(f"{name} is not what it should be")
        if is_real and not np.isfinite(array).all():
            raise ValueError(f"{name} has numbers that are not finite")
        most = n_cells if name == "patch" else 2 if name == "region" else n
        if not is_real and array.size and not (array.min() >= 0 and array.max() < most):
            raise ValueError(f"{name} names what is not there")
