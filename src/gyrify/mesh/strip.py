"""Strip: a grey film on a deep white substrate, periodic along x, clamped below and free above."""

from __future__ import annotations

import numpy as np

from gyrify.errors import MeshError
from gyrify.mesh.grading import Grading, layer_fractions
from gyrify.mesh.mesh import GREY, WHITE, FloatArray, Mesh
from gyrify.mesh.quality import require_quality
from gyrify.mesh.split import Split, split_quadrilaterals


def periodic_strip(
    length: float,
    depth: float,
    cortical_thickness: float,
    n_around: int,
    n_layers: int,
    n_cortex_layers: int,
    grading: Grading = "geometric",
    split: Split = "alternating",
    node_jitter: float = 0.0,
    seed: int = 0,
) -> Mesh:
    """Mesh the rectangle 0 <= x < length, 0 <= y <= depth, with the interface at y = depth - T.

    The last column of cells joins the first column of points again, one period further. The contour
    y = depth and the interface run towards +x; the outward direction is +y.

    Parameters
    ----------
    length : float
        Period in x [mm].
    depth : float
        Height of the contour above the clamped line [mm], cortex included.
    cortical_thickness : float
        Thickness T of the grey layer [mm].
    n_around, n_layers, n_cortex_layers : int
        Quadrilaterals along the period, across, and across the grey layer; each is split into two triangles.
        An odd ``n_around`` breaks the alternating split at the seam.
    grading : {"geometric", "uniform"}
        Thickness of the white layers; geometric starts at the thickness of a grey layer.
    split : {"alternating", "one", "random"}
        Which diagonal splits each quadrilateral.
    node_jitter : float
        Largest random shift of a point over its thinner neighbouring layer or, if smaller, over the width of
        a column. Points of the contour, the interface and the clamped line slide along x only.
    seed : int
        Seed of the jitter and of the random split.

    Returns
    -------
    Mesh
        Open (``is_closed`` is false), with ``period`` equal to the length.

    Raises
    ------
    MeshError
        If no white matter is left, or a cell would be a sliver.
    """
    T = cortical_thickness
    if not 0.0 < T < depth:
        raise MeshError(
            f"geometry.cortical_thickness = {T:g} mm leaves no white matter in {depth:.4g} mm.",
            f"Choose a thickness between 0 and {0.95 * depth:.4g} mm, or a larger geometry.depth.",
        )
    n_white = n_layers - n_cortex_layers
    white = layer_fractions(n_white, T / n_cortex_layers / (depth - T), grading)
    grey = np.linspace(0.0, 1.0, n_cortex_layers + 1)[1:]
    levels = np.concatenate([white * (depth - T), depth - T + grey * T])
    rng = np.random.default_rng(seed)
    points = _points(levels, length, n_around, n_white, node_jitter, rng)
    cells, layer = split_quadrilaterals(n_around, n_layers, split, rng, closed=True)
    layers = np.arange((n_layers + 1) * n_around).reshape(n_layers + 1, n_around)
    mesh = Mesh(
        points=points,
        # The ring's layers run counter-clockwise, with the outside on the right; here it is on the left.
        cells=np.ascontiguousarray(cells[:, [0, 2, 1]]),
        region=np.where(layer >= n_white, GREY, WHITE).astype(np.int8),
        contour=layers[-1].copy(),
        interface=layers[n_white].copy(),
        clamped=layers[0].copy(),
        across=np.tile([0.0, 1.0], (cells.shape[0], 1)),
        is_closed=False,
        period=length,
    )
    require_quality(mesh, advice=_advice(length / n_around, np.diff(levels)))
    return mesh


def _points(
    levels: FloatArray,
    length: float,
    n_around: int,
    interface_row: int,
    node_jitter: float,
    rng: np.random.Generator,
) -> FloatArray:
    """Grid points, layer by layer from below, shifted by up to ``node_jitter``."""
    x, y = np.meshgrid(length * np.arange(n_around) / n_around, levels)
    noise = rng.uniform(-1.0, 1.0, size=(2, *x.shape))
    if node_jitter > 0.0:
        steps = np.diff(levels)
        local = np.minimum(np.concatenate([steps[:1], steps]), np.concatenate([steps, steps[-1:]]))[:, None]
        upwards = node_jitter * local * noise[0]
        upwards[[0, interface_row, levels.size - 1]] = 0.0
        x = x + node_jitter * np.minimum(local, length / n_around) * noise[1]
        y = y + upwards
    return np.stack([x, y], axis=-1).reshape(-1, 2)


def _advice(column: float, layers: FloatArray) -> str:
    """What to change where columns are too wide for the thinnest layer or too narrow for the thickest."""
    if column / layers.min() >= layers.max() / column:
        return (
            f"Columns {column:.3g} mm wide are too wide for layers of {layers.min():.3g} mm: raise "
            "mesh.n_around, or lower geometry.length, mesh.n_layers or mesh.n_cortex_layers."
        )
    return (
        f"Columns {column:.3g} mm wide are too narrow for layers of {layers.max():.3g} mm: lower "
        "mesh.n_around or geometry.depth, or raise geometry.length or mesh.n_layers."
    )
