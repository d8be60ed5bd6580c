"""Cube roots by iteration, and by the library where that would not converge."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit

from gyrify.energy import lanes


@njit
def roots(x, found):
    """Call what is inlined everywhere else."""
    lanes.cube_roots(x.size, x, found)


@pytest.mark.parametrize(("low", "high"), [(0.25, 4.0), (0.9, 1.1), (1e-6, 1e6), (3.9, 4.1), (1e-300, 1e300)])
def test_cube_roots_are_right_to_the_last_digits(low: float, high: float) -> None:
    x = np.geomspace(low, high, 1000)
    found = np.empty_like(x)
    roots(x, found)
    np.testing.assert_allclose(found, np.cbrt(x), rtol=6e-16)


def test_what_is_no_number_stays_none() -> None:
    found = np.empty(2)
    roots(np.array([1.0, np.nan]), found)
    assert found[0] == 1.0
    assert np.isnan(found[1])
