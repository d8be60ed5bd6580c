"""Measures gyrify, alone and beside other libraries: ``python benchmarks --help``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from bench.environment import ROOT, enter, is_inside

PAGES = (ROOT / "docs" / "speed.md", ROOT / "docs" / "planning-3d.md")


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python benchmarks", description=__doc__)
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these benchmarks, slow ones too")
    parser.add_argument("--all", action="store_true", help="the slow ones too: half an hour")
    parser.add_argument("--quick", action="store_true", help="small slices: shows that everything works")
    parser.add_argument("--list", action="store_true", help="the names, and nothing else")
    parser.add_argument("--no-history", action="store_true", help="leave benchmarks/history.jsonl as it is")
    parser.add_argument(
        "--page",
        nargs="*",
        type=Path,
        metavar="FILE",
        help="write the tables of pages from the history, measure nothing",
    )
    return parser.parse_args()


def main() -> int:
    """Run the command."""
    options = _options()
    if not is_inside():
        return enter()
    if options.page is not None:
        from bench.chart import draw
        from bench.page import refresh

        draw()
        for path in options.page or PAGES:
            refresh(path)
        return 0
    from bench.cases import CASES
    from bench.run import run

    if options.list:
        for name, case in CASES.items():
            print(f"{name:10} {case.title}{' (slow)' if case.is_slow else ''}")
        return 0
    unknown = [name for name in options.only or () if name not in CASES]
    if unknown:
        print(f"There is no benchmark {unknown[0]!r}; choose from {', '.join(CASES)}.", file=sys.stderr)
        return 2
    names = options.only or [name for name, case in CASES.items() if options.all or not case.is_slow]
    return run(names, quick=options.quick, keep=not options.no_history)


if __name__ == "__main__":
    sys.exit(main())
