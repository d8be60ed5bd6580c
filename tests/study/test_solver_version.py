"""The version of the numerics covers everything that a result is computed with, and nothing else."""

from __future__ import annotations

import ast
import shutil
from pathlib import Path

import pytest

import gyrify
from gyrify.base import versions

SOURCE = Path(gyrify.__file__).parent
# Read on the way to a result without a part in it: how runs are kept, told, and fail.
NO_PART = {"base", "errors", "store"}


def imported(part: str) -> set[str]:
    """Packages right below gyrify that a package imports."""
    found = set()
    for file in sorted((SOURCE / part).rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("gyrify."):
                found.add(str(node.module).split(".")[1])
    return found


def test_it_covers_all_that_a_run_and_its_summary_import() -> None:
    reached: set[str] = set()
    waiting = {"run"}
    while waiting:
        part = waiting.pop()
        reached.add(part)
        waiting |= imported(part) - reached - NO_PART
    assert reached == set(versions.NUMERICS)


@pytest.fixture
def copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    home = Path(shutil.copytree(SOURCE, tmp_path / "gyrify", ignore=shutil.ignore_patterns("__pycache__")))
    monkeypatch.setattr(versions, "__file__", str(home / "base" / "versions.py"))
    return home


def test_it_changes_with_numerics_and_libraries_and_with_nothing_else(
    copied: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def version() -> str:
        return versions.solver_version.__wrapped__()

    first = version()
    assert first == version() == versions.solver_version()
    (copied / "cli" / "run.py").write_text("# another text")
    assert version() == first
    kernel = copied / "physics" / "materials" / "neo_hookean.py"
    kernel.write_text(kernel.read_text() + "\nHALF = 0.5\n")
    assert version() != first
    kernel.unlink()
    assert len({first, version()}) == 2
    before = version()
    monkeypatch.setattr(versions, "versions", lambda: {"numpy": "0.1"})
    assert version() != before
