"""Growth ratio at which the smooth slice loses stability, beside that at which folds are seen."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from gyrify.config import Config
from gyrify.errors import GyrifyError
from gyrify.paper.bench import Bench
from gyrify.threshold import critical_growth
from gyrify.versions import solver_version

FILE: Final = "stability.json"
_RANGE: Final = (1.0, 4.0)
_POINTS: Final = 13


def stability_thresholds(bench: Bench, configs: Sequence[Config]) -> list[str]:
    """Critical growth ratios of some slices, in words; kept in ``stability.json`` of the bench's folder.

    Parameters
    ----------
    bench : Bench
        Who computes.
    configs : sequence of Config
        The slices.

    Returns
    -------
    list of str
        Such as ``1.810 (mode 16)``.
    """
    path = bench.folder / FILE
    known = _read(path)
    keys = [f"{solver_version()}:{config.config_hash}" for config in configs]
    begun = {
        key: bench.call(_critical, config)
        for key, config in zip(keys, configs, strict=True)
        if key not in known
    }
    known |= {key: answer() for key, answer in begun.items()}
    if begun:
        partial = path.with_suffix(".partial")
        partial.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        os.replace(partial, path)
    return [known[key] for key in keys]


def _critical(config: Config) -> str:
    try:
        found = critical_growth(config, "growth.ratio", "stability", _RANGE, points=_POINTS)
    except GyrifyError as failure:
        return f"not found ({failure.message})"
    except ValueError:  # on a mesh so coarse that no state counts as smooth
        return "not found (no smooth state)"
    if found.critical_value is None:
        return f"none up to {_RANGE[1]:g}"
    return f"{found.critical_value:.3f} (mode {found.mode_number})"


def _read(path: Path) -> dict[str, str]:
    try:
        return dict(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return {}
