"""Small runs of every kind to draw, each stored in a folder once per session."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from matplotlib.figure import Figure

from gyrify.config import Config
from gyrify.errors import SolveError
from gyrify.run.simulation import Progress, new_run
from gyrify.store import History

KINDS = {
    "linear": {},
    "softer": {"material.stiffness_ratio": 0.7},
    "quadratic": {"mesh.element": "quadratic", "mesh.n_around": 36, "mesh.inversion_resistance": 0.1},
    "mean_dilatation": {"mesh.element": "mean_dilatation", "geometry.shape": "circle"},
    "strip": {"geometry.shape": "strip", "mesh.n_around": 36},
    "smooth": {"growth.ratio": 1.0, "solver.increments": 4},
    "unseen": {"stability.detect": False, "solver.increments": 4},
    "failed": {"solver.max_newton": 2, "solver.min_increment": 0.05, "growth.duration": 700.0},
    "stopped": {"limits.wall_time": 1e-9},
    "interrupted": {},
}


def _interrupt(progress: Progress) -> None:
    if progress.state.index == 4:
        raise KeyboardInterrupt


@pytest.fixture(scope="session")
def runs(tmp_path_factory: pytest.TempPathFactory, tiny: Config) -> dict[str, Path]:
    """Folders of the runs, by kind."""
    parent = tmp_path_factory.mktemp("runs")
    for name, changes in KINDS.items():
        observers = [_interrupt] if name == "interrupted" else []
        with (
            suppress(SolveError, KeyboardInterrupt),
            new_run(tiny.with_overrides(changes), parent / name) as run,
        ):
            run.grow(observers)
    return {name: parent / name for name in KINDS}


@pytest.fixture(scope="session")
def history(runs: dict[str, Path]) -> Callable[[str], History]:
    """The run of a kind."""
    loaded = {name: History.load(folder) for name, folder in runs.items()}
    return loaded.__getitem__


@pytest.fixture(scope="session")
def words() -> Callable[[Figure], list[str]]:
    """Everything written in a figure, as it is read."""

    def written(figure: Figure) -> list[str]:
        figure.canvas.draw()
        texts = [*figure.texts, *(text for axes in figure.axes for text in axes.texts)]
        for axes in figure.axes:
            texts += [axes.xaxis.label, axes.yaxis.label]
        for legend in [*figure.legends, *(axes.get_legend() for axes in figure.axes)]:
            texts += legend.get_texts() if legend else []
        return [text.get_text() for text in texts if text.get_visible() and text.get_text()]

    return written
