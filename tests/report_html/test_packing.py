"""Arrays survive the way into a page; pages are small, equal for equal runs, and made of small files."""

from __future__ import annotations

import re
import zlib
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from gyrify.config import Config
from gyrify.errors import HistoryError
from gyrify.report.html import assembly as page
from gyrify.report.html import run_page, write_page
from gyrify.report.html.frames import frames_of, packed_frames, spread
from gyrify.report.html.packing import Payload, coded
from gyrify.report.html.shown_fields import SHOWN, colour_range, describe
from gyrify.run.simulation import simulate
from gyrify.store import History

HOME = files("gyrify.report.html")
SOURCES = sorted(file for kind in ("js", "css") for file in Path(str(HOME / kind)).iterdir())


def unpacked(planes: bytes, rows: int, columns: int, width: int, order: int) -> np.ndarray:
    """What the page does, the slow way: planes, signs, sums."""
    octets = np.frombuffer(planes, dtype=np.uint8).reshape(width, -1).astype(np.int64)
    folded = sum(octets[k] << (8 * k) for k in range(width))
    values = np.where(folded % 2, -(folded // 2) - 1, folded // 2).reshape(rows, columns)
    for _ in range(order):
        values = np.cumsum(values, axis=0)
    return values % (1 << (8 * width))


@given(
    st.sampled_from([np.uint16, np.uint32]).flatmap(
        lambda kind: arrays(kind, st.tuples(st.integers(1, 5), st.integers(1, 6)))
    ),
    st.integers(0, 2),
)
def test_whole_numbers_come_back(codes: np.ndarray, order: int) -> None:
    payload = Payload()
    payload.add("codes", codes, order)
    planes = zlib.decompress(payload.deflated())
    assert np.array_equal(unpacked(planes, *codes.shape, codes.itemsize, order), codes)


def test_values_are_coded_within_half_a_step(rng: np.random.Generator) -> None:
    values = rng.normal(size=(4, 200)) * [[1e-9], [1.0], [1e9], [0.0]]
    values[1, 3] = np.nan
    for n_codes in (2, 255, 65535):
        found = coded(values, n_codes)
        back = found.low[:, None] + (found.codes.astype(float) - 1.0) * found.step[:, None]
        assert found.codes[1, 3] == 0
        assert found.codes.max() == n_codes
        off = np.abs(back - values)[np.isfinite(values) & (found.codes > 0)]
        limits = np.broadcast_to(found.step[:, None], values.shape)[np.isfinite(values)]
        assert np.all(off <= 0.5 * limits * (1 + 1e-6) + 1e-12 * np.abs(values[np.isfinite(values)]))


def test_too_large_a_run_is_thinned_and_coarsened(folded: History) -> None:
    frames = frames_of(folded, 51)
    whole, text = packed_frames(folded.mesh, frames, None)
    tight, small = packed_frames(folded.mesh, frames, None, budget=len(text) // 3)
    assert whole["indices"] == frames.indices
    assert len(small) <= len(text) // 3 * 4 // 3 + 4
    assert tight["fields"][0]["step"][-1] >= whole["fields"][0]["step"][-1]
    assert (tight["indices"][0], tight["indices"][-1]) == (0, len(folded) - 1)


def test_states_are_spread_evenly() -> None:
    assert spread(101, 51) == list(range(0, 101, 2))
    assert spread(3, 51) == [0, 1, 2]
    assert spread(1, 51) == [0]
    assert spread(100, 4) == [0, 33, 66, 99]


def test_signed_fields_have_zero_in_the_middle(rng: np.random.Generator) -> None:
    low, high = colour_range(rng.normal(1.0, 1.0, (3, 500)), "diverging")
    assert low == -high < 0.0
    thickness = next(field for field in SHOWN if field.name == "thickness")
    assert describe(thickness, np.full((2, 9), 1.5))["range"] == [1.0, 2.0]
    grown = describe(thickness, np.array([np.full(9, 1.0), np.linspace(2.0, 3.0, 9)]))
    assert grown["range"] == [1.0, grown["ranges"][1][1]]
    # A few extreme values do not decide.
    assert colour_range(np.append(np.linspace(0.0, 1.0, 999), 1e6)[None], "sequential")[1] < 1.0


def test_equal_runs_make_equal_pages(tiny: Config) -> None:
    first, second = (run_page(simulate(tiny), "run") for _ in range(2))
    # The time that it took is measured anew.
    assert re.sub(r'"time spent",[^,]+,', "", first) == re.sub(r'"time spent",[^,]+,', "", second)
    history = simulate(tiny)
    assert run_page(history, "run") == run_page(history, "run")
    assert "/" + "tmp" not in first


def test_a_page_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    write_page("text", tmp_path / "report.html")
    assert [file.name for file in tmp_path.iterdir()] == ["report.html"]
    with pytest.raises(HistoryError, match="cannot be written"):
        write_page("text", tmp_path / "no" / "report.html")


@pytest.mark.parametrize("file", SOURCES, ids=lambda file: file.name)
def test_scripts_and_styles_are_small(file: Path) -> None:
    lines = file.read_text(encoding="utf-8").splitlines()
    assert len(lines) <= 300
    assert not re.search(
        r"innerHTML|outerHTML|insertAdjacent|document\.write|\beval\b|https?://(?!www\.w3)", "\n".join(lines)
    )
    starts = [k for k, line in enumerate(lines) if re.match(r"(async )?function ", line)]
    for start in starts:
        length = next(k for k in range(start, len(lines)) if lines[k] == "}") - start + 1
        assert length <= 60, lines[start]


def test_every_script_and_style_is_in_a_page() -> None:
    named = {*page.STYLES, *page.RUN_SCRIPTS, *page.SPACE_SCRIPTS, *page.STUDY_SCRIPTS}
    assert {file.name for file in SOURCES} == named
