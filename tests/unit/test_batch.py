"""Arithmetic of a batch: cube roots by iteration or by the library, and what counts as a volume."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit

from gyrify.energy import batch as batch


@njit
def roots(x, found):
    """Call what is inlined everywhere else."""
    batch.cube_roots(x.size, x, found)


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


@njit(error_model="numpy")
def are_volumes(F, H, det):
    """Call what is inlined everywhere else."""
    return batch.invert(2, det.size, F, H, det)


@pytest.mark.parametrize(
    ("volumes", "are_positive"),
    [
        ((1.0, 2.0, 3.0), True),
        ((1.0, -1.0, 1.0), False),
        ((1.0, 0.0, 1.0), False),
        ((np.nan, 1.0, 1.0), False),
        ((-1.0, np.nan, 1.0), False),
    ],
)
def test_only_positive_numbers_are_volumes(volumes: tuple[float, ...], are_positive: bool) -> None:
    F = np.einsum("l,ij->ijl", np.ones(3), np.eye(2))
    F[0, 0] = volumes
    det, H = np.empty(3), np.empty((2, 2, 3))
    assert are_volumes(F, H, det) == are_positive
    np.testing.assert_array_equal(det, volumes)
