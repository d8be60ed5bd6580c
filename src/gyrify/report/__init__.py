"""Pictures and reports of runs."""

from gyrify.report.figures import folded_figure, save_figure

__all__ = ["folded_figure", "save_figure"]
