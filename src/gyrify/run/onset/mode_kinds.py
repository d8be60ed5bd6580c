"""What a mode of instability moves: a fold, the surface alone, or the slice as a whole."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from gyrify.mesh import Mesh
from gyrify.mesh.waves import contour_edges, dominant_wave, normal_displacement
from gyrify.metrics.surface import face_areas
from gyrify.run.onset.space_waves import outwards_in_space, surface_wave
from gyrify.solve.types import FloatArray

Kind = Literal["fold", "surface", "twist", "translation", "swelling"]
KINDS: Final[tuple[Kind, ...]] = ("fold", "surface", "twist", "translation", "swelling")

# Share of the contour's squared displacement from which a mode is that motion of the whole.
_WHOLE: Final = 0.5
# A wave sinks by exp(-2 pi depth / wavelength): shorter than this many cortical thicknesses it is over (4 %)
# where the white matter begins, so that it is none of a layer. A wave on so few points is the mesh's limit.
_SHORT: Final = 2.0
_FEW_POINTS: Final = 4.0


@dataclass(frozen=True)
class Wave:
    """What a mode moves.

    Attributes
    ----------
    kind : {"fold", "surface", "twist", "translation", "swelling"}
        ``fold``: the cortex undulates; ``surface``: waves so short that the white matter is not reached, or
        that the mesh cannot resolve them; ``twist``: a rotation about the hole; ``translation``: a shift
        against it; ``swelling``: uniformly outwards or inwards.
    mode_number : int
        Waves along the contour (along one period of a strip), in space see `surface_wave`: 0 for twist and
        swelling.
    wavelength : float
        Deformed length of the contour over the mode number [mm], in space see `surface_wave`; 0 where the
        number is 0.
    """

    kind: Kind
    mode_number: int
    wavelength: float


def wave_of(mesh: Mesh, u: FloatArray, mode: FloatArray) -> Wave:
    """What a mode moves.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh.
    u : (n_points, n_dim) float array
        State [mm].
    mode : (n_points, n_dim) float array
        Displacement from there, in any unit.

    Returns
    -------
    Wave
    """
    if mesh.n_dim == 3:
        number, wavelength = surface_wave(mesh, u, mode)
        if number == 0:
            return Wave("swelling", 0, 0.0)
        is_at_limit = wavelength < _FEW_POINTS * np.sqrt(_area_per_point(mesh, u))
        return Wave("surface" if is_at_limit else "fold", number, wavelength)
    lengths = np.linalg.norm(contour_edges(mesh, u), axis=1)
    weight = 0.5 * (lengths + np.roll(lengths, 1))
    total, moved = float(weight.sum()), mode[mesh.contour]
    square = float(weight @ np.sum(moved * moved, axis=1))
    shift = weight @ moved / total
    if total * float(shift @ shift) > _WHOLE * square:
        return Wave("translation", 1, total)
    if mesh.is_closed and _twisting(mesh, u, moved, weight) > _WHOLE * square:
        return Wave("twist", 0, 0.0)
    number, wavelength = dominant_wave(mesh, u, mode)
    if number == 0:
        return Wave("swelling", 0, 0.0)
    is_short = wavelength < _SHORT * mean_thickness(mesh, u)
    is_at_limit = mesh.contour.size < _FEW_POINTS * number
    return Wave("surface" if is_short or is_at_limit else "fold", number, wavelength)


def _area_per_point(mesh: Mesh, u: FloatArray) -> float:
    """Area of a deformed surface over its number of points [mm^2]."""
    return float(face_areas(mesh.unwrapped(mesh.faces) + u[mesh.faces]).sum()) / mesh.contour.size


def _twisting(mesh: Mesh, u: FloatArray, moved: FloatArray, weight: FloatArray) -> float:
    """Part of the contour's squared displacement that is a rotation about the centre of the hole."""
    x = mesh.points[mesh.contour] + u[mesh.contour] - mesh.points[mesh.clamped].mean(axis=0)
    around = np.stack([-x[:, 1], x[:, 0]], axis=1)
    along = float(weight @ np.sum(around * moved, axis=1))
    return along**2 / float(weight @ np.sum(around * around, axis=1))


def mean_thickness(mesh: Mesh, u: FloatArray) -> float:
    """Area of the deformed cortex over the length of its contour [mm]."""
    x = mesh.points + u[: mesh.n_points]
    length = float(np.linalg.norm(contour_edges(mesh, u), axis=1).sum())
    return abs(_area(mesh, x[mesh.contour]) - _area(mesh, x[mesh.interface])) / length


def _area(mesh: Mesh, line: FloatArray) -> float:
    """Area within a closed line, or under one period of an open one [mm^2]."""
    after = np.roll(line, -1, axis=0)
    if mesh.period is not None:
        after[-1, 0] += mesh.period * np.sign(line[1, 0] - line[0, 0])
        return abs(float(np.sum(0.5 * (line[:, 1] + after[:, 1]) * (after[:, 0] - line[:, 0]))))
    return 0.5 * abs(float(np.sum(line[:, 0] * after[:, 1] - line[:, 1] * after[:, 0])))


def outwards(mesh: Mesh, u: FloatArray, mode: FloatArray) -> FloatArray:
    """A mode with the sign by which its largest displacement normal to the contour points outwards."""
    if mesh.n_dim == 3:
        return outwards_in_space(mesh, u, mode)
    normal = normal_displacement(mesh, u, mode)
    # Among peaks that are equal but for rounding, the first one decides.
    peak = int(np.argmax(np.abs(normal) > (1.0 - 1e-6) * np.abs(normal).max()))
    return mode if normal[peak] >= 0.0 else -mode
