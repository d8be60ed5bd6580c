"""Recheck a stored run from its files alone."""

from gyrify.verify.recheck import verify
from gyrify.verify.verification import Check, Verification

__all__ = ["Check", "Verification", "verify"]
