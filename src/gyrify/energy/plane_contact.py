r"""Contact of half a body with its plane of symmetry, that is with its own mirror image.

.. math::
   E(u) = \sum_i \tfrac12 A_i \, k_b \, \hat d \; b(d_i^2 / \hat d^2), \quad
   b(s) = -(s - 1)^2 \ln s \; (s < 1), \; 0 \text{ otherwise}

over the points of the outer surface that do not lie in the plane, at the distance d_i from it and with the
reference area A_i. A half-space is convex, so that no edge or triangle crosses a plane that no point has
crossed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gyrify.energy.contact import SAFETY
from gyrify.energy.term import Evaluation, FloatArray, Hessian, IntArray, Pattern


@dataclass(frozen=True, eq=False)
class FacingPoints:
    """Points that face a plane across an axis.

    Attributes
    ----------
    points : (n,) int array
        Their numbers.
    gap : (n,) float array
        Distances in the reference state [mm].
    area : (n,) float array
        Reference area of each [mm^2].
    axis : int
        Axis that the plane lies across.
    sign : float
        1 if the plane is at the upper end of that axis, -1 at the lower.
    """

    points: IntArray
    gap: FloatArray
    area: FloatArray
    axis: int
    sign: float

    @staticmethod
    def of(points: FloatArray, faces: IntArray, on_plane: IntArray, axis: int, sign: float) -> FacingPoints:
        """Points of a surface that do not lie in the plane.

        Parameters
        ----------
        points : (n_points, 3) float array
            Reference coordinates [mm].
        faces : (n_faces, 3) int array
            Triangles of the surface.
        on_plane : (n,) int array
            Points in the plane.
        axis, sign
            As of the class.
        """
        facing: IntArray = np.setdiff1d(faces, on_plane)
        a, b, c = (points[faces[:, k]] for k in range(3))
        share = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6.0
        area = np.bincount(faces.ravel(), np.repeat(share, 3), points.shape[0]).astype(np.float64)[facing]
        place = float(points[on_plane, axis].mean())
        gap = np.asarray(sign * (place - points[facing, axis]))
        return FacingPoints(facing, gap, area, axis, sign)


class PlaneContact:
    """Barrier before a plane of symmetry; see the module's equation.

    Parameters
    ----------
    facing : FacingPoints
        What faces the plane.
    d_hat : float
        Activation distance [mm].
    barrier_stiffness : float
        k_b [Pa].
    """

    is_barrier = True

    def __init__(self, facing: FacingPoints, d_hat: float, barrier_stiffness: float) -> None:
        self.facing, self.d_hat, self.stiffness = facing, d_hat, barrier_stiffness

    def gaps(self, u: FloatArray) -> FloatArray:
        """(n,) distances from the plane [mm]."""
        facing = self.facing
        return np.asarray(facing.gap - facing.sign * u[facing.points, facing.axis])

    def evaluate(self, u: FloatArray, order: int, project_psd: bool = False) -> Evaluation:
        """Energy [Pa mm^3], gradient [Pa mm^2], Hessian [Pa mm]; see `EnergyTerm`."""
        facing, gaps = self.facing, self.gaps(u)
        if not gaps.min(initial=np.inf) > 0.0:
            return Evaluation(np.inf)
        near = np.flatnonzero(gaps < self.d_hat)
        gap, weight = gaps[near], 0.5 * facing.area[near] * self.stiffness * self.d_hat
        s = (gap / self.d_hat) ** 2
        value = -float(np.sum(weight * (s - 1.0) ** 2 * np.log(s)))
        if order == 0:
            return Evaluation(value)
        slope = weight * (-2.0 * (s - 1.0) * np.log(s) - (s - 1.0) ** 2 / s)
        along = 2.0 * gap / self.d_hat**2
        gradient = np.zeros_like(u)
        gradient[facing.points[near], facing.axis] = -facing.sign * slope * along
        if order == 1:
            return Evaluation(value, gradient)
        bend = weight * (-2.0 * np.log(s) - 4.0 * (s - 1.0) / s + (s - 1.0) ** 2 / s**2)
        values = bend * along**2 + 2.0 * slope / self.d_hat**2
        dofs = facing.points[near] * u.shape[1] + facing.axis
        return Evaluation(
            value, gradient, Hessian(Pattern(dofs, dofs), np.maximum(values, 0.0) if project_psd else values)
        )

    def max_step(self, u: FloatArray, du: FloatArray) -> float:
        """Largest safe fraction of du, at most 1: no point is beyond the plane up to it."""
        nearer = self.facing.sign * du[self.facing.points, self.facing.axis]
        gaps, moving = self.gaps(u), nearer > 0.0
        step = float((gaps[moving] / nearer[moving]).min(initial=np.inf))
        return 1.0 if step > 1.0 else SAFETY * step
