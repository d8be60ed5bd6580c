"""Minimisation of the total energy along growth."""
