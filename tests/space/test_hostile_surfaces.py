"""Files that are no surfaces and would take all memory, or mislead."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from test_surface_files import POINTS, TRIANGLES, gifti
from written_surfaces import config

from gyrify.config.inputs.closed_surface import closed_surface
from gyrify.config.inputs.surface_readers import read_triangles
from gyrify.errors import ConfigError


def test_what_is_no_file_is_refused() -> None:
    with pytest.raises(ConfigError, match="it is a device or a pipe"):
        config(Path("/dev/zero"))


def test_a_small_gifti_that_unfolds_to_much_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = gifti(tmp_path / "a.gii")
    read_triangles(path.read_bytes(), path.name)
    monkeypatch.setattr("gyrify.config.inputs.surface_readers.MOST_BYTES", 100)
    with pytest.raises(ConfigError, match="it unfolds to more than"):
        read_triangles(path.read_bytes(), path.name)


def test_points_that_no_triangle_uses_join_none() -> None:
    far = np.concatenate([POINTS, [[1.7e7, 0.0, 0.0]]])
    assert closed_surface(far, TRIANGLES, "it").points.shape == POINTS.shape
