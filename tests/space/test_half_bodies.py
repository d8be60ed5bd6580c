"""Half a body that ends in a plane of symmetry does what the half of the whole does."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from written_volumes import config, half_ball, mirrored, plain

from gyrify import Study, run_study
from gyrify.config import Config
from gyrify.energy.plane_contact import FacingPoints, PlaneContact
from gyrify.errors import ConfigError, MeshError
from gyrify.model.meshing import build_mesh
from gyrify.model.rigid import kept_modes, rigid_modes
from gyrify.model.slice import Slice
from gyrify.report.outputs import write_outputs
from gyrify.run.body_measures import measured
from gyrify.run.onset.space_waves import surface_wave
from gyrify.run.simulation import simulate
from gyrify.run.validity import config_warnings
from gyrify.store.fields import fields
from gyrify.verify.recheck import verify

AXES = (1.2, 1.0, 0.9)
HALF = half_ball(3, axes=AXES)
CUT = {"boundary.clamp": "plane"}
GROWTH = {
    "growth.law": "area",
    "growth.ratio": 1e4,
    "mesh.element": "mean_dilatation",
    "solver.increments": 4,
    "solver.tolerance": 1e-9,
    "growth.duration": 150.0,
}


def necked(points: Any) -> Any:
    """A body whose section in the plane is small: its walls face the plane."""
    share = 0.4 + 0.6 * np.minimum(np.abs(points[:, 1:2]) / 3.0, 1.0)
    return points * np.concatenate([share, np.ones_like(share), share], axis=1)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, Any, Path]:
    """Histories of a half and of the whole, and the folder of the half."""
    home = tmp_path_factory.mktemp("halves")
    half = simulate(
        config(plain(home / "half.mesh", *HALF), **CUT, **GROWTH, **{"dissipation.number": 0.2}),
        home / "half",
    )
    whole = simulate(
        config(plain(home / "whole.mesh", *mirrored(*HALF)), **GROWTH, **{"dissipation.number": 0.2})
    )
    return half, whole, home / "half"


def test_the_half_moves_as_the_half_of_the_whole(both: tuple[Any, Any, Path]) -> None:
    half, whole, _ = both
    n = half.mesh.n_points
    for number in range(1, len(half)):
        u, wanted = half.state_vector(number), whole.state_vector(number)[:n]
        size = np.abs(wanted).max()
        assert size > 0.1
        # clusters of cells that share a volume ratio are not mirror images in the whole
        assert np.abs(u - wanted).max() < 0.06 * size
        assert not u[half.mesh.on_plane, 1].any()


def test_linear_cells_move_to_the_last_digits(tmp_path: Path) -> None:
    found = []
    for points, cells, more in ((*HALF, CUT), (*mirrored(*HALF), {})):
        given = {**GROWTH, **more, "mesh.element": "linear", "dissipation.number": 0.2}
        found.append(simulate(config(plain(tmp_path / f"{len(points)}.mesh", points, cells), **given)))
    u, wanted = (history.state_vector(-1)[: len(HALF[0])] for history in found)
    assert np.abs(u - wanted).max() < 1e-6 * np.abs(wanted).max()


def test_it_is_measured_with_its_image(both: tuple[Any, Any, Path]) -> None:
    half, whole, folder = both
    write_outputs(half, folder)
    found = verify(folder)
    assert [check.sentence for check in found.checks if not check.passed] == []
    summary = json.loads((folder / "summary.json").read_text())
    assert (folder / "folded.png").stat().st_size > 10_000
    measures = measured(whole.mesh, whole.points(-1), whole.config.metrics)
    assert half.config.metrics.closing_radius == pytest.approx(whole.config.metrics.closing_radius)
    assert summary["surface_area_mm2"] == pytest.approx(measures.surface_area, rel=0.01)
    assert summary["volume_mm3"] == pytest.approx(measures.volume, rel=0.01)
    assert summary["gi"]["area"]["hull"] == pytest.approx(measures.gi_area_hull, abs=0.01)


def test_fields_of_the_surface_are_those_of_the_whole(both: tuple[Any, Any, Path]) -> None:
    """At the rim, too, where the half has triangles on one side alone."""
    half, whole, _ = both
    found, wanted = (fields(history, -1, ["curvature", "thickness"]) for history in (half, whole))
    contour = half.mesh.contour
    for name, most in (("curvature", 0.15), ("thickness", 0.03)):
        error = np.abs(found[name] - wanted[name][: half.mesh.n_points])[contour]
        assert error.max() < most * np.abs(wanted[name][contour]).max()


def test_it_is_free_to_slide_in_the_plane(tmp_path: Path) -> None:
    """Without drag three supports are left, on which nothing pulls."""
    given = config(plain(tmp_path / "a.mesh", *HALF), **CUT, **GROWTH, **{"dissipation.kind": "none"})
    problem = Slice(given)
    modes = kept_modes(rigid_modes(problem.mesh.points), 3 * problem.mesh.on_plane + 1)
    assert modes.shape[1] == 3
    assert problem.free.size - problem.supported.size == 3
    history = simulate(given)
    state = history.journal.state(len(history) - 1)
    total = problem.energy(1.0, history.journal.state(len(history) - 2), 0.75)
    force = np.zeros(problem.state_shape).ravel()
    force[problem.free] = total.slope(state.u)[1].ravel()[problem.free]
    assert np.abs(force).max() < 100.0 * problem.stepping.criterion.force


def test_walls_press_against_the_plane_and_do_not_cross_it(tmp_path: Path) -> None:
    points, cells = half_ball(3)
    path = plain(tmp_path / "a.mesh", necked(points), cells)
    growing = {**GROWTH, "growth.rate": 0.004, "growth.duration": 500.0, "solver.tolerance": 1e-6}
    gaps, least = {}, np.inf
    for enabled in (True, False):
        history = simulate(config(path, **CUT, **growing, **{"contact.enabled": enabled}))
        facing = history.slice.facing
        gaps[enabled] = facing.gap - history.state_vector(-1)[facing.points, 1]
        least = float(facing.gap.min())
    assert gaps[False].min() < 0.0
    assert 0.0 < gaps[True].min() < 0.5 * least


def test_the_barrier_is_the_derivative_of_its_energy() -> None:
    rng = np.random.default_rng(4)
    facing = FacingPoints(np.array([0, 2, 3]), np.array([0.4, 0.9, 3.0]), np.array([1.0, 2.0, 3.0]), 1, -1.0)
    term, u = PlaneContact(facing, 1.0, 7.0), rng.uniform(-0.1, 0.1, size=(5, 3))
    found, h = term.evaluate(u, 2), 1e-6
    assert found.gradient is not None
    assert found.hessian is not None
    dense = np.zeros((15, 15))
    dense[found.hessian.pattern.rows, found.hessian.pattern.cols] = found.hessian.values
    for dof in range(15):
        step = np.zeros(15)
        step[dof] = h
        up, down = (term.evaluate(u + s * step.reshape(5, 3), 1) for s in (1.0, -1.0))
        slope = (up.value - down.value) / (2.0 * h)
        assert found.gradient.ravel()[dof] == pytest.approx(slope, abs=1e-6)
        assert up.gradient is not None
        assert down.gradient is not None
        assert dense[:, dof] == pytest.approx((up.gradient - down.gradient).ravel() / (2.0 * h), abs=1e-5)
    # it pushes away from the plane, which is at the lower end
    assert found.gradient[0, 1] < 0.0
    assert found.gradient[3, 1] == 0.0
    down = np.zeros((5, 3))
    down[:, 1] = -1.0
    step = term.max_step(0.0 * u, down)
    assert step == pytest.approx(0.9 * 0.4)
    assert term.max_step(0.0 * u, -down) == 1.0
    assert np.isinf(term.evaluate(down, 0).value)


def test_the_other_side_is_the_mirror_image(tmp_path: Path) -> None:
    points, cells = half_ball(2, axes=AXES)
    lower = config(plain(tmp_path / "a.mesh", points, cells), **CUT, **GROWTH)
    image = points * np.array([1.0, -1.0, 1.0]) + np.array([0.0, 3.0, 0.0])
    plane = {"point": [0, 3, 0], "normal": [0, -1, 0]}
    upper = config(plain(tmp_path / "b.mesh", image, cells), **CUT, **GROWTH, **{"boundary.plane": plane})
    u, v = (simulate(given).state_vector(-1) for given in (lower, upper))
    assert np.abs(v * np.array([1.0, -1.0, 1.0]) - u).max() < 1e-6 * np.abs(u).max()
    again = Config.from_toml(upper.to_toml())
    assert again.config_hash == upper.config_hash != lower.config_hash


def test_pieces_that_the_plane_cuts_are_parts_or_holes(tmp_path: Path) -> None:
    points, cells = half_ball(3)
    beside = np.concatenate([points, 0.7 * points + np.array([40.0, 0.0, 0.0])])
    both = np.concatenate([cells, cells + len(points)])
    free = {**CUT, "dissipation.number": 0.2}
    mesh = build_mesh(config(plain(tmp_path / "two.mesh", beside, both), **free))
    assert mesh.clamped.size == 0
    reach = mesh.points[mesh.contour].max(axis=0)
    assert reach[0] == pytest.approx(54.0)
    assert (mesh.region[len(cells) :] == 1).sum() > 100
    # a cavity that the plane opens
    middle = np.abs(points[cells].mean(axis=1)).max(axis=1)
    labels = np.where(middle < 6.0, 3, np.where(middle < 12.0, 2, 1))
    given = {"geometry.labels": {"grey": [1], "white": [2], "hole": [3]}}
    hollow = build_mesh(config(plain(tmp_path / "a.mesh", points, cells, labels), **free, **given))
    assert hollow.clamped.size > 0
    assert np.linalg.norm(hollow.points[hollow.clamped], axis=1).max() < 14.0
    assert np.linalg.norm(hollow.points[hollow.contour], axis=1).min() == pytest.approx(20.0)


def test_a_cut_that_is_not_flat_is_made_flat_or_refused(tmp_path: Path) -> None:
    points, cells = half_ball(4)
    on_cut = points[:, 1] == 0.0
    for size, fits in ((1e-4, True), (0.05, False)):
        rough = points.copy()
        rough[on_cut, 1] = -size * np.random.default_rng(1).uniform(size=on_cut.sum())
        given = config(plain(tmp_path / f"{size}.mesh", rough, cells), **CUT)
        if fits:
            mesh = build_mesh(given)
            assert mesh.on_plane.size == on_cut.sum()
            assert not mesh.points[mesh.on_plane, 1].any()
            assert any("were moved into boundary.plane" in text for text in config_warnings(given))
        else:
            with pytest.raises(MeshError, match=r"does not lie in boundary.plane: .* leave it, first at \("):
                build_mesh(given)


def test_forces_of_the_plane_are_told(tmp_path: Path) -> None:
    points, cells = half_ball(3)
    path = plain(tmp_path / "a.mesh", necked(points), cells)
    growing = {**GROWTH, "growth.rate": 0.004, "growth.duration": 500.0, "solver.tolerance": 1e-6}
    history = simulate(config(path, **CUT, **growing))
    force = fields(history, -1, ["contact_force"])["contact_force"]
    gap = history.slice.facing.gap - history.state_vector(-1)[history.slice.facing.points, 1]
    nearest = history.slice.facing.points[np.argmin(gap)]
    assert force[nearest, 1] < 0.0


def test_modes_have_the_degree_of_the_whole(tmp_path: Path) -> None:
    ball = build_mesh(config(plain(tmp_path / "a.mesh", *mirrored(*half_ball(5)))))
    half = build_mesh(config(plain(tmp_path / "b.mesh", *half_ball(5)), **CUT))
    for mesh in (ball, half):
        x = mesh.points / np.maximum(np.linalg.norm(mesh.points, axis=1, keepdims=True), 1e-9)
        height = 35.0 * x[:, 1] ** 4 - 30.0 * x[:, 1] ** 2 + 3.0  # P4 about the normal of the plane
        assert surface_wave(mesh, np.zeros_like(x), height[:, None] * x)[0] == 4


def test_everything_is_told_and_read_again(tmp_path: Path) -> None:
    """Keys that are tables reach every file."""
    points, cells = half_ball(3)
    middle = np.abs(points[cells].mean(axis=1)).max(axis=1)
    path = plain(
        tmp_path / "a.mesh", points + np.array([0.0, 3.0, 0.0]), cells, np.where(middle < 12.0, 2, 1)
    )
    keys = {"boundary.plane": {"point": [0, 3, 0]}, "geometry.labels": {"grey": [1], "white": [2]}}
    given = config(path, **CUT, **keys, **{"solver.increments": 2, "growth.duration": 50.0})
    history = simulate(given, tmp_path / "run")
    write_outputs(history, tmp_path / "run")
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["parameters"]["geometry.labels"] == {"grey": [1], "white": [2], "hole": []}
    assert summary["parameters"]["boundary.plane"]["point"] == [0.0, 3.0, 0.0]
    assert [check.sentence for check in verify(tmp_path / "run").checks if not check.passed] == []
    # a part of a table that is laid over another one leaves the rest
    turned = given.with_overrides({"boundary.plane": {"normal": [0, -1, 0]}})
    assert turned.boundary.plane.point == (0.0, 3.0, 0.0)
    design = {"key": "growth.rate", "values": [0.001, 0.002]}
    base = {name: section for name, section in given.to_dict().items() if isinstance(section, dict)}
    study = Study.from_mapping({"base": base, "design": {"kind": "grid", "parameter": [design]}})
    found = run_study(study, tmp_path / "study")
    assert [record.status for record in found.records.values()] == ["completed", "completed"]


def test_what_does_not_fit_is_refused(tmp_path: Path) -> None:
    path = plain(tmp_path / "a.mesh", *HALF)
    for plane, words in (
        ({"point": [0, -5, 0]}, r"both sides of boundary.plane: \(.*\) mm is 5 mm beyond"),
        ({"point": [0, 5, 0]}, r"no face in boundary.plane: .* is 5 mm away"),
        ({"normal": [0, -1, 0]}, "both sides of boundary.plane"),
    ):
        with pytest.raises(MeshError, match=words):
            build_mesh(config(path, **CUT, **{"boundary.plane": plane}))
    with pytest.raises(ConfigError, match="unit vector along an axis"):
        config(path, **CUT, **{"boundary.plane": {"normal": [1, 1, 0]}})
    with pytest.raises(ConfigError, match=r'plane is not allowed with boundary.clamp = "hole"'):
        config(path, **{"boundary.plane": {"point": [0, 1, 0]}})
    with pytest.raises(ConfigError, match=r'"plane" is not allowed with geometry.shape = "ellipse"'):
        Config().with_overrides(CUT)
