"""Small closed surfaces, written to files by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from gyrify.config import Config
from gyrify.mesh.nested_surface import icosphere

# As `solids.BALL` and `solids.BRAIN`, without what is a shape's own.
GIVEN: dict[str, Any] = {
    "geometry.shape": "surface",
    "geometry.cortical_thickness": 3.0,
    "mesh.n_cortex_layers": 2,
    "stability.detect": False,
}


def ellipsoid(frequency: int = 5, axes: tuple[float, float, float] = (36.0, 36.0, 36.0)) -> Any:
    """Points and triangles of an ellipsoid, outwards."""
    surface = icosphere(frequency)
    return surface.places * np.array(axes), surface.triangles[-1]


def off(path: Path, points: Any, triangles: Any) -> Path:
    """Write an OFF file."""
    lines = ["OFF", f"{len(points)} {len(triangles)} 0"]
    lines += [" ".join(repr(float(x)) for x in point) for point in points]
    lines += ["3 " + " ".join(str(int(i)) for i in triangle) for triangle in triangles]
    path.write_text("\n".join(lines) + "\n")
    return path


def stl(path: Path, points: Any, triangles: Any) -> Path:
    """Write a binary STL file: every triangle with corners of its own, in single precision."""
    corners = np.asarray(points)[np.asarray(triangles)]
    rows = np.zeros(len(corners), dtype=[("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    rows["p"] = corners
    path.write_bytes(bytes(80) + np.uint32(len(corners)).tobytes() + rows.tobytes())
    return path


def config(path: Path, **overrides: Any) -> Config:
    """A body inside the surface of a file."""
    return Config().with_overrides({**GIVEN, "geometry.file": str(path), **overrides})
