"""Where the time of a run goes: own time of the methods of gyrify's parts, by wrapping their classes.

A part is a module; its classes are found, not listed, so that the split outlives changes within a part.
"""

from __future__ import annotations

import importlib
import inspect
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import wraps
from typing import Any

PARTS = {
    "tissue energy": ("energy.elastic", "energy.axial", "energy.mean_dilatation", "energy.kinematics"),
    "contact": ("energy.contact",),
    "dissipation": ("energy.viscous",),
    "matrix": ("solve.system", "energy.total"),
    "journal": ("store.journal",),
}
LIBRARIES = ("solve.linear", "solve.pardiso")
PHASES = {
    "analyse": "symbolic analysis",
    "factorise": "factorisation",
    "factorise_definite": "factorisation",
    "solve": "triangular solves",
}


class Clock:
    """Own time of each part: what a part calls in another one counts there only, its own calls count once."""

    def __init__(self) -> None:
        self.seconds: defaultdict[str, float] = defaultdict(float)
        self.calls: defaultdict[str, int] = defaultdict(int)
        self._inner: list[float] = []
        self._open: list[str] = []

    def wrap(self, part: str, method: Callable[..., Any]) -> Callable[..., Any]:
        """The method, timed."""

        @wraps(method)
        def timed(*args: Any, **kwargs: Any) -> Any:
            self._inner.append(0.0)
            self.calls[part] += not self._open or self._open[-1] != part
            self._open.append(part)
            begun = time.perf_counter()
            try:
                return method(*args, **kwargs)
            finally:
                spent = time.perf_counter() - begun
                self.seconds[part] += spent - self._inner.pop()
                self._open.pop()
                if self._inner:
                    self._inner[-1] += spent

        return timed


@contextmanager
def clocked() -> Iterator[Clock]:
    """Time every part until the end of the ``with`` block."""
    clock, undo = Clock(), []
    for owner, name, method, part in _methods():
        undo.append((owner, name, method))
        setattr(owner, name, clock.wrap(part, method))
    try:
        yield clock
    finally:
        for owner, name, method in undo:
            setattr(owner, name, method)


def _methods() -> Iterator[tuple[type, str, Callable[..., Any], str]]:
    for part, modules in PARTS.items():
        for owner in _classes(modules):
            for name, method in list(vars(owner).items()):
                if inspect.isfunction(method) and not name.startswith("__"):
                    yield owner, name, method, part
    for owner in _classes(LIBRARIES):
        # what is made of a pattern is an analysis; a factor is made of a matrix
        if "__init__" in vars(owner) and not owner.__name__.endswith("Factor"):
            yield owner, "__init__", vars(owner)["__init__"], PHASES["analyse"]
        for name, part in PHASES.items():
            if inspect.isfunction(vars(owner).get(name)):
                yield owner, name, vars(owner)[name], part


def _classes(modules: tuple[str, ...]) -> Iterator[type]:
    for name in modules:
        with suppress(ImportError):  # PARDISO may be missing
            module = importlib.import_module(f"gyrify.{name}")
            found = [c for _, c in inspect.getmembers(module, inspect.isclass)]
            yield from (c for c in found if c.__module__ == module.__name__ and not _is_protocol(c))


def _is_protocol(owner: type) -> bool:
    return bool(getattr(owner, "_is_protocol", False))
