"""What lies outside what was verified: sentences for the terminal, for JSON and for the stored run.

A check is a function that returns sentences; it is registered once, in the tuple `before.CHECKS` (what a
configuration tells before anything is computed) or `after.CHECKS` (what a run has come to).
"""

from gyrify.run.validity.after import run_warnings
from gyrify.run.validity.before import config_warnings

__all__ = ["config_warnings", "run_warnings"]
