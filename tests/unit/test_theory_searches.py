"""The searches of the exact theory, on margins that are made up: crossings, weakest mode, radial state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import gyrify.theory.margin as margin_module
import gyrify.theory.onset as onset
import gyrify.theory.radial as radial_module
from gyrify.errors import ConfigError, SolveError
from gyrify.theory import Annulus, SecondVariation, asymptotic_wrinkle, base_state, critical_growth_ratio
from gyrify.theory.margin import Margin, coarse_modes, stability_margin
from gyrify.theory.onset import crossings

STANDARD = Annulus()


def found(monkeypatch: pytest.MonkeyPatch, margin: Callable[[float], float], values: list[float]) -> Any:
    """Crossings of a margin over growth time."""

    def state(_: object, __: str, value: float, *___: object) -> Any:
        return SimpleNamespace(value=value, annulus=STANDARD, growth_time=value, radius=lambda _: 2.0)

    monkeypatch.setattr(onset, "state_at", state)
    monkeypatch.setattr(onset, "stability_margin", lambda state: Margin(margin(state.value), 7))
    return crossings(STANDARD, "growth_time", values)


def test_every_change_is_found_with_its_direction_and_to_a_millionth(monkeypatch: pytest.MonkeyPatch) -> None:
    exact = [0.31, 1.47, 2.22]
    all_of_them = found(
        monkeypatch, lambda t: -float(np.prod(t - np.array(exact))) * np.exp(3.0 * t), [0.0, 1.0, 2.0, 3.0]
    )
    assert [crossing.becomes for crossing in all_of_them] == ["unstable", "stable", "unstable"]
    assert [crossing.value for crossing in all_of_them] == pytest.approx(exact, rel=1e-6)
    assert [crossing.growth_time for crossing in all_of_them] == [crossing.value for crossing in all_of_them]
    assert {crossing.mode_number for crossing in all_of_them} == {7}


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_margin_of_zero_at_a_value_of_the_scan_is_one_crossing(
    monkeypatch: pytest.MonkeyPatch, sign: float
) -> None:
    (crossing,) = found(monkeypatch, lambda t: sign * (1.0 - t), [0.0, 1.0, 2.0])
    assert crossing.value == pytest.approx(1.0)
    assert crossing.becomes == ("unstable" if sign > 0 else "stable")


def test_values_that_repeat_are_no_scan(monkeypatch: pytest.MonkeyPatch) -> None:
    for values in ([1.0, 1.0], [1.0, 2.0, 2.0], [2.0, 1.0], [1.0]):
        with pytest.raises(ConfigError, match="do not increase"):
            found(monkeypatch, lambda t: 1.0 - t, values)


def weakest(monkeypatch: pytest.MonkeyPatch, margin: Callable[[int], float], surface: float = 9.0) -> Margin:
    """Weakest mode of margins that are known."""

    class Known:
        @staticmethod
        def of(_: object) -> Any:
            mu, radius = STANDARD.moduli_grey[0], STANDARD.outer_radius
            return SimpleNamespace(lowest=lambda n: margin(n) * mu * (max(n, 1) / radius) ** 2)

    monkeypatch.setattr(margin_module, "SecondVariation", Known)
    monkeypatch.setattr(margin_module, "surface_limit", lambda _: surface)
    return stability_margin(SimpleNamespace(annulus=STANDARD))  # type: ignore[arg-type]


LAST = coarse_modes(STANDARD)[-1]


@pytest.mark.parametrize("number", [*range(2, 40), 55, 83, LAST - 1, LAST])
def test_the_weakest_of_all_modes_is_found_though_few_are_tried(
    monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    weak = weakest(monkeypatch, lambda n: np.log(max(n, 0.5) / number) ** 2 - 0.1)
    assert weak.mode_number == number
    assert weak.value == pytest.approx(-0.1)
    assert not weak.at_edge


def test_the_weaker_of_two_valleys_is_found_and_an_end_is_said_to_be_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first valley is the wider one, of 9 waves and -0.1; that of 37 goes down to -0.2."""
    weak = weakest(
        monkeypatch, lambda n: min(np.log(max(n, 1) / 9) ** 2 - 0.1, 9.0 * np.log(max(n, 1) / 37) ** 2 - 0.2)
    )
    assert (weak.mode_number, weak.at_edge) == (37, False)
    assert weakest(monkeypatch, lambda n: 1.0 / (n + 1)).at_edge


@pytest.mark.parametrize("number", [0, 1])
def test_modes_without_a_wave_or_with_one_count(monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    assert weakest(monkeypatch, lambda n: -1.0 if n == number else 1.0).mode_number == number


@pytest.mark.parametrize(("surface", "number"), [(-0.11, None), (-0.09, 20), (-0.1, 20)])
def test_the_surface_is_weakest_only_where_it_is_weaker(
    monkeypatch: pytest.MonkeyPatch, surface: float, number: int | None
) -> None:
    weak = weakest(monkeypatch, lambda n: np.log(max(n, 0.5) / 20) ** 2 - 0.1, surface)
    assert weak.mode_number == number
    assert weak.value == pytest.approx(min(surface, -0.1))


@pytest.mark.parametrize("growth_ratio", [1.5, 2.6])
def test_margins_are_of_no_unit(growth_ratio: float) -> None:
    """Neither the modes' nor that of the surface depends on the unit of stress."""
    soft = Annulus(growth_ratio=growth_ratio, stiffness_ratio=1 / 3)
    stiff = replace(soft, young_modulus=1000.0 * soft.young_modulus)
    one, other = (stability_margin(base_state(annulus)) for annulus in (soft, stiff))
    assert one.mode_number == other.mode_number
    assert one.value == pytest.approx(other.value, rel=1e-6)


def test_the_wavelength_is_that_on_the_deformed_contour() -> None:
    (crossing,) = critical_growth_ratio(STANDARD, [1.6, 1.9])
    state = base_state(replace(STANDARD, growth_ratio=crossing.value))
    assert crossing.mode_number is not None
    around = 2.0 * np.pi * float(state.radius(STANDARD.outer_radius))
    assert crossing.wavelength * crossing.mode_number == pytest.approx(around, rel=1e-5)
    assert around > 2.1 * np.pi * STANDARD.outer_radius


def test_the_largest_entry_of_a_mode_is_one() -> None:
    variation = SecondVariation.of(base_state(STANDARD))
    for number in (1, 2, 3, 19, 20):
        mode = variation.mode(number)
        fields = np.concatenate([mode.radial, mode.circumferential])
        assert fields[np.argmax(np.abs(fields))] == 1.0


def test_a_radial_state_is_in_balance_to_round_off() -> None:
    for time in (1.0, 100.0, 500.0, 900.0):
        assert base_state(STANDARD, time).residual < 1e-12


@pytest.mark.parametrize("iterations", [1, 2, 3])
def test_a_radial_state_at_the_iteration_cap_is_refused(
    monkeypatch: pytest.MonkeyPatch, iterations: int
) -> None:
    monkeypatch.setattr(radial_module, "_MAX_NEWTON", iterations)
    with pytest.raises(SolveError, match="radial state is lost"):
        base_state(STANDARD)


def test_a_guess_is_no_more_than_a_guess() -> None:
    exact = base_state(STANDARD, 500.0)
    for guess in (
        base_state(STANDARD, 0.0),
        base_state(replace(STANDARD, degree=STANDARD.degree + 2), 500.0),
    ):
        again = base_state(STANDARD, 500.0, guess)
        assert again.displacement == pytest.approx(exact.displacement, abs=1e-10)
        assert again.residual < 1e-12


def test_a_ratio_of_nothing_has_no_asymptote() -> None:
    with pytest.raises(ConfigError, match="must be positive"):
        asymptotic_wrinkle(0.0)
