"""Draw ``reference-brain.png``: the preset of that name at the end of growth, and cut across.

``python docs/figures/make_brain.py`` folds it in a temporary folder, which takes some minutes.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from PIL import Image

from gyrify.config import Config
from gyrify.report.outputs import write_outputs
from gyrify.run.simulation import simulate

PICTURE = Path(__file__).parent / "reference-brain.png"
WIDTH, COLOURS = 1180, 64


def main() -> None:
    """Fold it, and make the run's own picture small."""
    with tempfile.TemporaryDirectory() as folder:
        run = Path(folder) / "brain"
        history = simulate(Config.preset("reference-brain"), run)
        write_outputs(history, run)
        history.journal.close()
        with Image.open(run / "folded.png") as drawn:
            height = round(WIDTH * drawn.height / drawn.width)
            small = drawn.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
            small.quantize(COLOURS).save(PICTURE, optimize=True)


if __name__ == "__main__":
    main()
