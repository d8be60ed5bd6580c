"""The surface of a body from a file, in mm: read once for each content and unit."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from gyrify.config.inputs.closed_surface import TriangleSurface, closed_surface
from gyrify.config.inputs.named_files import content
from gyrify.config.inputs.surface_readers import FloatArray, read_triangles
from gyrify.errors import ConfigError

# Units of a file in mm.
UNITS: Final = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1e3}
# Sizes of bodies that are meant; anything else is mistaken for them in a wrong unit [mm].
SMALLEST, LARGEST = 1.0, 500.0


def body_surface(path: str, unit: str, digest: str, key: str = "file") -> TriangleSurface:
    """Closed surface that a key of ``[geometry]`` names.

    Parameters
    ----------
    path : str
        The file.
    unit : str
        Unit of its coordinates, one of `UNITS`.
    digest : str
        Of the files of the configuration, to which what was read belongs.
    key : str
        The key.

    Returns
    -------
    TriangleSurface

    Raises
    ------
    ConfigError
        If the file cannot be read, or its size is not that of a body.
    MeshError
        If it is no closed surface that can be meshed; see `closed_surface`.
    """
    return _read(path, unit, digest, key)


# Distance over the size of the body below which the interface lies on the surface.
_COINCIDENT: Final = 1e-6


@lru_cache(maxsize=4)
def matching_points(path: str, outer: str, unit: str, digest: str) -> FloatArray:
    """Points of an interface that belong one by one to those of an outer surface.

    Parameters
    ----------
    path : str
        File of the interface.
    outer : str
        File of the outer surface, as of `body_surface`.
    unit, digest : str
        As of `body_surface`.

    Returns
    -------
    (n_points, 3) float array
        [mm].

    Raises
    ------
    ConfigError
        If the triangles of both files are not the same.
    """
    surface = body_surface(outer, unit, digest)
    points, triangles = read_triangles(content("interface_file", path), path)
    above, same = read_triangles(content("file", outer), outer)
    if points.shape != above.shape or not np.array_equal(triangles, same):
        raise ConfigError(
            f"geometry.interface_file ({Path(path).name}) has {points.shape[0]} points and "
            f"{triangles.shape[0]} triangles, and not the same triangles as geometry.file, which has "
            f"{above.shape[0]} and {same.shape[0]}.",
            "Give both surfaces with the same points in the same order, as FreeSurfer's pial and white are, "
            "or leave geometry.interface_file out.",
        )
    if not np.isfinite(points).all():
        raise ConfigError(
            f"geometry.interface_file ({Path(path).name}) has coordinates that are not finite numbers.",
            "Save it again from the program that made it.",
        )
    found = np.asarray(points[surface.source] * UNITS[unit])
    size = float(np.ptp(surface.points, axis=0).max())
    same_place = np.flatnonzero(np.linalg.norm(found - surface.points, axis=1) < _COINCIDENT * size)
    if same_place.size:
        where = ", ".join(f"{x:.4g}" for x in surface.points[same_place[0]])
        raise ConfigError(
            f"geometry.interface_file ({Path(path).name}) and geometry.file coincide at {same_place.size} "
            f"points, first at ({where}) mm: there is no cortex.",
            "Give an interface that lies below the surface everywhere; FreeSurfer's white and pial coincide "
            "where there is no cortex, on the medial wall: move them apart there, or leave "
            "geometry.interface_file out.",
        )
    return found


@lru_cache(maxsize=8)
def _read(path: str, unit: str, _digest: str, key: str) -> TriangleSurface:
    points, triangles = read_triangles(content(key, path), path)
    points = points * UNITS[unit]
    name = f"geometry.{key} ({Path(path).name})"
    used = points[np.unique(triangles)]
    if np.isfinite(used).all():
        require_size(float(np.ptp(used, axis=0).max()), unit, name)
    return closed_surface(points, triangles, name)


def require_size(size: float, unit: str, name: str) -> None:
    """A size that no body has comes from a wrong unit."""
    if SMALLEST <= size <= LARGEST:
        return
    plain = size / UNITS[unit]
    fitting = [other for other, factor in UNITS.items() if SMALLEST <= plain * factor <= LARGEST]
    nearest = sorted(fitting, key=lambda other: abs(np.log(plain * UNITS[other] / 60.0)))
    advice = (
        f'Try geometry.unit = "{nearest[0]}": it is then {plain * UNITS[nearest[0]]:.3g} mm long.'
        if nearest
        else "No unit makes it a body of 1 to 500 mm: check the file."
    )
    raise ConfigError(
        f'{name} is {size:.3g} mm long with geometry.unit = "{unit}"; bodies of 1 to 500 mm are meshed.',
        advice,
    )
