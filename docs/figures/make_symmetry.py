"""Writes the table on mirror symmetry of docs/elements.md: `python docs/figures/make_symmetry.py`."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gyrify import Config, History, gyrification_index, simulate

PAGE = Path(__file__).parents[1] / "elements.md"
SHARES = (20, 40, 60, 80, 100)


def half_indices(history: History) -> tuple[float, float]:
    """Closing GI of the right and of the left half, each made whole by its own mirror image."""
    x = history.contour(len(history) - 1)
    quarter = len(x) // 4
    found = []
    for turn in (quarter, -quarter):
        half = np.roll(x, turn, axis=0)[: 2 * quarter + 1]
        found.append(gyrification_index(np.concatenate([half, (half * [-1.0, 1.0])[-2:0:-1]])))
    return found[0], found[1]


def row(name: str, history: History, mirrors: tuple) -> list[str]:
    """Difference between the state and its mirror image in x over growth, and the index of both halves."""
    states = [history.journal.state(share).u for share in SHARES]
    gaps = [max(float(np.abs(mirror.of(u) - u).max()) for mirror in mirrors) for u in states]
    right, left = half_indices(history)
    return [name, *(f"{gap:.0e}" if gap else "0" for gap in gaps), f"{right:.4f}", f"{left:.4f}"]


def main() -> None:
    """Run both and write the table."""
    base = Config.preset("reference-slice").with_overrides({"stability.detect": False})
    rows = []
    symmetric = simulate(base.replace(**{"mesh.split": "symmetric", "mesh.node_jitter": 0.0}))
    for split, jitter in (("alternating", 0.0), ("symmetric", 0.0), ("symmetric", 1e-3)):
        config = base.replace(**{"mesh.split": split, "mesh.node_jitter": jitter})
        rows.append(row(f"{split}, jitter {jitter:g}", simulate(config), symmetric.mesh.mirrors))
    head = ["split", *(f"{share} %" for share in SHARES), "GI, right", "GI, left"]
    lines = ["| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *rows]]
    text, count = re.subn(
        r"(<!-- symmetry -->\n).*?(<!-- end -->)",
        lambda match: match[1] + "\n".join(lines) + "\n" + match[2],
        PAGE.read_text(encoding="utf-8"),
        flags=re.DOTALL,
    )
    if count != 1:
        raise ValueError(f"The page has {count} tables named symmetry.")
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
