"""Configuration in, history out: runs growth in memory or in a folder, and takes stored runs up again."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

from gyrify.base.arguments import Pathlike, as_path
from gyrify.base.versions import versions
from gyrify.config import Config, ConfigLike, as_config
from gyrify.config.inputs.named_files import FILE_KEYS
from gyrify.errors import ConfigError
from gyrify.model.kept_mesh import mesh_digest
from gyrify.model.slice import Slice
from gyrify.run.progress import progress_observer
from gyrify.run.repeat import known_run
from gyrify.run.running import Observer, Progress, Run
from gyrify.store.disk_faults import storage_faults
from gyrify.store.folder import JOURNAL, new_folder, stored_folder, write_config
from gyrify.store.history import History
from gyrify.store.journal import Journal
from gyrify.store.kept_inputs import inputs_of, require_mesh, stored_config, write_inputs

__all__ = ["Observer", "Progress", "kept_run", "new_run", "resume", "simulate", "stored_run"]


@contextmanager
def new_run(config: ConfigLike, out: Pathlike | None = None, *, overwrite: bool = False) -> Iterator[Run]:
    """Begin a run, and hold its folder until the end of the ``with`` block.

    Parameters
    ----------
    config : Config, dict or path
        Every number of the run; a path is that of a TOML file.
    out : path, optional
        Run folder; without it, the run is kept in memory.
    overwrite : bool
        Whether a run in the folder may be replaced.

    Yields
    ------
    Run

    Raises
    ------
    HistoryError
        If the folder cannot be used.
    """
    config = as_config(config)
    problem = Slice(config)
    meta = {"config": config.to_toml(), "versions": json.dumps(versions()), "n_dim": str(problem.mesh.n_dim)}
    if out is None:
        yield Run(problem, Journal.create(None, meta))
        return
    folder, inputs = as_path("out", out), inputs_of(config)
    meta["config"] = config.to_toml(is_stored=True)
    if inputs:
        meta["mesh"] = mesh_digest(problem.mesh)
    with new_folder(folder, meta["config"], overwrite) as note:
        write_inputs(inputs, folder)
        journal = Journal.create(folder / JOURNAL, meta)
        try:
            yield Run(problem, journal, note)
        finally:
            journal.settle()


@contextmanager
def stored_run(run: Pathlike, overrides: Mapping[str, object] | None = None) -> Iterator[Run]:
    """Take up a stored run, and hold its folder until the end of the ``with`` block.

    Parameters
    ----------
    run : path
        Run folder.
    overrides : mapping, optional
        New values in ``limits`` and ``output``, by dotted key; nothing else of a run can change.

    Yields
    ------
    Run

    Raises
    ------
    HistoryError
        If the folder holds no run, a damaged one, or one that another process works on.
    ConfigError
        If an override is not allowed.
    """
    folder = as_path("run", run)
    with stored_folder(folder) as note:
        journal = Journal.open(folder / JOURNAL)
        config = stored_config(journal.meta("config"), journal.path)
        if overrides:
            config = _changed(config, overrides)
            journal.set_meta(config=config.to_toml(is_stored=True))
        with storage_faults(folder):
            if overrides or not (folder / "config.toml").exists():
                write_config(folder, config.to_toml(is_stored=True))
            (folder / "summary.json").unlink(missing_ok=True)  # it told of an earlier end
        try:
            problem = require_mesh(Slice(config), journal)
            yield Run(problem, journal, f"{note} {_changed_versions(journal)}".strip())
        finally:
            journal.settle()


def kept_run(config: Config, folder: Path, *, goes_on: bool = True) -> AbstractContextManager[Run]:
    """Take up the run that a folder holds, with the limits of its configuration, or begin it there.

    Parameters
    ----------
    config : Config
        The run.
    folder : Path
        Its folder.
    goes_on : bool
        Whether what the folder holds is to be continued; if not, it is replaced.
    """
    if goes_on and (folder / JOURNAL).is_file():
        limits = {f"limits.{key}": value for key, value in config.limits.model_dump().items()}
        return stored_run(folder, limits)
    return new_run(config, folder, overwrite=not goes_on)


def simulate(
    config: ConfigLike,
    out: Pathlike | None = None,
    *,
    observers: Iterable[Observer] = (),
    overwrite: bool = False,
    progress: bool = False,
) -> History:
    """Fold a slice.

    A folder that holds this very run is used again: the stored run is returned if it completed, and continued
    if it did not.

    Parameters
    ----------
    config : Config, dict or path
        Every number of the run; a path is that of a TOML file.
    out : path, optional
        Run folder for the journal; without it, the run is kept in memory.
    observers : iterable of callables
        Called with a `Progress` at each accepted increment, once that is stored; what one raises ends the
        run.
    overwrite : bool
        Whether a run in the folder, whatever it is, is replaced.
    progress : bool
        Whether progress is shown on stderr: a bar on a terminal, else a line at each tenth of growth.

    Returns
    -------
    History
        Complete, or ``stopped`` by a limit of the configuration.

    Raises
    ------
    SolveError
        If growth cannot be completed; all accepted increments are in the folder.
    HistoryError
        If the folder cannot be used, or holds a run of another configuration.
    """
    config = as_config(config)
    known = None if out is None or overwrite else known_run(config, as_path("out", out))
    if known is not None and known.status == "completed" and not known.changes:
        return History.load(known.folder)
    if known is None:
        begin = new_run(config, out, overwrite=overwrite)
    else:
        begin = stored_run(known.folder, known.changes)
    with begin as run, progress_observer(progress) as shown:
        run.grow([*shown, *observers])
    return run.history


def resume(
    run: Pathlike,
    *,
    overrides: Mapping[str, object] | None = None,
    observers: Iterable[Observer] = (),
    progress: bool = False,
) -> History:
    """Continue a run from its last accepted increment to the same end as if it had never stopped.

    Parameters
    ----------
    run : path
        Run folder.
    overrides : mapping, optional
        New values in ``limits`` and ``output``, by dotted key.
    observers : iterable of callables
        As in `simulate`.
    progress : bool
        As in `simulate`.

    Returns
    -------
    History
        Complete, or ``stopped`` by a limit.

    Raises
    ------
    HistoryError
        If the folder holds no run, a damaged one, or one that another process works on.
    SolveError
        If growth cannot be completed.
    """
    with stored_run(run, overrides) as held, progress_observer(progress) as shown:
        held.grow([*shown, *observers])
    return held.history


def _changed(config: Config, overrides: Mapping[str, object]) -> Config:
    changed = config.with_overrides(overrides)
    # paths are no part of the hash, and those of a stored run are its own copies
    moved = any(getattr(changed.geometry, key) != getattr(config.geometry, key) for key in FILE_KEYS)
    if changed.config_hash != config.config_hash or moved:
        raise ConfigError(
            "A stored run keeps its configuration: only values in limits and output can change.",
            "Begin another run with `gyrify run`.",
        )
    return changed


def _changed_versions(journal: Journal) -> str:
    """What is no longer as it was when the run began, and may change its last digits."""
    recorded, now = json.loads(journal.meta("versions", "{}")), versions()
    changed = [
        f"{name} {recorded.get(name, 'none')} -> {now.get(name, 'none')}" for name in {**recorded, **now}
    ]
    changed = [
        text
        for text, name in zip(changed, {**recorded, **now}, strict=True)
        if recorded.get(name) != now.get(name)
    ]
    return (
        f"The run was begun with other versions ({', '.join(changed)}): its end may differ."
        if changed
        else ""
    )
