"""Signals that ask a process to end: of terminals, and of batch systems before they kill."""

from __future__ import annotations

import signal
from typing import Final

# Ctrl-C; kill, and most queues at the end of a job; a closed terminal; Slurm and LSF by request, SGE with
# -notify; the limit on processor time.
_NAMES: Final = ("SIGINT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGXCPU")


def ending_signals(*others: str) -> tuple[signal.Signals, ...]:
    """Those that this system has, but for the named others."""
    known = signal.Signals.__members__
    return tuple(known[name] for name in _NAMES if name in known and name not in others)
