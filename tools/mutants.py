"""Break the physics on purpose, one mistake at a time, and see that the tests notice.

Each mutant is one plausible mistake. It is made in a copy of the tree, and the tests named with it are run
there: a mutant that no test fails on has survived, which is a hole in the tests. Before that, the tests must
pass on the unbroken copy.

    python tools/mutants.py                 every mutant (about five minutes on two cores)
    python tools/mutants.py --only NAME     one of them
    python tools/mutants.py --list          names and reasons
    python tools/mutants.py --json FILE     write the table as JSON too

Exit code 0: all killed; 1: some survived, do not apply, or break the import instead of a test.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TIMEOUT = 300


@dataclass(frozen=True)
class Mutant:
    """One mistake.

    Attributes
    ----------
    name : str
        What is wrong.
    file : str
        Where, below src/gyrify.
    edits : tuple of (str, str)
        Old text, which occurs exactly once, and new text.
    why : str
        How such a mistake comes about, or what it does.
    tests : tuple of str
        Tests that must notice.
    """

    name: str
    file: str
    edits: tuple[tuple[str, str], ...]
    why: str
    tests: tuple[str, ...]


def read_mutants() -> tuple[Mutant, ...]:
    """The mistakes of mutants.toml."""
    tables = tomllib.loads((ROOT / "tools" / "mutants.toml").read_text(encoding="utf-8"))["mutant"]
    return tuple(
        Mutant(t["name"], t["file"], tuple(map(tuple, t["edits"])), t["why"], tuple(t["tests"]))
        for t in tables
    )


MUTANTS = read_mutants()


def text_of(mutant: Mutant, tree: Path) -> str:
    """Text of the broken file; raises ValueError where an edit does not apply."""
    text = (tree / "src" / "gyrify" / mutant.file).read_text(encoding="utf-8")
    for old, new in mutant.edits:
        if text.count(old) != 1:
            raise ValueError(f"{mutant.name}: {old!r} occurs {text.count(old)} times in {mutant.file}")
        text = text.replace(old, new)
    return text


def copy_tree(folder: Path) -> Path:
    """Copy of the sources and tests, without caches."""
    ignore = shutil.ignore_patterns("__pycache__", "*.nbi", "*.nbc")
    for name in ("src", "tests", "examples", "tools"):
        shutil.copytree(ROOT / name, folder / name, ignore=ignore)
    shutil.copy2(ROOT / "pyproject.toml", folder)
    return folder


def run_tests(tree: Path, tests: tuple[str, ...], cache: Path, seconds: float = TIMEOUT) -> tuple[int, str]:
    """Exit code of pytest in a tree, and the end of what it says; 124 when it takes too long."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(tree / "src"),  # comes before an editable install
        "PYTHONDONTWRITEBYTECODE": "1",
        "NUMBA_CACHE_DIR": str(cache),
        "OMP_NUM_THREADS": "1",
    }
    where = subprocess.run(
        [sys.executable, "-c", "import gyrify; print(gyrify.__file__)"],
        env=environment, cwd=tree, capture_output=True, text=True, check=True,
    )  # fmt: skip
    if not Path(where.stdout.strip()).is_relative_to(tree):
        raise RuntimeError(f"the tests would run on {where.stdout.strip()}, not on the copy")
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-m", "not slow", *tests]
    try:
        done = subprocess.run(
            command, env=environment, cwd=tree, capture_output=True, text=True, timeout=seconds
        )
    except subprocess.TimeoutExpired:
        return 124, "took too long"
    return done.returncode, done.stdout[-2000:]


@dataclass(frozen=True)
class Outcome:
    """What became of a mutant: ``killed``, ``survived``, or ``broken`` (no test could be run)."""

    name: str
    outcome: str
    by: str
    seconds: float


def judge(mutant: Mutant, tree: Path) -> Outcome:
    """Break the tree, run the tests, mend the tree."""
    file = tree / "src" / "gyrify" / mutant.file
    before, begun = file.read_bytes(), time.perf_counter()
    stamp = file.stat()
    try:
        file.write_text(text_of(mutant, tree), encoding="utf-8")
        with tempfile.TemporaryDirectory() as fresh:
            cache = Path(fresh) if is_compiled(before.decode()) else tree / "cache"
            code, said = run_tests(tree, mutant.tests, cache)
    finally:
        file.write_bytes(before)
        os.utime(file, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    by = ", ".join(re.findall(r"^FAILED \S+::(\S+)", said, flags=re.MULTILINE))
    outcome = {0: "survived", 1: "killed", 124: "killed"}.get(code, "broken")
    return Outcome(mutant.name, outcome, by or said.strip().splitlines()[-1], time.perf_counter() - begun)


def is_compiled(source: str) -> bool:
    """Whether numba compiles some of a file: its cache does not see every change in what it has built in."""
    return "njit" in source or "overload" in source


def judge_all(mutants: list[Mutant], jobs: int) -> list[Outcome]:
    """Outcome of every mutant, in order; each job breaks a copy of its own."""
    with tempfile.TemporaryDirectory() as folder:
        trees: queue.SimpleQueue[Path] = queue.SimpleQueue()
        for number in range(jobs):
            trees.put(copy_tree(Path(folder).resolve() / str(number)))
        needed = tuple(sorted({test for mutant in mutants for test in mutant.tests}))

        def work(mutant: Mutant | None) -> Outcome | str:
            tree = trees.get()
            try:
                if mutant is None:
                    code, said = run_tests(tree, needed, tree / "cache", 10.0 * TIMEOUT)
                    return "" if code == 0 else said
                outcome = judge(mutant, tree)
                print(
                    f"{outcome.outcome:9} {outcome.name:38} {outcome.seconds:5.1f} s  {outcome.by}",
                    flush=True,
                )
                return outcome
            finally:
                trees.put(tree)

        with ThreadPoolExecutor(jobs) as pool:
            # every job at once, so that each copy is tried and its kernels are compiled
            failures = [said for said in pool.map(work, [None] * jobs) if said]
            if failures:
                raise SystemExit(f"The tests fail before anything is broken:\n{failures[0]}")
            return [outcome for outcome in pool.map(work, mutants) if isinstance(outcome, Outcome)]


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--only", action="append", metavar="NAME", choices=[m.name for m in MUTANTS])
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--json", type=Path, metavar="FILE")
    options = parser.parse_args()
    chosen = [m for m in MUTANTS if not options.only or m.name in options.only]
    if options.list:
        print("\n".join(f"{m.name:38} {m.file:28} {m.why}" for m in chosen))
        return 0
    for m in chosen:
        text_of(m, ROOT)
    outcomes = judge_all(chosen, options.jobs)
    killed = sum(outcome.outcome == "killed" for outcome in outcomes)
    print(f"{killed} of {len(outcomes)} mutants killed")
    if options.json:
        table = [asdict(m) | asdict(o) for m, o in zip(chosen, outcomes, strict=True)]
        options.json.write_text(json.dumps(table, indent=1), encoding="utf-8")
    return 0 if killed == len(outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
