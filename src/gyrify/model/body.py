"""What the tissue of a configuration is made of at each point: its growth and its material."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gyrify.config import Config
from gyrify.energy.element import quadratic_values
from gyrify.energy.term import FloatArray, IntArray
from gyrify.mesh import GREY, Mesh
from gyrify.mesh.shapes import SolidShape, shape_of
from gyrify.physics.growth import Growth
from gyrify.physics.materials import Material, material_named

# Width of the sigmoid profile over T where none is given.
TRANSITION: Final = 0.1


@dataclass(frozen=True, eq=False)
class Places:
    """Where the integration points of a body are.

    Attributes
    ----------
    grey : (n,) bool array
        Where there is grey matter.
    across : (n, n_dim) float array
        Unit reference direction across the layers.
    along, depth : (n,) float array
        Position along the layers, 0 to 1 and round again, and across them: 0 on the clamped side, 1 on the
        interface, 2 on the contour [-]; NaN where the mesh has none.
    """

    grey: NDArray[np.bool_]
    across: FloatArray
    along: FloatArray
    depth: FloatArray

    @staticmethod
    def of(mesh: Mesh, cell: IntArray) -> Places:
        """Middles of the cells about the integration points."""
        along, depth = mesh.middles
        return Places(mesh.region[cell] == GREY, np.asarray(mesh.across[cell]), along[cell], depth[cell])

    @staticmethod
    def within(mesh: Mesh, cell: IntArray, shape: SolidShape) -> Places:
        """Integration points of quadratic tetrahedra; directions across curved layers differ in a cell."""
        values = quadratic_values(mesh.n_dim)
        points = np.einsum("qa,cai->cqi", values, mesh.cell_points).reshape(-1, mesh.n_dim)
        depth = (mesh.depth[mesh.cells] @ values.T).ravel()
        grey, nowhere = mesh.region[cell] == GREY, np.full(cell.size, np.nan)
        return Places(grey, shape.normals(points, depth), nowhere, depth)


def growth_of(config: Config, places: Places) -> Growth:
    """Growth of the points of a body."""
    growth, grey = config.growth, places.grey
    if growth.profile == "sigmoid":
        share = cortical_share(config, places)
        rate = growth.rate_white + (growth.rate - growth.rate_white) * share
        tangential = np.full(grey.shape, growth.is_tangential)
        rate_across: FloatArray | float = growth.rate_white * (1.0 - share)
    else:
        rate, tangential = np.where(grey, growth.rate, growth.rate_white), grey & growth.is_tangential
        rate_across = 0.0
    return Growth(
        rate=rate,
        tangential=tangential,
        across=places.across,
        law=growth.stretch,
        out_of_plane_rule=growth.out_of_plane,
        exponent=growth.out_of_plane_exponent,
        rate_across=rate_across,
    )


def cortical_share(config: Config, places: Places) -> FloatArray:
    """(n,) part m of the cortex' growth that a sigmoid profile gives to each point, 0 to 1.

    m = 1 / (1 + exp((d - T) / w)) with the depth d below the contour or outer surface in the reference state
    (Tallinen et al. 2016, Nature Physics 12, 588, with w = T / 10).
    """
    T = config.geometry.cortical_thickness
    width = config.growth.transition or TRANSITION * T
    white = shape_of(config.geometry).wall[0]
    below = T * (1.0 - np.maximum(places.depth - 1.0, 0.0)) + white * np.maximum(1.0 - places.depth, 0.0)
    # beyond 700 widths exp overflows, and the share is 0 anyway
    return np.asarray(1.0 / (1.0 + np.exp(np.minimum((below - T) / width, 700.0))))


def parameters_of(config: Config, places: Places) -> FloatArray:
    """(n_parameters, n) parameters of the material at each point."""
    grey, given, law = places.grey, config.material, material_of(config)
    stiff = law.parameters(given.young_modulus, given.poisson_ratio)
    soft = law.parameters(given.young_modulus_white, given.poisson_ratio_white)
    return np.stack([np.where(grey, g, w) for g, w in zip(stiff, soft, strict=True)])


def material_of(config: Config) -> Material:
    """The material of a configuration."""
    return material_named(config.material.law)
