"""What a configuration tells before anything is computed."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final

from gyrify.run.validity.inverted_cells import inversion
from gyrify.run.validity.lengths import check_lengths
from gyrify.run.validity.locking import locking
from gyrify.run.validity.ranges import check_ranges
from gyrify.run.validity.resolution import resolution
from gyrify.run.validity.surface_notes import surface_notes

if TYPE_CHECKING:
    from gyrify.config import Config

CHECKS: Final[tuple[Callable[[Config], list[str]], ...]] = (
    check_ranges,
    check_lengths,
    resolution,
    locking,
    inversion,
    surface_notes,
)


def config_warnings(config: Config) -> list[str]:
    """Sentences on what is legal, but outside what was verified.

    Parameters
    ----------
    config : Config
        Every number of the run.

    Returns
    -------
    list of str
        Each says what, why, and what to do about it; empty where nothing is to be said.
    """
    return [sentence for check in CHECKS for sentence in check(config)]
