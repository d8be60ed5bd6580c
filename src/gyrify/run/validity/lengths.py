"""Lengths of measuring that cannot fit the body: a disc larger than it, or a bump higher than the cortex."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gyrify.config.body_sections import PERIODIC
from gyrify.run.validity.ranges import contour_spacing

if TYPE_CHECKING:
    from gyrify.config import Config

# Points of the contour that a disc must span to bridge what they resolve.
_SPACINGS: Final = 2.0
# Bumps this much lower than the cortex is thick are jitter of the nodes and rounding.
_FLAT: Final = 0.01


def check_lengths(config: Config) -> list[str]:
    """Sentences on a closing radius or a prominence that does not fit the body."""
    return [*_radius(config), *_prominence(config)]


def _radius(config: Config) -> list[str]:
    geometry, radius = config.geometry, config.metrics.closing_radius
    fitting = config.replace(**{"metrics.closing_radius": None}).metrics.closing_radius
    if radius == fitting:
        return []
    advice = f"Leave metrics.closing_radius out to take {fitting:.4g} mm, which scales with the body."
    name, size = ("period", geometry.length)
    if geometry.shape not in PERIODIC:
        name, size = "mean radius", geometry.mean_radius * config.boundary.whole
    if radius > size:
        return [
            f"metrics.closing_radius = {radius:.4g} mm is larger than the {name} of the body, "
            f"{size:.4g} mm: the closing is nearly the convex hull, and GI closing nearly GI hull. {advice}"
        ]
    least = _SPACINGS * contour_spacing(config)
    if radius < min(least, fitting):
        return [
            f"metrics.closing_radius = {radius:.4g} mm is less than {_SPACINGS:g} spacings of the contour's "
            f"points, {least:.4g} mm: its disc enters sulci that the mesh just resolves, "
            f"and GI closing falls towards 1. {advice}"
        ]
    return []


def _prominence(config: Config) -> list[str]:
    thickness, prominence = config.geometry.cortical_thickness, config.metrics.gyrus_prominence
    if prominence > thickness:
        return [
            f"metrics.gyrus_prominence = {prominence:.4g} mm is more than the thickness of the cortex, "
            f"{thickness:.4g} mm: whole gyri are not counted. Try {0.2 * thickness:.3g}."
        ]
    if prominence < _FLAT * thickness:
        return [
            f"metrics.gyrus_prominence = {prominence:.4g} mm is less than {_FLAT:g} of the thickness of the "
            f"cortex, {thickness:.4g} mm: node jitter counts as gyri. Try {0.2 * thickness:.3g}."
        ]
    return []
