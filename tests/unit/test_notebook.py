"""How a History shows itself in a notebook, and as pandas and PyVista objects."""

from __future__ import annotations

import base64
import re
import sys
from html.parser import HTMLParser

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.errors import GyrifyError
from gyrify.run.simulation import Progress, simulate
from gyrify.store import History


@pytest.fixture(scope="module")
def history(tiny: Config) -> History:
    return simulate(tiny)


class Tags(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:  # noqa: ARG002
        if tag != "img":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_html_has_a_picture_and_the_metrics(history: History) -> None:
    text = history._repr_html_()
    found = re.search(r"data:image/png;base64,([A-Za-z0-9+/=]+)", text)
    assert found is not None
    assert base64.b64decode(found[1]).startswith(b"\x89PNG")
    assert "GI, closing of 10 mm" in text
    assert history.result_hash[:12] in text
    assert len(text) < 300_000
    tags = Tags()
    tags.feed(text)
    assert not tags.open


def test_html_is_escaped(tiny: Config) -> None:
    def observe(progress: Progress) -> None:
        if progress.state.index == 2:
            raise ValueError("<script>alert('x')</script>")

    from gyrify.run.simulation import new_run

    with new_run(tiny) as run:
        with pytest.raises(ValueError):
            run.grow([observe])
        text = run.history._repr_html_()
    assert "<script>" not in text
    assert "&lt;script&gt;" in text


def test_dataframe_has_the_columns_of_the_metrics(history: History) -> None:
    pytest.importorskip("pandas")
    from gyrify.run.summary import metrics_rows

    frame = history.to_dataframe()
    rows = metrics_rows(history)
    assert list(frame.columns) == [key for key in rows[0] if key != "increment"]
    assert len(frame) == len(history)
    assert frame.loc[len(history) - 1, "gi_hull"] == rows[-1]["gi_hull"]


def test_pyvista_grid_has_the_deformed_points_and_all_fields(history: History) -> None:
    pytest.importorskip("pyvista")
    grid = history.to_pyvista(2)
    np.testing.assert_array_equal(np.asarray(grid.points)[:, :2], history.points(2))
    assert grid.n_cells == history.mesh.n_cells
    assert grid.point_data["displacement_done"].shape == (history.mesh.n_points, 3)
    assert grid.cell_data["cauchy_stress"].shape == (history.mesh.n_cells, 9)
    assert set(grid.cell_data["region"]) == {0.0, 1.0}


def test_pyvista_grid_of_quadratic_cells_keeps_their_curved_edges(tiny: Config) -> None:
    pyvista = pytest.importorskip("pyvista")
    history = simulate(
        tiny.with_overrides({"mesh.element": "quadratic", "solver.increments": 2, "growth.duration": 50.0})
    )
    grid = history.to_pyvista()
    assert grid.n_cells == history.mesh.n_cells
    assert set(grid.celltypes) == {int(pyvista.CellType.QUADRATIC_TRIANGLE)}


@pytest.mark.parametrize(("library", "method"), [("pandas", "to_dataframe"), ("pyvista", "to_pyvista")])
def test_a_missing_library_is_named(
    history: History, monkeypatch: pytest.MonkeyPatch, library: str, method: str
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(GyrifyError, match=f"pip install {library} .*notebook"):
        getattr(history, method)()


def test_config_shows_itself_too(tiny: Config) -> None:
    assert "<table>" in tiny._repr_html_()
