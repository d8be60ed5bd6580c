r"""Resistance to the inversion of curved cells, where their integration points do not feel it.

.. math::
   E(u) = \sum_c A_c \, k_r \; b(m_c / m_0), \quad
   m_c = \min_{\xi \in c} \det \frac{\partial x}{\partial \xi} / 2 A_c, \quad
   b(s) = -(s - 1)^2 \ln s \; (s < 1), \; 0 \text{ otherwise}

with the reference area A_c: nothing as long as no part of a cell has shrunk below m_0 of the cell's reference
area, and infinite where a part of it vanishes. It is to cells what `gyrify.energy.contact` is to the contour.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gyrify.energy.curved import CurvedCells
from gyrify.energy.elastic import CellPattern
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray, Pattern

# Part of its reference size below which a part of a cell resists.
ACTIVATION: Final = 0.2
# Slopes along xi and eta of the area coordinates, and the corners beside each node between.
_SLOPES: Final = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
_EDGES: Final = ((0, 1), (1, 2), (2, 0))


class InversionBarrier:
    """Barrier of one mesh; see the module's equation.

    Parameters
    ----------
    curved : CurvedCells
        The cells.
    stiffness : float
        k_r [Pa].
    pattern : CellPattern
        Sparsity of the mesh, one row of positions per integration point.
    first_point : (n_cells,) int array
        First integration point of each cell.
    """

    is_barrier = True

    def __init__(
        self, curved: CurvedCells, stiffness: float, pattern: CellPattern, first_point: IntArray
    ) -> None:
        self.curved, self.stiffness, self.pattern = curved, stiffness, pattern
        self._first_point = first_point
        none = np.empty(0, dtype=np.int64)
        self._no_hessian = Hessian(Pattern(none, none), np.empty(0))

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^2], gradient [Pa mm], Hessian [Pa]; see `EnergyTerm`."""
        near = self.curved.smaller_than(u, ACTIVATION)
        x = self.curved.points[near] + u[self.curved.cells[near]]
        size = 2.0 * self.curved.areas[near]
        least, place, along = least_place(forms(x))
        acts = ~(least >= ACTIVATION * size)
        gradient = np.zeros_like(u) if order >= 1 else None
        if not acts.any():
            return Evaluation(0.0, gradient, self._no_hessian if order >= 2 else None)
        s = least[acts] / (ACTIVATION * size[acts])
        if not s.min() > 0.0:
            return Evaluation(np.inf)
        weight, log = 0.5 * self.stiffness * size[acts], np.log(s)
        value = -float(np.sum(weight * (s - 1.0) ** 2 * log))
        if gradient is None:
            return Evaluation(value)
        forces, stiffness = derivatives(x[acts], place[acts], along[acts])
        per = 1.0 / (ACTIVATION * size[acts])
        slope = per * weight * (-2.0 * (s - 1.0) * log - (s - 1.0) ** 2 / s)
        np.add.at(gradient, self.curved.cells[near[acts]], (slope[:, None] * forces).reshape(-1, 6, 2))
        if order < 2:
            return Evaluation(value, gradient)
        bend = per**2 * weight * (-2.0 * log - 4.0 * (s - 1.0) / s + (s - 1.0) ** 2 / s**2)
        matrices = slope[:, None, None] * stiffness
        matrices += bend[:, None, None] * forces[:, :, None] * forces[:, None, :]
        if project_psd:
            lengths, axes = np.linalg.eigh(matrices)
            matrices = np.einsum("cik,ck,cjk->cij", axes, np.maximum(lengths, 0.0), axes)
        return Evaluation(value, gradient, self._hessian(near[acts], matrices))

    def _hessian(self, acting: IntArray, matrices: FloatArray) -> Hessian:
        p, q = np.triu_indices(matrices.shape[1])
        values = np.zeros(self.pattern.pattern.rows.size)
        places = self.pattern.position[self._first_point[acting], : p.size]
        np.add.at(values, places, matrices[:, p, q])
        return Hessian(self.pattern.pattern, values)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:  # noqa: ARG002
        """No limit: the elastic energy of the same cells has it."""
        return 1.0


def forms(x: FloatArray) -> FloatArray:
    """(n, 3, 3) forms of det(dx/dxi) in the area coordinates; see `gyrify.energy.bernstein`."""
    xi, eta = (
        np.stack([x.transpose(0, 2, 1) @ node_slopes(corner)[:, axis] for corner in np.eye(3)], axis=1)
        for axis in (0, 1)
    )
    one = xi[:, :, None, 0] * eta[:, None, :, 1] - xi[:, :, None, 1] * eta[:, None, :, 0]
    return np.asarray(0.5 * (one + one.transpose(0, 2, 1)))


def least_place(M: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Least values of forms on the triangle, where, and the direction in which that place is free.

    It is a corner (which is not free), or on a side along which the form is convex. Inside it is never where
    it is positive: a determinant is a difference of two products, whose form has two positive eigenvalues at
    most.

    Parameters
    ----------
    M : (n, 3, 3) float array
        The forms.

    Returns
    -------
    least : (n,) float array
    place, along : (n, 3) float arrays
        Area coordinates, and a change of them.
    """
    values = np.diagonal(M, axis1=1, axis2=2)
    at = values.argmin(axis=1)
    least, place, along = values.min(axis=1), np.eye(3)[at], np.zeros((at.size, 3))
    for a, b in _EDGES:
        bend = M[:, a, a] - 2.0 * M[:, a, b] + M[:, b, b]
        share = np.where(bend > 0.0, M[:, a, a] - M[:, a, b], 0.0) / np.where(bend > 0.0, bend, 1.0)
        value = M[:, a, a] - bend * share**2
        lower = (share > 0.0) & (share < 1.0) & (value < least)
        direction = np.eye(3)[b] - np.eye(3)[a]
        least = np.where(lower, value, least)
        place = np.where(lower[:, None], np.eye(3)[a] + share[:, None] * direction, place)
        along = np.where(lower[:, None], direction, along)
    return least, place, along


def derivatives(x: FloatArray, place: FloatArray, along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First (n, 12) and second (n, 12, 12) derivatives of the least det(dx/dxi) of cells by their nodes.

    The first one is that at a fixed place, since the value does not change along the side; the second has the
    motion of the place in it.
    """
    slopes = node_slopes(place)
    at = np.einsum("cai,caj->cij", x, slopes)
    cross = slopes[:, :, None, 0] * slopes[:, None, :, 1]
    turned = np.array([[0.0, 1.0], [-1.0, 0.0]])
    second = np.einsum("cab,ij->caibj", cross - cross.transpose(0, 2, 1), turned).reshape(-1, 12, 12)
    change = node_slopes(along) - node_slopes(np.zeros(3))
    bend = np.einsum("cai,caj->cij", x, change)
    mixed = _cofactors(change, at) + _cofactors(slopes, bend)
    free = np.asarray(along.any(axis=1))
    convexity = np.where(free, 2.0 * np.linalg.det(bend), 1.0)
    motion = mixed[:, :, None] * mixed[:, None, :] / convexity[:, None, None]
    return _cofactors(slopes, at), second - np.where(free[:, None, None], motion, 0.0)


def node_slopes(L: FloatArray) -> FloatArray:
    """(..., 6, 2) dN_a / dxi at (..., 3) area coordinates, in which they are affine."""
    corners = (4.0 * L - 1.0)[..., None] * _SLOPES
    between = [4.0 * (L[..., a, None] * _SLOPES[b] + L[..., b, None] * _SLOPES[a]) for a, b in _EDGES]
    return np.concatenate([corners, np.stack(between, axis=-2)], axis=-2)


def _cofactors(slopes: FloatArray, at: FloatArray) -> FloatArray:
    """(n, 12) derivative of det(sum_a x_a (x) slopes_a) by x, where that matrix is ``at``."""
    first = slopes[:, :, 0] * at[:, 1, 1, None] - slopes[:, :, 1] * at[:, 1, 0, None]
    second = slopes[:, :, 1] * at[:, 0, 0, None] - slopes[:, :, 0] * at[:, 0, 1, None]
    return np.stack([first, second], axis=2).reshape(-1, 12)
