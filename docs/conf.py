"""The documentation site: `make docs` builds it from these pages and the docstrings, warnings as errors."""

import sys
from pathlib import Path

import gyrify

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "gyrify"
author = "The gyrify developers"
project_copyright = author
version = release = gyrify.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "numpydoc", "sphinx_copybutton", "mathml"]
exclude_patterns = ["_build"]
nitpicky = False

# Markdown: $…$ and $$…$$ as on GitHub; headings are targets of links.
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
html_math_renderer = "mathml"

# Docstrings: what a public name must say.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
numpydoc_validation_checks = {
    "GL01", "GL02", "GL03", "GL05", "GL06", "GL07", "GL08", "GL10",
    "SS01", "SS02", "SS03", "SS04",
    "PR01", "PR02", "PR03", "PR04", "PR05", "PR07", "PR09", "PR10", "YD01", "SA02",
}  # fmt: skip
# A record says what its fields are under Attributes; a configuration, on the page of its keys.
numpydoc_validation_overrides = {"PR01": [r"(?s).*\n *Attributes\n", r"Every number of a run"]}
# Every error has the parameters of the first.
numpydoc_validation_exclude = {r"gyrify\.(?!Gyrify)\w+Error$"}

html_theme = "furo"
html_title = f"gyrify {release}"
html_static_path = ["_static"]
html_css_files = ["gyrify.css"]
html_show_sphinx = False
html_copy_source = False
# The same bytes for the same pages.
html_last_updated_fmt = None
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#005b8f", "color-brand-content": "#005b8f"},
    "dark_css_variables": {"color-brand-primary": "#6cc4f5", "color-brand-content": "#6cc4f5"},
}
pygments_style = "default"
pygments_dark_style = "github-dark"
# Copy the command, not the prompt or the output.
copybutton_prompt_text = "$ "
copybutton_exclude = ".linenos, .gp, .go"
