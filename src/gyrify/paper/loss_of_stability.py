"""Growth ratio at which the smooth slice loses stability, beside that at which folds are seen."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from gyrify.base.versions import solver_version
from gyrify.config import Config
from gyrify.errors import GyrifyError
from gyrify.paper.simulations import Simulations
from gyrify.store.files import whole_file
from gyrify.threshold import critical_growth

FILE: Final = "stability.json"
LOWEST: Final = 1.0
HIGHEST: Final = 4.0
# Values scanned per unit of growth ratio.
_DENSITY: Final = 5.0


def stability_thresholds(
    simulations: Simulations, configs: Sequence[Config], ends: Sequence[float]
) -> list[str]:
    """Critical growth ratios of some slices, in words; kept in ``stability.json`` of their folder.

    Parameters
    ----------
    simulations : Simulations
        Who computes.
    configs : sequence of Config
        The slices.
    ends : sequence of float
        Growth ratio up to which each is scanned from 1 on.

    Returns
    -------
    list of str
        Such as ``1.810 (mode 16)``.
    """
    path = simulations.folder / FILE
    known = _read(path)
    keys = [f"{solver_version()}:{c.config_hash}:{end:.6g}" for c, end in zip(configs, ends, strict=True)]
    begun = {
        key: simulations.call(_critical, config, end)
        for key, config, end in zip(keys, configs, ends, strict=True)
        if key not in known
    }
    known |= {key: answer() for key, answer in begun.items()}
    if begun:
        with whole_file(path) as partial:
            partial.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    return [known[key] for key in keys]


def _critical(config: Config, end: float) -> str:
    points = max(3, round(_DENSITY * (end - LOWEST)))
    try:
        found = critical_growth(config, "growth.ratio", "stability", (LOWEST, end), points=points)
    except GyrifyError as failure:
        return f"not found ({failure.message})"
    except ValueError:  # on a mesh so coarse that no state counts as smooth
        return "not found (no smooth state)"
    if found.critical_value is None:
        return f"below {LOWEST:g}" if found.at_edge else f"not up to {end:.3g}"
    return f"{found.critical_value:.3f} (mode {found.mode_number})"


def _read(path: Path) -> dict[str, str]:
    try:
        return dict(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return {}
