"""Versions of everything that a result depends on."""

from __future__ import annotations

import platform
from importlib import metadata

LIBRARIES = ("gyrify", "numpy", "scipy", "numba", "ipctk", "shapely", "mkl")


def versions() -> dict[str, str]:
    """Version by name, of Python and of the libraries that are installed."""
    found = {"python": platform.python_version()}
    for name in LIBRARIES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found
