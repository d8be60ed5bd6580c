"""Which simulation stands where in the paper's figures 2 to 8, S1 and S2, and what their captions say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from gyrify.paper.cases import BOTH, EQUAL, GROWTH, SOFT, STIFFNESS, THICKNESS, Case, ratio_text, series

Varied = Literal["stiffness", "growth", "thickness"]
_SYMBOLS: Final = {"stiffness": "$E_G/E_W$", "growth": "$G_G/G_W$", "thickness": "$T$"}


@dataclass(frozen=True)
class Layout:
    """One figure.

    Attributes
    ----------
    name : str
        Name of its file.
    panels : tuple of tuple of Case
        Rows of slices.
    varied : tuple of str
        What is written above each slice.
    own_scale : bool
        Whether each slice fills its panel, with a scale bar of its own.
    caption : str
        What the paper's caption says of it, in our words.
    """

    name: str
    panels: tuple[tuple[Case, ...], ...]
    varied: tuple[Varied, ...]
    own_scale: bool
    caption: str

    def heading(self, case: Case) -> str:
        """What is written above a slice."""
        values = {
            "stiffness": ratio_text(case.stiffness),
            "growth": f"{case.growth:.4g}",
            "thickness": f"{case.thickness:g} mm",
        }
        return ", ".join(f"{_SYMBOLS[key]} = {values[key]}" for key in self.varied)


_E: Final = tuple(Case(stiffness) for stiffness in STIFFNESS)
_NO_MRI: Final = "The magnetic resonance images beside it in the paper are not reproduced."
LAYOUTS: Final = (
    Layout("figure-2", (_E[:4], _E[4:]), ("stiffness",), False, "The effect of the stiffness ratio."),
    Layout("figure-3", ((_E[2],),), ("stiffness",), False, f"Pachygyria at 1/2. {_NO_MRI}"),
    Layout("figure-4", ((_E[1],),), ("stiffness",), False, f"Type I lissencephaly at 1/2.61. {_NO_MRI}"),
    Layout(
        "figure-5",
        tuple(tuple(Case(e, g) for g in GROWTH) for e in BOTH),
        ("stiffness", "growth"),
        True,
        "The effect of the growth rate ratio. Every slice is scaled to its panel, as in the paper.",
    ),
    Layout(
        "figure-6",
        tuple(tuple(Case(e, thickness=t) for t in THICKNESS) for e in BOTH),
        ("stiffness", "thickness"),
        False,
        "The effect of the initial cortical plate thickness.",
    ),
    Layout(
        "figure-7",
        (tuple(Case(e, thickness=0.75) for e in BOTH),),
        ("stiffness", "thickness"),
        False,
        f"Polymicrogyria at T = 0.75 mm. {_NO_MRI}",
    ),
    Layout(
        "figure-8",
        ((Case(SOFT, thickness=7.5), Case(EQUAL, thickness=8.0)),),
        ("stiffness", "thickness"),
        False,
        f"Lissencephaly at T = 7.5 and 8 mm. {_NO_MRI}",
    ),
    *(
        Layout(
            f"figure-{name}",
            (series(e)[:4], (*series(e)[4:],)),
            ("stiffness", "growth"),
            True,
            f"From growth ratio 1 to 3.6 at stiffness ratio {ratio_text(e)}. The growth ratios are ours, but "
            "for the paper's threshold (the third); its supplement is not quoted.",
        )
        for name, e in (("S1", EQUAL), ("S2", SOFT))
    ),
)
