"""What the pages say that gyrify can and cannot do."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gyrify.config import Config
from gyrify.errors import ConfigError

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "gyrify"


def page(name: str) -> str:
    return (ROOT / "docs" / name).read_text(encoding="utf-8")


def test_a_material_is_named_in_its_own_file_in_the_list_and_as_the_default_alone() -> None:
    naming = {
        str(file.relative_to(SOURCE))
        for file in SOURCE.rglob("*.py")
        if re.search("neo_hookean|NEO_HOOKEAN", file.read_text(encoding="utf-8"))
    }
    defaults = {"config/physics_sections.py"}
    defaults |= {f"energy/{name}.py" for name in ("elastic", "axial", "mean_dilatation")}
    own = {"physics/materials/neo_hookean.py", "physics/materials/__init__.py"}
    assert naming == own | defaults | {"run/validity/exact_bodies.py"}


def test_what_is_not_built_in_space_is_refused() -> None:
    said = page("space.md").split("## What is not built yet")[1]
    assert "follow_branch" not in said
    with pytest.raises(ConfigError, match="in space"):
        Config().with_overrides({"geometry.shape": "sphere", "mesh.inversion_resistance": 0.1})
