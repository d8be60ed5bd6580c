"""Variables that the command line inherits and must not stumble over."""

from __future__ import annotations

import ast
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Final

# Libraries end in a traceback where these are not whole numbers above zero.
_COUNTS: Final = ("COLUMNS", "LINES", "NUMBA_NUM_THREADS")


def tidy_environment() -> None:
    """Set aside what a notebook, a queue or a terminal left behind; processes that are begun inherit that.

    No command opens a window, and every kernel is compiled.
    """
    os.environ["MPLBACKEND"] = "agg"
    os.environ.pop("NUMBA_DISABLE_JIT", None)
    for name in _COUNTS:
        if name in os.environ and not _is_count(os.environ[name]):
            del os.environ[name]


def _is_count(text: str) -> bool:
    return text.strip().isdecimal() and int(text) > 0


def restore_docstrings(module: ModuleType) -> None:
    """Give the functions and classes of a module their docstrings back, which are the help of the commands.

    Python leaves them out where PYTHONOPTIMIZE is 2.
    """
    if sys.flags.optimize < 2 or module.__file__ is None:
        return
    tree = ast.parse(Path(module.__file__).read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name in vars(module):
            vars(module)[node.name].__doc__ = ast.get_docstring(node)
