"""``gyrify animate``: growth as a GIF or an MP4."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

from gyrify.cli.options import number
from gyrify.cli.overrides import Text
from gyrify.cli.stored import RunFolder
from gyrify.cli.streams import print_json, say

Field = Literal[
    "tissue", "von_mises", "mean_stress", "circumferential_stress", "growth_stretch", "J", "J_elastic"
]


def animate(
    run_folder: RunFolder,
    /,
    *,
    out: Path | None = None,
    field: Field = "tissue",
    fps: Text = None,
    seconds: Text = None,
    width: int = 640,
    json: bool = False,
    quiet: bool = False,
) -> None:
    """Show growth as a moving picture, with growth time, gyrification index and scale bar.

    Parameters
    ----------
    out : Path, optional
        File to write, .gif or .mp4 (which needs the extra video); by default growth.gif in the run folder, or
        growth-FIELD.gif.
    field : str
        What colours the slice: its tissues, or a field of its cells.
    fps : str, optional
        Frames per second, 15 by default.
    seconds : str, optional
        Duration of growth in the animation, 6 by default.
    width : int
        Width in pixels.
    json : bool
        Print what was written as one JSON document.
    quiet : bool
        Show no progress.
    """
    from gyrify.report.animate import animate as write

    given = {"fps": fps, "seconds": seconds}
    chosen = {name: number(f"--{name}", text) for name, text in given.items() if text is not None}
    name = "growth.gif" if field == "tissue" else f"growth-{field}.gif"
    target = out if out is not None else run_folder / name
    with _progress(quiet) as observe:
        write(run_folder, target, field=field, width=width, observe=observe, **chosen)
    size = target.stat().st_size
    if json:
        print_json({"files": [str(target)], "bytes": size})
    else:
        say(f"{target} ({size / 1e6:.1f} MB)")


@contextmanager
def _progress(quiet: bool) -> Iterator[Callable[[int, int], None] | None]:
    """A bar on a terminal, and nothing elsewhere: it is a matter of seconds."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("drawing", total=None)
        yield lambda done, count: bar.update(task, completed=done, total=count)
