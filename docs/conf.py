"""The documentation as pages: `make docs` builds them into out/docs."""

import sys
from importlib.metadata import version as version_of
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from figures import draw

draw()

project = "inerter"
author = "The inerter authors"
copyright = author
version = release = version_of("inerter")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx_copybutton",
]
root_doc = "index"
source_suffix = {".md": "markdown"}
exclude_patterns = ["examples"]  # a script that stands on its own

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
# headings that a link may go to
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_default_options = {"members": True}
napoleon_google_docstring = False

html_theme = "furo"
html_title = "inerter"
html_static_path = ["_static"]
html_css_files = ["page.css"]
