"""Meshes: points, cells and named index sets, all frozen."""

from gyrify.mesh.mesh import GREY, WHITE, Mesh

__all__ = ["GREY", "WHITE", "Mesh"]
