"""Stability by four columns of a mesh, against the inertia of the whole mesh."""

from __future__ import annotations

import numpy as np
import pytest
from validity_cases import PUBLISHED, case

from gyrify.config import Config
from gyrify.run.validity.resolution import _SmoothMesh, mesh_onset
from gyrify.threshold import critical_growth

CIRCLE = {"geometry.shape": "circle", "mesh.n_layers": 7, "mesh.n_cortex_layers": 3}
MESHES = {
    "linear": {**CIRCLE, "mesh.n_around": 80},
    "one diagonal": {**CIRCLE, "mesh.n_around": 80, "mesh.split": "one"},
    "mean dilatation": {**CIRCLE, "mesh.n_around": 80, "mesh.element": "mean_dilatation"},
    "quadratic": {**CIRCLE, "mesh.n_around": 40, "mesh.element": "quadratic"},
    "cortex refined": {**CIRCLE, "mesh.n_around": 40, "mesh.refine_cortex": 1},
    "generalised": {**CIRCLE, "mesh.n_around": 80, "growth.out_of_plane": "generalised"},
    "tangential": {**CIRCLE, **PUBLISHED, "mesh.n_around": 160},
    "strip": {
        "geometry.shape": "strip",
        "mesh.n_around": 40,
        "mesh.n_layers": 10,
        "mesh.n_cortex_layers": 4,
    },
}


def onset_of_columns(config: Config, start: float, end: float) -> float:
    mesh = _SmoothMesh(config)
    assert mesh.is_stable(start)
    assert not mesh.is_stable(end)
    while end - start > 0.02:
        middle = 0.5 * (start + end)
        start, end = (middle, end) if mesh.is_stable(middle) else (start, middle)
    return 0.5 * (start + end)


@pytest.mark.parametrize("name", MESHES)
def test_four_columns_lose_stability_with_the_whole_mesh(name: str) -> None:
    config = case(MESHES[name])
    exact = mesh_onset(config).expected.growth_time
    low, high = 0.9 * exact, 1.8 * exact
    whole = critical_growth(config, "growth.time", range=(low, min(high, 500.0)), points=6, tolerance=1e-5)
    found = onset_of_columns(config, low, min(high, 500.0))
    # Along z the columns take the exact F33, and the whole mesh its own.
    tolerance = 5e-3 if name == "generalised" else 2e-3
    assert found == pytest.approx(whole.critical_value, rel=tolerance)


def test_refined_meshes_are_taken_by_their_size() -> None:
    """Columns and layers halved, instead of more columns: the same matrix size, nearly the same answer."""
    coarse = case({**CIRCLE, "mesh.n_around": 40, "mesh.refine": 1})
    found = onset_of_columns(coarse, 230.0, 450.0)
    whole = critical_growth(coarse, "growth.time", range=(230.0, 450.0), points=6, tolerance=1e-5)
    assert found == pytest.approx(whole.critical_value, rel=1e-2)
    assert (
        _SmoothMesh(coarse).columns.work
        < 40 * _SmoothMesh(case({**CIRCLE, "mesh.n_around": 40})).columns.work
    )


def test_every_wave_of_a_coarse_mesh_is_tried() -> None:
    phases = _SmoothMesh(case({**CIRCLE, "mesh.n_around": 80})).columns._phases(19)
    np.testing.assert_allclose(phases, 2 * np.pi * np.arange(11) / 20)
