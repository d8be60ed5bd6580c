"""gyrify simulates how the cerebral cortex folds."""

__version__ = "0.1.0"
