"""What must hold whatever a reader is given: a clear error or none, soon, and nothing written elsewhere.

`guarded` runs one input. An audit hook of the interpreter sees every file that is opened for writing, every
folder made, every name moved or removed, and refuses what lies outside of the folders that are allowed; it
refuses processes, connections and unpickled classes altogether.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from unittest import mock
from urllib.parse import unquote, urlsplit

from gyrify.errors import GyrifyError

TIME_LIMIT: Final = 3.0
LONGEST_MESSAGE: Final = 6000
_WRITES: Final = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
# Which arguments of an event are paths that it changes.
_CHANGED: Final = {
    "os.mkdir": (0,),
    "os.rmdir": (0,),
    "os.remove": (0,),
    "os.rename": (0, 1),
    "os.link": (1,),
    "os.symlink": (1,),
    "os.truncate": (0,),
    "os.chmod": (0,),
    "os.chown": (0,),
    "os.utime": (0,),
    "shutil.rmtree": (0,),
    "shutil.move": (0, 1),
    "sqlite3.connect": (0,),
}
_NEVER: Final = (
    "pickle.find_class",
    "subprocess.Popen",
    "os.system",
    "os.exec",
    "os.fork",
    "os.posix_spawn",
    "os.putenv",
    "socket.connect",
    "socket.bind",
    "urllib.Request",
    "ctypes.dlopen",
    "webbrowser.open",
)


class Hang(BaseException):
    """An input took too long; no handler of ordinary errors catches it."""


@dataclass(frozen=True)
class Outcome:
    """What became of an input.

    Attributes
    ----------
    kind : str
        ``read``, ``refused`` (a clear error), or a fault: ``crash``, ``hang``, ``memory``, ``message`` or
        ``escape``.
    told : str
        The error.
    seconds : float
        Time of the processor.
    """

    kind: str
    told: str
    seconds: float

    @property
    def is_fault(self) -> bool:
        """Whether something is wrong with the reader, not with the input."""
        return self.kind not in ("read", "refused")


class _Watch:
    """The state of the audit hook, which cannot be taken out again."""

    allowed: tuple[str, ...] | None = None
    named: tuple[str, ...] = ()
    escapes: tuple[str, ...] = ()


def _hook(event: str, arguments: tuple[Any, ...]) -> None:
    if _Watch.allowed is None or not (event == "open" or event in _CHANGED or event.startswith(_NEVER)):
        return
    if event == "open":
        path, _, flags = arguments
        changed = (path,) if isinstance(flags, int) and flags & _WRITES else ()
    else:
        changed = tuple(_in_folder(arguments, place) for place in _CHANGED.get(event, ()))
    outside = [str(path) for path in changed if not _is_allowed(path)]
    if outside or event.startswith(_NEVER):
        if not (outside and all(map(_is_named, outside))):
            _Watch.escapes = (*_Watch.escapes, f"{event} {outside or arguments}")
        raise PermissionError(13, "Permission denied")


def _in_folder(arguments: tuple[Any, ...], place: int) -> object:
    """Path of an event; relative to an open folder, where one is given as the last number."""
    path, last = arguments[place], arguments[-1]
    is_relative = isinstance(path, str | bytes) and not os.path.isabs(path)
    if is_relative and isinstance(last, int) and last >= 0 and len(arguments) in (2, 3, 4):
        with contextlib.suppress(OSError):
            return os.path.join(os.readlink(f"/proc/self/fd/{last}"), os.fsdecode(path))
    return path


sys.addaudithook(_hook)


def _is_allowed(path: object) -> bool:
    if isinstance(path, int):
        return True
    text = os.fsdecode(path)  # type: ignore[arg-type]
    if text.startswith("file:"):
        text = unquote(urlsplit(text).path)
    if text in (":memory:", "", os.devnull):
        return True
    real = os.path.realpath(text)
    return any(real == root or real.startswith(root + os.sep) for root in _Watch.allowed or ())


def _is_named(path: str) -> bool:
    """Whether the caller named this path: refused all the same, but no fault of the reader."""
    real = os.path.realpath(path)
    return any(
        real.startswith(name.rstrip(os.sep) + os.sep)
        or os.path.dirname(real) == os.path.dirname(name)
        or name.startswith(real.rstrip(os.sep) + os.sep)
        or real == name
        for name in _Watch.named
    )


def name_paths(*paths: str) -> None:
    """Take note of paths that the caller itself asked to be written, for the input at hand."""
    _Watch.named = tuple(os.path.realpath(path) for path in paths if path)


@contextmanager
def confined(*folders: Path) -> Iterator[None]:
    """Refuse and note every change outside of some folders."""
    _Watch.named, _Watch.escapes = (), ()
    _Watch.allowed = tuple(os.path.realpath(folder) for folder in folders)
    try:
        yield
    finally:
        _Watch.allowed = None


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Raise Hang in what takes more time of the processor, or waits twenty times as long.

    The wait is counted by alarms: there is but one for all the time that the process itself was stopped.
    """
    alarms = 0

    def stop(number: int, _: object) -> None:
        nonlocal alarms
        alarms += 1
        if number == signal.SIGPROF or alarms >= 20:
            raise Hang

    timers = ((signal.SIGPROF, signal.ITIMER_PROF), (signal.SIGALRM, signal.ITIMER_REAL))
    previous = [signal.signal(number, stop) for number, _ in timers]
    for _, timer in timers:
        signal.setitimer(timer, seconds, seconds)
    try:
        yield
    finally:
        for (number, timer), handler in zip(timers, previous, strict=True):
            signal.setitimer(timer, 0.0)
            signal.signal(number, handler)


def guarded(
    read: Callable[[bytes], object], data: bytes, *folders: Path, limit: float = TIME_LIMIT
) -> Outcome:
    """Give a reader one input and say what became of it.

    Parameters
    ----------
    read : callable
        The reader.
    data : bytes
        The input.
    *folders : Path
        Where it may write.
    limit : float
        Longest time of the processor [s].

    Returns
    -------
    Outcome
    """
    begun = time.process_time()
    kind, told = "read", ""
    try:
        with confined(*folders), mock.patch("tempfile.tempdir", str(folders[0])), time_limit(limit):
            read(data)
    except GyrifyError as error:
        kind, told = ("refused", str(error)) if is_clear(str(error)) else ("message", repr(str(error)))
    except Hang:
        kind, told = "hang", f"more than {limit:g} s"
    except MemoryError as error:
        kind, told = "memory", repr(error)
    except Exception as error:
        kind, told = "crash", f"{type(error).__name__}: {error} in {_place(error)}"
    if _Watch.escapes:
        kind, told = "escape", "; ".join(_Watch.escapes[:3])
    return Outcome(kind, told[:500], time.process_time() - begun)


def is_clear(message: str) -> bool:
    """Whether a message is a short text fit for a terminal, without the jargon of an interpreter."""
    if not message.strip() or len(message) > LONGEST_MESSAGE:
        return False
    jargon = re.search(r"Traceback|ValidationError|at 0x[0-9a-f]{9}|<[\w.]+ object", message)
    return jargon is None and all(c.isprintable() or c == "\n" for c in message)


def _place(error: BaseException) -> str:
    """Innermost line of gyrify that an error passed through."""
    found, trace = "?", error.__traceback__
    while trace is not None:
        name = trace.tb_frame.f_code.co_filename
        if "/gyrify/" in name:
            found = f"{name.rpartition('/gyrify/')[2]}:{trace.tb_lineno}"
        trace = trace.tb_next
    return found
