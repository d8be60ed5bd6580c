"""Where a smooth branch turns back, from its last two states."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from gyrify.errors import SolveError
from gyrify.run.onset.crossing import limit_point
from gyrify.run.onset.onset_search import OnsetSearch


def test_the_square_of_the_eigenvalue_goes_to_zero_along_a_line() -> None:
    # eigenvalue sqrt(2 - t)
    assert limit_point(0.0, 1.0, 2.0**0.5, 1.0) == pytest.approx(2.0)
    assert limit_point(0.5, 1.75, 1.5**0.5, 0.5) == pytest.approx(2.0)


@pytest.mark.parametrize(("first", "last"), [(1.0, -0.5), (-1.0, -2.0), (1.0, 1.0), (0.5, 1.0), (1.0, 0.0)])
def test_states_that_are_unstable_or_grow_stiffer_tell_none(first: float, last: float) -> None:
    assert limit_point(0.0, 1.0, first, last) is None


def test_a_branch_that_is_unstable_at_its_end_has_crossed_and_not_turned_back() -> None:
    """Halvings towards a state that is not found may pass the loss of stability."""
    eigenvalues = {0.0: 2.0, 0.1: 1.0, 0.125: -0.5}
    search, told = object.__new__(OnsetSearch), []
    unstable = SimpleNamespace(tangent=lambda _: SimpleNamespace(n_negative=2))
    vars(search).update(
        _branch=SimpleNamespace(known=eigenvalues, at=lambda _: unstable),
        _lowest=SimpleNamespace(at=eigenvalues.get, system=None),
        _change=lambda state, before: told.append((state, before)),
        _n_negative=0, onset=None, changes=[],
    )  # fmt: skip
    search._end_at_limit_point(0.15)
    assert told == [(unstable, 0)]
    assert search._n_negative == 2
    assert search.onset is None


@pytest.mark.parametrize("fault", ["modes", "state"])
def test_modes_that_are_not_found_are_no_end_of_the_branch(fault: str) -> None:
    """A solver that gives up at a state tells nothing of the states beyond it."""

    def fails(*_: object) -> object:
        raise SolveError("not found", "")

    state = SimpleNamespace(is_folded=False, tangent=fails)
    search, told = object.__new__(OnsetSearch), []
    vars(search).update(
        _branch=SimpleNamespace(at=fails if fault == "state" else lambda *_: state),
        _lowest=SimpleNamespace(system=None), _last=SimpleNamespace(fraction=0.2), _duration=500.0,
        _mesh=SimpleNamespace(n_dim=3), _n_negative=0, onset=None, _end_at_limit_point=told.append,
    )  # fmt: skip
    search._look(0.25)
    assert search.lost_at == 100.0
    assert told == ([0.25] if fault == "state" else [])
