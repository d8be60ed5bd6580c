"""The calibrations of Wang et al. (2019), with the arithmetic shown."""

from __future__ import annotations

import math

import pytest

from gyrify.errors import ConfigError
from gyrify.metrics import growth_ratio_from_scaling, growth_ratio_from_volumes, length_increase


def test_the_scaling_law_gives_the_published_growth_ratio() -> None:
    assert growth_ratio_from_scaling() == pytest.approx(3.592, abs=5e-4)


def test_the_scaling_law_by_hand() -> None:
    """Eqs 9-11 hold for the volumes at the ratio returned."""
    ratio = growth_ratio_from_scaling(3.0, area=5000.0, aspect_ratio=1.5, growth=0.8)
    b = math.sqrt(5000.0 / (1.5 * math.pi))
    a = 1.5 * b
    white = (1 + 0.8 / ratio) ** 3 * (math.pi * (a - 3) * (b - 3) - math.pi * a * b / 4) * 0.01
    grey = (1 + 0.8) ** 3 * (math.pi * a * b - math.pi * (a - 3) * (b - 3)) * 0.01
    assert white == pytest.approx(grey**1.23, rel=1e-12)


def test_the_scaling_law_depends_on_the_unit() -> None:
    assert growth_ratio_from_scaling(unit="um") == pytest.approx(0.19, abs=1e-3)
    with pytest.raises(ConfigError, match="cm³") as error:
        growth_ratio_from_scaling(unit="cm")
    assert "mm³" in error.value.advice


def test_volumes_give_the_growth_ratio() -> None:
    assert growth_ratio_from_volumes(4.6, 1.9) == pytest.approx(2.78, abs=5e-3)
    assert growth_ratio_from_volumes(8.0, 8.0) == 1.0
    assert growth_ratio_from_volumes(27.0, 8.0) == pytest.approx(2.0)


def test_volumes_give_the_increase_in_length() -> None:
    assert length_increase(60.0, 1200.0) == pytest.approx(1.71, abs=5e-3)
    assert length_increase(1.0, 8.0) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("cortical_thickness", 0.0),
        ("cortical_thickness", 17.0),
        ("area", -1.0),
        ("aspect_ratio", 0.5),
        ("hole_fraction", 1.0),
        ("slice_thickness", math.nan),
        ("exponent", 0.0),
        ("growth", -0.1),
    ],
)
def test_bad_geometry_is_refused_by_name_and_range(name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=rf"{name} = .* out of range"):
        growth_ratio_from_scaling(**{name: value})


def test_bad_volumes_and_units_are_refused() -> None:
    with pytest.raises(ConfigError, match="white_increase = 1"):
        growth_ratio_from_volumes(4.6, 1.0)
    with pytest.raises(ConfigError, match="initial_volume = 0"):
        length_increase(0.0, 1.0)
    with pytest.raises(ConfigError, match="'furlong'"):
        growth_ratio_from_scaling(unit="furlong")
