"""Degrees of freedom that follow from fewer unknowns: displacements that keep a mirror symmetry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gyrify.energy.term import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class Unknowns:
    """Each degree of freedom is one of the unknowns, up to its sign, or held at zero.

    An energy that does not change under the symmetry has an equilibrium among all displacements wherever it
    has one among those (principle of symmetric criticality, Palais 1979).

    Attributes
    ----------
    number : (n_dofs,) int array
        Unknown that each degree of freedom follows; -1 where it is held.
    sign : (n_dofs,) float array
        1, or -1 where it is the opposite of the unknown.
    size : int
        Number of unknowns.
    """

    number: IntArray
    sign: FloatArray
    size: int

    @classmethod
    def of(cls, source: IntArray, sign: FloatArray, free: IntArray) -> Unknowns:
        """Number the unknowns.

        Parameters
        ----------
        source : (n_dofs,) int array
            Degree of freedom that each one follows.
        sign : (n_dofs,) float array
            With which sign; 0 where it must vanish.
        free : (n_free,) int array
            Those that are not held; with a degree of freedom all that follow it.
        """
        is_free = np.zeros(source.size, dtype=bool)
        is_free[free] = True
        is_free &= sign != 0.0
        number = np.full(source.size, -1, dtype=np.int64)
        kept, numbers = np.unique(source[is_free], return_inverse=True)
        number[is_free] = numbers
        return cls(number, np.where(is_free, sign, 1.0), kept.size)

    def gather(self, gradient: FloatArray) -> FloatArray:
        """(size,) derivative by the unknowns, of one (n_dofs,) by the degrees of freedom."""
        moving = self.number >= 0
        parts = (self.sign * gradient)[moving]
        return np.bincount(self.number[moving], parts, minlength=self.size).astype(np.float64)

    def gather_mass(self, mass: FloatArray) -> FloatArray:
        """(size,) mass of the unknowns, of that (n_dofs,) of the degrees of freedom."""
        return self.gather(self.sign * mass)

    def scatter(self, step: FloatArray) -> FloatArray:
        """(n_dofs,) change of the degrees of freedom, of one (size,) of the unknowns."""
        moving = self.number >= 0
        full = np.zeros(self.number.size)
        full[moving] = self.sign[moving] * step[self.number[moving]]
        return full
