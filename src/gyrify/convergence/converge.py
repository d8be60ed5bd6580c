"""Drives a study of convergence: plan, runs, verdicts."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path

from gyrify.base.arguments import Pathlike, as_path, as_words, real_number, whole_number
from gyrify.config import Config, ConfigLike, as_config
from gyrify.convergence.levels import Convergence, Family, Level
from gyrify.convergence.plan import SUBJECTS, Subject, plan
from gyrify.convergence.runs import complete_all
from gyrify.errors import ConfigError
from gyrify.store.disk_faults import storage_faults

Teller = Callable[[Level, int, int], None]


def converge(
    config: ConfigLike,
    out: Pathlike | None = None,
    *,
    levels: int = 3,
    of: Subject | Sequence[Subject] | None = None,
    workers: int = 1,
    tolerance: float = 0.02,
    tell: Teller | None = None,
) -> Convergence:
    """Refine mesh, increments and contact distance in turn, and judge what the metrics converge to.

    Every level is a run of its own; nothing is transferred between meshes. Complete runs in the folder are
    not run again, and one that ended early is taken up where it ended.

    Parameters
    ----------
    config : Config, dict or path
        Where every family starts: its coarsest level.
    out : path, optional
        Folder for runs and results; by default ``convergence/`` and 12 digits of the configuration's hash.
    levels : int
        Runs per family, each twice as fine as the one before; three are needed for an order.
    of : {"mesh", "increments", "contact"} or a sequence of them, optional
        What is refined; by default all that has a meaning for the configuration.
    workers : int
        Processes; 1 computes in this one. More need the usual ``if __name__ == "__main__"`` in a script.
    tolerance : float
        Largest relative error that counts as converged.
    tell : callable, optional
        Called with each run as it ends, the number of runs that have, and their total.

    Returns
    -------
    Convergence
        Also written to the folder, as JSON and CSV.

    Raises
    ------
    ConfigError
        If an argument is out of range.
    HistoryError
        If the folder cannot be written.
    KeyboardInterrupt
        At Ctrl-C; the same call continues.
    """
    begun, config = time.perf_counter(), as_config(config)
    tolerance, workers = real_number("tolerance", tolerance), whole_number("workers", workers)
    _require_sensible(tolerance, workers)
    usual = tuple(s for s in SUBJECTS if s != "contact" or config.contact.enabled)
    folder = default_folder(config) if out is None else as_path("out", out)
    plans = plan(config, usual if of is None else as_words("of", of), whole_number("levels", levels))
    with storage_faults(folder):
        (folder / "runs").mkdir(parents=True, exist_ok=True)
    families = _complete(plans, folder / "runs", workers, tolerance, tell)
    convergence = Convergence(config, families, tolerance, time.perf_counter() - begun)
    with storage_faults(folder):
        convergence.write(folder)
    return convergence


def _require_sensible(tolerance: float, workers: int) -> None:
    if not 0.0 < tolerance < 1.0:
        raise ConfigError(f"tolerance = {tolerance:g} is out of range (above 0, below 1).", "Try 0.02.")
    if not 1 <= workers <= 256:
        raise ConfigError(f"workers = {workers} is out of range (1 to 256).", "Try the number of cores.")


def _complete(
    plans: dict[Subject, tuple[Config, ...]],
    folder: Path,
    workers: int,
    tolerance: float,
    tell: Teller | None,
) -> tuple[Family, ...]:
    """Every run that a family needs, each once, the finest begun first."""
    runs = {c.config_hash: c for group in reversed(plans.values()) for c in group}
    known: list[Level] = []

    def note(level: Level) -> None:
        known.append(level)
        if tell is not None:
            tell(level, len(known), len(runs))

    found = complete_all(list(runs.values()), folder, min(workers, len(runs)), note)
    return tuple(
        Family(subject, tuple(found[c.config_hash] for c in group), tolerance)
        for subject, group in plans.items()
    )


def default_folder(config: Config) -> Path:
    """Folder of a study that is given none."""
    return Path("convergence") / config.config_hash[:12]
