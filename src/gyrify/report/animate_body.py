"""The scene of an animation of a body in space: seen from the side, and cut across, to one scale."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_rgb

from gyrify.config.run_sections import OutputField
from gyrify.report.animate_scene import STEPS, Colour, Pixels, colour_bytes, fit, frame_text, header
from gyrify.report.layout import COLOURS, FOOTER_MM, LINE_MM, MARGIN_MM, FloatArray, legend, scale_bar
from gyrify.report.plot.bodies import in_space_paint, surface_values
from gyrify.report.plot.field_colours import colour_bar, common_scale
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.space_figure import in_view, panel, tissue_patches
from gyrify.report.plot.style import new_figure, write
from gyrify.report.surface_drawing import DrawnBody, Painted, paint, section_caption
from gyrify.store.fields import fields

_WIDTH_MM: Final = 120.0
_GAP_MM: Final = 4.0
_VIEW: Final = "from the side"
_SECTION: Final = "section"


class BodyScene:
    """Frames of a run of a body in space as pixels.

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
        Width and height in pixels, both even.
    """

    def __init__(self, states: Sequence[Shown], width: int, field: OutputField | None = None) -> None:
        self.states, self._field = states, field
        bounds = [DrawnBody(s.history.mesh, s.history.points(s.index)).bounds for s in states]
        low, high = np.min([b[0] for b in bounds], axis=0), np.max([b[1] for b in bounds], axis=0)
        self._place = float(0.5 * (low[0] + high[0]))
        title = [states[0].name, *([states[0].note] if states[0].note else [])]
        frames = {name: in_view(name, low, high) for name in (_VIEW, _SECTION)}
        wide = [float(ends[1][0] - ends[0][0]) for ends in frames.values()]
        scale = (_WIDTH_MM - 2.0 * MARGIN_MM - _GAP_MM) / sum(wide)
        tall, foot = scale * float(high[2] - low[2]), FOOTER_MM + 1.0
        self.figure = new_figure(_WIDTH_MM, 2.8 + LINE_MM * (len(title) + 3) + tall + foot)
        left, self.axes = MARGIN_MM, []
        for name, frame in frames.items():
            self.axes.append(panel(self.figure, (left, foot, tall), scale, frame))
            caption = name if name == _VIEW else section_caption(self._place, float(high[0] - low[0]))
            write(self.figure, left, foot + tall + LINE_MM, caption, fontsize=7)
            left += scale * float(frame[1][0] - frame[0][0]) + _GAP_MM
        self.size = fit(self.figure, width)
        self._colours: list[Colour] = [colour_bytes(COLOURS[name]) for name in ("white", "grey")]
        self._values: list[FloatArray] = []
        if field is None:
            legend(self.figure, tissue_patches())
        else:
            self._colour_by(field)
        scale_bar(self.figure, low, high)
        self._texts = header(self.figure, title)
        empty: Painted = ([], np.zeros((0, 3)))
        self._drawn = [paint(axes, empty) for axes in self.axes]
        for drawn in self._drawn:
            drawn.set_linewidth(0.5)  # as wide as a pixel of a small picture

    @property
    def colours(self) -> list[Colour]:
        """Colours that carry meaning."""
        return [*(colour_bytes(name) for name in ("white", COLOURS["line"])), *self._colours]

    def pixels(self, number: int) -> Pixels:
        """Frame as a (height, width, 3) array."""
        state = self.states[number]
        for drawn, (polygons, colours) in zip(self._drawn, self._painted(number), strict=True):
            vertices: Any = polygons
            drawn.set_verts(vertices)
            drawn.set_facecolor(colours)
            drawn.set_edgecolor(colours)
        for text, words in zip(self._texts, frame_text(state, self.states[-1].mark), strict=True):
            text.set_text(words)
        canvas: Any = self.figure.canvas
        canvas.draw()
        return np.array(canvas.buffer_rgba())[:, :, :3]

    def _painted(self, number: int) -> list[Painted]:
        """What each panel shows of a frame."""
        body = self.states[number].body
        if self._field is None:
            return [body.surface(_VIEW), body.section(self._place)]
        values = self._values[number]
        outside, inside = (
            np.asarray(self._to_colour.to_rgba(each))[:, :3]
            for each in (surface_values(body.mesh, values)[0], values)
        )
        return [body.surface(_VIEW, outside), body.section(self._place, inside)]

    def _colour_by(self, name: OutputField) -> None:
        """Take the values of a field, and draw the bar of its colours."""
        coloured = in_space_paint(name)
        self._values = [
            coloured.factor * fields(state.history, state.index, (name,))[name] for state in self.states
        ]
        scale = common_scale(coloured, self._values)
        self._to_colour = ScalarMappable(scale, coloured.colours)
        box = (_WIDTH_MM - 66.0, 9.0, 60.0, 2.2)
        colour_bar(self.figure, box, self._to_colour, coloured.label, np.concatenate(self._values))
        steps = self._to_colour.cmap(np.linspace(0.0, 1.0, STEPS))
        self._colours = [colour_bytes(to_rgb(colour)) for colour in steps]
