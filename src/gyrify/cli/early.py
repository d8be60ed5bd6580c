"""Ctrl-C while the command line is still loading, or already closing down: no traceback."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from gyrify.cli.codes import INTERRUPTED


@contextmanager
def quiet_interrupts() -> Iterator[None]:
    """End the process at Ctrl-C, with its exit code and nothing else, inside a ``with`` block."""
    is_main = threading.current_thread() is threading.main_thread()
    if not is_main or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    signal.signal(signal.SIGINT, lambda *_: os._exit(INTERRUPTED))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def ignore_interrupts() -> None:
    """Let Ctrl-C and SIGTERM do nothing from here on."""
    if threading.current_thread() is threading.main_thread():
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
