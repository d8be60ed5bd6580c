"""What goes to stdout and what to stderr."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable


def print_json(document: object) -> None:
    """Print the one JSON document of a command on stdout."""
    print(json.dumps(document, indent=2, ensure_ascii=True, allow_nan=False))


def complain(message: str) -> None:
    """Print a message on stderr."""
    text = f"gyrify: {_harmless(message)}\n"
    encoding = sys.stderr.encoding or "utf-8"
    sys.stderr.write(text.encode(encoding, "backslashreplace").decode(encoding))


def warn(sentences: Iterable[str]) -> None:
    """Print warnings on stderr; ``--quiet`` and ``--json`` do not silence them."""
    for sentence in sentences:
        complain(f"Warning: {sentence}")


def say(text: str) -> None:
    """Print text on stdout, in whatever encoding it has."""
    encoding = sys.stdout.encoding or "utf-8"
    print(_harmless(text).encode(encoding, "backslashreplace").decode(encoding))


def _harmless(text: str) -> str:
    """Text without characters that command a terminal or hide: they are written as escapes."""
    return "".join(c if c.isprintable() or c == "\n" else repr(c)[1:-1] for c in text)
