"""``gyrify paper``: the paper, reproduced by one command."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from gyrify.cli.codes import COMPLETED, FAILED, INTERRUPTED, STOPPED
from gyrify.cli.options import cores
from gyrify.cli.streams import complain, print_json, say, warn

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gyrify.config import Config
    from gyrify.paper.ensemble import Ensemble
    from gyrify.paper.reading import Reading
    from gyrify.paper.reproduce import Reproduction
    from gyrify.paper.search import Search
    from gyrify.paper.simulations import Simulations

PRESET = "wang2019"
_MORE_SEEDS = "the best three, with and without fitted constants, with five seeds"


def paper(
    *,
    out: Path = Path("paper"),
    workers: int | None = None,
    readings: bool = False,
    minutes: float = 75.0,
    preset: str = PRESET,
    set_: Annotated[tuple[str, ...], Parameter(name="--set", negative="", allow_leading_hyphen=True)] = (),
    gi: str | None = None,
    seed: int = 0,
    json: bool = False,
    quiet: bool = False,
) -> int:
    """Run the simulations of Wang, Yao and Hu (2019) and compare what they observed.

    Runs that the folder holds are not made again: the same command continues after Ctrl-C, and rebuilds all
    tables and figures.

    Parameters
    ----------
    out : Path
        Folder for runs, scoreboard and figures.
    workers : int, optional
        Processes, of one thread each; by default the number of cores.
    readings : bool
        Search the readings of what the paper leaves open, rank them, and repeat the best with five seeds.
    minutes : float
        Time after which the search begins nothing new.
    preset : str
        What to start from; its mechanics is the reading.
    set_ : sequence of str, optional
        Any other value, as section.field=value; may be repeated.
    gi : str, optional
        Gyrification index: closing, hull, exposed, picture, or picture:0.2 for a line of 0.2 mm; by default
        the preset's.
    seed : int
        Seed of the node jitter.
    json : bool
        Print the result as one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.cli.study_progress import progress_of_points
    from gyrify.paper.simulations import Simulations

    begun = time.perf_counter()
    base, reading = _reading_of(preset, set_, gi)
    processes = cores(workers)
    _require(processes, minutes)
    seen = progress_of_points(quiet or readings)
    try:
        with seen as observer, Simulations(out, processes, observer) as simulations:
            if readings:
                return _readings(simulations, base, begun, minutes, json, quiet)
            return _one(simulations, base, reading, begun, seed, json)
    except KeyboardInterrupt:
        return _interrupted(json)


def _reading_of(preset: str, set_: tuple[str, ...], gi: str | None) -> tuple[Config, Reading]:
    """What the preset and the other values come to, and the reading that it is."""
    from gyrify.cli.overrides import resolve_config
    from gyrify.config import preset_about
    from gyrify.paper.index import require_gi
    from gyrify.paper.reading import Mechanics, Reading

    base = resolve_config(preset=preset, set_=set_)
    index = require_gi(gi or preset_about(preset).gi_definition, base.metrics.closing_radius)
    return base, Reading(Mechanics.of(base), index)


def _interrupted(json: bool) -> int:
    said, advice = "Every finished run is stored.", "Run the same command again to continue."
    complain(f"Interrupted. {said} {advice}")
    if json:
        print_json({"error": "Interrupted", "message": said, "advice": advice})
    return INTERRUPTED


def _require(workers: int, minutes: float) -> None:
    from gyrify.base.pool import MAX_WORKERS
    from gyrify.errors import ConfigError

    if not 1 <= workers <= MAX_WORKERS:
        raise ConfigError(f"workers = {workers} is out of range (1 to {MAX_WORKERS}).", "Try 2.")
    if not 0 <= minutes < float("inf"):
        raise ConfigError(f"minutes = {minutes:g} is out of range: it must be >= 0.", "Try 75.")


def _one(
    simulations: Simulations, base: Config, reading: Reading, begun: float, seed: int, json: bool
) -> int:
    """One reading, one seed."""
    from gyrify.paper.reproduce import reproduce
    from gyrify.report.paper_files import write_report

    found = reproduce(simulations, base, reading, seed=seed)
    simulations.write()
    write_report(found, simulations.stored, simulations.folder)
    wall_s = time.perf_counter() - begun
    from gyrify.study.outcome import warnings_of

    warnings = [
        f"{len(keys)} of {len(simulations.records)} runs: {said}"
        for said, keys in warnings_of(simulations.records).items()
    ]
    warn(warnings)
    if json:
        print_json({**found.scoreboard.as_dict(wall_s), "warnings": warnings})
    else:
        _show(found)
        say(f"{len(simulations.records)} runs, {simulations.computed} of them now, {wall_s:.0f} s.")
        say(f"Files in {simulations.folder}.")
    return COMPLETED if any(row.is_complete for row in found.rows.values()) else FAILED


def _readings(
    simulations: Simulations, base: Config, begun: float, minutes: float, json: bool, quiet: bool
) -> int:
    """Search, rank, and repeat the best with fresh seeds, which put them in order."""
    from gyrify.paper.ensemble import best_first, repeat
    from gyrify.paper.search import BEST, SearchProgress, search
    from gyrify.report.paper_files import write_report
    from gyrify.report.paper_readings import write_readings

    def tell(now: SearchProgress) -> None:
        if not quiet:
            spent = (time.perf_counter() - begun) / 60
            done = f"round {now.round} of {now.rounds}, {now.readings} readings, {now.runs} runs"
            complain(f"{spent:.0f} min, {done}; best: {now.best:.3g} hold, {now.reading}")

    found = search(simulations, base, until=begun + 60 * minutes, tell=tell)
    write_readings(found, (), simulations.folder)
    if not quiet:
        complain(f"Now {_MORE_SEEDS}." if found.is_complete else "Time is over: no seeds yet.")
    ensembles = []
    for league in (found.fitted, found.free) if found.is_complete else ():
        chosen = [c for c in league.ranked if c.is_complete][:BEST]
        ensembles += best_first(repeat(simulations, base, c.reading, stability=False) for c in chosen)
    if simulations.records:
        simulations.write()
    files = write_readings(found, ensembles, simulations.folder)
    for number, ensemble in enumerate(ensembles, start=1):
        write_report(
            ensemble.members[0],
            simulations.stored,
            simulations.folder / f"best-{number}",
            figures=number == 1,
        )
    document = _ranking(found, ensembles, time.perf_counter() - begun)
    if json:
        print_json(document)
    else:
        for entry in document["ranking"][:10]:
            say(f"{entry['passed']:5.2f} hold, {entry['constants']} fitted constants: {entry['reading']}")
        say(f"Ranking in {files[1]}.")
    return COMPLETED if found.is_complete else STOPPED


def _ranking(found: Search, ensembles: Sequence[Ensemble], wall_s: float) -> dict[str, Any]:
    """The JSON document of a search: the best scoreboard, the ranking, and the spread over seeds."""
    ranking = [
        {
            "reading": str(c.reading),
            "passed": c.passed,
            "constants": len(c.reading.constants),
            "complete": c.is_complete,
            "proposed": c.origin,
        }
        for league in (found.fitted, found.free)
        for c in league.ranked
    ]
    seeds = [
        {
            "reading": str(e.reading),
            "passed": [m.scoreboard.passed for m in e.members],
            "first_passed": [m.scoreboard.first_passed for m in e.members],
            "constants": list(e.reading.constants),
            "passes": e.passes,
        }
        for e in ensembles
    ]
    best = ensembles[0].members[0].scoreboard.as_dict(wall_s) if ensembles else {"wall_s": wall_s}
    return {**best, "ranking": ranking, "seeds": seeds}


def _show(found: Reproduction) -> None:
    """Print the scoreboard as a table, and the sentences on what does not pass."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from gyrify.report.paper_tables import FIRST, by_first_rule, held

    marks = {True: Text("pass", "bold green"), False: Text("FAIL", "bold red"), None: Text("open", "yellow")}
    board = found.scoreboard
    title = f"Reading: {board.reading}"
    table = Table("", "The paper says", "paper", "ours", "", FIRST, title=title, title_justify="left")
    for row in board.rows:
        table.add_row(
            row.id,
            Text(row.statement),
            Text(row.paper),
            Text(row.ours),
            marks[row.passed],
            by_first_rule(row),
        )
    console = Console(width=None if os.isatty(1) else 140, highlight=False)
    console.print(table)
    for row in board.rows:
        if row.note:
            console.print(Text(f"{row.id}: {row.note}."))
    console.print(Text(held(board), "bold"))
