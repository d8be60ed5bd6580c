"""The preset ``converged-slice`` is what its name says."""

from __future__ import annotations

from pathlib import Path

import pytest

from gyrify import Config, converge
from gyrify.run.validity.converged import limit_of


def test_it_is_the_standard_slice_whose_limit_is_known() -> None:
    limit = limit_of(Config.preset("converged-slice"))
    assert limit is not None
    assert limit.follow_branch


@pytest.mark.slow
def test_converge_says_so(tmp_path: Path) -> None:
    """Index, onset, visible folds and energy; the number of gyri is within one."""
    fine = Config.preset("converged-slice")
    start = fine.with_overrides({"mesh.refine": 0})
    family = converge(start, levels=3, of=["mesh"], workers=2, out=tmp_path).family("mesh")
    assert family.levels[-1].config.config_hash == fine.config_hash
    verdicts, limit = family.verdicts, limit_of(fine)
    for name in ("gi_closing", "onset_growth_time", "visible_growth_time", "elastic_energy_mJ_per_mm"):
        assert verdicts[name].converged, name
    assert limit is not None
    assert verdicts["gi_closing"].limit == pytest.approx(limit.gi_closing, abs=limit.uncertainty)
    assert abs(verdicts["n_gyri"].values[-1] - verdicts["n_gyri"].values[-2]) <= 1
