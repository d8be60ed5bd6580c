"""The command line: ``gyrify``."""

from __future__ import annotations

from gyrify.cli.early import quiet_interrupts

with quiet_interrupts():
    from gyrify.cli.app import main

__all__ = ["main"]
