"""The version of the numerics follows what computes, and not what is said of it."""

from __future__ import annotations

from pathlib import Path

import pytest

import gyrify
from gyrify.base.versions import NUMERICS, code_of

SOURCE = '''"""A module."""

import math  # for pi

# A comment of its own.
ÅNGSTRÖM = "# no comment"  # Å is two bytes


def area(radius: float) -> float:
    """Area of a circle.

    Parameters
    ----------
    radius : float
    """
    text = f"""{radius}
    # no comment either"""
    return math.pi * radius**2  # exact


class Empty:
    """Nothing."""
'''


def test_what_computes_is_kept() -> None:
    assert code_of(SOURCE).splitlines() == [
        "import math",
        'ÅNGSTRÖM = "# no comment"',
        "def area(radius: float) -> float:",
        '    text = f"""{radius}',
        '    # no comment either"""',
        "    return math.pi * radius**2",
        "class Empty:",
    ]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("A module.", "A module of one function."),
        ("# A comment of its own.\n", ""),
        ("  # exact", ""),
        ("radius : float\n", "radius : float\n        Of the circle [mm].\n"),
        ("\n\n\ndef", "\n\ndef"),
        ("\n", "\r\n"),
    ],
)
def test_words_change_nothing(old: str, new: str) -> None:
    assert old in SOURCE
    assert code_of(SOURCE.replace(old, new)) == code_of(SOURCE)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("**2", "**3"),
        ("# no comment either", "# another"),
        ('"# no comment"', '""'),
        ("    return", "        return"),
    ],
)
def test_code_changes_it(old: str, new: str) -> None:
    assert old in SOURCE
    changed = SOURCE.replace(old, new)
    if old == "    return":
        changed = SOURCE.replace("    return math", "    if radius:\n        return math")
    assert code_of(changed) != code_of(SOURCE)


def test_no_words_are_left_of_the_numerics() -> None:
    home = Path(gyrify.__file__).parent
    for name in NUMERICS:
        for file in sorted((home / name).rglob("*.py")):
            code = code_of(file.read_text(encoding="utf-8")).splitlines()
            assert code or file.name == "__init__.py"
            if file.name != "reference.py":  # it writes a page, and has a string that begins with a title
                assert not [line for line in code if line.lstrip().startswith(("#", '"""', 'r"""'))], file
