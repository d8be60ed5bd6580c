"""The documentation names every key, command, option, public name and symbol; written pages match."""

from __future__ import annotations

import importlib.util
import re
from types import ModuleType

import pytest
from blocks import ROOT

import gyrify
from gyrify.config import Config
from gyrify.config.rows import rows

DOCS = ROOT / "docs"


def text(name: str) -> str:
    """A page of the documentation."""
    return (DOCS / name).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def writer() -> ModuleType:
    """The script that writes the page of commands."""
    spec = importlib.util.spec_from_file_location("make_command_line", DOCS / "make_command_line.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_configuration_key_is_documented() -> None:
    keys = [row.key for row in rows(Config())]
    assert len(keys) > 40
    page = text("configuration.md")
    absent = [key for key in keys if f"| `{key.rpartition('.')[2]}` |" not in page]
    assert absent == []


def test_the_page_of_commands_is_up_to_date(writer: ModuleType) -> None:
    assert text("command-line.md") == writer.page(), "run: python docs/make_command_line.py"


def test_the_page_of_commands_has_every_option(writer: ModuleType) -> None:
    page, found = text("command-line.md"), 0
    for name, command in writer.commands(writer.app):
        section = page.split(f"## {name}\n")[1].split("\n## ")[0]
        for argument in command.assemble_argument_collection():
            if argument.show:
                found += 1
                assert f"`{argument.names[0]}" in section, f"{name} {argument.names[0]}"
    assert found > 80


def test_every_public_name_is_in_the_reference() -> None:
    pages = "\n".join(page.read_text(encoding="utf-8") for page in (DOCS / "api").glob("*.md"))
    documented = set(
        re.findall(r"auto(?:class|function|exception):: gyrify\.(\w+)(?:\(.*\))?$", pages, re.MULTILINE)
    )
    assert set(gyrify.__all__) - {"__version__"} - documented == set()
    assert documented - set(gyrify.__all__) == set()


def test_the_reference_is_in_short_pages_that_an_index_lists() -> None:
    index = text("api.md")
    assert len(index.splitlines()) < 40
    for page in (DOCS / "api").glob("*.md"):
        names = re.findall(r"auto\w+:: gyrify\.([\w.]+)", page.read_text(encoding="utf-8"))
        assert 1 <= len(names) <= 10, page.name
        assert [name for name in names if f"`{name}`" not in index] == []


def test_members_from_a_base_class_are_in_the_reference() -> None:
    assert ":inherited-members:" in text("api/history.md").split("gyrify.History\n")[1].split("..")[0]
    assert {"at", "plot", "to_pyvista"} <= set(dir(gyrify.History))


def test_the_first_page_has_version_gallery_and_clone() -> None:
    page = text("index.md")
    assert f"This is version {gyrify.__version__};" in page
    assert "git clone <address of the repository>" in page
    assert page.count("](figures/") >= 6


def test_nothing_is_installed_from_where_it_is_not_published() -> None:
    root = DOCS.parent
    files = [root / "README.md", *DOCS.rglob("*.md"), *(root / "src").rglob("*.py")]
    found = [file.name for file in files if "gyrify[" in file.read_text(encoding="utf-8")]
    assert found in ([], ["changelog.md"])


def test_letters_of_the_house_are_in_the_notation() -> None:
    page = text("notation.md")
    letters = ["X", "x", "u", "F", "F_g", "F_e", "J", "J_g", "J_e", "I1", "P", "sigma", "W", "E", "nu", "mu"]
    letters += ["kappa", "G", "T", "R", "d_hat", "barrier_stiffness", "GI", "n_gyri", "sulcal_depth", "tau"]
    assert [letter for letter in letters if f"`{letter}`" not in page] == []
