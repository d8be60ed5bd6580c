"""Whether the mesh of a run is known to be converged for its numbers, and what to run to find out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from gyrify.config import Config

# Largest relative error that counts as converged, as in `gyrify converge`.
TOLERANCE: Final = 0.02
_MAX_REFINE: Final = 4
_SECTIONS: Final = ("geometry", "material", "growth", "contact")


@dataclass(frozen=True)
class Limit:
    """What a study of convergence found for the standard slice; docs/convergence.md has the measurement.

    Attributes
    ----------
    dissipation : mapping
        Dissipation that it holds for, by key.
    follow_branch : bool
        Whether the branch is followed.
    gi_closing, uncertainty : float
        Limit of the gyrification index by the closing of 10 mm, and its error [-].
    """

    dissipation: Mapping[str, Any]
    follow_branch: bool
    gi_closing: float
    uncertainty: float


LIMITS: Final = (
    Limit({"kind": "drag", "number": 1.3, "course": "constant"}, False, 1.74, 0.03),
    Limit({"kind": "none"}, True, 1.60, 0.02),
)


def limit_of(config: Config) -> Limit | None:
    """The measured limit of the physics of a configuration, whatever its mesh; None where there is none."""
    from gyrify.config import Config

    standard = Config()
    if any(getattr(config, name) != getattr(standard, name) for name in _SECTIONS):
        return None
    if config.metrics.closing_radius != standard.metrics.closing_radius:
        return None
    for limit in LIMITS:
        given = {key: getattr(config.dissipation, key) for key in limit.dissipation}
        if given == limit.dissipation and config.stability.follow_branch == limit.follow_branch:
            return limit
    return None


def convergence(config: Config, gi_closing: float, *, is_complete: bool) -> dict[str, Any]:
    """What is known of the convergence of a run's mesh, as in ``summary.json``.

    Parameters
    ----------
    config : Config
        The run.
    gi_closing : float
        Its gyrification index by the closing.
    is_complete : bool
        Whether growth came to its end: limits are known there only.

    Returns
    -------
    dict
        ``known`` (bool), ``converged`` (bool or null), ``error`` (relative error of the index, or null),
        ``limit`` (the index on ever finer meshes, or null), ``sentence`` and ``command``.
    """
    limit = limit_of(config) if is_complete else None
    found: dict[str, Any] = {"command": command(config)}
    if limit is None:
        sentence = "Whether this mesh is converged is not known: it was not checked."
        return {
            "known": False,
            "converged": None,
            "error": None,
            "limit": None,
            "sentence": sentence,
            **found,
        }
    error = abs(limit.gi_closing - gi_closing) / gi_closing
    is_converged = error <= TOLERANCE + limit.uncertainty / gi_closing
    shown = f"{limit.gi_closing:.2f} ± {limit.uncertainty:.2f}"
    if is_converged:
        sentence = f"This mesh is converged for the gyrification index: it tends to {shown} on finer ones."
    else:
        side = "above" if limit.gi_closing > gi_closing else "below"
        sentence = (
            f"This mesh is not converged: the gyrification index tends to {shown} on finer ones, {error:.0%} "
            f"{side} that of this run."
        )
    return {
        "known": True,
        "converged": is_converged,
        "error": error,
        "limit": limit.gi_closing,
        "sentence": sentence,
        **found,
    }


def command(config: Config) -> str:
    """Command that checks the mesh, in the folder of the run.

    Its finest level is at least twice as fine as the run's mesh, as far as `mesh.refine` allows. In space,
    where each level has eight times the cells of the one before, there are two levels.
    """
    n_levels = 3 if config.geometry.n_dim == 2 else 2
    first = min(config.mesh.refine, _MAX_REFINE - n_levels + 1)
    start = "" if first == config.mesh.refine else f" --set mesh.refine={first}"
    return f"gyrify converge config.toml --of mesh{'' if n_levels == 3 else ' --levels 2'}{start}"


def mark(converged: Mapping[str, Any], n_warnings: int = 0) -> str:
    """A few words beside a number: whether its mesh is converged, and whether there are warnings."""
    words = {True: "mesh converged", False: "mesh not converged", None: "mesh not checked"}
    found = words[converged["converged"]]
    if n_warnings == 0:
        return found
    return f"{found}; {n_warnings} {'warning' if n_warnings == 1 else 'warnings'}, see summary.json"
