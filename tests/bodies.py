"""Small bodies and meshes to test on."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from gyrify.energy.contact import ContactEnergy, ContactSurface
from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.viscous import KelvinVoigtEnergy
from gyrify.mesh import Mesh
from gyrify.mesh.layered import layered_mesh
from gyrify.mesh.layered_grid import Layers
from gyrify.mesh.shapes import Ellipse, PeriodicStrip

MU, KAPPA = 3.0, 20.0


def distorted_square(rng: np.random.Generator, n: int = 6) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, triangles and boundary points of a unit square whose inner points lie anywhere near a grid."""
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, n)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    boundary = np.any((grid == 0) | (grid == 1), axis=1)
    grid[~boundary] += rng.uniform(-0.3, 0.3, (np.count_nonzero(~boundary), 2)) / n
    cells = Delaunay(grid).simplices.astype(np.int64)
    a, b, c = (grid[cells[:, k]] for k in range(3))
    twice_area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    cells[twice_area < 0] = cells[twice_area < 0][:, [0, 2, 1]]
    return grid, cells[np.abs(twice_area) > 1e-9], np.flatnonzero(boundary)


def separate_triangles(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and cells of n triangles that share nothing: their Hessian is a row of 6 x 6 blocks."""
    corners = np.array([[0.0, 0.0], [1.0, 0.1], [0.2, 0.9]]) + rng.uniform(-0.15, 0.15, (n, 3, 2))
    return corners.reshape(-1, 2), np.arange(3 * n).reshape(n, 3)


def random_growth(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Growth of n cells, isotropic for even and tangential for odd ones, with F_g33 between 1 and 2."""
    stretch, angle = rng.uniform(1.0, 1.8, n), rng.uniform(0, 2 * np.pi, n)
    N = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    F_g = stretch[:, None, None] * np.eye(2)
    F_g[1::2] -= ((stretch - 1)[:, None, None] * N[:, :, None] * N[:, None, :])[1::2]
    return F_g, rng.uniform(1.0, 2.0, n)


def kinematics(points, cells, F_g=None, F_g33=None) -> ElasticKinematics:
    """Kinematics of grown cells; without growth by default."""
    n, d = cells.shape[0], points.shape[1]
    F_g = np.broadcast_to(np.eye(d), (n, d, d)) if F_g is None else F_g
    F_g33 = np.ones(n) if F_g33 is None else F_g33
    return ElasticKinematics.of(Simplices.of(points[cells], cells, len(points)), F_g, F_g33)


def elastic(points, cells, F_g=None, F_g33=None, mu=MU, kappa=KAPPA) -> ElasticEnergy:
    """Elastic term per grown volume."""
    k, n = kinematics(points, cells, F_g, F_g33), cells.shape[0]
    pattern = CellPattern(cells, points.shape[1])
    return ElasticEnergy(k, np.stack([np.full(n, mu), np.full(n, kappa)]), k.volumes * k.J_g, pattern)


def kelvin_voigt(points, cells, previous_strain, F_g=None, F_g33=None, coefficient=5.0) -> KelvinVoigtEnergy:
    """Viscous term per grown volume."""
    k = kinematics(points, cells, F_g, F_g33)
    pattern = CellPattern(cells, points.shape[1])
    return KelvinVoigtEnergy(k, coefficient, k.volumes * k.J_g, previous_strain, pattern)


def pinched_contour() -> tuple[np.ndarray, float]:
    """A closed contour with two banks of a sulcus at gaps of 0.3 to 0.9 of the activation distance, and that.

    The banks carry their points at different places, so that a vertex faces the inside of an edge on some
    pairs, and a vertex on others.
    """
    d_hat = 0.2
    left = np.stack([np.linspace(0.0, 3.0, 8), 0.5 * 0.12 + 0.03 * np.sin(np.arange(8.0))], axis=1)
    right = np.stack([np.linspace(2.9, -0.1, 7), -0.5 * 0.12 + 0.02 * np.cos(np.arange(7.0))], axis=1)
    around = np.array([[-1.0, -0.2], [-1.0, -1.5], [4.5, -1.5], [4.5, 1.5], [-1.0, 1.5], [-1.0, 0.3]])
    # counter-clockwise around the tissue, which lies outside the gap
    return np.concatenate([right, around[:1], around[1:5], around[5:], left]), d_hat


def pinched_contact(stiffness: float = 7.0) -> tuple[ContactEnergy, np.ndarray, float]:
    """Contact term of the pinched contour (at rest it is wider), displacement and activation distance."""
    x, d_hat = pinched_contour()
    reference = x * [1.1, 1.5]
    surface = ContactSurface(reference, np.arange(len(x)), True)
    return ContactEnergy(surface, d_hat, stiffness), x - reference, d_hat


def rotation(angle: float) -> np.ndarray:
    """Rotation by an angle in the plane."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def elliptic_ring(
    semi_axes: tuple[float, float], hole_fraction: float, cortical_thickness: float, layers: Layers
) -> Mesh:
    """`layered_mesh` of an `Ellipse`."""
    return layered_mesh(Ellipse(semi_axes, hole_fraction, cortical_thickness), layers)


def periodic_strip(length: float, depth: float, cortical_thickness: float, layers: Layers) -> Mesh:
    """`layered_mesh` of a `PeriodicStrip`."""
    return layered_mesh(PeriodicStrip(length, depth, cortical_thickness), layers)
