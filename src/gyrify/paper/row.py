"""One row of results: what a simulation of the paper came to, as the rules read it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

from gyrify.config import Config
from gyrify.phenotype import classify, grown_thickness
from gyrify.study.results import flat

GiDefinition = Literal["closing", "hull", "exposed"]
GI_DEFINITIONS: Final[tuple[GiDefinition, ...]] = ("closing", "hull", "exposed")


@dataclass(frozen=True)
class Row:
    """Result of one case.

    Attributes
    ----------
    status, reason : str
        How the run ended; only one that is ``completed`` has what follows.
    gi : float
        Gyrification index by the definition of the reading [-].
    n_gyri : int
        Number of gyri.
    depth : float
        Mean sulcal depth [mm].
    width : float
        Mean width of a gyrus [mm].
    crown_fundus : float
        Cortical thickness at crowns over that at fundi [-].
    sharpness : float
        Turning at fundi over that at crowns [-].
    label, because : str
        Phenotype, and the rule and numbers that gave it.
    key : str
        Folder of the run in its study.
    """

    status: str = "completed"
    reason: str = ""
    gi: float = 1.0
    n_gyri: int = 0
    depth: float = 0.0
    width: float = 0.0
    crown_fundus: float = 1.0
    sharpness: float = 1.0
    label: str = "smooth"
    because: str = ""
    key: str = ""

    @property
    def is_complete(self) -> bool:
        """Whether the run came to its end."""
        return self.status == "completed"


def row_of(
    config: Config, key: str, status: str, reason: str, summary: Mapping[str, Any] | None, gi: GiDefinition
) -> Row:
    """Row of a run that has ended.

    Parameters
    ----------
    config : Config
        The run.
    key : str
        Its folder.
    status, reason : str
        How it ended.
    summary : mapping or None
        As in ``summary.json``.
    gi : {"closing", "hull", "exposed"}
        Definition of the gyrification index.

    Returns
    -------
    Row
    """
    if status != "completed" or summary is None:
        return Row(status if status != "completed" else "failed", reason, key=key)
    metrics = flat(summary)
    index = metrics[f"gi_{gi}"]
    phenotype = classify(metrics, grown_thickness(config))
    return Row(
        gi=float("inf") if index is None else index,
        n_gyri=metrics["n_gyri"],
        depth=metrics["sulcal_depth_mm_mean"],
        width=metrics["gyrus_width_mm"],
        crown_fundus=phenotype.numbers["crown_fundus"],
        sharpness=metrics["fold_sharpness"],
        label=phenotype.label,
        because=f"{phenotype.rule}: {phenotype.because}",
        key=key,
    )
