"""How much sharper sulci are than gyri: cusped sulci between smooth gyri, or the same wave below as above."""

from __future__ import annotations

import numpy as np

from gyrify.metrics.contour import FloatArray
from gyrify.metrics.folds import Folds

# Longest piece of contour around a crown or fundus on which turning is summed, over the spacing of folds.
_WINDOW = 0.25
# Stands for crowns that do not turn at all.
_SHARPEST = 100.0


def fold_sharpness(folds: Folds, *, closed: bool = True) -> float:
    """Turning of the contour at fundi over that at crowns.

    Around a fundus (the other way round a crown) the direction of the contour changes. Of all pieces that are
    centred there and no longer than a quarter of the fold spacing (contour length over number of gyri), the
    one that turns most counts: a narrow slit is not balanced by its lips. What the whole contour turns by on
    that length is left out, so that folds of a strip and of a ring compare.

    Parameters
    ----------
    folds : Folds
        Gyri and sulci of a contour.
    closed : bool
        Whether the first point follows the last; otherwise it is one period of a strip, whose last point is
        the first one moved by the period.

    Returns
    -------
    float
        Ratio of the mean turnings [-]: 1 for a sine wave, above 1 for sulci sharper than gyri; 1 without
        folds, and at most 100.
    """
    if folds.n_gyri == 0:
        return 1.0
    at, turning, length = _turnings(folds.points, closed)
    turning -= (2 * np.pi if closed else 0.0) * _shares(at, length)
    reach = 0.5 * _WINDOW * length / folds.n_gyri
    n = len(at)
    above = _mean([_most(at, turning, at[i % n], reach, length) for i in folds.crowns])
    below = _mean([_most(at, -turning, at[i % n], reach, length) for i in folds.fundi])
    return float(min(below / above, _SHARPEST)) if above > 0 else _SHARPEST


def _turnings(points: FloatArray, closed: bool) -> tuple[FloatArray, FloatArray, float]:
    """Arc length at every point, the angle turned by there (outwards positive), and the whole length."""
    z = points[:, 0] + 1j * points[:, 1]
    edges = np.diff(np.append(z, z[0])) if closed else np.diff(z)
    arc = np.concatenate([[0.0], np.cumsum(np.abs(edges))])
    turning = np.angle(edges * np.conj(np.roll(edges, 1)))
    # Crowns turn to the left on a ring that runs counter-clockwise, to the right on a strip towards +x.
    outwards = np.sign(turning.sum()) if closed else -1.0
    return arc[:-1], outwards * turning, float(arc[-1])


def _shares(at: FloatArray, length: float) -> FloatArray:
    """Share of the length that belongs to every point: half of either edge."""
    edges = np.diff(np.append(at, length))
    return np.asarray(0.5 * (edges + np.roll(edges, 1)) / length)


def _most(at: FloatArray, turning: FloatArray, centre: float, reach: float, length: float) -> float:
    """Largest angle turned by on a piece about a place on a periodic line, at most so far on either side."""
    apart = np.abs(at - centre)
    apart = np.minimum(apart, length - apart)
    near = np.flatnonzero(apart <= reach)
    return float(np.cumsum(turning[near[np.argsort(apart[near], kind="stable")]]).max(initial=0.0))


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)
