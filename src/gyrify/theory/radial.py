"""Bodies that move along their radius alone: parameters, discretised energy, and its minimum under growth."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields
from typing import Any, Final, Protocol

import numpy as np
from numpy.typing import NDArray

from gyrify.errors import ConfigError, SolveError
from gyrify.theory.moduli import Response
from gyrify.theory.spectral import Line

FloatArray = NDArray[np.float64]

# White elements shrink towards the cortex, where folds live, and towards a clamp, where r' is steep.
_WHITE_EDGES: Final = (1.0, 0.95, 0.8, 0.5, 0.25, 0.125, 0.0)
_CORTEX_ELEMENTS: Final = 2
# Largest growth strain of the cortex between two solves.
_LARGEST_STEP = 0.15
_MAX_NEWTON = 50


def require_parameters(
    body: Any,
    choices: Mapping[str, Collection[str]],
    *,
    may_vanish: Collection[str] = (),
    may_be_infinite: Collection[str] = (),
) -> None:
    """Check the fields of a body: words by their lists, numbers by their signs, radii by their order.

    Parameters
    ----------
    body : dataclass
        Its fields are checked; Poisson's ratios are not, nor what is None.
    choices : mapping
        Allowed words by field.
    may_vanish, may_be_infinite : collection of str
        Fields that may be 0, or infinite.

    Raises
    ------
    ConfigError
        If a value is out of bounds.
    """
    for field in fields(body):
        name, value = field.name, getattr(body, field.name)
        if name in choices:
            if value not in choices[name]:
                raise ConfigError(f"{name} is {value!r}.", f"Choose one of {choices[name]}.")
        elif name in may_vanish:
            if not 0.0 <= value < np.inf:
                raise ConfigError(f"{name} is {value}.", "It must be 0 or more.")
        elif value is None or "poisson" in name or (value == np.inf and name in may_be_infinite):
            continue
        elif not 0.0 < value < np.inf:
            raise ConfigError(f"{name} is {value}.", "It must be positive.")
    if not body.inner_radius < body.interface_radius:
        raise ConfigError("The cortex fills the whole wall.", "Use a thinner cortex or a smaller hole.")


def wall(inner_radius: float, interface_radius: float, outer_radius: float, degree: int) -> Line:
    """Elements across a wall, with an edge on the interface; radii in mm."""
    white = interface_radius - (interface_radius - inner_radius) * np.array(_WHITE_EDGES)
    grey = np.linspace(interface_radius, outer_radius, _CORTEX_ELEMENTS + 1)
    return Line.build(np.concatenate([white, grey[1:]]), degree)


class RadialBody(Protocol):
    """What is asked of a body."""

    @property
    def growth_rate(self) -> float:
        """G of the cortex [1/time]."""
        ...

    def response(self, radius: FloatArray, stretch: FloatArray, growth_time: float) -> Response:
        """Energy, stress and tangent at radii (n,) [mm] and principal stretches (n, 3) [-]."""
        ...


@dataclass(frozen=True, eq=False)
class RadialProblem:
    """The discrete energy, whose stretches less one are linear in the unknowns.

    Attributes
    ----------
    body : RadialBody
        Tissue and growth.
    line : Line
        The elements across the wall.
    area : (n_points,) float array
        Weight of each point: of R dR in the plane, of R^2 dR in space.
    strain : (n_points, 3, n_free) float array
        Stretches at the points per free unknown.
    free : (n_unknowns,) bool array
        Which unknowns are not held at zero.
    force : float
        What nodal forces are compared with: E_G times the outer radius in the plane [Pa mm], times its square
        in space [Pa mm^2].
    """

    body: RadialBody
    line: Line
    area: FloatArray
    strain: FloatArray
    free: NDArray[np.bool_]
    force: float

    def solve(self, growth_time: float, start: FloatArray | None = None) -> tuple[FloatArray, float]:
        """Equilibrium at a growth time, from a nearby one if given; else in steps of growth.

        Parameters
        ----------
        growth_time : float
            t [time], not negative.
        start : (n_unknowns,) float array, optional
            Unknowns of a nearby state.

        Returns
        -------
        unknowns : (n_unknowns,) float array
            Of the state, in balance to round-off.
        residual : float
            Largest out-of-balance nodal force over `force` [-].

        Raises
        ------
        ConfigError
            If the growth time is negative or not finite.
        SolveError
            If no equilibrium is found.
        """
        if not 0.0 <= growth_time < np.inf:
            raise ConfigError(f"The growth time is {growth_time}.", "It must be finite and not negative.")
        if start is not None:
            try:
                return self._newton(start, growth_time)
            except (FloatingPointError, np.linalg.LinAlgError):
                pass  # too far away: step from the start instead
        return self._stepped(growth_time)

    def _newton(self, unknowns: FloatArray, growth_time: float) -> tuple[FloatArray, float]:
        """Newton's method; raises FloatingPointError where it does not converge."""
        smallest = np.inf
        for _ in range(_MAX_NEWTON):
            stretch = 1.0 + self.strain @ unknowns[self.free]
            if np.any(stretch <= 0.0):
                raise FloatingPointError
            response = self.body.response(self.line.points, stretch, growth_time)
            force = np.einsum("q,qi,qia->a", self.area, response.stress, self.strain)
            size = float(np.max(np.abs(force)) / self.force)
            # Stop where round-off takes over, not at a guessed tolerance.
            if size < 1e-8 and size >= 0.5 * smallest:
                return unknowns, size
            smallest = min(size, smallest)
            weighted = (self.area[:, None, None] * response.moduli) @ self.strain
            tangent = np.tensordot(self.strain, weighted, axes=([0, 1], [0, 1]))
            unknowns = unknowns.copy()
            unknowns[self.free] -= np.linalg.solve(tangent, force)
        raise FloatingPointError

    def _stepped(self, time: float) -> tuple[FloatArray, float]:
        """Follow the state from no growth, halving the step where Newton's method fails."""
        unknowns, residual, done = np.zeros(len(self.free)), 0.0, 0.0
        step = min(1.0, _LARGEST_STEP / max(self.body.growth_rate * time, 1e-12))
        while done < 1.0:
            target = min(1.0, done + step)
            try:
                unknowns, residual = self._newton(unknowns, target * time)
                done = target
            except (FloatingPointError, np.linalg.LinAlgError):
                step *= 0.5
                if step < 1e-6:
                    raise SolveError(
                        f"The radial state is lost at growth time {done * time:.6g}.",
                        "Try less growth, or a larger hole.",
                    ) from None
        return unknowns, residual
