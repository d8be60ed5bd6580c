"""Whether a mesh can show the folds that exact theory expects, known before the run."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from gyrify.errors import GyrifyError, SolveError
from gyrify.run.validity.exact_bodies import annulus_of, bilayer_of
from gyrify.run.validity.expected import Expected, expected_onset
from gyrify.run.validity.locking import locking
from gyrify.run.validity.space_resolution import resolution_in_space

if TYPE_CHECKING:
    from gyrify.config import Config
    from gyrify.run.validity.columns import MeshColumns
    from gyrify.theory import BaseState

FloatArray = NDArray[np.float64]

# Delay of the onset on the mesh, over the exact growth time, from which it is told.
LATE: Final = 0.10
# The mesh's own onset is sought between the exact one and the end of growth in so many steps, then halved.
_STEPS, _HALVINGS = 6, 6
# Points of the contour on a wave that are tried as advice, by element.
_POINTS: Final = (8, 12, 16, 24)
_MOST_COLUMNS: Final = 4096
# Operations of one factorisation beyond which a mesh is too large to look at beforehand (about 0.1 s).
_MOST_WORK: Final = 3e7


@dataclass(frozen=True)
class MeshOnset:
    """Where the smooth slice loses stability on the mesh.

    Attributes
    ----------
    expected : Expected
        The exact onset; its growth time is known.
    is_late, is_early : bool
        Whether the mesh keeps stability to 1.1 times the exact growth time, or loses it by 0.9 times that.
    growth_time : float or None
        Where the mesh loses it, if it is late; None where not before the end of growth.
    points : float
        Points of the contour on a wave of the expected length; 0 at the surface limit.
    """

    expected: Expected
    is_late: bool
    is_early: bool
    growth_time: float | None
    points: float


def contour_points(config: Config) -> int:
    """Points on the outer contour."""
    mesh = config.mesh
    return int(mesh.n_around * 2 ** (mesh.refine + mesh.refine_cortex) * (1 + (mesh.element == "quadratic")))


def mesh_onset(config: Config) -> MeshOnset | None:
    """Onset on the mesh of a configuration against the exact one, from four columns of the mesh.

    Parameters
    ----------
    config : Config
        Every number of the run; an ellipse stands as the circle of the same area.

    Returns
    -------
    MeshOnset or None
        None where no theory covers the configuration, no onset is expected, or the smooth state of the mesh
        is not found.
    """
    document = config.model_dump_json(include={"geometry", "mesh", "material", "growth"})
    return _mesh_onset(document)


@lru_cache(maxsize=256)
def _mesh_onset(document: str) -> MeshOnset | None:
    from gyrify.config import Config

    config = Config.model_validate_json(document)
    expected = expected_onset(config)
    if not expected.is_known or expected.growth_time is None:
        return None
    points = contour_points(config) / expected.mode_number if expected.mode_number else 0.0
    mesh = _SmoothMesh(config)
    if mesh.columns.work > _MOST_WORK:
        return None
    with suppress(SolveError, np.linalg.LinAlgError):
        is_early = not mesh.is_stable((1.0 - LATE) * expected.growth_time)
        is_late = not is_early and mesh.is_stable((1.0 + LATE) * expected.growth_time)
        time = _later(mesh, (1.0 + LATE) * expected.growth_time) if is_late else None
        return MeshOnset(expected, is_late, is_early, time, points)
    return None


class _SmoothMesh:
    """The smooth state of the mesh at any growth time, from the exact one."""

    def __init__(self, config: Config) -> None:
        from gyrify.run.validity.columns import MeshColumns

        self.config, self.columns = config, MeshColumns(config)
        self._base: BaseState | None = None

    def is_stable(self, time: float) -> bool:
        outward, axial = self._guess(time)
        return self.columns.is_stable(time, outward, axial, expected_onset(self.config).mode_number)

    def _guess(self, time: float) -> tuple[FloatArray, float]:
        if self.config.geometry.shape == "strip":
            return _strip_displacement(self.config, self.columns, time), 1.0
        from gyrify.theory import base_state

        rest = self.columns.rest
        try:
            self._base = base_state(annulus_of(self.config), time, self._base)
        except GyrifyError as fault:
            raise SolveError(fault.message, fault.advice) from fault
        return self._base.radius(rest) - rest, self._base.axial_stretch


def _strip_displacement(config: Config, columns: MeshColumns, time: float) -> FloatArray:
    """Exact outward displacement of a strip: every layer stretches uniformly."""
    bilayer, growth = bilayer_of(config), config.growth
    if isinstance(bilayer, str):
        raise SolveError(bilayer, "Choose another shape.")
    strain = growth.rate * time
    load = np.exp(strain) if growth.stretch == "exponential" else 1.0 + strain
    film, below = (float(bilayer.state(layer, [load])[0][0, 0]) for layer in ("film", "substrate"))
    white = config.geometry.depth - config.geometry.cortical_thickness
    height = columns.rest
    return np.asarray(
        (below - 1.0) * np.minimum(height, white) + (film - 1.0) * np.maximum(height - white, 0.0)
    )


def _later(mesh: _SmoothMesh, start: float) -> float | None:
    """Growth time after a stable one at which the mesh loses stability; None if not before the end."""
    end = mesh.config.growth.duration
    if start >= end:
        return None
    low = start
    for time in np.linspace(start, end, _STEPS + 1)[1:]:
        if not mesh.is_stable(float(time)):
            high = float(time)
            for _ in range(_HALVINGS):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if mesh.is_stable(middle) else (low, middle)
            return high
        low = float(time)
    return None


def resolution(config: Config) -> list[str]:
    """Warn where the mesh delays the onset, hides it, or loses stability before the tissue does."""
    if config.geometry.n_dim == 3:
        return resolution_in_space(config)
    onset = mesh_onset(config)
    if onset is None:
        return []
    if onset.is_early:
        return [
            "This mesh loses stability before the tissue does: exact theory "
            f"({onset.expected.theory}) expects {_waves(onset.expected)} from growth time "
            f"{onset.expected.growth_time:.4g} on, and the mesh is unstable at 0.9 times that. What folds "
            f"first is the mesh. {_advice(config, onset)}"
        ]
    if not onset.is_late:
        return []
    expected, time = onset.expected, onset.growth_time
    assert expected.growth_time is not None
    if time is None:
        says = "hides the folds", "keeps the smooth slice stable to the end of growth"
    else:
        delay = time / expected.growth_time - 1.0
        says = "delays the folds", f"loses stability at growth time {time:.4g} ({delay:.0%} late)"
    counted = f", with {onset.points:.2g} points of the contour on a wave" if onset.points else ""
    return [
        f"This mesh {says[0]}: exact theory ({expected.theory}) expects {_waves(expected)} from growth time "
        f"{expected.growth_time:.4g} on, but this mesh {says[1]}{counted}. {_advice(config, onset)}"
    ]


def _waves(expected: Expected) -> str:
    if expected.mode_number is None or expected.wavelength_mm is None:
        return "waves much shorter than the cortex is thick"
    return f"{expected.mode_number} waves of {expected.wavelength_mm:.3g} mm"


def _advice(config: Config, onset: MeshOnset) -> str:
    """The cheapest mesh that was found to be on time."""
    if onset.expected.mode_number is None:
        return "No mesh resolves them: where folds begin then depends on the mesh. Do not trust their number."
    finer = finer_mesh(config)
    if finer is None:
        return "No mesh that was tried is on time: compare several with `gyrify converge`."
    words = [
        f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}" for key, value in finer.items()
    ]
    return f"Set {_listed(words)}: that mesh is at most 10 % late."


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def finer_mesh(config: Config) -> dict[str, Any] | None:
    """Values of the cheapest mesh that loses stability within 10 % of the exact growth time.

    Parameters
    ----------
    config : Config
        Where to start: meshes with at least as many points on the contour are tried.

    Returns
    -------
    dict or None
        Values by dotted key, where they differ from the configuration's.
    """
    from gyrify.model.meshing import build_mesh

    found = [overrides for element in _elements(config) if (overrides := _finer(config, element))]
    for overrides in sorted(found, key=lambda values: _cost(config, values)):
        with suppress(GyrifyError):
            build_mesh(config.replace(**overrides))
            return overrides
    return None


def _elements(config: Config) -> list[str]:
    """The element, or a better one."""
    if config.mesh.element == "quadratic":
        return ["quadratic"]
    locks = config.mesh.element == "linear" and bool(locking(config))
    return ["mean_dilatation" if locks else config.mesh.element, "quadratic"]


def _finer(config: Config, element: str) -> dict[str, Any] | None:
    """The fewest layers, and then columns, with which an element is on time."""
    mesh, number = config.mesh, expected_onset(config).mode_number
    if number is None:
        return None
    per_column = 2 ** (mesh.refine + mesh.refine_cortex) * (2 if element == "quadratic" else 1)
    wanted = [2 * int(np.ceil(0.5 * points * number / per_column)) for points in _POINTS]
    columns = sorted({max(mesh.n_around, n) for n in wanted if n <= _MOST_COLUMNS})
    for layers in (1, 2, 4) if columns else ():
        tried = [_mesh_values(config, element, n_around, layers) for n_around in columns]
        if not _is_on_time(config, tried[-1]):
            continue
        first = next(values for values in tried if values is tried[-1] or _is_on_time(config, values))
        return first or None
    return None


def _mesh_values(config: Config, element: str, n_around: int, layers: int) -> dict[str, Any]:
    mesh = config.mesh
    values = {
        "element": element,
        "n_around": n_around,
        "n_layers": layers * mesh.n_layers,
        "n_cortex_layers": layers * mesh.n_cortex_layers,
    }
    if element == "quadratic":  # or their cells would invert where folds close
        values["inversion_resistance"] = max(mesh.inversion_resistance, 0.1)
    return {f"mesh.{key}": value for key, value in values.items() if value != getattr(mesh, key)}


def _is_on_time(config: Config, overrides: dict[str, Any]) -> bool:
    with suppress(GyrifyError, np.linalg.LinAlgError):
        tried = config.replace(**overrides)
        mesh, time = _SmoothMesh(tried), expected_onset(tried).growth_time
        if time is not None and mesh.columns.work <= _MOST_WORK:
            return mesh.is_stable((1.0 - LATE) * time) and not mesh.is_stable((1.0 + LATE) * time)
    return False


def _cost(config: Config, overrides: dict[str, Any]) -> int:
    """Points of a mesh."""
    mesh = config.mesh
    columns = overrides.get("mesh.n_around", mesh.n_around)
    layers = overrides.get("mesh.n_layers", mesh.n_layers)
    return int(columns * layers * (4 if overrides.get("mesh.element", mesh.element) == "quadratic" else 1))
