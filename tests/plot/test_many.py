"""Any number of slices in a grid, the slices of a study, and a name of its own for each picture."""

from __future__ import annotations

from pathlib import Path

import pytest
from matplotlib.figure import Figure

import gyrify
from gyrify.cli import main
from gyrify.cli.plot import default_name
from gyrify.config import Config
from gyrify.errors import ConfigError
from gyrify.report.plot.slices import grid_columns
from gyrify.report.plot.style import letter_of


@pytest.mark.parametrize(("what", "each"), [("folded", 1), ("stress", 3), ("thickness", 2)])
def test_more_than_eight_runs_make_a_grid(runs, what: str, each: int, words) -> None:
    others = [runs[("linear", "softer")[number % 2]] for number in range(27 if what == "folded" else 8)]
    figure = gyrify.plot(runs["linear"], what, compare=others)
    n_panels = each * (len(others) + 1)
    letters = [text for text in words(figure) if text.isalpha() and len(text) <= 2 and text != "GI"]
    assert letters == [letter_of(number) for number in range(n_panels)]
    slices = [axes for axes in figure.axes if not axes.axison]
    assert len(slices) == (n_panels if what != "thickness" else n_panels // 2)
    assert not _overlap(slices)


def _overlap(panels: list) -> bool:
    """Whether two panels share paper."""
    boxes = [axes.get_position() for axes in panels]
    return any(
        min(a.x1, b.x1) - max(a.x0, b.x0) > 1e-9 and min(a.y1, b.y1) - max(a.y0, b.y0) > 1e-9
        for number, a in enumerate(boxes)
        for b in boxes[:number]
    )


def test_columns_leave_room_for_labels() -> None:
    assert [grid_columns(n, 180.0) for n in (2, 3, 4, 9, 10, 25, 200)] == [2, 3, 2, 3, 4, 5, 6]
    assert grid_columns(50, 90.0) == 3
    assert [letter_of(n) for n in (0, 25, 26, 51, 52)] == ["a", "z", "aa", "az", "ba"]


def test_every_picture_has_a_name_of_its_own(runs, tmp_path: Path, capsys) -> None:
    folder, other = runs["linear"], runs["softer"]
    options = [
        [],
        ["--at", "300"],
        ["--compare", str(other)],
        ["--compare", str(other), str(runs["strip"])],
        ["--what", "stress", "--stress", "mean"],
    ]
    for given in options:
        assert main(["plot", str(folder), "--dpi", "50", *given]) == 0
    files = capsys.readouterr().out.split()
    assert files[0].endswith("plot-folded.png")
    assert files[2].endswith("plot-folded-with-softer.png")
    assert files[4].endswith("plot-stress-mean.png")
    assert len(set(files)) == len(options)
    others = [tmp_path / f"{'long' * 10}{number}" for number in range(4)]
    names = {default_name(folder, "gi", None, others[:n], None) for n in range(5)}
    assert len(names) == 5
    assert max(map(len, names)) < 100
    for file in files:
        Path(file).unlink()


def test_every_animation_has_a_name_of_its_own(runs, capsys) -> None:
    for field in ("tissue", "von_mises"):
        command = ["animate", str(runs["linear"]), "--fps", "4", "--seconds", "1", "--width", "200"]
        assert main([*command, "--field", field, "--quiet"]) == 0
    out = capsys.readouterr().out
    assert "growth.gif" in out
    assert "growth-von_mises.gif" in out
    for name in ("growth.gif", "growth-von_mises.gif"):
        (runs["linear"] / name).unlink()


@pytest.fixture(scope="module")
def study(tiny: Config, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of two numbers, in whose middle a run fails."""
    folder = tmp_path_factory.mktemp("grid")
    design = {
        "kind": "grid",
        "parameter": [
            {"key": "growth.ratio", "values": [1.0, 3.6]},
            {"key": "material.stiffness_ratio", "values": [1.0, 2.0]},
        ],
    }
    base = {**tiny.to_dict(), "output": {}, "limits": {}}
    gyrify.run_study({"base": base, "design": design}, folder)
    return folder


def test_a_study_is_a_grid_of_its_slices(study: Path, words, capsys) -> None:
    figure: Figure = gyrify.plot(study)
    told = words(figure)
    slices = [axes for axes in figure.axes if not axes.axison]
    assert len(slices) == 4
    assert [text for text in told if text.startswith("stiffness")] == [
        f"stiffness ratio {value}" for value in (2, 2, 1, 1)
    ]
    assert [text for text in told if text.startswith("growth ratio")] == [
        f"growth ratio {value}" for value in (1, 3.6, 1, 3.6)
    ]
    assert slices[0].get_position().y0 == slices[1].get_position().y0 > slices[2].get_position().y0
    assert main(["plot", str(study), "--dpi", "50"]) == 0
    assert capsys.readouterr().out.strip() == str(study / "plot-folded.png")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"what": "gi"}, "what = gi is not possible for the study"),
        ({"at": 100.0}, "at = 100 is not possible"),
        ({"compare": ["x"]}, r"compare is not possible .* keep = .all."),
    ],
)
def test_what_a_study_cannot_show_is_refused(study: Path, options: dict, message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        gyrify.plot(study, **options)


def test_runs_that_did_not_complete_say_so(tiny: Config, tmp_path: Path, words) -> None:
    failing = {"limits": {"wall_time": 1e-9}}
    design = {"kind": "list", "point": [{"seed": 0}, {"seed": 1}]}
    base = {**tiny.to_dict(), **failing}
    gyrify.run_study({"base": base, "design": design}, tmp_path)
    rows = gyrify.read_results(tmp_path).to_pylist()
    assert {row["status"] for row in rows} == {"stopped"}
    assert sum(text == "run stopped" for text in words(gyrify.plot(tmp_path))) == 2
