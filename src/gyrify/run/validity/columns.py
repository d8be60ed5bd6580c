"""Stability of the smooth slice on a mesh, by waves along its columns.

Columns of a mesh without jitter repeat. Four of them, with displacements that go on beyond them as a wave
(Bloch's theorem), stand for the whole ring or strip: a matrix of some hundred unknowns per wave number tells
whether the smooth state is stable, and the whole mesh is never built. Displacements are counted outwards and
along at each point, so that the smooth state is the same in every four columns.
"""

from __future__ import annotations

from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from gyrify.energy.element import reference_element
from gyrify.errors import SolveError
from gyrify.mesh import GREY
from gyrify.mesh.layered_grid import LayeredGrid, Layers, build_grid
from gyrify.model.body import Places, growth_of, material_of, parameters_of
from gyrify.physics.stress import response
from gyrify.run.validity.bands import Bands

if TYPE_CHECKING:
    from gyrify.config import Config

FloatArray = NDArray[np.float64]

# The fewest columns between which no two points share two edges.
COLUMNS: Final = 4
_MAX_NEWTON: Final = 30
_HALVINGS: Final = 12
# Wave numbers tried: all where they are few, or else some spread evenly and some about the expected one.
_ALL, _SPREAD, _ABOUT = 40, 16, 16


class MeshColumns:
    """Four columns of the mesh of a configuration; an ellipse stands as the circle of the same area.

    Parameters
    ----------
    config : Config
        Every number of the run; jitter is set aside, and a random split is taken as an alternating one.
    """

    def __init__(self, config: Config) -> None:
        self._config = config
        self._is_strip = config.geometry.shape == "strip"
        self._grid = grid = self._build()
        along = grid.along[grid.cells]
        images = -np.round(along - along[:, :1]).astype(np.int64)
        # 0 for the four columns, 1 for those after them: the same for all cells of a patch.
        self._image = images - images.min(axis=1, keepdims=True)
        points, turn = self._placed(along + self._image, grid.depth[grid.cells])
        slopes, weights = reference_element(grid.cells.shape[1], 2)
        mapping = np.einsum("cai,qaj->cqij", points, slopes)
        shape = (-1, grid.cells.shape[1], 2)
        self._gradients = np.einsum("qaj,cqji->cqai", slopes, np.linalg.inv(mapping)).reshape(shape)
        self._volumes = (np.abs(np.linalg.det(mapping)) * weights).ravel()
        self._cell = np.repeat(np.arange(len(grid.cells)), weights.size)
        self._turn = turn[self._cell]
        places = Places(
            grey=grid.region[self._cell] == GREY,
            across=self._outwards(along + self._image)[self._cell],
            along=np.full(self._cell.size, np.nan),  # all columns are alike
            depth=grid.depth[grid.cells[:, :3]].mean(axis=1)[self._cell],
        )
        self._growth, self._material = growth_of(config, places), material_of(config)
        self._parameters = parameters_of(config, places)
        self._kappa = self._parameters[-1]
        self._isochoric = np.concatenate([self._parameters[:-1], np.zeros_like(self._parameters[-1:])])
        # What the mesh adds to the guess, as far as it is known from another growth time.
        self._correction = np.zeros((grid.depth.size, 2))

    @cached_property
    def rest(self) -> FloatArray:
        """(n_points,) distance of the points from the middle, or above the floor of a strip [mm]."""
        return self._outward(self._grid.depth)

    def is_stable(
        self, time: float, outward: FloatArray, axial_stretch: float, expected_mode: int | None
    ) -> bool:
        """Whether the smooth state of the mesh is stable against all waves at a growth time.

        Parameters
        ----------
        time : float
            Growth time.
        outward : (n_points,) float array
            A guess of the outward displacements [mm], best the exact ones.
        axial_stretch : float
            F33 [-].
        expected_mode : int or None
            Waves around the contour (along the period) about which to look closely.

        Raises
        ------
        SolveError
            If the smooth state is not found.
        """
        bands = self._smooth(time, outward, axial_stretch)
        return all(bands.is_definite(float(phase)) for phase in self._phases(expected_mode))

    def _build(self) -> LayeredGrid:
        geometry, mesh = self._config.geometry, self._config.mesh
        layers = Layers(
            n_around=COLUMNS,
            n_layers=mesh.n_layers * 2**mesh.refine,
            n_cortex_layers=mesh.n_cortex_layers * 2**mesh.refine,
            grading=mesh.grading,
            split="one" if mesh.split == "one" else "alternating",
            element=mesh.element,
            refine_cortex=mesh.refine_cortex,
        )
        T = geometry.cortical_thickness
        return build_grid(layers, T / self._white, (self._white, T), self._width)

    @property
    def _n_around(self) -> int:
        return int(self._config.mesh.n_around * 2**self._config.mesh.refine)

    @property
    def _white(self) -> float:
        geometry = self._config.geometry
        wall = geometry.depth if self._is_strip else geometry.mean_radius * (1.0 - geometry.hole_fraction)
        return wall - geometry.cortical_thickness

    @property
    def _width(self) -> float:
        """Length of four columns: an angle, or [mm] along a strip."""
        whole = self._config.geometry.length if self._is_strip else 2.0 * np.pi
        return whole * COLUMNS / self._n_around

    def _outward(self, depth: FloatArray) -> FloatArray:
        geometry = self._config.geometry
        start = 0.0 if self._is_strip else geometry.hole_fraction * geometry.mean_radius
        white, grey = np.minimum(depth, 1.0), np.maximum(depth - 1.0, 0.0)
        return start + white * self._white + grey * geometry.cortical_thickness

    def _placed(self, along: FloatArray, depth: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Points (..., 2) [mm] and their directions outwards and along, as columns of (..., 2, 2)."""
        outward, at = self._outward(depth), along * self._width
        turn = np.zeros((*along.shape, 2, 2))
        if self._is_strip:
            turn[..., 1, 0] = turn[..., 0, 1] = 1.0
            return np.stack([at, outward], axis=-1), turn
        turn[..., 0, 0] = turn[..., 1, 1] = np.cos(at)
        turn[..., 1, 0], turn[..., 0, 1] = np.sin(at), -np.sin(at)
        return outward[..., None] * turn[..., 0], turn

    def _outwards(self, along: FloatArray) -> FloatArray:
        """(n_cells, 2) direction across the layers at the middle of each cell."""
        middle = along[:, :3].mean(axis=1)
        return self._placed(middle, np.ones_like(middle))[1][..., 0]

    @cached_property
    def _place(self) -> NDArray[np.int64]:
        """(n_points, 2) place of each unknown, from the clamped side outwards; negative where it is held."""
        grid = self._grid
        place = np.full((grid.depth.size, 2), -1)
        order = np.lexsort((grid.along, grid.depth))
        free = order[~np.isin(order, grid.rows[0])]
        place[free] = np.arange(2 * free.size).reshape(-1, 2)
        return place

    @cached_property
    def _unknowns(self) -> NDArray[np.int64]:
        """(n, n_unknowns) places of the unknowns of the cell about each integration point."""
        places = self._place[self._grid.cells]
        return np.asarray(places.reshape(len(places), -1)[self._cell])

    @cached_property
    def _ahead(self) -> NDArray[np.int64]:
        """(n, n_unknowns) whether they are those of the next four columns."""
        return np.asarray(np.repeat(self._image, 2, axis=1)[self._cell])

    @cached_property
    def _band(self) -> tuple[int, int]:
        """Number of unknowns, and the largest distance between two of a patch."""
        n, patch = int(self._place.max()) + 1, self._grid.patch[self._cell]
        highest, lowest = np.full(patch.max() + 1, -1), np.full(patch.max() + 1, n)
        np.maximum.at(highest, patch, self._unknowns.max(axis=1))
        np.minimum.at(lowest, patch, np.where(self._unknowns < 0, n, self._unknowns).min(axis=1))
        return n, int((highest - lowest).max())

    @property
    def work(self) -> float:
        """Operations of one factorisation."""
        n, width = self._band
        return float(n) * width**2

    def _phases(self, expected_mode: int | None) -> FloatArray:
        """Phases per four columns; each stands for all waves that differ by a whole turn or in direction."""
        quarter = self._n_around / COLUMNS
        numbers = np.arange(0.5 * quarter + 1.0)
        if numbers.size > _ALL:
            about = np.linspace(0.25, 1.25, _ABOUT) * (expected_mode or 0)
            numbers = np.unique(np.concatenate([np.linspace(0.0, 0.5 * quarter, _SPREAD), np.round(about)]))
        return np.asarray(2.0 * np.pi * numbers / quarter)

    def _smooth(self, time: float, outward: FloatArray, axial_stretch: float) -> Bands:
        """Stiffness of the smooth state, found from a guess by Newton's method."""
        grown = self._grown(time, axial_stretch)
        guess = np.stack([outward, np.zeros_like(outward)], axis=1)
        u = guess + self._correction
        force, bands = self._evaluate(u, *grown)
        for _ in range(_MAX_NEWTON):
            step = bands.solve(-force)
            if not np.isfinite(step).all():
                break
            u, force, bands = self._stepped(u, step, grown)
            if float(np.abs(step).max()) < 1e-7 * self._config.geometry.cortical_thickness:
                self._correction = u - guess
                return bands
        raise SolveError(
            f"The smooth state of the mesh is not found at growth time {time:.6g}.", "Raise mesh.n_around."
        )

    def _stepped(
        self, u: FloatArray, step: FloatArray, grown: tuple[FloatArray, FloatArray, FloatArray]
    ) -> tuple[FloatArray, FloatArray, Bands]:
        """Displacement after a step, or as much of it as inverts no cell; its forces and stiffness."""
        change = np.append(step, 0.0)[self._place]
        for part in 0.5 ** np.arange(_HALVINGS):
            with suppress(SolveError):
                moved = u + part * change
                return moved, *self._evaluate(moved, *grown)
        raise SolveError("A cell of the smooth state is inverted.", "Raise mesh.n_around.")

    def _grown(self, time: float, axial_stretch: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Gradients of displacements (n, 4, n_unknowns), F_g^-1, and (f33, weight) at a growth time."""
        F_g, F_g33 = self._growth.tensor(time), self._growth.out_of_plane(time)
        inverse = np.linalg.inv(F_g)
        slopes = self._gradients @ inverse
        B = np.einsum("caik,caj->cijak", self._turn, slopes).reshape(len(slopes), 4, -1)
        J_g = np.linalg.det(F_g) * F_g33
        weight = self._volumes * (J_g if self._config.growth.energy_per == "grown" else 1.0)
        return B, np.asarray(inverse, dtype=np.float64), np.stack([axial_stretch / F_g33, weight])

    def _evaluate(
        self, u: FloatArray, B: FloatArray, base: FloatArray, scalars: FloatArray
    ) -> tuple[FloatArray, Bands]:
        """Forces on the unknowns, and their stiffness."""
        f33, weight = scalars
        moved = u[self._grid.cells].reshape(len(self._grid.cells), -1)[self._cell]
        F = base + np.einsum("cxp,cp->cx", B, moved).reshape(-1, 2, 2)
        J = np.linalg.det(F) * f33
        if np.any(J <= 0.0):
            raise SolveError("A cell of the smooth state is inverted.", "Raise mesh.n_around.")
        bands, averages = Bands(*self._band), self._config.mesh.element == "mean_dilatation"
        pressure = self._averaged(J, F, B, weight, bands) if averages else np.zeros_like(J)
        stress, tangent = response(
            self._material, F, f33, self._isochoric if averages else self._parameters, pressure
        )
        force = np.zeros(bands.n + 1)
        np.add.at(force, self._unknowns, weight[:, None] * np.einsum("cx,cxp->cp", stress, B))
        stiffness = np.swapaxes(B, 1, 2) @ (weight[:, None, None] * tangent) @ B
        bands.add(self._unknowns, self._unknowns, self._ahead, self._ahead, stiffness)
        return force[:-1], bands

    def _averaged(
        self, J: FloatArray, F: FloatArray, B: FloatArray, weight: FloatArray, bands: Bands
    ) -> FloatArray:
        """Pressure from the mean volume ratio of each patch; the products of its gradient go to the bands."""
        patch = self._grid.patch[self._cell]
        total = np.bincount(patch, weight)
        mean = np.bincount(patch, weight * J) / total
        H = np.swapaxes(np.linalg.inv(F), 1, 2).reshape(-1, 4)
        slope = (weight * J)[:, None] * np.einsum("cx,cxp->cp", H, B)
        first, second = np.nonzero(patch[:, None] == patch)
        scale = self._kappa[first] / total[patch[first]]
        products = scale[:, None, None] * slope[first][:, :, None] * slope[second][:, None, :]
        unknowns, ahead = self._unknowns, self._ahead
        bands.add(unknowns[first], unknowns[second], ahead[first], ahead[second], products)
        return np.asarray(self._kappa * (mean[patch] - 1.0))
