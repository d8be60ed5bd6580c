"""What the pages say that gyrify can and cannot do."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from gyrify.energy.contact import ContactSurface

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


def test_contact_is_planar_and_the_plan_says_so() -> None:
    assert "**contact\nin space does not exist in gyrify**" in page("planning-3d.md")
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    with pytest.raises(ValueError, match="could not be broadcast"):
        ContactSurface(corners, np.arange(4))
