"""Shapes, once each: a file that says where the places of a wall are, and its line in this list."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from gyrify.mesh.shapes.ellipse import Ellipse
from gyrify.mesh.shapes.ellipsoid import Ellipsoid
from gyrify.mesh.shapes.patch import Patch
from gyrify.mesh.shapes.shape import Shape
from gyrify.mesh.shapes.solid import SolidShape
from gyrify.mesh.shapes.strip import PeriodicStrip
from gyrify.mesh.shapes.surface_body import SurfaceBody
from gyrify.mesh.shapes.volume_body import VolumeBody

__all__ = [
    "SHAPES",
    "Ellipse",
    "Ellipsoid",
    "Patch",
    "PeriodicStrip",
    "Shape",
    "SolidShape",
    "SurfaceBody",
    "VolumeBody",
    "shape_of",
]

AnyShape = Shape | SolidShape | SurfaceBody | VolumeBody


def _ellipse(geometry: Any) -> Ellipse:
    return Ellipse(geometry.outer_axes, geometry.hole_fraction, geometry.cortical_thickness)


def _strip(geometry: Any) -> PeriodicStrip:
    return PeriodicStrip(geometry.length, geometry.depth, geometry.cortical_thickness)


def _ellipsoid(geometry: Any) -> Ellipsoid:
    return Ellipsoid(geometry.outer_axes, geometry.hole_fraction, geometry.cortical_thickness)


def _patch(geometry: Any) -> Patch:
    return Patch(geometry.length, geometry.width, geometry.depth, geometry.cortical_thickness)


def _surface(geometry: Any) -> SurfaceBody:
    outer, hole = geometry.surface, geometry.hole_surface
    return SurfaceBody(
        outer.points,
        outer.triangles,
        geometry.cortical_thickness,
        geometry.mean_radius,
        None if hole is None else (hole.points, hole.triangles),
        geometry.interface_points,
    )


def _volume(geometry: Any) -> VolumeBody:
    volume = geometry.volume
    return VolumeBody(
        volume.points, volume.cells, volume.grey, geometry.cortical_thickness, geometry.mean_radius
    )


# By the value of ``geometry.shape``: what makes the shape of that section of a configuration.
SHAPES: Final[dict[str, Callable[[Any], AnyShape]]] = {
    "ellipse": _ellipse,
    "circle": _ellipse,
    "strip": _strip,
    "sphere": _ellipsoid,
    "ellipsoid": _ellipsoid,
    "patch": _patch,
    "surface": _surface,
    "volume": _volume,
}


def shape_of(geometry: Any) -> AnyShape:
    """The shape of a section ``geometry`` of a configuration.

    Raises
    ------
    MeshError
        If there is no such body.
    """
    return SHAPES[geometry.shape](geometry)
