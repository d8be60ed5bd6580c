"""Readers of text: configurations, studies, and what a run and a point of a study say of themselves."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from unittest import mock

from target import Target

from gyrify.config import Config
from gyrify.store.derived import read_metrics, read_summary
from gyrify.study import Study, design
from gyrify.study.archive import read_record, was_begun

# A design of the most points allowed takes minutes; see tests/fuzz/test_found.py for its time.
_FEW_POINTS = 60


def _config(folder: Path) -> Callable[[bytes], object]:
    file = folder / "config.toml"

    def read(data: bytes) -> None:
        file.write_bytes(data)
        config = Config.load(file)
        assert Config.from_toml(config.to_toml()) == config

    return read


def _study(folder: Path) -> Callable[[bytes], object]:
    file = folder / "study.toml"
    (folder / "base.toml").write_text("seed = 1\n[growth]\nratio = 2.0\n", encoding="utf-8")

    def read(data: bytes) -> None:
        file.write_bytes(data)
        study = Study.from_toml(file)
        again = folder / "again.toml"
        again.write_text(study.to_toml(), encoding="utf-8")
        keys = [point.key for point in Study.from_toml(again).points()]
        assert keys == [point.key for point in study.points()]

    return read


def _few_points() -> AbstractContextManager[None]:
    return mock.patch.object(design, "MAX_POINTS", _FEW_POINTS)


def _summary(folder: Path) -> Callable[[bytes], object]:
    """What ``gyrify verify`` reads beside the journal."""

    def read(data: bytes) -> None:
        (folder / "summary.json").write_bytes(data)
        (folder / "metrics.csv").write_bytes(data)
        read_metrics(folder / "metrics.csv")
        read_summary(folder)

    return read


def _point(folder: Path) -> Callable[[bytes], object]:
    """``point.json`` of a study, and who is said to hold a folder."""
    from gyrify.store.lock import has_owner, run_lock

    def read(data: bytes) -> None:
        (folder / "point.json").write_bytes(data)
        (folder / "run.owner.json").write_bytes(data)
        was_begun(folder, "0" * 64, "1" * 12)
        has_owner(folder)
        record = read_record(folder)
        with run_lock(folder) as note:
            assert note.isprintable()
        if record is not None:
            Config.from_dict(record.config)

    return read


TARGETS = (
    Target("config", "configuration, TOML", _config),
    Target(
        "study",
        "study, TOML",
        _study,
        _few_points,
        words=(b"[[design.parameter]]", b"[[design.point]]", b"[base]", b"[design]"),
    ),
    Target("summary", "`summary.json`, `metrics.csv`", _summary),
    Target(
        "point",
        "`point.json`, `run.owner.json`",
        _point,
        words=(b'"begun"', b'"pid"', b'"host"', b"NaN", b"Infinity"),
    ),
)
