"""Files that a configuration names: where they are, what they hold, and what they are called in a run."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from typing import Any, Final

from gyrify.errors import ConfigError

# Keys of [geometry] that name files, and what their copies in the folder of a run are called.
FILE_KEYS: Final = {"file": "surface", "hole_file": "hole", "interface_file": "interface"}
# Folder of the copies.
FOLDER: Final = "inputs"
# What the mesh beside them is called.
MESH: Final = "mesh.npz"
# Ends of names that copies keep, for they tell the format.
SUFFIXES: Final = (
    *(".stl", ".ply", ".off", ".obj", ".gii"),
    *(".mesh", ".vtk", ".vtu", ".msh", ".inp", ".nas", ".bdf", ".su2", ".avs"),
)
# Larger files describe no surface that can be meshed.
MOST_BYTES: Final = 500_000_000


def resolved(tables: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Tables of a configuration in which the paths of its files no longer depend on a folder.

    Parameters
    ----------
    tables : mapping
        Tables by section.
    folder : Path
        What relative paths are relative to.

    Returns
    -------
    dict
    """
    geometry = tables.get("geometry")
    if not isinstance(geometry, Mapping):
        return dict(tables)
    named = {
        key: str((folder / value).absolute())
        for key, value in geometry.items()
        if key in FILE_KEYS and isinstance(value, str) and value
    }
    return {**tables, "geometry": {**geometry, **named}} if named else dict(tables)


def kept_name(key: str, path: str) -> str:
    """What the copy of a file is called, seen from the folder of the run."""
    suffix = Path(path).suffix.lower()
    return f"{FOLDER}/{FILE_KEYS[key]}{suffix if suffix in SUFFIXES else ''}"


def kept_files(folder: Path) -> list[Path]:
    """Every file that a run may have in its folder of copies."""
    copies = [f"{role}{suffix}" for role in FILE_KEYS.values() for suffix in ("", *SUFFIXES)]
    return [folder / FOLDER / name for name in (*copies, MESH)]


def content(key: str, path: str) -> bytes:
    """Bytes of a file.

    Parameters
    ----------
    key : str
        Which of `FILE_KEYS` names it.
    path : str
        Where it is.

    Raises
    ------
    ConfigError
        If it cannot be read, is empty or too large.
    """
    name = f"geometry.{key} = {_shown(path)}"
    try:
        about = Path(path).stat()
        if not (S_ISREG(about.st_mode) or S_ISDIR(about.st_mode)):
            raise ConfigError(f"{name}: it is a device or a pipe.", "Give the path of a file.")
        with Path(path).open("rb") as file:  # which may grow after it was looked at
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise ConfigError(
                f"{name} has {about.st_size / 1e6:.0f} MB; at most {MOST_BYTES / 1e6:.0f} are read.",
                "Give a surface with fewer triangles.",
            )
    except (OSError, ValueError) as fault:
        words: dict[type, str] = {
            FileNotFoundError: "there is no such file",
            IsADirectoryError: "it is a folder",
            PermissionError: "it may not be read",
        }
        why = words.get(type(fault), "it cannot be read")
        raise ConfigError(
            f"{name}: {why}.",
            "Give the path of a surface; it is relative to the configuration file.",
        ) from fault
    if not data:
        raise ConfigError(f"{name}: it is empty.", "Give a file that holds a body.")
    return data


def digest(paths: Mapping[str, str]) -> str:
    """SHA-256 over the files that a configuration names, whatever they are called.

    Parameters
    ----------
    paths : mapping
        Paths by key of `FILE_KEYS`; empty where there is none.
    """
    return _joined({key: _of_file(key, path, *_version(path)) for key, path in paths.items() if path})


def digest_of(contents: Mapping[str, bytes]) -> str:
    """The same from what the files hold."""
    return _joined({key: hashlib.sha256(data).hexdigest() for key, data in contents.items()})


def _joined(digests: Mapping[str, str]) -> str:
    lines = "".join(f"{key} {digests[key]}\n" for key in FILE_KEYS if key in digests)
    return hashlib.sha256(lines.encode()).hexdigest()


def _version(path: str) -> tuple[int, int]:
    """What differs once a file was written to, but within the resolution of the clock of the disk."""
    try:
        found = Path(path).stat()
    except (OSError, ValueError):
        return 0, 0
    return found.st_mtime_ns, found.st_size


@lru_cache(maxsize=32)
def _of_file(key: str, path: str, _written: int, _size: int) -> str:
    return hashlib.sha256(content(key, path)).hexdigest()


def _shown(path: str) -> str:
    here = Path(path)
    if here.is_relative_to(Path.cwd()):
        path = here.relative_to(Path.cwd()).as_posix()
    return f'"{path}"' if len(path) <= 100 else f'"…{path[-99:]}"'
