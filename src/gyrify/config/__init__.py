"""Configuration: frozen, validated parameter objects that read and write TOML."""

from __future__ import annotations

from gyrify.config.body_sections import Geometry, MeshSettings
from gyrify.config.given import ConfigLike, as_config
from gyrify.config.numbers import parse_number
from gyrify.config.physics_sections import Boundary, Contact, Dissipation, Growth, Material
from gyrify.config.preset_files import PresetAbout, preset_about, preset_names
from gyrify.config.run_sections import Limits, Metrics, Output, Solver, Stability
from gyrify.config.settings import Config

__all__ = [
    "Boundary",
    "Config",
    "ConfigLike",
    "Contact",
    "Dissipation",
    "Geometry",
    "Growth",
    "Limits",
    "Material",
    "MeshSettings",
    "Metrics",
    "Output",
    "PresetAbout",
    "Solver",
    "Stability",
    "as_config",
    "parse_number",
    "preset_about",
    "preset_names",
]
