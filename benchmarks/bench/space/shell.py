"""Tetrahedral meshes of half a thick-walled ellipsoid, and the tangent of gyrify's own energy on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.term import FloatArray, IntArray
from gyrify.physics.materials.neo_hookean import lame_parameters

# Semi-axes of the outer surface [mm], the hole as a fraction of them, and the tissue of `reference-slice`.
SEMI_AXES = np.array([39.4, 32.9, 32.9])
HOLE = 0.5
YOUNG_MODULUS, POISSON_RATIO = 9210.87, 0.458


@dataclass(frozen=True, eq=False)
class Shell:
    """A mesh; the inner surface is clamped.

    Attributes
    ----------
    points : (n_points, 3) float array
        Coordinates [mm].
    cells : (n_cells, 4) int array
        Positively oriented tetrahedra.
    inner : (n_inner,) int array
        Points of the inner surface.
    n_outer : int
        Number of points of the outer surface.
    """

    points: FloatArray
    cells: IntArray
    inner: IntArray
    n_outer: int


def half_ellipsoid(n: int) -> Shell:
    """Shell of 9 n^3 tetrahedra: half a cube's surface blown up to half an ellipsoid, in n / 2 layers.

    Parameters
    ----------
    n : int
        Cells along an edge of the cube, even.
    """
    lattice, triangles = _half_cube(n)
    # equal angles, so that cells in the middle of a face and at its edges are about as large
    directions = np.tan(0.25 * np.pi * lattice)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    depth, n_surface = np.linspace(HOLE, 1.0, n // 2 + 1), lattice.shape[0]
    points = (depth[:, None, None] * directions * SEMI_AXES).reshape(-1, 3)
    below = (triangles + n_surface * np.arange(n // 2)[:, None, None]).reshape(-1, 3)
    return Shell(points, _prisms_split(below, n_surface, points), np.arange(n_surface), n_surface)


def _half_cube(n: int) -> tuple[FloatArray, IntArray]:
    """Points in [-1, 1]^2 x [0, 1] and triangles of the top and the upper half of the four sides."""
    quads = []
    for axis in range(3):
        first, second = [k for k in range(3) if k != axis]
        i, j = np.meshgrid(np.arange(-n, n, 2), np.arange(-n if axis == 2 else 0, n, 2), indexing="ij")
        for side in (n,) if axis == 2 else (-n, n):
            corners = np.empty((i.size, 4, 3), dtype=np.int64)
            corners[:, :, axis] = side
            corners[:, :, first] = i.ravel()[:, None] + [0, 2, 2, 0]
            corners[:, :, second] = j.ravel()[:, None] + [0, 0, 2, 2]
            quads.append(corners)
    lattice, number = np.unique(np.concatenate(quads).reshape(-1, 3), axis=0, return_inverse=True)
    corner = number.reshape(-1, 4)
    return lattice / n, np.concatenate([corner[:, [0, 1, 2]], corner[:, [0, 2, 3]]])


def _prisms_split(below: IntArray, n_surface: int, points: FloatArray) -> IntArray:
    """Three tetrahedra for each prism; the diagonal of a side starts below at its lower number."""
    a, b, c = np.sort(below, axis=1).T
    above = (a + n_surface, b + n_surface, c + n_surface)
    cells = np.concatenate(
        [np.stack(nodes, axis=1) for nodes in ((a, b, c, above[2]), (a, b, *above[1:]), (a, *above))]
    )
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    flipped = np.linalg.det(edges) < 0.0
    cells[flipped] = cells[flipped][:, [0, 1, 3, 2]]
    return cells


class Tangent:
    """Energy of a shell at rest, and its stiffness without the clamped points.

    Parameters
    ----------
    shell : Shell
        The mesh.
    """

    def __init__(self, shell: Shell) -> None:
        simplices = Simplices.of(shell.points[shell.cells], shell.cells, shell.points.shape[0])
        n_cells = shell.cells.shape[0]
        moduli = np.stack([np.full(n_cells, m) for m in lame_parameters(YOUNG_MODULUS, POISSON_RATIO)])
        F_g = np.broadcast_to(np.eye(3), (n_cells, 3, 3)).copy()
        kinematics = ElasticKinematics.of(simplices, F_g, np.ones(n_cells))
        pattern = CellPattern(shell.cells, 3)
        self.energy = ElasticEnergy(kinematics, moduli, kinematics.volumes * kinematics.J_g, pattern)
        self.u = np.zeros_like(shell.points)
        is_free = np.ones(shell.points.shape, dtype=bool)
        is_free[shell.inner] = False
        self.free = np.flatnonzero(is_free)
        self.points = shell.points

    def upper(self) -> sp.csr_matrix:
        """Upper triangle on the free degrees of freedom, sorted, with its diagonal."""
        hessian = self.energy.evaluate(self.u, 2).hessian
        assert hessian is not None
        pattern, size = hessian.pattern, self.u.size
        whole = sp.csr_matrix((hessian.values, (pattern.rows, pattern.cols)), shape=(size, size))
        free = whole[self.free][:, self.free].tocsr()
        free.sort_indices()
        return free

    def rigid_modes(self) -> FloatArray:
        """(n_free, 6) translations and rotations, the near null space of elasticity."""
        x = self.points - self.points.mean(axis=0)
        modes = np.zeros((*x.shape, 6))
        for k in range(3):
            modes[:, k, k] = 1.0
            modes[:, (k + 1) % 3, 3 + k] = -x[:, (k + 2) % 3]
            modes[:, (k + 2) % 3, 3 + k] = x[:, (k + 1) % 3]
        return modes.reshape(-1, 6)[self.free]
