"""How wide and how flat gyri are, from the profile between the two sulci beside each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gyrify.metrics.contour import FloatArray
from gyrify.metrics.folds import Folds

# Heights above the higher of the two sulci, over that of the crown, at which a gyrus is cut.
_HALF, _TOP = 0.5, 0.75


@dataclass(frozen=True, eq=False)
class GyrusShapes:
    """Width and flatness of every gyrus, in the order of the crowns.

    Attributes
    ----------
    width : (n_gyri,) float array
        Chord across the gyrus at half its height [mm]. Half the wavelength for a cosine, two thirds of it for
        a cusped profile |cos|, and nearly all of it where the sulci are closed.
    flatness : (n_gyri,) float array
        Chord at three quarters of the height over that between the two fundi [-], at most 1: 1/4 for a
        triangle, 1/3 for a cosine, 0.46 for |cos|, 1 for a box.
    """

    width: FloatArray
    flatness: FloatArray

    @property
    def mean_width(self) -> float:
        """Mean width [mm]; 0 without gyri."""
        return float(self.width.mean()) if len(self.width) else 0.0

    @property
    def mean_flatness(self) -> float:
        """Mean flatness [-]; 0 without gyri."""
        return float(self.flatness.mean()) if len(self.flatness) else 0.0


def gyrus_shapes(folds: Folds, *, closed: bool = True) -> GyrusShapes:
    """Width and flatness of every gyrus.

    A gyrus reaches from fundus to fundus. Its height is that of its crown above the higher of the two; going
    down from the crown on either side, the first point below half (three quarters) of it ends the chord.
    Where sulci are closed, the fundi can lie closer to one another than the walls: flatness is cut at 1.

    Parameters
    ----------
    folds : Folds
        Gyri and sulci of a contour.
    closed : bool
        Whether the first point follows the last; otherwise it is one period of a strip, whose last point is
        the first one moved by the period.

    Returns
    -------
    GyrusShapes
    """
    if folds.n_gyri == 0:
        return GyrusShapes(np.empty(0), np.empty(0))
    points, height, n = _unrolled(folds, closed)
    width, flatness = np.empty(folds.n_gyri), np.empty(folds.n_gyri)
    for number, (left, crown, right) in enumerate(_spans(folds, n)):
        foot = max(height[left], height[right])
        half, top = (
            _chord(points, height, (left, crown, right), foot + level * (height[crown] - foot))
            for level in (_HALF, _TOP)
        )
        base = float(np.hypot(*(points[right] - points[left])))
        width[number], flatness[number] = half, min(top / base, 1.0) if base > 0 else 1.0
    return GyrusShapes(width, flatness)


def _unrolled(folds: Folds, closed: bool) -> tuple[FloatArray, FloatArray, int]:
    """Three turns of the contour, so that every gyrus of the middle one is in one piece."""
    points, height = folds.points, folds.displacement
    step = np.zeros(2)
    if not closed:
        step = points[-1] - points[0]
        points, height = points[:-1], height[:-1]
    turns = np.concatenate([points - step, points, points + step])
    return turns, np.tile(height, 3), len(points)


def _spans(folds: Folds, n: int) -> list[tuple[int, int, int]]:
    """Left fundus, crown and right fundus of every gyrus, as indices into three turns."""
    fundi = np.sort(np.concatenate([folds.fundi % n + turn * n for turn in range(3)]))
    crowns: NDArray[np.int64] = folds.crowns % n + n
    after = np.searchsorted(fundi, crowns, side="right")
    return [(int(fundi[k - 1]), int(crown), int(fundi[k])) for crown, k in zip(crowns, after, strict=True)]


def _chord(points: FloatArray, height: FloatArray, span: tuple[int, int, int], level: float) -> float:
    """Distance between the points where the profile first falls to a level on either side of the crown."""
    left, crown, right = span
    ends = []
    for stop, step in ((left, -1), (right, 1)):
        side = np.arange(crown, stop + step, step)
        below = int(np.argmax(height[side] <= level))
        high, low = side[below - 1], side[below]
        share = (height[high] - level) / (height[high] - height[low])
        ends.append(points[high] + share * (points[low] - points[high]))
    return float(np.hypot(*(ends[1] - ends[0])))
