"""Where the work of growth goes: stored, dissipated, in contact, lost in jumps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gyrify.report.drawn_slice import FloatArray
from gyrify.report.plot.curves import curves, mark_onset, title_of
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.style import DASHES, HUES, SINGLE, TIME_LABEL, add_legend, literal
from gyrify.run.reevaluation import reevaluated

# 1 Pa mm² per mm of depth is 1e-6 mJ; in space 1 Pa mm³ is.
_MILLIJOULES: Final = 1e-6
_HEIGHTS: Final = (40.0, 32.0)
# Labels, to which "/mm" is added in the plane.
_SHARES: Final = ("stored [mJ", "dissipated [mJ", "contact [µJ", "lost [µJ")
_SURROUNDINGS: Final = "surroundings [mJ"
_LABELS: Final = ("energy [mJ", "energy [µJ")
# Contact and jumps take so little that they are given in microjoules.
_MICRO: Final = 1e3


@dataclass(frozen=True, eq=False)
class Budget:
    """Energy from the start of growth to each state, (n_states,) each: per depth [mJ/mm], in space [mJ].

    ``work`` of growth = ``stored`` in elasticity + ``contact`` + ``external`` in the surroundings +
    ``dissipated`` + ``lost`` in jumps; see `gyrify.run.reevaluation`.
    """

    time: FloatArray
    work: FloatArray
    stored: FloatArray
    dissipated: FloatArray
    contact: FloatArray
    external: FloatArray
    lost: FloatArray

    @staticmethod
    def of(state: Shown) -> Budget:
        """Evaluate the increments of a run up to the shown state again."""
        history, end = state.history, state.index
        rows = [
            (i.work, i.stored, i.dissipated, i.contact, i.external, -i.defect)
            for i in islice(reevaluated(history), end)
        ]
        sums = np.zeros((6, end + 1))
        if rows:
            sums[:, 1:] = _MILLIJOULES * np.cumsum(np.array(rows).T, axis=1)
        return Budget(history.growth_times[: end + 1], *sums)


def energy_plot(states: Sequence[Shown], width_mm: float | None) -> Figure:
    """Energy of one run, small shares below at their own scale; or a panel per share for several runs."""
    width = width_mm or SINGLE
    end = max(state.history.config.growth.duration for state in states)
    per = "" if states[0].in_space else "/mm"
    if len(states) > 1:
        budgets = [Budget.of(state) for state in states]
        labels = [each + per + "]" for each in _SHARES]
        if any(b.external.any() for b in budgets):
            labels.append(f"{_SURROUNDINGS}{per}]")
        title = title_of(states, "Energy against growth")
        figure, panels = curves(title, TIME_LABEL, labels, width, len(labels) * (28.0,))
        _several(panels, states, budgets)
    else:
        figure, panels = curves(
            title_of(states, ""), TIME_LABEL, [each + per + "]" for each in _LABELS], width, _HEIGHTS
        )
        _one(panels, states[0])
    panels[0].set_xlim(0.0, end)
    return figure


def _one(panels: Sequence[Axes], state: Shown) -> None:
    budget = Budget.of(state)
    shares: tuple[tuple[Axes, FloatArray, str, int, int], ...] = (
        (panels[0], budget.work, "work of growth", 4, 0),
        (panels[0], budget.stored, "stored in the tissue", 0, 0),
        (panels[0], budget.dissipated, "dissipated", 1, 1),
        (panels[1], _MICRO * budget.lost, "lost in jumps", 2, 0),
        (panels[1], _MICRO * budget.contact, "stored in contact", 3, 1),
    )
    if budget.external.any():
        shares += ((panels[0], budget.external, "in the surroundings", 5, 1),)
    for axes, values, label, hue, dash in shares:
        axes.plot(budget.time, values, color=HUES[hue], linestyle=DASHES[dash], linewidth=1.2, label=label)
    onset = state.history.onset
    for number, axes in enumerate(panels):
        add_legend(axes, loc="upper left")
        if onset is not None:
            mark_onset(axes, onset.growth_time, "" if number else "onset")


def _several(panels: Sequence[Axes], states: Sequence[Shown], budgets: Sequence[Budget]) -> None:
    for state, budget, hue, dash in zip(states, budgets, HUES, DASHES, strict=False):
        style: dict[str, Any] = {"color": hue, "linestyle": dash, "linewidth": 1.2}
        shares = (
            budget.stored,
            budget.dissipated,
            _MICRO * budget.contact,
            _MICRO * budget.lost,
            budget.external,
        )
        for axes, values in zip(panels, shares, strict=False):  # without surroundings there is no last panel
            axes.plot(budget.time, values, label=literal(state.name), **style)
    add_legend(panels[0], loc="upper left")
