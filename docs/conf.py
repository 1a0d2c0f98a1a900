"""The site: the pages of this folder by Sphinx, MyST and Furo, built by `tools/site.py`.

Everything is local: equations are MathML, made by docutils, and no page asks another host for
anything.
"""

from __future__ import annotations

import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS.parent))
sys.path.insert(0, str(DOCS))

from cqdd_design.version import __version__  # noqa: E402

project = "cqdd-design"
author = "The cqdd-design maintainers"
project_copyright = author
version = release = __version__
language = "en"

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "site_parts",
]
source_suffix = {".md": "markdown"}
exclude_patterns = ["figures"]
nitpicky = True
# Types of other packages have no page here, and there is no network to look them up in.
nitpick_ignore_regex = [(r"py:.*", r"(?!cqdd_design\.\w+$).*")]

myst_enable_extensions = ["colon_fence", "deflist"]
myst_fence_as_directive = {"math"}
myst_heading_anchors = 4

autodoc_typehints = "none"
autodoc_member_order = "bysource"
autodoc_class_signature = "separated"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True

# Classes are made by what reads or computes them; how Python makes them says nothing.
autodoc_default_options = {"exclude-members": "__new__, __init__"}

html_theme = "furo"
html_title = f"cqdd-design {release}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False
html_last_updated_fmt = None
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"
copybutton_prompt_text = r"\$ |>>> "
copybutton_prompt_is_regexp = True
copybutton_only_copy_prompt_lines = True
