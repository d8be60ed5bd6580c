"""The benchmarks by name: what each measures, and whether it takes minutes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from bench.assembly import assembly
from bench.command import command
from bench.dynamics import dynamics
from bench.figures import Figures
from bench.iteration import iteration
from bench.kernels import kernels, threshold
from bench.scale import fine, finest, quadratic, soft
from bench.space.plan import space
from bench.space.solvers import solvers
from bench.standard import standard
from bench.whole_run import whole_run


@dataclass(frozen=True)
class Case:
    """One benchmark.

    Attributes
    ----------
    measure : callable
        Gives the figures; its argument asks for a quick look on a small slice.
    title : str
        What is measured.
    is_slow : bool
        Whether it runs only with ``--all`` or by its name.
    """

    measure: Callable[[bool], Figures]
    title: str
    is_slow: bool = False


CASES = {
    "standard": Case(standard, "Whole standard run"),
    "kernels": Case(kernels, "Assembly and contact alone, at the folded state"),
    "iteration": Case(iteration, "Newton iteration over factorisation and solve of the same matrix"),
    "assembly": Case(assembly, "Energy, gradient, Hessian and fill beside other libraries"),
    "whole-run": Case(whole_run, "The same increments on scikit-fem and SciPy"),
    "dynamics": Case(dynamics, "Damped explicit dynamics"),
    "command": Case(command, "Command line from start to end"),
    "quadratic": Case(quadratic, "Other elements on the standard mesh"),
    "threshold": Case(threshold, "Critical growth"),
    "fine": Case(fine, "Finer meshes: the finest for a minute"),
    "finest": Case(finest, "Finer meshes to full growth", is_slow=True),
    "soft": Case(soft, "Soft cortex, little drag", is_slow=True),
    "solvers": Case(solvers, "Linear systems of growing bodies in space, in turn", is_slow=True),
    "space": Case(space, "Constants for three dimensions", is_slow=True),
}
