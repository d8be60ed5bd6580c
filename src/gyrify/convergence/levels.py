"""What a study of convergence found: its runs, level by level, and a verdict per metric."""

from __future__ import annotations

import csv
import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from gyrify.base.markup import html_rows
from gyrify.config import Config
from gyrify.convergence.limit import RULE, Verdict, judge
from gyrify.convergence.measured import Metric, metrics
from gyrify.convergence.plan import Subject, contour_nodes, resolution
from gyrify.store.files import whole_file


@dataclass(frozen=True)
class Level:
    """One run.

    Attributes
    ----------
    config : Config
        Its configuration.
    folder : Path
        Its run folder.
    status : str
        ``completed``, ``failed``, ``stopped`` or ``interrupted``.
    reason : str
        Why it did not complete.
    metrics : dict
        By the keys of `gyrify.convergence.measured.metrics`; empty unless it completed.
    wall_s : float
        Time spent solving [s].
    warnings : tuple of str
        What a reader of its numbers should not overlook.
    """

    config: Config
    folder: Path
    status: str
    reason: str
    metrics: dict[str, float | None]
    wall_s: float
    warnings: tuple[str, ...] = ()

    @property
    def is_complete(self) -> bool:
        """Whether growth came to its end."""
        return self.status == "completed"

    def name(self, subject: Subject) -> str:
        """What the level is called within a family."""
        if subject == "increments":
            return f"{self.config.solver.increments} increments"
        if subject == "contact":
            return f"{resolution(self.config, 'contact'):.3g} mm"
        mesh = self.config.mesh
        if self.config.geometry.n_dim == 3:
            return f"edges of {resolution(self.config, 'mesh'):.3g} mm"
        factor = 2**mesh.refine
        return f"{mesh.n_around * factor} × {mesh.n_layers * factor}"


@dataclass(frozen=True)
class Family:
    """Runs that differ in one thing, coarse to fine.

    Attributes
    ----------
    subject : {"mesh", "increments", "contact"}
        What is refined.
    levels : tuple of Level
        The runs.
    tolerance : float
        Largest relative error that counts as converged.
    """

    subject: Subject
    levels: tuple[Level, ...]
    tolerance: float

    @cached_property
    def verdicts(self) -> dict[str, Verdict]:
        """Verdict per metric, by its key."""
        scale = self.levels[0].config.geometry.scale if self.levels else 1.0
        return {
            metric.key: judge(
                [level.metrics.get(metric.key) for level in self.levels],
                self.tolerance,
                is_count=metric.is_count,
                least=metric.least * scale,
            )
            for metric in self.metrics
        }

    @property
    def metrics(self) -> tuple[Metric, ...]:
        """What is compared."""
        return metrics(self.levels[0].config.geometry.n_dim if self.levels else 2)

    @property
    def notes(self) -> tuple[str, ...]:
        """What a reader of the verdicts must know."""
        notes = [
            f"{level.name(self.subject)} {level.status}: {level.reason}"
            for level in self.levels
            if not level.is_complete
        ]
        notes += [
            f"{metric.name}: {self.verdicts[metric.key].note}."
            for metric in self.metrics
            if self.verdicts[metric.key].note
        ]
        gyri = self.verdicts["n_gyri"]
        if gyri.converged is False:
            counts = " → ".join("?" if n is None else f"{n:.0f}" for n in gyri.values)
            notes.append(
                f"The number of gyri still changes ({counts}): the levels show different folds, and where "
                "their other metrics agree, that may be chance."
            )
        return tuple(notes)

    def as_dict(self) -> dict[str, Any]:
        """Plain values, fit for JSON."""
        return {
            "subject": self.subject,
            "levels": [_row(level, self.subject) for level in self.levels],
            "verdicts": {key: verdict.as_dict() for key, verdict in self.verdicts.items()},
            "notes": list(self.notes),
        }


@dataclass(frozen=True, repr=False)
class Convergence:
    """A study of convergence.

    Attributes
    ----------
    config : Config
        Where every family starts.
    families : tuple of Family
        One for each subject.
    tolerance : float
        Largest relative error that counts as converged.
    wall_s : float
        Time taken by this call [s]; runs that were complete before take none.
    """

    config: Config
    families: tuple[Family, ...]
    tolerance: float
    wall_s: float

    @property
    def status(self) -> str:
        """``completed``, or what became of the runs that did not complete: ``failed`` before ``stopped``."""
        found = {level.status for family in self.families for level in family.levels}
        return next(
            (status for status in ("failed", "interrupted", "stopped") if status in found), "completed"
        )

    def __repr__(self) -> str:
        told = []
        for family in self.families:
            verdicts = [verdict.converged for verdict in family.verdicts.values()]
            told.append(f"{family.subject}: {sum(v is True for v in verdicts)} of {len(verdicts)} metrics")
        within = f"within {self.tolerance:g}"
        return f"Convergence({self.status}; converged {within} by refinement of {', '.join(told)})"

    def _repr_html_(self) -> str:
        rows = [
            (family.subject, key, verdict.sentence)
            for family in self.families
            for key, verdict in family.verdicts.items()
        ]
        return html_rows(repr(self), rows, ("refined", "metric", "verdict"))

    def family(self, subject: Subject) -> Family:
        """The family of a subject.

        Parameters
        ----------
        subject : {"mesh", "increments", "contact"}
            What was refined.
        """
        return next(family for family in self.families if family.subject == subject)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings of the runs, each with the levels that it holds for."""
        levels: dict[str, dict[str, None]] = {}
        for family in self.families:
            for level in family.levels:
                for sentence in level.warnings:
                    levels.setdefault(sentence, {})[level.name(family.subject)] = None
        return tuple(f"{', '.join(names)}: {sentence}" for sentence, names in levels.items())

    def as_dict(self) -> dict[str, Any]:
        """Fields nested as in ``gyrify converge --json``."""
        return {
            "status": self.status,
            "config_hash": self.config.config_hash,
            "tolerance": self.tolerance,
            "rule": RULE,
            "warnings": list(self.warnings),
            "families": [family.as_dict() for family in self.families],
            "wall_s": self.wall_s,
        }

    def write(self, folder: Path) -> None:
        """Write ``convergence.json`` and ``convergence.csv`` (one row per level), by atomic rename.

        Parameters
        ----------
        folder : Path
            An existing folder.
        """
        with whole_file(folder / "convergence.json") as partial:
            partial.write_text(json.dumps(self.as_dict(), indent=2, allow_nan=False) + "\n", encoding="utf-8")
        rows = [_row(level, family.subject) for family in self.families for level in family.levels]
        with (
            whole_file(folder / "convergence.csv") as partial,
            partial.open("w", newline="", encoding="utf-8") as file,
        ):
            writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def _row(level: Level, subject: Subject) -> dict[str, Any]:
    """One level, flat."""
    config = level.config
    return {
        "subject": subject,
        "level": level.name(subject),
        "resolution": resolution(config, subject),
        "contour_nodes": contour_nodes(config) if config.geometry.n_dim == 2 else None,
        "run": config.config_hash[:12],
        "status": level.status,
        "reason": level.reason,
        **{metric.key: level.metrics.get(metric.key) for metric in metrics(config.geometry.n_dim)},
        "wall_s": level.wall_s,
    }
