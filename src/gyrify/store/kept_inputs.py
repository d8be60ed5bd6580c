"""What a run needs besides its journal: copies of the files that it was read from, and their mesh."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from gyrify.config import Config
from gyrify.config.body_sections import FROM_FILES
from gyrify.config.inputs.named_files import FILE_KEYS, FOLDER, MESH, content, digest_of, kept_name
from gyrify.errors import ConfigError, HistoryError
from gyrify.model.kept_mesh import mesh_bytes, mesh_digest
from gyrify.model.slice import Slice
from gyrify.store.disk_faults import storage_faults
from gyrify.store.files import refuse_link, whole_file
from gyrify.store.journal import Journal


def inputs_of(config: Config) -> dict[str, bytes]:
    """What the folder of a run holds of the files of its configuration, by name; nothing where it has none.

    Parameters
    ----------
    config : Config
        The run.

    Raises
    ------
    ConfigError
        If a file has changed since the configuration was made.
    """
    if config.geometry.shape not in FROM_FILES:
        return {}
    named = {key: getattr(config.geometry, key) for key in FILE_KEYS if getattr(config.geometry, key)}
    read = {key: content(key, path) for key, path in named.items()}
    if digest_of(read) != config.geometry.digest:
        raise ConfigError("A file of [geometry] changed while the run began.", "Run again.")
    return {kept_name(key, named[key]): read[key] for key in named} | {f"{FOLDER}/{MESH}": mesh_bytes(config)}


def write_inputs(inputs: Mapping[str, bytes], folder: Path) -> None:
    """Write `inputs_of` a configuration into the folder of its run.

    Raises
    ------
    HistoryError
        If the folder cannot be written, or holds a link where they go.
    """
    if not inputs:
        return
    refuse_link(folder / FOLDER)
    with storage_faults(folder):
        (folder / FOLDER).mkdir(exist_ok=True)
        for name, data in inputs.items():
            with whole_file(folder / name) as partial:
                partial.write_bytes(data)


def require_mesh(problem: Slice, journal: Journal) -> Slice:
    """The problem, if its mesh is the one that the run of a journal was begun on.

    Raises
    ------
    HistoryError
        If it is another one.
    """
    recorded = journal.meta("mesh", "")
    if recorded and recorded != mesh_digest(problem.mesh):
        raise HistoryError(
            f"The mesh of {journal.name} is not the one that the run was begun on: {FOLDER}/{MESH} was "
            "removed or replaced, and Netgen here makes another one.",
            f"Restore {FOLDER}/{MESH}, or run again.",
        )
    return problem


def stored_config(text: str, journal: Path | None) -> Config:
    """Configuration that a journal holds; paths of its files are relative to the folder of the run.

    Parameters
    ----------
    text : str
        TOML.
    journal : Path or None
        The journal's file; None for a run in memory.

    Raises
    ------
    HistoryError
        If a copy of a file is missing or damaged.
    """
    try:
        return Config.from_toml(text, None if journal is None else journal.absolute().parent)
    except ConfigError as fault:
        if journal is None or f'"{FOLDER}/' not in text:
            raise
        raise HistoryError(
            f"The run in {journal.parent} lacks a file that it was made from, or it is damaged: "
            f"{fault.message}",
            f"Restore the folder {FOLDER} of the run, or run again.",
        ) from fault
