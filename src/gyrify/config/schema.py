"""The JSON Schema of the TOML format, for editors and other programs."""

from __future__ import annotations

from typing import Any, Final

from gyrify.config.numbers import NUMBER_PATTERN
from gyrify.config.preset_files import preset_names
from gyrify.config.settings import Config

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"
_NUMBER_KEYS: Final = ("type", "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum")


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of a configuration file.

    Returns
    -------
    dict
        Every key with type, bounds, default, unit and source; numbers may also be fractions in quotes.
    """
    schema = Config.model_json_schema()
    for definition in schema["$defs"].values():
        properties = definition["properties"]
        definition["properties"] = {name: _with_fraction(value) for name, value in properties.items()}
    preset = {"enum": list(preset_names()), "description": "Preset that the other values are laid over."}
    properties = {"preset": preset, **schema["properties"]}
    return {"$schema": DIALECT, **schema, "properties": properties}


def _with_fraction(field: dict[str, Any]) -> dict[str, Any]:
    if field.get("type") != "number":
        return field
    number = {key: field.pop(key) for key in _NUMBER_KEYS if key in field}
    return {"anyOf": [number, {"type": "string", "pattern": NUMBER_PATTERN}], **field}
