"""The advice of every refusal in `bad_input`, as what a reader does who follows it.

Each way out is tried in the folder of the refusal, after it, and must succeed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bad_runs
from bad_runs import RUN

CHECK = ("config", "check")


@dataclass(frozen=True)
class Way:
    """One way out of a refusal.

    Attributes
    ----------
    says : str
        The part of the message that names it.
    toml : str or None
        The configuration file as it is after the change; it is then the last argument.
    args : tuple of str
        Arguments of the command line.
    first : callable, optional
        What else the advice has one do, in the folder of the refusal.
    then : tuple of str
        Arguments of another command that must succeed afterwards.
    """

    says: str
    toml: str | None = None
    args: tuple[str, ...] = CHECK
    first: Callable[[Path], object] | None = None
    then: tuple[str, ...] = ()


def default(says: str, toml: str = "") -> list[Way]:
    """The default value, given or left out."""
    return [Way(says, toml), Way(says, "")]


def restored(folder: Path) -> None:
    """Put the journal back from a copy."""
    (folder / "run" / "journal.sqlite").write_bytes(bad_runs.journal_bytes())
    for rest in ("journal.sqlite-wal", "journal.sqlite-shm"):
        (folder / "run" / rest).unlink(missing_ok=True)


AGAIN = Way("run again with --overwrite", args=(*RUN, "run", "--overwrite"))
COPY = Way("Restore the file from a copy", args=("resume", "run"), first=restored)
ELSEWHERE = Way("Choose", args=(*RUN, "elsewhere"))
MEND = Way("Correct or complete that line", '[growth]\nratio = "1/1.36"')

_SURFACE = '[geometry]\nshape = "surface"\nfile = "{}"\ncortical_thickness = 1\n[mesh]\nrefine = 2'

_VOLUME = '[geometry]\nshape = "volume"\nfile = "brain.mesh"\ncortical_thickness = 5'

ADVICE: dict[str, list[Way]] = {
    "no-file": [Way("surface.stl", _SURFACE.format("surface.stl"), first=bad_runs.write_tetrahedron)],
    "lost-file": [
        Way("Give the path of a surface", _SURFACE.format("brain.stl"), first=bad_runs.write_tetrahedron)
    ],
    "open-surface": [Way("Close its holes", _SURFACE.format("brain.off"), first=bad_runs.write_tetrahedron)],
    "broken-volume": [Way("Save it again", _VOLUME, first=bad_runs.write_volume)],
    "labels": [
        Way(
            "Name each label of the file once",
            _VOLUME + "\nlabels = {grey = [1], white = [2]}",
            first=bad_runs.write_volume,
        )
    ],
    "plane": [
        Way(
            "Give a point and a normal that points out of the body",
            _VOLUME + '\n[boundary]\nclamp = "plane"\nplane = {point = [0, 14, 0]}',
            first=bad_runs.write_volume,
        )
    ],
    "negative": default("The default is 3.6", "[growth]\nratio = 3.6"),
    "zero": default("The default is 4069.0", "[geometry]\narea = 4069.0"),
    "absurd": default("The default is 9210.87", "[material]\nyoung_modulus = 9210.87"),
    "nan": default("The default is 0.002", "[growth]\nrate = 0.002"),
    "infinite": default("The default is 500.0", "[growth]\nduration = 500.0"),
    "incompressible": default("The default is 0.458", "[material]\npoisson_ratio = 0.458"),
    "fractional-count": default("The default is 216", "[mesh]\nn_around = 216"),
    "boolean": default("The default is 3.6", "[growth]\nratio = 3.6"),
    "quoted": [Way("without quotes", "[growth]\nratio = 3")],
    "one-for-true": default("true or false. The default is true", "[contact]\nenabled = true"),
    "zero-division": [Way("the fraction divides by zero", '[material]\nstiffness_ratio = "1/2"')],
    "code": [
        Way("looks like 3.6", "[growth]\nratio = 3.6"),
        Way('or "1/1.36"', '[growth]\nratio = "1/1.36"'),
    ],
    "word": [Way('Did you mean "ellipse"?', '[geometry]\nshape = "ellipse"')],
    "neither": default('The default is "auto"', '[contact]\nbarrier_stiffness = "auto"'),
    "list": [Way('Did you mean "mean_stress"?', '[output]\nfields = ["mean_stress"]')],
    "date": default("The default is 0", "seed = 0"),
    "huge": default("The default is 0", "seed = 0"),
    "schema": default("The default is 1", "schema_version = 1"),
    "no-white-matter": [
        Way("Try geometry.cortical_thickness = 14.7 or less", "[geometry]\ncortical_thickness = 14.7"),
        Way("a larger geometry.area", "[geometry]\ncortical_thickness = 16\narea = 6000"),
        Way("a smaller geometry.hole_fraction", "[geometry]\ncortical_thickness = 16\nhole_fraction = 0.4"),
    ],
    "no-white-layer": [
        Way("Try at most 16", "[mesh]\nn_cortex_layers = 16"),
        Way("or more layers", "[mesh]\nn_cortex_layers = 17\nn_layers = 18"),
    ],
    "too-many-cells": [
        # "or less": the most that is allowed has almost four million cells
        Way("Try mesh.n_around = 458 or less", "[mesh]\nn_around = 24\nrefine = 4"),
    ],
    "too-much-growth": [
        Way("Try growth.rate = 0.02 ", "[growth]\nrate = 0.02"),
        Way("or growth.duration = 10.", "[growth]\nrate = 1\nduration = 10"),
    ],
    "increment": [Way("Try 1e-06, the default", "[solver]\nmin_increment = 1e-6")],
    "branch": [
        Way(
            'Try stability.detect = true and dissipation.kind = "none"',
            '[stability]\ndetect = true\nfollow_branch = true\n[dissipation]\nkind = "none"',
        )
    ],
    "several": [Way("Did you mean mesh?", "seed = 0\n[growth]\nratio = 3.6\n[mesh]")],
    "key": [Way("Did you mean growth.ratio?", "[growth]\nratio = 3.6")],
    "section": [Way("Did you mean material?", "[material]\npoisson_ratio = 0.4")],
    "misplaced": [Way("Did you mean material.stiffness_ratio?", "[material]\nstiffness_ratio = 2")],
    "no-section": [Way("Write [growth] with its keys below", "[growth]\nratio = 3.6")],
    "control": [Way("Known: schema_version, seed", "seed = 1")],
    "missing": [Way("Check the path", "seed = 1")],
    "directory": [Way("Name a TOML file", "seed = 1")],
    "truncated": [MEND],
    "twice": [Way("Correct or complete that line", "seed = 2")],
    "latin-1": [Way("Save it as UTF-8", "# été")],
    "binary": [MEND],
    "large": [Way("Name a configuration in TOML", "seed = 1")],
    "deep": [MEND],
    "digits": [MEND],
    "preset": [Way("Did you mean wang2019?", args=(*CHECK, "--preset", "wang2019"))],
    "preset-in-file": [
        Way("reference-slice", 'preset = "reference-slice"'),
        Way("wang2019", 'preset = "wang2019"'),
    ],
    "option-value": [Way("The default is 3.6", args=(*CHECK, "--growth-ratio", "3.6"))],
    "slivers": [
        Way("Try mesh.n_around = 382", args=(*CHECK, "--thickness", "0.05", "--set", "mesh.n_around=382")),
        Way(
            "or mesh.n_cortex_layers = 3",
            args=(*CHECK, "--thickness", "0.05", "--set", "mesh.n_cortex_layers=3"),
        ),
    ],
    "axial-power": [
        Way(
            'Try growth.out_of_plane = "blocked"',
            '[growth]\nout_of_plane = "blocked"\nout_of_plane_exponent = 0.5',
        )
    ],
    "axial-patches": [
        Way(f'"{element}"', f'[growth]\nout_of_plane = "generalised"\n[mesh]\nelement = "{element}"')
        for element in ("quadratic", "linear")
    ],
    "cortex-refined-too-often": [
        Way("one of the 3 white layers. Try at most that number", "[mesh]\nn_layers = 9\nrefine_cortex = 3"),
        Way("or more layers in mesh.n_layers", "[mesh]\nn_layers = 10\nrefine_cortex = 4"),
    ],
    "symmetric-columns": [
        Way("Try mesh.n_around = 60", '[mesh]\nn_around = 60\nsplit = "symmetric"'),
        Way("or 64", '[mesh]\nn_around = 64\nsplit = "symmetric"'),
    ],
    "symmetric-branch": [
        Way(
            'Try mesh.split = "alternating"',
            '[mesh]\nsplit = "alternating"\n[dissipation]\nkind = "none"\n[stability]\nfollow_branch = true',
        )
    ],
    "option-word": [Way("The default is 1.5", args=(*CHECK, "--thickness", "1.5"))],
    "set-key": [Way("Did you mean growth.ratio?", args=(*CHECK, "--set", "growth.ratio=2"))],
    "set-form": [Way("Write --set section.field=value", args=(*CHECK, "--set", "growth.ratio=2"))],
    "set-section": [Way("Name one of its keys", args=(*CHECK, "--set", "growth.ratio=2"))],
    "given-twice": [Way("Give it once", args=(*CHECK, "--growth-ratio", "2"))],
    "option": [Way("Did you mean --growth-ratio?", args=(*CHECK, "--growth-ratio", "2"))],
    "command": [Way('Did you mean "check"?', args=CHECK)],
    "holds-run": [
        Way("gyrify resume run", args=("resume", "run")),
        Way("--overwrite", args=(*RUN, "run", "--overwrite")),
        Way("choose another", args=(*RUN, "elsewhere")),
    ],
    "out-file": [ELSEWHERE],
    "out-under-file": [ELSEWHERE],
    "read-only": [ELSEWHERE],
    "in-use": [
        Way("Wait for that process", args=(*RUN, "run", "--overwrite")),
        Way("choose another folder with --out", args=(*RUN, "elsewhere")),
    ],
    "full-disk": [Way("continue with `gyrify resume", args=("resume", "run"))],
    "full-disk-outputs": [Way("continue with `gyrify resume run`", args=("resume", "run"))],
    "no-folder": [
        Way("a folder that `gyrify run` has written", args=(*RUN, "absent"), then=("resume", "absent"))
    ],
    "resume-other": [
        Way("only values in limits", args=("resume", "run", "--set", "limits.wall_time=99")),
        Way("Begin another run", args=(*RUN, "another", "--set", "growth.ratio=2")),
    ],
    "version": [Way("or run again", args=(*RUN, "run", "--overwrite"))],
    "other-program": [
        Way("a folder that `gyrify run` has written", args=(*RUN, "another"), then=("resume", "another"))
    ],
    "not-a-database": [COPY, AGAIN],
    "empty": [COPY, AGAIN],
    "half": [COPY, AGAIN],
    "flipped-state": [COPY, AGAIN],
    "flipped-config": [COPY, AGAIN],
}
