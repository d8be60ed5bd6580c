"""The recheck of quadratic cells, whose smallest J may lie between integration points."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from forging import edit_row, failures, write_outputs

from gyrify.config import Config
from gyrify.run.measuring import point_extremes
from gyrify.run.simulation import simulate
from gyrify.run.summary import volume_extremes
from gyrify.store import History
from gyrify.verify import verify


@pytest.fixture
def quadratic(tiny: Config, tmp_path: Path) -> Path:
    """Folder of a run of quadratic cells."""
    history = simulate(
        tiny.replace(**{"mesh.element": "quadratic", "mesh.inversion_resistance": 0.1}), tmp_path / "run"
    )
    write_outputs(history, tmp_path / "run")
    history.journal.close()
    return tmp_path / "run"


def test_a_corner_that_is_inverted_between_integration_points_is_found(quadratic: Path):
    """The node on a side of cell 200 moves near its end, which turns the corner there over."""
    history = History.load(quadratic)
    mesh, u = history.mesh, history.state_vector(2)
    start, end, node = mesh.cells[200, [0, 1, 3]]
    x = mesh.points + u
    move = 0.78 * x[start] + 0.22 * x[end] - x[node]
    u[node] += move
    J = history.slice.volume_ratio(u)
    assert J.min() > 0.0
    history.journal.close()

    def turn(blob: bytearray) -> None:
        blob[:] = u.astype("<f8").tobytes()

    edit_row(quadratic, 2, turn, fix_digest=True)
    verification = verify(quadratic)
    found = {check.name: check for check in verification.checks}
    assert {"volume", "elastic volume"} <= failures(verification)
    assert found["volume"].sentence.startswith("The smallest J is -")
    assert "in cell 200 of increment 2" in found["volume"].sentence
    # the energy of an inverted cell is infinite, so that nothing is said of forces and energies
    assert not {"residual", "descent", "energy balance"} & found.keys()


def test_the_smallest_j_of_integration_points_that_earlier_versions_stored_still_passes(quadratic: Path):
    history = History.load(quadratic)
    point, whole = point_extremes(history), volume_extremes(history)
    assert whole[0] < point[0] - 1e-3
    path = quadratic / "summary.json"
    summary = json.loads(path.read_text())
    assert summary["min_J"] == pytest.approx(whole[0], rel=1e-12)
    summary["min_J"], summary["min_J_elastic"] = point
    path.write_text(json.dumps(summary))
    assert "summary.json" not in failures(verify(quadratic))
    summary["min_J"] += 1e-6
    path.write_text(json.dumps(summary))
    assert "summary.json" in failures(verify(quadratic))


def test_the_smallest_j_is_that_of_whole_cells(quadratic: Path):
    """Against the determinants at a lattice of places in every cell."""
    history = History.load(quadratic)
    mesh, J_g = history.mesh, history.slice.volume_growth(500.0).reshape(-1, 3)[:, 0]
    slopes = reference_slopes()
    X, x = mesh.cell_points, mesh.cell_points + history.displacement()[mesh.cells]
    J = np.linalg.det(np.einsum("cai,qaj->cqij", x, slopes)) / np.linalg.det(
        np.einsum("cai,qaj->cqij", X, slopes)
    )
    found = volume_extremes(history)
    assert found == pytest.approx((J.min(), (J / J_g[:, None]).min()), abs=2e-3)
    assert found[0] <= J.min() + 1e-9


def reference_slopes() -> np.ndarray:
    """(n, 6, 2) slopes of the quadratic shape functions at a lattice."""
    L = np.array([(i, j, 60 - i - j) for i in range(61) for j in range(61 - i)]) / 60.0
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    corners = [(4 * L[:, a, None] - 1) * slope[a] for a in range(3)]
    between = [4 * (L[:, a, None] * slope[b] + L[:, b, None] * slope[a]) for a, b in ((0, 1), (1, 2), (2, 0))]
    return np.stack(corners + between, axis=1)
