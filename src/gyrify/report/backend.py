"""Matplotlib made ready: pictures need no window, and no home folder."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from gyrify.base.scratch import scratch_folder


def prepare_matplotlib() -> None:
    """Import matplotlib whatever the environment asks of it.

    A process that a notebook starts inherits the notebook's interactive backend, which its own installation
    may not have: matplotlib then refuses to be imported. And where its folder of settings cannot be written,
    it looks for all fonts again in every process, or fails.
    """
    if "matplotlib" in sys.modules:
        return
    if "MPLCONFIGDIR" not in os.environ and not _settings_are_writable():
        folder = scratch_folder()
        if folder is not None:
            os.environ["MPLCONFIGDIR"] = str(folder / "matplotlib")
    backend = os.environ.pop("MPLBACKEND", None)
    try:
        import matplotlib as mpl
    finally:
        if backend is not None:
            os.environ["MPLBACKEND"] = backend
    if backend:
        try:
            mpl.rcParams["backend"] = backend
        except ValueError:  # there is no such backend here: pictures are drawn without one
            return


def _settings_are_writable() -> bool:
    """Whether matplotlib could make its folder of settings; a variable may name it, or the home holds it."""
    if not sys.platform.startswith("linux"):
        return True
    try:
        folders = [
            Path(os.environ.get(variable) or Path.home() / name)
            for variable, name in (("XDG_CONFIG_HOME", ".config"), ("XDG_CACHE_HOME", ".cache"))
        ]
    except RuntimeError:  # the user has no home
        return False
    return all(os.access(_nearest(folder / "matplotlib"), os.W_OK) for folder in folders)


def _nearest(folder: Path) -> Path:
    """The folder, or the nearest one above it that there is."""
    return next(path for path in (folder, *folder.absolute().parents) if path.exists())
