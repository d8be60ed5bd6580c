"""The same brain by BrainGrowth and by gyrify: time, shape before buckling, area after it, a picture.

BrainGrowth (github.com/rousseau/BrainGrowth) has no licence: give a copy of your own, and a Python that has
its requirements. It takes more than an hour.

    python benchmarks/braingrowth.py run COPY --python THEIR_PYTHON    # their program: COPY/res/same
    python benchmarks/braingrowth.py compare COPY                      # gyrify's runs, and the figures

Three lines of a copy of their simulation.py are changed, so that both solve the same problem: no part is kept
from growing, the thickness of the cortex does not change with time, and positions are written as they are.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.spatial import ConvexHull, cKDTree

from gyrify import Config, simulate
from gyrify.mesh import GREY, WHITE, Mesh
from gyrify.metrics.surface import face_areas
from gyrify.model.meshing import build_mesh
from gyrify.model.slice import Slice
from gyrify.report.surface_drawing import DrawnBody, paint
from gyrify.run.running import Run
from gyrify.store.journal import Journal

MESH, STEPS_PER_FILE = "data/sphere5.mesh", 500
CHANGES = {
    "gr = mark_nogrowth(coordinates0, n_nodes)": "gr = np.ones(n_nodes)",
    "cortex_thickness = THICKNESS_CORTEX + 0.01*t": "cortex_thickness = THICKNESS_CORTEX",
    "zoom_pos = paraZoom(coordinates, nodal_idx, longi_length)": "zoom_pos = 1.0",
}
# Theirs: lengths over the half length, growth time 0 to 1, shear moduli 1 (grey) and 1.167, bulk modulus 5.
THICKNESS, GROWTH, STIFFER, BULK, DAMPING = 0.042, 1.829, 1.167, 5.0, 0.5
TIMES = (0.1, 0.2, 0.235, 0.3, 0.4, 0.5, 0.65, 0.8)
FIGURE = Path(__file__).resolve().parents[1] / "docs" / "figures" / "braingrowth.png"


def run_theirs(copy: Path, python: str) -> None:
    """Run their program in one thread."""
    text = (copy / "simulation.py").read_text()
    for old, new in CHANGES.items():
        if text.count(old) != 1:
            raise SystemExit(f"{copy}/simulation.py has no line {old!r}: it is another version.")
        text = text.replace(old, new)
    (copy / "simulation_same.py").write_text(text)
    one = dict.fromkeys(("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    words = (
        f"{python} simulation_same.py -i {MESH} -o res/same -hc whole -t {THICKNESS} -g {GROWTH} -gm global"
    )
    ended = subprocess.run(words.split(), cwd=copy, env={**os.environ, **one}, check=False)
    (copy / "same.txt").write_text(f"{resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime}\n")
    if ended.returncode:  # without a part that does not grow the brain leaves the box of its contact search
        print("It ended before full growth: what it wrote until then is compared.", file=sys.stderr)


@dataclass(frozen=True)
class Folded:
    """Positions of the outer surface over growth time.

    Attributes
    ----------
    name : str
    times : (n_times,) float array
        0 to 1.
    points : (n_times, n_points, 3) float array
        Over the half length.
    cpu : float
        Processor time [s].
    """

    name: str
    times: np.ndarray
    points: np.ndarray
    cpu: float

    def at(self, time: float) -> np.ndarray:
        """Positions at a time, between the states."""
        near = np.argsort(np.abs(self.times - time), kind="stable")[:4]
        near.sort()
        return np.asarray(
            make_interp_spline(self.times[near], self.points[near], k=min(3, near.size - 1))(time)
        )


def theirs(copy: Path, scale: float) -> Folded:
    """What their program wrote."""
    files = sorted(copy.glob("res/same/*/B*.txt"), key=lambda path: int(path.stem[1:]))
    step = 0.05 * np.sqrt(0.01 * 0.01**2 / BULK)
    rows = [np.array(path.read_text().split(), dtype=float) for path in files]
    points = np.array([row[1 : 1 + 3 * int(row[0])].reshape(-1, 3) for row in rows])
    known = copy / "same.txt"
    cpu = float(known.read_text()) if known.exists() else float("nan")
    return Folded("BrainGrowth", STEPS_PER_FILE * step * np.arange(len(files)), points / scale, cpu)


def config_of(copy: Path, half_length: float, mean_radius: float, element: str) -> Config:
    """Their problem in gyrify's words; a unit of the file is taken for a centimetre."""
    poisson = (3.0 * BULK - 2.0) / (2.0 * (3.0 * BULK + 1.0))
    young = 2.0 * (1.0 + poisson)
    return Config().with_overrides(
        {
            "geometry.shape": "volume",
            "geometry.file": str(copy / MESH),
            "geometry.unit": "cm",
            "geometry.cortical_thickness": THICKNESS * half_length,
            "mesh.element": element,
            "mesh.node_jitter": 0.0,
            "material.young_modulus": 1e3 * young,
            "material.stiffness_ratio": 1.0 / STIFFER,
            "material.poisson_ratio": poisson,
            "growth.law": "tangential",
            "growth.profile": "sigmoid",
            "growth.rate": GROWTH / 500.0,
            "growth.ratio": 1e4,
            "dissipation.number": DAMPING * (mean_radius / half_length) ** 2 / young,
            "solver.increments": 50,
            "solver.linear_solver": "cg",
            "stability.detect": False,
        }
    )


def by_nearest_points(mesh: Mesh, geometry: Any) -> Mesh:
    """Mesh with depths as theirs has them: distances to the nearest point of the surface."""
    below, _ = cKDTree(mesh.points[mesh.contour]).query(mesh.points)
    is_grey = below[mesh.cells].mean(axis=1) < geometry.cortical_thickness
    depth = 2.0 - below / geometry.cortical_thickness
    return replace(mesh, depth=depth, region=np.where(is_grey, GREY, WHITE).astype(np.int8))


def ours(copy: Path, half_length: float, mean_radius: float, element: str) -> tuple[Folded, Any]:
    """A run of gyrify in one thread, in memory."""
    config = config_of(copy, half_length, mean_radius, element)
    simulate(config.replace(**{"growth.duration": 5.0, "solver.increments": 1}))  # compiles
    begun = time.process_time()
    mesh = by_nearest_points(build_mesh(config), config.geometry)
    journal = Journal.create(None, {"config": config.to_toml(), "versions": "{}", "n_dim": "3"})
    run = Run(Slice(config, mesh), journal)
    run.grow()
    history, cpu = run.history, time.process_time() - begun
    points = np.array([history.points(k)[mesh.contour] for k in range(len(history))]) / half_length
    return Folded(f"gyrify, {element}", history.fractions, points, cpu), mesh


def change(moved: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Displacements without the best rigid motion."""
    a, b = moved - moved.mean(axis=0), rest - rest.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))]) @ v
    return np.asarray(a @ turn - b)


def compare(copy: Path) -> None:
    """Print the figures, and draw the picture."""
    first = Config().with_overrides(
        {"geometry.shape": "volume", "geometry.file": str(copy / MESH), "geometry.unit": "cm"}
    )
    rest = first.geometry.surface.points
    # theirs is measured from the mean of all points of the mesh
    half_length = float(
        np.abs(first.geometry.volume.points - first.geometry.volume.points.mean(axis=0)).max()
    )
    found, mesh = [theirs(copy, half_length / 10.0)], None
    for element in ("linear", "mean_dilatation"):
        run, mesh = ours(copy, half_length, first.geometry.mean_radius, element)
        found.append(run)
    assert mesh is not None
    faces, rest = np.searchsorted(mesh.contour, mesh.faces), rest / half_length
    print("| | " + " | ".join(run.name for run in found) + " |")
    print("|---|" + "---:|" * len(found))
    print("| processor time [s] | " + " | ".join(f"{run.cpu:.0f}" for run in found) + " |")
    print("| growth reached | " + " | ".join(f"{run.times[-1]:.3f}" for run in found) + " |")
    whole = [run.cpu / run.times[-1] for run in found]  # extrapolated where growth was not completed
    print("| to full growth [s] | " + " | ".join(f"{time:.0f}" for time in whole) + " |")
    print("| ratio | " + " | ".join(f"{whole[0] / time:.0f}" for time in whole) + " |")
    for t in TIMES:
        states = [run.at(t) for run in found]
        changes = [change(state, rest) for state in states]
        sizes = [float(np.sqrt(np.square(u).sum(axis=1).mean())) for u in changes]
        alike = [float(np.corrcoef(changes[0].ravel(), u.ravel())[0, 1]) for u in changes]
        areas = [float(face_areas(state[faces]).sum()) for state in states]
        start = float(face_areas(rest[faces]).sum())
        print(f"| change of shape at {t:g}, rms | " + " | ".join(f"{size:.4f}" for size in sizes) + " |")
        print("| correlation with BrainGrowth's | " + " | ".join(f"{value:.3f}" for value in alike) + " |")
        print("| area over that at the start | " + " | ".join(f"{area / start:.3f}" for area in areas) + " |")
        hulls = [area / ConvexHull(state).area for area, state in zip(areas, states, strict=True)]
        print("| area over hull | " + " | ".join(f"{hull:.3f}" for hull in hulls) + " |")
    draw(found, mesh, half_length)


def draw(found: list[Folded], mesh: Any, scale: float) -> None:
    """Both brains at the last time that all have reached, from above and from the side."""
    last = min(run.times[-1] for run in found)
    figure, axes = plt.subplots(2, len(found), figsize=(3.6 * len(found), 6.4), layout="constrained")
    for column, run in enumerate(found):
        points = np.array(mesh.points)
        points[mesh.contour] = run.at(last) * scale
        points[mesh.contour] -= points[mesh.contour].mean(axis=0)
        body = DrawnBody(mesh, points)
        for row, view in enumerate(("from above", "from the side")):
            paint(axes[row, column], body.surface(view))
            axes[row, column].set_aspect("equal")
            axes[row, column].autoscale_view()
            axes[row, column].set_axis_off()
            axes[row, column].set(xlim=(-1.5 * scale, 1.5 * scale), ylim=(-1.15 * scale, 1.15 * scale))
            axes[row, column].text(-1.45 * scale, 1.02 * scale, view, fontsize=8)
        area = face_areas(body.corners).sum() / ConvexHull(points[mesh.contour]).area
        axes[0, column].set_title(f"{run.name}\narea over hull {area:.2f}", fontsize=10)
    figure.savefig(FIGURE, dpi=130)


def main() -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("run", "compare"))
    parser.add_argument("copy", type=Path)
    parser.add_argument("--python", default=sys.executable)
    options = parser.parse_args()
    if options.what == "run":
        run_theirs(options.copy, options.python)
    else:
        compare(options.copy)
    return 0


if __name__ == "__main__":
    sys.exit(main())
