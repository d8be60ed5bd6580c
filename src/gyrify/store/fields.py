r"""Fields of a state: strains, stresses and contour quantities as plain arrays.

Everything follows from the stored displacement and the configuration. With the total deformation gradient F
(in the plane; F33 = 1), the growth tensor F_g and F_e = F F_g^{-1}, all with their 33 entries:

.. math::
   J = \det F, \quad J_e = \det F_e, \quad J_g = \det F_g, \quad J = J_e J_g, \\
   \sigma = J_e^{-1} P_e F_e^T = 2 W_1 J_e^{-1} F_e F_e^T + W_J I .

The Cauchy stress is that of the elastic energy; viscous stress of Kelvin-Voigt dissipation is not part of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.sparse import csr_array

from gyrify.base.arguments import as_words
from gyrify.base.force_units import force_unit
from gyrify.config.faults import nearest
from gyrify.config.run_sections import ALL_FIELDS, OutputField
from gyrify.errors import ConfigError
from gyrify.model.slice import Slice
from gyrify.solve.types import FloatArray
from gyrify.store.history import History
from gyrify.store.space_fields import SpaceFields
from gyrify.store.state_fields import StateFields
from gyrify.store.state_numbers import state_number

# Point fields that live on the contour alone.
CONTOUR_FIELDS: Final[frozenset[OutputField]] = frozenset({"thickness", "curvature", "contact_force"})
# Fields that do not change with growth.
STATIC_FIELDS: Final[frozenset[OutputField]] = frozenset({"region"})

UNITS: Final[dict[OutputField, str]] = {
    "displacement": "mm",
    "region": "0 white, 1 grey",
    "growth_stretch": "-",
    "J": "-",
    "J_elastic": "-",
    "J_growth": "-",
    "cauchy_stress": "Pa",
    "von_mises": "Pa",
    "mean_stress": "Pa",
    "circumferential_stress": "Pa",
    "thickness": "mm",
    "curvature": "1/mm",
    "contact_force": "Pa mm",
}


def field_unit(name: OutputField, n_dim: int) -> str:
    """Unit of a field of a body in the plane (2), where forces are per thickness, or in space (3)."""
    return force_unit(n_dim) if name == "contact_force" else UNITS[name]


def fields(
    history: History, index: int = -1, names: Sequence[OutputField] = ALL_FIELDS
) -> dict[OutputField, FloatArray]:
    """Fields of one state of a run.

    Parameters
    ----------
    history : History
        The run.
    index : int
        State; negative indices count from the end.
    names : str or sequence of str
        Fields wanted, of those that ``output.fields`` may name.

    Returns
    -------
    dict
        Array by name: ``displacement`` (n_points, n_dim) [mm]; ``region`` (n_cells,) 0 white, 1 grey;
        ``growth_stretch``, ``J``, ``J_elastic``, ``J_growth`` (n_cells,) [-]; ``cauchy_stress``
        (n_cells, 3, 3) [Pa]; ``von_mises``, ``mean_stress``, ``circumferential_stress`` (n_cells,) [Pa];
        ``thickness`` [mm] and ``curvature`` [1/mm] (n_points,), NaN off the contour; ``contact_force``
        (n_points, n_dim) [Pa mm] per unit thickness of the slice, in space [Pa mm^2], zero off the contour.
        In space the contour is the outer surface, ``curvature`` its mean curvature, and
        ``circumferential_stress`` the mean normal stress along the layers.

    Raises
    ------
    HistoryError
        If there is no such state.
    ConfigError
        If there is no such field.
    """
    number = state_number(index, len(history))
    wanted = known_fields(names)
    u = history.state_vector(number)
    u_start = history.state_vector(max(number - 1, 0))
    state = FieldMaker(history.slice).state(u, float(history.fractions[number]), u_start)
    return {name: state[name] for name in wanted}


def known_fields(names: str | Sequence[str]) -> list[OutputField]:
    """Return the names of fields, or raise ConfigError."""
    known: dict[str, OutputField] = {name: name for name in ALL_FIELDS}
    wanted = as_words("names", names)
    for name in wanted:
        if name not in known:
            close = nearest(name, known)
            hint = f"Did you mean {close}?" if close else f"Choose among {', '.join(known)}."
            raise ConfigError(f"There is no field {name[:60]!r}.", hint)
    return [known[name] for name in wanted]


class FieldMaker:
    """Fields of any state of one problem.

    Parameters
    ----------
    problem : Slice
        The tissue.
    """

    def __init__(self, problem: Slice) -> None:
        self.problem = problem
        if problem.mesh.n_dim == 3:
            return
        simplices = problem.simplices
        n, n_nodes = simplices.cells.shape
        rows = np.repeat(np.arange(n), n_nodes)
        entries = np.concatenate([simplices.gradients[:, :, axis].ravel() for axis in range(2)])
        places = (np.concatenate([rows, rows + n]), np.tile(simplices.cells.ravel(), 2))
        self._gradient = csr_array((entries, places), shape=(2 * n, problem.mesh.n_points))
        self.along = np.stack([-1.0 * problem.mesh.across[:, 1], problem.mesh.across[:, 0]])[
            :, simplices.cell
        ]

    def state(self, u: FloatArray, fraction: float, u_start: FloatArray) -> StateFields:
        """Fields of a state.

        Parameters
        ----------
        u : (n_points, 2) float array
            Displacement [mm].
        fraction : float
            Growth time over the duration of growth.
        u_start : (n_points, 2) float array
            Displacement at the start of the increment [mm], on which the activation distance of contact
            depends.
        """
        kind = SpaceFields if self.problem.mesh.n_dim == 3 else StateFields
        return kind(self, u, fraction, u_start)

    def deformation(self, u: FloatArray) -> FloatArray:
        """(2, 2, n) total deformation gradient F_ij = d x_i / d X_j in the plane."""
        columns = np.ascontiguousarray(u[: self.problem.mesh.n_points].T)
        F = np.stack([(self._gradient @ column).reshape(2, -1) for column in columns])
        F[0, 0] += 1.0
        F[1, 1] += 1.0
        return F
