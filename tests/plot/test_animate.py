"""Animations: frames, times and bytes, and no half of a file however one ends."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

import gyrify
from gyrify.errors import ConfigError, GyrifyError, HistoryError
from gyrify.report.animate import HOLD, frames_of
from gyrify.report.animate_files import durations
from gyrify.report.animate_scene import Scene

KINDS = ("quadratic", "mean_dilatation", "strip", "interrupted", "failed", "stopped")
SMALL = {"width": 240, "fps": 10.0, "seconds": 2.0}


def frames(path: Path) -> tuple[list[np.ndarray], list[float]]:
    """Pictures of a GIF, and for how long each is shown [ms]."""
    pictures, times = [], []
    with Image.open(path) as gif:
        for number in range(gif.n_frames):
            gif.seek(number)
            pictures.append(np.array(gif.convert("RGB")))
            times.append(gif.info["duration"])
    return pictures, times


def test_a_gif_has_every_state_once_and_lasts_as_long_as_it_should(history, tmp_path) -> None:
    run = history("linear")
    path = gyrify.animate(run, tmp_path / "a.gif", **SMALL)
    pictures, times = frames(path)
    assert len(pictures) == len(run)
    assert sum(times) == pytest.approx(1000.0 * (SMALL["seconds"] + HOLD))
    assert {picture.shape[1] for picture in pictures} == {240}
    assert not any(np.array_equal(a, b) for a, b in pairwise(pictures))
    assert (pictures[0][-1, -1] == 255).all()
    assert path.stat().st_size < 5_000_000


@pytest.mark.parametrize(
    "name", ["quadratic", "mean_dilatation", "strip", "interrupted", "failed", "stopped"]
)
@pytest.mark.parametrize("field", ["tissue", "von_mises"])
def test_every_kind_of_run_is_animated(runs, history, tmp_path, name, field) -> None:
    told: list[tuple[int, int]] = []
    path = gyrify.animate(
        runs[name], tmp_path / "a.gif", field=field, observe=lambda *n: told.append(n), **SMALL
    )
    pictures, _ = frames(path)
    assert len(pictures) == len(history(name))
    assert told == [(number + 1, len(pictures)) for number in range(len(pictures))]


def test_frames_say_time_and_index_and_hold_the_frame(history) -> None:
    run = history("interrupted")
    states, repeats = frames_of(run, 20)
    assert [state.index for state in states] == list(range(len(run)))
    assert sum(repeats) == 20
    scene = Scene(states, 240)
    limits = scene.figure.axes[0].get_xlim(), scene.figure.axes[0].get_ylim()
    scene.pixels(0)
    scene.pixels(len(states) - 1)
    assert limits == (scene.figure.axes[0].get_xlim(), scene.figure.axes[0].get_ylim())
    told = [text.get_text() for text in scene.figure.texts]
    assert f"growth time {run.growth_times[-1]:.4g} of 500" in told
    assert "run interrupted at 50% of growth" in told
    gi = gyrify.measure_state(run).gi_closing
    line = next(text for text in told if text.startswith(f"GI {gi:.2f} (closing, 10 mm)"))
    assert line.endswith("mesh not checked")
    room = scene.figure.bbox.width
    assert all(text.get_window_extent().x1 < room for text in scene.figure.texts)
    for number, state in enumerate(states):
        scene.pixels(number)
        contour = scene.figure.axes[0].lines[-1].get_xydata()
        assert contour[:-1] == pytest.approx(run.contour(state.index))


def test_a_field_keeps_its_colours_from_frame_to_frame(history) -> None:
    run = history("linear")
    states, _ = frames_of(run, 9)
    scene = Scene(states, 240, "von_mises")
    (field,) = scene.figure.axes[0].collections
    limits = field.get_clim()
    for number in (0, len(states) - 1):
        scene.pixels(number)
        stored = gyrify.store.fields.fields(run, states[number].index, ("von_mises",))["von_mises"]
        assert np.asarray(field.get_array()) == pytest.approx(1e-3 * stored)
        assert field.get_clim() == limits


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_the_same_run_gives_the_same_bytes(runs, tmp_path, suffix) -> None:
    first, second = (
        gyrify.animate(runs["linear"], tmp_path / f"{name}.{suffix}", **SMALL).read_bytes() for name in "ab"
    )
    assert first == second


def test_an_mp4_can_be_read_and_lasts_as_long_as_it_should(runs, tmp_path) -> None:
    path = gyrify.animate(runs["linear"], tmp_path / "a.mp4", **SMALL)
    reader = imageio_ffmpeg.read_frames(str(path))
    about = next(reader)
    width, height = about["size"]
    pictures = [np.frombuffer(frame, np.uint8).reshape(height, width, 3) for frame in reader]
    assert width == 240
    assert about["fps"] == pytest.approx(10.0)
    assert len(pictures) == 20 + 15
    assert np.abs(pictures[0].astype(int) - pictures[-1]).mean() > 2.0


def test_an_encoder_that_is_missing_is_named(runs, tmp_path, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(GyrifyError, match=r"pip install imageio-ffmpeg .*\[video\]"):
        gyrify.animate(runs["linear"], tmp_path / "a.mp4")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_an_interrupt_leaves_the_earlier_file_and_nothing_else(runs, tmp_path, suffix) -> None:
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(b"earlier")

    def interrupt(done: int, count: int) -> None:
        if done == count // 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gyrify.animate(runs["linear"], path, observe=interrupt, **SMALL)
    assert path.read_bytes() == b"earlier"
    assert list(tmp_path.iterdir()) == [path]


def test_times_are_rounded_without_drift() -> None:
    shown = durations([1] * 90, 12.0, 0.0)
    assert sum(shown) == 7500
    assert set(shown) == {80, 90}
    assert durations([2, 1], 10.0, 1.0) == [200, 1100]


@pytest.mark.parametrize(
    ("out", "options", "message"),
    [
        ("a.avi", {}, "End it with one of: .gif, .mp4"),
        ("a.gif", {"fps": 99.0}, r"fps = 99 is out of range: it must be 1 to 50 \[1/s\]"),
        ("a.gif", {"seconds": 0.0}, "seconds = 0 is out of range"),
        ("a.gif", {"width": 20}, "width = 20 is out of range"),
        ("a.gif", {"field": "heat"}, "Choose one of: tissue, von_mises"),
    ],
)
def test_what_cannot_be_animated_is_refused(runs, tmp_path, out, options, message) -> None:
    with pytest.raises(ConfigError, match=message):
        gyrify.animate(runs["linear"], tmp_path / out, **options)


def test_a_folder_that_is_missing_is_named(runs, tmp_path) -> None:
    with pytest.raises(HistoryError, match=r"nowhere.a\.gif cannot be written: No such file"):
        gyrify.animate(runs["stopped"], tmp_path / "nowhere" / "a.gif", **SMALL)
