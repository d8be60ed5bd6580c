"""Work on independent items in processes of one thread each, or in this one; results as they come."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor
from concurrent.futures import wait as await_futures
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.connection import wait
from multiprocessing.synchronize import Event
from typing import Any, Final, Self, TypeVar

from gyrify.base.signals import ending_signals
from gyrify.errors import GyrifyError

Item = TypeVar("Item")
Result = TypeVar("Result")
Watcher = Callable[[], None]
Work = Callable[[Item, Watcher], Result]

MAX_WORKERS: Final = 256
_ONE_THREAD: Final = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
_stop: Event | None = None
_is_asked_to_end = False


def go_on() -> None:
    """Watch for nothing."""


def each(
    work: Work[Item, Result], items: Sequence[Item], workers: int, lost: Callable[[Item], Result]
) -> Generator[Result, None, None]:
    """Work on every item; results come as they are ready.

    Close the iterator (``contextlib.closing``) to end early: every process then ends at a safe place.

    Parameters
    ----------
    work : callable
        Called with an item and a function that it must call often, which raises KeyboardInterrupt where the
        work should end; for several workers, one that can be pickled.
    items : sequence
        Begun in this order.
    workers : int
        Processes; one works in this process.
    lost : callable
        What an item comes to whose process dies over it, even when it is worked on alone.

    Yields
    ------
    object
        What ``work`` returned.

    Raises
    ------
    GyrifyError
        If processes cannot begin.
    """
    if workers == 1:
        yield from (work(item, go_on) for item in items)
        return
    waiting = list(reversed(items))
    while waiting:
        begun: dict[Future[Result], Item] = {}
        with Crew(min(workers, len(waiting))) as crew:
            try:
                while waiting or begun:
                    while waiting and len(begun) <= crew.size:  # one more than at work: none is ever idle
                        item = waiting.pop()
                        begun[crew.submit(_work, work, item)] = item
                    for future in await_futures(begun, return_when=FIRST_COMPLETED).done:
                        result = future.result()
                        del begun[future]
                        yield result
            except BrokenProcessPool:
                crew.require_begun()
        for item in begun.values():  # a process has died, over one of these
            yield _alone(work, item, lost)


def _alone(work: Work[Item, Result], item: Item, lost: Callable[[Item], Result]) -> Result:
    """Work on an item in a process that works on nothing else."""
    with Crew(1) as crew:
        try:
            found: Result = crew.submit(_work, work, item).result()
            return found
        except BrokenProcessPool:
            crew.require_begun()
            return lost(item)


class Crew(Executor):
    """Processes of one thread each in a ``with`` block; at its end they are asked to end at a safe place."""

    def __init__(self, size: int) -> None:
        self.size = size
        context = multiprocessing.get_context("spawn")
        with _deaf_children():  # Python begins a process that looks after these
            self._stop, self._begun = context.Event(), context.Event()
        self._pool = ProcessPoolExecutor(size, context, _begin_worker, (self._stop, self._begun))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()  # only an interrupt or an error finds work that still goes on
        self._pool.shutdown(wait=True, cancel_futures=True)

    def submit(self, work: Callable[..., Result], /, *arguments: Any, **options: Any) -> Future[Result]:
        """Let the next idle process work; it begins processes while there are too few."""
        try:
            with _one_thread(), _deaf_children():
                return self._pool.submit(work, *arguments, **options)
        except BrokenProcessPool as broken:  # known only now; it is to be met where results are
            future: Future[Result] = Future()
            future.set_exception(broken)
            return future

    def require_begun(self) -> None:
        """Tell processes that die over their work from those that never came to it.

        Raises
        ------
        GyrifyError
            If none has ever begun.
        """
        if not self._begun.is_set():
            raise GyrifyError(
                "No process for the runs could be started.",
                "In a script, call this below if __name__ == '__main__'; or use one worker.",
            )


def _work(work: Work[Item, Result], item: Item) -> Result:
    return work(item, _look)


def _look() -> None:
    if _is_asked_to_end or (_stop is not None and _stop.is_set()):
        raise KeyboardInterrupt


def _begin_worker(stop: Event, begun: Event) -> None:
    """Leave Ctrl-C to the parent, and end with it whatever becomes of it.

    Queues send their signals to every process of a job: work then ends at a safe place, and the parent with
    it. SIGTERM ends a process at once, because that is how a broken pool is taken down.
    """
    global _stop
    _stop = stop
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for number in ending_signals("SIGINT", "SIGTERM"):
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _note)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, ending_signals())
    parent = multiprocessing.parent_process()
    if parent is not None:
        sentinel = parent.sentinel
        threading.Thread(target=lambda: (wait([sentinel]), os._exit(1)), daemon=True).start()
    begun.set()


def _note(*_: object) -> None:
    global _is_asked_to_end
    _is_asked_to_end = True


@contextmanager
def _deaf_children() -> Iterator[None]:
    """Hold signals back while processes begin: they inherit that, and lay it down once they are prepared."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ending_signals())
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _one_thread() -> Iterator[None]:
    """Let processes that begin inside a ``with`` block compute with one thread each."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
