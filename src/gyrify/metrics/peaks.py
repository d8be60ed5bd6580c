"""Prominent maxima of a profile, as `scipy.signal.find_peaks` finds them.

That module takes longer to import than a run may last, for the sake of this one function.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def prominent_maxima(profile: FloatArray, prominence: float) -> NDArray[np.int64]:
    """Maxima that rise by at least the prominence above the higher of the two saddles beside them.

    Parameters
    ----------
    profile : (n,) float array
        Heights; the ends are no maxima.
    prominence : float
        Least prominence, in the unit of the heights.

    Returns
    -------
    (n_maxima,) int array
        Indices in increasing order; of a plateau, its middle.
    """
    if np.ptp(profile) < prominence:  # mostly noise, with many maxima
        return np.empty(0, dtype=np.int64)
    peaks = _maxima(profile)
    if peaks.size == 0:
        return peaks
    heights = profile[peaks]
    valleys = np.minimum.reduceat(profile, np.concatenate([[0], peaks]))
    left = _lowest_before(heights.tolist(), valleys[:-1].tolist())
    right = _lowest_before(heights[::-1].tolist(), valleys[:0:-1].tolist())[::-1]
    return peaks[heights - np.maximum(left, right) >= prominence]


def _maxima(profile: FloatArray) -> NDArray[np.int64]:
    """Middles of the plateaus, mostly of one point, that lie above both neighbours."""
    starts = np.flatnonzero(np.concatenate([[True], np.diff(profile) != 0.0]))
    ends = np.append(starts[1:], profile.size) - 1
    level = profile[starts]
    above = np.flatnonzero((level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])) + 1
    return np.asarray((starts[above] + ends[above]) // 2, dtype=np.int64)


def _lowest_before(heights: list[float], valleys: list[float]) -> list[float]:
    """Lowest valley between each peak and the next higher one before it; each valley lies before its peak."""
    found: list[float] = []
    falling: list[tuple[float, float]] = []
    for height, lowest in zip(heights, valleys, strict=True):
        while falling and falling[-1][0] <= height:
            lowest = min(lowest, falling.pop()[1])
        falling.append((height, lowest))
        found.append(lowest)
    return found
