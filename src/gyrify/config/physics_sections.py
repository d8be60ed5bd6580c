"""The sections that say what grows and how; units: mm, Pa and the paper's growth time."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from gyrify.config.base import Section, setting
from gyrify.config.body_sections import PAPER
from gyrify.config.registered import Registered
from gyrify.config.small_tables import Plane

Law = Annotated[
    str,
    Registered(
        ("neo_hookean",),
        "gyrify.physics.materials",
        lambda module: [material.name for material in module.MATERIALS],
    ),
]
Stiffness = Annotated[float, Field(gt=0, le=1e15)]


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
    law: Literal["isotropic", "tangential", "area"] = setting(
        "isotropic",
        "Direction of growth: all, or along the layers of the cortex only (tangential; area is its name in "
        "space).",
    )
    profile: Literal["sharp", "sigmoid"] = setting(
        "sharp", "Growth rate across the interface: a step, or 1/(1 + exp((d − T)/transition)), d the depth."
    )
    transition: float = setting(
        0.0, "Width of the sigmoid profile; 0: a tenth of T.", unit="mm", ge=0, le=1e5
    )

    @property
    def is_tangential(self) -> bool:
        """Whether the cortex grows along its layers alone."""
        return self.law != "isotropic"

    @property
    def rate_white(self) -> float:
        """Growth rate G_W of white matter [1/time]."""
        return self.rate / self.ratio


class Boundary(Section):
    """What holds the body."""

    clamp: Literal["hole", "none", "plane"] = setting(
        "hole",
        "What is held: the hole (or the lower side of a strip or a patch), nothing, or a plane of symmetry "
        "that half a brain ends in; a solid body has no hole, and is free.",
    )
    plane: Plane = setting(
        Plane(),
        "Plane of symmetry: a point on it [mm], and its normal, along an axis and out of the body.",
    )

    @property
    def whole(self) -> float:
        """Mean radius of the whole body over that of what is given [-]: half a one ends in a plane."""
        return 2.0 ** (1.0 / 3.0) if self.clamp == "plane" else 1.0


class Contact(Section):
    """Self-contact of the outer contour or surface."""

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
