"""The documentation as pages: `make docs` builds them into out/docs."""

import sys
from importlib.metadata import version as version_of
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from generated import make

if missing := make():
    print(f"scenes not rendered: {missing}")

project = "inerter"
author = "The inerter authors"
copyright = author
version = release = version_of("inerter")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx_copybutton",
]
root_doc = "index"
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
# scripts that stand on their own, and what other pages include
exclude_patterns = ["examples/*.py", "figures/*.md"]

# the notebook is run when its text, or the build's folder, is new
nb_execution_mode = "cache"
nb_execution_raise_on_error = True
nb_execution_timeout = 120

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
