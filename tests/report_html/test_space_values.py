"""What the report of a body in space tells under the pointer: the stored values."""

from __future__ import annotations

import re

import numpy as np
import pytest
from bodies_on_pages import area, cut, section, stored
from reading import changed, check_value

from gyrify.config import Config
from gyrify.report.html import run_page
from gyrify.report.html.shown_fields import SHOWN_IN_SPACE
from gyrify.report.surface_drawing import cut_cells
from gyrify.run.simulation import simulate
from gyrify.store import History
from gyrify.store.fields import fields


@pytest.fixture(scope="module")
def text(lump: History) -> str:
    return run_page(lump, "a body")


@pytest.fixture
def opened(browser, text):
    found = browser.open(text)
    yield found
    assert found.errors == []
    assert len(found.requests) == 1, "only the file itself"
    assert found.requests[0].startswith("file://")


@pytest.mark.parametrize(
    "field", [field for field in SHOWN_IN_SPACE if field.place == "cell"], ids=lambda f: f.name
)
def test_hover_tells_the_stored_value_of_cells_inside(opened, lump: History, field) -> None:
    opened.choose(field.name)
    place = cut(opened, "z")
    values = stored(lump, -1, field.name)
    middles, cells, _ = section(lump, 2, place)
    for k in (0, 7, 21):
        tip = opened.hover(*middles[k])
        assert f"cell {cells[k]} " in tip
        check_value(tip, values[cells[k]], np.ptp(values), precision=3e-4)
        assert f"z {place:.4g}".replace("-", "−") in tip
        assert field.unit in tip


@pytest.mark.parametrize("name", ["von_mises", "thickness", "curvature", "contact_force", "depth"])
def test_hover_tells_the_stored_value_of_the_surface(opened, lump: History, name: str) -> None:
    opened.choose(name)
    opened.page.get_by_role("button", name="front", exact=True).click()
    indices, mesh = opened.run("gyrify.report.run.frames.indices"), lump.mesh
    for frame in (len(indices) - 1, len(indices) // 2):
        opened.seek(frame)
        x, values = lump.points(indices[frame]), stored(lump, indices[frame], name)
        spread = max(np.ptp(stored(lump, index, name)) for index in indices)
        # triangles that look towards +x, nearest to the reader first
        corners = x[mesh.faces]
        facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        order = np.argsort(-facing[:, 0] / np.linalg.norm(facing, axis=1))
        for face in order[:4]:
            nearest = mesh.faces[face][0]
            tip = opened.hover(
                *(corners[face].mean(axis=0) + 0.2 * (x[nearest] - corners[face].mean(axis=0)))
            )
            if name == "von_mises":
                found = int(re.search(r"cell (\d+) ", tip).group(1))
                assert set(mesh.faces[face]) <= set(mesh.cells[found])
                check_value(tip, values[found], spread, precision=3e-4)
            else:
                assert f"surface node {nearest}" in tip
                check_value(tip, values[np.flatnonzero(mesh.contour == nearest)[0]], spread, precision=3e-4)


def test_beside_the_body_there_is_no_value(opened) -> None:
    assert opened.hover(0.0, 0.0, 200.0) == ""


def test_the_picture_follows_growth_and_field(opened) -> None:
    opened.choose("region")
    late = opened.pixels()
    opened.seek(0)
    assert changed(late, opened.pixels()) > 0.1
    pictures = []
    for name in ("region", "J", "von_mises", "circumferential_stress", "thickness", "curvature"):
        opened.choose(name)
        opened.seek(4)
        pictures.append(opened.pixels())
    assert all(changed(a, b) > 0.05 for k, a in enumerate(pictures) for b in pictures[:k])
    title = opened.page.locator(".bar-title").inner_text()
    assert title == "mean curvature [mm⁻¹]"


def test_a_patch_is_whole_across_its_periods(browser) -> None:
    config = Config().with_overrides(
        {
            "geometry.shape": "patch",
            "geometry.length": 10.0,
            "geometry.width": 8.0,
            "geometry.depth": 12.0,
            "mesh.edge_length": 2.0,
            "mesh.n_layers": 5,
            "mesh.n_cortex_layers": 2,
            "stability.detect": False,
            "solver.increments": 2,
            "metrics.closing_radius": 4.0,
        }
    )
    history = simulate(config)
    opened = browser.open(run_page(history, "patch"))
    opened.choose("J")
    place = cut(opened, "z", 0.6)
    mesh, values = history.mesh, fields(history, -1, ["J"])["J"]
    corners = mesh.cell_points + history.displacement()[mesh.cells]
    spans = [cell for cell in range(mesh.n_cells) if np.ptp(mesh.points[mesh.cells[cell], 0]) > 5.0]
    apart = corners.reshape(-1, 3)
    polygons, cells = cut_cells(apart, np.arange(len(apart)).reshape(-1, 4), 2, place)
    wrapped = [k for k in range(len(cells)) if cells[k] in set(spans) and area(polygons[k]) > 0.3]
    assert wrapped
    for k in wrapped[:3]:
        tip = opened.hover(*polygons[k].mean(axis=0), place)
        assert f"cell {cells[k]} " in tip
        check_value(tip, values[cells[k]], max(np.ptp(values), 1e-9), precision=1.0)
    assert opened.errors == []
