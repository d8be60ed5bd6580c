"""The physics once more, from the equations on paper: nothing here comes from the package but plain numbers.

Derivatives are taken by the complex step, Im f(x + i h) / h with h = 1e-30: no difference is formed, so that
they are exact to round-off and share no line with the closed forms of the package.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
import sympy as sp

STEP = 1e-30


def complex_step(function: Callable[[np.ndarray], np.ndarray], x: np.ndarray) -> np.ndarray:
    """Derivative of a function of (n_items, n_unknowns), item by item, in the shape of x."""
    gradient = np.empty(x.shape)
    for k in range(x.shape[1]):
        shifted = x.astype(complex)
        shifted[:, k] += 1j * STEP
        gradient[:, k] = function(shifted).imag / STEP
    return gradient


def moduli(young_modulus: float, poisson_ratio: float) -> tuple[float, float]:
    """mu and kappa of an isotropic solid."""
    return young_modulus / 2 / (1 + poisson_ratio), young_modulus / 3 / (1 - 2 * poisson_ratio)


def neo_hookean(F: np.ndarray, mu: np.ndarray | float, kappa: np.ndarray | float) -> np.ndarray:
    """W = mu/2 (J^(-2/3) tr F F^T - 3) + kappa/2 (J - 1)^2 of gradients F (..., 3, 3), complex ones too."""
    J = np.linalg.det(F)
    trace = (F * F).sum(axis=(-2, -1))
    return mu / 2 * (J ** (-2 / 3) * trace - 3) + kappa / 2 * (J - 1) ** 2


def deformation(X: np.ndarray, u: np.ndarray) -> np.ndarray:
    """F = dx/dX of triangles with corners X (n, 3, 2), from the edges: F [dX1 dX2] = [dx1 dx2]."""
    x = X + u
    reference = np.stack([X[:, 1] - X[:, 0], X[:, 2] - X[:, 0]], axis=-1)
    current = np.stack([x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]], axis=-1)
    return current @ np.linalg.inv(reference)


def embedded(F: np.ndarray, f33: np.ndarray | float) -> np.ndarray:
    """(n, 3, 3) gradients from their blocks in the plane and their 33 entries."""
    whole = np.zeros((F.shape[0], 3, 3), dtype=F.dtype)
    whole[:, :2, :2] = F
    whole[:, 2, 2] = f33
    return whole


def area(X: np.ndarray) -> np.ndarray:
    """Area of triangles (n, 3, 2)."""
    (ax, ay), (bx, by) = (X[:, 1] - X[:, 0]).T, (X[:, 2] - X[:, 0]).T
    return (ax * by - ay * bx) / 2


class SliceOracle:
    """Energies of a whole slice, read from the numbers of a configuration and the arrays of its mesh."""

    def __init__(self, config, mesh) -> None:
        self.config, self.mesh = config, mesh
        self.X = mesh.points[mesh.cells]
        self.grey = mesh.region == 1

    def growth(self, fraction: float) -> np.ndarray:
        """(n_cells, 3, 3) growth tensors at a fraction of the duration."""
        g = self.config.growth
        strain = np.where(self.grey, g.rate, g.rate / g.ratio) * fraction * g.duration
        stretch = 1 + strain if g.stretch == "linear" else np.exp(strain)
        F_g = np.zeros((self.grey.size, 3, 3))
        for c, s in enumerate(stretch):
            N = self.mesh.across[c] if g.law == "tangential" and self.grey[c] else np.zeros(2)
            F_g[c, :2, :2] = s * (np.eye(2) - np.outer(N, N)) + np.outer(N, N)
            F_g[c, 2, 2] = s if g.out_of_plane == "blocked" else 1.0
        return F_g

    def elastic(self, u: np.ndarray, fraction: float) -> tuple[float, np.ndarray]:
        """Energy, and its gradient (n_points, 2)."""
        m, F_g = self.config.material, self.growth(fraction)
        grey = moduli(m.young_modulus, m.poisson_ratio)
        white = moduli(m.young_modulus / m.stiffness_ratio, m.poisson_ratio_white)
        mu, kappa = (np.where(self.grey, g, w) for g, w in zip(grey, white, strict=True))
        grown = np.linalg.det(F_g) if self.config.growth.energy_per == "grown" else 1.0

        def energies(flat: np.ndarray) -> np.ndarray:
            F = embedded(deformation(self.X, flat.reshape(-1, 3, 2)), 1.0)
            return area(self.X) * grown * neo_hookean(F @ np.linalg.inv(F_g), mu, kappa)

        flat = u[self.mesh.cells].reshape(-1, 6)
        gradient = np.zeros_like(u)
        np.add.at(gradient, self.mesh.cells, complex_step(energies, flat).reshape(-1, 3, 2))
        return float(energies(flat).sum()), gradient

    @cached_property
    def lumped_area(self) -> np.ndarray:
        """A third of the area of every triangle around a point."""
        lumped = np.zeros(self.mesh.n_points)
        for corner in range(3):
            np.add.at(lumped, self.mesh.cells[:, corner], area(self.X) / 3)
        return lumped

    def drag(self, u: np.ndarray, before: np.ndarray, span: float) -> np.ndarray:
        """Force c m (u - u_n) / dt; number = c R^2 / (E duration), pi R^2 = area, span = dt / duration."""
        R_squared = self.config.geometry.area / np.pi
        c_over_dt = self.config.dissipation.number * self.config.material.young_modulus / R_squared / span
        return c_over_dt * self.lumped_area[:, None] * (u - before)

    def contact(self, u: np.ndarray, before: np.ndarray) -> np.ndarray:
        """Gradient (n_points, 2) of the barrier; its activation distance comes from the increment's start."""
        rest = self.mesh.points[self.mesh.contour]
        x_before = rest + before[self.mesh.contour]
        shortest = np.linalg.norm(np.roll(x_before, -1, axis=0) - x_before, axis=1).min()
        T = self.config.geometry.cortical_thickness
        undeformed = np.linalg.norm(np.roll(rest, -1, axis=0) - rest, axis=1).min()
        d_hat = min(self.config.contact.activation_fraction * T, max(shortest, undeformed / 10) / 2)
        gradient = np.zeros_like(u)
        k_b = self.config.material.young_modulus / 10
        gradient[self.mesh.contour] = barrier(rest, rest + u[self.mesh.contour], d_hat, k_b)[1]
        return gradient

    def residual(self, u: np.ndarray, before: np.ndarray, fraction: float, fraction_before: float) -> float:
        """Largest force on a free point."""
        force = self.elastic(u, fraction)[1]
        if self.config.dissipation.kind == "drag":
            force += self.drag(u, before, fraction - fraction_before)
        if self.config.contact.enabled:
            force += self.contact(u, before)
        force[self.mesh.clamped] = 0.0
        return float(np.sqrt((force**2).sum(axis=1)).max())


def barrier(rest: np.ndarray, x: np.ndarray, d_hat: float, k_b: float) -> tuple[float, np.ndarray]:
    """Energy and gradient of the contact barrier of a closed polyline.

    Every vertex p meets every edge it is no end of, weighted with half its share A_p of the reference length;
    a vertex v that closes two such edges would count twice where it is the nearest point, so that the pair
    (p, v) is taken away once (Li et al. 2023). b(s) = -(s - 1)^2 ln s with s = d^2 / d_hat^2 below 1.
    """
    n = len(x)
    p, e = (index.ravel() for index in np.indices((n, n)))
    other = (p != e) & (p != (e + 1) % n)
    p, a, b = p[other], e[other], (e[other] + 1) % n
    q, v = (index.ravel() for index in np.indices((n, n)))
    apart = (q - v) % n
    far = (apart > 1) & (apart < n - 1)
    q, v = q[far], v[far]
    lengths = np.linalg.norm(np.roll(rest, -1, axis=0) - rest, axis=1)
    share = (lengths + np.roll(lengths, 1)) / 2

    def energies(flat: np.ndarray, weight: np.ndarray) -> np.ndarray:
        s = distance_squared(*np.moveaxis(flat.reshape(-1, flat.shape[1] // 2, 2), 1, 0)) / d_hat**2
        return weight * k_b * d_hat / 2 * -((s - 1) ** 2) * np.log(s)

    energy, gradient = 0.0, np.zeros_like(x)
    for ends, sign in (((p, a, b), 1.0), ((q, v), -1.0)):
        flat = np.concatenate([x[end] for end in ends], axis=1)
        near = distance_squared(*(x[end] for end in ends)) < d_hat**2
        if not near.any():
            continue
        weight = sign * share[ends[0][near]]
        energy += energies(flat[near], weight).sum()
        forces = complex_step(lambda z, w=weight: energies(z, w), flat[near])
        for k, end in enumerate(ends):
            np.add.at(gradient, end[near], forces[:, 2 * k : 2 * k + 2])
    return float(energy), gradient


def distance_squared(p: np.ndarray, a: np.ndarray, b: np.ndarray | None = None) -> np.ndarray:
    """From points p (n, 2) to points a, or to segments a-b; complex arguments too."""
    if b is None:
        return ((p - a) ** 2).sum(axis=1)
    along = b - a
    where = ((p - a) * along).sum(axis=1) / (along**2).sum(axis=1)
    where = np.where(where.real <= 0, 0, np.where(where.real >= 1, 1, where))
    return ((p - a - where[:, None] * along) ** 2).sum(axis=1)


def symbolic_triangle() -> Callable[..., tuple[float, np.ndarray, np.ndarray]]:
    """Energy per volume of one triangle with gradient (6,) and Hessian (6, 6), differentiated symbolically.

    Arguments of the returned function: X (3, 2), u (3, 2), F_g (2, 2), F_g33, mu, kappa.
    """
    x, A = sp.Matrix(3, 2, sp.symbols("x:6")), sp.Matrix(2, 2, sp.symbols("A:4"))
    G33, mu, kappa = sp.symbols("G33 mu kappa")
    # F_e = [x1 - x0, x2 - x0] A with the constant A = [X1 - X0, X2 - X0]^-1 F_g^-1
    F = sp.diag(sp.Matrix([x.row(1) - x.row(0), x.row(2) - x.row(0)]).T * A, 1 / G33)
    J = F.det()
    W = mu / 2 * (J ** sp.Rational(-2, 3) * (F * F.T).trace() - 3) + kappa / 2 * (J - 1) ** 2
    gradient = [sp.diff(W, s) for s in x]
    hessian = [[sp.diff(g, s) for s in x] for g in gradient]
    function = sp.lambdify([*x, *A, G33, mu, kappa], [W, gradient, hessian], "numpy", cse=True)

    def evaluate(X, u, F_g, F_g33, mu, kappa) -> tuple[float, np.ndarray, np.ndarray]:
        A = np.linalg.inv(np.stack([X[1] - X[0], X[2] - X[0]], axis=1)) @ np.linalg.inv(F_g)
        W, gradient, hessian = function(*np.ravel(X + u), *np.ravel(A), F_g33, mu, kappa)
        return float(W), np.array(gradient, dtype=float), np.array(hessian, dtype=float)

    return evaluate
