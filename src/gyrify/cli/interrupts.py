"""Ctrl-C, SIGTERM, a closed terminal or a queue's warning during a run: it ends at a safe place, and soon.

A signal is noted, and the run looks for it at each Newton iteration, so that it never strikes inside a
transaction. Where that place is not reached in time (a library compiles, loads or factorises), or there is
nothing to save yet, the process ends where it is: the journal keeps every accepted increment at any moment.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from shlex import quote
from types import FrameType, TracebackType
from typing import Final, Self

from gyrify.base.signals import ending_signals
from gyrify.cli.codes import INTERRUPTED

# Seconds that a run gets to reach a safe place and save; and that a start gets to leave foreign code.
GRACE: Final = 1.2
START_GRACE: Final = 0.2


class Interrupts:
    """Catches the signals that ask a run to end, inside a ``with`` block of the main thread.

    Parameters
    ----------
    as_json : bool
        Whether a JSON document is owed to stdout.

    Attributes
    ----------
    requested : bool
        Whether a signal came.
    """

    def __init__(self, as_json: bool = False) -> None:
        self.requested, self._name = False, ""
        self._json, self._is_told = as_json, False
        self._folder: Path | None = None
        self._over, self._ending = threading.Event(), threading.Lock()
        self._previous: dict[int, Callable[[int, FrameType | None], object] | int | None] = {}
        self._wake: tuple[socket.socket, socket.socket] | None = None

    def __enter__(self) -> Self:
        if threading.current_thread() is not threading.main_thread():
            return self
        reader, writer = self._wake = socket.socketpair()
        writer.setblocking(False)
        signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
        threading.Thread(target=self._await_signal, args=(reader,), daemon=True).start()
        for number in ending_signals():
            # A signal that is ignored (nohup, a job in the background) stays ignored.
            if (previous := signal.getsignal(number)) is not signal.SIG_IGN:
                self._previous[number] = previous
                signal.signal(number, self._note)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        for number, previous in self._previous.items():
            # After one signal the process is about to end, and more of them would only garble that.
            signal.signal(number, signal.SIG_IGN if self.requested else previous)
        if self._wake is not None:
            signal.set_wakeup_fd(-1)
            for end in self._wake:
                end.close()

    def guard(self, folder: Path) -> None:
        """From here on there is something to save in a folder."""
        self._folder = folder

    def watch(self) -> None:
        """Look for a signal, at a place where the run may end.

        Raises
        ------
        KeyboardInterrupt
            If there was one; once.
        """
        if self.requested and not self._is_told:
            self._is_told = True
            raise KeyboardInterrupt(self._name)

    def _note(self, number: int, frame: FrameType | None) -> None:  # noqa: ARG002
        if not self.requested:
            self.requested, self._name = True, signal.Signals(number).name
        if self._folder is None:
            self._end()

    def _await_signal(self, reader: socket.socket) -> None:
        """Wait for a signal in a thread of its own, since the main one may be deep in foreign code."""
        with contextlib.suppress(OSError):
            while number := reader.recv(1):
                if number[0] in self._previous:
                    if not self._over.wait(START_GRACE if self._folder is None else GRACE):
                        self._end()
                    return

    def _end(self) -> None:
        """End the process here and now, with the message and code of an interrupt.

        Past Python's streams, whose locks the main thread may hold for ever.
        """
        if not self._ending.acquire(blocking=False):
            return
        if self._folder is not None and (self._folder / "journal.sqlite").is_file():
            with contextlib.suppress(OSError):
                (self._folder / "run.owner.json").unlink()  # an orderly end, if an abrupt one
            said, advice = (
                "Every accepted increment is stored.",
                f"Continue with: gyrify resume {quote(str(self._folder))}",
            )
        else:
            said, advice = "Nothing had been computed yet.", "Run it again."
        cursor = "\x1b[?25h\n" if os.isatty(2) else ""  # a live bar hides it
        _write(2, f"{cursor}gyrify: Interrupted. {said}\ngyrify: {advice}\n")
        if self._json:
            _write(1, json.dumps({"error": "Interrupted", "message": said, "advice": advice}) + "\n")
        os._exit(INTERRUPTED)


def _write(descriptor: int, text: str) -> None:
    with contextlib.suppress(OSError):
        os.write(descriptor, text.encode("utf-8", "backslashreplace"))


@contextlib.contextmanager
def ends_are_interrupts() -> Iterator[None]:
    """Let every signal that asks to end do what Ctrl-C does, inside a ``with`` block of the main thread."""
    numbers = ending_signals("SIGINT")
    is_main = threading.current_thread() is threading.main_thread()
    # A signal that is ignored (nohup) stays ignored.
    before = {n: signal.getsignal(n) for n in numbers if is_main and signal.getsignal(n) != signal.SIG_IGN}
    for number in before:
        signal.signal(number, _interrupt)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _interrupt(number: int, frame: FrameType | None) -> None:  # noqa: ARG001
    raise KeyboardInterrupt(signal.Signals(number).name)
