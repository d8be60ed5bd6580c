"""TOML in and out: files read with care, values written so that they come back bit for bit."""

from __future__ import annotations

import json
import re
import stat
import sys
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from pydantic import BaseModel

from gyrify.config.numbers import MAX_LENGTH, NUMBER_PATTERN, number_advice
from gyrify.config.words import shorten
from gyrify.errors import ConfigError

MAX_BYTES: Final = 64 * 1024
MAX_PATH: Final = 240
MAX_REASON: Final = 120


def read_text(path: Path) -> str:
    """Read a configuration file.

    Parameters
    ----------
    path : Path
        A regular file of at most 64 KiB in UTF-8.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    ConfigError
        When the file is missing, unreadable, too large or not UTF-8.
    """
    name = f"The configuration file {shorten(str(path), MAX_PATH)}"
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            raise ConfigError(f"{name} is not a regular file.", "Name a TOML file.")
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        raise ConfigError(f"{name} does not exist.", "Check the path.") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ConfigError(
            f"{name} cannot be read: {reason}.", "Check the path and its permissions."
        ) from None
    return _decoded(data, name)


def read_standard_input() -> str:
    """Read a configuration or a study from standard input, as `read_text` reads a file.

    Raises
    ------
    ConfigError
        When there is nothing, too much, or no UTF-8.
    """
    stream = getattr(sys.stdin, "buffer", None)
    data = (sys.stdin.read(MAX_BYTES + 1).encode() if stream is None else stream.read(MAX_BYTES + 1)) or b""
    if not data.strip():
        raise ConfigError("Standard input is empty.", "Write TOML to it, such as: gyrify run - < soft.toml")
    return _decoded(data, "Standard input")


def _decoded(data: bytes, name: str) -> str:
    if len(data) > MAX_BYTES:
        raise ConfigError(f"{name} is larger than {MAX_BYTES // 1024} KiB.", "Name a configuration in TOML.")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ConfigError(f"{name} is not UTF-8 text (byte {error.start}).", "Save it as UTF-8.") from None


def parse(text: str, name: str = "The configuration") -> dict[str, Any]:
    """Parse TOML, or say in one sentence where it is broken.

    Parameters
    ----------
    text : str
        TOML of at most 64 KiB.
    name : str, optional
        What the text is called in a message.

    Returns
    -------
    dict
        Its tables.
    """
    if len(text) > MAX_BYTES:
        raise ConfigError(f"{name} is larger than {MAX_BYTES // 1024} KiB.", "Shorten it.")
    try:
        return tomllib.loads(text)
    except RecursionError:
        reason = "it is nested too deeply"
    except tomllib.TOMLDecodeError as error:
        reason = shorten(" ".join(str(error).split()), MAX_REASON)
    except ValueError:
        reason = "it holds a number of too many digits"
    hint = _line_advice(text, reason)
    file_hint = (
        " To read a file, use Config.load." if text.strip().endswith(".toml") and "\n" not in text else ""
    )
    raise ConfigError(
        f"{name} is not valid TOML: {reason}.", f"{hint or 'Correct or complete that line.'}{file_hint}"
    )


def _line_advice(text: str, reason: str) -> str:
    """What is wrong with the line that a reason names, where a number is written as TOML does not."""
    place = re.search(r"at line (\d+)", reason)
    lines = text.splitlines()
    if place is None or not 0 < int(place[1]) <= len(lines):
        return ""
    _, equals, value = lines[int(place[1]) - 1].partition("=")
    value = value.partition("#")[0].strip()
    if not equals or len(value) > MAX_LENGTH:
        return ""
    if re.match(NUMBER_PATTERN, value, re.ASCII) and "/" in value:
        return f'Write a fraction in quotes: "{value}".'
    return number_advice(value)


def literal(value: Any) -> str:
    """Write a value as TOML.

    Parameters
    ----------
    value : bool, int, float, str, sequence of those, or a small table
        Floats are finite; their shortest exact form is written.

    Returns
    -------
    str
        The TOML literal.
    """
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, BaseModel):
        return "{" + ", ".join(f"{key} = {literal(item)}" for key, item in value) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(literal(item) for item in value) + "]"
    return str(value).lower() if isinstance(value, bool) else repr(value)


def table(lines: Iterable[tuple[str, Any, str]]) -> str:
    """Write keys with values and trailing comments.

    Parameters
    ----------
    lines : iterable of (str, object, str)
        Key, value and comment.

    Returns
    -------
    str
        One line for each key.
    """
    written = ((f"{key} = {literal(value)}", comment) for key, value, comment in lines)
    return "".join(f"{pair}  # {comment}\n" if comment else f"{pair}\n" for pair, comment in written)
