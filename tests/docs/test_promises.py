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


def test_the_theory_names_every_file_that_names_the_material() -> None:
    told = re.search(
        r"<!-- files that name the material -->\n(.*?)\n<!-- end -->", page("theory.md"), re.DOTALL
    )
    assert told is not None
    naming = {
        str(file.relative_to(SOURCE))
        for file in SOURCE.rglob("*.py")
        if "neo_hookean" in file.read_text(encoding="utf-8")
    }
    assert set(re.findall(r"`([^`]+)`", told[1])) == naming | {"physics/neo_hookean.py"}


def test_contact_is_planar_and_the_plan_says_so() -> None:
    assert "**contact\nin space does not exist in gyrify**" in page("planning-3d.md")
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    with pytest.raises(ValueError, match="could not be broadcast"):
        ContactSurface(corners, np.arange(4))
