"""MKL PARDISO for real symmetric indefinite matrices (mtype -2), which reports the inertia.

pypardiso finds the library; its high-level interface is made for unsymmetric matrices and hashes every
one, so that the three phases are called here.
"""

from __future__ import annotations

import ctypes
import sys
from functools import lru_cache
from typing import Any

import numpy as np
from pypardiso import PyPardisoSolver

from gyrify.errors import SolveError
from gyrify.solve.types import FloatArray, IntArray

_MTYPE = -2
_ANALYSE, _FACTORISE, _SOLVE, _RELEASE = 11, 22, 33, -1
_CBWR_AUTO = 2


@lru_cache(maxsize=1)
def _library() -> Any:
    """MKL, in the mode that gives the same bits for the same input on one processor family."""
    library = PyPardisoSolver(mtype=_MTYPE).libmkl
    # Has no effect once MKL has computed something in this process: then the mode is already fixed.
    library.MKL_CBWR_Set(ctypes.c_int(_CBWR_AUTO))
    return library


class Pardiso:
    """See `gyrify.solve.linear.LinearSolver`; one thread, reproducible numerics."""

    name = "pardiso"

    def __init__(self) -> None:
        library = _library()
        library.MKL_Set_Num_Threads_Local(ctypes.c_int(1))
        self._pardiso = library.pardiso
        self._handle = np.zeros(64, dtype=np.int64)
        self._iparm = np.zeros(64, dtype=np.int32)
        self._n = 0
        self.generation = 0

    def analyse(self, indptr: IntArray, indices: IntArray) -> None:
        """See `LinearSolver`."""
        self._release()
        self._iparm[:] = 0
        self._iparm[0] = 1  # the values below, not the defaults
        self._iparm[1] = 2  # nested dissection
        self._iparm[7] = 1  # at most one step of iterative refinement
        self._iparm[9] = 8  # perturb pivots below 1e-8 of the norm
        self._iparm[20] = 1  # 1 x 1 and 2 x 2 pivots: exact inertia of indefinite matrices
        self._n = indptr.size - 1
        self._indptr = (indptr + 1).astype(np.int32)
        self._indices = (indices + 1).astype(np.int32)
        self._data = np.zeros(indices.size)
        self._call(_ANALYSE, self._data, np.empty(0))

    def factorise(self, data: FloatArray) -> PardisoFactor:
        """See `LinearSolver`; a factor is valid until the next one."""
        self._data = np.ascontiguousarray(data)
        self.generation += 1
        self._call(_FACTORISE, self._data, np.empty(0))
        return PardisoFactor(self, self.generation, int(self._iparm[22]))

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution with the latest factor."""
        return self._call(_SOLVE, self._data, np.asfortranarray(right, dtype=np.float64))

    def _call(self, phase: int, data: FloatArray, right: FloatArray) -> FloatArray:
        solution = np.zeros_like(right)
        error = ctypes.c_int32(0)
        n_right = right.shape[1] if right.ndim == 2 else 1
        self._pardiso(
            _pointer(self._handle, ctypes.c_int64),
            *(_integer(value) for value in (1, 1, _MTYPE, phase, self._n)),
            _pointer(data, ctypes.c_double),
            _pointer(self._indptr, ctypes.c_int32),
            _pointer(self._indices, ctypes.c_int32),
            None,
            _integer(n_right),
            _pointer(self._iparm, ctypes.c_int32),
            _integer(0),
            _pointer(right, ctypes.c_double),
            _pointer(solution, ctypes.c_double),
            ctypes.byref(error),
        )
        if error.value != 0:
            raise SolveError(f"PARDISO failed in phase {phase} with error {error.value}.")
        return solution

    def _release(self) -> None:
        if self._n > 0:
            self._call(_RELEASE, self._data, np.empty(0))
            self._handle[:] = 0

    def __del__(self) -> None:
        if getattr(self, "_n", 0) > 0 and not sys.is_finalizing():
            self._release()


class PardisoFactor:
    """See `gyrify.solve.linear.Factor`."""

    def __init__(self, solver: Pardiso, generation: int, n_negative: int) -> None:
        self._solver, self._generation = solver, generation
        self.n_negative = n_negative

    def solve(self, right: FloatArray) -> FloatArray:
        """See `Factor`."""
        if self._generation != self._solver.generation:
            raise RuntimeError("this factor has been overwritten by a later one")
        return self._solver.solve(right)


def _pointer(array: Any, kind: Any) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(kind))


def _integer(value: int) -> Any:
    return ctypes.byref(ctypes.c_int32(value))
