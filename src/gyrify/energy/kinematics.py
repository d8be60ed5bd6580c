"""Elastic deformation gradient of each cell as an affine function of the displacements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from gyrify.energy.curved import CurvedCells
from gyrify.energy.element import reference_element
from gyrify.energy.kernels import cell_kernels
from gyrify.energy.term import FloatArray, IntArray

# Of the nodes of quadratic cells, by their number.
_SHARES: Final = {
    6: np.repeat([1 / 12, 1 / 4], 3),
    10: np.concatenate([np.full(4, 1 / 32), np.full(6, 7 / 48)]),
}


@dataclass(frozen=True, eq=False)
class Simplices:
    """Integration points of simplices, each with the nodes of its cell and its share of the volume.

    Linear cells (d + 1 nodes) have one point, quadratic ones with curved edges d + 1 (6 or 10 nodes). All
    that follows is a sum over integration points.

    Attributes
    ----------
    cells : (n, n_nodes) int array
        Point indices of the cell around each integration point.
    gradients : (n, n_nodes, n_dim) float array
        dN_a / dX [1/mm].
    volumes : (n,) float array
        Share of the reference volume, an area in the plane [mm^2].
    cell : (n,) int array
        Cell of each integration point, in order.
    n_points : int
        Number of points of the mesh.
    curved : CurvedCells or None
        What F is like between the integration points; None where it is constant over each cell.
    """

    cells: IntArray
    gradients: FloatArray
    volumes: FloatArray
    cell: IntArray
    n_points: int
    curved: CurvedCells | None = None

    @staticmethod
    def of(cell_points: FloatArray, cells: IntArray, n_points: int) -> Simplices:
        """Integration points of cells with (n_cells, n_nodes, n_dim) node coordinates [mm]."""
        n_cells, n_nodes, n_dim = cell_points.shape
        slopes, weights = reference_element(n_nodes, n_dim)
        mapping = np.einsum("cai,qaj->cqij", cell_points, slopes)
        gradients = np.einsum("qaj,cqji->cqai", slopes, np.linalg.inv(mapping))
        volumes = np.linalg.det(mapping) * weights
        return Simplices(
            cells=np.repeat(cells, weights.size, axis=0),
            gradients=np.ascontiguousarray(gradients.reshape(-1, n_nodes, n_dim)),
            volumes=volumes.ravel(),
            cell=np.repeat(np.arange(n_cells), weights.size),
            n_points=n_points,
            curved=CurvedCells.of(cell_points, cells),
        )

    @property
    def lumped_volumes(self) -> FloatArray:
        """(n_points,) share of the reference volume of each point of the mesh [mm^2].

        A quadratic triangle gives 1/12 to each corner and 1/4 to each node between, a tetrahedron 1/32 and
        7/48: the shares of its parts with half the edges, since the row sums of the mass matrix vanish at
        the corners of a triangle and are negative at those of a tetrahedron.
        """
        shares = _SHARES.get(self.cells.shape[1])
        if shares is None:
            shares = np.full(self.cells.shape[1], 1 / self.cells.shape[1])
        lumped = np.zeros(self.n_points)
        np.add.at(lumped, self.cells, self.volumes[:, None] * shares)
        return lumped

    def cell_means(self, values: FloatArray) -> FloatArray:
        """(n_cells, ...) means over the cells of values at the integration points, weighted by volume."""
        n_cells = int(self.cell[-1]) + 1
        if n_cells == self.cell.size:
            return values
        weighted = values * self.volumes.reshape(-1, *([1] * (values.ndim - 1)))
        sums = np.zeros((n_cells, *values.shape[1:]))
        np.add.at(sums, self.cell, weighted)
        volumes = np.bincount(self.cell, weights=self.volumes)
        return np.asarray(sums / volumes.reshape(-1, *([1] * (values.ndim - 1))))

    def volume_ratio(self, u: FloatArray) -> FloatArray:
        """(n,) in-plane det F of a state u [mm] at the integration points."""
        n_cells, n_nodes, n_dim = self.gradients.shape
        ratio = np.empty(n_cells)
        cell_kernels(n_dim, n_nodes).volume_ratio(u, self.cells, self.gradients, ratio)
        return ratio

    def least_volume_ratio(self, u: FloatArray) -> FloatArray:
        """(n_cells,) least in-plane det F of a state u [mm] over the whole of each cell."""
        return self.volume_ratio(u) if self.curved is None else self.curved.least_ratio(u)

    def first_inverted(self, u: FloatArray) -> int | None:
        """Number of the first cell that is inverted anywhere in it in a state u [mm]; None if none is."""
        if self.curved is not None:
            return self.curved.first_inverted(u)
        inverted = np.flatnonzero(~(self.volumes * self.volume_ratio(u) > 0.0))
        return int(inverted[0]) if inverted.size else None

    def largest_of_cells(self, values: FloatArray) -> FloatArray:
        """(n_cells,) largest of (n,) values at the integration points of each cell."""
        return np.asarray(values.reshape(int(self.cell[-1]) + 1, -1).max(axis=1))


@dataclass(frozen=True, eq=False)
class ElasticKinematics:
    """F_e = F F_g^{-1} of each cell, written as F_e = base + sum_a u_a (x) gradients_a.

    Attributes
    ----------
    cells : (n_cells, n_nodes) int array
        Point indices.
    base : (n_cells, n_dim, n_dim) float array
        F_g^{-1} in the plane: the elastic deformation of the undisplaced, grown cell.
    gradients : (n_cells, n_nodes, n_dim) float array
        Shape-function gradients with respect to the grown configuration [1/mm].
    f33 : (n_cells,) float array
        Out-of-plane elastic stretch F33 / F_g,33; ones in three dimensions.
    J_g : (n_cells,) float array
        det F_g, the 33 entry included.
    volumes : (n_cells,) float array
        Reference volume per unit thickness [mm^2].
    n_points : int
        Number of points of the mesh.
    curved : CurvedCells or None
        As in `Simplices`.
    """

    cells: IntArray
    base: FloatArray
    gradients: FloatArray
    f33: FloatArray
    J_g: FloatArray
    volumes: FloatArray
    n_points: int
    curved: CurvedCells | None = None

    @staticmethod
    def of(simplices: Simplices, F_g: FloatArray, F_g33: FloatArray, F33: float = 1.0) -> ElasticKinematics:
        """Kinematics of grown cells.

        Parameters
        ----------
        simplices : Simplices
            The cells.
        F_g : (n_cells, n_dim, n_dim) float array
            In-plane growth tensor.
        F_g33 : (n_cells,) float array
            Out-of-plane growth; ones in three dimensions.
        F33 : float
            Total out-of-plane stretch, 1 in plane strain.
        """
        n_cells, n_nodes, n_dim = simplices.gradients.shape
        base, gradients, det = np.empty_like(F_g), np.empty_like(simplices.gradients), np.empty(n_cells)
        cell_kernels(n_dim, n_nodes).grow(F_g, simplices.gradients, base, gradients, det)
        return ElasticKinematics(
            cells=simplices.cells,
            base=base,
            gradients=gradients,
            f33=F33 / F_g33,
            J_g=det * F_g33,
            volumes=simplices.volumes,
            n_points=simplices.n_points,
            curved=simplices.curved,
        )

    def deformation(self, u: FloatArray) -> FloatArray:
        """(n_cells, n_dim, n_dim) elastic deformation gradients in the plane of a state u [mm]."""
        _, n_nodes, n_dim = self.gradients.shape
        F = np.empty_like(self.base)
        cell_kernels(n_dim, n_nodes).deform(u, self.cells, self.base, self.gradients, F)
        return F
