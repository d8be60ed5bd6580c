"""Limits on wall time and memory, looked at once per Newton iteration."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from gyrify.errors import LimitReachedError


class Watch:
    """Raises once a limit is reached.

    Parameters
    ----------
    wall_time : float
        Longest time [s]; 0 for no limit.
    memory : float
        Largest resident memory of the process [MB]; 0 for no limit.
    """

    def __init__(self, wall_time: float, memory: float) -> None:
        self._wall_time, self._memory = wall_time, memory
        self._begun = time.monotonic()

    def __call__(self) -> None:
        """Check.

        Raises
        ------
        LimitReachedError
            If a limit is reached.
        """
        if 0.0 < self._wall_time <= time.monotonic() - self._begun:
            raise LimitReachedError(
                f"The wall-time limit of {self._wall_time:g} s is reached.",
                "Continue with `gyrify resume`, or raise limits.wall_time.",
            )
        if 0.0 < self._memory <= resident_memory():
            raise LimitReachedError(
                f"The memory limit of {self._memory:g} MB is reached.",
                "Raise limits.memory, or use a smaller mesh.",
            )


def resident_memory() -> float:
    """Resident memory of this process [MB]: now where the system tells, else its peak."""
    status = Path("/proc/self/statm")
    if status.exists():
        import resource

        return int(status.read_text().split()[1]) * resource.getpagesize() / 1e6
    if sys.platform == "win32":
        return 0.0
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1e6 if sys.platform == "darwin" else peak / 1e3
