"""Contact of a folded surface in space: the folded contour of a slice, drawn out into a sheet."""

from __future__ import annotations

from functools import partial
from typing import Any

import ipctk
import numpy as np

from bench.figures import Figure, Figures
from bench.slices import folded
from bench.timing import interleaved

# Activation distance [mm] and stiffness [Pa] of `reference-slice`.
D_HAT, STIFFNESS = 0.1, 921.087


class Sheet:
    """A folded contour, repeated in z, as a collision mesh of triangles.

    Parameters
    ----------
    contour : (n, 2) float array
        Folded closed contour [mm].
    n_rows : int
        Number of copies.
    spacing : float
        Between two copies [mm].
    """

    def __init__(self, contour: np.ndarray, n_rows: int, spacing: float) -> None:
        n = contour.shape[0]
        z = np.repeat(spacing * np.arange(n_rows), n)
        points = np.column_stack([np.tile(contour, (n_rows, 1)), z])
        here = np.arange(n) + n * np.arange(n_rows - 1)[:, None]
        after = np.roll(np.arange(n), -1) + n * np.arange(n_rows - 1)[:, None]
        pieces = [[here, after, after + n], [here, after + n, here + n]]
        faces = np.concatenate([np.stack(piece, axis=-1).reshape(-1, 3) for piece in pieces])
        faces = np.asfortranarray(faces.astype(np.int32))
        self.points = np.asfortranarray(points)
        self.mesh = ipctk.CollisionMesh(self.points, ipctk.edges(faces), faces)
        self.barrier = ipctk.BarrierPotential(D_HAT, STIFFNESS, True)

    def collisions(self) -> ipctk.NormalCollisions:
        """Pairs within the activation distance."""
        found = ipctk.NormalCollisions()
        found.use_area_weighting = True
        found.collision_set_type = ipctk.NormalCollisions.IMPROVED_MAX_APPROX
        found.build(self.mesh, self.points, D_HAT)
        return found

    def everything(self) -> Any:
        """Search, energy, gradient and Hessian."""
        found = self.collisions()
        energy = self.barrier(found, self.mesh, self.points)
        gradient = self.barrier.gradient(found, self.mesh, self.points)
        hessian = self.barrier.hessian(found, self.mesh, self.points, ipctk.PSDProjectionMethod.NONE)
        return energy, gradient, hessian

    def free_step(self) -> float:
        """Collision-free part of a step that would open the sheet by a hundredth."""
        end = np.asfortranarray(1.01 * self.points)
        return float(ipctk.compute_collision_free_stepsize(self.mesh, self.points, end))


def contact(quick: bool) -> Figures:
    """Seconds per surface vertex of all that contact asks for."""
    history = folded(quick)
    contour = history.contour()
    spacing = float(np.linalg.norm(np.roll(contour, -1, axis=0) - contour, axis=1).mean())
    found: Figures = []
    for n_rows in (8, 16) if quick else (16, 64):
        sheet = Sheet(contour, n_rows, spacing)
        n = sheet.points.shape[0]
        tasks = {
            "energy, gradient, Hessian": sheet.everything,
            "collision-free step": partial(sheet.free_step),
        }
        times = interleaved(tasks, 2 if quick else 5)
        found.append(Figure(f"contact, {n} vertices: pairs per vertex", len(sheet.collisions()) / n))
        for name, sample in times.items():
            found.append(Figure(f"contact, {n} vertices: {name}, per vertex", 1e6 * sample.median / n, "us"))
    return found
