"""The fields of the configuration against the contract, written out by hand."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from gyrify.config import Config, Contact, Geometry, Growth, Material
from gyrify.config.reference import page
from gyrify.config.rows import rows
from gyrify.config.small_tables import Labels, Plane
from gyrify.errors import ConfigError

DEFAULTS: dict[str, Any] = {
    "schema_version": 1, "seed": 0,
    "geometry.shape": "ellipse", "geometry.area": 4069.0, "geometry.aspect_ratio": 1.2,
    "geometry.hole_fraction": 0.5, "geometry.cortical_thickness": 1.5,
    "geometry.length": 40.0, "geometry.depth": 18.0, "geometry.width": 40.0,
    "geometry.semi_axes": (39.4, 32.9, 32.9), "mesh.edge_length": 0.0,
    "geometry.file": "", "geometry.hole_file": "", "geometry.interface_file": "",
    "geometry.unit": "mm", "geometry.labels": Labels(), "geometry.digest": "",
    "mesh.n_around": 216, "mesh.n_layers": 17, "mesh.n_cortex_layers": 6, "mesh.grading": "geometric",
    "mesh.split": "alternating", "mesh.node_jitter": 1e-3, "mesh.element": "linear",
    "mesh.inversion_resistance": 0.0, "mesh.refine": 0, "mesh.refine_cortex": 0,
    "material.law": "neo_hookean",
    "material.young_modulus": 9210.87, "material.stiffness_ratio": 1.0,
    "material.poisson_ratio": 0.458, "material.poisson_ratio_white": 0.458,
    "growth.rate": 0.002, "growth.ratio": 3.6, "growth.duration": 500.0, "growth.out_of_plane": "blocked",
    "growth.out_of_plane_exponent": 1.0,
    "growth.stretch": "linear", "growth.energy_per": "grown", "growth.law": "isotropic",
    "growth.profile": "sharp", "growth.transition": 0.0, "boundary.clamp": "hole", "boundary.plane": Plane(),
    "contact.enabled": True, "contact.activation_fraction": 0.0667, "contact.barrier_stiffness": "auto",
    "dissipation.kind": "drag", "dissipation.number": 1.3, "dissipation.course": "constant",
    "solver.increments": 100, "solver.min_increment": 1e-6, "solver.tolerance": 1e-6,
    "solver.max_newton": 60, "solver.regularisation": "shift", "solver.linear_solver": "auto",
    "stability.detect": True, "stability.follow_branch": False, "stability.sign": 1,
    "metrics.closing_radius": 10.0, "metrics.gyrus_prominence": 0.3, "metrics.samples": 2000,
    "output.every": 1, "limits.wall_time": 0.0, "limits.memory": 0.0,
}  # fmt: skip

CHOICES = {
    "geometry.shape": ["ellipse", "circle", "strip", "sphere", "ellipsoid", "patch", "surface", "volume"],
    "mesh.grading": ["geometric", "uniform"],
    "mesh.split": ["alternating", "one", "random"],
    "mesh.element": ["linear", "quadratic", "mean_dilatation"],
    "growth.out_of_plane": ["blocked", "none", "generalised"],
    "dissipation.course": ["constant", "reduced"],
    "growth.stretch": ["linear", "exponential"],
    "growth.energy_per": ["grown", "reference"],
    "growth.law": ["isotropic", "tangential", "area"],
    "growth.profile": ["sharp", "sigmoid"],
    "boundary.clamp": ["hole", "none", "plane"],
    "dissipation.kind": ["drag", "kelvin_voigt", "none"],
    "solver.regularisation": ["shift", "projection"],
    "solver.linear_solver": ["auto", "pardiso", "superlu", "cg"],
    "stability.sign": [1, -1],
    "contact.barrier_stiffness": ["auto", 1e-3, 5e4],
}

# Keys that follow others when they are not given.
FOLLOWERS = {"material.poisson_ratio_white", "metrics.closing_radius", "metrics.gyrus_prominence"}
ABOVE_ZERO = 5e-324
UP, DOWN = math.inf, -math.inf
INSIDE_AND_OUTSIDE: dict[str, tuple[list[float], list[float]]] = {
    "seed": ([0, 2**32 - 1], [-1, 2**32]),
    "geometry.area": ([800.0, 1e10], [0.0, -1.0]),
    "geometry.aspect_ratio": ([1.0, 3.0], [math.nextafter(1, 0), math.nextafter(3, UP)]),
    "geometry.hole_fraction": ([0.1, 0.9], [math.nextafter(0.1, 0), math.nextafter(0.9, UP)]),
    "geometry.cortical_thickness": ([ABOVE_ZERO, 15.6], [0.0, 15.7, -1.5]),
    "geometry.length": ([0.5], [0.0, -1.0]),
    "geometry.depth": ([2.0], [0.0, -1.0]),
    "geometry.width": ([2.0], [0.0, -1.0]),
    "mesh.edge_length": ([0.0, 2.0], [-ABOVE_ZERO, math.nextafter(1e5, UP)]),
    "growth.transition": ([0.0, 2.0], [-ABOVE_ZERO, math.nextafter(1e5, UP)]),
    "mesh.n_around": ([24, 4096], [23, 4097]),
    "mesh.n_layers": ([7, 512], [2, 6, 513]),
    "mesh.n_cortex_layers": ([2, 16], [1, 17]),
    "mesh.node_jitter": ([0.0, 0.1], [-ABOVE_ZERO, math.nextafter(0.1, UP)]),
    "mesh.inversion_resistance": ([0.0, 10.0], [-ABOVE_ZERO, math.nextafter(10, UP)]),
    "mesh.refine": ([0, 4], [-1, 5]),
    "mesh.refine_cortex": ([0, 4], [-1, 5]),
    "material.young_modulus": ([ABOVE_ZERO, 1e9], [0.0, -1.0]),
    "material.stiffness_ratio": ([0.05, 50.0], [math.nextafter(0.05, 0), math.nextafter(50, UP)]),
    "material.poisson_ratio": ([math.nextafter(-1, 0), math.nextafter(0.5, 0)], [-1.0, 0.5]),
    "material.poisson_ratio_white": ([math.nextafter(-1, 0), math.nextafter(0.5, 0)], [-1.0, 0.5]),
    "growth.rate": ([0.0, 0.02], [-ABOVE_ZERO, 0.0201]),
    "growth.ratio": ([0.1, 1e4], [math.nextafter(0.1, 0), math.nextafter(1e4, UP)]),
    "growth.duration": ([ABOVE_ZERO, 5000.0], [0.0, 5001.0]),
    "contact.activation_fraction": ([ABOVE_ZERO, 1.0], [0.0, 1.1]),
    "contact.barrier_stiffness": ([ABOVE_ZERO], [0.0, -1.0]),
    "growth.out_of_plane_exponent": ([0.0, 2.0], [-ABOVE_ZERO, math.nextafter(2, UP)]),
    "dissipation.number": ([0.0, 1000.0], [-ABOVE_ZERO, math.nextafter(1000, UP)]),
    "solver.increments": ([1, 100_000], [0, 100_001]),
    "solver.min_increment": ([ABOVE_ZERO, 0.01], [0.0, 0.011]),
    "solver.tolerance": ([ABOVE_ZERO, 1e-2], [0.0, 0.011]),
    "solver.max_newton": ([1, 10_000], [0, 10_001]),
    "metrics.closing_radius": ([ABOVE_ZERO], [0.0, -1.0]),
    "metrics.gyrus_prominence": ([ABOVE_ZERO], [0.0, -1.0]),
    "metrics.samples": ([100], [99, 1_000_001]),
    "output.every": ([1], [0]),
    "limits.wall_time": ([0.0, 3600.0], [-1.0]),
    "limits.memory": ([0.0, 600.0], [-1.0]),
}
# What some keys need beside them.
BESIDE = {
    "growth.transition": {"growth.profile": "sigmoid"},
    "mesh.edge_length": {"geometry.shape": "sphere"},
    "solver.linear_solver": {"geometry.shape": "sphere"},
}
NUMBERS = sorted(INSIDE_AND_OUTSIDE)
COUNTS = [key for key in NUMBERS if type(DEFAULTS[key]) is int]


def value_of(config: Config, key: str) -> Any:
    section, _, name = key.rpartition(".")
    return getattr(getattr(config, section) if section else config, name)


def test_the_contract_and_nothing_else() -> None:
    assert {row.key for row in rows(Config())} == {*DEFAULTS, "output.fields"}
    numbers = {key for key, value in DEFAULTS.items() if type(value) in (int, float)}
    assert numbers - {"schema_version", "stability.sign"} <= set(NUMBERS)


@pytest.mark.parametrize("key", DEFAULTS)
def test_default(key: str) -> None:
    value = value_of(Config(), key)
    assert value == DEFAULTS[key]
    assert type(value) is type(DEFAULTS[key])


@pytest.mark.parametrize(("key", "value"), [(k, v) for k in NUMBERS for v in INSIDE_AND_OUTSIDE[k][0]])
def test_bound_is_allowed(key: str, value: float) -> None:
    assert value_of(Config().replace(**BESIDE.get(key, {}), **{key: value}), key) == value


@pytest.mark.parametrize(("key", "value"), [(k, v) for k in NUMBERS for v in INSIDE_AND_OUTSIDE[k][1]])
def test_beyond_the_bound_is_refused(key: str, value: float) -> None:
    with pytest.raises(ConfigError) as caught:
        Config().replace(**{key: value})
    name = key.rpartition(".")[2]
    assert name in str(caught.value)
    assert "not allowed" in str(caught.value)


@pytest.mark.parametrize("key", NUMBERS)
@pytest.mark.parametrize(
    "value", [True, "3", "", None, math.nan, math.inf, -math.inf, [], {}, 1j, b"1", "1/0", 1 << 9999]
)
def test_what_is_no_number_is_refused(key: str, value: object) -> None:
    if key in FOLLOWERS and value is None:
        return  # None is how Python says "what it follows"
    with pytest.raises(ConfigError, match=key.replace(".", r"\.")):
        Config().replace(**{key: value})


@pytest.mark.parametrize("key", COUNTS)
@pytest.mark.parametrize("value", [216.0, 216.5, "432/2"])
def test_counts_are_whole(key: str, value: object) -> None:
    with pytest.raises(ConfigError, match="whole number"):
        Config().replace(**{key: value})


@pytest.mark.parametrize(("key", "value"), [(k, v) for k, values in CHOICES.items() for v in values])
def test_choice_is_allowed(key: str, value: object) -> None:
    if (key, value) == ("boundary.clamp", "plane"):  # half a body is read from a file
        with pytest.raises(ConfigError, match=r'Try geometry\.shape = "volume"'):
            Config().replace(**{key: value})
        return
    if key == "geometry.shape" and value in ("surface", "volume"):  # what is read from a file needs one
        with pytest.raises(ConfigError, match=r"not allowed without geometry\.file"):
            Config().replace(**{key: value})
        return
    assert value_of(Config().replace(**BESIDE.get(key, {}), **{key: value}), key) == value


@pytest.mark.parametrize("key", CHOICES)
@pytest.mark.parametrize("value", ["", "Linear ", True, 1.0, -2, None, ["auto"]])
def test_other_choice_is_refused(key: str, value: object) -> None:
    if (key, value) == ("contact.barrier_stiffness", 1.0) and value is not True:
        return
    with pytest.raises(ConfigError, match="not allowed"):
        Config().replace(**{key: value})


@pytest.mark.parametrize("key", ["contact.enabled", "stability.detect", "stability.follow_branch"])
@pytest.mark.parametrize("value", [0, 1, "true", None])
def test_flags_are_true_or_false(key: str, value: object) -> None:
    with pytest.raises(ConfigError, match="true or false"):
        Config().replace(**{key: value})


def test_sections_and_whole_raise_the_same_kind_of_error() -> None:
    with pytest.raises(ConfigError, match="ratio = 0 "):
        Growth(ratio=0)
    with pytest.raises(ConfigError, match="barrier_stiffness"):
        Contact(barrier_stiffness="big")  # type: ignore[arg-type]


def test_white_matter_follows_the_cortex_until_it_has_its_own_value() -> None:
    follows = Config().replace(**{"material.poisson_ratio": 0.3})
    assert follows.material.poisson_ratio_white == 0.3
    assert Config.preset("reference-slice").replace(**{"material.poisson_ratio": 0.3}) == follows
    own = follows.replace(**{"material.poisson_ratio_white": 0.4, "material.poisson_ratio": 0.2})
    assert (own.material.poisson_ratio, own.material.poisson_ratio_white) == (0.2, 0.4)
    again = own.replace(**{"material.poisson_ratio_white": None})
    assert again.material.poisson_ratio_white == 0.2


def test_derived_values() -> None:
    geometry = Geometry()
    a, b = geometry.outer_axes
    assert (round(a, 2), round(b, 2), round(geometry.mean_radius, 1)) == (39.42, 32.85, 36.0)
    assert math.isclose(math.pi * a * b, 4069.0)
    assert geometry.narrowest_wall == b / 2
    circle = Geometry(shape="circle", hole_fraction=0.25)
    assert circle.outer_axes == (circle.mean_radius, circle.mean_radius)
    assert circle.narrowest_wall == 0.75 * circle.mean_radius
    assert Geometry(shape="strip", depth=7.0).narrowest_wall == 7.0
    assert Growth(rate=0.002, ratio=4).rate_white == 0.0005
    assert Material(young_modulus=1000, stiffness_ratio=0.5).young_modulus_white == 2000


@pytest.mark.parametrize(("shape", "wall"), [("ellipse", 16.4266), ("circle", 17.9944), ("strip", 18.0)])
def test_thickness_against_the_narrowest_wall(shape: str, wall: float) -> None:
    def with_share(share: float) -> Config:
        return Config().replace(**{"geometry.shape": shape, "geometry.cortical_thickness": share * wall})

    assert with_share(0.9499).geometry.shape == shape
    with pytest.raises(ConfigError, match="white matter"):
        with_share(0.9501)


def test_every_field_has_a_doc_line_and_a_range_in_words() -> None:
    for row in rows(Config()):
        assert row.doc.endswith(".")
        assert "\n" not in row.doc
        assert row.allowed


def test_source_is_given_only_for_the_published_value() -> None:
    def source(config: Config) -> str:
        return next(row.source for row in rows(config) if row.key == "growth.ratio")

    assert "Eqs 9-11" in source(Config())
    assert source(Config().replace(**{"growth.ratio": 2})) == ""


def test_reference_page_is_up_to_date() -> None:
    path = Path(__file__).parents[2] / "docs" / "configuration.md"
    stale = "docs/configuration.md is stale: python -m gyrify.config.reference docs/configuration.md"
    assert path.read_text("utf-8") == page(), stale
