"""Ratio (c): the whole run against the same increments on scikit-fem and SciPy."""

from __future__ import annotations

import numpy as np

from bench.figures import Figure, Figures
from bench.slices import configuration, grown, solvers
from bench.timing import Sample
from gyrify import History, measure_state


def whole_run(quick: bool) -> Figures:
    """Runs with gyrify's parts and with the exchanged ones, in turns."""
    from bench.peers.increments import ScikitFemEnergy, replaced

    names, seconds, last = solvers(), {}, {}
    for _ in range(1 if quick else 3):
        for name in names:
            last[name], spent = grown(configuration(quick, {"solver.linear_solver": name}))
            seconds.setdefault(name, []).append(spent)
        before = ScikitFemEnergy.evaluated
        with replaced():
            last["peer"], spent = grown(configuration(quick, {"solver.linear_solver": "superlu"}))
        if ScikitFemEnergy.evaluated - before < last["peer"].stats.newton_iterations:
            raise RuntimeError("the run did not use the exchanged assembly")
        seconds.setdefault("peer", []).append(spent)
    peer = Sample(tuple(seconds["peer"]))
    found = [Figure.of("scikit-fem and SciPy: processor time", peer)]
    found += _compared("scikit-fem and SciPy", last["peer"], last["superlu"])
    for name in names:
        own = Sample(tuple(seconds[name]))
        found.append(Figure.of(f"gyrify, {name}: processor time", own))
        found.append(Figure.of(f"scikit-fem and SciPy over gyrify, {name}", peer.over(own), "x"))
    return found


def _compared(name: str, peer: History, own: History) -> Figures:
    """Work of the peer, and how far its states are from gyrify's."""
    away = float(np.abs(peer.displacement() - own.displacement()).max())
    closing = [measure_state(history).gi_closing for history in (peer, own)]
    return [
        Figure(f"{name}: Newton iterations", peer.stats.newton_iterations),
        Figure(f"{name}: factorisations", peer.stats.factorizations),
        Figure(f"{name}: largest difference of the final displacement", float(f"{away:.1e}"), "mm"),
        Figure(f"{name}: difference of the gyrification index", float(f"{closing[0] - closing[1]:.1e}")),
    ]
