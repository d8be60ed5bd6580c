"""Prominent maxima against SciPy's, and on profiles whose answer is plain."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.signal import find_peaks

from gyrify.metrics.peaks import prominent_maxima

LEVELS = hnp.arrays(np.float64, st.integers(3, 60), elements=st.integers(-4, 4).map(float))


@settings(deadline=None)
@given(profile=LEVELS, prominence=st.integers(1, 6))
def test_the_same_as_scipy_on_profiles_with_plateaus(profile: np.ndarray, prominence: int) -> None:
    expected, _ = find_peaks(profile, prominence=prominence)
    assert prominent_maxima(profile, prominence).tolist() == expected.tolist()


@settings(deadline=None)
@given(seed=st.integers(0, 10**6), prominence=st.floats(0.1, 3.0))
def test_the_same_as_scipy_on_random_walks(seed: int, prominence: float) -> None:
    profile = np.cumsum(np.random.default_rng(seed).standard_normal(200))
    expected, _ = find_peaks(profile, prominence=prominence)
    assert prominent_maxima(profile, prominence).tolist() == expected.tolist()


@pytest.mark.parametrize(("prominence", "expected"), [(0.5, [1, 4, 7]), (2.0, [1, 7]), (2.1, [7]), (6.0, [])])
def test_saddles_decide(prominence: float, expected: list[int]) -> None:
    """Heights 4, 3, 5 over saddles 2 and 2.5, ends 0: prominences 2, 0.5 and 5; 4 is a plateau's middle."""
    profile = np.array([0.0, 4.0, 2.0, 3.0, 3.0, 3.0, 2.5, 5.0, 0.0])
    assert prominent_maxima(profile, prominence).tolist() == expected


def test_a_maximum_that_rises_by_just_the_prominence_counts() -> None:
    profile = np.array([0.0, 1.0, 0.0])
    assert prominent_maxima(profile, 1.0).tolist() == [1]
    assert prominent_maxima(profile, float(np.nextafter(1.0, 2.0))).size == 0
