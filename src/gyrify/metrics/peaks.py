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
    peaks = _maxima(profile)
    return peaks[[_prominence(profile, peak) >= prominence for peak in peaks.tolist()]]


def _maxima(profile: FloatArray) -> NDArray[np.int64]:
    """Middles of the plateaus, mostly of one point, that lie above both neighbours."""
    starts = np.flatnonzero(np.concatenate([[True], np.diff(profile) != 0.0]))
    ends = np.append(starts[1:], profile.size) - 1
    level = profile[starts]
    above = np.flatnonzero((level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])) + 1
    return np.asarray((starts[above] + ends[above]) // 2, dtype=np.int64)


def _prominence(profile: FloatArray, peak: int) -> float:
    """Height above the higher of the lowest points on either side, each up to where something is higher."""
    height = profile[peak]
    higher = profile > height
    left = np.flatnonzero(higher[:peak])
    right = np.flatnonzero(higher[peak:])
    first = int(left[-1]) + 1 if left.size else 0
    last = peak + int(right[0]) if right.size else profile.size
    return float(height - max(profile[first : peak + 1].min(), profile[peak:last].min()))
