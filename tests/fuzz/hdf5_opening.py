"""HDF5 opens a file in a process of its own, so that a crash of the library is counted and not suffered.

Run as a program, this is that process: it reads names of files, one a line, and answers each with one line.
It has little memory, may write nothing, and is ended by a signal when an answer takes more than `TIME_LIMIT`
of the processor.
"""

from __future__ import annotations

import contextlib
import resource
import select
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Final

from guard import Outcome

ROOM: Final = 2**29
TIME_LIMIT: Final = 5.0
LONGEST_WAIT: Final = 120.0
# After so many files a new process begins, so that none suffers from what others left behind.
_FILES: Final = 1000
_READY: Final = "ready"


class Opened(Outcome):
    """What HDF5 did with a file; nothing of it is a fault of gyrify, which does not open it."""

    @property
    def is_fault(self) -> bool:
        """Never."""
        return False


class Opener:
    """A process that opens files; a new one takes its place when it is gone, or has opened many.

    Parameters
    ----------
    command : sequence of str, optional
        The process; this module by default.
    longest : float
        Longest time to wait for an answer [s].
    """

    def __init__(self, command: tuple[str, ...] = (), longest: float = LONGEST_WAIT) -> None:
        self.command = command or (sys.executable, "-W", "ignore", str(Path(__file__)))
        self.longest = longest
        self._process: subprocess.Popen[str] | None = None
        self._opened = 0

    def __enter__(self) -> Opener:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def open(self, path: Path) -> Opened:
        """Have HDF5 read a whole file.

        Parameters
        ----------
        path : Path
            The file.

        Returns
        -------
        Opened
            ``read``, ``refused`` (an exception), ``memory``, ``crash`` (the process died) or ``hang``.
        """
        process, begun = self._running(), time.perf_counter()
        assert process.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            process.stdin.write(f"{path}\n")
            process.stdin.flush()
        answer = self._answer(process, self.longest)
        seconds = time.perf_counter() - begun
        if answer:
            kind, _, told = answer.partition(" ")
            return Opened(kind, told, seconds)
        status = process.wait() if answer == "" else None
        self._end()
        kind = "hang" if status in (None, -signal.SIGPROF) else "crash"
        return Opened(kind, f"exit {status}", seconds)

    def _running(self) -> subprocess.Popen[str]:
        self._opened += 1
        if self._opened % _FILES == 0:
            self._end()
        if self._process is None:
            self._process = subprocess.Popen(
                self.command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                bufsize=1,
            )
            if self._answer(self._process, 120.0) != _READY:
                raise RuntimeError(f"The process that opens files did not begin: {self.command}")
        return self._process

    @staticmethod
    def _answer(process: subprocess.Popen[str], limit: float) -> str | None:
        """A line; empty at the end of the process, None where none comes in time."""
        assert process.stdout is not None
        ready, _, _ = select.select([process.stdout], [], [], limit)
        return process.stdout.readline().strip() if ready else None

    def _end(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            for stream in (self._process.stdin, self._process.stdout):
                with contextlib.suppress(BrokenPipeError):
                    stream.close()  # type: ignore[union-attr]
            self._process = None


def read_all(path: str) -> str:
    """Every attribute and every array of a file; in a word what became of it."""
    import h5py

    def look(_: str, node: h5py.Group | h5py.Dataset) -> None:
        dict(node.attrs)
        if isinstance(node, h5py.Dataset):
            node[()]

    try:
        with h5py.File(path, "r") as file:
            dict(file.attrs)
            file.visititems(look)
    except MemoryError:
        return "memory"
    except Exception as error:
        return f"refused {type(error).__name__}"
    return "read"


def main() -> None:
    """Answer until there are no more names."""
    import h5py  # noqa: F401  (before the limit)

    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    taken = pages * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (taken + ROOM, taken + ROOM))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    print(_READY, flush=True)
    for line in sys.stdin:
        signal.setitimer(signal.ITIMER_PROF, TIME_LIMIT)
        print(read_all(line.rstrip("\n")), flush=True)


if __name__ == "__main__":
    main()
