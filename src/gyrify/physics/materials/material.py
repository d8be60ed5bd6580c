"""What a material is: an energy density and its derivatives, and the numbers that a tissue gives it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

Form = Literal["invariants", "stretches"]


@dataclass(frozen=True, eq=False)
class Material:
    """An isotropic hyperelastic solid, per unit volume of the stress-free (grown) tissue.

    The functions are compiled (`gyrify.base.compiled.njit`) and plain arithmetic, so that they take arrays
    too. p[k, c] is parameter k at point c.

    Attributes
    ----------
    name : str
        What ``material.law`` calls it.
    form : {"invariants", "stretches"}
        What the energy is a function of: I1 = tr F F^T and J = det F, or the principal stretches. The first
        is faster by far and serves where it can.
    density : callable
        W [Pa]. By invariants ``density(I1, J, cube_root, p, c)``, where the cube root of J is given because
        it costs more than all the rest; by stretches ``density(a, b, s, p, c)``.
    derivatives : callable
        By invariants W_1, W_J, W_11, W_1J, W_JJ; by stretches W_a, W_b, W_s, W_aa, W_bb, W_ss, W_ab, W_as,
        W_bs [Pa]. Same arguments.
    parameters : callable
        ``parameters(young_modulus, poisson_ratio)``: the parameters of a tissue of initial Young's modulus E
        [Pa] and Poisson's ratio nu [-]. The last one is the bulk modulus kappa [Pa], by which the energy has
        the term kappa / 2 (J - 1)^2 and no other one of J alone: elements that average the volume ratio put
        their own in its place.
    about : str
        Its equation, in one line.
    """

    name: str
    form: Form
    density: Callable[..., Any]
    derivatives: Callable[..., Any]
    parameters: Callable[[float, float], tuple[float, ...]]
    about: str = ""
