"""Versions of everything that a result depends on."""

from __future__ import annotations

import hashlib
import json
import platform
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Final

LIBRARIES = ("gyrify", "numpy", "scipy", "numba", "ipctk", "shapely", "mkl")
# What the result of a run is computed with: packages and modules of gyrify.
NUMERICS: Final = (
    "config",
    "physics",
    "mesh",
    "meshing",
    "energy",
    "tissue",
    "terms",
    "model",
    "solve",
    "onset",
    "run",
    "theory",
    "metrics",
    "measuring",
    "summary",
    "validity",
)


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
        12 hexadecimal digits of the SHA-256 of the source of `NUMERICS` and of the versions of the
        numerical libraries. Equal configurations that run with equal versions have equal
        results on machines of one kind.
    """
    home = Path(__file__).parent
    digest = hashlib.sha256()
    for name in NUMERICS:
        for file in sorted((home / name).rglob("*.py")) or [home / f"{name}.py"]:
            digest.update(file.relative_to(home).as_posix().encode())
            digest.update(file.read_bytes().replace(b"\r\n", b"\n"))
    libraries = {name: version for name, version in versions().items() if name not in ("python", "gyrify")}
    digest.update(json.dumps(libraries, sort_keys=True).encode())
    return digest.hexdigest()[:12]
