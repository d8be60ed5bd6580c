"""Kill runs at random moments, some of them inside a commit, and resume them until they are done.

``python tools/kill_runs.py [--kills 20] [--commits 5] [--seed 0] [--records FILE]`` prints a table and exits
with 1 if an increment that was reported as accepted is lost, or a resumed run ends with another result than
an uninterrupted one. Every run is a process of its own that dies by SIGKILL.

A run that is to die in a commit arms a thread when SQLite begins to execute COMMIT, and is killed 0 to 100
microseconds later. That it died inside is proven twice: a byte of shared memory, set as COMMIT begins and
cleared when it has returned, is still set; and the write-ahead log may end in frames of the dying
transaction that no commit mark closes ("torn").
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import mmap
import os
import random
import shutil
import signal
import struct
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

from gyrify import Config, History, Progress, resume, simulate
from gyrify.cli import main as gyrify
from gyrify.errors import HistoryError
from gyrify.store import Journal

CONFIG = {
    "mesh.n_around": 168,
    "mesh.n_layers": 8,
    "mesh.n_cortex_layers": 4,
    "growth.duration": 600.0,
    "solver.increments": 20,
}
LONGEST_DELAY = 1e-4  # [s]
IN_COMMIT, ACCEPTED = 0, 4  # where the shared memory holds the flag, and the last increment reported


@dataclass
class Trial:
    """One run, its deaths, and what was left of it."""

    number: int
    deaths: list[str]
    accepted: int = 0
    stored: int = 0
    n_lost: int = 0
    result_hash: str = ""


def grow_and_die(folder: Path, shared: mmap.mmap, doom: Callable[[], None]) -> bool:
    """Begin or resume a run in a process that dies; whether it was killed."""
    shared[IN_COMMIT] = 0
    child = os.fork()
    if child == 0:
        with contextlib.suppress(BaseException):
            doom()
            if numbers_stored(folder):
                resume(folder, observers=[lambda progress: report(progress, shared)])
            else:
                watch = [lambda progress: report(progress, shared)]
                simulate(configuration(), folder, observers=watch, overwrite=True)
            os._exit(0)
        os._exit(1)
    status = os.waitpid(child, 0)[1]
    if not (os.WIFSIGNALED(status) or os.WEXITSTATUS(status) == 0):
        raise SystemExit(f"A run in {folder} failed by itself.")
    return os.WIFSIGNALED(status)


def report(progress: Progress, shared: mmap.mmap) -> None:
    """Tell the parent that an increment has been accepted and stored."""
    shared[ACCEPTED : ACCEPTED + 4] = struct.pack("<i", progress.state.index)


def die_after(seconds: float) -> None:
    """Kill this process after a while."""
    signal.signal(signal.SIGALRM, signal.SIG_DFL)

    def strike() -> None:
        time.sleep(seconds)
        os.kill(os.getpid(), signal.SIGKILL)

    threading.Thread(target=strike, daemon=True).start()


def die_in_commit(number: int, delay: float, shared: mmap.mmap) -> None:
    """Kill this process shortly after SQLite begins to execute the COMMIT of its ``number``-th increment."""
    append = Journal.append
    strike, count = threading.Event(), 0

    def wait() -> None:
        strike.wait()
        time.sleep(delay)
        os.kill(os.getpid(), signal.SIGKILL)

    def trace(statement: str) -> None:
        if statement == "COMMIT":
            shared[IN_COMMIT] = 1
            strike.set()

    def append_and_die(journal: Journal, *row: object) -> None:
        nonlocal count
        count += 1
        if count == number:
            journal._connection.set_trace_callback(trace)
        append(journal, *row)  # type: ignore[arg-type]
        shared[IN_COMMIT] = 0

    Journal.append = append_and_die  # type: ignore[method-assign,assignment]
    sys.setswitchinterval(1e-6)
    threading.Thread(target=wait, daemon=True).start()


def torn_frames(journal: Path) -> int:
    """Frames at the end of the write-ahead log that no commit mark closes."""
    log = Path(f"{journal}-wal")
    data = log.read_bytes() if log.exists() else b""
    if len(data) < 32:
        return 0
    page, salts = struct.unpack(">I", data[8:12])[0], data[16:24]
    torn = 0
    for start in range(32, len(data) - 23, 24 + page):
        if data[start + 8 : start + 16] != salts:
            break
        torn = 0 if struct.unpack(">I", data[start + 4 : start + 8])[0] else torn + 1
    return torn


def configuration() -> Config:
    """A slice that folds until its sulci close, in about a second."""
    return Config.preset("reference-slice").with_overrides(CONFIG)


def attempt(number: int, folder: Path, in_commit: bool, seconds: float, chance: random.Random) -> Trial:
    """One run that is killed once or twice, and resumed to its end by the command."""
    trial, shared = Trial(number, []), mmap.mmap(-1, 8)
    journal = folder / "journal.sqlite"
    for _ in range(chance.choice((1, 2))):
        if in_commit:
            target, delay = chance.randint(2, 10), chance.uniform(0.0, LONGEST_DELAY)
            is_dead = grow_and_die(folder, shared, lambda t=target, d=delay: die_in_commit(t, d, shared))
        else:
            moment = chance.uniform(0.0, seconds)
            is_dead = grow_and_die(folder, shared, lambda m=moment: die_after(m))
        if is_dead:
            torn = torn_frames(journal)
            where = f"inside a commit, {torn} torn frames" if shared[IN_COMMIT] else "outside a commit"
            trial.deaths.append(where)
        trial.accepted = struct.unpack("<i", shared[ACCEPTED : ACCEPTED + 4])[0]
        stored = numbers_stored(folder)
        trial.stored = max(0, len(stored) - 1)
        if stored or trial.accepted:
            trial.n_lost += len(set(range(trial.accepted + 1)) - stored)
        in_commit = in_commit and not shared[IN_COMMIT]
    trial.result_hash = finish(folder)
    return trial


def numbers_stored(folder: Path) -> set[int]:
    """Increments that a folder holds; none where the run died before its journal was made."""
    try:
        return set(History.load(folder).journal.column("number"))
    except HistoryError as nothing:
        if "There is no journal" in nothing.message or "before its first state" in nothing.message:
            return set()
        raise


def finish(folder: Path) -> str:
    """Resume by the command, and return the hash in the summary."""
    if not numbers_stored(folder):
        simulate(configuration(), folder, overwrite=True)
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(io.StringIO()):
        code = gyrify(["resume", str(folder), "--json", "--quiet"])
    summary = json.loads(said.getvalue())
    if code != 0 or summary["status"] != "completed":
        raise SystemExit(f"The run in {folder} could not be completed: {summary}")
    return str(summary["result_hash"])


def main() -> int:
    """Kill and resume, print the table, return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--kills", type=int, default=20, help="runs that are killed")
    parser.add_argument("--commits", type=int, default=5, help="runs among them that die inside a commit")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--records", type=Path, help="file to append one JSON line per run to")
    given = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="kill-runs-"))
    try:
        simulate(configuration())  # compiles
        begun = time.perf_counter()
        expected = simulate(configuration(), folder / "whole").result_hash
        seconds = time.perf_counter() - begun
        print(f"uninterrupted: {expected[:12]}, {seconds:.2f} s\n")
        print("run  accepted  stored  lost  same result  deaths")
        trials = []
        for trial in all_trials(folder, given.kills, given.commits, seconds, random.Random(given.seed)):
            trials.append(trial)
            same = "yes" if trial.result_hash == expected else "NO"
            numbers = f"{trial.number:3d}  {trial.accepted:8d}  {trial.stored:6d}  {trial.n_lost:4d}"
            print(f"{numbers}  {same:11}  {'; '.join(trial.deaths)}", flush=True)
            if given.records is not None:
                line = {"route": "run", **asdict(trial), "same": trial.result_hash == expected}
                with given.records.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(line) + "\n")
        return summarise(trials, expected)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def all_trials(
    folder: Path, n_kills: int, n_commits: int, seconds: float, chance: random.Random
) -> Iterator[Trial]:
    """As many runs that died as wanted, and more until enough died inside a commit."""
    trials: list[Trial] = []
    for number in range(1, 4 * n_kills + 20):
        outside_left = n_kills - n_commits - sum(not is_inside(trial) for trial in trials)
        in_commit = n_inside(trials) < n_commits and (outside_left <= 0 or len(trials) % 2 == 1)
        trial = attempt(len(trials) + 1, folder / str(number), in_commit, seconds, chance)
        if trial.deaths:  # else it was done before its moment came
            trials.append(trial)
            yield trial
        if len(trials) >= n_kills and n_inside(trials) >= n_commits:
            return
    raise SystemExit("Too few runs died inside a commit: the machine is too slow or too fast.")


def summarise(trials: list[Trial], expected: str) -> int:
    """Print what it all came to, and return the exit code."""
    deaths = [death for trial in trials for death in trial.deaths]
    inside = [death for death in deaths if death.startswith("inside")]
    torn = sum(" 0 torn" not in death for death in inside)
    wrong = sum(trial.result_hash != expected or trial.n_lost > 0 for trial in trials)
    print(
        f"\n{len(trials)} runs, {len(deaths)} kills, {len(inside)} inside a commit ({torn} with torn frames);"
    )
    print(f"{sum(trial.n_lost for trial in trials)} accepted increments lost, {wrong} runs differ.")
    return 1 if wrong else 0


def is_inside(trial: Trial) -> bool:
    """Whether a run died inside a commit."""
    return any(death.startswith("inside") for death in trial.deaths)


def n_inside(trials: list[Trial]) -> int:
    """Number of runs that died inside a commit."""
    return sum(map(is_inside, trials))


if __name__ == "__main__":
    sys.exit(main())
