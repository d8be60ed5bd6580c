"""The reference page of the configuration, written from the models.

``python -m gyrify.config.reference docs/configuration.md`` rewrites it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from itertools import groupby
from pathlib import Path
from typing import Final

from gyrify.config.faults import sections
from gyrify.config.preset_files import PresetAbout, preset_about, preset_names
from gyrify.config.rows import Row, rows
from gyrify.config.settings import Config
from gyrify.config.words import show

INTRODUCTION: Final = """\
# Configuration

<!-- Written from the models by `python -m gyrify.config.reference docs/configuration.md`; do not edit. -->

A configuration is a TOML file; every key has a default, so an empty file is the standard slice.
Lengths are in mm, stresses in Pa, growth time in the units of the source.

- `preset = "wang2019"` at the top starts from a preset; the keys of the file are laid over it, and values on
  the command line over both. The name is not kept: equal values are equal configurations with one hash.
- A number may be a fraction in quotes, such as `"1/1.36"`. Fractions are parsed, never evaluated.
- Types are strict: `true` is not 1, `"3"` is not 3, and 216.5 is not a whole number. Not-a-number and
  infinity are refused. Unknown keys are refused with the nearest known one.
- Further conditions tie keys together: `mesh.n_cortex_layers` is below `mesh.n_layers`; the cortex is thinner
  than 0.95 of the narrowest wall (the shortest axis times 1 − `hole_fraction`, `depth` for strip and patch);
  at most 4 million cells; `growth.rate` × `growth.duration` is at most 10; `solver.min_increment` is at most
  1/`solver.increments`; `stability.follow_branch` needs `stability.detect` and no dissipation;
  `growth.out_of_plane = "generalised"` goes with neither `mean_dilatation` cells nor `kelvin_voigt`;
  `mesh.refine_cortex` is at most the number of white layers. What has no meaning in the plane or in space
  ([Bodies in space](space.md)) is refused there when it is not the default.
- `metrics.closing_radius` and `metrics.gyrus_prominence` scale with the body when they are not given. The
  scale of a body is its mean radius over that of the standard slice, √(`geometry.area` / 4069 mm²), for
  ellipse and circle, ∛(abc) / 35.99 mm for sphere and ellipsoid (of equal volume for a surface or a
  volume, of the whole body for half a one); for a
  strip or a patch, whose folds have no other length, `geometry.cortical_thickness` / 1.5 mm.
  The standard slice has 10 mm and 0.3 mm. The same brain in another unit of length so has the same indices.
  A stored `config.toml` states every number: a stored run keeps the lengths that it was measured with.
- The configuration hash is the SHA-256 of the canonical JSON (sorted keys, no spaces, shortest exact floats)
  of every value outside `output` and `limits`.
"""


def page() -> str:
    """Return the page in Markdown."""
    kinds = sections(Config)
    parts = [INTRODUCTION]
    for name, group in groupby(rows(Config()), key=lambda row: row.key.rpartition(".")[0]):
        title = f"## `[{name}]`\n\n{kinds[name].__doc__}" if name else "## Top level"
        parts.append(f"{title}\n\n{_table(group)}")
    parts.append("## Presets\n\n" + "\n".join(map(_preset, map(preset_about, preset_names()))))
    return "\n".join(parts)


def _table(group: Iterable[Row]) -> str:
    lines = ["| key | default | allowed | what it is | source |", "|---|---|---|---|---|"]
    for row in group:
        default = f"`{show(row.default)}`" if row.default is not None else row.follows
        if row.key == "output.fields":
            default = "all"
        cells = (f"`{row.key.rpartition('.')[2]}`", default, row.allowed, row.doc, row.source)
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _preset(about: PresetAbout) -> str:
    text = f"### `{about.name}`\n\n{about.description}\n"
    if about.reference:
        text += f"\n{about.reference}\n"
    text += "\nNot claimed:\n\n" + "".join(f"- {line}\n" for line in about.not_claimed)
    if about.sources:
        text += "\n| key | source |\n|---|---|\n"
        text += "".join(f"| `{key}` | {source} |\n" for key, source in about.sources.items())
    return text


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")
