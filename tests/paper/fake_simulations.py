"""A simulations that makes results up, from a model with a few numbers that depend on the mechanics."""

from __future__ import annotations

import hashlib
import math
import random
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from gyrify.config import Config
from gyrify.paper.index import Index
from gyrify.paper.reading import Mechanics
from gyrify.paper.row import Row, row_of
from gyrify.study import Point, Record
from gyrify.study.results import flat


def numbers_of(config: Config) -> random.Random:
    """Random numbers that are the same for the same mechanics."""
    digest = hashlib.sha256(str(Mechanics.of(config)).encode()).digest()
    return random.Random(int.from_bytes(digest[:8], "big"))


def made_up(config: Config) -> dict[str, Any]:
    """Summary of a slice that folds beyond some growth ratio, in waves that follow the thickness."""
    draw = numbers_of(config)
    onset, stiff, thick, gain, uniform = (draw.uniform(*ends) for ends in _ENDS)
    thickness, stiffness = config.geometry.cortical_thickness, config.material.stiffness_ratio
    critical = onset - stiff * math.log(stiffness) + thick * max(thickness - 1.5, 0.0)
    beyond = max(1.0 - critical / config.growth.ratio, 0.0) + 1e-4 * config.seed
    folded = beyond > 0.003
    gi = 1.0 + gain * beyond * (0.8 if thickness < 1 else 1.0)
    crown = 1.5 if stiffness <= 1 else uniform
    return {
        "gi": {"hull": 1 + 1.2 * (gi - 1), "closing": gi, "exposed": 1 + 2 * (gi - 1)},
        "n_gyri": round(19 * 1.5 / thickness) if folded else 0,
        "sulcal_depth_mm": {"max": 20 * beyond, "mean": 11 * beyond if folded else 0.0},
        "gyrus_width_mm": 5.0 * thickness,
        "gyrus_flatness": 0.4,
        "fold_sharpness": 2.0,
        "thickness_mm": {"crown": crown, "fundus": 1.0},
        "contour_length_mm": 400.0 * gi,
    }


_ENDS = ((1.3, 2.2), (0.5, 1.5), (0.0, 0.5), (0.5, 1.0), (1.1, 1.3))


class FakeSimulations:
    """Has what the paper's code uses of a simulations.

    Some mechanics fail at a certain case, as real ones do.
    """

    def __init__(self, workers: int = 1) -> None:
        self.folder, self.workers = Path(), workers
        self.records: dict[str, Record] = {}
        self.asked: list[Point] = []
        self.core_minutes = 0.0

    def run(self, points: Sequence[Point]) -> None:
        for point in points:
            if point.key not in self.records:
                self.asked.append(point)
                self.records[point.key] = self._record(point)

    def row(self, point: Point, index: Index) -> Row | None:
        record = self.records.get(point.key)
        if record is None:
            return None
        metrics = None
        if record.summary is not None:
            metrics = flat(record.summary)
            metrics["gi_picture"] = 0.2 + 0.8 * metrics["gi_closing"]
            wide = 1 + 0.02 * (index.radius - 10.0)
            metrics["gi"] = 1 + wide * (metrics[f"gi_{index.definition}"] - 1)
        return row_of(point.config, point.key, record.status, record.reason, metrics)

    def _record(self, point: Point) -> Record:
        stalls = Mechanics.of(point.config).number > 5.0 and point.config.growth.ratio == 360.0
        status, reason = ("failed", "Stalled.") if stalls else ("completed", "")
        summary = None if stalls else made_up(point.config)
        told = (point.config.config_hash, "v", status, reason, "", point.config.to_dict())
        return Record(*told, summary, "", 0.0)
