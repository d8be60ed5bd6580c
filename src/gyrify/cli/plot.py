"""``gyrify plot``: a picture of a run, or of several, for a journal."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Final, Literal

from cyclopts import Parameter

from gyrify.cli.options import number
from gyrify.cli.overrides import Text
from gyrify.cli.streams import print_json, say
from gyrify.errors import ConfigError

What = Literal["folded", "gi", "stress", "thickness", "energy", "mode", "dispersion"]
_SUFFIXES: Final = (".png", ".svg", ".pdf")
_LONGEST_NAME: Final = 80
_FEWEST_DPI, _MOST_DPI = 50, 1200


def plot(
    run_folder: Annotated[Path, Parameter(name="RUN_OR_STUDY", help="Run folder or study folder.")],
    /,
    *,
    what: What = "folded",
    out: Path | None = None,
    at: Text = None,
    compare: Annotated[tuple[Path, ...], Parameter(consume_multiple=True)] = (),
    stress: Literal["von_mises", "mean", "circumferential"] | None = None,
    width: Text = None,
    dpi: int = 300,
    json: bool = False,
    quiet: bool = False,  # noqa: ARG001 - for uniformity
) -> None:
    """Draw a run, or the folded slices of a study in a grid, at journal quality.

    Parameters
    ----------
    what : str
        folded: the slice. gi: indices against growth. stress, thickness: as colour. energy: where the work of
        growth goes. mode: along which stability was lost. dispersion: exact growth at onset of each mode.
    out : Path, optional
        File to write, .png, .svg or .pdf; by default plot-WHAT.png in the folder, named
        after what else was chosen.
    at : str, optional
        Growth time; the nearest stored state is shown, and curves end there.
    compare : Path, optional
        Folders of further runs, shown beside it at one scale: any number of slices, seven for curves.
    stress : str, optional
        The one stress to show instead of three.
    width : str, optional
        Width of the page in mm: one column of most journals is 90, two are 180.
    dpi : int
        Pixels per inch of a .png, and of fields of colour in the others.
    json : bool
        Print what was written as one JSON document.
    quiet : bool
        Show no progress.
    """
    target = out if out is not None else run_folder / default_name(run_folder, what, at, compare, stress)
    _check(target, dpi)
    if what == "dispersion":  # matrices of 200 rows are slower with more threads; numpy is not loaded yet
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from gyrify.report.figures import save_figure
    from gyrify.report.plot import plot as draw
    from gyrify.store.disk_faults import storage_faults

    figure = draw(
        run_folder,
        what,
        compare=compare,
        at=None if at is None else number("--at", at),
        stress=stress,
        width_mm=None if width is None else number("--width", width),
    )
    with storage_faults(target.parent, f"The picture {target}"):
        save_figure(figure, target, dpi=dpi)
    if json:
        print_json({"what": what, "files": [str(target)]})
    else:
        say(str(target))


def default_name(folder: Path, what: str, at: str | None, compare: Sequence[Path], stress: str | None) -> str:
    """Name of a picture: one for each thing that can be shown, so that none replaces another."""
    parts = [f"plot-{what}", *([stress] if stress else []), *([f"at-{at.strip()}"] if at else [])]
    if compare:
        parts += ["with", *(_relative(other, folder) for other in compare)]
    name = re.sub(r"[^\w.-]+", "-", "-".join(parts))
    if len(name) > _LONGEST_NAME:
        digest = hashlib.sha256(name.encode()).hexdigest()[:8]
        name = f"{name[:_LONGEST_NAME]}-{digest}"
    return f"{name}.png"


def _relative(other: Path, folder: Path) -> str:
    """Path of another run, as short as it can be beside this one."""
    try:
        return str(other.resolve().relative_to(folder.resolve().parent))
    except ValueError:
        return str(other).strip("/.")


def _check(target: Path, dpi: int) -> None:
    if target.suffix.lower() not in _SUFFIXES:
        raise ConfigError(
            f"--out {str(target)[-60:]!r} has no suffix that names a format.",
            f"End it with one of: {', '.join(_SUFFIXES)}.",
        )
    if not _FEWEST_DPI <= dpi <= _MOST_DPI:
        raise ConfigError(
            f"--dpi {dpi} is out of range: it must be {_FEWEST_DPI} to {_MOST_DPI}.",
            "Journals ask for 300 to 600.",
        )
