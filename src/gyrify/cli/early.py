"""A request to end while the command line is still loading, or already closing down: no traceback."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from gyrify.base.signals import ending_signals
from gyrify.cli.codes import INTERRUPTED


@contextmanager
def quiet_interrupts() -> Iterator[None]:
    """End the process at Ctrl-C and the like, with their exit code and nothing else, in a ``with`` block."""
    is_main = threading.current_thread() is threading.main_thread()
    usual = (signal.SIG_DFL, signal.default_int_handler)
    # A signal that is ignored (nohup), or that the program around this one handles, stays as it is.
    before = {n: signal.getsignal(n) for n in ending_signals() if is_main and signal.getsignal(n) in usual}
    for number in before:
        signal.signal(number, lambda *_: os._exit(INTERRUPTED))
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def ignore_interrupts() -> None:
    """Let Ctrl-C and all that asks to end do nothing from here on."""
    if threading.current_thread() is threading.main_thread():
        for number in ending_signals():
            signal.signal(number, signal.SIG_IGN)
