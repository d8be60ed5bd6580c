"""From a configuration to its mesh."""

from __future__ import annotations

from gyrify.config import Config
from gyrify.mesh import Mesh
from gyrify.mesh.ring import elliptic_ring
from gyrify.mesh.sheet import Layers
from gyrify.mesh.strip import periodic_strip


def build_mesh(config: Config) -> Mesh:
    """Mesh of a configuration.

    Raises
    ------
    MeshError
        If the geometry cannot be meshed well.
    """
    geometry, mesh = config.geometry, config.mesh
    layers = Layers(
        n_around=mesh.n_around,
        n_layers=mesh.n_layers,
        n_cortex_layers=mesh.n_cortex_layers,
        grading=mesh.grading,
        split=mesh.split,
        node_jitter=mesh.node_jitter,
        seed=config.seed,
        element=mesh.element,
        refine=mesh.refine,
        refine_cortex=mesh.refine_cortex,
    )
    if geometry.shape == "strip":
        return periodic_strip(geometry.length, geometry.depth, geometry.cortical_thickness, layers)
    return elliptic_ring(geometry.semi_axes, geometry.hole_fraction, geometry.cortical_thickness, layers)
