"""Waves along the contour: the Fourier number of a displacement by deformed arc length."""

from __future__ import annotations

import numpy as np

from gyrify.mesh.mesh import FloatArray, Mesh

_SAMPLES = 4096


def normal_displacement(mesh: Mesh, u: FloatArray, du: FloatArray) -> FloatArray:
    """Part of a displacement normal to the deformed contour.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh.
    u : (n_points, 2) float array
        State [mm].
    du : (n_points, 2) float array
        Displacement from there, in any unit.

    Returns
    -------
    (n_contour,) float array
        Positive outwards, in the unit of ``du``.
    """
    edges = contour_edges(mesh, u)
    tangent = edges + np.roll(edges, 1, axis=0)
    normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(np.sum(du[mesh.contour] * normal, axis=1) * _outwards(mesh))


def dominant_wave(mesh: Mesh, u: FloatArray, du: FloatArray) -> tuple[int, float]:
    """Dominant wave of a displacement along the contour.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh.
    u : (n_points, 2) float array
        State [mm].
    du : (n_points, 2) float array
        Displacement from there, in any unit.

    Returns
    -------
    mode_number : int
        Number of the wave of largest amplitude in the normal displacement over arc length, 0 for a uniform
        one: waves around the contour, or along one period of a strip.
    wavelength : float
        Deformed length of the contour over the mode number [mm]; 0 where that is 0.
    """
    lengths = np.linalg.norm(contour_edges(mesh, u), axis=1)
    arc, length = np.cumsum(lengths) - lengths, float(lengths.sum())
    at = np.arange(_SAMPLES) * (length / _SAMPLES)
    height = np.interp(at, arc, normal_displacement(mesh, u, du), period=length)
    amplitude = np.abs(np.fft.rfft(height))
    amplitude[0] *= 0.5  # a wave has a coefficient at its negative number too
    mode_number = int(np.argmax(amplitude))
    return mode_number, length / mode_number if mode_number else 0.0


def contour_edges(mesh: Mesh, u: FloatArray) -> FloatArray:
    """(n_contour, 2) deformed edges [mm], the last one back to the first point or across the period."""
    x = mesh.points[mesh.contour] + u[mesh.contour]
    edges = np.roll(x, -1, axis=0) - x
    if mesh.period is not None:
        edges[-1, 0] += mesh.period * np.sign(edges[0, 0])
    return np.asarray(edges)


def _outwards(mesh: Mesh) -> float:
    """1 where the contour runs such that its right-hand normal points out of the tissue, else -1."""
    if mesh.is_closed:
        return 1.0
    return -1.0 if mesh.points[mesh.contour[1], 0] > mesh.points[mesh.contour[0], 0] else 1.0
