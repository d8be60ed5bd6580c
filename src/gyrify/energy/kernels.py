"""Compiled loops over integration points, specialised for a dimension and a number of nodes."""

from __future__ import annotations

import inspect
import zlib
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from gyrify.base.compiled import njit
from gyrify.energy import batch, cell, dashpot, projection, tangents
from gyrify.energy.batch import (
    BATCH,
    add_axial_force,
    add_axial_matrices,
    add_forces,
    add_matrices,
    add_products,
    energy,
    gather,
    invariants,
    load,
    products,
    step_to_inversion,
    step_to_inversion_in_space,
    store,
    weigh_moduli,
)
from gyrify.energy.batch import invert as invert_all
from gyrify.energy.cell import deform, invert
from gyrify.energy.dashpot import (
    add_dashpot_forces,
    add_dashpot_matrices,
    project_stresses,
    squares,
    subtract_from_strain,
    weigh,
)
from gyrify.energy.principal import principal_kernel
from gyrify.energy.tangents import add_projected
from gyrify.physics import stress
from gyrify.physics.materials import MATERIALS, Material, dispatch

# Closures may capture integers only: numba finds them again in its cache, but not captured functions. The
# cache looks at this file alone, so that the digest of what the kernels are made of is one of the integers.


class ElasticKernels(NamedTuple):
    """Compiled energy of one material on one kind of simplex; without and with a common F33 as an unknown."""

    accumulate: Callable[..., float]
    accumulate_axial: Callable[..., float]


class CellKernels(NamedTuple):
    """Compiled functions of one kind of simplex that know no material."""

    dissipate: Callable[..., float]
    largest_step: Callable[..., float]
    grow: Callable[..., None]
    deform: Callable[..., None]
    volume_ratio: Callable[..., None]


@cache
def elastic_kernels(n_dim: int, n_nodes: int, material: Material) -> ElasticKernels:
    """Energy of cells of ``n_nodes`` nodes in ``n_dim`` dimensions, compiled at its first call."""
    place, digest = MATERIALS.index(material), _sources_digest(material)
    make = _accumulate if material.form == "invariants" else principal_kernel
    return ElasticKernels(*(make(n_dim, n_nodes, axial, place, digest) for axial in (0, 1)))


@cache
def cell_kernels(n_dim: int, n_nodes: int) -> CellKernels:
    """Kernels for cells of ``n_nodes`` nodes in ``n_dim`` dimensions, compiled at their first call."""
    digest = _sources_digest(None)
    return CellKernels(
        _dissipate(n_dim, n_nodes, digest),
        _largest_step(n_dim, n_nodes, digest),
        _grow(n_dim, n_nodes, digest),
        _deform(n_dim, n_nodes, digest),
        _volume_ratio(n_dim, n_nodes, digest),
    )


def _sources_digest(material: Material | None) -> int:
    """Checksum, not negative, of the source of everything that is compiled into the kernels."""
    modules: list[Any] = [cell, dashpot, batch, projection, tangents, stress, dispatch]
    if material is not None:
        modules += [inspect.getmodule(f) or f for f in (material.density, material.derivatives)]
    return zlib.crc32("".join(map(inspect.getsource, modules)).encode())


def _accumulate(n_dim: int, n_nodes: int, axial: int, material: int, digest: int) -> Any:
    @njit(cache=True, error_model="numpy")
    def accumulate(  # type: ignore[no-untyped-def]
        u,
        cells,
        base,
        gradients,
        f33,
        slope,
        parameters,
        pressure,
        weight,
        order,
        project_psd,
        position,
        gradient,
        values,
    ):
        """Add every point's energy, forces and matrix; infinite as soon as one is inverted.

        The slope dF33/dw [1/mm] of each point is read where a common F33 is unknown (axial is 1).
        """
        x, g = np.empty((n_nodes, n_dim, BATCH)), np.empty((n_nodes, n_dim, BATCH))
        F, H = np.empty((n_dim, n_dim, BATCH)), np.empty((n_dim + 0 * digest, n_dim, BATCH))
        f, h = np.empty((n_nodes, n_dim, BATCH)), np.empty((n_nodes, n_dim, BATCH))
        det, I1, J, root = np.empty(BATCH), np.empty(BATCH), np.empty(BATCH), np.empty(BATCH)
        moduli, entries = np.empty((5, BATCH)), np.empty(BATCH)
        value = 0.0
        for first in range(0, cells.shape[0], BATCH):
            n = min(BATCH, cells.shape[0] - first)
            gather(n_dim, n_nodes, first, n, u, cells, x)
            load(n_nodes, n_dim, first, n, gradients, g)
            load(n_dim, n_dim, first, n, base, F)
            add_products(n_dim, n_nodes, n, x, g, F)
            if not invert_all(n_dim, n, F, H, det):
                return np.inf
            invariants(n_dim, first, n, F, det, f33, I1, J, root)
            value += energy(material, first, n, I1, J, root, parameters, weight, entries)
            if order == 0:
                continue
            weigh_moduli(material, first, n, I1, J, root, parameters, pressure, weight, moduli)
            products(n_dim, n_nodes, n, F, g, f)
            products(n_dim, n_nodes, n, H, g, h)
            add_forces(n_dim, n_nodes, first, n, f, h, moduli, cells, gradient)
            if axial:
                add_axial_force(first, n, f33, slope, moduli, gradient)
            if order == 2 and project_psd:
                add_projected(n_dim, n_nodes, axial, first, n, F, H, g, f33, slope, moduli, position, values)
            elif order == 2:
                add_matrices(n_dim, n_nodes, first, n, f, h, g, moduli, position, entries, values)
                if axial:
                    add_axial_matrices(
                        n_dim, n_nodes, first, n, f33, slope, f, h, moduli, position, entries, values
                    )
        return value

    return accumulate


def _dissipate(n_dim: int, n_nodes: int, digest: int) -> Any:
    @njit(cache=True)
    def dissipate(  # type: ignore[no-untyped-def]
        u, cells, base, gradients, previous, weight, order, project_psd, position, gradient, values
    ):
        """Add every point's Kelvin-Voigt energy, forces and matrix; ``previous`` is the strain before."""
        x, g = np.empty((n_nodes, n_dim, BATCH)), np.empty((n_nodes, n_dim, BATCH))
        F, B = np.empty((n_dim, n_dim, BATCH)), np.empty((n_dim + 0 * digest, n_dim, BATCH))
        f, s = np.empty((n_nodes, n_dim, BATCH)), np.empty((n_nodes, n_dim, BATCH))
        S, entries = np.empty((n_dim, n_dim, BATCH)), np.empty(BATCH)
        value = 0.0
        for first in range(0, cells.shape[0], BATCH):
            n = min(BATCH, cells.shape[0] - first)
            gather(n_dim, n_nodes, first, n, u, cells, x)
            load(n_nodes, n_dim, first, n, gradients, g)
            load(n_dim, n_dim, first, n, base, F)
            add_products(n_dim, n_nodes, n, x, g, F)
            load(n_dim, n_dim, first, n, previous, S)
            subtract_from_strain(n_dim, n, F, S)
            value += weigh(n_dim, first, n, weight, S, entries)
            if order == 0:
                continue
            products(n_dim, n_nodes, n, S, g, s)
            add_dashpot_forces(n_dim, n_nodes, first, n, F, s, cells, gradient)
            if order == 1:
                continue
            if project_psd:
                project_stresses(n_dim, n, S)
                products(n_dim, n_nodes, n, S, g, s)
            products(n_dim, n_nodes, n, F, g, f)
            squares(n_dim, n, F, B)
            add_dashpot_matrices(n_dim, n_nodes, first, n, B, f, g, s, weight, position, entries, values)
        return value

    return dissipate


def _largest_step(n_dim: int, n_nodes: int, digest: int) -> Any:
    @njit(cache=True, error_model="numpy")
    def largest_step(u, du, cells, base, gradients):  # type: ignore[no-untyped-def]
        """Smallest positive root over the points of det(F + s D) = 0, at most 1; in space just below it."""
        x, g = np.empty((n_nodes, n_dim, BATCH)), np.empty((n_nodes, n_dim, BATCH))
        F, D = np.empty((n_dim + 0 * digest, n_dim, BATCH)), np.empty((n_dim, n_dim, BATCH))
        scratch, largest = np.empty(BATCH), 1.0
        for first in range(0, cells.shape[0], BATCH):
            n = min(BATCH, cells.shape[0] - first)
            gather(n_dim, n_nodes, first, n, u, cells, x)
            load(n_nodes, n_dim, first, n, gradients, g)
            load(n_dim, n_dim, first, n, base, F)
            add_products(n_dim, n_nodes, n, x, g, F)
            gather(n_dim, n_nodes, first, n, du, cells, x)
            D[:] = 0.0
            add_products(n_dim, n_nodes, n, x, g, D)
            if n_dim == 2:
                largest = min(largest, step_to_inversion(n, F, D, scratch))
            else:
                largest = step_to_inversion_in_space(n, F, D, largest)
        return largest

    return largest_step


def _grow(n_dim: int, n_nodes: int, digest: int) -> Any:
    @njit(cache=True, error_model="numpy")
    def grow(F_g, gradients, base, grown, det):  # type: ignore[no-untyped-def]
        """Write F_g^{-1}, the gradients with respect to the grown cell, and det F_g in the plane."""
        g, h = np.empty((n_nodes, n_dim, BATCH)), np.empty((n_nodes, n_dim, BATCH))
        F, H = np.empty((n_dim + 0 * digest, n_dim, BATCH)), np.empty((n_dim, n_dim, BATCH))
        volume = np.empty(BATCH)
        for first in range(0, F_g.shape[0], BATCH):
            n = min(BATCH, F_g.shape[0] - first)
            load(n_dim, n_dim, first, n, F_g, F)
            load(n_nodes, n_dim, first, n, gradients, g)
            invert_all(n_dim, n, F, H, volume)
            products(n_dim, n_nodes, n, H, g, h)
            store(n_nodes, n_dim, first, n, h, grown)
            for l in range(n):
                det[first + l] = volume[l]
                for i in range(n_dim):
                    for j in range(n_dim):
                        base[first + l, i, j] = H[j, i, l]

    return grow


def _deform(n_dim: int, n_nodes: int, digest: int) -> Any:
    @njit(cache=True)
    def deform_all(u, cells, base, gradients, deformation):  # type: ignore[no-untyped-def]
        """Write base + sum_a u_a (x) g_a."""
        F = np.empty((n_dim, n_dim + 0 * digest))
        for c in range(cells.shape[0]):
            deform(n_dim, n_nodes, u, cells[c], base[c], gradients[c], F)
            deformation[c] = F

    return deform_all


def _volume_ratio(n_dim: int, n_nodes: int, digest: int) -> Any:
    @njit(cache=True, error_model="numpy")
    def volume_ratio(u, cells, gradients, ratio):  # type: ignore[no-untyped-def]
        """Write det(I + grad u)."""
        F, H, identity = np.empty((n_dim, n_dim)), np.empty((n_dim + 0 * digest, n_dim)), np.eye(n_dim)
        for c in range(cells.shape[0]):
            deform(n_dim, n_nodes, u, cells[c], identity, gradients[c], F)
            ratio[c] = invert(n_dim, F, H)

    return volume_ratio
