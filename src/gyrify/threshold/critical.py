"""The threshold of one parameter: scan first, then refine every crossing."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from gyrify.base.arguments import real_number
from gyrify.base.pool import MAX_WORKERS
from gyrify.config import Config, ConfigLike, as_config
from gyrify.config.body_sections import FROM_FILES, PERIODIC
from gyrify.config.space_checks import finer
from gyrify.errors import ConfigError
from gyrify.run.limits import Watch
from gyrify.run.validity.expected import expected_onset
from gyrify.run.validity.locking import locking
from gyrify.run.validity.ranges import contour_spacing
from gyrify.run.validity.space_resolution import EDGES_PER_WAVE
from gyrify.threshold.crossings import Crossing, Definition, Scanned, Threshold, main_crossing
from gyrify.threshold.scanned_parameter import PARAMETERS, Range, scan_values
from gyrify.threshold.stability_scan import StabilityScan
from gyrify.threshold.theory_value import differences, expected_crossings
from gyrify.threshold.visible_scan import VisibleScan

# Relative tolerance of a crossing, by definition.
TOLERANCE: dict[str, float] = {"stability": 1e-6, "visible": 0.01}


def critical_growth(
    config: ConfigLike,
    parameter: str = "growth.ratio",
    definition: Definition = "stability",
    range: Range | None = None,
    *,
    level: float = 1.005,
    points: int | None = None,
    tolerance: float | None = None,
    workers: int = 1,
) -> Threshold:
    """Find the critical value of one parameter, of a body in the plane or in space.

    Stability need not be monotone in the parameter, so the range is scanned first and every change is
    refined; two crossings between neighbouring points of the scan are not seen.

    Parameters
    ----------
    config : Config, dict or path
        All other parameters; a path is that of a TOML file.
    parameter : str
        ``growth.ratio``, ``growth.time``, ``material.stiffness_ratio`` or ``geometry.cortical_thickness``.
    definition : {"stability", "visible"}
        ``stability``: where the smooth equilibrium at the end of growth, without jitter and dissipation,
        changes stability. ``visible``: where the gyrification index by the closing (of areas in space)
        passes ``level`` after a full run with the configuration's jitter and dissipation.
    range : (float, float), optional
        Values to scan between, in the unit of the parameter.
    level : float
        Gyrification index above which a body counts as folded [-], > 1; `visible` only.
    points : int, optional
        Values to scan.
    tolerance : float, optional
        Relative width to which a crossing is refined; 1e-6 (stability) or 0.01 (visible) by default.
    workers : int
        Processes for the runs of the scan (`visible`); the states of `stability` follow one another, in one.

    Returns
    -------
    Threshold
        With ``critical_value`` None and a ``reason`` where nothing is critical.

    Raises
    ------
    ConfigError
        If an argument is out of range.
    SolveError
        If the smooth branch cannot be found at either end of the range.
    LimitReachedError
        If a limit of the configuration is reached.
    """
    begun, config = time.perf_counter(), as_config(config)
    level = real_number("level", level)
    tolerance = None if tolerance is None else real_number("tolerance", tolerance)
    _check(definition, level, tolerance, workers)
    if definition == "stability":
        _require_one_branch(config, parameter)
    values = scan_values(config, parameter, range, points, definition == "visible")
    found = _find(config, parameter, definition, values, level, tolerance or TOLERANCE[definition], workers)
    return replace(found, wall_s=time.perf_counter() - begun)


def _require_one_branch(config: Config, parameter: str) -> None:
    """Refuse what has no smooth branch: another mesh for each value, bodies that nothing holds."""
    if config.geometry.shape not in FROM_FILES:
        return
    advice = 'Set definition = "visible".'
    if parameter == "geometry.cortical_thickness":
        raise ConfigError(
            f'{parameter} is not allowed with geometry.shape = "{config.geometry.shape}" and definition = '
            '"stability": each thickness has another mesh, and states of one are none of another.',
            advice,
        )
    if (n := config.geometry.surface.n_parts) > 1:
        raise ConfigError(
            f'definition = "stability" is not allowed with the {n} closed surfaces of geometry.file: '
            "without drag nothing holds one beside the other.",
            advice,
        )


def _find(
    config: Config,
    parameter: str,
    definition: Definition,
    values: Sequence[float],
    level: float,
    tolerance: float,
    workers: int,
) -> Threshold:
    """Scan, and refine every change between neighbours of known state."""
    visible, watch = definition == "visible", Watch(config.limits.wall_time, config.limits.memory)
    scan = (
        VisibleScan(config, parameter, level, watch, workers)
        if visible
        else StabilityScan(config, parameter, watch)
    )
    scanned = scan.scan(values)
    changes = [
        scan.crossing(below, above, tolerance)
        for below, above in pairwise(point for point in scanned if _is_known(point))
        if _is_beyond(below, level) != _is_beyond(above, level)
    ]
    ends = scan.ends(scanned) if isinstance(scan, StabilityScan) else []
    crossings = _ordered((*changes, *ends))
    main, edges = main_crossing(crossings), _edges(parameter, scanned, crossings, level, tolerance)
    unsolved = _unsolved(values, scanned)
    if visible and parameter == "growth.time":  # one run, read at its own increments
        unsolved = ()
    is_round = config.geometry.n_dim == 3 and config.geometry.shape not in PERIODIC
    exact = None if visible else expected_crossings(config, parameter, values)
    return Threshold(
        parameter=parameter,
        definition=definition,
        critical_value=main.value if main else None,
        reason="" if main else _reason(config, parameter, scanned, level, visible, unsolved, exact),
        notes=(*scan.notes, *edges),
        warnings=_warnings(config, parameter, crossings, exact, unsolved),
        unsolved=unsolved,
        bracket=main.bracket if main else None,
        mode_number=main.mode_number if main else None,
        wavelength_mm=main.wavelength_mm if main else None,
        growth_time=main.growth_time if main else None,
        crossings=_ordered(crossings),
        scan=tuple(scanned),
        level=level if visible else None,
        evaluations=scan.evaluations,
        wall_s=0.0,
        at_edge=bool(edges),
        counted="gyri" if visible else "degree" if is_round else "waves",
    )


def _edges(
    parameter: str, scanned: Sequence[Scanned], crossings: Sequence[Crossing], level: float, tolerance: float
) -> list[str]:
    """Where the answer lies at an end of what was scanned, or beyond it."""
    known = [point for point in scanned if _is_known(point)]
    if not known:
        return []
    name, low, high = parameter, known[0].value, known[-1].value
    notes = []
    if _is_beyond(known[0], level):
        state = "unstable" if known[0].gi is None else "folded"
        notes.append(
            f"The slice is {state} already at the lowest value of {name} that was computed ({low:.6g}): a "
            "crossing may lie below it. Scan from a smaller value."
        )
    for end in (low, high):
        if any(abs(crossing.value - end) <= 2.0 * tolerance * abs(end) for crossing in crossings):
            notes.append(
                f"A crossing lies at the end of the range ({name} = {end:.6g}): scan a wider range to see "
                "what is on its other side."
            )
    return notes


def _check(definition: str, level: float, tolerance: float | None, workers: int) -> None:
    if not 1 <= workers <= MAX_WORKERS:
        raise ConfigError(
            f"workers = {workers} is out of range (1 to {MAX_WORKERS}).", "Try the number of cores."
        )
    if definition not in TOLERANCE:
        raise ConfigError(f"definition = {definition[:60]!r} is unknown.", "Choose stability or visible.")
    if not 1.0 < level < 10.0:
        raise ConfigError(f"level = {level:g} is out of range: it must be above 1.", "Try 1.005.")
    if tolerance is not None and not 1e-12 <= tolerance <= 0.5:
        raise ConfigError(f"tolerance = {tolerance:g} is out of range (1e-12 to 0.5).", "Try 1e-6.")


def _is_known(point: Scanned) -> bool:
    return point.n_negative is not None or point.gi is not None


def _is_beyond(point: Scanned, level: float) -> bool:
    """Whether a point is unstable, or visibly folded."""
    return bool(point.n_negative) if point.gi is None else point.gi > level


def _ordered(crossings: Sequence[Crossing]) -> tuple[Crossing, ...]:
    return tuple(sorted(crossings, key=lambda crossing: crossing.value))


def _unsolved(values: Sequence[float], scanned: Sequence[Scanned]) -> tuple[float, ...]:
    """Values that were to be scanned and of which nothing is known."""
    known = {point.value for point in scanned if _is_known(point)}
    return tuple(value for value in values if value not in known)


def _warnings(
    config: Config,
    parameter: str,
    crossings: Sequence[Crossing],
    exact: Sequence[float] | None,
    unsolved: Sequence[float],
) -> tuple[str, ...]:
    """What a reader of the answer should not overlook."""
    found = [*locking(config)]
    if unsolved:
        found.append(
            f"{_listed(unsolved)} of {parameter} could not be solved: a crossing there is not seen. "
            f"Scan another range, or {finer(config)}."
        )
    found += _coarse_beside(config, crossings)
    again = f"Repeat it with mesh.refine = {config.mesh.refine + 1}, and see how far it moves."
    advice = "Change the element first." if locking(config) else again
    return (*found, *differences(parameter, expected_onset(config).theory, exact, crossings, advice))


def _coarse_beside(config: Config, crossings: Sequence[Crossing]) -> list[str]:
    """Warn of waves that few edges of a surface in space make up: the crossing is the mesh's as well."""
    if config.geometry.n_dim == 2:
        return []
    edge, needed = contour_spacing(config), EDGES_PER_WAVE[config.mesh.element]
    return [
        f"The wave of {crossing.wavelength_mm:.3g} mm at {crossing.value:.4g} is {number:.2g} edges of "
        f"{edge:.3g} mm long ({needed:g} are needed): a finer mesh moves the crossing: "
        f"{finer(config)}."
        for crossing in crossings
        if crossing.wavelength_mm is not None and (number := crossing.wavelength_mm / edge) < needed
    ]


def _listed(values: Sequence[float]) -> str:
    shown = ", ".join(f"{value:.5g}" for value in values[:5]) + (" …" if len(values) > 5 else "")
    return f"{len(values)} {'value' if len(values) == 1 else 'values'} ({shown})"


def _reason(
    config: Config,
    parameter: str,
    scanned: Sequence[Scanned],
    level: float,
    visible: bool,
    unsolved: Sequence[float],
    exact: Sequence[float] | None,
) -> str:
    """Why there is no critical value: nothing is critical, or nothing is known."""
    scanned = [point for point in scanned if _is_known(point)]
    if len(scanned) < 2:
        return (
            f"Nothing is known: no two points of {parameter} could be computed. "
            f"Scan another range, or {finer(config)}."
        )
    unit = PARAMETERS[parameter].unit
    low, high = scanned[0].value, scanned[-1].value
    beyond = _is_beyond(scanned[0], level)
    if visible:
        outcome = f"The gyrification index is {'above' if beyond else 'at most'} {level:g}"
    else:
        outcome = f"The smooth state is {'unstable' if beyond else 'stable'}"
    where = f"at all {len(scanned)} values of {parameter} from {low:.6g} to {high:.6g} {unit}".rstrip()
    if unsolved:
        return (
            f"Whether anything is critical is unknown: {_listed(unsolved)} could not be solved. {outcome} at "
            f"the others. Scan another range, or {finer(config)}."
        )
    if exact:
        return (
            "Nothing is critical on this mesh, but exact theory has a crossing in this range. "
            f"{outcome} {where}. Refine the mesh."
        )
    return f"{outcome} {where}. Scan another range, or more points."
