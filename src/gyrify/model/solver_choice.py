"""Which linear solver serves a body: a direct one, or conjugate gradients where they take less."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

import numpy as np

from gyrify.config import Config
from gyrify.energy.unknowns import Unknowns
from gyrify.solve.linear import SolverName, linear_solver

# Memory of a factor in space at so many unknowns [MB], and the exponent by which it grows: that of theory for
# PARDISO, whose own figures for five bodies of up to 305 445 unknowns stay below; measured for SuperLU.
_MEMORY: Final = {"pardiso": (590.0, 81_159, 4.0 / 3.0), "superlu": (1250.0, 19_224, 1.56)}
# Part of the machine's memory that a factor may take: the rest is for all else, and for others.
_SHARE: Final = 0.5
# From so many unknowns on conjugate gradients take half the time or less ...
_MANY: Final = 15_000
# ... of tissue that is compressible enough: those were 13/32 and 0.458.
_COMPRESSIBLE: Final = 0.46
# Where the system does not tell its memory [MB].
_UNKNOWN: Final = 8000.0
_CGROUP: Final = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))


def chosen_solver(config: Config, unknowns: Unknowns | None, state_shape: tuple[int, int]) -> SolverName:
    """Name of the solver, ``auto`` resolved.

    Parameters
    ----------
    config : Config
        Every number of the run.
    unknowns : Unknowns or None
        What the degrees of freedom follow, where a symmetry is kept.
    state_shape : (int, int)
        Number of points and dimension.

    Returns
    -------
    {"pardiso", "superlu", "cg"}
    """
    asked = config.solver.linear_solver
    if asked != "auto":
        return asked
    direct: SolverName = "pardiso" if linear_solver("auto").name == "pardiso" else "superlu"
    if state_shape[1] != 3 or unknowns is not None:
        return direct
    room = _SHARE * machine_memory()
    if config.limits.memory > 0.0:
        room = min(room, config.limits.memory)
    n_unknowns = int(np.prod(state_shape))
    if is_well_conditioned(config) and n_unknowns >= _MANY:
        return "cg"
    return direct if factor_memory(direct, n_unknowns) <= room else "cg"


def is_well_conditioned(config: Config) -> bool:
    """Whether few iterations solve its systems: drag bounds the condition, and nothing asks for modes."""
    dissipation, material = config.dissipation, config.material
    return (
        dissipation.kind == "drag"
        and dissipation.number > 0.0
        and not config.stability.detect
        and config.mesh.element != "quadratic"
        and max(material.poisson_ratio, material.poisson_ratio_white) <= _COMPRESSIBLE
    )


def factor_memory(name: SolverName, n_unknowns: int) -> float:
    """About how much memory the factor of a body in space takes [MB]."""
    memory, size, exponent = _MEMORY[name]
    return float(memory * (n_unknowns / size) ** exponent)


def machine_memory() -> float:
    """Memory of this machine, or of the container that this is [MB]: not what is free, which changes."""
    try:
        whole = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 1e6
    except (AttributeError, ValueError, OSError):
        return _UNKNOWN
    for file in _CGROUP:
        try:
            whole = min(whole, int(file.read_text()) / 1e6)
        except (OSError, ValueError):  # there is none, or its limit is "max"
            continue
    return whole
