"""Elastic deformation gradient of each cell as an affine function of the displacements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gyrify.energy.kernels import elastic_kernels
from gyrify.energy.term import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Simplices:
    """Cells with d + 1 nodes and the gradients of their linear shape functions.

    Attributes
    ----------
    cells : (n_cells, n_nodes) int array
        Point indices.
    gradients : (n_cells, n_nodes, n_dim) float array
        dN_a / dX [1/mm].
    volumes : (n_cells,) float array
        Reference volume, an area in the plane [mm^2].
    n_points : int
        Number of points of the mesh.
    """

    cells: IntArray
    gradients: FloatArray
    volumes: FloatArray
    n_points: int

    @staticmethod
    def of(cell_points: FloatArray, cells: IntArray, n_points: int) -> Simplices:
        """Simplices from their (n_cells, n_dim + 1, n_dim) corner coordinates [mm]."""
        n_dim = cell_points.shape[2]
        edges = np.swapaxes(cell_points[:, 1:] - cell_points[:, :1], 1, 2)
        inner = np.linalg.inv(edges)
        gradients = np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1)
        volumes = np.linalg.det(edges) / float(np.prod(np.arange(1, n_dim + 1)))
        return Simplices(cells, np.ascontiguousarray(gradients), volumes, n_points)

    def volume_ratio(self, u: FloatArray) -> FloatArray:
        """(n_cells,) in-plane det F of a state u [mm]."""
        n_cells, n_nodes, n_dim = self.gradients.shape
        ratio = np.empty(n_cells)
        elastic_kernels(n_dim, n_nodes).volume_ratio(u, self.cells, self.gradients, ratio)
        return ratio


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
    """

    cells: IntArray
    base: FloatArray
    gradients: FloatArray
    f33: FloatArray
    J_g: FloatArray
    volumes: FloatArray
    n_points: int

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
        elastic_kernels(n_dim, n_nodes).grow(F_g, simplices.gradients, base, gradients, det)
        return ElasticKinematics(
            cells=simplices.cells,
            base=base,
            gradients=gradients,
            f33=F33 / F_g33,
            J_g=det * F_g33,
            volumes=simplices.volumes,
            n_points=simplices.n_points,
        )

    def deformation(self, u: FloatArray) -> FloatArray:
        """(n_cells, n_dim, n_dim) elastic deformation gradients in the plane of a state u [mm]."""
        return np.asarray(self.base + np.einsum("cai,caj->cij", u[self.cells], self.gradients))
