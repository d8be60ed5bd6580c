"""Exit codes of the command line."""

from __future__ import annotations

from typing import Final

COMPLETED: Final = 0
FAILED: Final = 1
USAGE: Final = 2
STOPPED: Final = 3
INTERRUPTED: Final = 130
