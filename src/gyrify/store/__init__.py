"""Stored runs: the journal is the truth, everything else in a run folder is derived from it."""

from gyrify.store.history import History
from gyrify.store.journal import Journal

__all__ = ["History", "Journal"]
