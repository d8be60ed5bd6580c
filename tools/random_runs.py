"""Run random valid configurations, recheck each from its stored files, and say what became of every one.

``python tools/random_runs.py runs.jsonl [--space wide] [--first 0] [--count 30] [--seed 0] [--workers 1]``
appends one line per configuration and goes on where it was stopped; ``python tools/reliability.py`` makes the
tables of the reliability page from such files. It exits with 1 if a run is wrong or unexplained.

Every run is made by the command ``gyrify run``, with all its files. It is

- completed: it reached the end of growth, exit code 0, and every check of ``gyrify verify`` holds;
- stopped: it ended early for a reason of the tissue, with its evidence, and all that it stored holds;
- exhausted: the solver gave up (one of `EXHAUSTED`), said so, and all that it stored holds: no convergence;
- wrong: anything else, such as a check that fails, a status that contradicts the exit code, or an ending that
  is not on the list.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parent))

from random_configurations import SPACES, configuration

from gyrify import Config, History
from gyrify.base.pool import Watcher, each, go_on
from gyrify.cli import main as gyrify
from gyrify.cli.codes import COMPLETED, FAILED, INTERRUPTED
from gyrify.cli.codes import STOPPED as LIMITED
from gyrify.errors import GyrifyError
from gyrify.solve.result import Result
from gyrify.verify import verify

Record = dict[str, Any]
# Reasons by a part of their sentence: the closed list. What stops in the tissue, and what in the solver.
STOPPED: Final = {"unstable": "Buckling instability"}
EXHAUSTED: Final = {
    **{result.name.lower(): result.message for result in Result if result is not Result.CONVERGED},
    "branch_lost": "An unstable equilibrium could not be left",
    "no_eigenvalue": "The lowest eigenvalue of the stiffness was not found",
    "no_factor": "could not factorise the stiffness matrix",
    "pardiso": "PARDISO failed",
    "no_shift": "No shift makes the stiffness positive definite",
    "wall_time": "The wall-time limit",
}
EXIT_CODES: Final = {"completed": COMPLETED, "failed": FAILED, "stopped": LIMITED}
LONGEST: Final = 900.0  # [s] of one run


def run_one(job: tuple[str, int, int], watch: Watcher = go_on) -> Record:
    """One configuration, from its draw to what became of it."""
    watch()
    space, seed, number = job
    config = configuration(space, seed, number)
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="random-run-") as folder:
        record = carry_out(config, Path(folder))
    record["wall_s"] = round(time.perf_counter() - begun, 2)
    return {"space": space, "seed": seed, "number": number, **record, "config": differences(config)}


def carry_out(config: Config, folder: Path) -> Record:
    """Run by the command, read back, recheck and classify."""
    file, run = folder / "config.toml", folder / "run"
    limited = config.with_overrides({"limits.wall_time": LONGEST})
    file.write_text(limited.to_toml(), encoding="utf-8")
    out, err = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = gyrify(["run", str(file), "--out", str(run), "--json", "--quiet"])
        if code == INTERRUPTED:
            raise KeyboardInterrupt
        summary, history = json.loads(out.getvalue()), History.load(run)
        failed = [f"{check.name}: {check.sentence}" for check in verify(run).checks if not check.passed]
        found = evidence(history, summary)
    except Exception as error:  # whatever it is, it is what the campaign looks for
        told = f"{type(error).__name__}: {error} {err.getvalue()[-500:]}"
        return {"outcome": "wrong", "reason": "", "said": told, "config_hash": config.config_hash}
    record = {
        "status": summary["status"],
        "exit_code": code,
        "reason": name_of(summary["reason"]),
        "said": summary["reason"],
        "failed_checks": failed + contradictions(summary, config, run),
        "evidence": found,
        "config_hash": summary["config_hash"],
    }
    return {"outcome": outcome(record), **record}


def name_of(reason: str) -> str:
    """Name on the closed list of the reason that a run gives; empty where it is on none."""
    known = {**STOPPED, **EXHAUSTED}
    return next((name for name, part in known.items() if part in reason), "")


def contradictions(summary: Record, config: Config, run: Path) -> list[str]:
    """What a run says of itself that cannot be."""
    found = []
    if summary["config_hash"] != config.config_hash:
        found.append("hash: the run is of another configuration.")
    if not (summary["min_J"] > 0.0 and summary["min_J_elastic"] > 0.0):
        found.append("volume: the last state has an inverted cell.")
    if config.contact.enabled and summary["self_intersecting"]:
        found.append("contour: the last state crosses itself.")
    if not summary["gi"]["closing"] > 0.0:
        found.append("index: the gyrification index is no number.")
    if (summary["status"] == "completed") == bool(summary["reason"]):
        found.append("reason: there is one exactly where a run did not complete.")
    if not all((run / name).is_file() for name in ("folded.png", "metrics.csv", "history.vtkhdf")):
        found.append("files: some are missing.")
    return found


def outcome(record: Record) -> str:
    """Class of a run; see the top of this file."""
    if record["failed_checks"] or EXIT_CODES.get(record["status"]) != record["exit_code"]:
        return "wrong"
    if record["status"] == "completed":
        return "completed"
    if record["reason"] in STOPPED and record["evidence"]["lowest_eigenvalue"] is not None:
        return "stopped"
    return "exhausted" if record["reason"] in EXHAUSTED else "wrong"


def evidence(history: History, summary: Record) -> Record:
    """Numbers of the last accepted state that tell why there is none after it."""
    solver = summary["solver"]
    found = {
        "growth": float(history.fractions[-1]),
        "min_J": summary["min_J"],
        "min_J_elastic": summary["min_J_elastic"],
        "min_gap_mm": summary["min_gap_mm"],
        "residual_over_tolerance": solver["residual"] / solver["tolerance"],
        "gi": summary["gi"]["closing"],
        "n_gyri": summary["n_gyri"],
        "increments": solver["increments"],
        "newton_iterations": solver["newton_iterations"],
        "rejected": solver["rejected"],
        "lowest_eigenvalue": None,
    }
    if history.status != "completed" and len(history) > 1:
        found["lowest_eigenvalue"] = lowest_eigenvalue(history)
    return found


def lowest_eigenvalue(history: History) -> float | None:
    """Of the tissue's stiffness at the last accepted state [Pa/mm^2]; None where no solver finds it."""
    problem, state = history.slice, history.journal.state(len(history) - 1)
    system = problem.system(state.couplings)
    with contextlib.suppress(GyrifyError):
        tangent = problem.tangent(state.position / problem.stepping.end, state.u, state.u_before, system)
        return float(tangent.lowest().eigenvalue)
    return None


def differences(config: Config) -> Record:
    """Values by dotted key that are not those of the standard slice."""
    base, given = Config.preset("reference-slice").to_dict(), config.to_dict()
    found = {}
    for section, values in given.items():
        if isinstance(values, dict):
            found.update({f"{section}.{k}": v for k, v in values.items() if v != base[section][k]})
        elif values != base[section]:
            found[section] = values
    return found


def lost(job: tuple[str, int, int]) -> Record:
    """What becomes of a configuration whose process dies over it."""
    space, seed, number = job
    config = differences(configuration(*job))
    told = {"outcome": "wrong", "reason": "", "said": "Its process died."}
    return {"space": space, "seed": seed, "number": number, **told, "config": config}


def read(path: Path) -> list[Record]:
    """Records of a file; a last line that was cut off is none."""
    if not path.exists():
        return []
    records = []
    for line in path.read_text(encoding="utf-8").splitlines():
        with contextlib.suppress(ValueError):
            records.append(json.loads(line))
    return records


def campaign(path: Path, jobs: list[tuple[str, int, int]], workers: int) -> Iterator[Record]:
    """Run what a file does not hold yet, append it line by line, and yield each."""
    known = {(record["space"], record["seed"], record["number"]) for record in read(path)}
    todo = [job for job in jobs if job not in known]
    if path.exists() and path.read_bytes()[-1:] not in (b"", b"\n"):
        path.write_text("".join(json.dumps(record) + "\n" for record in read(path)), encoding="utf-8")
    with (
        path.open("a", encoding="utf-8") as file,
        contextlib.closing(each(run_one, todo, workers, lost)) as found,
    ):
        for record in found:
            file.write(json.dumps(record) + "\n")
            file.flush()
            yield record


def line(record: Record) -> str:
    """A record in one line."""
    told = "; ".join(record.get("failed_checks", [])) or record["said"]
    numbers = f"{record['number']:4d} {record['outcome']:9} {record['reason']:12}"
    return f"{numbers} {record.get('wall_s', 0.0):6.1f} s  {told}".rstrip()


def main() -> int:
    """Run, print a line each, and return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("records", type=Path, help="file of JSON lines to continue")
    parser.add_argument("--space", choices=SPACES, default="wide")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=1)
    given = parser.parse_args()
    jobs = [(given.space, given.seed, given.first + number) for number in range(given.count)]
    for record in campaign(given.records, jobs, given.workers):
        print(line(record), flush=True)
    mine = [r for r in read(given.records) if (r["space"], r["seed"], r["number"]) in set(jobs)]
    counts = Counter(record["outcome"] for record in mine)
    print(", ".join(f"{count} {name}" for name, count in sorted(counts.items())))
    return 1 if counts["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main())
