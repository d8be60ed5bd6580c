"""Pictures of a study, chosen by what its design varies."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

from gyrify.config import Config
from gyrify.report.figures import save_figure
from gyrify.report.onset_curve import onset_curve
from gyrify.report.phase_diagram import phase_figure
from gyrify.report.sensitivity import MOST_LINES, NUMBER, sensitivity_figure
from gyrify.report.study_data import Row, cells, index_name, numeric, varied
from gyrify.study import final_state, read_results


def write_study_pictures(folder: str | Path) -> list[Path]:
    """Write the pictures that a study's results allow, without simulating.

    ``phase-diagram.png`` where exactly two numeric parameters vary (beside the seed), and
    ``dissipation.png`` where the dissipation number does.

    Parameters
    ----------
    folder : path
        Study folder.

    Returns
    -------
    list of Path
        The files; those of an earlier design that are not written are removed.

    Raises
    ------
    HistoryError
        If there are no results, or the folder cannot be written.
    """
    target = Path(folder)
    rows = read_results(target).to_pylist()
    files = []
    drawn = {"phase-diagram.png": _phase(rows, target), "dissipation.png": _sensitivity(rows)}
    for name, figure in drawn.items():
        if figure is None:
            (target / name).unlink(missing_ok=True)
            continue
        save_figure(figure, target / name, dpi=200)
        files.append(target / name)
    return files


def _phase(rows: list[Row], folder: Path) -> Figure | None:
    keys = varied(rows)
    if len(keys) != 2 or numeric(rows, keys) != keys:
        return None
    found = cells(rows, keys)
    (x, y), places = keys, list(zip(*(cell.at for cell in found), strict=True))
    spans = tuple((float(min(values)), float(max(values))) for values in places)
    onset = onset_curve(_config(rows, folder), (x, y), (spans[0], spans[1]))
    seeds = max(len(c.gi) + c.n_failed for c in found)
    return phase_figure(found, (x, y), onset, n_seeds=seeds, index=index_name(rows))


def _sensitivity(rows: list[Row]) -> Figure | None:
    keys = varied(rows)
    if NUMBER not in keys or not any(row["status"] == "completed" for row in rows):
        return None
    ordered = [NUMBER, *(key for key in keys if key != NUMBER)]
    found = cells(rows, ordered)
    is_drawn = len({cell.at[1:] for cell in found}) <= MOST_LINES
    return sensitivity_figure(found, ordered, index_name(rows)) if is_drawn else None


def _config(rows: list[Row], folder: Path) -> Config:
    """What all runs have in common, and the parameters of one."""
    return final_state(folder, str(rows[0]["key"])).config
