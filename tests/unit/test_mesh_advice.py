"""Refusals of meshes and of sizes name numbers that work."""

from __future__ import annotations

import re

import numpy as np
import pytest

from gyrify.config import Config
from gyrify.config.cross_checks import MAX_GROWTH, _below
from gyrify.errors import ConfigError, MeshError
from gyrify.mesh.quality import SliverError
from gyrify.model.meshing import build_mesh

DEEP = {"geometry.shape": "strip", "geometry.length": 48.15, "geometry.depth": 65.0}
REFUSED = {
    "a deep strip": {**DEEP, "geometry.cortical_thickness": 1.0, "mesh.n_around": 192},
    "a deeper strip": {
        **DEEP,
        "geometry.depth": 200.0,
        "geometry.cortical_thickness": 1.0,
        "mesh.n_around": 96,
    },
    "a strip of wide columns": {**DEEP, "geometry.cortical_thickness": 0.02, "mesh.n_around": 24},
    "a thin cortex": {"geometry.cortical_thickness": 0.05},
    "a thin cortex, refined": {"geometry.cortical_thickness": 0.05, "mesh.refine": 1},
    "a thin cortex, symmetric": {"geometry.cortical_thickness": 0.05, "mesh.split": "symmetric"},
    "many columns": {"mesh.n_around": 4096},
    "many columns, quadratic": {"mesh.n_around": 4096, "mesh.element": "quadratic"},
}


@pytest.mark.parametrize("changes", REFUSED.values(), ids=list(REFUSED))
def test_every_number_that_the_advice_names_makes_a_mesh(changes: dict[str, object]) -> None:
    config = Config.preset("reference-slice").with_overrides(changes)
    with pytest.raises(MeshError) as caught:
        build_mesh(config)
    ways = re.findall(r"(mesh\.\w+) = (\d+)", caught.value.advice)
    assert ways, caught.value
    together = [dict(ways)] if " with " in caught.value.advice else [{key: value} for key, value in ways]
    for changed in together:
        assert build_mesh(config.with_overrides({k: int(v) for k, v in changed.items()})).n_cells > 0


def test_the_deep_strip_is_told_what_is_wrong_with_it() -> None:
    config = Config.preset("reference-slice").with_overrides(REFUSED["a deep strip"])
    with pytest.raises(SliverError, match=r"0\.251 mm wide are too narrow for layers of 25\.\d mm") as caught:
        build_mesh(config)
    assert caught.value.advice.startswith("Try mesh.n_around = ")
    columns = int(re.findall(r"n_around = (\d+)", caught.value.advice)[0])
    assert 96 < columns < 192


@pytest.mark.filterwarnings("error")
def test_where_no_single_number_helps_the_advice_says_so() -> None:
    config = Config.preset("reference-slice").replace(**{"geometry.cortical_thickness": 5e-4})
    with pytest.raises(MeshError, match=r"Try a thicker cortex, or a smaller shape"):
        build_mesh(config)


def test_factors_within_a_limit_are_rounded_down(rng: np.random.Generator) -> None:
    for factor in 10.0 ** rng.uniform(-6, 9, 2000):
        for exact in (factor, float(f"{factor:.3g}")):
            product = float(_below(MAX_GROWTH, exact)) * exact
            assert 0.98 * MAX_GROWTH < product <= MAX_GROWTH


def test_too_many_refinements_are_lowered() -> None:
    config = Config.preset("reference-slice")
    with pytest.raises(ConfigError, match=r"at most 4000000\. Try mesh\.refine = 4 and") as caught:
        config.with_overrides({"mesh.refine": 4, "mesh.refine_cortex": 4})
    lowered = {key: int(value) for key, value in re.findall(r"(mesh\.\w+) = (\d+)", str(caught.value))}
    assert config.with_overrides(lowered).mesh.refine == 4
