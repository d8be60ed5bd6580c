"""One row of results: what a simulation of the paper came to, as the rules read it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from gyrify.config import Config
from gyrify.phenotype import classify, grown_thickness


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
    breadth, flatness : float
        Of the gyri, as phenotypes have them [-].
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
    breadth: float = 0.0
    flatness: float = 0.0
    label: str = "smooth"
    because: str = ""
    key: str = ""

    @property
    def is_complete(self) -> bool:
        """Whether the run came to its end."""
        return self.status == "completed"


def row_of(config: Config, key: str, status: str, reason: str, metrics: Mapping[str, Any] | None) -> Row:
    """Row of a run that has ended.

    Parameters
    ----------
    config : Config
        The run.
    key : str
        Its folder.
    status, reason : str
        How it ended.
    metrics : mapping or None
        Names as in ``metrics.csv``, and ``gi``; see `gyrify.paper.index.index_metrics`.

    Returns
    -------
    Row
    """
    if status != "completed" or metrics is None:
        return Row(status if status != "completed" else "failed", reason, key=key)
    phenotype = classify(metrics, grown_thickness(config))
    return Row(
        gi=float("inf") if metrics["gi"] is None else metrics["gi"],
        n_gyri=metrics["n_gyri"],
        depth=metrics["sulcal_depth_mm_mean"],
        width=metrics["gyrus_width_mm"],
        crown_fundus=phenotype.numbers["crown_fundus"],
        sharpness=metrics["fold_sharpness"],
        breadth=phenotype.numbers["breadth"],
        flatness=phenotype.numbers["flatness"],
        label=phenotype.label,
        because=f"{phenotype.rule}: {phenotype.because}",
        key=key,
    )
