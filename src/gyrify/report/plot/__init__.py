"""Pictures of runs at journal quality: one state or all of growth, one run or several side by side."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from io import BytesIO
from typing import Final, Literal, get_args

from matplotlib.figure import Figure

from gyrify.base.arguments import as_path, real_number
from gyrify.errors import ConfigError
from gyrify.report.plot.dispersion import dispersion_plot
from gyrify.report.plot.energy import energy_plot
from gyrify.report.plot.folded import folded_plot
from gyrify.report.plot.index_curves import gi_plot
from gyrify.report.plot.mode import mode_plot
from gyrify.report.plot.shown import Run, Shown, show
from gyrify.report.plot.stress import stress_plot
from gyrify.report.plot.study_slices import is_study, study_plot
from gyrify.report.plot.style import HUES
from gyrify.report.plot.thickness import thickness_plot
from gyrify.store.history import History

__all__ = ["KINDS", "Kind", "plot"]

Kind = Literal["folded", "gi", "stress", "thickness", "energy", "mode", "dispersion"]
KINDS: Final[tuple[Kind, ...]] = get_args(Kind)
_MAKERS: Final[dict[str, Callable[[Sequence[Shown], float | None], Figure]]] = {
    "folded": folded_plot,
    "gi": gi_plot,
    "stress": stress_plot,
    "thickness": thickness_plot,
    "energy": energy_plot,
    "mode": mode_plot,
    "dispersion": dispersion_plot,
}
# Pictures of what has no growth time, or all of them.
_TIMELESS: Final = {"mode": "the onset", "dispersion": "every growth time"}
# Curves of several runs share their axes, and more colours are not told apart.
_CURVES: Final = ("gi", "energy", "dispersion")
_MOST_RUNS: Final = 500
_NOTEBOOK_DPI: Final = 110
_NARROWEST, _WIDEST = 60.0, 300.0


def plot(
    run: Run,
    what: Kind = "folded",
    *,
    compare: Run | Sequence[Run] = (),
    at: float | None = None,
    stress: str | None = None,
    width_mm: float | None = None,
) -> Figure:
    """Draw a run, or the folded slices of a study.

    Parameters
    ----------
    run : History or path
        The run, or its folder; it need not have completed, and the picture says so. The folder of a study
        gives a grid of its folded slices.
    what : str
        ``folded``: tissues, contour and exposed outline. ``gi``: gyrification index, sulcal depth and gyri
        against growth time. ``stress``: von Mises, mean and circumferential stress [kPa]. ``thickness``: that
        of the cortex, as colour and along the contour [mm]. ``energy``: work of growth, stored, dissipated,
        in contact and lost in jumps [mJ/mm]. ``mode``: the mode along which stability was lost.
        ``dispersion``: exact growth at onset against mode number, with the onset of the run.
        Bodies in space are shown from three sides and cut across, their surface coloured.
    compare : History, path, or sequence of them, optional
        Further runs to show beside it, at the same scale and in the same colours: any number in a grid of
        slices, at most seven where curves share their axes (``gi``, ``energy``, ``dispersion``).
    at : float, optional
        Growth time [model units]; the nearest stored state is shown, and curves end there. The last state by
        default.
    stress : {"von_mises", "mean", "circumferential"}, optional
        The one stress to show instead of three.
    width_mm : float, optional
        Width of the page [mm], 60 to 300; 90 or 180, the columns of most journals, by default.

    Returns
    -------
    matplotlib.figure.Figure
        To be shown in a notebook or passed to `gyrify.report.save_figure`.

    Raises
    ------
    ConfigError
        If there is no such picture, growth time or stress; if a run has no onset, or no
        dispersion: strips and bodies in space have none.
    HistoryError
        If there is no run in a folder.

    Examples
    --------
    >>> figure = gyrify.plot("runs/reference-slice", "stress", at=300.0)  # doctest: +SKIP
    """
    others = [compare] if isinstance(compare, History | str | os.PathLike) else list(compare)
    at = None if at is None else real_number("at", at)
    width_mm = None if width_mm is None else real_number("width_mm", width_mm)
    _check(what, len(others), at, stress, width_mm)
    if not isinstance(run, History) and is_study(as_path("run", run)):
        return _seen(study_plot(as_path("run", run), what, len(others), at, width_mm))
    states = show([run, *others], at)
    if len({state.in_space for state in states}) > 1:
        raise ConfigError(
            "compare has bodies in the plane and in space: one picture shows the ones or the others.",
            "Compare runs of one kind.",
        )
    if what == "stress":
        return _seen(stress_plot(states, width_mm, stress))
    return _seen(_MAKERS[what](states, width_mm))


def _seen(figure: Figure) -> Figure:
    """A figure that a notebook shows, also where pyplot was never loaded."""
    figure._repr_png_ = partial(_png, figure)  # type: ignore[attr-defined]
    return figure


def _png(figure: Figure) -> bytes:
    stream = BytesIO()
    figure.savefig(stream, format="png", dpi=_NOTEBOOK_DPI)
    return stream.getvalue()


def _check(what: str, others: int, at: float | None, stress: str | None, width_mm: float | None) -> None:
    """Refuse what no picture can show, before a run is read."""
    if not isinstance(what, str) or what not in KINDS:
        raise ConfigError(
            f"what = {str(what)[:60]!r} is not a picture.", f"Choose one of: {', '.join(KINDS)}."
        )
    most = len(HUES) if what in _CURVES else _MOST_RUNS
    if others >= most:
        advice = "Compare fewer runs, or choose what = folded." if what in _CURVES else "Compare fewer runs."
        raise ConfigError(
            f"compare has {others} runs: a picture of {what} holds at most {most - 1} more.", advice
        )
    if at is not None and what in _TIMELESS:
        raise ConfigError(
            f"at = {at:g} has no meaning for {what}, which shows {_TIMELESS[what]}.", "Leave it out."
        )
    if stress is not None and what != "stress":
        raise ConfigError(
            f"stress = {stress[:60]!r} has no meaning for {what}.", "Use it with what = stress."
        )
    if width_mm is not None and not _NARROWEST <= width_mm <= _WIDEST:
        raise ConfigError(
            f"width_mm = {width_mm:g} is out of range: it must be {_NARROWEST:g} to {_WIDEST:g} mm.",
            "One column of most journals is 90 mm wide, two are 180 mm.",
        )
