"""What a state that dissipation holds back has become without it."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass
from typing import Final

# Folds are the same while the index by the closing changes by no more than this; it is known to about that
# between seeds of the node jitter.
KEPT: Final = 0.02


@dataclass(frozen=True)
class Relaxation:
    """What a state relaxes to without dissipation, while growth stands still.

    Attributes
    ----------
    gi_closing : float
        Gyrification index by the closing of the relaxed state [-].
    n_gyri : int
        Its gyri.
    moved_mm : float
        Largest displacement of a point on the way [mm].
    is_kept : bool
        Whether the folds are the same: as many gyri, and an index within `KEPT`.
    """

    gi_closing: float
    n_gyri: int
    moved_mm: float
    is_kept: bool

    def to_text(self) -> str:
        """JSON."""
        return json.dumps(asdict(self))

    @staticmethod
    def from_text(text: str) -> Relaxation | None:
        """Relaxation of its JSON; None where that is not one."""
        try:
            found = Relaxation(**json.loads(text))
        except (ValueError, TypeError, RecursionError):
            return None
        numbers = (found.gi_closing, found.moved_mm)
        if not all(type(value) is float and math.isfinite(value) for value in numbers):
            return None
        return found if type(found.n_gyri) is int and type(found.is_kept) is bool else None
