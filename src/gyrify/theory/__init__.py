"""Exact onset of folding, independent of the two-dimensional code and a reference to verify it against."""

from gyrify.theory.annulus import Annulus, BaseState, base_state

__all__ = ["Annulus", "BaseState", "base_state"]
