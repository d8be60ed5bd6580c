"""MKL PARDISO for real symmetric matrices: Cholesky (mtype 2), and with the inertia (mtype -2).

The three phases are called by hand: packages that wrap PARDISO are made for unsymmetric matrices, hash every
one, and search the whole environment for the library.
"""

from __future__ import annotations

import ctypes
import sys
from ctypes.util import find_library
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Any

import numpy as np

from gyrify.errors import SolveError
from gyrify.solve.types import FloatArray, IntArray

_DEFINITE, _INDEFINITE = 2, -2
_ANALYSE, _FACTORISE, _SOLVE, _RELEASE = 11, 22, 33, -1
_NO_MEMORY, _NOT_DEFINITE = -2, -4
_SEQUENTIAL, _CBWR_AUTO = 1, 2


@lru_cache(maxsize=1)
def _library() -> Any:
    """MKL without threads, in the mode that gives the same bits for the same input on one processor family.

    Raises
    ------
    ImportError
        If it is not installed.
    """
    library = ctypes.CDLL(_find_library())
    # Neither has an effect once MKL has computed something in this process: then both are already fixed.
    library.MKL_Set_Threading_Layer(ctypes.c_int(_SEQUENTIAL))
    library.MKL_CBWR_Set(ctypes.c_int(_CBWR_AUTO))
    return library


def _find_library() -> str:
    """Path of MKL's runtime as the package `mkl` installs it, or its name where the system has it."""
    try:
        installed = files("mkl") or []
    except PackageNotFoundError:
        installed = []
    for file in installed:
        if "mkl_rt" in file.name and not file.name.endswith(".lib"):
            return str(Path(str(file.locate())).resolve())
    name = find_library("mkl_rt")
    if name is None:
        raise ImportError("MKL is not installed")
    return name


class Pardiso:
    """See `gyrify.solve.linear.LinearSolver`; one thread, reproducible numerics."""

    name = "pardiso"

    def __init__(self) -> None:
        _library()

    def analyse(self, indptr: IntArray, indices: IntArray) -> None:
        """See `LinearSolver`."""
        self._pattern = (indptr + 1).astype(np.int32), (indices + 1).astype(np.int32)
        self._definite: _Matrices | None = None
        self._indefinite: _Matrices | None = None

    def factorise(self, data: FloatArray) -> PardisoFactor:
        """See `LinearSolver`."""
        if self._indefinite is None:
            # Minimum degree, at most one step of iterative refinement; pivots below 1e-8 of the norm are
            # perturbed; 1 x 1 and 2 x 2 pivots give the exact inertia of indefinite matrices.
            self._indefinite = _Matrices(_INDEFINITE, *self._pattern, {1: 0, 7: 1, 9: 8, 20: 1})
        return self._indefinite.factorise(data)

    def factorise_definite(self, data: FloatArray) -> PardisoFactor | None:
        """See `LinearSolver`."""
        if self._definite is None:
            # Nested dissection and the two-level factorisation, which is faster even on one thread, but may
            # overlook a negative pivot next to zero.
            self._definite = _Matrices(_DEFINITE, *self._pattern, {1: 2, 23: 1})
        try:
            return self._definite.factorise(data)
        except NotDefiniteError:
            return None


class NotDefiniteError(SolveError):
    """A pivot was not positive."""


class _Matrices:
    """Matrices of one kind that share a pattern; the latest of them is factorised."""

    def __init__(self, kind: int, indptr: Any, indices: Any, parameters: dict[int, int]) -> None:
        library = _library()
        library.MKL_Set_Num_Threads_Local(ctypes.c_int(1))
        self._pardiso, self._kind = library.pardiso, kind
        self._handle = np.zeros(64, dtype=np.int64)
        self._iparm = np.zeros(64, dtype=np.int32)
        self._iparm[0] = 1  # the values given, not the defaults
        for number, value in parameters.items():
            self._iparm[number] = value
        # Kept alive here, because PARDISO is given their addresses.
        self._pattern = indptr, indices
        self._n = indptr.size - 1
        self._data = np.zeros(indices.size)
        self.generation = 0
        self._call(_ANALYSE, np.empty(0))

    def factorise(self, data: FloatArray) -> PardisoFactor:
        """Factor of a matrix; it is valid until the next one."""
        self._data = np.ascontiguousarray(data)
        self.generation += 1
        self._call(_FACTORISE, np.empty(0))
        n_negative = int(self._iparm[22]) if self._kind == _INDEFINITE else 0
        return PardisoFactor(self, self.generation, n_negative)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution with the latest factor."""
        return self._call(_SOLVE, np.asfortranarray(right, dtype=np.float64))

    def _call(self, phase: int, right: FloatArray) -> FloatArray:
        solution = np.zeros_like(right)
        error = ctypes.c_int32(0)
        n_right = right.shape[1] if right.ndim == 2 else 1
        indptr, indices = self._pattern
        self._pardiso(
            _address(self._handle),
            *(_integer(value) for value in (1, 1, self._kind, phase, self._n)),
            _address(self._data),
            _address(indptr),
            _address(indices),
            None,
            _integer(n_right),
            _address(self._iparm),
            _integer(0),
            _address(right),
            _address(solution),
            ctypes.byref(error),
        )
        if error.value == _NOT_DEFINITE:
            raise NotDefiniteError("A pivot of the stiffness matrix is not positive.")
        if error.value == _NO_MEMORY:  # no fault of the matrix, as a SolveError would say
            raise MemoryError(f"PARDISO ran out of memory in phase {phase}.")
        if error.value != 0:
            raise SolveError(f"PARDISO failed in phase {phase} with error {error.value}.")
        return solution

    def __del__(self) -> None:
        if not sys.is_finalizing() and self._handle.any():
            self._call(_RELEASE, np.empty(0))


class PardisoFactor:
    """See `gyrify.solve.linear.Factor`."""

    def __init__(self, matrices: _Matrices, generation: int, n_negative: int) -> None:
        self._matrices, self._generation = matrices, generation
        self.n_negative = n_negative

    def solve(self, right: FloatArray) -> FloatArray:
        """See `Factor`."""
        if self._generation != self._matrices.generation:
            raise RuntimeError("this factor has been overwritten by a later one")
        return self._matrices.solve(right)


def _address(array: Any) -> Any:
    return ctypes.c_void_p(array.__array_interface__["data"][0])


def _integer(value: int) -> Any:
    return ctypes.byref(ctypes.c_int32(value))
