"""Imports run one way, and files and functions stay small."""

from __future__ import annotations

import ast
import importlib
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import gyrify

SOURCE = Path(gyrify.__file__).parent

# Each layer may import from the layers above it in this list, and from its own package.
LAYERS = [
    {"errors", "versions", "markup", "scratch"},
    {"arguments", "compiled"},
    {"config", "physics", "mesh", "theory", "limits"},
    {"energy", "metrics"},
    {"solve", "meshing", "phenotype"},
    {"tissue"},
    {"terms"},
    {"model"},
]
# What kernels and readers may know, more strictly than by their layer.
MAY_IMPORT = {
    "config": {"arguments", "errors"},
    "physics": {"compiled", "errors"},
    "mesh": {"errors"},
    "theory": {"errors"},
    "energy": {"compiled", "physics", "errors"},
    "solve": {"energy", "physics", "mesh", "errors"},
    "metrics": {"arguments", "mesh", "errors", "markup"},
    "phenotype": {"metrics", "config", "errors"},
}
# Imports inside functions: (importer, imported), and why. Anything else is written at the top of its file.
LAZY = {
    ("config", "config"): "the HTML table is for notebooks only",
    ("energy", "energy"): "ipctk may be missing",
    ("solve", "solve"): "PARDISO may be missing",
    ("store", "notebook"): "pictures are for notebooks only",
    ("store", "store"): "h5py is loaded when it is needed",
    ("study", "outputs"): "pictures are drawn only where a study keeps whole run folders",
}
# The command line answers at once, so that it imports what a command needs when it runs; so do its warnings.
MAY_BE_LAZY = {"cli", "notebook", "outputs", "validity"}
LONGEST_FILE, LONGEST_FUNCTION = 300, 60


@dataclass(frozen=True)
class Import:
    """One import of a part of the package by another."""

    file: str
    importer: str
    imported: str
    is_lazy: bool


def part(name: str) -> str:
    """Package or module right below gyrify; the package itself is ``gyrify``."""
    return name.split(".")[1] if "." in name else "gyrify"


def imports_of(file: Path) -> list[Import]:
    """Every import from gyrify in a file, but for those that only type checkers see."""
    relative = file.relative_to(SOURCE.parent).with_suffix("")
    importer = (
        part(".".join(relative.parts)) if relative.name != "__init__" else part(".".join(relative.parts[:-1]))
    )
    found: list[Import] = []

    def visit(node: ast.AST, is_lazy: bool) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
                continue
            if isinstance(child, ast.ImportFrom):
                assert child.level == 0, f"{relative}: imports are absolute"
                whole = child.module == "gyrify"
                names = [f"gyrify.{alias.name}" if whole else child.module or "" for alias in child.names]
            elif isinstance(child, ast.Import):
                names = [alias.name for alias in child.names]
            else:
                visit(child, is_lazy or isinstance(child, ast.FunctionDef | ast.Lambda))
                continue
            for name in names:
                if name.split(".")[0] == "gyrify" and name != "gyrify.__version__":
                    found.append(Import(str(relative), importer, part(name), is_lazy))

    visit(ast.parse(file.read_text(encoding="utf-8")), False)
    return found


FILES = sorted(SOURCE.rglob("*.py"))
IMPORTS = [found for file in FILES for found in imports_of(file)]


def layer(name: str) -> int:
    """Number of the layer; what stands in none drives the others and comes last but for the command line."""
    if name == "cli":
        return len(LAYERS) + 1
    return next((number for number, names in enumerate(LAYERS) if name in names), len(LAYERS))


def test_the_reader_of_imports_sees_the_package() -> None:
    assert len(FILES) > 40
    assert any(i.importer == "energy" and i.imported == "physics" for i in IMPORTS)
    assert any(i.importer == "cli" for i in IMPORTS)
    known = set.union(*LAYERS) | {"cli"}
    assert known <= {i.importer for i in IMPORTS} | {i.imported for i in IMPORTS}


def test_no_layer_imports_from_a_later_one() -> None:
    wrong = [i for i in IMPORTS if layer(i.imported) > layer(i.importer) and i.importer != "gyrify"]
    assert not [i for i in wrong if (i.importer, i.imported) not in LAZY or not i.is_lazy]
    same = [
        i
        for i in IMPORTS
        if layer(i.imported) == layer(i.importer) < len(LAYERS) and i.imported != i.importer
    ]
    assert not same


def test_kernels_and_readers_know_only_what_they_may() -> None:
    wrong = [
        i
        for i in IMPORTS
        if i.importer in MAY_IMPORT and i.imported not in MAY_IMPORT[i.importer] | {i.importer}
    ]
    assert not wrong


@pytest.mark.parametrize("kernel", ["physics", "energy"])
def test_kernels_know_no_files_and_no_pictures(kernel: str) -> None:
    forbidden = {"matplotlib", "h5py", "sqlite3", "pathlib", "tomllib", "json", "os", "pydantic", "rich"}
    for file in (SOURCE / kernel).rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not forbidden & {name.split(".")[0] for name in names}, file


def test_nothing_but_the_command_line_imports_the_command_line() -> None:
    assert not [i for i in IMPORTS if i.imported == "cli" and i.importer != "cli"]


def test_imports_at_the_top_of_files_make_no_circle() -> None:
    graph: dict[str, set[str]] = {}
    for i in IMPORTS:
        if i.importer not in ("gyrify", i.imported) and i.imported != "gyrify" and not i.is_lazy:
            graph.setdefault(i.importer, set()).add(i.imported)
    assert list(TopologicalSorter(graph).static_order())


def test_imports_inside_functions_are_the_listed_ones() -> None:
    lazy = {(i.importer, i.imported) for i in IMPORTS if i.is_lazy and i.importer not in MAY_BE_LAZY}
    assert not lazy - set(LAZY)


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(SOURCE)))
def test_files_and_functions_are_short(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= LONGEST_FILE
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef) and not _is_factory(node):
            assert _length(node) <= LONGEST_FUNCTION, node.name


def test_files_of_tests_and_tools_are_short() -> None:
    root = Path(__file__).resolve().parents[2]
    files = [file for folder in ("tests", "tools", "benchmarks") for file in (root / folder).rglob("*.py")]
    files = [file for file in files if ".venv" not in file.parts]
    assert len(files) > 100
    long = [file.name for file in files if len(file.read_text(encoding="utf-8").splitlines()) > LONGEST_FILE]
    assert long == []


def _length(node: ast.FunctionDef) -> int:
    """Lines from the signature to the end, the docstring (a table of parameters, often) not counted."""
    first = node.body[0]
    docstring = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    unread = (first.end_lineno or 0) - first.lineno + 1 if docstring else 0
    return (node.end_lineno or 0) - node.lineno + 1 - unread


def _is_factory(node: ast.FunctionDef) -> bool:
    """A function that defines compiled ones for a dimension, and little else; those are measured."""
    inner = sum(_length(child) for child in node.body if isinstance(child, ast.FunctionDef))
    return inner > 0 and _length(node) - inner < LONGEST_FUNCTION / 2


def test_every_public_name_can_be_imported() -> None:
    assert "simulate" in gyrify.__all__
    for name in gyrify.__all__:
        assert getattr(gyrify, name) is not None
    assert set(gyrify.__all__) <= set(dir(gyrify))
    with pytest.raises(AttributeError):
        _ = gyrify.no_such_name


def test_public_names_are_those_that_type_checkers_see() -> None:
    tree = ast.parse((SOURCE / "__init__.py").read_text(encoding="utf-8"))
    (guarded,) = [node for node in tree.body if isinstance(node, ast.If)]
    seen = {alias.asname or alias.name for node in guarded.body for alias in getattr(node, "names", [])}
    assert seen | {"__version__"} == set(gyrify.__all__)


def test_every_module_can_be_imported_on_its_own() -> None:
    """A circle that only some first import would hit."""
    for file in FILES:
        name = ".".join(file.relative_to(SOURCE.parent).with_suffix("").parts)
        if not name.endswith("__main__") and not name.endswith("pardiso"):
            assert importlib.import_module(name.removesuffix(".__init__"))


def test_kernels_are_compiled_by_our_njit_alone() -> None:
    """That of numba makes a folder ``~`` for a user without a home, and fails where it cannot write."""
    found = [
        path.relative_to(SOURCE).as_posix()
        for path in SOURCE.rglob("*.py")
        if "from numba import" in (text := path.read_text("utf-8")) or "\nimport numba" in text
    ]
    assert found == ["compiled.py"]
