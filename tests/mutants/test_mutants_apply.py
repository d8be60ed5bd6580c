"""The list of mutants fits the sources: a mutant that no longer applies tests nothing."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "tools" / "mutants.py"
_spec = importlib.util.spec_from_file_location("mutants", SCRIPT)
mutants = importlib.util.module_from_spec(_spec)
sys.modules["mutants"] = mutants
_spec.loader.exec_module(mutants)


@pytest.mark.parametrize("mutant", mutants.MUTANTS, ids=lambda mutant: mutant.name)
def test_mutant_applies_and_names_tests(mutant) -> None:
    file = mutants.ROOT / "src" / "gyrify" / mutant.file
    broken = mutants.text_of(mutant, mutants.ROOT)
    assert broken != file.read_text(encoding="utf-8")
    compile(broken, mutant.file, "exec")
    assert mutant.tests
    assert all((mutants.ROOT / test).is_file() for test in mutant.tests)


def test_mutants_are_many_and_have_names() -> None:
    names = [mutant.name for mutant in mutants.MUTANTS]
    assert len(set(names)) == len(names) >= 14


def test_what_numba_compiles_is_told_from_the_source() -> None:
    """A list by hand would go out of date, and a mutant would meet the cache of the unbroken code."""
    sources = mutants.ROOT / "src" / "gyrify"
    found = {str(f.relative_to(sources)) for f in sources.rglob("*.py") if mutants.is_compiled(f.read_text())}
    assert {"energy/batch.py", "physics/stress.py", "physics/materials/neo_hookean.py"} <= found
    assert "solve/newton.py" not in found
