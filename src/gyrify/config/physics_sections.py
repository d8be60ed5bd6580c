"""The sections that say what grows and how; units: mm, Pa and the paper's growth time."""

from __future__ import annotations

import math
from typing import Annotated, Final, Literal

from pydantic import Field, model_validator

from gyrify.config.base import Section, setting
from gyrify.config.registered import Registered

PAPER: Final = "Wang 2019"
# Of the standard slice: area inside its contour [mm²] and thickness of its cortex [mm].
STANDARD_AREA: Final = 4069.0
STANDARD_THICKNESS: Final = 1.5


Shape = Annotated[
    str,
    Registered(("ellipse", "circle", "strip"), "gyrify.mesh.shapes", lambda module: module.SHAPES),
]
Law = Annotated[
    str,
    Registered(
        ("neo_hookean",),
        "gyrify.physics.materials",
        lambda module: [material.name for material in module.MATERIALS],
    ),
]
Stiffness = Annotated[float, Field(gt=0, le=1e15)]


class Geometry(Section):
    """The slice: a hollow ellipse or circle, or a strip that is periodic in x and clamped below."""

    shape: Shape = setting("ellipse", "Shape of the slice.", source=f"{PAPER}, Fig. 1")
    area: float = setting(
        STANDARD_AREA,
        "Area inside the outer contour, hole included; ellipse and circle only.",
        unit="mm²",
        source=f"{PAPER}, Fig. 1 (40.69 cm²)",
        gt=0,
        le=1e10,
    )
    aspect_ratio: float = setting(
        1.2,
        "Long over short axis of the ellipse; ignored by circle and strip.",
        source=f"{PAPER}, Fig. 1",
        ge=1,
        le=3,
    )
    hole_fraction: float = setting(
        0.5,
        "Axes of the clamped hole over axes of the contour; ellipse and circle only.",
        source=f"{PAPER}, Fig. 1",
        ge=0.1,
        le=0.9,
    )
    cortical_thickness: float = setting(
        STANDARD_THICKNESS,
        "Initial thickness T of the cortex, less than 0.95 of the narrowest wall.",
        unit="mm",
        source=f"{PAPER}, Mathematical Model",
        gt=0,
    )
    length: float = setting(
        40.0, "Period of the strip in x; ignored by ellipse and circle.", unit="mm", gt=0, le=1e5
    )
    depth: float = setting(
        18.0,
        "Depth of the strip, cortex included (default: the mean wall of the standard slice).",
        unit="mm",
        gt=0,
        le=1e5,
    )

    @property
    def semi_axes(self) -> tuple[float, float]:
        """Semi-axes (a, b) of the outer contour of an ellipse or circle [mm]."""
        ratio = self.aspect_ratio if self.shape == "ellipse" else 1.0
        minor = math.sqrt(self.area / (math.pi * ratio))
        return ratio * minor, minor

    @property
    def mean_radius(self) -> float:
        """Mean radius R = √(ab) of an ellipse or circle [mm]."""
        return math.sqrt(self.area / math.pi)

    @property
    def drag_length(self) -> float:
        """Length R of the drag number: the mean radius, or the depth of a strip [mm]."""
        return self.depth if self.shape == "strip" else self.mean_radius

    @property
    def scale(self) -> float:
        """Size of the body over that of the standard slice [-]: what lengths of measuring scale with.

        Mean radii of an ellipse or circle. The folds of a strip know no length but the thickness of its
        cortex: its depth and its period stand for a body without end.
        """
        if self.shape == "strip":
            return self.cortical_thickness / STANDARD_THICKNESS
        return math.sqrt(self.area) / math.sqrt(STANDARD_AREA)

    @property
    def narrowest_wall(self) -> float:
        """Smallest distance from the contour to the clamped boundary [mm]."""
        if self.shape == "strip":
            return self.depth
        return self.semi_axes[1] * (1.0 - self.hole_fraction)


class MeshSettings(Section):
    """How the slice is divided into cells."""

    n_around: int = setting(
        216,
        "Points on the outer contour (along a period of the strip).",
        source=f"{PAPER}, Results",
        ge=24,
        le=4096,
    )
    n_layers: int = setting(
        17,
        "Layers from the clamped boundary to the contour.",
        source=f"{PAPER}, Results (7344 triangles / 216 / 2)",
        ge=3,
        le=512,
    )
    n_cortex_layers: int = setting(
        6,
        "Layers in the cortex, fewer than n_layers.",
        source=f"{PAPER}, Results (at least six)",
        ge=2,
        le=511,
    )
    grading: Literal["geometric", "uniform"] = setting(
        "geometric", "White layers: geometric (the first as thick as a cortical one) or uniform."
    )
    split: Literal["alternating", "one", "random", "symmetric"] = setting(
        "alternating",
        "How each quadrilateral is cut into two triangles; symmetric: the mesh and the folds are their own "
        "mirror image.",
    )
    node_jitter: float = setting(
        1e-3,
        "Seeded random shift of the points, as a fraction of the local layer (mirrored: symmetric split).",
        ge=0,
        le=0.1,
    )
    element: Literal["linear", "quadratic", "mean_dilatation"] = setting(
        "linear", "Finite element.", source=f"{PAPER}, Results (3-node triangles)"
    )
    inversion_resistance: float = setting(
        0.0,
        "Stiffness over E_G that keeps quadratic cells from inverting beside integration points; 0: none.",
        ge=0,
        le=10,
    )
    refine: int = setting(0, "Times the whole mesh is refined by halving.", ge=0, le=4)
    refine_cortex: int = setting(0, "Times the cortex alone is refined by halving.", ge=0, le=4)


class Material(Section):
    """Hyperelastic cortex and white matter."""

    law: Law = setting("neo_hookean", "Energy of the elastic deformation: a name in the list of materials.")
    young_modulus: float = setting(
        9210.87,
        "Young's modulus E_G of the cortex.",
        unit="Pa",
        source=f"{PAPER}, Mathematical Model (Soza)",
        gt=0,
        le=1e13,
    )
    stiffness_ratio: float = setting(
        1.0, "Stiffness of the cortex over white matter, E_G/E_W.", source=f"{PAPER}, Results", ge=0.05, le=50
    )
    poisson_ratio: float = setting(
        0.458, "Poisson ratio of the cortex.", source=f"{PAPER}, Mathematical Model (Soza)", gt=-1, lt=0.5
    )
    poisson_ratio_white: float = setting(
        None,
        "Poisson ratio of white matter; that of the cortex when not given.",
        source=f"{PAPER}, Results",
        follows="material.poisson_ratio",
        gt=-1,
        lt=0.5,
    )

    @model_validator(mode="after")
    def _same_poisson_ratio(self) -> Material:
        """State the number that is meant; it does not count as given and follows later overrides."""
        if self.__dict__["poisson_ratio_white"] is None:
            self.__dict__["poisson_ratio_white"] = self.poisson_ratio
        return self

    @property
    def young_modulus_white(self) -> float:
        """Young's modulus E_W of white matter [Pa]."""
        return self.young_modulus / self.stiffness_ratio


class Growth(Section):
    """Growth of the two tissues."""

    rate: float = setting(
        0.002,
        "Growth rate G_G of the cortex.",
        unit="1/time",
        source=f"{PAPER}, Mathematical Model",
        ge=0,
        le=1e6,
    )
    ratio: float = setting(
        3.6,
        "Growth rate of the cortex over white matter, G_G/G_W.",
        source=f"{PAPER}, Eqs 9-11",
        ge=0.1,
        le=1e4,
    )
    duration: float = setting(
        500.0, "Growth time Δt.", unit="time", source=f"{PAPER}, Mathematical Model", gt=0, le=1e9
    )
    out_of_plane: Literal["blocked", "none", "generalised"] = setting(
        "blocked",
        "Along z: blocked (grows, F33 = 1), none (no growth, F33 = 1), generalised (no net force).",
    )
    out_of_plane_exponent: float = setting(
        1.0,
        "Growth along z as a power s of the growth stretch, F_g,33 = λ_g^s: 1 as in the plane, 0 none.",
        ge=0,
        le=2,
    )
    stretch: Literal["linear", "exponential"] = setting(
        "linear", "Growth stretch: linear (1 + G t) or exponential (exp G t)."
    )
    energy_per: Literal["grown", "reference"] = setting("grown", "Volume that the energy density refers to.")
    law: Literal["isotropic", "tangential"] = setting(
        "isotropic", "Direction of growth in the plane: all, or along the layers of the cortex only."
    )

    @property
    def rate_white(self) -> float:
        """Growth rate G_W of white matter [1/time]."""
        return self.rate / self.ratio


class Contact(Section):
    """Self-contact of the outer contour."""

    enabled: bool = setting(True, "Whether the contour may not cross itself; off only for comparison.")
    activation_fraction: float = setting(
        0.0667,
        "Gap at which contact sets in, over T; capped at half the shortest deformed contour edge "
        "(at no less than a twentieth of the shortest undeformed one).",
        gt=0,
        le=1,
    )
    barrier_stiffness: Stiffness | Literal["auto"] = setting(
        "auto", "Stiffness of the contact barrier.", unit="Pa"
    )


class Dissipation(Section):
    """Resistance to the rate of deformation."""

    kind: Literal["drag", "kelvin_voigt", "none"] = setting(
        "drag", "Drag against a fixed background, Kelvin-Voigt viscosity of the tissue, or none."
    )
    number: float = setting(
        1.3,
        "c R²/(E_G · duration) for drag of force c·m·u̇, m the reference area; "
        "η/(E_G · duration) for Kelvin-Voigt.",
        ge=0,
        le=1000,
    )
    course: Literal["constant", "reduced"] = setting(
        "constant",
        "Over growth: constant, or reduced in proportion to what is left of it, max(1 − t/duration, 0.001), "
        "t the end of the increment.",
    )
