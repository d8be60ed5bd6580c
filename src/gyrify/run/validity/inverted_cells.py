"""Quadratic cells that nothing keeps from inverting between their integration points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gyrify.run.validity.expected import expected_onset

if TYPE_CHECKING:
    from gyrify.config import Config


def inversion(config: Config) -> list[str]:
    """Warn of quadratic cells without resistance in a body that folds, or may fold."""
    if config.mesh.element != "quadratic" or config.mesh.inversion_resistance > 0.0:
        return []
    expected = expected_onset(config)
    if expected.is_known and expected.growth_time is None:
        return []
    if config.geometry.n_dim == 3:
        return [
            'mesh.element = "quadratic" in space: where folds close tightly, a part of a '
            "cell may be inverted between integration points, and the run then ends before the end of "
            'growth. Set mesh.element = "mean_dilatation" to fold deeply.'
        ]
    return [
        'mesh.element = "quadratic" without mesh.inversion_resistance: where folds close, a part of a cell '
        "may be inverted between integration points, and the run then ends before the end of growth. Set "
        "mesh.inversion_resistance = 0.1."
    ]
