"""What all sections share: strictness, fractions, and faults told in plain words."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic.config import JsonDict

from gyrify.base.arguments import native
from gyrify.config.faults import config_error, nearest
from gyrify.config.numbers import is_fraction, parse_number
from gyrify.config.words import show
from gyrify.errors import ConfigError


def setting(
    default: Any, doc: str, *, unit: str = "", source: str = "", follows: str = "", **bounds: Any
) -> Any:
    """Declare a field with its default, one line of doc, unit, published source and bounds.

    Parameters
    ----------
    default : object
        The default value; None stands for a value taken from other fields, as ``follows`` says.
    doc : str
        One line of documentation.
    unit : str, optional
        The unit; empty for words and pure numbers.
    source : str, optional
        Where the default was published.
    follows : str, optional
        What the value is when it is not given, in words.
    **bounds
        `gt`, `ge`, `lt`, `le`, as pydantic names them.

    Returns
    -------
    Any
        A pydantic field.
    """
    extra: JsonDict = {"unit": unit, "source": source}
    if follows:
        extra["follows"] = follows
    return Field(default, description=doc, json_schema_extra=extra, **bounds)


if TYPE_CHECKING:
    _Model = BaseModel
else:

    class _PlainWords(type(BaseModel)):
        """Makes a constructor raise ConfigError where pydantic raises ValidationError."""

        def __call__(cls, *args, **values):
            try:
                return super().__call__(*args, **values)
            except ValidationError as error:
                raise config_error(cls, error.errors(include_url=False)) from None

    class _Model(BaseModel, metaclass=_PlainWords):
        pass


class Section(_Model):
    """A frozen group of settings; unknown keys, wrong types and non-finite numbers are refused."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, use_attribute_docstrings=False
    )

    @model_validator(mode="before")
    @classmethod
    def _normalise(cls, data: Any) -> Any:
        """Turn fractions, NumPy scalars and -0.0 into plain numbers and drop None where it is the default."""
        if not isinstance(data, dict):
            return data
        return {
            key: _normalised(native(value)) for key, value in data.items() if not cls._is_unset(key, value)
        }

    def __setattr__(self, name: str, value: object) -> None:
        """Refuse, and say how a configuration with another value is made."""
        if name.startswith("_"):
            super().__setattr__(name, value)
            return
        raise self._refusal(name, f"{name} cannot be set", show(value))

    def __delattr__(self, name: str) -> None:
        """Refuse, as setting is."""
        raise self._refusal(name, f"{name} cannot be deleted", "...")

    def _refusal(self, name: str, what: str, value: str) -> ConfigError:
        kind = type(self)
        if name not in kind.model_fields:
            close = nearest(name, kind.model_fields)
            return ConfigError(
                f"{what}: {kind.__name__} has no such value.", f"Did you mean {close}?" * bool(close)
            )
        section = kind.section_name()
        key = f"{section}.{name}" if section else name
        return ConfigError(
            f"{key} cannot be changed: a configuration never changes once it is made.",
            f'Make another one: config = config.with_overrides({{"{key}": {value}}}).',
        )

    @classmethod
    def section_name(cls) -> str:
        """Name of the section in a configuration; empty for the configuration itself."""
        name = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", cls.__name__).lower()
        return {"config": "", "mesh_settings": "mesh"}.get(name, name)

    @classmethod
    def _is_unset(cls, key: object, value: object) -> bool:
        field = cls.model_fields.get(key) if isinstance(key, str) else None
        return value is None and field is not None and field.default is None


def _normalised(value: object) -> object:
    if is_fraction(value):
        try:
            return parse_number(str(value)) + 0.0
        except ValueError:
            return value  # refused below, with the reason
    return 0.0 if isinstance(value, float) and value == 0.0 else value
