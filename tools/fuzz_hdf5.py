"""Damage the time series of a run: gyrify must refuse it unopened; what HDF5 does with it is told beside.

    python tools/fuzz_hdf5.py [--inputs 100000] [--seed 1] [--out FILE]

HDF5 opens the files in a process of its own, with limits of time and memory. Counts, and where they are
written, are as in tools/fuzz.py; a file that gyrify does not refuse is ``accepted``, and the only fault.
"""

from __future__ import annotations

import argparse
import faulthandler
import sys
import tempfile
from pathlib import Path

from fuzz import RESULTS, Tally
from guard import Outcome, guarded
from hdf5_damage import Damage, stored_run
from hdf5_opening import Opener
from series_target import series_reader, unopened


def campaign(inputs: int, seed: int, out: Path) -> int:
    """Try damaged files; return how many gyrify did not refuse."""
    tally = Tally("hdf5", "damage", seed, out)
    with tempfile.TemporaryDirectory() as name, Opener() as opener:
        folder = Path(name)
        read, source = series_reader(folder), Damage(stored_run()["history.vtkhdf"], seed)
        with unopened():
            for _ in range(inputs):
                data = source.next()
                by_gyrify = guarded(read, data, folder)
                outcome: Outcome = opener.open(folder / "history.vtkhdf")
                if by_gyrify.kind != "refused":
                    outcome = Outcome("accepted", str(by_gyrify), by_gyrify.seconds)
                tally.add(data, outcome)
        tally.write()
    faulthandler.cancel_dump_traceback_later()
    return tally.faults


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=RESULTS)
    given = parser.parse_args()
    return 1 if campaign(given.inputs, given.seed, given.out) else 0


if __name__ == "__main__":
    sys.exit(main())
