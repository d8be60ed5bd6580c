"""Reports of every element, shape and end of a run."""

from __future__ import annotations

import re

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.report.html import run_page
from gyrify.run.simulation import simulate
from gyrify.store import History

KINDS = {
    "quadratic": {"mesh.element": "quadratic", "mesh.inversion_resistance": 0.1},
    "mean_dilatation": {"mesh.element": "mean_dilatation", "geometry.shape": "circle"},
    "strip": {"geometry.shape": "strip", "growth.duration": 300.0},
    "generalised": {"growth.out_of_plane": "generalised"},
    "one increment, no contact": {"solver.increments": 1, "contact.enabled": False, "growth.duration": 20.0},
}


@pytest.mark.parametrize("changes", KINDS.values(), ids=list(KINDS))
def test_every_kind_is_drawn_and_read(browser, tiny: Config, changes: dict[str, object]) -> None:
    history = simulate(tiny.with_overrides(changes))
    opened = browser.open(run_page(history, "run"))
    for name in ("region", "J", "von_mises", "curvature", "contact_force"):
        opened.choose(name)
        seen = len(np.unique(opened.pixels().reshape(-1, 3), axis=0))
        assert seen > (20 if name == "von_mises" else 3)
    opened.choose("von_mises")
    # Under the middle of a cell lies that cell, whole cells and parts of quadratic ones alike.
    mesh, x = history.mesh, history.points()
    # Nodes between corners make the inner part of a quadratic cell.
    nodes = mesh.cells[:, -3:]
    corners = mesh.cell_points[:, -3:] - mesh.points[nodes] + x[nodes]
    for cell in (0, mesh.n_cells // 2, mesh.n_cells - 3):
        found = re.search(r"cell (\d+) ", opened.hover(*map(float, corners[cell].mean(axis=0))))
        assert found
        assert int(found.group(1)) == cell
    assert opened.errors == []


def test_a_run_of_one_state_is_shown(browser, tiny: Config) -> None:
    history = only_the_start(tiny)
    opened = browser.open(run_page(history, "run"))
    assert opened.run("gyrify.panel.player.slider.disabled")
    assert opened.page.get_by_label("play").is_disabled()
    opened.choose("J")
    assert opened.hover(*map(float, history.points()[history.mesh.cells[0]].mean(axis=0))).startswith(
        "1.0000"
    )
    assert opened.page.get_by_role("alert").is_visible()
    assert opened.errors == []


def only_the_start(config: Config) -> History:
    """A run that failed in its first increment."""
    history = simulate(config)
    connection = history.journal._connection
    connection.execute("DELETE FROM increments WHERE number > 0")
    connection.execute("DELETE FROM onset")
    history.journal.set_meta(status="failed", reason="Newton's method did not converge.", advice="")
    history.__dict__.pop("positions", None)
    return history
