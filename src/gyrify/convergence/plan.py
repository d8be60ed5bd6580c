"""Which runs a study of convergence needs: one family of configurations for each subject."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, get_args

import numpy as np

from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.run.validity.ranges import contour_spacing

Subject = Literal["mesh", "increments", "contact"]
SUBJECTS: Final[tuple[Subject, ...]] = get_args(Subject)
MAX_LEVELS: Final = 6
_MAX_REFINE: Final = 4


def plan(config: Config, subjects: Sequence[str], levels: int) -> dict[Subject, tuple[Config, ...]]:
    """Configurations of every family, coarse to fine; the first of each is the given one.

    Parameters
    ----------
    config : Config
        Where to start.
    subjects : sequence of {"mesh", "increments", "contact"}
        What is refined by halving: cells (by ``mesh.refine``), increments, or the contact distance.
    levels : int
        Runs of a family, at least two.

    Returns
    -------
    dict
        Configurations by subject.

    Raises
    ------
    ConfigError
        If a subject is unknown or has no meaning here, or a configuration would be out of bounds.
    """
    if not 2 <= levels <= MAX_LEVELS:
        raise ConfigError(f"levels = {levels} is out of range (2 to {MAX_LEVELS}).", "Try 3.")
    if not subjects:
        raise ConfigError("No subject to refine is given.", f"Choose among {', '.join(SUBJECTS)}.")
    known = [_known(subject) for subject in subjects]
    for subject in known:
        _require_meaning(config, subject, levels)
    return {subject: _family(config, subject, levels) for subject in dict.fromkeys(known)}


def _family(config: Config, subject: Subject, levels: int) -> tuple[Config, ...]:
    """Configurations of all levels; where a finer one is out of bounds, the advice is fewer."""
    found: list[Config] = []
    for level in range(levels):
        try:
            found.append(_refined(config, subject, 2**level))
        except ConfigError as fault:
            advice = f"Ask for --levels {level}." if level >= 2 else "Start from a coarser mesh."
            raise ConfigError(
                f"Level {level + 1} of {levels} is not allowed: {fault.message}", advice
            ) from None
    return tuple(found)


def resolution(config: Config, subject: Subject) -> float:
    """What is halved from level to level.

    Returns
    -------
    float
        Mean distance of contour nodes, or edge on the outer surface, in the reference state [mm], increment
        over the duration, or distance at which contact sets in [mm].
    """
    if subject == "increments":
        return 1.0 / config.solver.increments
    if subject == "contact":
        return config.contact.activation_fraction * config.geometry.cortical_thickness
    if config.geometry.n_dim == 3:
        return contour_spacing(config)
    return _contour_length(config) / contour_nodes(config)


def contour_nodes(config: Config) -> int:
    """Nodes on the outer contour: a quadratic cell has one between its corners."""
    mesh = config.mesh
    per_cell = 2 if mesh.element == "quadratic" else 1
    return int(mesh.n_around * 2 ** (mesh.refine + mesh.refine_cortex) * per_cell)


def _contour_length(config: Config) -> float:
    if config.geometry.shape == "strip":
        return config.geometry.length
    a, b = config.geometry.outer_axes
    angle = 2.0 * np.pi * np.arange(720) / 720
    return float(2.0 * np.pi * np.hypot(a * np.sin(angle), b * np.cos(angle)).mean())


def _known(subject: str) -> Subject:
    for known in SUBJECTS:
        if subject == known:
            return known
    raise ConfigError(f"{subject[:60]!r} cannot be refined.", f"Choose among {', '.join(SUBJECTS)}.")


def _require_meaning(config: Config, subject: Subject, levels: int) -> None:
    if subject == "contact" and not config.contact.enabled:
        raise ConfigError("There is no contact to refine: contact.enabled is false.", "Leave contact out.")
    if subject == "mesh" and config.mesh.refine + levels - 1 > _MAX_REFINE:
        raise ConfigError(
            f"{levels} levels from mesh.refine = {config.mesh.refine} are not allowed: the finest would have "
            f"mesh.refine = {config.mesh.refine + levels - 1}, above {_MAX_REFINE}.",
            "Start from a coarser mesh, or ask for fewer levels.",
        )


def _refined(config: Config, subject: Subject, factor: int) -> Config:
    """The configuration, finer by a power of two."""
    if factor == 1:
        return config
    if subject == "increments":
        return config.replace(**{"solver.increments": config.solver.increments * factor})
    if subject == "contact":
        return config.replace(**{"contact.activation_fraction": config.contact.activation_fraction / factor})
    return config.replace(**{"mesh.refine": config.mesh.refine + factor.bit_length() - 1})
