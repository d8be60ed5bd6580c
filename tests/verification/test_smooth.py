"""Growth of both tissues alike keeps the slice smooth."""

from __future__ import annotations

import numpy as np
import pytest

from gyrify import simulate
from gyrify.config import Config


def gyrification(contour: np.ndarray) -> float:
    """Contour length over the perimeter of its convex hull."""
    import shapely

    return (
        np.linalg.norm(np.roll(contour, -1, axis=0) - contour, axis=1).sum()
        / shapely.Polygon(contour).convex_hull.length
    )


def test_growth_ratio_one_stays_smooth() -> None:
    """The reference slice with jitter and drag, in larger increments; the same one at ratio 3.6 folds."""
    config = Config.preset("reference-slice").with_overrides({"solver.increments": 25})
    smooth = simulate(config.replace(**{"growth.ratio": 1.0}))
    assert smooth.status == "completed"
    assert gyrification(smooth.contour()) < 1.0005
    # it does grow: the whole ellipse, by far more than round-off
    assert np.linalg.norm(smooth.displacement(), axis=1).max() > 10.0


def test_growth_ratio_of_the_paper_folds(folded) -> None:
    assert folded.status == "completed"
    assert gyrification(folded.contour()) > 1.3
    assert gyrification(folded.contour(0)) == pytest.approx(1.0, abs=1e-12)
