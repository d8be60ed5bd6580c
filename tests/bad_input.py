"""Bad inputs and the message each one gets: the source of a test and of docs/bad-input.md.

``python tests/bad_input.py`` rewrites the page. To add a case, append it to a list in `GROUPS`.
"""

# One case a line reads as the table that it is.
# ruff: noqa: E501

from __future__ import annotations

import contextlib
import functools
import io
import re
import tempfile
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

import bad_runs
from bad_runs import RUN

from gyrify.cli import main

PAGE = Path(__file__).parents[1] / "docs" / "bad-input.md"
CHECK = ("config", "check")


@dataclass(frozen=True)
class Case:
    """One bad input.

    Attributes
    ----------
    id : str
        Short name.
    what : str
        What is wrong, for the page.
    expected : tuple of str
        What the message must contain.
    toml : str or bytes or None
        Content of the file ``config.toml`` in the working folder; it is then the last argument.
    args : tuple of str
        Arguments of the command line.
    exit_code : int
        The exit code it must get.
    prepare : callable, optional
        Sets the scene in the working folder, which is given as its argument.
    scene : callable, optional
        The same for a scene that must be cleared away.
    shown : str
        What the page shows instead of the file and the arguments.
    foreign : bool
        The wording comes from a library and may change with its version.
    """

    id: str
    what: str
    expected: tuple[str, ...]
    toml: str | bytes | None = None
    args: tuple[str, ...] = CHECK
    exit_code: int = 2
    prepare: Callable[[Path], object] | None = None
    scene: Callable[[Path], AbstractContextManager[None]] = contextlib.nullcontext
    shown: str = ""
    foreign: bool = False

    def input(self) -> str:
        """Return the input as the page shows it."""
        if self.shown:
            return self.shown
        text = self.toml if self.toml is not None else "gyrify " + " ".join(self.args)
        lines = str(text).strip().splitlines() if isinstance(text, str) else [repr(text)[1:]]
        return "<br>".join(f"`{line}`" for line in lines)


def provoke(case: Case, folder: Path) -> tuple[int, str]:
    """Run a case in an empty folder, which becomes the working directory; return exit code and stderr but for warnings."""
    if case.toml is not None:
        data = case.toml.encode() if isinstance(case.toml, str) else case.toml
        (folder / "config.toml").write_bytes(data)
    if case.prepare is not None:
        case.prepare(folder)
    arguments = [*case.args, *(["config.toml"] if case.toml is not None else [])]
    stderr = io.StringIO()
    with (
        contextlib.chdir(folder),
        case.scene(folder),
        contextlib.redirect_stderr(stderr),
        contextlib.redirect_stdout(io.StringIO()),
    ):
        code = main(arguments)
    lines = stderr.getvalue().splitlines(keepends=True)
    return code, "".join(line for line in lines if not line.startswith("gyrify: Warning: "))


def assign(*pairs: str) -> tuple[str, ...]:
    """Return the arguments that set values on the command line."""
    return (*CHECK, *(word for pair in pairs for word in ("--set", pair)))


VALUES = [
    Case("negative", "a ratio that is not positive", ("growth.ratio = -3.6", "0.1 to 10000", "default is 3.6"), "[growth]\nratio = -3.6"),
    Case("zero", "a length that is not positive", ("geometry.area = 0 ", "above 0", "mm²"), "[geometry]\narea = 0"),
    Case("absurd", "an absurd value", ("material.young_modulus = 1e+30", "at most 1e+13"), "[material]\nyoung_modulus = 1e30"),
    Case("nan", "not a number", ("growth.rate = nan",), "[growth]\nrate = nan"),
    Case("infinite", "infinity", ("growth.duration = inf",), "[growth]\nduration = inf"),
    Case("incompressible", "a Poisson ratio of exactly 0.5", ("material.poisson_ratio = 0.5", "above -1 and below 0.5"), "[material]\npoisson_ratio = 0.5"),
    Case("fractional-count", "a count that is not whole", ("mesh.n_around = 216.5", "whole number from 24 to 4096"), "[mesh]\nn_around = 216.5"),
    Case("boolean", "true where a number belongs", ("growth.ratio = true", "a number"), "[growth]\nratio = true"),
    Case("quoted", "a number in quotes", ('growth.ratio = "3"', "without quotes"), '[growth]\nratio = "3"'),
    Case("one-for-true", "a number where true or false belongs", ("contact.enabled = 1", "true or false"), "[contact]\nenabled = 1"),
    Case("zero-division", "a fraction that divides by zero", ('"1/0"', "divides by zero"), '[material]\nstiffness_ratio = "1/0"'),
    Case("code", "code in place of a number", ("__import__", "a number looks like"), '[growth]\nratio = "__import__(\'os\').getcwd()/1"'),
    Case("word", "a word that is not a choice", ('"elipse"', 'Did you mean "ellipse"?'), '[geometry]\nshape = "elipse"'),
    Case("neither", "neither a number nor the word", ("contact.barrier_stiffness", 'or "auto"'), '[contact]\nbarrier_stiffness = "automatic"'),
    Case("list", "an unknown output field", ('"stress"', "cauchy_stress"), '[output]\nfields = ["stress"]'),
    Case("date", "a date", ("seed = 2019-02-13", "whole number"), "seed = 2019-02-13"),
    Case("huge", "a huge whole number", ("a huge whole number", "4294967295"), f"seed = 0x{'f' * 100}", shown="`seed = 0xfff…` (100 digits)"),
    Case("schema", "a format of another version", ("schema_version = 2",), "schema_version = 2"),
]  # fmt: skip
TOGETHER = [
    Case("no-white-matter", "no white matter left", ("cortical_thickness = 16.0", "15.6053 [mm]", "Try geometry.cortical_thickness = 14.7"), "[geometry]\ncortical_thickness = 16"),
    Case("no-white-layer", "no white layer left", ("n_cortex_layers = 17", "n_layers = 17", "at most 16"), "[mesh]\nn_cortex_layers = 17"),
    Case("too-many-cells", "more cells than fit", ("cells are not allowed", "n_around"), "[mesh]\nn_around = 4096\nrefine = 4"),
    Case("too-much-growth", "absurd growth", ("growth.rate × growth.duration = 500", "at most 10"), "[growth]\nrate = 1"),
    Case("no-file", "a surface without a file", ("not allowed without geometry.file", "surface.stl"), '[geometry]\nshape = "surface"'),
    Case("lost-file", "a surface that is not there", ('geometry.file = "brain.stl": there is no such file', "relative to the configuration file"), '[geometry]\nshape = "surface"\nfile = "brain.stl"'),
    Case("open-surface", "a surface with a hole", ("is not closed: 3 edges", "Close its holes"), '[geometry]\nshape = "surface"\nfile = "brain.off"\ncortical_thickness = 1', prepare=functools.partial(bad_runs.write_tetrahedron, n_faces=3)),
    Case("broken-volume", "tetrahedra that are cut short", ("damaged or cut short", "Save it again"), '[geometry]\nshape = "volume"\nfile = "brain.mesh"\ncortical_thickness = 5', prepare=functools.partial(bad_runs.write_volume, share=0.5)),
    Case("labels", "labels that the tetrahedra do not have", ("label 1, which geometry.labels names nowhere", "Name each label"), '[geometry]\nshape = "volume"\nfile = "brain.mesh"\ncortical_thickness = 5\nlabels = {grey = [2], white = [3]}', prepare=bad_runs.write_volume),
    Case("plane", "a plane of symmetry that the body crosses", ("lies on both sides of boundary.plane", "cut the body there"), '[geometry]\nshape = "volume"\nfile = "brain.mesh"\ncortical_thickness = 5\n[boundary]\nclamp = "plane"', prepare=bad_runs.write_volume),
    Case("increment", "a smallest increment above the planned one", ("solver.min_increment = 0.5", "1/solver.increments = 0.01"), "[solver]\nmin_increment = 0.5"),
    Case("branch", "a branch to follow that is not looked for", ("stability.follow_branch", "stability.detect = true"), "[stability]\ndetect = false\nfollow_branch = true"),
    Case("several", "several faults at once", ("growth.ratio = 0", "seed = -1", "mash", "Did you mean mesh?"), "seed = -1\n[growth]\nratio = 0\n[mash]"),
]  # fmt: skip
KEYS = [
    Case("key", "a misspelt key", ("growth.ratoi is not a known key", "growth.ratio"), "[growth]\nratoi = 3.6"),
    Case("section", "a misspelt section", ("materials is not a known key", "Did you mean material?"), "[materials]\npoisson_ratio = 0.4"),
    Case("misplaced", "a key of another section", ("Did you mean material.stiffness_ratio?",), "[growth]\nstiffness_ratio = 2"),
    Case("no-section", "a value in place of a section", ("growth = 3.6", "it must be a table", "[growth]"), "growth = 3.6"),
    Case("control", "control characters in a key", ("\\x1b[31m is not a known key",), '"\\u001b[31m" = 1'),
]  # fmt: skip
FILES = [
    Case("missing", "a file that does not exist", ("absent.toml does not exist",), args=(*CHECK, "absent.toml")),
    Case("directory", "a folder", ("is not a regular file",), args=(*CHECK, ".")),
    Case("truncated", "truncated TOML", ("not valid TOML", "complete that line"), '[growth]\nratio = "1/1.', foreign=True),
    Case("twice", "a key given twice", ("not valid TOML", "overwrite"), "seed = 1\nseed = 2", foreign=True),
    Case("latin-1", "text that is not UTF-8", ("not UTF-8", "byte 2"), b"# \xe9t\xe9"),
    Case("binary", "a binary file", ("not valid TOML",), b"\x00\x01\x02\x03", foreign=True),
    Case("large", "a file that is far too large", ("larger than 64 KiB",), "#" * 70_000, shown="70 000 characters"),
    Case("deep", "brackets nested without end", ("nested too deeply",), "seed = " + "[" * 30_000, shown="`seed = [[[…` (30 000 brackets)"),
    Case("digits", "a number of 5000 digits", ("too many digits",), "seed = " + "9" * 5000, shown="`seed = 999…` (5000 digits)"),
]  # fmt: skip
COMMAND_LINE = [
    Case("preset", "a preset that does not exist", ("available are converged-slice, reference-brain, reference-slice, wang2019", "Did you mean wang2019?"), args=(*CHECK, "--preset", "wang2018")),
    Case("preset-in-file", "a preset in a file that does not exist", ("does not exist",), 'preset = "../../secret"'),
    Case("option-value", "a bad value of an option", ("growth.ratio = -3 ",), args=(*CHECK, "--growth-ratio", "-3")),
    Case("slivers", "layers far too thin for their columns", ("quality 0.011", "too wide", "Try mesh.n_around = "), args=(*CHECK, "--thickness", "0.05")),
    Case("axial-power", "a power of growth along z where there is none", ("out_of_plane_exponent = 0.5", "no growth along z", "Try"), '[growth]\nout_of_plane = "none"\nout_of_plane_exponent = 0.5'),
    Case("axial-patches", "an element that has no free stretch along z", ("growth.out_of_plane", "mean_dilatation", "Try"), '[growth]\nout_of_plane = "generalised"\n[mesh]\nelement = "mean_dilatation"'),
    Case("cortex-refined-too-often", "more refinements of the cortex than white layers", ("mesh.refine_cortex = 4", "3 white"), "[mesh]\nn_layers = 9\nrefine_cortex = 4"),
    Case("symmetric-columns", "columns that cannot be symmetric", ("mesh.split", "4 must divide", "n_around = 60 or 64"), "[mesh]\nn_around = 62\nsplit = \"symmetric\""),
    Case("symmetric-branch", "a branch to follow that may break the symmetry", ("mesh.split", "follow_branch", "alternating"), "[mesh]\nsplit = \"symmetric\"\n[dissipation]\nkind = \"none\"\n[stability]\nfollow_branch = true"),
    Case("option-word", "a word for a number", ("geometry.cortical_thickness", '"thick"'), args=(*CHECK, "--thickness", "thick")),
    Case("set-key", "an unknown key on the command line", ("Did you mean growth.ratio?",), args=assign("growth.ratoi=2")),
    Case("set-form", "an assignment without a value", ("is not an assignment", "section.field=value"), args=assign("growth.ratio")),
    Case("set-section", "a section on the command line", ("growth is a section",), args=assign("growth=2")),
    Case("given-twice", "two values for one key", ("given twice: 2 and 3",), args=(*CHECK, "--growth-ratio", "2", "--set", "growth.ratio=3")),
    Case("option", "an unknown option", ("--growth-ratoi", "--help"), args=(*CHECK, "--growth-ratoi", "2"), foreign=True),
    Case("command", "an unknown command", ('Did you mean "check"?',), args=("config", "chekc"), foreign=True),
]  # fmt: skip
STORED = [
    Case("holds-run", "an output folder that holds another run", ("run already holds a run of another configuration", "growth.ratio is 3.6 there and 2.0 here", "--overwrite", "gyrify resume run"), args=(*RUN, "run", "--growth-ratio", "2"), prepare=bad_runs.stored, shown="`gyrify run --growth-ratio 2 --out run`"),
    Case("out-file", "an output folder that is a file", ("notes.txt is a file", "--out"), args=(*RUN, "notes.txt"), prepare=bad_runs.file_in_the_way, shown="`gyrify run --out notes.txt`"),
    Case("out-under-file", "an output folder under a file", ("notes.txt is a file", "--out"), args=(*RUN, "notes.txt/run"), prepare=bad_runs.file_in_the_way, shown="`gyrify run --out notes.txt/run`"),
    Case("read-only", "an output folder that is read-only", ("locked/run cannot be written: Permission denied", "--out"), args=(*RUN, "locked/run"), scene=bad_runs.read_only, shown="`gyrify run --out locked/run`"),
    Case("in-use", "an output folder that another process works in", ("in use by process 4242 on node-7", "Wait"), args=(*RUN, "run", "--overwrite"), scene=bad_runs.in_use, shown="`gyrify run --out run --overwrite`"),
    Case("full-disk", "a disk that is full before the run is done: what was accepted is kept", ("run/journal.sqlite", "space", "gyrify resume"), args=(*RUN, "run"), exit_code=1, scene=functools.partial(bad_runs.full_disk, room=60_000), shown="`gyrify run --out run`", foreign=True),
    Case("full-disk-outputs", "a disk that is full before the outputs are written: the run is kept", ("outputs in run", "Free space", "gyrify resume run"), args=("resume", "run"), exit_code=1, prepare=bad_runs.stored, scene=functools.partial(bad_runs.full_disk, room=90_000), shown="`gyrify resume run`", foreign=True),
    Case("no-folder", "a run folder that does not exist", ("There is no run in absent", "gyrify run"), args=("resume", "absent")),
    Case("resume-other", "another value for a stored run", ("keeps its configuration", "limits and output", "another run"), args=("resume", "run", "--set", "growth.ratio=2"), prepare=bad_runs.stored),
    Case("version", "a history of another version", ("journal format 99", "reads format 1", "versions"), args=("resume", "run"), prepare=bad_runs.other_version, shown="`gyrify resume run`"),
    Case("other-program", "a database of another program", ("not a gyrify journal",), args=("resume", "run"), prepare=bad_runs.other_program),
    Case("not-a-database", "a journal that is something else", ("damaged", "from a copy", "--overwrite"), args=("resume", "run"), prepare=bad_runs.overwritten, foreign=True),
    Case("empty", "a journal that is empty", ("journal.sqlite is empty", "--overwrite"), args=("resume", "run"), prepare=bad_runs.emptied),
    Case("half", "a journal that is cut off", ("damaged", "from a copy", "--overwrite"), args=("resume", "run"), prepare=bad_runs.truncated, foreign=True),
    Case("flipped-state", "a journal with a flipped bit in a state", ("Increment 5", "checksum"), args=("resume", "run"), prepare=bad_runs.flip_state),
    Case("flipped-config", "a journal with a flipped bit in its configuration", ("configuration", "checksum"), args=("resume", "run"), prepare=bad_runs.flip_config),
]  # fmt: skip

GROUPS: dict[str, list[Case]] = {
    "Values out of range or of the wrong type": VALUES,
    "Values that do not go together": TOGETHER,
    "Keys": KEYS,
    "Configuration files": FILES,
    "Presets and the command line": COMMAND_LINE,
    "Run folders, disks and stored runs": STORED,
}
CASES = [case for cases in GROUPS.values() for case in cases]

INTRODUCTION = """\
# Bad input

<!-- Written by `python tests/bad_input.py`, which provokes every message; do not edit. -->

Every input below ends with one message on stderr and exit code 2 (a usage or configuration error) unless the
table says otherwise; nothing is run or written, and what a folder held before is still there.
"""


def page() -> str:
    """Return the page, with the messages as they are now."""
    parts = [INTRODUCTION]
    for title, cases in GROUPS.items():
        lines = [f"## {title}\n", "| what | input | message |", "|---|---|---|", *map(_line, cases)]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def _line(case: Case) -> str:
    with tempfile.TemporaryDirectory() as folder:
        code, message = provoke(case, Path(folder))
    what = case.what if code == 2 else f"{case.what} (exit code {code})"
    # which disk is this machine's own, and no part of the page
    text = re.sub(r" It is on a disk of type .*? \(mounted at .*?\)\.", "", message.strip()).replace(
        "\n", "<br>"
    )
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in (what, case.input(), text)) + " |"


def own_lines(text: str) -> list[str]:
    """Return the lines of the page without those whose wording comes from a library."""
    foreign = tuple(f"| {case.what} " for case in CASES if case.foreign)
    return [line for line in text.splitlines() if not line.startswith(foreign)]


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
