"""Versions of everything that a result depends on."""

from __future__ import annotations

import ast
import hashlib
import io
import json
import platform
import tokenize
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Final

LIBRARIES = (
    "gyrify",
    "numpy",
    "scipy",
    "numba",
    "ipctk",
    "shapely",
    "mkl",
    "pyamg",
    "netgen-mesher",
    "trimesh",
    "nibabel",
)
# What the result of a run is computed with: packages of gyrify.
NUMERICS: Final = ("config", "physics", "mesh", "energy", "model", "solve", "run", "theory", "metrics")


def versions() -> dict[str, str]:
    """Version by name, of Python and of the libraries that are installed."""
    found = {"python": platform.python_version()}
    for name in LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


@cache
def solver_version() -> str:
    """Version of the numerics: it changes with their source, and with the libraries that they use.

    Returns
    -------
    str
        12 hexadecimal digits of the SHA-256 of the code of `NUMERICS` and of the versions of the
        numerical libraries. Equal configurations that run with equal versions have equal
        results on machines of one kind.
    """
    home = Path(__file__).parent.parent
    digest = hashlib.sha256()
    for name in NUMERICS:
        for file in sorted((home / name).rglob("*.py")):
            digest.update(file.relative_to(home).as_posix().encode())
            digest.update(code_of(file.read_text(encoding="utf-8")).encode())
    libraries = {name: version for name, version in versions().items() if name not in ("python", "gyrify")}
    digest.update(json.dumps(libraries, sort_keys=True).encode())
    return digest.hexdigest()[:12]


def code_of(source: str) -> str:
    """What of a Python file computes: its lines without comments, docstrings and blank lines.

    Parameters
    ----------
    source : str
        Text of the file, with line ends of any kind.
    """
    # Spaces for what is removed, so that the places of what comes after it hold; by bytes, as `ast` counts.
    source = source.replace("\r\n", "\n")
    lines = [bytearray(line.encode()) for line in source.split("\n")]
    for first, start, last, end in (*_docstrings(source), *_comments(source)):
        for number in range(first, last + 1):
            line = lines[number - 1]
            a, b = start if number == first else 0, end if number == last else len(line)
            line[a:b] = b" " * (b - a)
    return "\n".join(text for line in lines if (text := line.decode().rstrip()))


def _docstrings(source: str) -> list[tuple[int, int, int, int]]:
    """Lines and columns [bytes] at which strings that are statements begin and end."""
    return [
        (value.lineno, value.col_offset, value.end_lineno or 0, value.end_col_offset or 0)
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Expr)
        and isinstance(value := node.value, ast.Constant)
        and isinstance(value.value, str)
    ]


def _comments(source: str) -> list[tuple[int, int, int, int]]:
    """The same of comments."""
    text = "\n".join(source.splitlines()) + "\n"
    found = [t for t in tokenize.generate_tokens(io.StringIO(text).readline) if t.type == tokenize.COMMENT]
    columns = [(t.start[0], len(t.line[: t.start[1]].encode()), len(t.string.encode())) for t in found]
    return [(line, start, line, start + size) for line, start, size in columns]
