"""Where the points of a study are computed: here, in processes, by any executor, or by a dask scheduler."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, as_completed
from contextlib import contextmanager
from typing import Final

from gyrify.base.extras import require
from gyrify.base.pool import each
from gyrify.config import Config
from gyrify.errors import ConfigError, GyrifyError
from gyrify.study.solve import Outcome, lost_point

Work = Callable[[Config], Outcome]
_PATIENCE: Final = "20s"
# Times that dask begins a point again whose worker has died, before the point counts as failed.
_RETRIES: Final = 3


def outcomes(
    work: Callable[..., Outcome], configs: Sequence[Config], workers: int, executor: Executor | None
) -> Generator[Outcome, None, None]:
    """Outcomes as they come; close the iterator to end early.

    Parameters
    ----------
    work : callable
        `gyrify.study.solve.solve_point`, with what is common to all points.
    configs : sequence of Config
        The points.
    workers : int
        Processes, where there is no executor.
    executor : concurrent.futures.Executor, optional
        Who works on them instead.

    Yields
    ------
    Outcome

    Raises
    ------
    GyrifyError
        If processes cannot begin, or the executor breaks.
    """
    if executor is None:
        return each(work, configs, workers, lost_point)
    return _by_executor(work, configs, executor)


def _by_executor(work: Work, configs: Sequence[Config], executor: Executor) -> Generator[Outcome, None, None]:
    futures = {executor.submit(work, config): config for config in configs}
    try:
        for future in as_completed(futures):
            config = futures.pop(future)
            try:
                yield future.result()
            except (BrokenExecutor, CancelledError) as broken:
                raise GyrifyError(
                    f"The executor failed: {broken or type(broken).__name__}.",
                    "What is done is stored: run the study again to continue.",
                ) from broken
            except Exception as error:  # of the executor's own: a point's errors are outcomes
                yield lost_point(config, f"Its worker was lost ({type(error).__name__}): {error}.")
    finally:
        for future in futures:
            future.cancel()


@contextmanager
def dask_executor(address: str) -> Iterator[Executor]:
    """Executor of a running dask scheduler, which begins points again whose worker has died.

    Parameters
    ----------
    address : str
        Such as ``tcp://node1:8786``.

    Yields
    ------
    concurrent.futures.Executor

    Raises
    ------
    ConfigError
        If dask is not installed, or no scheduler answers.
    """
    distributed = require("distributed", "cluster", "A dask scheduler")
    try:
        client = distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError) as fault:
        raise ConfigError(
            f"No dask scheduler answers at {address[:120]}: {' '.join(str(fault).split())[:160]}.",
            "Start one with `dask scheduler`, and name the address that it prints.",
        ) from fault
    with client:
        if not client.scheduler_info()["workers"]:
            raise ConfigError(
                f"The scheduler at {address} has no workers.", f"Start `dask worker {address}`."
            )
        yield client.get_executor(pure=False, retries=_RETRIES)
