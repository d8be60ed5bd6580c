"""Mapped elliptic ring: the paper's brain slice, grey on the outside, white inside, a hole in the middle."""

from __future__ import annotations

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.grading import Grading, layer_fractions
from gyrify.mesh.mesh import GREY, WHITE, FloatArray, Mesh
from gyrify.mesh.quality import require_quality
from gyrify.mesh.split import Split, split_quadrilaterals


def elliptic_ring(
    semi_axes: tuple[float, float],
    hole_fraction: float,
    cortical_thickness: float,
    n_around: int,
    n_layers: int,
    n_cortex_layers: int,
    grading: Grading = "geometric",
    split: Split = "alternating",
    node_jitter: float = 0.0,
    seed: int = 0,
) -> Mesh:
    """Mesh a ring between the ellipses (h a, h b) and (a, b) with the interface on (a - T, b - T).

    Parameters
    ----------
    semi_axes : (float, float)
        Outer semi-axes a, b [mm].
    hole_fraction : float
        Semi-axes of the clamped hole over those of the contour, h.
    cortical_thickness : float
        Thickness T of the grey layer [mm].
    n_around, n_layers, n_cortex_layers : int
        Quadrilaterals around, across, and across the grey layer; each is split into two triangles.
    grading : {"geometric", "uniform"}
        Thickness of the white layers; geometric starts at the thickness of a grey layer.
    split : {"alternating", "one", "random"}
        Which diagonal splits each quadrilateral.
    node_jitter : float
        Largest random shift of a point over its local layer thickness. Points of the contour, the
        interface and the hole slide along their ellipse, so that these lines stay exact.
    seed : int
        Seed of the jitter and of the random split.

    Returns
    -------
    Mesh

    Raises
    ------
    MeshError
        If no white matter is left, or a cell would be a sliver.
    """
    a, b = semi_axes
    T = cortical_thickness
    wall = min(a, b) * (1.0 - hole_fraction)
    if not 0.0 < T < wall:
        raise MeshError(
            f"geometry.cortical_thickness = {T:g} mm leaves no white matter: the wall is {wall:.4g} mm.",
            f"Choose a thickness between 0 and {0.95 * wall:.4g} mm.",
        )
    mean_wall = np.sqrt(a * b) * (1.0 - hole_fraction)
    white = layer_fractions(n_layers - n_cortex_layers, T / n_cortex_layers / (mean_wall - T), grading)
    depth = np.concatenate([white, 1.0 + np.linspace(0.0, 1.0, n_cortex_layers + 1)[1:]])
    angle = 2.0 * np.pi * np.arange(n_around) / n_around
    depth, angle = np.broadcast_arrays(depth[:, None], angle[None, :])
    rng = np.random.default_rng(seed)
    depth, angle = _jittered(
        depth, angle, n_layers - n_cortex_layers, node_jitter, rng, (a, b), T, hole_fraction
    )

    points = _map_to_ring(depth, angle, (a, b), hole_fraction, T)
    cells, layer = split_quadrilaterals(n_around, n_layers, split, rng, closed=True)
    layers = np.arange((n_layers + 1) * n_around).reshape(n_layers + 1, n_around)
    mesh = Mesh(
        points=points,
        cells=cells,
        region=np.where(layer >= n_layers - n_cortex_layers, GREY, WHITE).astype(np.int8),
        contour=layers[-1].copy(),
        interface=layers[n_layers - n_cortex_layers].copy(),
        clamped=layers[0].copy(),
        across=_ellipse_normals(points[cells].mean(axis=1), (a, b)),
    )
    require_quality(mesh)
    return mesh


def _map_to_ring(
    depth: FloatArray, angle: FloatArray, semi_axes: tuple[float, float], hole_fraction: float, T: float
) -> FloatArray:
    """Points of depth 0 (hole) to 1 (interface) to 2 (contour) at an eccentric angle."""
    a, b = semi_axes
    white, grey = np.minimum(depth, 1.0), np.maximum(depth - 1.0, 0.0)
    along_a = hole_fraction * a + white * (a - T - hole_fraction * a) + grey * T
    along_b = hole_fraction * b + white * (b - T - hole_fraction * b) + grey * T
    return np.stack([along_a * np.cos(angle), along_b * np.sin(angle)], axis=-1).reshape(-1, 2)


def _jittered(
    depth: FloatArray,
    angle: FloatArray,
    interface_row: int,
    node_jitter: float,
    rng: np.random.Generator,
    semi_axes: tuple[float, float],
    T: float,
    hole_fraction: float,
) -> tuple[FloatArray, FloatArray]:
    """Shift each point by up to ``node_jitter`` of its thinner neighbouring layer, in both directions."""
    noise = rng.uniform(-1.0, 1.0, size=(2, *depth.shape))
    if node_jitter == 0.0:
        return depth, angle
    steps = np.diff(depth[:, 0])
    local = np.minimum(np.concatenate([steps[:1], steps]), np.concatenate([steps, steps[-1:]]))[:, None]
    fixed_rows = [0, interface_row, depth.shape[0] - 1]
    radial = node_jitter * local * noise[0]
    radial[fixed_rows] = 0.0
    mean_radius = np.sqrt(semi_axes[0] * semi_axes[1])
    unit = np.where(depth[:, :1] < 1.0, mean_radius * (1.0 - hole_fraction) - T, T)
    return depth + radial, angle + node_jitter * local * unit / mean_radius * noise[1]


def _ellipse_normals(points: FloatArray, semi_axes: tuple[float, float]) -> FloatArray:
    """Unit outward normals of the ellipses, similar to the contour, through the points."""
    normal = points / np.square(semi_axes)
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))
