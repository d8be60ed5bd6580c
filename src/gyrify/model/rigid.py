"""Rigid motions of a body, and the fewest supports that prevent them."""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.energy.term import FloatArray, IntArray

# Parts by which two candidates are told apart: less is rounding, and the first one is taken.
_TIE: Final = 1e-9
# Rigid motions that move held points by less than this part of the others do not move them.
_HELD: Final = 1e-9


def rigid_modes(points: FloatArray) -> FloatArray:
    """(n_dofs, n) translations and infinitesimal rotations about the middle of (n_points, n_dim) points.

    Three in the plane, six in space; rotations are over the size of the body, so that all have the unit of
    translations.
    """
    n_points, n_dim = points.shape
    x = points - points.mean(axis=0)
    x = x / np.abs(x).max()
    modes = [np.tile(axis, n_points) for axis in np.eye(n_dim)]
    for i in range(n_dim):
        for j in range(i + 1, n_dim):
            turn = np.zeros_like(x)
            turn[:, i], turn[:, j] = -x[:, j], x[:, i]
            modes.append(turn.ravel())
    return np.stack(modes, axis=1)


def kept_modes(modes: FloatArray, held: IntArray) -> FloatArray:
    """(n_dofs, k) rigid motions, of those given, that leave some degrees of freedom where they are."""
    _, size, right = np.linalg.svd(modes[held], full_matrices=True)
    rank = int(np.count_nonzero(size > _HELD * size[0]))
    found = modes @ right[rank:].T
    # exactly, not but for rounding
    found[held] = 0.0
    return np.asarray(found)


def isostatic_supports(modes: FloatArray) -> IntArray:
    """Degrees of freedom, in order, that prevent (n_dofs, n) rigid motions and no deformation.

    Each is where the rigid motions that those before it have left move most.
    """
    left = modes
    chosen = []
    for _ in range(left.shape[1]):
        size = np.einsum("ij,ij->i", left, left)
        chosen.append(int(np.argmax(size > (1.0 - _TIE) * size.max())))
        row = left[chosen[-1]] / np.sqrt(size[chosen[-1]])
        left = left - np.einsum("ij,j->i", left, row)[:, None] * row
    return np.sort(np.array(chosen, dtype=np.int64))
