"""The ranking of readings, and the best of them with several seeds, as CSV, Markdown and HTML."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Final

from gyrify.paper.candidate import Candidate
from gyrify.paper.ensemble import Ensemble
from gyrify.paper.observations import observations
from gyrify.paper.row import GI_DEFINITIONS
from gyrify.paper.scoreboard import Scoreboard
from gyrify.paper.screen import Screening
from gyrify.report.paper_page import html_table, page
from gyrify.report.paper_tables import MARKS, csv_text, markdown_table, write_text

SHOWN: Final = 40
_SIGNS: Final = {True: "✓", False: "✗", None: "·"}
_AXES: Final = ("out_of_plane", "stretch", "energy_per", "dissipation", "number", "element", "imperfection")
_LEGEND: Final = "✓ holds, ✗ does not, · left open. "
_WHY_OPEN: Final = (
    "With all that is open such a reading would still not be among the best three: it was not run to the end."
)


def write_readings(screening: Screening, ensembles: Sequence[Ensemble], folder: Path) -> list[Path]:
    """Write ``readings.csv``, ``.md`` and ``.html``, and ``seeds.csv`` where there are ensembles.

    Parameters
    ----------
    screening : Screening
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
        "readings.csv": readings_csv(screening),
        "readings.md": readings_markdown(screening, ensembles),
        "readings.html": readings_page(screening, ensembles),
    }
    if ensembles:
        texts["seeds.csv"] = seeds_csv(ensembles)
    for name, text in texts.items():
        write_text(folder / name, text)
    return [folder / name for name in texts]


def readings_csv(screening: Screening) -> str:
    """The full matrix: one line per mechanics and definition of the index, best mechanics first."""
    ids = [observation.id for observation in observations()]
    names = ("rank", *_AXES, "gi", "passed", "open", *ids, "runs", "remark")
    lines = [
        (
            rank,
            *(getattr(candidate.mechanics, axis) for axis in _AXES),
            gi,
            board.passed,
            board.open,
            *(MARKS[row.passed] for row in board.rows),
            candidate.n_runs,
            candidate.impossible,
        )
        for rank, candidate in enumerate(screening.candidates, start=1)
        for gi, board in ((gi, candidate.boards[gi]) for gi in GI_DEFINITIONS)
    ]
    return csv_text(names, lines)


def seeds_csv(ensembles: Sequence[Ensemble]) -> str:
    """Mean and standard deviation of every quantity of the best readings."""
    lines = [
        (number, str(e.reading), s.name, f"{s.mean:.6g}", f"{s.deviation:.6g}", s.n)
        for number, e in enumerate(ensembles, start=1)
        for s in (e.score, *e.spreads())
    ]
    return csv_text(("rank", "reading", "quantity", "mean", "standard_deviation", "n"), lines)


def readings_markdown(screening: Screening, ensembles: Sequence[Ensemble]) -> str:
    """Ranking with the matrix, and the best with several seeds."""
    names, lines = _matrix(screening)
    blocks = ["# Readings of Wang, Yao and Hu (2019), ranked", _summary(screening), _legend(screening)]
    blocks.append(markdown_table(names, lines))
    for ensemble in ensembles:
        blocks += [f"## {ensemble.reading}", _members(ensemble), markdown_table(*_passes(ensemble))]
        blocks.append(markdown_table(("quantity", "mean ± standard deviation"), _spreads(ensemble)))
    return "\n\n".join(blocks) + "\n"


def readings_page(screening: Screening, ensembles: Sequence[Ensemble]) -> str:
    """The same as an HTML page."""
    names, lines = _matrix(screening)
    blocks = [f"<p>{escape(_summary(screening))}</p><p class='small'>{escape(_legend(screening))}</p>"]
    blocks.append(html_table(names, lines))
    for ensemble in ensembles:
        blocks.append(f"<h2>{escape(str(ensemble.reading))}</h2><p>{escape(_members(ensemble))}</p>")
        blocks.append(html_table(*_passes(ensemble)))
        blocks.append(html_table(("quantity", "mean ± standard deviation"), _spreads(ensemble)))
    return page("Readings of Wang, Yao and Hu (2019), ranked", *blocks)


def _matrix(screening: Screening) -> tuple[list[str], list[list[object]]]:
    """Heading and lines of the ranking, one line per mechanics with its best index."""
    names = ["", "reading", "holds", "at most", *(observation.id for observation in observations())]
    return names, [_line(rank, c) for rank, c in enumerate(screening.candidates[:SHOWN], start=1)]


def _line(rank: int, candidate: Candidate) -> list[object]:
    board = candidate.boards[candidate.gi]
    name = (
        f"{candidate.reading} (impossible: {candidate.impossible})"
        if candidate.impossible
        else candidate.reading
    )
    return [rank, name, candidate.passed, candidate.bound, *_marks(board)]


def _marks(board: Scoreboard) -> list[str]:
    return [_SIGNS[row.passed] for row in board.rows]


def _summary(screening: Screening) -> str:
    n, open_ones = len(screening.candidates), sum(c.is_open for c in screening.candidates)
    runs = sum(c.n_runs for c in screening.candidates)
    told = (
        f"{n} mechanics, each with three definitions of the gyrification index; {runs} runs with one seed. "
    )
    if screening.is_complete:
        told += f"The best three are certain; {open_ones} were given up before their end."
    else:
        told += (
            f"Time ran out: {screening.live} could still be among the best three. Run the same command again."
        )
    told += f" {screening.note}" if screening.note else ""
    hidden = n - min(n, SHOWN)
    return told + (f" The best {SHOWN} are shown; readings.csv has all." if hidden else "")


def _legend(screening: Screening) -> str:
    return (_LEGEND + (_WHY_OPEN if screening.is_complete else "")).strip()


def _members(ensemble: Ensemble) -> str:
    scores = ", ".join(str(member.scoreboard.passed) for member in ensemble.members)
    return f"{len(ensemble.members)} seeds: {scores} observations hold, {ensemble.score}."


def _passes(ensemble: Ensemble) -> tuple[list[str], list[list[object]]]:
    passes = ensemble.passes
    return [*passes], [[f"{count}/{len(ensemble.members)}" for count in passes.values()]]


def _spreads(ensemble: Ensemble) -> list[tuple[str, str]]:
    return [(s.name, str(s)) for s in ensemble.spreads()]
