"""Hostile input guided by coverage, with atheris; a tool of the campaign, not a dependency of gyrify.

    python -m venv .venv-fuzz && .venv-fuzz/bin/pip install -c constraints.txt . atheris
    .venv-fuzz/bin/python tools/fuzz_guided.py TARGET [--inputs 20000] [--seed 1] [--out FILE]

Only gyrify itself is instrumented, and of it not what is compiled, which reads nothing. What is counted, and
where it is written, is as in tools/fuzz.py.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
from pathlib import Path

import atheris
from fuzz import RESULTS, ROOT, Tally, limit_memory

SOURCES = ROOT / "src"
COMPILED = [
    ".".join(file.relative_to(SOURCES).with_suffix("").parts)
    for name in ("energy", "physics")
    for file in (SOURCES / "gyrify" / name).rglob("[!_]*.py")
]

with atheris.instrument_imports(include=["gyrify"], exclude=COMPILED):
    from guard import guarded
    from targets import TARGETS


def main() -> None:
    """Run the command line; libFuzzer ends the process."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("name", choices=[*TARGETS])
    parser.add_argument("--inputs", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=RESULTS)
    given = parser.parse_args()
    target, folder = TARGETS[given.name], Path(tempfile.mkdtemp())
    corpus, work = folder / "corpus", folder / "work"
    corpus.mkdir()
    work.mkdir()
    read = target.prepare(work)
    tally = Tally(target.name, "coverage", given.seed, given.out.resolve())
    for number, data in enumerate(target.seeds()):
        (corpus / str(number)).write_bytes(data)
        guarded(read, data, work, limit=120.0)
    limit_memory()
    count = 0

    def one(data: bytes) -> None:
        nonlocal count
        count += 1
        tally.add(data, guarded(read, data, work))
        if count == given.inputs:  # libFuzzer does not return
            tally.write()
            shutil.rmtree(folder, ignore_errors=True)
            os._exit(1 if tally.faults else 0)

    options = [f"-seed={given.seed}", "-rss_limit_mb=0", "-timeout=0", "-max_len=8192", "-verbosity=0"]
    with target.around():
        atheris.Setup([sys.argv[0], *options, str(corpus)], one)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
