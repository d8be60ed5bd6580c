"""The sections that say what the body is and how it is divided; units: mm."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Annotated, Final, Literal

from pydantic import Field, model_validator

from gyrify.config.base import Section, setting
from gyrify.config.inputs.named_files import FILE_KEYS, digest
from gyrify.config.registered import Registered
from gyrify.config.small_tables import Labels
from gyrify.errors import ConfigError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from gyrify.config.inputs.body_volume import TetrahedronVolume
    from gyrify.config.inputs.closed_surface import TriangleSurface

PAPER: Final = "Wang 2019"
# Of the standard slice: area inside its contour [mm²] and thickness of its cortex [mm].
STANDARD_AREA: Final = 4069.0
STANDARD_THICKNESS: Final = 1.5


Shape = Annotated[
    str,
    Registered(
        ("ellipse", "circle", "strip", "sphere", "ellipsoid", "patch", "surface", "volume"),
        "gyrify.mesh.shapes",
        lambda module: module.SHAPES,
    ),
]
# Shapes in space; what lies in the plane has no say in them, and they none in it.
IN_SPACE: Final = frozenset({"sphere", "ellipsoid", "patch", "surface", "volume"})
PERIODIC: Final = frozenset({"strip", "patch"})
# Shapes that are read from files.
FROM_FILES: Final = frozenset({"surface", "volume"})
Axis = Annotated[float, Field(gt=0, le=1e5)]


class Geometry(Section):
    """The body: in the plane a hollow ellipse or circle, or a strip that is periodic in x and clamped below;
    in space a sphere or an ellipsoid, solid or hollow, a patch, periodic in x and y and clamped below,
    what is inside a closed surface from a file, or tetrahedra from one."""

    shape: Shape = setting("ellipse", "Shape of the body.", source=f"{PAPER}, Fig. 1")
    area: float = setting(
        STANDARD_AREA,
        "Area inside the outer contour, hole included; ellipse and circle only.",
        unit="mm²",
        source=f"{PAPER}, Fig. 1 (40.69 cm²)",
        gt=0,
        le=1e10,
    )
    aspect_ratio: float = setting(
        1.2,
        "Long over short axis of the ellipse; ignored by other shapes.",
        source=f"{PAPER}, Fig. 1",
        ge=1,
        le=3,
    )
    hole_fraction: float = setting(
        0.5,
        "Axes of the hole over those of the contour or surface, at least 0.1; in space also 0, a solid body. "
        "Ignored by strip and patch.",
        source=f"{PAPER}, Fig. 1",
        ge=0,
        le=0.9,
    )
    cortical_thickness: float = setting(
        STANDARD_THICKNESS,
        "Initial thickness T of the cortex, less than 0.95 of the narrowest wall.",
        unit="mm",
        source=f"{PAPER}, Mathematical Model",
        gt=0,
    )
    length: float = setting(
        40.0, "Period of the strip or the patch in x; ignored by other shapes.", unit="mm", gt=0, le=1e5
    )
    depth: float = setting(
        18.0,
        "Depth of the strip or the patch, cortex included (default: the mean wall of the standard slice).",
        unit="mm",
        gt=0,
        le=1e5,
    )
    width: float = setting(40.0, "Period of the patch in y.", unit="mm", gt=0, le=1e5)
    semi_axes: tuple[Axis, Axis, Axis] = setting(
        (39.4, 32.9, 32.9),
        "Semi-axes of the ellipsoid along x, y and z; a sphere takes the first as its radius.",
        unit="mm",
        strict=False,
    )
    file: str = setting(
        "",
        "Closed surface of triangles (STL, PLY, OFF, OBJ, GIfTI, FreeSurfer), or tetrahedra of a volume "
        "(MESH, VTK, VTU, MSH, INP and others); surface and volume only, which need it. Relative to the "
        "configuration file.",
    )
    hole_file: str = setting("", "Closed surface of a hole in the white matter; surface only.")
    interface_file: str = setting(
        "",
        "Interface under a surface, with the same points and triangles in the same order; without it, it "
        "lies T below the surface.",
    )
    unit: Literal["um", "mm", "cm", "m"] = setting("mm", "Unit of length of the files.")
    labels: Labels = setting(
        Labels(),
        "Labels of a volume's tetrahedra, each a list of whole numbers. Without them tetrahedra are grey by "
        "their depth.",
    )
    digest: str = setting(
        "",
        "SHA-256 of the files. Found when it is not given; if it is, files with another one are refused.",
        pattern="^([0-9a-f]{64})?$",
    )

    @model_validator(mode="after")
    def _read_files(self) -> Geometry:
        """Paths no longer depend on the folder, and the digest is that of the files."""
        if self.shape in FROM_FILES:
            if not self.file:
                what, name = (
                    ("tetrahedra", "brain.mesh") if self.shape == "volume" else ("surface", "surface.stl")
                )
                raise ConfigError(
                    f'geometry.shape = "{self.shape}" is not allowed without geometry.file, the {what}.',
                    f'Try geometry.file = "{name}", relative to the configuration file.',
                )
            paths = {key: os.path.abspath(path) if (path := getattr(self, key)) else "" for key in FILE_KEYS}
            found = digest(paths)
            if self.digest not in ("", found):
                raise ConfigError(
                    "The files that [geometry] names are not those of geometry.digest: they have changed.",
                    "Restore them, or leave geometry.digest out to take them as they are.",
                )
            self.__dict__.update(paths, digest=found)
        return self

    @property
    def surface(self) -> TriangleSurface:
        """Outer surface of a body from a file."""
        from gyrify.config.inputs.body_surface import body_surface

        if self.shape == "volume":
            return self.volume.outer
        return body_surface(self.file, self.unit, self.digest)

    @property
    def hole_surface(self) -> TriangleSurface | None:
        """Surface of its hole; None where there is none."""
        from gyrify.config.inputs.body_surface import body_surface

        if self.shape == "volume":
            return self.volume.hole
        return body_surface(self.hole_file, self.unit, self.digest, "hole_file") if self.hole_file else None

    @property
    def volume(self) -> TetrahedronVolume:
        """Tetrahedra of a body from a file."""
        from gyrify.config.inputs.body_volume import body_volume

        return body_volume(self.file, self.unit, self.digest, self.labels)

    @property
    def interface_points(self) -> NDArray[np.float64] | None:
        """(n_points, 3) points of its interface under those of the surface [mm], from a file; or None."""
        from gyrify.config.inputs.body_surface import matching_points

        if not self.interface_file:
            return None
        return matching_points(self.interface_file, self.file, self.unit, self.digest)

    @property
    def n_dim(self) -> int:
        """Dimension of the space that the body lies in."""
        return 3 if self.shape in IN_SPACE else 2

    @property
    def outer_axes(self) -> tuple[float, ...]:
        """Semi-axes of the outer contour (a, b) or surface (a, b, c) of a body that is not periodic [mm].

        Of a surface from a file, half its sizes along x, y and z.
        """
        if self.shape in FROM_FILES:
            return tuple(float(0.5 * extent) for extent in self.surface.extents)
        if self.shape in IN_SPACE:
            return (self.semi_axes[0],) * 3 if self.shape == "sphere" else self.semi_axes
        ratio = self.aspect_ratio if self.shape == "ellipse" else 1.0
        minor = math.sqrt(self.area / (math.pi * ratio))
        return ratio * minor, minor

    @property
    def mean_radius(self) -> float:
        """Mean radius R = √(ab), or ∛(abc) in space, of a body that is not periodic [mm].

        Inside a surface, that of the ball of equal volume, a hole included.
        """
        if self.shape in FROM_FILES:
            return math.cbrt(self.surface.volume / (4.0 / 3.0 * math.pi))
        if self.shape in IN_SPACE:
            return math.cbrt(math.prod(self.outer_axes))
        return math.sqrt(self.area / math.pi)

    @property
    def drag_length(self) -> float:
        """Length R of the drag number: the mean radius, or the depth of a strip or a patch [mm]."""
        return self.depth if self.shape in PERIODIC else self.mean_radius

    @property
    def scale(self) -> float:
        """Size of the body over that of the standard slice [-]: what lengths of measuring scale with.

        Mean radii. The folds of a strip or a patch know no length but the thickness of its cortex: its depth
        and its periods stand for a body without end.
        """
        if self.shape in PERIODIC:
            return self.cortical_thickness / STANDARD_THICKNESS
        if self.shape in IN_SPACE:
            return self.mean_radius / math.sqrt(STANDARD_AREA / math.pi)
        return math.sqrt(self.area) / math.sqrt(STANDARD_AREA)

    @property
    def narrowest_wall(self) -> float:
        """Smallest distance from the contour or outer surface to the other end of the wall [mm].

        Of a surface, half the smallest size: what no wall exceeds.
        """
        if self.shape in PERIODIC:
            return self.depth
        return min(self.outer_axes) * (1.0 - self.hole_share)

    @property
    def hole_share(self) -> float:
        """Axes of the hole over those of the body; 0 for a surface, whose hole is of any shape."""
        return 0.0 if self.shape in FROM_FILES else self.hole_fraction


class MeshSettings(Section):
    """How the slice is divided into cells."""

    edge_length: float = setting(
        0.0,
        "In space, edge of the triangles on the outer surface; 0: one and a half times T, or those of a "
        "file.",
        unit="mm",
        ge=0,
        le=1e5,
    )
    n_around: int = setting(
        216,
        "Points on the outer contour (along a period of the strip); not used in space.",
        source=f"{PAPER}, Results",
        ge=24,
        le=4096,
    )
    n_layers: int = setting(
        17,
        "Layers from the clamped boundary (or the middle) to the outer contour or surface.",
        source=f"{PAPER}, Results (7344 triangles / 216 / 2)",
        ge=3,
        le=512,
    )
    n_cortex_layers: int = setting(
        6,
        "Layers in the cortex, fewer than n_layers; at least 2 in the plane.",
        source=f"{PAPER}, Results (at least six)",
        ge=1,
        le=511,
    )
    grading: Literal["geometric", "uniform"] = setting(
        "geometric", "White layers: geometric (the first as thick as a cortical one) or uniform."
    )
    split: Literal["alternating", "one", "random", "symmetric"] = setting(
        "alternating",
        "How each quadrilateral is cut into two triangles; symmetric: the mesh and the folds are their own "
        "mirror image.",
    )
    node_jitter: float = setting(
        1e-3,
        "Seeded random shift of the points, as a fraction of the local layer (mirrored: symmetric split).",
        ge=0,
        le=0.1,
    )
    element: Literal["linear", "quadratic", "mean_dilatation"] = setting(
        "linear", "Finite element.", source=f"{PAPER}, Results (3-node triangles)"
    )
    inversion_resistance: float = setting(
        0.0,
        "Stiffness over E_G that keeps quadratic cells from inverting beside integration points; 0: none.",
        ge=0,
        le=10,
    )
    refine: int = setting(0, "Times the whole mesh is refined by halving.", ge=0, le=4)
    refine_cortex: int = setting(0, "Times the cortex alone is refined by halving.", ge=0, le=4)
