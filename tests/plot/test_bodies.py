"""Pictures and animations of bodies in space: what is drawn is what is stored, to one true scale."""

from __future__ import annotations

import re
from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from PIL import Image

import gyrify
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.mesh.boundary import boundary_faces, straight_cells
from gyrify.model.slice import build_mesh
from gyrify.report.animate import frames_of
from gyrify.report.animate_body import BodyScene
from gyrify.report.plot.field_colours import PAINTS, common_scale
from gyrify.report.plot.mode import mode_row
from gyrify.report.plot.shown import Shown
from gyrify.report.plot.space_figure import space_figure
from gyrify.report.surface_drawing import VIEWS, DrawnBody, cut_cells
from gyrify.run.simulation import simulate
from gyrify.solve.stability import Onset
from gyrify.store import History
from gyrify.store.fields import fields

STRESSES = ("von_mises", "mean_stress", "circumferential_stress")


def panels(figure) -> list[PolyCollection]:
    """What is drawn in each panel, in order."""
    return [c for axes in figure.axes for c in axes.collections if isinstance(c, PolyCollection)]


def scales(figure) -> list[float]:
    """Inches of the page to a mm of the body, along both axes of every panel."""
    width, height = figure.get_size_inches()
    found = []
    for axes in figure.axes:
        if axes.axison:
            continue
        place = axes.get_position()
        found.append(place.width * width / np.ptp(axes.get_xlim()))
        found.append(place.height * height / np.ptp(axes.get_ylim()))
    return found


def bar_mm(figure) -> tuple[float, float]:
    """Length that the scale bar covers, and what it says [mm]."""
    figure.canvas.draw()
    (bar,) = [item for item in figure.get_children() if isinstance(item, Line2D)]
    inches = float(np.ptp(bar.get_xdata())) * figure.get_figwidth()
    (said,) = [text.get_text() for text in figure.texts if re.fullmatch(r"[\d.]+ mm", text.get_text())]
    return inches / scales(figure)[0], float(said.split()[0])


@pytest.mark.parametrize("what", ["folded", "stress", "thickness"])
def test_three_views_and_a_section_have_one_true_scale(lump: History, words, what: str) -> None:
    figure = gyrify.plot(lump, what)
    rows = {"folded": 1, "stress": 3, "thickness": 1}[what]
    assert len(panels(figure)) == 4 * rows
    assert scales(figure) == pytest.approx([scales(figure)[0]] * 8 * rows)
    length, said = bar_mm(figure)
    assert length == pytest.approx(said)
    told = words(figure)
    for view in VIEWS:
        assert told.count(view) == rows
    assert sum(word.startswith("section at x = ") for word in told) == rows
    assert any("GI by area 1.02" in word for word in told)
    room = figure.bbox.width
    assert all(text.get_window_extent().x1 <= room for text in figure.texts)


def test_stresses_in_colour_are_the_stored_ones(lump: History) -> None:
    figure = gyrify.plot(lump, "stress")
    drawn, mesh, x = panels(figure), lump.mesh, lump.points()
    place = 0.5 * float(x[mesh.contour, 0].min() + x[mesh.contour, 0].max())
    _, cells = cut_cells(x, mesh.cells, 0, place)
    for row, name in enumerate(STRESSES):
        values = PAINTS[name].factor * fields(lump, -1, [name])[name]
        scale = common_scale(PAINTS[name], [values])
        colours = mpl.colormaps[PAINTS[name].colours](scale(values[cells]))
        assert drawn[4 * row + 3].get_facecolor() == pytest.approx(colours)
        # on the surface: of the cell below each triangle that faces the reader, in its hue
        cell_of = {
            frozenset(face): cell
            for cell, nodes in enumerate(mesh.cells.tolist())
            for face in combinations(nodes, 3)
            if set(face) <= set(mesh.contour.tolist())
        }
        corners = x[mesh.faces]
        up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0.0
        order = np.flatnonzero(up)[np.argsort(corners[up][:, :, 2].mean(axis=1), kind="stable")]
        owners = [cell_of[frozenset(face)] for face in mesh.faces[order].tolist()]
        full = mpl.colormaps[PAINTS[name].colours](scale(values[owners]))[:, :3]
        painted = drawn[4 * row + 1].get_facecolor()[:, :3]
        light = (painted * full).sum(axis=1) / (full * full).sum(axis=1)
        assert painted == pytest.approx(light[:, None] * full, abs=1e-9)
    labels = [axes.get_xlabel() for axes in figure.axes if axes.get_xlabel()]
    assert labels == ["von Mises stress [kPa]", "mean stress [kPa]", "stress along the layers [kPa]"]


def test_light_changes_how_bright_a_value_is_but_not_its_hue(lump: History) -> None:
    body = DrawnBody(lump.mesh, lump.points())
    colour = np.tile([0.8, 0.4, 0.2], (len(lump.mesh.faces), 1))
    triangles, painted = body.surface("from above", colour)
    brightness = painted[:, 0] / 0.8
    assert painted == pytest.approx(brightness[:, None] * colour[0])
    assert 0.6 < brightness.min() < 0.9 < brightness.max() <= 1.0
    # drawn are those that face the reader, the far ones first
    corners = body.corners
    up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0.0
    heights = np.sort(corners[up][:, :, 2].mean(axis=1))
    by_place = {tuple(np.round(c[:, :2].mean(axis=0), 9)): c[:, 2].mean() for c in corners[up]}
    drawn = [by_place[tuple(np.round(triangle.mean(axis=0), 9))] for triangle in triangles]
    assert drawn == pytest.approx(heights)


@pytest.mark.parametrize("element", ["linear", "quadratic"])
def test_the_boundary_is_that_of_the_cells(lump: History, element: str) -> None:
    from gyrify.model.meshing import build_mesh

    mesh = build_mesh(lump.config.with_overrides({"mesh.element": element}))
    faces, owners = boundary_faces(mesh)
    n = len(mesh.faces)
    assert np.array_equal(np.sort(faces[:n], axis=1), np.sort(mesh.faces, axis=1))
    assert np.isin(faces[n:], mesh.clamped).all()
    assert all(set(face) < set(mesh.cells[cell]) for face, cell in zip(faces, owners, strict=True))
    corners = mesh.points[faces]
    volume = np.einsum("ni,ni->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    parts = straight_cells(mesh)
    edges = mesh.points[parts[:, 1:]] - mesh.points[parts[:, :1]]
    assert volume == pytest.approx(np.abs(np.linalg.det(edges)).sum() / 6.0)
    first = len(parts) // mesh.n_cells
    assert all(set(part) <= set(mesh.cells[k // first]) for k, part in enumerate(parts))


def test_bodies_are_compared_at_one_scale(lump: History, history, words) -> None:
    figure = gyrify.plot(lump, compare=[lump], at=250.0)
    assert len(panels(figure)) == 8
    assert scales(figure) == pytest.approx([scales(figure)[0]] * 16)
    assert sum("t = 250" in word for word in words(figure)) == 2
    with pytest.raises(ConfigError, match="in the plane and in space"):
        gyrify.plot(lump, compare=[history("linear")])


def test_curves_have_the_indices_and_units_of_space(lump: History, words) -> None:
    figure = gyrify.plot(lump, "gi")
    measures = gyrify.measure_state(lump)
    ends = [line.get_ydata()[-1] for line in figure.axes[0].lines[:3]]
    assert ends == pytest.approx([measures.gi_area_closing, measures.gi_area_hull, measures.gi_sections])
    assert "mean of sections" in words(figure)
    figure = gyrify.plot(lump, "energy")
    assert [axes.get_ylabel() for axes in figure.axes] == ["energy [mJ]", "energy [µJ]"]
    # 1 Pa mm3 is 1e-6 mJ
    stored = next(line for line in figure.axes[0].lines if line.get_label() == "stored in the tissue")
    energy = (
        lump.slice.tissue_energy(1.0, lump.state_vector()).terms[0].evaluate(lump.state_vector(), 0).value
    )
    assert stored.get_ydata()[-1] == pytest.approx(1e-6 * energy)
    figure = gyrify.plot(lump, "energy", compare=[lump])
    assert figure.axes[0].get_ylabel() == "stored [mJ]"


def test_what_has_no_meaning_in_space_is_refused_by_name(lump: History) -> None:
    with pytest.raises(ConfigError, match="no circumferential modes"):
        gyrify.plot(lump, "dispersion")
    with pytest.raises(ConfigError, match=r"stability.detect = false"):
        gyrify.plot(lump, "mode")


def test_a_mode_is_drawn_by_how_far_it_moves_the_surface_outwards(lump: History) -> None:
    mesh = lump.mesh
    x = mesh.points
    along = np.zeros_like(x)
    along[:, 2] = 1.0  # a translation: outwards above, inwards below
    onset = Onset(100.0, (90.0, 110.0), 0.0, 1, 30.0, np.zeros_like(x), along)
    row = mode_row(Shown(lump, 2, "run"), onset)
    values = row.values[mesh.contour]
    top, bottom = x[mesh.contour, 2].argmax(), x[mesh.contour, 2].argmin()
    assert values[top] == pytest.approx(1.0, abs=0.02)
    assert values[bottom] == pytest.approx(-1.0, abs=0.02)
    assert np.isnan(np.delete(row.values, mesh.contour)).all()
    moved = row.body.points - x
    assert moved == pytest.approx(np.linalg.norm(moved[0]) * along)
    assert np.linalg.norm(moved[0]) == pytest.approx(0.03 * np.ptp(x[mesh.contour, 0]))


@pytest.mark.parametrize("field", ["tissue", "von_mises"])
def test_growth_is_animated(lump: History, tmp_path, field: str) -> None:
    path = gyrify.animate(lump, tmp_path / "a.gif", field=field, width=240, fps=10.0, seconds=1.0)
    with Image.open(path) as gif:
        assert gif.n_frames == len(lump)
        assert gif.width == 240
        pictures = [np.array(gif.convert("RGB")) for n in range(gif.n_frames) if gif.seek(n) is None]
    assert not any(np.array_equal(a, b) for a, b in zip(pictures[1:], pictures[:-1], strict=True))
    assert (
        path.read_bytes()
        == gyrify.animate(
            lump, tmp_path / "b.gif", field=field, width=240, fps=10.0, seconds=1.0
        ).read_bytes()
    )


def test_frames_keep_their_scale_and_say_time_and_index(lump: History) -> None:
    states, _ = frames_of(lump, 10)
    scene = BodyScene(states, 240, "mean_stress")
    frame = scene.pixels(0)
    assert frame.shape == (scene.size[1], 240, 3)
    limits = [(axes.get_xlim(), axes.get_ylim()) for axes in scene.axes]
    scene.pixels(len(states) - 1)
    assert limits == [(axes.get_xlim(), axes.get_ylim()) for axes in scene.axes]
    (low, high), (bottom, top) = limits[0]
    x = lump.points()
    assert low <= x[:, 0].min() < x[:, 0].max() <= high
    assert bottom <= x[:, 2].min() < x[:, 2].max() <= top
    told = [text.get_text() for text in scene.figure.texts]
    assert "growth time 500 of 500" in told
    assert any(text.startswith("GI by area 1.02 (closing, 12 mm)") for text in told)
    # the section has the stored values of the last state
    _, cells = cut_cells(lump.points(), lump.mesh.cells, 0, scene._place)
    values = [1e-3 * fields(lump, state.index, ["mean_stress"])["mean_stress"] for state in states]
    scale = common_scale(PAINTS["mean_stress"], values)
    expected = mpl.colormaps["RdBu_r"](scale(values[-1][cells]))
    assert scene._drawn[1].get_facecolor() == pytest.approx(expected)


def test_the_onset_in_space_is_read_back_with_three_components(tmp_path) -> None:
    config = Config().with_overrides(
        {
            "geometry.shape": "sphere",
            "geometry.semi_axes": (12.0, 12.0, 12.0),
            "geometry.hole_fraction": 0.0,
            "geometry.cortical_thickness": 2.0,
            "mesh.edge_length": 9.0,
            "mesh.n_layers": 4,
            "mesh.n_cortex_layers": 2,
            "solver.increments": 2,
            "stability.detect": False,
        }
    )
    history = simulate(config, tmp_path / "ball")
    n = history.mesh.n_points
    state, mode = np.arange(6.0 * n).reshape(2, n, 3)
    history.journal.set_onset(Onset(1.0, (0.5, 1.5), 0.0, 2, 3.0, state, mode), ())
    found = history.onset
    assert np.array_equal(found.displacement, state)
    assert np.array_equal(found.vector, mode)


def test_panels_of_a_body_that_is_wider_than_long_do_not_overlap() -> None:
    mesh = build_mesh(
        Config().with_overrides(
            {
                "geometry.shape": "ellipsoid", "geometry.semi_axes": (12.0, 20.0, 14.0),
                "geometry.hole_fraction": 0.0, "mesh.edge_length": 6.0, "mesh.n_layers": 4,
                "mesh.n_cortex_layers": 2,
            }
        )
    )  # fmt: skip
    figure = space_figure(mesh, mesh.points)
    boxes = [axes.get_position() for axes in figure.axes[:4]]
    for k, one in enumerate(boxes):
        for other in boxes[k + 1 :]:
            apart = one.x1 <= other.x0 or other.x1 <= one.x0 or one.y1 <= other.y0 or other.y1 <= one.y0
            assert apart
