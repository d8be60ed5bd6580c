"""Panels of each kind of element under given loads, and how far a state is from an exact one.

Shape functions and quadrature (degree 5, exact on curved cells to the order that is measured) are written
down here again, so that an error in those of the elements shows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gyrify.energy.elastic import CellPattern, ElasticEnergy
from gyrify.energy.kinematics import ElasticKinematics, Simplices
from gyrify.energy.mean_dilatation import MeanDilatationEnergy, PatchPattern
from gyrify.energy.term import Evaluation
from gyrify.energy.total import TotalEnergy
from gyrify.mesh import Mesh
from gyrify.solve.equilibrium import find_equilibrium
from gyrify.solve.linear import linear_solver
from gyrify.solve.newton import Criterion, minimise
from gyrify.solve.result import Result
from gyrify.solve.system import System

Field = Callable[[np.ndarray], np.ndarray]
ELEMENTS = ("linear", "mean_dilatation", "quadratic")
NO_PAIRS = np.empty((0, 2), dtype=np.int64)

# Radon's rule with seven points: barycentric coordinates and weights over the area.
_ROOT = np.sqrt(15.0)
_SMALL, _LARGE = (6.0 - _ROOT) / 21.0, (6.0 + _ROOT) / 21.0
BARYCENTRIC = np.array(
    [[1 / 3] * 3] + [np.roll([1.0 - 2.0 * s, s, s], k).tolist() for s in (_SMALL, _LARGE) for k in range(3)]
)
WEIGHTS = np.array([9 / 40] + [(155.0 - _ROOT) / 1200.0] * 3 + [(155.0 + _ROOT) / 1200.0] * 3)


def shape_functions(n_nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Values (7, n_nodes) and slopes (7, n_nodes, 2) by the second and third barycentric coordinate."""
    r, s = BARYCENTRIC[:, 1], BARYCENTRIC[:, 2]
    one, zero = np.ones_like(r), np.zeros_like(r)
    if n_nodes == 3:
        values = [1 - r - s, r, s]
        slopes = [[-one, -one], [one, zero], [zero, one]]
    else:
        t = 1 - r - s
        values = [t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t]
        slopes = [
            [1 - 4 * t, 1 - 4 * t],
            [4 * r - 1, zero],
            [zero, 4 * s - 1],
            [4 * (t - r), -4 * r],
            [4 * s, 4 * r],
            [-4 * s, 4 * (t - s)],
        ]
    return np.stack(values, axis=1), np.moveaxis(np.array(slopes), 2, 0)


@dataclass(frozen=True, eq=False)
class Panel:
    """A body of one material without growth.

    Attributes
    ----------
    points, cells, patch
        As in `gyrify.mesh.Mesh`.
    held : (n,) int array
        Points whose displacement is given.
    element : str
        Kind of element.
    """

    points: np.ndarray
    cells: np.ndarray
    patch: np.ndarray
    held: np.ndarray
    element: str

    @staticmethod
    def of_ring(mesh: Mesh, element: str) -> Panel:
        """Ring held on both of its circles."""
        held = np.concatenate([mesh.contour, mesh.clamped])
        return Panel(mesh.points, mesh.cells, mesh.patch, held, element)

    @cached_property
    def simplices(self) -> Simplices:
        return Simplices.of(self.points[self.cells], self.cells, len(self.points))

    @cached_property
    def pattern(self) -> CellPattern:
        return CellPattern(self.simplices.cells, 2)

    @cached_property
    def patches(self) -> PatchPattern:
        return PatchPattern(self.simplices.cells, self.patch, 2, self.pattern.pattern)

    def elastic(self, mu: float, kappa: float) -> ElasticEnergy:
        """Elastic term of the element."""
        n = self.simplices.volumes.size
        k = ElasticKinematics.of(self.simplices, np.tile(np.eye(2), (n, 1, 1)), np.ones(n))
        material = (k, np.stack([np.full(n, mu), np.full(n, kappa)]), k.volumes, self.pattern)
        if self.element == "mean_dilatation":
            return MeanDilatationEnergy(*material, self.patches)
        return ElasticEnergy(*material)

    @cached_property
    def quadrature(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Places (c, q, 2), weights (c, q), values (q, a) and slopes (c, q, a, 2) of the shape functions."""
        values, slopes = shape_functions(self.cells.shape[1])
        nodes = self.points[self.cells]
        mapping = np.einsum("cai,qaj->cqij", nodes, slopes)
        gradients = np.einsum("qaj,cqji->cqai", slopes, np.linalg.inv(mapping))
        return (
            np.einsum("qa,cai->cqi", values, nodes),
            0.5 * WEIGHTS * np.linalg.det(mapping),
            values,
            gradients,
        )

    def load(self, body_force: Field) -> np.ndarray:
        """(n_points, 2) nodal forces of a force per reference area."""
        places, weights, values, _ = self.quadrature
        forces = np.zeros_like(self.points)
        np.add.at(forces, self.cells, np.einsum("cq,cqi,qa->cai", weights, body_force(places), values))
        return forces

    def errors(self, u: np.ndarray, exact: Field, slope: Field) -> tuple[float, float]:
        """Relative errors in L2 and in the H1 seminorm."""
        places, weights, values, gradients = self.quadrature
        nodal = u[self.cells]
        pairs = (
            (np.einsum("qa,cai->cqi", values, nodal), exact(places)),
            (np.einsum("cai,cqaj->cqij", nodal, gradients), slope(places)),
        )
        axes = ((2,), (2, 3))
        found = []
        for (approximate, true), axis in zip(pairs, axes, strict=True):
            squares = [np.sum(np.square(x), axis=axis) for x in (approximate - true, true)]
            error, size = (np.sum(weights * square) for square in squares)
            found.append(float(np.sqrt(error / size)))
        return found[0], found[1]

    def solve(self, mu: float, kappa: float, load: np.ndarray, u: np.ndarray, steps: int = 1) -> np.ndarray:
        """Stable equilibrium under nodal forces, from a state that is right where displacements are given.

        Energy leads to it; the residual, which rounds off later, takes over near the end.
        """
        free = np.ones(self.points.shape, dtype=bool)
        free[self.held] = False
        pattern = self.patches.pattern if self.element == "mean_dilatation" else self.pattern.pattern
        system = System(np.flatnonzero(free), u.size, 2, pattern, linear_solver("superlu"), NO_PAIRS)
        elastic, size = self.elastic(mu, kappa), mu * float(np.ptp(self.points))
        for share in np.arange(1, steps + 1) / steps:
            total = TotalEnergy([elastic, DeadLoad(share * load)])
            for solve, tolerance in ((minimise, 1e-4), (find_equilibrium, 1e-9)):
                solution = solve(total, u, system, Criterion(tolerance * size, 200), lambda _: NO_PAIRS)
                assert solution.result is Result.CONVERGED, (self.element, share, solution)
                u = solution.u
        assert (
            system.factorise_data(system.assemble(total.evaluate(u, False), lambda: NO_PAIRS)).n_negative == 0
        )
        return u


class DeadLoad:
    """Potential of constant nodal forces."""

    def __init__(self, forces: np.ndarray) -> None:
        self.forces = forces

    def evaluate(self, u: np.ndarray, order: int, project_psd: bool = False) -> Evaluation:  # noqa: ARG002
        """See `EnergyTerm`; there is no Hessian."""
        value = -float(np.sum(self.forces * u))
        return Evaluation(value, -self.forces if order else None)

    is_barrier = False

    def max_step(self, u: np.ndarray, du: np.ndarray) -> float:  # noqa: ARG002
        """No limit."""
        return 1.0


def square(n: int, element: str, distortion: float = 0.2) -> Panel:
    """Unit square of n x n distorted quadrilaterals, each split in two at random; held all around."""
    rng = np.random.default_rng(4 + n)
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    points = np.stack([x, y], axis=2)
    points[1:-1, 1:-1] += rng.uniform(-distortion, distortion, (n - 1, n - 1, 2)) / n
    return quadrilaterals(points, element, rng.random((n, n)) < 0.5)


def quadrilaterals(points: np.ndarray, element: str, falling: np.ndarray) -> Panel:
    """Panel of a (rows, columns, 2) grid of points, each quadrilateral split by one or the other diagonal."""
    rows, columns = points.shape[:2]
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    first = np.where(falling[..., None], np.stack([a, b, d], axis=2), np.stack([a, b, c], axis=2))
    second = np.where(falling[..., None], np.stack([b, c, d], axis=2), np.stack([a, c, d], axis=2))
    cells = np.stack([first, second], axis=2).reshape(-1, 3)
    patch = np.repeat(np.arange(a.size), 2)
    flat = points.reshape(-1, 2)
    rim = np.concatenate([number[0], number[-1], number[:, 0], number[:, -1]])
    on_rim = np.isin(np.arange(len(flat)), rim)
    if element == "quadratic":
        ends = np.sort(np.stack([cells, np.roll(cells, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        edges, position, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
        cells = np.concatenate([cells, len(flat) + position.reshape(-1, 3)], axis=1)
        flat = np.concatenate([flat, flat[edges].mean(axis=1)])
        on_rim = np.concatenate([on_rim, count == 1])
    return Panel(flat, cells, patch, np.flatnonzero(on_rim), element)


def rates(errors: np.ndarray, factor: float = 2.0) -> np.ndarray:
    """Orders between neighbouring levels, from the coarsest."""
    errors = np.asarray(errors)
    return np.log(errors[:-1] / errors[1:]) / np.log(factor)


def straight_square(n: int, element: str, diagonals: str) -> Panel:
    """Unit square of n x n equal squares with parallel or alternating diagonals; held all around."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    turns = np.indices((n, n)).sum(axis=0) % 2 == 0
    return quadrilaterals(np.stack([x, y], axis=2), element, turns & (diagonals == "alternating"))
