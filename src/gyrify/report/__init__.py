"""Pictures and reports of runs."""

from gyrify.report.backend import prepare_matplotlib

prepare_matplotlib()

from gyrify.report.figures import folded_figure, save_figure  # noqa: E402

__all__ = ["folded_figure", "save_figure"]
