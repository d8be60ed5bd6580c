"""A quantity of one's own: how much of the contour lies inside sulci.

Whatever is added to `gyrify.metrics.quantities.MEASURED` is measured of every state, and stands with its unit
and label in summary.json, metrics.csv, results.parquet, reports, notebooks and tables.

Run it: ``python examples/own_quantity.py``
"""

from __future__ import annotations

import gyrify
from gyrify.metrics.deformed import Deformed
from gyrify.metrics.quantities import MEASURED, Quantity


def buried_fraction(shape: Deformed) -> float:
    """Part of the contour that a disc of the closing radius cannot touch [-]."""
    return max(1.0 - shape.exposed_length / shape.length, 0.0)


BURIED = Quantity(
    path="buried_fraction",
    type=float,
    unit="1",
    label="buried in sulci",
    decimals=2,
    about="Part of the contour that lies in sulci",
    shown=frozenset({"run", "notebook", "study", "table", "converge"}),
    measure=buried_fraction,
)


def main() -> None:
    """Fold a coarse slice and tell how much of its contour is buried."""
    MEASURED.append(BURIED)
    config = gyrify.Config().with_overrides(
        {"mesh.n_around": 108, "mesh.n_layers": 9, "mesh.n_cortex_layers": 3}
    )
    history = gyrify.simulate(config)
    print(f"{gyrify.measure_state(history).buried_fraction:.2f} of the contour lies in sulci.")


if __name__ == "__main__":
    main()
