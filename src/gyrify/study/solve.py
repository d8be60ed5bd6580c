"""One point of a study, from configuration to what is kept of it; runs in whatever process it is sent to."""

from __future__ import annotations

import time
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, Final

from gyrify.base.pool import Watcher, go_on
from gyrify.base.versions import solver_version
from gyrify.config import Config
from gyrify.errors import GyrifyError
from gyrify.run.simulation import kept_run, new_run
from gyrify.run.summary import summarise
from gyrify.store.folder import JOURNAL
from gyrify.store.history import History
from gyrify.study.archive import FinalState, begin_folder, was_begun
from gyrify.study.definition import KEY_DIGITS

_RETRY: Final = "Raise the limit, then run the study again with --retry-failed."


@dataclass(frozen=True)
class Outcome:
    """What a point came to.

    Attributes
    ----------
    config : Config
        The point.
    solver_version : str
        Version of the numerics that it was computed with.
    wall_s : float
        Time that the point took [s].
    status, reason, advice : str
        How it ended.
    summary : dict or None
        As ``summary.json``; None where there is no state.
    final : bytes
        The archived final state; empty where there is none.
    """

    config: Config
    solver_version: str
    wall_s: float
    status: str
    reason: str
    advice: str
    summary: dict[str, Any] | None
    final: bytes


def solve_point(config: Config, watch: Watcher = go_on, *, folder: Path | None = None) -> Outcome:
    """Fold a point and measure it; a failure is an outcome too.

    Parameters
    ----------
    config : Config
        The point.
    watch : callable
        Called at each Newton iteration; may raise to end the run there.
    folder : Path, optional
        Where the whole run folder goes, under its key; without it, nothing is written.

    Returns
    -------
    Outcome
    """
    begun = time.perf_counter()
    told: tuple[str, str, str, dict[str, Any] | None, bytes]
    try:
        history = _in_memory(config, watch) if folder is None else _in_folder(config, folder, watch)
        summary = summarise(history)
        advice = _RETRY if history.status == "stopped" else history.advice
        told = (history.status, history.reason, advice, summary, FinalState.of(history).to_bytes())
    except GyrifyError as failure:
        told = ("failed", failure.message, failure.advice, None, b"")
    except MemoryError:
        told = ("failed", "Memory ran out.", "Use a smaller mesh or fewer workers.", None, b"")
    except Exception as error:  # one point must not take the study with it
        told = ("failed", f"An unexpected {type(error).__name__}: {error}.", "", None, b"")
    return Outcome(config, solver_version(), time.perf_counter() - begun, *told)


def lost_point(config: Config, reason: str = "Its process ended unexpectedly.") -> Outcome:
    """What a point comes to that no process could finish."""
    advice = "Memory ran out, perhaps: use a smaller mesh or fewer workers, then --retry-failed."
    return Outcome(config, solver_version(), 0.0, "failed", reason, advice, None, b"")


def _in_memory(config: Config, watch: Watcher) -> History:
    with new_run(config) as run:
        run.grow_to_some_end(watch)
    return run.history


def _in_folder(config: Config, folder: Path, watch: Watcher) -> History:
    """Begin a run folder, or take it up where the same solver left it; write all its files."""
    # By name: pictures know what a study is, which must not know them.
    outputs = import_module("gyrify.report.outputs")

    target = folder / config.config_hash[:KEY_DIGITS]
    goes_on = was_begun(target, config.config_hash, solver_version()) and (target / JOURNAL).is_file()
    if not goes_on:
        begin_folder(target, config.config_hash, solver_version())
    with kept_run(config, target, goes_on=goes_on) as run:
        try:
            if run.history.status != "completed":
                run.grow_to_some_end(watch)
        except KeyboardInterrupt:
            outputs.write_state(run.history, target)
            raise
        outputs.write_outputs(run.history, target)
    return run.history
