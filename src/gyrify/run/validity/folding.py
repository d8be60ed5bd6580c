"""Whether the folds of a run, or their absence, agree with exact theory and are the tissue's own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from gyrify.run.validity.expected import expected_onset

if TYPE_CHECKING:
    from gyrify.store.history import History

# Gyrification index above which a contour is not smooth, whether it has gyri or not.
VISIBLE: Final = 1.005
# Part of the growth after the onset below which drag alone may keep a slice smooth.
_LITTLE: Final = 0.25


def smooth_against_theory(history: History, summary: dict[str, Any]) -> list[str]:
    """Warn of a slice that ended smooth although unstable, and of one that should have stayed smooth."""
    expected = expected_onset(history.config)
    if summary["status"] != "completed" or not expected.is_known:
        return []
    time, n_gyri = expected.growth_time, summary["n_gyri"]
    if time is None and n_gyri > 0:
        return [
            f"The body has {n_gyri} gyri, but by exact theory ({expected.theory}) its smooth state is "
            "stable to the end of growth. Run it on a finer mesh (mesh.refine = 1): folds of the tissue "
            "stay, those of the mesh do not."
        ]
    index = summary["gi"]["closing"] if history.mesh.n_dim == 2 else summary["gi"]["area"]["hull"]
    if time is None or n_gyri > 0 or index > VISIBLE:
        return []
    return [
        f"The body is smooth at the end of growth, but by exact theory ({expected.theory}) the smooth state "
        f"is unstable from growth time {time:.4g} on: smooth is not the answer of the tissue. "
        f"{_cause(history, time)}"
    ]


def _cause(history: History, time: float) -> str:
    """What may have kept a slice smooth, and what to do."""
    config, is_held = history.config, not history.slice.is_conservative
    left = 1.0 - time / config.growth.duration
    if config.mesh.node_jitter == 0.0 and not config.stability.follow_branch:
        branch = "" if is_held else ", or stability.follow_branch = true"
        return f"Nothing disturbs it: set mesh.node_jitter = 0.001{branch}."
    if is_held and left < _LITTLE:
        return (
            f"Dissipation holds folds back, and only {left:.0%} of the growth is left after that: lower "
            "dissipation.number, or raise growth.duration."
        )
    then = " and, if it stays smooth, lower dissipation.number" if is_held else ""
    return f"Refine the mesh (mesh.refine = 1, or what a warning on the mesh says){then}."


def sawtooth(history: History, summary: dict[str, Any]) -> list[str]:
    """Warn of a contour that goes up and down from point to point."""
    from gyrify.metrics import find_folds
    from gyrify.metrics.periodic import strip_sawteeth

    metrics, mesh = history.config.metrics, history.mesh
    if mesh.n_dim == 3:
        return []
    contour = history.contour(len(history) - 1)
    if mesh.period is None:
        n_sawteeth = find_folds(contour, metrics.gyrus_prominence, metrics.samples).n_sawteeth
    else:
        n_sawteeth = strip_sawteeth(contour, mesh.period, metrics.gyrus_prominence, metrics.samples)
    if n_sawteeth == 0:
        return []
    return [
        f"The contour is a sawtooth at the scale of the mesh: {n_sawteeth} crowns are about two points of "
        f"the contour wide. They are not folds, and not counted as gyri (n_gyri = {summary['n_gyri']}). "
        'Set mesh.refine = 1, or mesh.element = "mean_dilatation" where material.poisson_ratio is near 0.5.'
    ]
