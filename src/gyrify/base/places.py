"""Places in messages."""

from __future__ import annotations

from collections.abc import Iterable


def place(point: Iterable[float]) -> str:
    """A place as text, in mm."""
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ") mm"
