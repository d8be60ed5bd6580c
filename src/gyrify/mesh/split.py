"""Triangles from a structured sheet of quadrilaterals."""

from __future__ import annotations

from typing import Literal

import numpy as np

from gyrify.mesh.mesh import IntArray

Split = Literal["alternating", "one", "random"]


def split_quadrilaterals(
    n_around: int, n_layers: int, split: Split, rng: np.random.Generator, *, closed: bool
) -> tuple[IntArray, IntArray]:
    """Split each quadrilateral of a sheet along one diagonal.

    Points are numbered along a layer first, layers from the inside out.

    Parameters
    ----------
    n_around, n_layers : int
        Quadrilaterals along and across.
    split : {"alternating", "one", "random"}
        Which diagonal: in a chequerboard, always the same, or drawn for each.
    rng : numpy.random.Generator
        Source of the random split.
    closed : bool
        Whether the last quadrilateral of a layer joins the first point again.

    Returns
    -------
    cells : (2 n_around n_layers, 3) int array
        Counter-clockwise triangles, provided that layers are numbered outwards and points counter-clockwise.
    layer : (2 n_around n_layers,) int array
        Layer of each triangle.
    """
    n_columns = n_around if closed else n_around + 1
    row, column = (index.ravel() for index in np.indices((n_layers, n_around)))
    after = (column + 1) % n_columns
    inner, inner_next = row * n_columns + column, row * n_columns + after
    outer, outer_next = inner + n_columns, inner_next + n_columns
    if split == "alternating":
        falling = (row + column) % 2 == 0
    elif split == "one":
        falling = np.zeros(row.size, dtype=bool)
    else:
        falling = rng.random(row.size) < 0.5
    first = np.where(
        falling[:, None], np.stack([inner, outer, inner_next], 1), np.stack([inner, outer, outer_next], 1)
    )
    second = np.where(
        falling[:, None],
        np.stack([outer, outer_next, inner_next], 1),
        np.stack([inner, outer_next, inner_next], 1),
    )
    cells = np.stack([first, second], axis=1).reshape(-1, 3)
    return cells.astype(np.int64), np.repeat(row, 2)
