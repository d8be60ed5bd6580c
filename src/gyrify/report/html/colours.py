"""Colour maps that all eyes tell apart, sampled for a page."""

from __future__ import annotations

from typing import Final

import matplotlib as mpl
import numpy as np

from gyrify.report.layout import COLOURS

# Viridis for scalars. Of diverging ones, blue to red through white keeps its order for every colour vision.
_MAPS: Final = {"sequential": "viridis", "diverging": "RdBu_r"}
_SAMPLES: Final = 64


def colour_maps() -> dict[str, list[str]]:
    """Samples of each map from low to high, and the tissues' colours (white, then grey matter)."""
    places = np.linspace(0.0, 1.0, _SAMPLES)
    maps = {
        kind: [mpl.colors.to_hex(colour) for colour in mpl.colormaps[name](places)]
        for kind, name in _MAPS.items()
    }
    return {**maps, "region": [COLOURS["white"], COLOURS["grey"]]}
