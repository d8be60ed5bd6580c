"""The cells of gyrify in FElupe: its own neo-Hookean solid in plane strain, or a solid of the plane alone.

`PlaneStrain` is the library's `NeoHooke`, whose energy is that of gyrify, with growth around it: it works on
3 x 3 gradients, of which the plane needs 2 x 2. `InPlane` hands the library stress and tangent of the plane
in closed form, in arrays that are allocated once. FElupe keeps the sparsity pattern itself.

FElupe is under the GPL: it is imported here, in the environment of the benchmarks, and nowhere else.
"""

from __future__ import annotations

import felupe
import numpy as np
import scipy.sparse as sp

from bench.peers.cells import GrownCells
from bench.peers.solid import GrownSolid
from gyrify.energy.term import FloatArray


class _VaryingNeoHooke(felupe.NeoHooke):
    """The library's solid with moduli of every cell: inputs, which it cuts into chunks with the others."""

    def _gradient(self, x: list[FloatArray]) -> list[FloatArray]:
        F, self.mu, self.bulk, scale = x
        stress, _ = super()._gradient([F, scale])
        return [np.multiply(stress, scale, out=stress), scale]

    def _hessian(self, x: list[FloatArray]) -> list[FloatArray]:
        F, self.mu, self.bulk, scale = x
        (tangent,) = super()._hessian([F])
        return [np.multiply(tangent, scale, out=tangent)]


class PlaneStrain:
    """`felupe.NeoHooke` of F / lambda_g, counted per grown volume.

    Parameters
    ----------
    cells : GrownCells
        Mesh, growth and stiffness; 33 entries as in the ``blocked`` and ``none`` readings of growth.
    """

    def __init__(self, cells: GrownCells) -> None:
        region = felupe.RegionTriangle(felupe.Mesh(cells.points, cells.cells, "triangle"))
        self.displacement = felupe.FieldPlaneStrain(region, dim=2)
        self.field = felupe.FieldContainer([self.displacement])
        self.mu, self.kappa = cells.mu[None].copy(), cells.kappa[None].copy()
        self.solid = _VaryingNeoHooke(mu=self.mu, bulk=self.kappa)
        self.J_g, self.volumes = cells.J_g[None], region.dV
        inverse = 1.0 / cells.stretch[None]
        self.first, self.second = self.J_g * inverse, self.J_g * inverse**2
        self.stretch = np.ones((3, 3, 1, 1)) * inverse
        self.stretch[2, 2] = cells.f33
        shape = (cells.stretch.size,)
        self._F, self._stress = np.empty((3, 3, 1, *shape)), np.empty((3, 3, 1, *shape))
        self._tangent = np.empty((3, 3, 3, 3, 1, *shape))

    def energy(self, u: FloatArray) -> float:
        """See `bench.peers.cells.Assembler`."""
        return self._sum(self._elastic(u))

    def all(self, u: FloatArray) -> tuple[float, FloatArray, sp.csr_matrix]:
        """See `bench.peers.cells.Assembler`."""
        F = self._elastic(u)
        self.solid.gradient([F, self.mu, self.kappa, self.first], out=self._stress)
        self.solid.hessian([F, self.mu, self.kappa, self.second], out=self._tangent)
        return (
            self._sum(F),
            _assembled(self.field, self._stress).toarray().ravel(),
            _assembled(self.field, self._tangent, self.field),
        )

    def _sum(self, F: FloatArray) -> float:
        self.solid.mu, self.solid.bulk = self.mu, self.kappa
        (density,) = self.solid.function([F])
        return float((density * self.J_g * self.volumes).sum())

    def _elastic(self, u: FloatArray) -> FloatArray:
        self.displacement.values[:] = u
        F = self.displacement.extract(out=self._F)
        return np.multiply(F, self.stretch, out=self._F)


class InPlane:
    """Stress and tangent of the plane in closed form.

    Parameters
    ----------
    cells : GrownCells
        Mesh, growth and stiffness.
    """

    def __init__(self, cells: GrownCells) -> None:
        region = felupe.RegionTriangle(felupe.Mesh(cells.points, cells.cells, "triangle"))
        self.displacement = felupe.Field(region, dim=2)
        self.field = felupe.FieldContainer([self.displacement])
        self.solid, self.volumes = GrownSolid(cells), region.dV[0]
        self._gradient = np.empty((2, 2, 1, cells.cells.shape[0]))

    def energy(self, u: FloatArray) -> float:
        """See `bench.peers.cells.Assembler`."""
        return float((self.solid.density(self._extracted(u)) * self.volumes).sum())

    def all(self, u: FloatArray) -> tuple[float, FloatArray, sp.csr_matrix]:
        """See `bench.peers.cells.Assembler`."""
        density, stress, tangent = self.solid.all(self._extracted(u))
        tangent = self.solid.full(tangent)
        return (
            float((density * self.volumes).sum()),
            _assembled(self.field, stress[:, :, None]).toarray().ravel(),
            _assembled(self.field, tangent[:, :, :, :, None], self.field),
        )

    def _extracted(self, u: FloatArray) -> FloatArray:
        self.displacement.values[:] = u
        return self.displacement.grad(out=self._gradient)[:, :, 0]


def _assembled(
    test: felupe.FieldContainer, function: FloatArray, trial: felupe.FieldContainer | None = None
) -> sp.csr_matrix:
    return felupe.IntegralForm([function], test, test.region.dV, trial).assemble()
