"""Runs of bodies inside surfaces: they need nothing outside their folder, and damage of it is seen."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import meshio
import numpy as np
import pytest
from solids import BRAIN
from written_surfaces import config, ellipsoid, off, stl

from gyrify.errors import ConfigError, HistoryError, MeshError
from gyrify.metrics.surface_pairs import crosses_itself, smallest_gap
from gyrify.model import kept_mesh
from gyrify.report.outputs import write_outputs
from gyrify.run.simulation import resume, simulate, stored_run
from gyrify.store import History
from gyrify.store.export import export
from gyrify.verify.recheck import verify

FOLDING = {key: BRAIN[key] for key in BRAIN if key.partition(".")[0] not in ("geometry", "mesh")}
FOLDING |= {"mesh.element": "mean_dilatation", "mesh.node_jitter": 0.02, "solver.increments": 4}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run whose files are gone."""
    home = tmp_path_factory.mktemp("space")
    points, triangles = ellipsoid(4, (24.0, 20.0, 18.0))
    path = stl(home / "mine.stl", points, triangles)
    history = simulate(config(path, **FOLDING), home / "run")
    write_outputs(history, home / "run")
    history.journal.close()
    path.unlink()
    kept_mesh._made.clear()
    return home / "run"


def test_a_run_needs_nothing_outside_its_folder(folder: Path, tmp_path: Path) -> None:
    moved = tmp_path / "elsewhere"
    shutil.copytree(folder, moved)
    kept_mesh._made.clear()
    found = verify(moved)
    assert [check.sentence for check in found.checks if not check.passed] == []
    history = History.load(moved)
    summary = json.loads((moved / "summary.json").read_text())
    assert summary["status"] == "completed"
    assert summary["parameters"]["geometry.file"] == "inputs/surface.stl"
    assert summary["gi"]["area"]["hull"] >= 1.0
    assert 'file = "inputs/surface.stl"' in (moved / "config.toml").read_text()
    assert (moved / "folded.png").stat().st_size > 10_000
    (grid,) = export(history, "vtu", tmp_path / "brain.vtu")
    assert meshio.read(grid).cells[0].type == "tetra"
    assert export(history, "stl", tmp_path / "brain.stl")
    again = simulate(moved / "config.toml", tmp_path / "again")
    assert again.result_hash == history.result_hash


def test_it_resumes_to_the_same_bytes_without_its_file(folder: Path, tmp_path: Path) -> None:
    class Enough(Exception):
        pass

    def stop(progress) -> None:
        if progress.state.index == 2:
            raise Enough

    path = stl(tmp_path / "mine.stl", *ellipsoid(4, (24.0, 20.0, 18.0)))
    with pytest.raises(Enough):
        simulate(config(path, **FOLDING), tmp_path / "cut", observers=[stop])
    path.unlink()
    kept_mesh._made.clear()
    again = resume(tmp_path / "cut")
    assert len(again) > 3
    assert again.result_hash == History.load(folder).result_hash


def test_the_same_surface_under_another_name_is_the_same_run(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "run")
    other = stl(tmp_path / "other.stl", *ellipsoid(4, (24.0, 20.0, 18.0)))
    before = (tmp_path / "run" / "journal.sqlite").stat().st_mtime_ns
    history = simulate(config(other, **FOLDING), tmp_path / "run")
    assert history.status == "completed"
    assert (tmp_path / "run" / "journal.sqlite").stat().st_mtime_ns == before
    larger = stl(tmp_path / "larger.stl", *ellipsoid(4, (24.0, 20.0, 18.5)))
    with pytest.raises(HistoryError, match=r"another configuration: geometry\.digest"):
        simulate(config(larger, **FOLDING), tmp_path / "run")
    # a run may be replaced by one of the very file that it keeps
    kept = tmp_path / "run" / "inputs" / "surface.stl"
    given = {**FOLDING, "growth.rate": 0.0, "solver.increments": 1}
    simulate(config(kept, **given), tmp_path / "run", overwrite=True)
    assert kept.is_file()


@pytest.mark.parametrize("damage", ["surface gone", "surface changed", "mesh damaged", "mesh of another"])
def test_damage_of_the_copies_is_seen(damage: str, folder: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    shutil.copytree(folder, run)
    kept_mesh._made.clear()
    surface, mesh = run / "inputs" / "surface.stl", run / "inputs" / "mesh.npz"
    if damage == "surface gone":
        surface.unlink()
    elif damage == "surface changed":
        stl(surface, *ellipsoid(4, (24.0, 20.0, 19.0)))
    elif damage == "mesh damaged":
        data = bytearray(mesh.read_bytes())
        data[len(data) // 2] ^= 255
        mesh.write_bytes(bytes(data))
    else:
        journal = History.load(run).journal.meta("mesh")
        assert len(journal) == 64
        _exchange(run, mesh)
    with pytest.raises((HistoryError, MeshError), match=r"lacks a file|is damaged|is not the one"):
        _ = History.load(run).mesh


def _exchange(run: Path, mesh: Path) -> None:
    """Put another mesh under the name of the run's own."""
    with np.load(mesh) as archive:
        arrays = dict(archive)
    arrays["points"][-1] += 1e-9
    np.savez_compressed(mesh, **arrays)
    assert mesh.is_relative_to(run)


def test_two_bodies_in_one_file_meet(tmp_path: Path) -> None:
    """Two hemispheres that grow press against each other, and do not cross."""
    points, triangles = ellipsoid(3, (10.0, 9.0, 9.0))
    apart = np.array([10.2, 0.0, 0.0])
    both = np.concatenate([points - apart, points + apart])
    path = off(tmp_path / "two.off", both, np.concatenate([triangles, triangles + len(points)]))
    given = {
        **FOLDING,
        "growth.ratio": 1.0,
        "growth.law": "isotropic",
        "growth.rate": 4e-4,
        "solver.increments": 4,
    }
    given |= {"geometry.cortical_thickness": 2.0, "dissipation.number": 0.01}
    with pytest.raises(ConfigError, match="2 closed surfaces"):
        config(path, **{**given, "dissipation.kind": "none"})
    history = simulate(config(path, **given))
    mesh = history.mesh
    moved = history.points(-1)[mesh.contour]
    left = mesh.points[mesh.contour][:, 0] < 0.0
    faces = np.searchsorted(mesh.contour, mesh.faces)
    assert np.ptp(moved[:, 1]) > 1.1 * 18.0
    assert moved[~left, 0].mean() - moved[left, 0].mean() > 20.4 + 1.0
    assert 0.0 < smallest_gap(moved, faces) < 0.3
    assert not crosses_itself(moved, faces)


def test_a_stored_run_keeps_its_own_copies(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "run")
    shutil.copy(folder / "inputs" / "surface.stl", tmp_path / "copy.stl")
    other = {"geometry.file": str(tmp_path / "copy.stl")}
    with (
        pytest.raises(ConfigError, match="keeps its configuration"),
        stored_run(tmp_path / "run", other),
    ):
        pass
    assert History.load(tmp_path / "run").result_hash
