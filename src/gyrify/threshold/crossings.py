"""What a threshold is: every crossing of a scanned parameter, and the one that counts."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, Literal

from gyrify.base.markup import html_rows

Definition = Literal["stability", "visible"]
Counted = Literal["waves", "degree", "gyri"]
Becomes = Literal["unstable", "stable", "folded", "smooth"]


@dataclass(frozen=True)
class Crossing:
    """One value of the parameter at which the outcome changes.

    Attributes
    ----------
    value : float
        Critical value, in the unit of the parameter.
    becomes : {"unstable", "stable", "folded", "smooth"}
        What the slice becomes as the parameter rises.
    bracket : (float, float)
        The closest values known to lie on either side.
    mode_number : int or None
        Waves of the mode along the contour, in space its degree (see
        `gyrify.run.onset.space_waves.surface_wave`); for visible folds, the number of gyri.
    wavelength_mm : float or None
        Deformed contour over the mode number, in space the length of the wave [mm].
    growth_time : float
        Growth time [time].
    kind : str or None
        What the mode moves (definition `stability`); see `gyrify.run.onset.mode_kinds.Wave`.
    """

    value: float
    becomes: Becomes
    bracket: tuple[float, float]
    mode_number: int | None
    wavelength_mm: float | None
    growth_time: float
    kind: str | None = None


@dataclass(frozen=True)
class Scanned:
    """One point of the scan.

    Attributes
    ----------
    value : float
        Value of the parameter.
    n_negative : int or None
        Negative pivots of the stiffness (definition `stability`).
    gi : float or None
        Gyrification index by the closing (definition `visible`).
    """

    value: float
    n_negative: int | None = None
    gi: float | None = None


@dataclass(frozen=True, repr=False)
class Threshold:
    """Critical value of one parameter.

    Attributes
    ----------
    parameter : str
        Key of the parameter.
    definition : {"stability", "visible"}
        What critical means.
    critical_value : float or None
        The first crossing at which the slice becomes unstable (or folded) as the parameter rises, or else
        the first of the others; None where nothing is critical, or nothing is known.
    reason : str
        Why there is none; else empty.
    notes : tuple of str
        What limits the answer.
    warnings : tuple of str
        What a reader should not overlook: values that could not be solved, and where exact theory disagrees.
    unsolved : tuple of float
        Values of the scan of which nothing is known.
    bracket : (float, float) or None
        The closest values known to lie on either side of the critical one.
    mode_number, wavelength_mm, growth_time
        Of the critical crossing, as in `Crossing`.
    crossings : tuple of Crossing
        Every crossing found, in the order of the parameter.
    scan : tuple of Scanned
        Every point of the scan, in the order of the parameter.
    level : float or None
        Gyrification index above which a slice counts as folded (definition `visible`).
    evaluations : int
        Equilibria (or runs) computed.
    wall_s : float
        Time taken [s].
    at_edge : bool
        Whether the answer may lie outside of what was scanned: the slice is unstable (or folded) at the
        lowest value already, or changes at an end of the range. A note says which.
    counted : {"waves", "degree", "gyri"}
        What ``mode_number`` is: waves along the contour (of a patch, along its period in x), the degree of
        spherical harmonics, or gyri.
    """

    parameter: str
    definition: Definition
    critical_value: float | None
    reason: str
    notes: tuple[str, ...]
    warnings: tuple[str, ...]
    unsolved: tuple[float, ...]
    bracket: tuple[float, float] | None
    mode_number: int | None
    wavelength_mm: float | None
    growth_time: float | None
    crossings: tuple[Crossing, ...]
    scan: tuple[Scanned, ...]
    level: float | None
    evaluations: int
    wall_s: float
    at_edge: bool = False
    counted: Counted = "waves"

    def wave(self, crossing: Crossing | None = None) -> str:
        """What folds at a crossing: "19 waves of 11.9 mm", or nothing.

        Parameters
        ----------
        crossing : Crossing, optional
            The critical one by default.

        Returns
        -------
        str
        """
        at = crossing or self
        if at.mode_number is None or at.wavelength_mm is None:
            return ""
        if self.counted == "degree":
            return f"degree {at.mode_number}, waves of {at.wavelength_mm:.3g} mm"
        return f"{at.mode_number} {self.counted} of {at.wavelength_mm:.3g} mm"

    def __repr__(self) -> str:
        if self.critical_value is None:
            return f"Threshold({self.parameter}, {self.definition}: nothing is critical)"
        wave = f", {self.wave()}" if self.wave() else ""
        crossings = f"; {len(self.crossings)} crossings" if len(self.crossings) > 1 else ""
        return f"Threshold({self.parameter} = {self.critical_value:.6g}, {self.definition}{wave}{crossings})"

    def _repr_html_(self) -> str:
        rows = [
            (f"{c.value:.6g}", f"{c.becomes} above", c.mode_number or "-", _length(c.wavelength_mm))
            for c in self.crossings
        ]
        return html_rows(repr(self), rows, (self.parameter, "becomes", "mode number", "wavelength [mm]"))

    @property
    def is_known(self) -> bool:
        """Whether anything could be computed: two points of the scan at least."""
        return sum(point.n_negative is not None or point.gi is not None for point in self.scan) > 1

    def as_dict(self) -> dict[str, Any]:
        """Return the fields nested as in ``gyrify threshold --json``."""
        return asdict(self)


def main_crossing(crossings: tuple[Crossing, ...]) -> Crossing | None:
    """The first crossing into instability or folds, or else the first."""
    into = [crossing for crossing in crossings if crossing.becomes in ("unstable", "folded")]
    return next(iter([*into, *crossings]), None)


def _length(value: float | None) -> str:
    return "-" if value is None else f"{value:.3g}"
