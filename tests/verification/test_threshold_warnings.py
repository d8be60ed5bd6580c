"""Nothing is critical only where every value was solved, and exact theory sees nothing beyond the mesh."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from gyrify.cli import main
from gyrify.config import Config
from gyrify.theory import Annulus, critical_growth_ratio
from gyrify.threshold import critical_growth
from gyrify.threshold.crossings import Crossing, Scanned
from gyrify.threshold.stability_scan import StabilityScan
from gyrify.threshold.theory_value import differences, expected_crossings

MESH = {"geometry.shape": "circle", "mesh.n_around": 96, "mesh.n_layers": 8, "mesh.n_cortex_layers": 3}
LOCKED = {**MESH, "material.poisson_ratio": 0.4999}
Capture = pytest.CaptureFixture[str]


def options(values: dict[str, object]) -> list[str]:
    return [word for key, value in values.items() for word in ("--set", f"{key}={value}")]


def test_a_locked_mesh_does_not_say_that_nothing_is_critical(capsys: Capture) -> None:
    command = ["threshold", "--parameter", "growth.time", "--points", "11", *options(LOCKED)]
    assert main([*command, "--json"]) in (0, 1)
    printed = capsys.readouterr()
    found = json.loads(printed.out)
    assert any("locks" in sentence for sentence in found["warnings"])
    for sentence in found["warnings"]:
        assert sentence in printed.err
    if found["critical_value"] is None:
        assert found["unsolved"]
        assert "unknown" in found["reason"]
        assert any("critical growth.time of 236" in sentence for sentence in found["warnings"])
    else:
        assert any("236" in sentence for sentence in found["warnings"])


def test_the_element_that_is_advised_finds_the_exact_value() -> None:
    config = Config().replace(**{**LOCKED, "mesh.element": "mean_dilatation", "mesh.n_around": 216})
    found = critical_growth(config, "growth.time", range=(200.0, 320.0), points=5)
    assert found.critical_value == pytest.approx(236.0, rel=0.1)
    assert found.warnings == ()
    assert found.unsolved == ()


def test_values_that_were_not_solved_are_no_stable_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    scan = [Scanned(1.0, 0), Scanned(2.0), Scanned(3.0, 0)]
    monkeypatch.setattr(StabilityScan, "scan", lambda self, _: (self._start([1.0]), scan)[1])
    config = Config().replace(**MESH, **{"growth.duration": 100.0})
    found = critical_growth(config, "growth.ratio", range=(1.0, 3.0), points=3)
    assert found.critical_value is None
    assert found.unsolved == (1.7320508075688774,) or len(found.unsolved) == 1
    assert "unknown" in found.reason
    assert any("could not be solved" in sentence for sentence in found.warnings)
    assert found.is_known


def test_nothing_computed_is_a_failure(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr(
        StabilityScan, "scan", lambda self, values: (self._start([1.0]), [Scanned(v) for v in values])[1]
    )
    assert main(["threshold", *options(MESH), "--points", "3"]) == 1
    printed = capsys.readouterr()
    assert "Nothing is critical" not in printed.out
    assert "Nothing is known" in printed.out


def test_nothing_is_critical_is_said_where_theory_agrees(capsys: Capture) -> None:
    short = {**MESH, "growth.duration": 100.0}
    assert main(["threshold", "--parameter", "growth.time", "--points", "4", *options(short)]) == 0
    printed = capsys.readouterr()
    assert "Nothing is critical. The smooth state is stable" in printed.out
    assert "Warning" not in printed.err


def test_exact_crossings_are_those_of_the_theory() -> None:
    config = Config().replace(**{"geometry.shape": "circle", "geometry.area": 4071.5040790523717})
    (found,) = expected_crossings(config, "growth.ratio", [1.0, 1.5, 2.0, 3.0])
    assert found == pytest.approx(critical_growth_ratio(Annulus(), [1.0, 2.0])[0].value, rel=1e-3)
    (time,) = expected_crossings(config, "growth.time", [0.0, 200.0, 400.0])
    assert time == pytest.approx(251.6, abs=0.3)
    strip = Config().replace(**{"geometry.shape": "strip"})
    (time,) = expected_crossings(strip, "growth.time", [0.0, 100.0, 200.0, 300.0])
    assert time == pytest.approx(180.2, abs=0.3)
    assert (
        expected_crossings(strip.replace(**{"growth.law": "tangential"}), "growth.time", [0.0, 1.0]) is None
    )


def test_differences_are_told_from_a_tenth_on() -> None:
    at = Crossing(250.0, "unstable", (249.0, 251.0), 18, 12.0, 250.0)

    def told(exact: tuple[float, ...] | None, *found: Crossing) -> list[str]:
        return differences("growth.time", "annulus", exact, found, "Refine.")

    assert told((240.0,), at) == []
    assert told(None, at) == []
    assert (
        told(
            (),
        )
        == []
    )
    (far,) = told((200.0,), at)
    assert "25% apart" in far
    (hidden,) = told((200.0,))
    assert "this mesh shows none" in hidden
    (spurious,) = told((), at)
    assert "may be the mesh's own" in spurious
    assert len(told((200.0,), at, replace(at, value=300.0))) == 2
