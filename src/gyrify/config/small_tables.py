"""Values that are small tables: labels of tissues, a plane."""

from __future__ import annotations

from gyrify.config.base import Section, setting


class Labels(Section):
    """Which labels of cells mean which tissue."""

    grey: tuple[int, ...] = setting((), "Labels of grey matter.", strict=False)
    white: tuple[int, ...] = setting((), "Labels of white matter.", strict=False)
    hole: tuple[int, ...] = setting((), "Labels of what is left out.", strict=False)


class Plane(Section):
    """A plane of symmetry, across an axis."""

    point: tuple[float, float, float] = setting((0.0, 0.0, 0.0), "A point on it.", unit="mm", strict=False)
    normal: tuple[float, float, float] = setting(
        (0.0, 1.0, 0.0), "Its normal, along an axis and out of the body.", strict=False
    )
