"""The ranking of readings, and the best of them with several seeds, as CSV, Markdown and HTML."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from typing import Any, Final

from gyrify.paper.contender import CHOOSING, Contender
from gyrify.paper.ensemble import Ensemble
from gyrify.paper.exclusion import exclusions
from gyrify.paper.observations import observations
from gyrify.paper.search import League, Search
from gyrify.report.paper_page import html_table, page
from gyrify.report.paper_tables import csv_text, markdown_table, write_text

SHOWN: Final = 12
TITLE: Final = "Readings of Wang, Yao and Hu (2019), ranked"
_AXES: Final = (
    *("out_of_plane", "exponent", "stretch", "energy_per", "dissipation", "number", "course"),
    *("element", "grading", "split", "imperfection"),
)
_LEAGUES: Final = {
    True: "With fitted constants",
    False: "Without fitted constants",
}
_LEGEND: Final = (
    "In the columns P1 to P18, the number of seeds with which an observation holds; · where it was left "
    "open, since the reading had fallen behind. Holds: mean over the seeds that were run."
)
Block = tuple[str, str, Sequence[str], Sequence[Sequence[object]]]


def write_readings(found: Search, ensembles: Sequence[Ensemble], folder: Path) -> list[Path]:
    """Write ``readings.csv``, ``.md`` and ``.html``, and ``seeds.csv`` where there are ensembles.

    Parameters
    ----------
    found : Search
        The ranking.
    ensembles : sequence of Ensemble
        The best readings with several seeds.
    folder : Path
        Where to.

    Returns
    -------
    list of Path
        The files.
    """
    texts = {
        "readings.csv": readings_csv(found),
        "readings.md": readings_markdown(found, ensembles),
        "readings.html": readings_page(found, ensembles),
    }
    if ensembles:
        texts["seeds.csv"] = seeds_csv(ensembles)
    for name, text in texts.items():
        write_text(folder / name, text)
    return [folder / name for name in texts]


def readings_csv(found: Search) -> str:
    """One line per mechanics, with its best index."""
    ids = [observation.id for observation in observations()]
    names = ("rank", "constants", "proposed", *_AXES, "gi", "passed", "seeds", *ids, "runs", "remark")
    lines = [
        (
            rank,
            len(c.reading.constants),
            c.origin,
            *(getattr(c.mechanics, axis) for axis in _AXES),
            str(c.gi),
            f"{c.passed:.4g}",
            len(c.candidates),
            *_marks(c),
            c.n_runs,
            c.impossible or ("" if c.is_complete else "fell behind"),
        )
        for league in (found.fitted, found.free)
        for rank, c in enumerate(league.ranked, start=1)
    ]
    return csv_text(names, lines)


def seeds_csv(ensembles: Sequence[Ensemble]) -> str:
    """Mean and standard deviation of every quantity of the best readings."""
    lines = [
        (number, str(e.reading), s.name, f"{s.mean:.6g}", f"{s.deviation:.6g}", s.n)
        for number, e in enumerate(ensembles, start=1)
        for s in (*e.scores, *e.spreads())
    ]
    return csv_text(("rank", "reading", "quantity", "mean", "standard_deviation", "n"), lines)


def readings_markdown(found: Search, ensembles: Sequence[Ensemble]) -> str:
    """Ranking, what guidance and constants bring, what excludes what, and the best with several seeds."""
    blocks = [f"# {TITLE}", summary(found)]
    for heading, text, names, lines in _blocks(found, ensembles):
        blocks += [f"## {heading}", *([text] if text else []), markdown_table(names, lines)]
    return "\n\n".join(blocks) + "\n"


def readings_page(found: Search, ensembles: Sequence[Ensemble]) -> str:
    """The same as an HTML page."""
    blocks = [f"<p>{escape(summary(found))}</p>"]
    for heading, text, names, lines in _blocks(found, ensembles):
        blocks += [f"<h2>{escape(heading)}</h2>", f"<p class='small'>{escape(text)}</p>" if text else ""]
        blocks.append(html_table(names, lines))
    return page(TITLE, *blocks)


def summary(found: Search) -> str:
    """How much was searched, in words."""
    contenders = [*found.fitted.contenders, *found.free.contenders]
    told = (
        f"{len(contenders)} readings in {found.rounds} rounds, {sum(c.n_runs for c in contenders)} runs "
        f"({found.core_minutes:.0f} minutes of one core); "
        f"chosen by seeds {', '.join(map(str, CHOOSING))}, and given up once they could no longer be among "
        "the best three."
    )
    told += "" if found.is_complete else " Time ran out: run the same command again to go on."
    return told + (f" {found.note}" if found.note else "")


def _blocks(found: Search, ensembles: Sequence[Ensemble]) -> Iterator[Block]:
    for league in (found.fitted, found.free):
        if league.contenders:
            yield (_LEAGUES[league.is_fitted], _LEGEND, *_matrix(league))
    yield "What guidance brings", "", *_origins(found)
    yield "What constants bring", "", *_constants(found)
    pairs = list(_pairs(found))
    if pairs:
        told = (
            "Pairs of which each was seen to hold, and never both, among all scoreboards in which both are "
            "decided: every reading, seed and index counts as one."
        )
        yield "What was never seen together", told, ("pair", "decided", "first alone", "second alone"), pairs
    for ensemble in ensembles:
        yield str(ensemble.reading), ensemble.told, *_passes(ensemble)
        yield (
            "",
            "",
            ("quantity", "mean ± standard deviation"),
            [(s.name, str(s)) for s in ensemble.spreads()],
        )


def _matrix(league: League) -> tuple[list[str], list[list[object]]]:
    """Heading and lines of a ranking, one line per mechanics with its best index."""
    names = ["", "reading", "fitted", "proposed", "holds", *(o.id for o in observations())]
    lines: list[list[object]] = [
        [rank, c.reading, len(c.reading.constants), c.origin, f"{c.passed:.3g}", *_marks(c)]
        for rank, c in enumerate(league.ranked[:SHOWN], start=1)
    ]
    return names, lines


def _marks(contender: Contender) -> list[str]:
    boards = [candidate.boards[contender.gi] for candidate in contender.candidates]
    columns = zip(*(board.rows for board in boards), strict=True)
    return [
        "·" if any(row.passed is None for row in column) else str(sum(row.passed is True for row in column))
        for column in columns
    ]


def _origins(found: Search) -> tuple[Sequence[str], list[list[object]]]:
    """The best of what chance and what the surrogate proposed, as many of each."""
    names = ("", "proposed", "readings", "came to their end", "best mean")
    lines: list[list[object]] = []
    for league in (found.fitted, found.free):
        for origin in ("known", "random", "surrogate", "neighbour"):
            own = [c for c in league.contenders if c.origin == origin]
            if own:
                ends = [c.passed for c in own if c.is_complete]
                best = f"{max(ends):.3g}" if ends else "–"
                lines.append([_LEAGUES[league.is_fitted], origin, len(own), len(ends), best])
    return names, lines


def _constants(found: Search) -> tuple[Sequence[str], list[list[object]]]:
    """The best reading for each number of fitted constants."""
    everyone: list[Any] = [c for league in (found.fitted, found.free) for c in league.ranked if c.is_complete]
    best: dict[int, Contender] = {}
    for contender in everyone:
        number = len(contender.reading.constants)
        if number not in best or contender.passed > best[number].passed:
            best[number] = contender
    lines: list[list[object]] = [
        [number, ", ".join(c.reading.constants) or "none", f"{c.passed:.3g}", c.reading]
        for number, c in sorted(best.items())
    ]
    return ("fitted constants", "which", "best mean", "reading"), lines


def _pairs(found: Search) -> Iterator[tuple[object, ...]]:
    boards = (
        board
        for league in (found.fitted, found.free)
        for contender in league.contenders
        for candidate in contender.candidates
        for board in candidate.boards.values()
    )
    for pair in exclusions(boards):
        if pair.is_exclusive:
            yield f"{pair.one}, {pair.other}", pair.decided, pair.only_one, pair.only_other


def _passes(ensemble: Ensemble) -> tuple[list[str], list[list[object]]]:
    passes = ensemble.passes
    return [*passes], [[f"{count}/{len(ensemble.members)}" for count in passes.values()]]
