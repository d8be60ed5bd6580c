"""Equations as MathML, by docutils alone: no script, font or network, when building or when reading."""

from __future__ import annotations

import re

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.writers.html5 import HTML5Translator

# A letter, its index and its accent.
_UNDER_ACCENT = re.compile(
    r"<munderover>\s*(<mi>\w</mi>)\s*(<m[in]>\w+</m[in]>)\s*(<mo[^>]*>[ˉˆ˜˙_]</mo>)\s*</munderover>"
)
_LOGGER = logging.getLogger(__name__)


def setup(app: Sphinx) -> dict[str, object]:
    """Register the renderer."""
    app.add_html_math_renderer("mathml", (_inline, None), (_display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(translator: HTML5Translator, node: nodes.math) -> None:
    translator.body.append(_render(node, as_block=False))
    raise nodes.SkipNode


def _display(translator: HTML5Translator, node: nodes.math_block) -> None:
    translator.body.append(translator.starttag(node, "div", CLASS="math"))
    translator.body.append(_render(node, as_block=True))
    translator.body.append("</div>\n")
    raise nodes.SkipNode


def _render(node: nodes.Element, as_block: bool) -> str:
    """MathML of a node; an equation that cannot be read is a warning, and so an error of the build."""
    latex = node.astext().strip()
    if as_block and r"\\" in latex and r"\begin" not in latex:
        latex = rf"\begin{{aligned}}{latex}\end{{aligned}}"
    try:
        return _subscripts_of_accents(tex2mathml(latex, as_block=as_block))
    except MathError as error:
        _LOGGER.warning("equation cannot be read: %s: %s", error, latex, location=node)
        return _escaped(latex)


def _subscripts_of_accents(mathml: str) -> str:
    """Index beside an accented letter; docutils sets it under the letter, like a limit."""
    return _UNDER_ACCENT.sub(r'<msub><mover accent="true">\1\3</mover>\2</msub>', mathml)


def _escaped(latex: str) -> str:
    """Source of an equation, escaped."""
    return latex.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
