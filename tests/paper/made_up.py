"""Made-up results in which every observation of the paper holds, to be spoilt one by one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from gyrify.paper.cases import BOTH, EQUAL, SOFT, STIFFNESS, Case
from gyrify.paper.row import Row
from gyrify.paper.visible_folds import STATES

GI_BY_STIFFNESS = (1.0, 1.01, 1.1, 1.29, 1.37, 1.42, 1.44, 1.47)
LABELS = ("smooth", "lissencephaly", "pachygyria", "normal", "normal", *["sinusoidal"] * 3)
FIRST_FOLDED = {EQUAL: 1.715, SOFT: 2.03}


def perfect() -> dict[Case, Row]:
    """Results of a model that agrees with the paper in everything."""
    rows: dict[Case, Row] = {}
    for stiffness, gi, label in zip(STIFFNESS, GI_BY_STIFFNESS, LABELS, strict=True):
        uniform = 1.1 if stiffness > 1 else 1.5
        rows[Case(stiffness)] = Row(
            gi=gi, n_gyri=19, depth=5.0, width=10.0, crown_fundus=uniform, sharpness=2.0, label=label
        )
    rows[Case(STIFFNESS[2])] = replace(rows[Case(STIFFNESS[2])], n_gyri=12, depth=2.0)
    for stiffness in BOTH:
        one = rows[Case(stiffness)]
        first = FIRST_FOLDED[stiffness]
        rows |= {
            Case(stiffness, 1.0): Row(),
            Case(stiffness, first - 0.01): Row(gi=1.001),
            Case(stiffness, first): Row(gi=1.008, n_gyri=12, label="lissencephaly"),
            Case(stiffness, 2.5): Row(gi=1.1, n_gyri=17, label="pachygyria"),
            Case(stiffness, 36.0): replace(one, gi=one.gi + 0.2),
            Case(stiffness, 360.0): replace(one, gi=one.gi + 0.22),
            Case(stiffness, thickness=0.75): replace(
                one, gi=one.gi - 0.1, n_gyri=30, depth=3.0, width=5.0, label="polymicrogyria"
            ),
            Case(stiffness, thickness=3.0): replace(
                one, gi=one.gi - 0.1, n_gyri=11, depth=7.0, width=20.0, label="pachygyria"
            ),
            Case(stiffness, thickness=7.5): Row(gi=1.01 + 0.01 * stiffness, label="lissencephaly"),
            Case(stiffness, thickness=8.0): Row(gi=1.005 + 0.01 * stiffness, label="lissencephaly"),
        }
    assert {row.label for row in rows.values()} >= set(STATES)
    return rows


def spoilt(case: Case, **values: Any) -> dict[Case, Row]:
    """The same with one result changed."""
    rows = perfect()
    return rows | {case: replace(rows.get(case, Row()), **values)}
