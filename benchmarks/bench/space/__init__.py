"""Measured constants for a plan in three dimensions: tetrahedra, factorisation, multigrid, contact."""
