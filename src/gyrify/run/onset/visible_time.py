"""Where folds are seen in a run: drag delays that beyond the loss of stability."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from gyrify.mesh import Mesh
from gyrify.mesh.mesh import FloatArray
from gyrify.metrics.gyrification import index_of
from gyrify.run.body_measures import measured, surface_of

if TYPE_CHECKING:
    from gyrify.config.run_sections import Metrics
    from gyrify.store.history import History

# Gyrification index (closing) above which a slice counts as visibly folded.
VISIBLE: Final = 1.005


def visible_time(history: History, level: float = VISIBLE) -> float | None:
    """Growth time at which the index by the closing first passes a level, interpolated between increments.

    Parameters
    ----------
    history : History
        The run, complete or not.
    level : float
        Gyrification index [-], > 1.

    Returns
    -------
    float or None
        None where it never does.
    """
    times, last = history.growth_times, 1.0
    for index in range(len(history)):
        now = visible_index(history.mesh, history.points(index), history.config.metrics, level)
        if now > level:
            start, end = (float(times[max(index - 1, 0)]), float(times[index]))
            if last > level:
                return end
            last = visible_index(history.mesh, history.points(index - 1), history.config.metrics, 1.0)
            return start + (level - last) / (now - last) * (end - start)
        last = now
    return None


def visible_index(mesh: Mesh, points: FloatArray, metrics: Metrics, level: float = VISIBLE) -> float:
    """Index by the closing, of areas in space; 1 where that by the hull is at most a level.

    Parameters
    ----------
    mesh : Mesh
        The reference mesh.
    points : (n_points, n_dim) float array
        Deformed coordinates [mm].
    metrics : Metrics
        Section of the configuration.
    level : float
        Gyrification index of interest [-].

    Returns
    -------
    float
    """
    if mesh.n_dim == 3:
        surface = surface_of(mesh, points, metrics)
        if surface.area <= level * surface.hull_area:
            return 1.0
        return surface.area / surface.closing.area
    contour = points[mesh.contour]
    if mesh.period is None:
        if index_of(contour, "hull", metrics.closing_radius) <= level:
            return 1.0
        return index_of(contour, "closing", metrics.closing_radius)
    return measured(mesh, points, metrics).gi_closing
