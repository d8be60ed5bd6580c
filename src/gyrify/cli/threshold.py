"""``gyrify threshold``: the critical value of one parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from gyrify.cli.codes import COMPLETED, FAILED, STOPPED
from gyrify.cli.options import cores, number
from gyrify.cli.overrides import ConfigPath, Overrides, Text
from gyrify.cli.streams import complain, print_json, say, warn
from gyrify.errors import LimitReachedError

if TYPE_CHECKING:
    from gyrify.threshold import Threshold

DEFAULT = Overrides()
Key = Literal["growth.ratio", "growth.time", "material.stiffness_ratio", "geometry.cortical_thickness"]


def threshold(
    config: ConfigPath = None,
    /,
    *,
    overrides: Overrides = DEFAULT,
    parameter: Key = "growth.ratio",
    definition: Literal["stability", "visible"] = "stability",
    range_: Annotated[tuple[str, str] | None, Parameter(name="--range")] = None,
    level: Text = None,
    points: int | None = None,
    workers: int | None = None,
    json: bool = False,
    quiet: bool = False,
) -> int:
    """Find where the smooth slice loses stability, or where folds are seen.

    Parameters
    ----------
    parameter : str
        What is varied.
    definition : str
        stability: the smooth equilibrium at the end of growth, without jitter and dissipation, becomes
        unstable. visible: the gyrification index of a full run passes a level.
    range_ : (str, str), optional
        Lower and upper end of what is scanned; numbers may be fractions.
    level : str, optional
        Gyrification index (closing) that counts as folded; 1.005 by default.
    points : int, optional
        Values to scan.
    workers : int, optional
        Processes for the runs of the definition visible; by default the number of cores.
    json : bool
        Print one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.threshold import critical_growth

    ends = None if range_ is None else (number("--range", range_[0]), number("--range", range_[1]))
    folded = 1.005 if level is None else number("--level", level)
    resolved = overrides.resolve(config)
    processes = 1 if definition == "stability" and workers is None else cores(workers)
    try:
        if not quiet:
            complain(f"Scanning {parameter} ...")
        found = critical_growth(
            resolved, parameter, definition, ends, level=folded, points=points, workers=processes
        )
    except LimitReachedError as limit:
        complain(str(limit))
        if json:
            print_json({"error": "LimitReachedError", "message": limit.message, "advice": limit.advice})
        return STOPPED
    for note in found.notes:
        complain(f"Note: {note}")
    warn(found.warnings)
    if json:
        print_json(found.as_dict())
    else:
        _report(found)
    return COMPLETED if found.is_known else FAILED


def _report(found: Threshold) -> None:
    from gyrify.threshold import PARAMETERS

    unit = PARAMETERS[found.parameter].unit
    for crossing in found.crossings:
        wave = f", {found.wave(crossing)}" if found.wave(crossing) else ""
        value = f"{crossing.value:.6g} {unit}".rstrip()
        say(f"{found.parameter} = {value}: becomes {crossing.becomes} above{wave}.")
    if found.critical_value is None:
        is_sure = found.is_known and not found.unsolved and not found.reason.startswith("Nothing is critical")
        say(f"Nothing is critical. {found.reason}" if is_sure else found.reason)
    say(f"{found.evaluations} evaluations, {found.wall_s:.1f} s.")
