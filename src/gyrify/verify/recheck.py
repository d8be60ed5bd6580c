"""Recheck a stored run from its files alone: every row, every increment, every number derived from them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import numpy as np

from gyrify.config import Config
from gyrify.errors import ConfigError, HistoryError
from gyrify.run.body_measures import hole_crosses_itself
from gyrify.run.reevaluation import Increment, reevaluated
from gyrify.run.summary import metrics_rows
from gyrify.run.units import energy_unit, force_unit
from gyrify.store.derived import read_summary, require_digest
from gyrify.store.folder import JOURNAL
from gyrify.store.history import History
from gyrify.verify.metrics import check_metrics
from gyrify.verify.verification import Check, Verification

# Rounding of a residual over the tolerance that it is compared with.
RESIDUAL_MARGIN: Final = 1e-3
# Largest energy created, over the work of growth; more if the increments are so few that the work of growth
# itself is known less well.
ENERGY_BOUND: Final = 0.02
# Difference between a state and its mirror image [mm]; they agree to the last bit where all is well.
SYMMETRY_BOUND: Final = 1e-9
# Rounding of a sum over all cells.
DESCENT_BOUND: Final = 1e-10


def verify(run: str | Path) -> Verification:
    """Recheck a run from its folder.

    Parameters
    ----------
    run : path
        Run folder.

    Returns
    -------
    Verification
        Every check; where a state is damaged, those that need the states are left out.

    Raises
    ------
    HistoryError
        If the folder holds no run, or a summary that cannot be read.
    """
    folder = Path(run)
    try:
        history = History.load(folder)
    except HistoryError as damaged:
        if not (folder / JOURNAL).is_file():
            raise
        return Verification((Check("states", False, str(damaged)),))
    checks = [_check_states(history), _check_config(history, folder), _check_series(history, folder)]
    try:
        summary = read_summary(folder)
    except HistoryError as damaged:
        return Verification((*checks, Check("summary.json", False, str(damaged))))
    checks.append(_check_hash(history, summary))
    if not checks[0].passed:
        return Verification(tuple(checks))
    increments, rows = list(reevaluated(history)), metrics_rows(history)
    if increments:
        volumes = list(_check_volumes(increments))
        if all(check.passed for check in volumes):  # the energy of an inverted cell is infinite
            checks += _check_forces(
                history.slice.stepping.criterion.force, increments, force_unit(history.mesh.n_dim)
            )
        checks += volumes
        if all(check.passed for check in volumes):
            checks.append(_check_balance(increments, energy_unit(history.mesh.n_dim)))
        checks += _check_symmetry(history)
    if history.config.contact.enabled:
        checks += _check_contact(rows)
        checks += _check_hole(history)
        if history.mesh.n_dim == 2:  # in space no path is straight; see `Slice.is_path_admissible`
            checks.append(_check_path(increments, _jumps(history)))
    checks += check_metrics(history, folder, rows, summary)
    return Verification(tuple(checks))


def _check_states(history: History) -> Check:
    """Every row there, undamaged, in order, finite, clamped where it must be."""
    held, stepping, name = history.slice.held, history.slice.stepping, "states"
    position, shape = 0, history.slice.state_shape
    try:
        for number in range(len(history)):
            state = history.journal.state(number)
            if state.u.shape != shape or not np.isfinite(state.u).all():
                return Check(name, False, f"Increment {number} is not a finite displacement of this mesh.")
            if number > 0 and (state.span < 1 or state.position != position + state.span):
                return Check(name, False, f"Increment {number} does not follow the one before it.")
            if state.u.ravel()[held].any() or (number == 0 and (state.u.any() or state.position != 0)):
                return Check(name, False, f"Increment {number} moves points that are held.")
            position = state.position
    except HistoryError as error:
        return Check(name, False, error.message)
    if history.status == "completed" and position != stepping.end:
        return Check(name, False, "The run is marked completed but does not reach the end of growth.")
    return Check(name, True, f"All {len(history)} states are there, undamaged and in order.")


def _check_config(history: History, folder: Path) -> Check:
    path, recorded = folder / "config.toml", history.config.config_hash
    if not path.is_file():
        return Check("configuration", True, "There is no config.toml to compare; the journal has its own.")
    try:
        found = Config.load(path).config_hash
    except ConfigError as damaged:
        return Check("configuration", False, damaged.message)
    if found != recorded:
        return Check("configuration", False, "config.toml is not the configuration that the journal records.")
    return Check("configuration", True, f"config.toml and the journal agree on {recorded[:12]}.")


def _check_series(history: History, folder: Path) -> Check:
    """The time series is the file that was written; HDF5 is not asked to open it."""
    path, recorded, name = folder / "history.vtkhdf", history.journal.meta("vtkhdf_sha256"), "time series"
    if not path.is_file() or not recorded:
        return Check(name, True, "There is no history.vtkhdf whose checksum is on record.")
    try:
        require_digest(path, recorded)
    except HistoryError as differs:
        return Check(name, False, str(differs))
    return Check(name, True, f"history.vtkhdf is the file that was written ({recorded[:12]}).")


def _check_hash(history: History, summary: dict[str, Any] | None) -> Check:
    found = history.result_hash
    if summary is None:
        return Check("result hash", True, f"It is {found[:12]}; there is no summary.json to compare with.")
    if summary.get("result_hash") != found:
        return Check("result hash", False, "The stored states are not those that summary.json was made of.")
    return Check("result hash", True, f"The journal and summary.json agree on {found[:12]}.")


def _check_forces(tolerance: float, increments: list[Increment], unit: str) -> Iterator[Check]:
    """Bounds that each increment must keep by itself; ``tolerance`` is that of the residual, a force."""
    margin = RESIDUAL_MARGIN * tolerance
    residuals = [increment.residual for increment in increments]
    gaps = [abs(increment.residual - increment.stored_residual) for increment in increments]
    rises = [increment.rise for increment in increments]
    what = f"The largest difference between a stored and a recomputed residual [{unit}]"
    yield _at_most("residual", residuals, tolerance + margin, f"The largest nodal force [{unit}]")
    yield _at_most("stored residual", gaps, margin, what)
    yield _at_most("descent", rises, DESCENT_BOUND, "The largest relative rise of the energy")


def _check_volumes(increments: list[Increment]) -> Iterator[Check]:
    """No cell is inverted, anywhere in it."""
    cells = [increment.smallest_cell for increment in increments]
    yield _above_zero("volume", [increment.min_J for increment in increments], "The smallest J", cells=cells)
    cells = [increment.smallest_elastic_cell for increment in increments]
    least = [increment.min_J_elastic for increment in increments]
    yield _above_zero("elastic volume", least, "The smallest J_e", cells=cells)


def _check_symmetry(history: History) -> Iterator[Check]:
    """States are their own mirror image where the mesh is."""
    mirrors = history.mesh.mirrors
    if mirrors:
        states = [history.journal.state(number).u for number in range(1, len(history))]
        gaps = [max(float(np.abs(mirror.of(u) - u).max()) for mirror in mirrors) for u in states]
        what = "The largest difference between a state and its mirror image [mm]"
        yield _at_most("symmetry", gaps, SYMMETRY_BOUND, what)


def _jumps(history: History) -> set[int]:
    """Increments without dissipation that left an unstable equilibrium, or could not be made smaller."""
    if not history.slice.may_jump:
        return set()
    left = {number for number, n_negative in history.journal.negative_pivots.items() if n_negative > 0}
    spans = enumerate(history.journal.column("span"))
    return left | {number for number, span in spans if history.slice.stepping.is_smallest(span)}


def _check_contact(rows: list[dict[str, Any]]) -> Iterator[Check]:
    """The contour or surface meets itself in no state."""
    crossed = sum(bool(row["self_intersecting"]) for row in rows)
    yield Check(
        "simple contour", crossed == 0, f"{crossed} of {len(rows)} contours cross themselves.", crossed, 0.0
    )
    gaps = [float(row["min_gap_mm"]) for row in rows]
    yield _above_zero("gap", gaps, "The smallest gap [mm]", first=0)


def _check_hole(history: History) -> Iterator[Check]:
    """A hole that nothing holds meets itself in no state: contact does not keep it from that."""
    mesh = history.mesh
    if mesh.n_dim == 2 or mesh.clamped.size == 0 or history.slice.is_clamped:
        return
    crossed = sum(hole_crosses_itself(mesh, history.points(number)) for number in range(len(history)))
    sentence = f"The surface of the hole crosses itself in {crossed} of {len(history)} states."
    yield Check("hole", crossed == 0, sentence, float(crossed), 0.0)


def _check_path(increments: list[Increment], jumps: set[int]) -> Check:
    """The contour meets itself nowhere on the straight path from state to state."""
    # A jump is a descent of many steps, each free of collisions: the straight path may yet cross.
    straight = [increment for number, increment in enumerate(increments, 1) if number not in jumps]
    crossing = sum(not increment.is_path_free for increment in straight)
    sentence = f"{crossing} of {len(straight)} straight paths between states cross the contour"
    sentence += f"; {len(increments) - len(straight)} jumps are not straight." if jumps else "."
    return Check("path", crossing == 0, sentence, float(crossing), 0.0)


def _at_most(name: str, values: list[float], bound: float, what: str) -> Check:
    """Largest value of all increments, the first of which is number 1, at most a bound."""
    at = int(np.argmax(values))  # a NaN is the largest
    sentence = f"{what} is {values[at]:.3g}, in increment {at + 1} (allowed: at most {bound:.3g})."
    return Check(name, values[at] <= bound, sentence, values[at], bound)


def _above_zero(
    name: str, values: list[float], what: str, first: int = 1, cells: list[int] | None = None
) -> Check:
    """Smallest value of all increments from the ``first`` on, above zero; in which of the ``cells``."""
    at = int(np.argmin(values))  # a NaN is the smallest
    place = f"increment {at + first}" if cells is None else f"cell {cells[at]} of increment {at + first}"
    sentence = f"{what} is {values[at]:.3g}, in {place} (allowed: above 0)."
    return Check(name, values[at] > 0.0, sentence, values[at], 0.0)


def _check_balance(increments: list[Increment], unit: str) -> Check:
    """Work of growth against the energies that it went into."""
    known = [i for i in increments if math.isfinite(i.work_error)]
    left_out = len(increments) - len(known)
    why = "halfway on the straight path to their ends a cell is inverted, and the work of growth has no value"
    if increments and not known:
        return Check("energy balance", True, f"Not checked in any increment: {why}.", 0.0, ENERGY_BOUND)
    increments, work = known, math.fsum(abs(i.work) for i in known)
    if work == 0.0:
        return Check("energy balance", True, "Nothing has grown.", 0.0, ENERGY_BOUND)
    shares = {
        name: math.fsum(getattr(i, name) for i in increments) / work
        for name in ("stored", "contact", "external", "dissipated", "work_error")
    }
    created = math.fsum(max(i.defect, 0.0) for i in increments) / work
    lost = math.fsum(max(-i.defect, 0.0) for i in increments) / work
    bound = max(ENERGY_BOUND, shares["work_error"])
    outside = f"{shares['external']:.2%} in the surroundings, " if any(i.external for i in increments) else ""
    sentence = (
        f"Of the work of growth ({work:.4g} {unit}) {shares['stored']:.2%} is stored elastically, "
        f"{shares['contact']:.2%} in contact, {outside}{shares['dissipated']:.2%} dissipated; the increments "
        f"create {created:.2%} and lose {lost:.2%} (error of the work {shares['work_error']:.2g}, allowed to "
        f"create {bound:.2g})."
    )
    if left_out:
        sentence += f" {left_out} increments are left out: {why}."
    return Check("energy balance", created <= bound, sentence, created, bound)
