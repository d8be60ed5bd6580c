"""Ranges of tissue and brains, with their sources: what legal values are judged by, in one table."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from gyrify.config.body_sections import PERIODIC
from gyrify.config.space_checks import edge_length

if TYPE_CHECKING:
    from gyrify.config import Config

# Fractions such as 1/3 are rounded.
_ROUNDING: Final = 1e-9
_AREAS: Final = {"cm²": 1e2, "m²": 1e6, "µm²": 1e-6}
_LENGTHS: Final = {"cm": 1e1, "m": 1e3, "µm": 1e-3}
_STRESSES: Final = {"kPa": 1e3, "MPa": 1e6}


@dataclass(frozen=True)
class Range:
    """What a quantity is in brains or in what gyrify was held against.

    Attributes
    ----------
    name : str
        The key, or what is computed from several.
    what : str
        What has values in this range, in words.
    low, high : float
        Bounds, allowed themselves.
    unit : str
        Unit; empty for pure numbers.
    source : str
        Who measured or used such values.
    advice : str
        What to do about a value outside.
    value : callable
        The quantity of a configuration; None where it has none.
    units : mapping
        Other units that are mistaken for this one, each in this one.
    """

    name: str
    what: str
    low: float
    high: float
    unit: str
    source: str
    advice: str
    value: Callable[[Config], float | None]
    units: Mapping[str, float] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The range in words."""
        unit = f" {self.unit}" if self.unit else ""
        if self.high == math.inf:
            return f"at least {_plain(self.low)}{unit}"
        if self.low == 0.0:
            return f"at most {_plain(self.high)}{unit}"
        return f"{_plain(self.low)} to {_plain(self.high)}{unit}"

    def holds(self, value: float) -> bool:
        """Whether a value lies in the range."""
        return self.low * (1 - _ROUNDING) <= value <= self.high * (1 + _ROUNDING)

    def warning(self, value: float) -> str:
        """Sentences on a value outside the range."""
        unit = f" {self.unit}" if self.unit else ""
        return (
            f"{self.name} = {value:.6g}{unit} is outside the range of {self.what}, {self.text} "
            f"({self.source}). {self._meant(value)}{self.advice}"
        )

    def _meant(self, value: float) -> str:
        """What to write if the value was meant in another unit."""
        for unit, factor in self.units.items():
            if self.holds(factor * value):
                return f"If {value:.6g} {unit} is meant, write {factor * value:.6g}. "
        return ""


def _plain(value: float) -> str:
    if value == 1 / 3:
        return "1/3"
    return f"{value:.0f}" if value >= 1 and value == round(value) else f"{value:g}"


def _closed(value: Callable[[Config], float]) -> Callable[[Config], float | None]:
    """The quantity, for an ellipse or circle alone."""
    return lambda config: (
        None if config.geometry.shape in PERIODIC or config.geometry.n_dim == 3 else value(config)
    )


def growth_strain(config: Config) -> float:
    """Relative increase in length of a free cortex over the whole growth [-]."""
    growth = config.growth
    exponent = growth.rate * growth.duration
    return math.expm1(exponent) if growth.stretch == "exponential" else exponent


def contour_spacing(config: Config) -> float:
    """Mean distance of neighbouring points of the contour, or of the outer surface, at the start [mm].

    The perimeter of an ellipse by Ramanujan's first formula, true to 1e-4 up to an aspect ratio of 3.
    """
    geometry = config.geometry
    if geometry.n_dim == 3:
        return edge_length(config) / 2.0 ** (config.mesh.refine + config.mesh.refine_cortex)
    n_points: float = config.mesh.n_around * 2.0 ** (config.mesh.refine + config.mesh.refine_cortex)
    if geometry.shape == "strip":
        return geometry.length / n_points
    a, b = geometry.outer_axes[:2]
    return math.pi * (3 * (a + b) - math.sqrt((3 * a + b) * (a + 3 * b))) / n_points


def _spacing_over_thickness(config: Config) -> float:
    return contour_spacing(config) / config.geometry.cortical_thickness


def _drag(config: Config) -> float | None:
    return None if config.dissipation.kind == "none" else config.dissipation.number


RANGES: Final[tuple[Range, ...]] = (
    Range(
        "geometry.area",
        "brains that fold, in section",
        100.0,
        100_000.0,
        "mm²",
        "rounded, about the folded brains that Hofman 1985 and Mota and Herculano-Houzel 2015 survey; "
        "4069 mm² in Wang 2019",
        "Check the unit: an area is in mm².",
        _closed(lambda config: config.geometry.area),
        _AREAS,
    ),
    Range(
        "geometry.cortical_thickness",
        "healthy and malformed cortex",
        0.5,
        20.0,
        "mm",
        "1 to 4.5 mm in adults, Fischl and Dale 2000; 1 to 1.5 mm at 22 weeks, and 15 to 20 mm in type I "
        "lissencephaly, in Wang 2019",
        "Check the unit: a thickness is in mm.",
        lambda config: config.geometry.cortical_thickness,
        _LENGTHS,
    ),
    Range(
        "material.young_modulus",
        "brain tissue",
        100.0,
        10_000.0,
        "Pa",
        "Budday et al. 2017; review of Chatelin et al. 2010; 9210.87 Pa in Wang 2019",
        "Check the unit: a stress is in Pa.",
        lambda config: config.material.young_modulus,
        _STRESSES,
    ),
    Range(
        "material.stiffness_ratio",
        "grey over white matter in brains",
        1 / 3,
        3.0,
        "",
        "never reported to exceed 3 either way, Wang 2019",
        "A much stiffer cortex wrinkles like a film on a soft base, which brains do not.",
        lambda config: config.material.stiffness_ratio,
    ),
    Range(
        "material.poisson_ratio",
        "brain tissue, which is nearly incompressible",
        0.35,
        0.5,
        "",
        "0.35 drained, Cheng and Bilston 2007; bulk over shear modulus 5 (0.406) in Tallinen et al. 2014; "
        "0.458 in Wang 2019",
        "Try 0.458, the default.",
        lambda config: config.material.poisson_ratio,
    ),
    Range(
        "material.poisson_ratio_white",
        "brain tissue, which is nearly incompressible",
        0.35,
        0.5,
        "",
        "as material.poisson_ratio",
        "Leave it out to take material.poisson_ratio.",
        lambda config: (
            None
            if config.material.poisson_ratio_white == config.material.poisson_ratio
            else config.material.poisson_ratio_white
        ),
    ),
    Range(
        "growth strain of the cortex",
        "growth from 22 weeks to the adult",
        0.0,
        3.0,
        "",
        "1.71 from brain volumes, and 1 in the model, in Wang 2019; 0.83 along the surface in Tallinen et "
        "al. 2016",
        "It is growth.rate × growth.duration, or exp of it less 1 where growth is exponential: lower one.",
        growth_strain,
    ),
    Range(
        "growth.ratio",
        "cortex over white matter in models of brains",
        1.0,
        360.0,
        "",
        "the values of Wang 2019; 3.6 from the scaling law of mammals, 2.78 from volumes at 30 to 40 weeks; "
        "from 1000 on white matter counts as not growing, as in Tallinen et al. 2016",
        "Below 1 the white matter grows faster than the cortex.",
        lambda config: config.growth.ratio if config.growth.ratio < 1000.0 else None,
    ),
    Range(
        "dissipation.number",
        "dissipation that leaves folds their time",
        0.0,
        30.0,
        "",
        "no measured value: 1.3 and 2.6 in the presets; far below 1 in tissue, which relaxes within minutes "
        "(Budday et al. 2017) while growth takes weeks",
        "Lower it: with much dissipation folds come late or never.",
        _drag,
    ),
    Range(
        "spacing of the contour's points over the thickness of the cortex",
        "meshes that resolve folds at all",
        0.0,
        1.5,
        "",
        "0.7 for the standard slice of Wang 2019, 1.4 for its thinnest cortex",
        "Raise mesh.n_around.",
        lambda config: _spacing_over_thickness(config) if config.geometry.n_dim == 2 else None,
    ),
    Range(
        "edge of the outer surface over the thickness of the cortex",
        "meshes that resolve folds at all",
        0.0,
        2.0,
        "",
        "1.6 in a public mesh of BrainGrowth, which is not converged",
        "Lower mesh.edge_length, or raise mesh.refine.",
        lambda config: _spacing_over_thickness(config) if config.geometry.n_dim == 3 else None,
    ),
)


def check_ranges(config: Config) -> list[str]:
    """Sentences on the quantities of a configuration that lie outside of `RANGES`."""
    found = ((known, known.value(config)) for known in RANGES)
    return [known.warning(value) for known, value in found if value is not None and not known.holds(value)]


def table() -> str:
    """Return the ranges as a table in Markdown, for the documentation."""
    lines = ["| quantity | what | range | source |", "|---|---|---|---|"]
    for known in RANGES:
        name = f"`{known.name}`" if "." in known.name and " " not in known.name else known.name
        lines.append(f"| {name} | {known.what} | {known.text} | {known.source} |")
    return "\n".join(lines) + "\n"
