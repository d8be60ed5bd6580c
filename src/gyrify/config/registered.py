"""Settings that take a word of a list to which others may be added: a material, a shape."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema


@dataclass(frozen=True)
class Registered:
    """Annotation of a text that must be a word of a list.

    Attributes
    ----------
    standard : tuple of str
        Words that the package comes with.
    module : str
        Where the list is. Whoever has added to it has imported this module; nobody else needs it.
    names : callable
        Every word of the list, from the module.
    """

    standard: tuple[str, ...]
    module: str
    names: Callable[[ModuleType], Iterable[str]]

    def words(self) -> tuple[str, ...]:
        """Every word, the standard ones first."""
        loaded = sys.modules.get(self.module)
        return tuple(dict.fromkeys((*self.standard, *(self.names(loaded) if loaded else ()))))

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(self._checked, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return {**handler(schema), "enum": list(self.words())}

    def _checked(self, word: str) -> str:
        if word not in self.words():
            raise ValueError("no such word")
        return word
