"""Growth as a moving picture: GIF or MP4, with growth time, gyrification index and scale bar."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final, get_args

import numpy as np

from gyrify.base.arguments import Pathlike, as_path, real_number, whole_number
from gyrify.config.run_sections import OutputField
from gyrify.errors import ConfigError
from gyrify.report.animate_body import BodyScene
from gyrify.report.animate_files import durations, video_encoder, watched, write_gif, write_mp4
from gyrify.report.animate_scene import Pixels, Scene
from gyrify.report.plot.field_colours import PAINTS
from gyrify.report.plot.shown import Run, Shown, run_title, show
from gyrify.store.disk_faults import storage_faults
from gyrify.store.files import whole_file
from gyrify.store.history import History
from gyrify.store.state_fields import CELL_FIELDS

__all__ = ["FIELDS", "animate"]

FIELDS: Final = ("tissue", *(name for name in PAINTS if name in CELL_FIELDS))
FORMATS: Final = (".gif", ".mp4")
# How much longer the last frame is shown [s].
HOLD: Final = 1.5
_LIMITS: Final = {"fps": (1.0, 50.0, "1/s"), "seconds": (0.5, 120.0, "s"), "width": (200, 2000, "pixels")}


def animate(
    run: Run,
    out: Pathlike,
    *,
    fps: float = 15.0,
    seconds: float = 6.0,
    field: str = "tissue",
    width: int = 640,
    observe: Callable[[int, int], None] | None = None,
) -> Path:
    """Write growth as a GIF or an MP4, by atomic rename.

    Growth time runs evenly; each frame shows the stored state nearest to its time, the last one is held. A
    body in space is seen from the side, and cut across.

    Parameters
    ----------
    run : History or path
        The run, or its folder; where it has not completed, the picture says so.
    out : path
        File to write, ``.gif`` or ``.mp4``.
    fps : float
        Frames per second, 1 to 50.
    seconds : float
        Duration of growth in the animation [s], 0.5 to 120.
    field : str
        ``tissue`` for grey and white matter, or one of ``von_mises``, ``mean_stress``,
        ``circumferential_stress``, ``growth_stretch``, ``J`` and ``J_elastic`` as colour.
    width : int
        Width in pixels, 200 to 2000.
    observe : callable, optional
        Called with the number of frames drawn and of all; may raise to stop.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ConfigError
        If an argument is out of range, or the suffix is of another format.
    GyrifyError
        If an MP4 is asked for and there is no encoder.
    HistoryError
        If there is no run in a folder, or the file cannot be written; no half of it is left behind.

    Examples
    --------
    >>> gyrify.animate("runs/reference-slice", "growth.gif", field="von_mises")  # doctest: +SKIP
    """
    target = as_path("out", out)
    fps, seconds = real_number("fps", fps), real_number("seconds", seconds)
    width = whole_number("width", width)
    _check(target, field, fps=fps, seconds=seconds, width=width)
    (last,) = show([run])
    states, repeats = frames_of(last.history, max(round(fps * seconds), 2))
    kind = BodyScene if last.in_space else Scene
    scene = kind(states, 2 * round(width / 2), _field(field))
    with storage_faults(target.parent, f"The animation {target}"), whole_file(target) as partial:
        _write(partial, target.suffix, scene, watched(scene.pixels, len(states), observe), repeats, fps)
    return target


def _write(
    file: Path,
    suffix: str,
    scene: Scene | BodyScene,
    frames: Iterator[Pixels],
    repeats: list[int],
    fps: float,
) -> None:
    """Write the frames; the last one is held."""
    if suffix.lower() == ".mp4":
        repeats[-1] += math.ceil(HOLD * fps)
        write_mp4(file, frames, scene.size, repeats, fps)
    else:
        samples = [scene.pixels(number) for number in (0, len(repeats) // 2, len(repeats) - 1)]
        write_gif(file, frames, samples, scene.colours, durations(repeats, fps, HOLD))


def frames_of(history: History, count: int) -> tuple[list[Shown], list[int]]:
    """States nearest to evenly spaced growth times, each once, and how many times each is shown."""
    times = history.growth_times
    wanted = np.linspace(0.0, times[-1], count)
    middles = 0.5 * (times[1:] + times[:-1])
    nearest = np.searchsorted(middles, wanted)
    indices, repeats = np.unique(nearest, return_counts=True)
    title = run_title(history)
    return [Shown(history, int(index), title) for index in indices], [int(count) for count in repeats]


def _field(name: str) -> OutputField | None:
    return next((field for field in get_args(OutputField) if field == name), None)


def _check(target: Path, field: str, **numbers: float) -> None:
    """Refuse what cannot be written, before a run is read."""
    if target.suffix.lower() not in FORMATS:
        raise ConfigError(
            f"out = {str(target)[-60:]!r} has no known format.",
            f"End it with one of: {', '.join(FORMATS)}.",
        )
    if not isinstance(field, str) or field not in FIELDS:
        raise ConfigError(
            f"field = {str(field)[:60]!r} cannot be animated.", f"Choose one of: {', '.join(FIELDS)}."
        )
    for name, value in numbers.items():
        low, high, unit = _LIMITS[name]
        if not low <= value <= high:
            raise ConfigError(
                f"{name} = {value:g} is out of range: it must be {low:g} to {high:g} [{unit}].",
                f"Give {name} in that range.",
            )
    if target.suffix.lower() == ".mp4":
        video_encoder()
