"""Where a smooth branch turns back, from its last two states."""

from __future__ import annotations

import pytest

from gyrify.run.onset.crossing import limit_point


def test_the_square_of_the_eigenvalue_goes_to_zero_along_a_line() -> None:
    # eigenvalue sqrt(2 - t)
    assert limit_point(0.0, 1.0, 2.0**0.5, 1.0) == pytest.approx(2.0)
    assert limit_point(0.5, 1.75, 1.5**0.5, 0.5) == pytest.approx(2.0)


@pytest.mark.parametrize(("first", "last"), [(1.0, -0.5), (-1.0, -2.0), (1.0, 1.0), (0.5, 1.0), (1.0, 0.0)])
def test_states_that_are_unstable_or_grow_stiffer_tell_none(first: float, last: float) -> None:
    assert limit_point(0.0, 1.0, first, last) is None
