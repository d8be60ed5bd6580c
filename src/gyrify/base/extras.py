"""Optional packages: loaded when they are needed, and named where they are missing."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from gyrify.errors import ConfigError


def require(module: str, extra: str, what: str, package: str = "") -> Any:
    """Load an optional package.

    Parameters
    ----------
    module : str
        What is imported.
    extra : str
        The extra of gyrify that brings it.
    what : str
        What needs it, as the beginning of a sentence.
    package : str, optional
        Name of the package, where it is not that of the module.

    Returns
    -------
    module

    Raises
    ------
    ConfigError
        If it is not installed; it says what to install.
    """
    try:
        return import_module(module)
    except ImportError as missing:
        package = package or module
        raise ConfigError(
            f"{what} needs the package {package}, which is not installed.", how_to_install(extra, package)
        ) from missing


def how_to_install(extra: str, package: str) -> str:
    """Advice that works: the extra from a copy of the sources, or the package alone."""
    alone, whole = f"pip install {package}", f"pip install '.[{extra}]'"
    return f"Install it with: {alone} (or {whole} in the folder of gyrify's sources)."
