"""Give every reader of gyrify hostile input, and count what becomes of it.

    python tools/fuzz.py run TARGET... [--inputs 100000] [--seed 1] [--out FILE]   mutation
    python tools/fuzz.py list                                                      what there is
    python tools/fuzz.py page [FILE]                                               write the table of the page

Every 2000 inputs a line of JSON is added to the file. The process may not use more than 2 GiB of memory
beyond what its libraries take; a watchdog ends it, with a trace, where an input hangs beyond the reach of
signals. Exit code 1 where an input is a fault; it is kept beside the file. The campaign that is guided by
coverage is in tools/fuzz_guided.py.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import resource
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "fuzz"))
sys.dont_write_bytecode = True

if TYPE_CHECKING:
    from target import Target

RESULTS: Final = ROOT / "docs" / "figures" / "fuzz.jsonl"
CHUNK: Final = 2000
ROOM: Final = 2 * 2**30
WATCHDOG_S: Final = 300.0


def limit_memory(room: int = ROOM) -> None:
    """Bound the address space to what is taken now and some room."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    most = pages * resource.getpagesize() + room
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (most, hard))


class Tally:
    """Counts what becomes of inputs, and writes a line for each chunk of them.

    Parameters
    ----------
    target, way : str
        What is read, and how inputs are made.
    seed : int
        Seed of the inputs.
    out : Path
        JSON lines; inputs that are faults go beside it.
    """

    def __init__(self, target: str, way: str, seed: int, out: Path) -> None:
        self.told = {"target": target, "way": way, "seed": seed}
        self.out, self.faults = out, 0
        self._begin()

    def _begin(self) -> None:
        self.kinds: Counter[str] = Counter()
        self.slowest, self.begun = 0.0, time.perf_counter()
        faulthandler.dump_traceback_later(WATCHDOG_S, exit=True)

    def add(self, data: bytes, outcome: Any) -> None:
        """Count one input."""
        self.kinds[outcome.kind] += 1
        self.slowest = max(self.slowest, outcome.seconds)
        if outcome.is_fault:
            self.faults += 1
            if self.faults <= 20:
                name = f"{self.told['target']}-{self.told['seed']}-{self.faults}.input"
                self.out.with_name(name).write_bytes(data)
                print(f"{outcome.kind}: {outcome.told} ({name})", flush=True)
        if self.kinds.total() == CHUNK:
            self.write()

    def write(self) -> None:
        """Write what was counted since the last line."""
        if self.kinds.total():
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            line = {
                **self.told,
                "inputs": self.kinds.total(),
                **dict(sorted(self.kinds.items())),
                "slowest_s": round(self.slowest, 3),
                "peak_MB": round(peak),
                "wall_s": round(time.perf_counter() - self.begun, 1),
            }
            with self.out.open("a", encoding="utf-8") as file:
                file.write(json.dumps(line) + "\n")
        self._begin()


def mutate(target: Target, inputs: int, seed: int, out: Path) -> int:
    """Give a reader mutated inputs; return the number of faults."""
    from guard import guarded
    from mutation import Mutator

    tally = Tally(target.name, "mutation", seed, out)
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        folder = Path(name)
        read: Callable[[bytes], object] = target.prepare(folder)
        stack.enter_context(target.around())
        source = Mutator(target.seeds(), seed, target.words)
        for data in target.seeds():  # loads libraries, which takes longer than any input may
            guarded(read, data, folder, limit=120.0)
        limit_memory()
        met: set[str] = set()
        for _ in range(inputs):
            data = source.next()
            outcome = guarded(read, data, folder)
            tally.add(data, outcome)
            if (novel := f"{outcome.kind} {outcome.told[:60]}") not in met and len(met) < 3000:
                met.add(novel)
                source.keep(data)
        tally.write()
    faulthandler.cancel_dump_traceback_later()
    return tally.faults


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", choices=("run", "list", "page"))
    parser.add_argument("names", nargs="*")
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=RESULTS)
    given = parser.parse_args()
    if given.what == "page":
        from fuzz_page import write_page

        write_page(Path(given.names[0]) if given.names else RESULTS)
        return 0
    from targets import TARGETS

    if given.what == "list":
        for target in TARGETS.values():
            print(f"{target.name:10} {target.what}")
        return 0
    faults = [mutate(TARGETS[name], given.inputs, given.seed, given.out) for name in given.names or TARGETS]
    return 1 if any(faults) else 0


if __name__ == "__main__":
    sys.exit(main())
