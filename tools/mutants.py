"""Break the physics on purpose, one mistake at a time, and see that the tests notice.

Each mutant is one plausible mistake. It is made in a copy of the tree, and the tests named with it are run
there: a mutant that no test fails on has survived, which is a hole in the tests. Before that, the tests must
pass on the unbroken copy.

    python tools/mutants.py                 every mutant (about five minutes on two cores)
    python tools/mutants.py --only NAME     one of them
    python tools/mutants.py --list          names and reasons
    python tools/mutants.py --json FILE     write the table as JSON too

Exit code 0: all killed; 1: some survived, do not apply, or break the import instead of a test.
"""

from __future__ import annotations

import argparse
import json
import os
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TIMEOUT = 300

ELASTIC = "tests/derivatives/test_elastic_derivatives.py"
CONTACT = "tests/derivatives/test_contact_derivatives.py"
VISCOUS = "tests/derivatives/test_viscous_derivatives.py"
PROJECTION = "tests/derivatives/test_projection.py"
INVARIANCE = "tests/invariants/test_energy_invariance.py"
GROWTH = "tests/verification/test_growth_energy.py"
SLICE = "tests/unit/test_energy_of_a_slice.py"
NEWTON = "tests/unit/test_newton.py"
LINEAR = "tests/unit/test_linear.py"

MATERIAL = "physics/neo_hookean.py"
TANGENT = "physics/isotropic.py"
KERNELS = "energy/kernels.py"
KINEMATICS = "energy/kinematics.py"
BARRIER = "energy/contact.py"
DASHPOT = "energy/viscous.py"
MODEL = "model.py"
CONFIG = "config/physics_sections.py"
# Compiled code: numba's cache does not see a change in a function that it has built into another one.
COMPILED = (MATERIAL, TANGENT, KERNELS, "energy/projection.py")


@dataclass(frozen=True)
class Mutant:
    """One mistake.

    Attributes
    ----------
    name : str
        What is wrong.
    file : str
        Where, below src/gyrify.
    edits : tuple of (str, str)
        Old text, which occurs exactly once, and new text.
    why : str
        How such a mistake comes about, or what it does.
    tests : tuple of str
        Tests that must notice.
    """

    name: str
    file: str
    edits: tuple[tuple[str, str], ...]
    why: str
    tests: tuple[str, ...]


def mutant(name: str, file: str, old: str, new: str, why: str, *tests: str) -> Mutant:
    """A mutant of one edit."""
    return Mutant(name, file, ((old, new),), why, tests)


MUTANTS = (
    # the material
    mutant(
        "energy_exponent",
        MATERIAL,
        "(I1 / (cube_root * cube_root) - 3.0)",
        "(I1 / cube_root - 3.0)",
        "J^(-1/3) for J^(-2/3) in the energy alone",
        ELASTIC,
    ),
    Mutant(
        "exponent_throughout",
        MATERIAL,
        (
            ("(I1 / (cube_root * cube_root) - 3.0)", "(I1 / cube_root - 3.0)"),
            ("power = mu / (cube_root * cube_root)", "power = mu / cube_root"),
            ("-power * I1 / (3.0 * J) + kappa", "-power * I1 / (6.0 * J) + kappa"),
            ("-power / (3.0 * J),", "-power / (6.0 * J),"),
            ("5.0 / 9.0 * power", "2.0 / 9.0 * power"),
        ),
        "J^(-1/3) in energy, stress and tangent alike: finite differences cannot see it",
        (ELASTIC,),
    ),
    mutant(
        "stress_coupling",
        MATERIAL,
        "-power * I1 / (3.0 * J) + kappa",
        "-power * I1 / (2.0 * J) + kappa",
        "the 2/3 of the exponent lost in the stress",
        ELASTIC,
    ),
    mutant(
        "tangent_coupling",
        MATERIAL,
        "        -power / (3.0 * J),",
        "        power / (3.0 * J),",
        "sign of d2W / dI1 dJ",
        ELASTIC,
    ),
    mutant(
        "tangent_volumetric",
        MATERIAL,
        "5.0 / 9.0 * power",
        "2.0 / 3.0 * power",
        "d2W / dJ2 without 2/3 (2/3 + 1)",
        ELASTIC,
    ),
    mutant(
        "bulk_modulus",
        MATERIAL,
        "young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio))",
        "young_modulus / (2.0 * (1.0 - 2.0 * poisson_ratio))",
        "kappa in two dimensions",
        SLICE,
    ),
    mutant(
        "shear_modulus",
        MATERIAL,
        "young_modulus / (2.0 * (1.0 + poisson_ratio))",
        "young_modulus / (2.0 + poisson_ratio)",
        "a bracket in the wrong place",
        SLICE,
    ),
    mutant(
        "tangent_second_order",
        TANGENT,
        "b + J * J * W_JJ",
        "b",
        "J^2 W_JJ forgotten",
        ELASTIC,
    ),
    mutant(
        "array_stress_in_z",
        TANGENT,
        "2.0 * W_1 * f33 + J * W_J / f33",
        "2.0 * W_1 * f33 + J * W_J",
        "out-of-plane stress without the inverse stretch",
        ELASTIC,
    ),
    # the kernels
    mutant(
        "geometric_term_sign",
        KERNELS,
        "- b_ * h[b, i] * h[a, k]",
        "+ b_ * h[b, i] * h[a, k]",
        "derivative of F^-T with the wrong sign",
        ELASTIC,
    ),
    mutant(
        "projected_geometric_term_sign",
        KERNELS,
        "- b_ * H[i, l] * H[k, j]",
        "+ b_ * H[i, l] * H[k, j]",
        "the same in the projected tangent, which Newton would forgive",
        PROJECTION,
    ),
    mutant(
        "inverted_cells_accepted",
        KERNELS,
        "            if not det > 0.0:\n                return np.inf",
        "            if det == 0.0:\n                return np.inf",
        "the line search would walk into inverted cells",
        INVARIANCE,
    ),
    mutant(
        "invariant_without_z",
        KERNELS,
        "J, I1 = det * f33[c], f33[c] * f33[c]",
        "J, I1 = det * f33[c], 1.0",
        "plane strain formed in two dimensions: f33 = 1 in I1",
        ELASTIC,
    ),
    mutant(
        "determinant_without_z",
        KERNELS,
        "J, I1 = det * f33[c], f33[c] * f33[c]",
        "J, I1 = det, f33[c] * f33[c]",
        "plane strain formed in two dimensions: f33 = 1 in J",
        ELASTIC,
    ),
    mutant(
        "projection_keeps_negative",
        "energy/projection.py",
        "if eigenvalues[k] > 0.0:",
        "if eigenvalues[k] != 0.0:",
        "nothing projected",
        PROJECTION,
    ),
    # growth
    mutant(
        "out_of_plane_inverted",
        KINEMATICS,
        "f33=F33 / F_g33",
        "f33=F33 * F_g33",
        "F_e33 = lambda for 1 / lambda",
        ELASTIC,
        SLICE,
    ),
    mutant(
        "growth_volume_without_z",
        KINEMATICS,
        "J_g=det * F_g33",
        "J_g=det",
        "det F_g in the plane only",
        SLICE,
        GROWTH,
    ),
    mutant(
        "blocked_and_none_swapped",
        "physics/growth.py",
        'np.ones_like(stretch) if out_of_plane == "none" else stretch.copy()',
        'stretch.copy() if out_of_plane == "none" else np.ones_like(stretch)',
        "the 33 entry of the other reading",
        GROWTH,
    ),
    mutant(
        "tangential_direction",
        "physics/growth.py",
        "np.where(tangential, 1.0 - stretch, 0.0)",
        "np.where(tangential, stretch - 1.0, 0.0)",
        "growth across the layers instead of along",
        GROWTH,
    ),
    mutant(
        "stretch_swapped",
        "physics/growth.py",
        'if stretch == "exponential"',
        'if stretch == "linear"',
        "linear and exponential growth exchanged",
        GROWTH,
    ),
    mutant(
        "growth_determinant_lost",
        MODEL,
        "return kinematics.volumes * kinematics.J_g",
        "return kinematics.volumes",
        "det F_g lost in the weight of the energy",
        SLICE,
    ),
    mutant(
        "energy_per_swapped",
        MODEL,
        'energy_per == "grown"',
        'energy_per == "reference"',
        "grown and reference volume exchanged",
        SLICE,
    ),
    mutant(
        "tangential_white_matter",
        MODEL,
        'grey & (growth.law == "tangential")',
        '(growth.law == "tangential") & (grey | ~grey)',
        "white matter grows tangentially too",
        SLICE,
    ),
    # the tissues
    mutant(
        "stiffness_ratio_inverted",
        CONFIG,
        "self.young_modulus / self.stiffness_ratio",
        "self.young_modulus * self.stiffness_ratio",
        "1/1.36 taken for 1.36",
        SLICE,
    ),
    mutant(
        "growth_ratio_inverted",
        CONFIG,
        "self.rate / self.ratio",
        "self.rate * self.ratio",
        "G_W / G_G for G_G / G_W",
        SLICE,
    ),
    mutant(
        "white_poisson_ratio",
        MODEL,
        "lame_parameters(material.young_modulus_white, material.poisson_ratio_white)",
        "lame_parameters(material.young_modulus_white, material.poisson_ratio)",
        "white matter with the cortex's nu",
        SLICE,
    ),
    # dissipation
    mutant(
        "drag_not_per_time",
        MODEL,
        "self.config.material.young_modulus / span",
        "self.config.material.young_modulus",
        "drag and viscosity without 1 / dt: halved increments would change the physics",
        SLICE,
    ),
    mutant(
        "drag_not_per_area",
        MODEL,
        "rate / self.config.geometry.drag_length**2",
        "rate",
        "drag number without R^2",
        SLICE,
    ),
    mutant(
        "drag_from_the_reference",
        DASHPOT,
        "rate = u - self.previous\n",
        "rate = u\n",
        "a spring to the reference state instead of drag",
        VISCOUS,
    ),
    mutant(
        "kelvin_voigt_from_the_reference",
        DASHPOT,
        "rate = green_lagrange(F) - self.previous_strain",
        "rate = green_lagrange(F)",
        "a spring instead of a dashpot",
        VISCOUS,
    ),
    mutant(
        "kelvin_voigt_stiffening",
        DASHPOT,
        '        matrix += np.einsum("cab,ik->caibk", stiffening, np.eye(n_dim))\n',
        "",
        "stress stiffening forgotten in the Hessian",
        VISCOUS,
    ),
    mutant(
        "lumped_area",
        MODEL,
        "self.simplices.volumes[:, None] / n_nodes",
        "self.simplices.volumes[:, None] / 2",
        "half of a triangle to each of its three points",
        SLICE,
    ),
    # contact
    mutant(
        "barrier_sign",
        BARRIER,
        "forces = self._barrier.gradient(",
        "forces = -self._barrier.gradient(",
        "contact that attracts",
        CONTACT,
    ),
    mutant(
        "barrier_area_weight",
        BARRIER,
        "collisions.use_area_weighting = True",
        "collisions.use_area_weighting = False",
        "pressure that depends on the number of points",
        CONTACT,
    ),
    mutant(
        "barrier_distance",
        BARRIER,
        "ipctk.BarrierPotential(d_hat, barrier_stiffness, True)",
        "ipctk.BarrierPotential(2.0 * d_hat, barrier_stiffness, True)",
        "another activation distance",
        CONTACT,
    ),
    mutant(
        "barrier_units",
        BARRIER,
        "ipctk.BarrierPotential(d_hat, barrier_stiffness, True)",
        "ipctk.BarrierPotential(d_hat, barrier_stiffness, False)",
        "a stiffness that is no pressure",
        CONTACT,
    ),
    mutant(
        "barrier_counts_twice",
        BARRIER,
        "NormalCollisions.IMPROVED_MAX_APPROX",
        "NormalCollisions.IPC",
        "sum over pairs without the improved maximum",
        CONTACT,
    ),
    mutant(
        "contact_distance_of_the_wrong_length",
        MODEL,
        "min(contact.activation_fraction * T,",
        "min(contact.activation_fraction,",
        "a fraction taken for millimetres",
        SLICE,
    ),
    mutant(
        "unsafe_contact_step",
        BARRIER,
        "return 1.0 if step >= 1.0 else SAFETY * step",
        "return 1.0",
        "steps through the other bank",
        INVARIANCE,
    ),
    # the solver
    mutant(
        "path_check_removed",
        "solve/quasistatic.py",
        "if solution.result is Result.CONVERGED and not problem.is_path_admissible(state.u, solution.u):",
        "if False:",
        "states on both sides of a crossing",
        NEWTON,
    ),
    mutant(
        "path_check_of_the_slice",
        MODEL,
        "return not self.config.contact.enabled or self.surface.is_path_collision_free(u, u_end)",
        "return True",
        "the same, one level below",
        SLICE,
    ),
    mutant(
        "line_search_accepts_anything",
        "solve/newton.py",
        "if trial <= value + SUFFICIENT_DECREASE * step * slope + noise:",
        "if True:",
        "an inverted cell has infinite energy, and is accepted",
        NEWTON,
    ),
    mutant(
        "iteration_cap_accepted",
        "solve/newton.py",
        "if residual <= criterion.force:",
        "if residual <= criterion.force or iteration == criterion.max_iterations:",
        "the cap taken for convergence",
        NEWTON,
    ),
    mutant(
        "indefinite_hessian_used",
        "solve/newton.py",
        "    elif factor.n_negative > 0:",
        "    elif factor.n_negative < 0:",
        "Newton runs to saddles",
        NEWTON,
    ),
    mutant(
        "inertia_of_superlu",
        "solve/linear.py",
        "self._lu.U.diagonal() < 0.0",
        "self._lu.U.diagonal() > 0.0",
        "positive pivots counted",
        LINEAR,
    ),
)


def text_of(mutant: Mutant, tree: Path) -> str:
    """Text of the broken file; raises ValueError where an edit does not apply."""
    text = (tree / "src" / "gyrify" / mutant.file).read_text(encoding="utf-8")
    for old, new in mutant.edits:
        if text.count(old) != 1:
            raise ValueError(f"{mutant.name}: {old!r} occurs {text.count(old)} times in {mutant.file}")
        text = text.replace(old, new)
    return text


def copy_tree(folder: Path) -> Path:
    """Copy of the sources and tests, without caches."""
    ignore = shutil.ignore_patterns("__pycache__", "*.nbi", "*.nbc")
    for name in ("src", "tests", "tools"):
        shutil.copytree(ROOT / name, folder / name, ignore=ignore)
    shutil.copy2(ROOT / "pyproject.toml", folder)
    return folder


def run_tests(tree: Path, tests: tuple[str, ...], cache: Path) -> tuple[int, str]:
    """Exit code of pytest in a tree, and the end of what it says; 124 when it takes too long."""
    environment = {
        **os.environ,
        "PYTHONPATH": str(tree / "src"),  # comes before an editable install
        "PYTHONDONTWRITEBYTECODE": "1",
        "NUMBA_CACHE_DIR": str(cache),
        "OMP_NUM_THREADS": "1",
    }
    where = subprocess.run(
        [sys.executable, "-c", "import gyrify; print(gyrify.__file__)"],
        env=environment, cwd=tree, capture_output=True, text=True, check=True,
    )  # fmt: skip
    if not Path(where.stdout.strip()).is_relative_to(tree):
        raise RuntimeError(f"the tests would run on {where.stdout.strip()}, not on the copy")
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-m", "not slow", *tests]
    try:
        done = subprocess.run(
            command, env=environment, cwd=tree, capture_output=True, text=True, timeout=TIMEOUT
        )
    except subprocess.TimeoutExpired:
        return 124, "took too long"
    return done.returncode, done.stdout[-2000:]


@dataclass(frozen=True)
class Outcome:
    """What became of a mutant: ``killed``, ``survived``, or ``broken`` (no test could be run)."""

    name: str
    outcome: str
    by: str
    seconds: float


def judge(mutant: Mutant, tree: Path) -> Outcome:
    """Break the tree, run the tests, mend the tree."""
    file = tree / "src" / "gyrify" / mutant.file
    before, begun = file.read_bytes(), time.perf_counter()
    stamp = file.stat()
    try:
        file.write_text(text_of(mutant, tree), encoding="utf-8")
        with tempfile.TemporaryDirectory() as fresh:
            cache = Path(fresh) if mutant.file in COMPILED else tree / "cache"
            code, said = run_tests(tree, mutant.tests, cache)
    finally:
        file.write_bytes(before)
        os.utime(file, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    by = ", ".join(re.findall(r"^FAILED \S+::(\S+)", said, flags=re.MULTILINE))
    outcome = {0: "survived", 1: "killed", 124: "killed"}.get(code, "broken")
    return Outcome(mutant.name, outcome, by or said.strip().splitlines()[-1], time.perf_counter() - begun)


def judge_all(mutants: list[Mutant], jobs: int) -> list[Outcome]:
    """Outcome of every mutant, in order; each job breaks a copy of its own."""
    with tempfile.TemporaryDirectory() as folder:
        trees: queue.SimpleQueue[Path] = queue.SimpleQueue()
        for number in range(jobs):
            trees.put(copy_tree(Path(folder).resolve() / str(number)))
        needed = tuple(sorted({test for mutant in mutants for test in mutant.tests}))

        def work(mutant: Mutant | None) -> Outcome | str:
            tree = trees.get()
            try:
                if mutant is None:
                    code, said = run_tests(tree, needed, tree / "cache")
                    return "" if code == 0 else said
                outcome = judge(mutant, tree)
                print(
                    f"{outcome.outcome:9} {outcome.name:38} {outcome.seconds:5.1f} s  {outcome.by}",
                    flush=True,
                )
                return outcome
            finally:
                trees.put(tree)

        with ThreadPoolExecutor(jobs) as pool:
            # every job at once, so that each copy is tried and its kernels are compiled
            failures = [said for said in pool.map(work, [None] * jobs) if said]
            if failures:
                raise SystemExit(f"The tests fail before anything is broken:\n{failures[0]}")
            return [outcome for outcome in pool.map(work, mutants) if isinstance(outcome, Outcome)]


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--only", action="append", metavar="NAME", choices=[m.name for m in MUTANTS])
    parser.add_argument("--jobs", type=int, default=min(2, os.cpu_count() or 1))
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--json", type=Path, metavar="FILE")
    options = parser.parse_args()
    chosen = [m for m in MUTANTS if not options.only or m.name in options.only]
    if options.list:
        print("\n".join(f"{m.name:38} {m.file:28} {m.why}" for m in chosen))
        return 0
    for m in chosen:
        text_of(m, ROOT)
    outcomes = judge_all(chosen, options.jobs)
    killed = sum(outcome.outcome == "killed" for outcome in outcomes)
    print(f"{killed} of {len(outcomes)} mutants killed")
    if options.json:
        table = [asdict(m) | asdict(o) for m, o in zip(chosen, outcomes, strict=True)]
        options.json.write_text(json.dumps(table, indent=1), encoding="utf-8")
    return 0 if killed == len(outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
