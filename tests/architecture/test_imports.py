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

# Each layer may import from those before it in this list, and a package from itself.
LAYERS = [
    {"errors"},
    {"base"},
    {"metrics"},
    {"physics", "mesh", "theory"},
    {"config"},
    {"energy"},
    {"solve", "phenotype"},
    {"model"},
    {"store"},
    {"run"},
    {"verify", "threshold", "convergence", "study"},
    {"paper"},
    {"report"},
    {"cli"},
]
# What kernels and readers may know, more strictly than by their layer.
MAY_IMPORT = {
    "config": {"base", "errors", "metrics"},
    "physics": {"base"},
    "mesh": {"base", "errors", "metrics"},
    "theory": {"errors"},
    "energy": {"base", "physics"},
    "solve": {"energy", "errors"},
    "metrics": {"base", "errors"},
    "phenotype": {"metrics", "config", "errors"},
}
# Packages that import inside functions, and why. Anything else is written at the top of its file.
LAZY = {
    "cli": "the command line answers at once: a command imports what it needs when it runs",
    "config": "the HTML table is for notebooks only, and few bodies come from files",
    "energy": "ipctk may be missing",
    "report": "a format of animations is loaded when it is asked for",
    "run": "warnings load what they look at",
    "solve": "PARDISO may be missing",
}
# Places at the top of the package, its own file and the mark of types not counted.
MOST_PLACES = 20
# Names of files that several packages may have: a command is named after what it is about.
MAY_SHARE = {"__init__", "__main__"}
LONGEST_FILE, LONGEST_FUNCTION = 300, 60


@dataclass(frozen=True)
class Import:
    """One import of a part of the package by another."""

    module: str
    target: str
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
    module = ".".join(relative.parts).removesuffix(".__init__")
    found: list[Import] = []

    def visit(node: ast.AST, is_lazy: bool) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
                continue
            if isinstance(child, ast.ImportFrom):
                assert child.level == 0, f"{relative}: imports are absolute"
                names = [f"{child.module}.{alias.name}" for alias in child.names]
            elif isinstance(child, ast.Import):
                names = [alias.name for alias in child.names]
            else:
                visit(child, is_lazy or isinstance(child, ast.FunctionDef | ast.Lambda))
                continue
            for name in names:
                if name.split(".")[0] == "gyrify" and name != "gyrify.__version__":
                    found.append(Import(module, _file_of(name), importer, part(name), is_lazy))

    visit(ast.parse(file.read_text(encoding="utf-8")), False)
    return found


def _file_of(name: str) -> str:
    """The module of a name: itself, or what it is imported from."""
    path = SOURCE.joinpath(*name.split(".")[1:])
    return name if path.is_dir() or path.with_suffix(".py").is_file() else name.rpartition(".")[0]


FILES = sorted(SOURCE.rglob("*.py"))
IMPORTS = [found for file in FILES for found in imports_of(file)]


def layer(name: str) -> int:
    """Number of the layer."""
    return next(number for number, names in enumerate(LAYERS) if name in names)


def test_the_reader_of_imports_sees_the_package() -> None:
    assert len(FILES) > 40
    assert any(i.importer == "energy" and i.imported == "physics" for i in IMPORTS)
    assert any(i.importer == "cli" for i in IMPORTS)
    assert set.union(*LAYERS) == {i.importer for i in IMPORTS} - {"gyrify"} | {"errors"}


def test_no_layer_imports_from_its_own_or_a_later_one() -> None:
    between = [i for i in IMPORTS if i.importer not in ("gyrify", i.imported) and i.imported != "gyrify"]
    assert not [i for i in between if layer(i.imported) >= layer(i.importer)]


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


def test_no_file_is_in_a_circle_of_imports_lazy_or_not() -> None:
    graph: dict[str, set[str]] = {}
    for i in IMPORTS:
        graph.setdefault(i.module, set()).add(i.target)
    for module, targets in graph.items():
        targets.discard(module)
    assert list(TopologicalSorter(graph).static_order())


def test_imports_inside_functions_are_of_the_listed_packages() -> None:
    lazy = {i.importer for i in IMPORTS if i.is_lazy}
    assert lazy == set(LAZY)


def test_the_top_of_the_package_is_seen_at_a_glance() -> None:
    places = {path.name for path in SOURCE.iterdir()} - {"__init__.py", "py.typed", "__pycache__"}
    assert len(places) <= MOST_PLACES, sorted(places)


def test_no_two_files_of_one_name_mean_different_things() -> None:
    """Commands and plots are named after what they show."""
    named = [file for file in FILES if file.parent.name not in ("cli", "plot")]
    names = [file.stem for file in named if file.stem not in MAY_SHARE]
    assert not {name for name in names if names.count(name) > 1}


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
    assert found == ["base/compiled.py"]
