"""Closed-form physics that knows no mesh: growth tensors and hyperelastic densities."""
