"""The preset ``reference-brain``: its mesh, and its whole growth without a crossing."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.mesh import GREY
from gyrify.metrics.surface import face_areas
from gyrify.model.slice import build_mesh
from gyrify.report.outputs import write_outputs
from gyrify.run.simulation import simulate
from gyrify.verify.recheck import verify


def test_mesh_of_the_reference_brain() -> None:
    mesh = build_mesh(Config.preset("reference-brain"))
    assert (mesh.n_cells, mesh.n_points, mesh.faces.shape[0]) == (43500, 9511, 8000)
    assert np.count_nonzero(mesh.region == GREY) == 24000
    areas = face_areas(mesh.points[mesh.faces])
    # about as large everywhere, on an ellipsoid whose axes differ by a half
    assert areas.max() < 1.5 * areas.min()


@pytest.mark.slow
def test_the_reference_brain_folds_deeply_without_a_crossing(tmp_path: Path) -> None:
    history = simulate(Config.preset("reference-brain"), tmp_path / "brain")
    write_outputs(history, tmp_path / "brain")
    history.journal.close()
    summary = json.loads((tmp_path / "brain" / "summary.json").read_text())
    assert summary["status"] == "completed"
    assert summary["gi"]["area"]["hull"] > 1.7
    assert summary["self_intersecting"] is False
    assert summary["min_gap_mm"] > 0.0
    found = verify(tmp_path / "brain")
    assert [check.sentence for check in found.checks if not check.passed] == []
