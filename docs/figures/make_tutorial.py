"""Draws folded.png, and tutorial-phase-diagram.png from the study of docs/tutorial.md (some minutes)."""

from __future__ import annotations

import re
import shutil
import tempfile
from pathlib import Path

from gyrify import Config, Study, run_study, simulate
from gyrify.report import save_figure
from gyrify.report.outputs import folded_picture
from gyrify.report.study_pictures import write_study_pictures
from gyrify.run.summary import summarise

HERE = Path(__file__).parent
NAME = "tutorial-phase-diagram.png"


def study() -> Study:
    """The study that the tutorial shows."""
    page = (HERE.parent / "tutorial.md").read_text(encoding="utf-8")
    block = re.search(r"```toml\n(# map\.toml\n.*?)```", page, re.DOTALL)
    if block is None:
        raise SystemExit("docs/tutorial.md has no study named map.toml")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "map.toml"
        file.write_text(block[1], encoding="utf-8")
        return Study.from_toml(file)


if __name__ == "__main__":
    history = simulate(Config.preset("reference-slice"))
    save_figure(folded_picture(history, summarise(history)), HERE / "folded.png", dpi=150)
    with tempfile.TemporaryDirectory() as folder:
        run_study(study(), folder)
        write_study_pictures(folder)
        shutil.copyfile(Path(folder) / "phase-diagram.png", HERE / NAME)
