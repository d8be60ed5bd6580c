r"""Resistance to the inversion of curved cells, where their integration points do not feel it.

.. math::
   E(u) = k_r \sum_c A_c \sum_k b(D_{ck} / d_0), \quad d_0 = 2 A_c m_0, \quad
   b(s) = -(s - 1)^2 \ln s \; (s < 1), \; 0 \text{ otherwise}

with the reference area A_c and the Bernstein coefficients D_ck of det(dx/dxi) on the four triangles between
the corners and the middles of the sides of a cell, which are bounds of it (see `gyrify.energy.bernstein`): it
is nothing as long as no part of a cell has shrunk below m_0 of its reference size, and infinite before a part
of it vanishes. All coefficients have their share, since the least of them alone has kinks, on which Newton's
method comes to a halt. It is to cells what `gyrify.energy.contact` is to the contour.
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
        scale = 1.0 / (ACTIVATION * 2.0 * self.curved.areas[near])
        s = scale[:, None] * coefficients(x)
        acts = ~(s.min(axis=1, initial=1.0) >= 1.0)
        near, x, s, scale = near[acts], x[acts], s[acts], scale[acts]
        gradient = np.zeros_like(u) if order >= 1 else None
        if not near.size:
            return Evaluation(0.0, gradient, self._no_hessian if order >= 2 else None)
        if not s.min() > 0.0:
            return Evaluation(np.inf)
        weight, log, below = self.stiffness * self.curved.areas[near][:, None], np.log(s), s < 1.0
        value = -float(np.sum(np.where(below, weight * (s - 1.0) ** 2 * log, 0.0)))
        if gradient is None:
            return Evaluation(value)
        slope = np.where(below, weight * (-2.0 * (s - 1.0) * log - (s - 1.0) ** 2 / s), 0.0) * scale[:, None]
        changes = coefficient_slopes(x)
        np.add.at(gradient, self.curved.cells[near], np.einsum("nk,nkai->nai", slope, changes))
        if order < 2:
            return Evaluation(value, gradient)
        bend = -2.0 * log - 4.0 * (s - 1.0) / s + (s - 1.0) ** 2 / s**2
        bend = np.where(below, weight * bend, 0.0) * scale[:, None] ** 2
        changes = changes.reshape(-1, FORMS.shape[0], 12)
        matrices = np.einsum("nk,nkp,nkq->npq", bend, changes, changes, optimize=True)
        matrices += np.einsum("nk,kab,ij->naibj", slope, FORMS, _TURN).reshape(-1, 12, 12)
        if project_psd:
            lengths, axes = np.linalg.eigh(matrices)
            matrices = np.einsum("cik,ck,cjk->cij", axes, np.maximum(lengths, 0.0), axes)
        return Evaluation(value, gradient, self._hessian(near, matrices))

    def _hessian(self, acting: IntArray, matrices: FloatArray) -> Hessian:
        p, q = np.triu_indices(matrices.shape[1])
        values = np.zeros(self.pattern.pattern.rows.size)
        places = self.pattern.position[self._first_point[acting], : p.size]
        np.add.at(values, places, matrices[:, p, q])
        return Hessian(self.pattern.pattern, values)

    def max_step(self, u: FloatArray, du: FloatArray) -> float:  # noqa: ARG002
        """No limit: the elastic energy of the same cells has it."""
        return 1.0


def node_slopes(L: FloatArray) -> FloatArray:
    """(..., 6, 2) dN_a / dxi at (..., 3) area coordinates, in which they are affine."""
    corners = (4.0 * L - 1.0)[..., None] * _SLOPES
    between = [4.0 * (L[..., a, None] * _SLOPES[b] + L[..., b, None] * _SLOPES[a]) for a, b in _EDGES]
    return np.concatenate([corners, np.stack(between, axis=-2)], axis=-2)


def _forms() -> FloatArray:
    """(15, 6, 6) antisymmetric forms K of the coefficients, D_k = sum_ab x_a K_kab y_b of the nodes (x, y).

    The coefficient of two corners V and W of a small triangle is the polar form of the determinant there.
    """
    corners = np.eye(3)
    middles = [0.5 * (corners[a] + corners[b]) for a, b in _EDGES]
    halves = [(corners[n], middles[m]) for m, edge in enumerate(_EDGES) for n in edge]
    within = [(middles[a], middles[b]) for a, b in _EDGES]
    found = []
    for V, W in [(L, L) for L in (*corners, *middles)] + halves + within:
        v, w = node_slopes(V), node_slopes(W)
        half = 0.5 * (np.outer(v[:, 0], w[:, 1]) + np.outer(w[:, 0], v[:, 1]))
        found.append(half - half.T)
    return np.array(found)


FORMS: Final = _forms()
_TURN: Final = np.array([[0.0, 1.0], [-1.0, 0.0]])


def coefficients(x: FloatArray) -> FloatArray:
    """(n, 15) Bernstein coefficients of det(dx/dxi) of cells with (n, 6, 2) nodes."""
    return np.asarray(np.einsum("na,kab,nb->nk", x[:, :, 0], FORMS, x[:, :, 1], optimize=True))


def coefficient_slopes(x: FloatArray) -> FloatArray:
    """(n, 15, 6, 2) derivatives of the coefficients by the nodes."""
    return np.asarray(np.einsum("kab,ij,nbj->nkai", FORMS, _TURN, x, optimize=True))
