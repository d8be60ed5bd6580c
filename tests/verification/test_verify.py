"""A stored run passes its recheck; a run that was tampered with does not."""

from __future__ import annotations

import json
import shutil
import sqlite3
from pathlib import Path

import numpy as np
import pytest
from forging import edit_row, failures, flip_a_bit, nudge, write_outputs

from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.run.reevaluation import reevaluated
from gyrify.run.simulation import simulate
from gyrify.verify import verify
from gyrify.verify.recheck import ENERGY_BOUND


@pytest.fixture(scope="module")
def stored(folding: Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a run with contact."""
    folder = tmp_path_factory.mktemp("verify") / "run"
    history = simulate(folding, folder)
    write_outputs(history, folder)
    history.journal.close()
    return folder


@pytest.fixture
def copy(stored: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(stored, tmp_path / "run"))


def test_a_run_with_contact_passes_every_check(stored: Path):
    verification = verify(stored)
    assert verification.passed, str(verification)
    assert [check.name for check in verification.checks] == [
        "states",
        "configuration",
        "time series",
        "result hash",
        "residual",
        "stored residual",
        "descent",
        "volume",
        "elastic volume",
        "energy balance",
        "simple contour",
        "gap",
        "path",
        "metrics.csv",
        "summary.json",
    ]
    assert json.loads(json.dumps(verification.as_dict()))["passed"] is True
    assert str(verification).count("\n") == 14
    assert "FAILED" not in str(verification)


@pytest.mark.parametrize(
    "reading",
    [
        {"dissipation.kind": "none", "growth.duration": 300.0},
        {"dissipation.kind": "kelvin_voigt", "dissipation.number": 0.05},
        {"growth.out_of_plane": "none", "growth.stretch": "exponential"},
        {"growth.law": "tangential", "growth.energy_per": "reference"},
        {"contact.enabled": False},
        {"growth.rate": 0.0},
        {"growth.out_of_plane": "generalised"},
        {"growth.out_of_plane": "generalised", "growth.out_of_plane_exponent": 0.13},
        {"dissipation.course": "reduced", "growth.out_of_plane_exponent": 0.5},
        {"mesh.element": "quadratic", "growth.duration": 300.0},
        {"mesh.element": "quadratic", "mesh.inversion_resistance": 0.1},
        {"mesh.element": "mean_dilatation"},
        {"geometry.shape": "strip", "mesh.n_layers": 12},
    ],
    ids=lambda reading: ",".join(map(str, reading.values())),
)
def test_every_reading_passes(tiny: Config, reading: dict[str, object], tmp_path: Path):
    simulate(tiny.with_overrides(reading), tmp_path / "run").journal.close()
    verification = verify(tmp_path / "run")
    assert verification.passed, str(verification)
    assert ("gap" in {check.name for check in verification.checks}) == reading.get("contact.enabled", True)


def test_a_flipped_bit_is_a_damaged_state(copy: Path):
    edit_row(copy, 5, flip_a_bit, fix_digest=False)
    verification = verify(copy)
    assert failures(verification) == {"states"}
    assert "Increment 5" in str(verification)
    assert len(verification.checks) == 1  # nothing is said of what cannot be read


def test_a_forged_state_with_a_mended_checksum_is_out_of_equilibrium(copy: Path):
    edit_row(copy, 5, nudge, fix_digest=True)
    found = failures(verify(copy))
    assert {"result hash", "residual", "stored residual"} <= found
    assert "states" not in found


def test_a_forged_state_is_caught_without_any_derived_file(copy: Path):
    edit_row(copy, 5, nudge, fix_digest=True)
    (copy / "summary.json").unlink()
    (copy / "metrics.csv").unlink()
    assert "residual" in failures(verify(copy))


def test_a_missing_increment_is_noticed(copy: Path):
    with sqlite3.connect(copy / "journal.sqlite") as database:
        database.execute("DELETE FROM increments WHERE number = 7")
    database.close()
    assert "states" in failures(verify(copy))


def test_an_end_that_was_cut_off_is_noticed(copy: Path):
    with sqlite3.connect(copy / "journal.sqlite") as database:
        database.execute("DELETE FROM increments WHERE number = (SELECT max(number) FROM increments)")
    database.close()
    (copy / "summary.json").unlink()
    assert "states" in failures(verify(copy))


def test_a_changed_metric_in_the_summary_is_named(copy: Path):
    path = copy / "summary.json"
    summary = json.loads(path.read_text())
    summary["gi"]["closing"] += 1e-6
    path.write_text(json.dumps(summary))
    verification = verify(copy)
    assert failures(verification) == {"summary.json"}
    assert "gi.closing" in str(verification)


def test_a_changed_metric_in_the_table_is_named(copy: Path):
    path = copy / "metrics.csv"
    lines = path.read_text().splitlines()
    column = lines[0].split(",").index("n_gyri")
    cells = lines[-1].split(",")
    cells[column] = str(int(cells[column]) + 1)
    path.write_text("\n".join([*lines[:-1], ",".join(cells)]) + "\n")
    verification = verify(copy)
    assert failures(verification) == {"metrics.csv"}
    assert "n_gyri" in str(verification)


def test_another_configuration_file_is_noticed(copy: Path):
    config = Config.load(copy / "config.toml")
    (copy / "config.toml").write_text(config.replace(**{"growth.ratio": 3.5}).to_toml())
    assert failures(verify(copy)) == {"configuration"}


def test_what_is_only_written_and_not_computed_may_change_in_the_configuration_file(copy: Path):
    config = Config.load(copy / "config.toml")
    (copy / "config.toml").write_text(config.replace(**{"output.every": 5}).to_toml())
    assert verify(copy).passed


def test_a_damaged_summary_is_a_failed_check(copy: Path):
    (copy / "summary.json").write_text('{"status": ')
    verification = verify(copy)
    assert failures(verification) == {"summary.json"}
    assert "summary.json is damaged" in str(verification)


def test_a_damaged_configuration_file_is_a_failed_check(copy: Path):
    (copy / "config.toml").write_text("[geometry")
    assert "configuration" in failures(verify(copy))


def test_a_folder_without_a_run_is_refused(tmp_path: Path):
    with pytest.raises(HistoryError, match="no journal"):
        verify(tmp_path)


def test_work_of_growth_at_rest_is_the_closed_form(tiny: Config):
    """Held at u = 0 the energy of a grown, blocked cell is J_g kappa/2 (lambda_g^-3 - 1)^2 per area."""
    from gyrify.model.slice import Slice
    from gyrify.run.reevaluation import _growth_power

    problem = Slice(tiny.replace(**{"growth.ratio": 1.0}))
    u, t, step = np.zeros((problem.mesh.n_points, 2)), 0.4, 1e-5

    def energy(fraction: float) -> float:
        stretch = 1.0 + fraction  # 0.002 * 500 = 1
        density = stretch**3 * 0.5 * problem.bulk_modulus * (stretch**-3 - 1.0) ** 2
        return float(density @ problem.simplices.volumes)

    expected = (energy(t + step) - energy(t - step)) / (2.0 * step)
    assert _growth_power(problem, t, u, {}) == pytest.approx(expected, rel=1e-6)


def test_energy_balance_closes_and_its_defect_falls_with_the_square_of_the_increments(tiny: Config):
    """Smooth growth: both quadratures are of second order, so halving the increments divides by about 4."""
    smooth = tiny.replace(**{"dissipation.kind": "kelvin_voigt", "dissipation.number": 0.2})
    defects = []
    for increments in (8, 16, 32):
        run = list(reevaluated(simulate(smooth.replace(**{"solver.increments": increments}))))
        assert len(run) == increments
        work = sum(increment.work for increment in run)
        defects.append(sum(abs(increment.defect) for increment in run) / work)
        assert sum(increment.dissipated for increment in run) / work > 0.05
    assert defects[0] < ENERGY_BOUND
    assert defects[0] / defects[1] > 3.0
    assert defects[1] / defects[2] > 3.0
    print("defects over work of growth, 8, 16, 32 increments:", defects)
