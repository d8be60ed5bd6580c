"""The scene of an animation: one fixed frame, of which only what moves is drawn again."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.text import Text
from numpy.typing import NDArray

from gyrify.config.run_sections import OutputField
from gyrify.mesh import GREY, WHITE
from gyrify.report.drawn_slice import DrawnSlice
from gyrify.report.figures import boundary_loops, tissue_path
from gyrify.report.layout import (
    COLOURS,
    FONT,
    LINE_MM,
    MARGIN_MM,
    MM,
    OUTLINE,
    FloatArray,
    legend,
    line,
    page,
    scale_bar,
)
from gyrify.report.plot.field_colours import PAINTS, colour_bar, common_scale, draw_field
from gyrify.report.plot.folded import tissue_handles
from gyrify.report.plot.shown import Shown, per_triangle
from gyrify.report.plot.slices import clamped_line, common_frame
from gyrify.report.plot.style import POINTS, literal
from gyrify.store.fields import fields

Pixels = NDArray[np.uint8]
Colour = tuple[int, int, int]
# Steps of a map of colours that a palette keeps.
STEPS: Final = 96
_WIDTH_MM: Final = 90.0
_TOP_MM: Final = 2.0
_THIN: Final[dict[str, Any]] = {"color": COLOURS["line"], "linewidth": 0.4}
_THICK: Final = {**_THIN, "linewidth": 0.9}


class Fill(Protocol):
    """What fills the slice."""

    artists: list[Artist]
    colours: list[Colour]

    def show(self, number: int, drawing: DrawnSlice) -> None:
        """Take the shape, and the values, of a frame."""


class Scene:
    """Frames of a run as pixels.

    Parameters
    ----------
    states : sequence of Shown
        State of each frame.
    width : int
        Width of the frames in pixels.
    field : str, optional
        Field of the cells instead of the tissues; its colour scale holds for all frames.

    Attributes
    ----------
    figure : Figure
        The page.
    size : (int, int)
        Width and height in pixels, both even: encoders of video ask for that.
    """

    def __init__(self, states: Sequence[Shown], width: int, field: OutputField | None = None) -> None:
        self.states = states
        low, high = common_frame([(state.drawing.low, state.drawing.high) for state in states])
        title = [states[0].name, *([states[0].note] if states[0].note else [])]
        head = 2.8 + LINE_MM * (len(title) + 2)
        self.figure, self._axes = page(low, high, _WIDTH_MM, header_mm=head)
        self.size = fit(self.figure, width)
        self._fill: Fill = (
            Tissues(self._axes, states[0].drawing) if field is None else Field(self.figure, states, field)
        )
        if field is None:
            legend(self.figure, tissue_handles())
        scale_bar(self.figure, low, high)
        self._axes.add_line(line(clamped_line(states[0]), **_THIN))
        styles = (OUTLINE, _THIN, _THICK)
        self._lines = [self._axes.add_line(line(np.zeros((0, 2)), **style)) for style in styles]
        self._texts = header(self.figure, title)
        self._background: Any = None

    @property
    def colours(self) -> list[Colour]:
        """Colours that carry meaning."""
        return [
            *(colour_bytes(name) for name in ("white", COLOURS["line"], COLOURS["outline"])),
            *self._fill.colours,
        ]

    def pixels(self, number: int) -> Pixels:
        """Frame as a (height, width, 3) array."""
        canvas: Any = self.figure.canvas
        moving = [*self._fill.artists, *self._lines, *self._texts]
        if self._background is None:
            for artist in moving:
                artist.set_animated(True)
            canvas.draw()
            self._background = canvas.copy_from_bbox(self.figure.bbox)
        self._move(number)
        canvas.restore_region(self._background)
        renderer = canvas.get_renderer()
        for artist in moving:
            artist.draw(renderer)
        return np.array(canvas.buffer_rgba())[:, :, :3]

    def _move(self, number: int) -> None:
        """Move everything to a frame."""
        state, drawing = self.states[number], self.states[number].drawing
        self._fill.show(number, drawing)
        for drawn, vertices in zip(
            self._lines, (_joined(drawing.exposed), drawing.interface, drawing.contour), strict=True
        ):
            drawn.set_data(vertices[:, 0], vertices[:, 1])
        for text, words in zip(self._texts, frame_text(state, self.states[-1].mark), strict=True):
            text.set_text(words)


class Tissues:
    """Grey and white matter, each one shape."""

    def __init__(self, axes: Axes, drawing: DrawnSlice) -> None:
        self._loops = [boundary_loops(drawing.cells[drawing.region == kind]) for kind in (WHITE, GREY)]
        self._patches = [
            PathPatch(tissue_path(drawing.points, loops), facecolor=COLOURS[name], edgecolor="none")
            for loops, name in zip(self._loops, ("white", "grey"), strict=True)
        ]
        self.artists: list[Artist] = [axes.add_artist(patch) for patch in self._patches]
        self.colours = [colour_bytes(COLOURS[name]) for name in ("white", "grey")]

    def show(self, number: int, drawing: DrawnSlice) -> None:  # noqa: ARG002
        """Take the shape of a frame."""
        for patch, loops in zip(self._patches, self._loops, strict=True):
            patch.set_path(tissue_path(drawing.points, loops))


class Field:
    """Triangles with their colours."""

    def __init__(self, figure: Figure, states: Sequence[Shown], name: OutputField) -> None:
        paint, first = PAINTS[name], states[0]
        self._states = states
        self._values = [paint.factor * fields(state.history, state.index, (name,))[name] for state in states]
        scale = common_scale(paint, self._values)
        of_triangles = per_triangle(first.history, self._values[0], first.drawing)
        self._drawn = draw_field(figure.axes[0], first.drawing, of_triangles, paint, scale)
        colour_bar(figure, (42.0, 9.5, 45.0, 2.2), self._drawn, paint.label, np.concatenate(self._values))
        self.artists: list[Artist] = [self._drawn]
        self.colours = [colour_bytes(colour) for colour in self._drawn.cmap(np.linspace(0.0, 1.0, STEPS))]

    def show(self, number: int, drawing: DrawnSlice) -> None:
        """Take the shape and the values of a frame."""
        corners: Any = drawing.points[drawing.cells]
        self._drawn.set_verts(corners)
        self._drawn.set_array(per_triangle(self._states[number].history, self._values[number], drawing))


def frame_text(state: Shown, mark: str) -> tuple[str, str]:
    """What is written above a frame: growth time, index, gyri, and what is known of the mesh."""
    gyri, duration = state.measures.n_gyri, state.history.config.growth.duration
    count = f"{gyri} {'gyrus' if gyri == 1 else 'gyri'}"
    measures, kind = state.measures, "by area " if state.in_space else ""
    return (
        f"growth time {state.growth_time:.4g} of {duration:g}",
        f"GI {kind}{measures.index:.2f} (closing, {measures.closing_radius:.4g} mm)   {count}   {mark}",
    )


def colour_bytes(colour: Any) -> Colour:
    """A colour as three whole numbers from 0 to 255."""
    red, green, blue = (round(255 * part) for part in to_rgb(colour))
    return red, green, blue


def header(figure: Figure, title: Sequence[str]) -> list[Text]:
    """Write the title, and return the lines below it, which change."""
    width_mm, height_mm = figure.get_size_inches() / MM
    texts = []
    for number, words in enumerate([*title, "", ""]):
        colour = COLOURS["outline"] if 0 < number < len(title) else COLOURS["line"]
        style: dict[str, Any] = {"va": "top", "family": FONT, "fontsize": POINTS, "color": colour}
        weight = "normal" if number else "bold"
        top = 1.0 - (_TOP_MM + LINE_MM * number) / height_mm
        texts.append(figure.text(MARGIN_MM / width_mm, top, literal(words), fontweight=weight, **style))
    return texts[len(title) :]


def fit(figure: Figure, width: int) -> tuple[int, int]:
    """Set the resolution for a width, and the height to an even number of pixels; return both."""
    wide, tall = figure.get_size_inches()
    figure.set_dpi(width / wide)
    size = width, 2 * round(0.5 * width * tall / wide)
    figure.set_size_inches(wide, (size[1] + 1e-6) / width * wide)
    return size


def _joined(pieces: Sequence[FloatArray]) -> FloatArray:
    """Pieces of a line as one, with gaps between them."""
    gap = np.full((1, 2), np.nan)
    return np.concatenate([part for piece in pieces for part in (piece, gap)])
