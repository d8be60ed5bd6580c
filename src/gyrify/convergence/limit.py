"""From the values of one metric on successive levels to its order, its limit and a verdict, by a rule."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

RULE: Final = (
    "Error of the finest level: from three levels that approach a limit monotonically with an order p of 0.5 "
    "to 4, 1.25 times the distance to the limit of Richardson's extrapolation; from three others, the "
    "largest difference among them; from two, three times their difference. A count has the largest "
    "difference among the two finest levels. Converged means an error of at most the tolerance, relative to "
    "the finest value or, for depths, to 0.1 mm times the scale of the body if that is more (a count: no "
    "difference). The finest level, and the one before it, must be known."
)
# Safety factors of the grid convergence index, with an order and without (Roache 1994).
_SAFETY_WITH_ORDER: Final = 1.25
_SAFETY_OF_TWO: Final = 3.0
# Orders outside of this are no property of the elements but chance.
_ORDERS: Final = (0.5, 4.0)
# Differences below this, relative to the size of the value, are rounding and tolerance, and have no order.
_NOISE: Final = 1e-9


@dataclass(frozen=True)
class Verdict:
    """What the levels say of one metric.

    Attributes
    ----------
    values : tuple of float or None
        Coarse to fine; None where a level has none.
    order : float or None
        Order p by which differences fall when the resolution is halved, where there is one.
    limit : float or None
        Richardson's extrapolation, where there is an order.
    error : float or None
        Estimated error of the finest value, in its unit; None where it is unknown.
    relative_error : float or None
        Error over the finest value.
    converged : bool or None
        Verdict; None where it is unknown.
    sentence : str
        Verdict in words.
    pace : float or None
        Order by which the last differences fall, where the levels approach a limit monotonically: the order
        itself, or one outside of 0.5 to 4, which is not trusted.
    """

    values: tuple[float | None, ...]
    order: float | None
    limit: float | None
    error: float | None
    relative_error: float | None
    converged: bool | None
    sentence: str
    pace: float | None = None

    @property
    def note(self) -> str:
        """Why no limit is extrapolated although the levels approach one; else empty."""
        if self.pace is None or self.order is not None:
            return ""
        return (
            f"differences fall with order {self.pace:.2g}, outside of {_ORDERS[0]:g} to {_ORDERS[1]:g}: no "
            "limit is extrapolated"
        )

    def as_dict(self) -> dict[str, Any]:
        """Plain values, fit for JSON."""
        return {**asdict(self), "values": list(self.values)}


def judge(
    values: Sequence[float | None], tolerance: float, *, is_count: bool = False, least: float = 0.0
) -> Verdict:
    """Judge one metric by `RULE`.

    Parameters
    ----------
    values : sequence of float or None
        Values, coarse to fine, each level twice as fine as the one before.
    tolerance : float
        Largest relative error that counts as converged.
    is_count : bool
        Whether the metric is a whole number.
    least : float
        Size below which errors are relative to this instead of the finest value.

    Returns
    -------
    Verdict
    """
    kept = tuple(values)
    finest = _finest(kept)
    if len(finest) < 2:
        return Verdict(kept, None, None, None, None, None, f"unknown: {_missing(kept)}")
    scale = max(abs(finest[-1]), least)
    pace = None if is_count else observed_pace(finest, scale)
    order = None if is_count else observed_order(finest, scale)
    limit = None if order is None else finest[-1] + (finest[-1] - finest[-2]) / (2.0**order - 1.0)
    error = _error(finest, limit, is_count)
    relative = error / scale if scale > 0.0 else (math.inf if error > 0.0 else 0.0)
    converged = error == 0.0 if is_count else relative <= tolerance
    sentence = _count_sentence(error) if is_count else _sentence(relative, converged)
    known = relative if math.isfinite(relative) else None
    return Verdict(kept, order, limit, error, known, converged, sentence, pace)


def _count_sentence(error: float) -> str:
    return f"not converged: ±{error:.0f}" if error else "converged: the same on the two finest"


def _sentence(relative: float, converged: bool) -> str:
    percent = 100.0 * relative
    if percent < 0.01:
        share = "0.01 %"
    elif percent > 1000.0:
        share = "more than 1000 %"
    else:
        share = f"{percent:.2g} %" if percent < 10.0 else f"{percent:.0f} %"
    return f"converged to {share}" if converged else f"not converged ({share})"


def _missing(values: tuple[float | None, ...]) -> str:
    if all(value is None for value in values):
        return "no level has a value"
    return "the finest level has no value" if values[-1] is None else "the level before the finest has none"


def observed_order(values: Sequence[float], scale: float) -> float | None:
    """Order of the last three values, if they approach a limit monotonically and at a credible pace."""
    order = observed_pace(values, scale)
    return order if order is not None and _ORDERS[0] <= order <= _ORDERS[1] else None


def observed_pace(values: Sequence[float], scale: float) -> float | None:
    """Order by which the differences of the last three values fall, if they are monotone; credible or not."""
    if len(values) < 3:
        return None
    first, second = values[-2] - values[-3], values[-1] - values[-2]
    if min(abs(first), abs(second)) <= _NOISE * scale or first * second < 0.0:
        return None
    return math.log2(first / second)


def _finest(values: tuple[float | None, ...]) -> tuple[float, ...]:
    """The unbroken sequence of known values that ends at the finest level, at most three."""
    found: list[float] = []
    for value in reversed(values[-3:]):
        if value is None:
            break
        found.append(value)
    return tuple(reversed(found))


def _error(finest: tuple[float, ...], limit: float | None, is_count: bool) -> float:
    if is_count:
        return abs(finest[-1] - finest[-2])
    if limit is not None:
        return _SAFETY_WITH_ORDER * abs(limit - finest[-1])
    if len(finest) == 2:
        return _SAFETY_OF_TWO * abs(finest[1] - finest[0])
    return max(finest) - min(finest)
