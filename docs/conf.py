"""The site of wearwell: `make docs` builds it from these pages, the headers in Doxygen's XML, the Python sources and R's help pages.

WEARWELL_DOXYGEN is the folder of Doxygen's XML (the Makefile sets it). Nothing is fetched from a network.
"""

import os
import sys
from pathlib import Path

here = Path(__file__).resolve().parent
root = here.parent
sys.path[:0] = [str(here / "_ext"), str(root / "python")]

project = "wearwell"
author = "the authors of wearwell"
copyright = "the authors of wearwell; Apache-2.0"
root_doc = "index"
exclude_patterns = ["_ext", "_tools"]
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "repository_files", "cpp_header", "r_help", "furo_of_debian"]

# Pages. Links go to pages and to their headings as GitHub names these, so that both places show them.
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # a page may begin a list of symbols at any level

# A link that leads nowhere is an error: the Makefile turns warnings into errors. Names of the C++ standard library, of Eigen and of
# private headers are not pages of this site.
nitpicky = True
nitpick_ignore_regex = [(r"cpp:.*", r".*"), (r"py:.*", r".*")]

# C++: the headers of docs/reference/library.md.
breathe_projects = {"wearwell": os.environ.get("WEARWELL_DOXYGEN", str(root / "build/docs/doxygen/xml"))}
breathe_default_project = "wearwell"
breathe_default_members = ("members",)
primary_domain = "cpp"
highlight_language = "none"

# Python: the sources are read, the compiled part is not needed. Docstrings are in the form of numpydoc.
napoleon_google_docstring = False
autodoc_mock_imports = ["wearwell._impl._core"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
smartquotes = False

html_theme = "furo"
html_title = "wearwell"
html_show_sphinx = False
html_copy_source = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_theme_options = {"navigation_with_keys": True}
html_last_updated_fmt = None
