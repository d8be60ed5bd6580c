"""Frames into files: GIF by Pillow, MP4 by ffmpeg where that is installed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import accumulate
from pathlib import Path
from typing import Any, Final

from gyrify.base.extras import require
from gyrify.errors import GyrifyError
from gyrify.report.animate_scene import Pixels

# Colours of a GIF: enough for smooth edges beside a map of colours, few enough for small files.
_COLOURS: Final = 192
# Difference of channels up to which a colour is taken for one that is kept.
_CLOSE: Final = 8
# Constant quality of H.264: visually lossless for line art.
_QUALITY: Final = "18"


def durations(repeats: Sequence[int], fps: float, hold: float) -> list[int]:
    """Time that each frame is shown [ms], in the hundredths of a second of a GIF, rounded without drift.

    Parameters
    ----------
    repeats : sequence of int
        For how many frames of even spacing each is shown.
    fps : float
        Frames per second.
    hold : float
        How much longer the last one is shown [s].

    Returns
    -------
    list of int
        At least 20 ms each: viewers slow down what is shorter.
    """
    ends = [round(100.0 * end / fps) for end in accumulate(repeats)]
    shown = [10 * max(end - start, 2) for start, end in zip([0, *ends], ends, strict=False)]
    shown[-1] += 10 * round(100.0 * hold)
    return shown


def write_gif(
    path: Path,
    frames: Iterable[Pixels],
    samples: Sequence[Pixels],
    colours: Sequence[Sequence[int]],
    milliseconds: Sequence[int],
) -> None:
    """Write frames with one palette for all of them; equal frames give equal bytes.

    Parameters
    ----------
    path : Path
        File to write.
    frames : iterable of (height, width, 3) arrays
        All frames.
    samples : sequence of (height, width, 3) arrays
        Frames that the palette is taken from.
    colours : sequence of (red, green, blue)
        Colours that are kept exactly.
    milliseconds : sequence of int
        Time that each frame is shown.
    """
    from PIL import Image

    palette = _palette(samples, colours)
    indexed = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    next(indexed).save(
        path,
        format="GIF",
        save_all=True,
        append_images=indexed,
        duration=list(milliseconds),
        loop=0,
        optimize=False,
        disposal=1,
    )


def _palette(samples: Sequence[Pixels], colours: Sequence[Sequence[int]]) -> Any:
    """Colours that are kept, and those between them that smooth edges need."""
    import numpy as np
    from PIL import Image

    others = _COLOURS - len(colours)
    sample = Image.fromarray(np.concatenate(list(samples)))
    reduced = sample.quantize(others, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    kept = np.array(colours)
    found = np.array((reduced.getpalette() or [])[: 3 * others]).reshape(-1, 3)
    # A mean of nearly white pixels would be found for white: what is close to a kept colour becomes that.
    apart = np.abs(found[:, None] - kept).max(axis=2)
    found = np.where(apart.min(axis=1, keepdims=True) <= _CLOSE, kept[apart.argmin(axis=1)], found)
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.concatenate([kept, found]).ravel().tolist())
    return palette


def write_mp4(
    path: Path, frames: Iterable[Pixels], size: tuple[int, int], repeats: Sequence[int], fps: float
) -> None:
    """Write frames as H.264 that every browser plays.

    Parameters
    ----------
    path : Path
        File to write.
    frames : iterable of (height, width, 3) arrays
        All frames.
    size : (int, int)
        Width and height in pixels, even.
    repeats : sequence of int
        How many times each frame is written.
    fps : float
        Frames per second.

    Raises
    ------
    GyrifyError
        If there is no encoder, or it fails.
    """
    encoder = video_encoder()
    writer = encoder.write_frames(
        str(path),
        size,
        fps=fps,
        codec="libx264",
        pix_fmt_in="rgb24",
        pix_fmt_out="yuv420p",
        quality=None,
        macro_block_size=2,
        ffmpeg_log_level="error",
        # One thread and no names of programs: equal frames give equal bytes.
        output_params=["-f", "mp4", "-crf", _QUALITY, "-threads", "1", "-movflags", "+faststart", *_BITEXACT],
    )
    writer.send(None)
    try:
        for frame, count in zip(frames, repeats, strict=True):
            data = frame.tobytes()
            for _ in range(count):
                writer.send(data)
    except OSError as error:
        raise GyrifyError(f"The encoder of videos failed: {error}.", "Write a .gif instead.") from error
    finally:
        writer.close()


_BITEXACT: Final = ("-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1")


def video_encoder() -> Any:
    """imageio-ffmpeg.

    Raises
    ------
    GyrifyError
        If it is not installed.
    """
    return require("imageio_ffmpeg", "video", "An MP4 animation", "imageio-ffmpeg")


def watched(
    frame: Callable[[int], Pixels], count: int, observe: Callable[[int, int], None] | None
) -> Iterator[Pixels]:
    """Frames in order; the observer is told how many of how many there are."""
    for number in range(count):
        yield frame(number)
        if observe is not None:
            observe(number + 1, count)
