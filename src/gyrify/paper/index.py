"""What a reading calls gyrification index: a definition, and the disc that closes the sulci."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from gyrify.config import Config, parse_number
from gyrify.errors import ConfigError
from gyrify.metrics.contour import filled, fitting_radius, offset_outline
from gyrify.metrics.gyrification import closing_length
from gyrify.metrics.measure import measure_valid
from gyrify.metrics.quantities import flat
from gyrify.study import StoredPoint

GiDefinition = Literal["closing", "hull", "exposed", "picture"]
STANDARD_RADIUS: Final = 10.0
# Width of a printed line on the tissue [mm]: half a point, 0.18 mm, where a folded slice some 115 mm wide is
# printed 43 mm wide, four to a page as in Figure 2. What is narrower is seen as a line and not as a sulcus.
PEN: Final = 0.5


@dataclass(frozen=True, order=True)
class Index:
    """A gyrification index.

    Attributes
    ----------
    definition : {"closing", "hull", "exposed", "picture"}
        As of `gyrify.gyrification_index`; ``"picture"`` is the closing's as a person measures it on a printed
        slice, who cannot follow a sulcus that is narrower than the line it is drawn with.
    radius : float
        Of the closing [mm]; sulcal depth is measured below its outline too.
    pen : float
        Width of the line that a picture is drawn with [mm].
    """

    definition: GiDefinition = "closing"
    radius: float = STANDARD_RADIUS
    pen: float = PEN

    def __str__(self) -> str:
        word = self.definition + ("" if self.radius == STANDARD_RADIUS else f" of {self.radius:g} mm")
        return word + ("" if self.pen == PEN else f" with a line of {self.pen:g} mm")

    @property
    def constants(self) -> tuple[str, ...]:
        """Numbers of it that differ from those that were fixed before any comparison."""
        fitted = {"closing radius": self.radius != STANDARD_RADIUS, "width of the line": self.pen != PEN}
        return tuple(name for name, is_fitted in fitted.items() if is_fitted)

    @property
    def is_fitted(self) -> bool:
        """Whether it has a fitted constant."""
        return bool(self.constants)


STANDARD_INDEX: Final = Index()
# Those that a search chooses from.
INDICES: Final = (
    STANDARD_INDEX,
    *(Index("closing", radius) for radius in (9.0, 8.0, 7.0, 6.0)),
    Index("hull"),
    Index("exposed"),
    *(Index("picture", pen=pen) for pen in (PEN, 0.3, 0.2, 0.1, 0.05)),
)


def index_metrics(
    index: Index, config: Config, summary: Mapping[str, Any], stored: Callable[[], StoredPoint]
) -> dict[str, Any]:
    """Metrics of a completed run with one index, which is ``gi`` among them.

    Parameters
    ----------
    index : Index
        Which one.
    config : Config
        The run.
    summary : mapping
        As in ``summary.json``; it serves where it has the index.
    stored : callable
        Gives the stored run, which is measured anew where the summary has another radius.

    Returns
    -------
    dict
        Names as in ``metrics.csv``.
    """
    metrics = config.metrics
    if index.radius == metrics.closing_radius and index.definition != "picture":
        row = flat(summary)
        return {**row, "gi": row[f"gi_{index.definition}"]}
    contour, interface = stored().contour, stored().interface
    found = measure_valid(
        contour, interface, index.radius, metrics.gyrus_prominence, metrics.samples, None
    ).flat()
    named = f"gi_{index.definition}"
    return {
        **found,
        "gi": found[named] if named in found else picture_index(contour, index.radius, index.pen),
    }


def picture_index(contour: NDArray[np.float64], radius: float, pen: float = PEN) -> float:
    """Index of a contour as it is measured on a picture.

    Parameters
    ----------
    contour : (n, 2) float array
        Closed contour in order [mm].
    radius : float
        Of the closing that is the exposed outline [mm].
    pen : float
        Width of the line [mm]; narrower sulci count only as far as they are wider.

    Returns
    -------
    float
        GI [-].
    """
    tissue = filled(contour)
    hull = float(tissue.convex_hull.length)
    wide = fitting_radius(tissue, radius)
    seen = closing_length(offset_outline(tissue, 0.5 * pen), 0.5 * pen, hull)
    return seen / closing_length(offset_outline(tissue, wide), wide, hull)


def require_gi(word: str, radius: float = STANDARD_RADIUS) -> Index:
    """An index by its name: ``"closing"``, or ``"picture:0.2"`` for one with a line of 0.2 mm.

    Raises
    ------
    ConfigError
        If there is none of that name.
    """
    name, colon, width = word.partition(":")
    if name == "picture" and colon:
        return Index("picture", radius, _pen(word, width, radius))
    for known in get_args(GiDefinition):
        if word == known:
            return Index(known, radius)
    known_words = ", ".join(get_args(GiDefinition))
    raise ConfigError(f"gi = {word[:60]!r} is not known.", f"Choose one of {known_words}, picture:0.2.")


def _pen(word: str, width: str, radius: float) -> float:
    with suppress(ValueError):
        pen = parse_number(width)
        if 0.0 < pen < radius:
            return pen
    raise ConfigError(
        f"gi = {word[:60]!r}: the width of the line must be above 0 and below {radius:g} mm.",
        f"Try picture:{PEN:g}.",
    )
