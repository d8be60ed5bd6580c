"""What a run has come to, and a reader of its numbers should not overlook."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from gyrify.config.body_sections import FROM_FILES
from gyrify.run.validity.collapse import collapse
from gyrify.run.validity.folding import sawtooth, smooth_against_theory

if TYPE_CHECKING:
    from gyrify.store.history import History

# Points of the contour that a fold needs to be resolved.
POINTS_PER_FOLD: Final = 8.0
# Depth below which a sulcus is not worth the name, over the prominence from which a bump is a gyrus.
NEGLIGIBLE: Final = 0.1


def run_warnings(history: History, summary: dict[str, Any]) -> list[str]:
    """Sentences on what a reader of a run's numbers should not overlook.

    Parameters
    ----------
    history : History
        The run, complete or not.
    summary : dict
        Its summary, but for the warnings.

    Returns
    -------
    list of str
        Empty where nothing is to be said.
    """
    return [sentence for check in CHECKS for sentence in check(history, summary)]


def fold_resolution(history: History, summary: dict[str, Any]) -> list[str]:
    """Warn of folds that few points of the contour make up."""
    nodes = summary["nodes_per_wavelength"]
    if nodes is None or nodes >= POINTS_PER_FOLD:
        return []
    where, advice = "contour", "raise mesh.n_around"
    if history.mesh.n_dim == 3:
        is_read = history.config.geometry.shape in FROM_FILES
        where, advice = "surface", "raise mesh.refine" if is_read else "lower mesh.edge_length"
    return [f"A fold spans only {nodes:.1f} points of the {where} (8 are needed to resolve it): {advice}."]


def crossing(history: History, summary: dict[str, Any]) -> list[str]:
    """Warn of a contour that crosses itself."""
    if not summary["self_intersecting"]:
        return []
    what = "contour" if history.mesh.n_dim == 2 else "surface"
    return [f"The {what} crosses itself: the state is not physical. Set contact.enabled = true."]


def stability(_: History, summary: dict[str, Any]) -> list[str]:
    """Warn of a last state that is no stable one."""
    note = summary["stability_note"]
    is_told = any(words in note for words in ("unstable equilibrium", "not known", "held by dissipation"))
    return [note] if is_told else []


def symmetry(history: History, summary: dict[str, Any]) -> list[str]:
    """Warn of folds that are stable only as long as they are mirror-symmetric."""
    if history.config.mesh.split != "symmetric" or summary["stable"] is not False:
        return []
    return [
        "The folds are held mirror-symmetric, and the last state is unstable without dissipation: folds that "
        'break the symmetry may come first. To see them, run again with mesh.split = "alternating".'
    ]


def dents(history: History, summary: dict[str, Any]) -> list[str]:
    """Warn of gyri whose sulci the disc of the closing enters."""
    deepest, prominence = summary["sulcal_depth_mm"]["max"], history.config.metrics.gyrus_prominence
    if summary["n_gyri"] == 0 or deepest >= NEGLIGIBLE * prominence:
        return []
    hull = summary["gi"]["hull"] if history.mesh.n_dim == 2 else summary["gi"]["area"]["hull"]
    return [
        f"{summary['n_gyri']} gyri are counted, but the deepest sulcus measures {deepest:.2g} mm: the dents "
        f"between them are so wide that the disc of {summary['gi']['closing_radius_mm']:g} mm enters them. "
        f"Go by GI hull ({hull:.4f}), or measure with a larger metrics.closing_radius."
    ]


CHECKS: Final[tuple[Callable[[History, dict[str, Any]], list[str]], ...]] = (
    fold_resolution,
    crossing,
    stability,
    symmetry,
    dents,
    smooth_against_theory,
    sawtooth,
    collapse,
)
