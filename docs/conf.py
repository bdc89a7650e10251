"""How Sphinx makes the pages. `./dev docs` gathers them in build/docs/source first (tools/docs_pages.py)."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

import takt  # noqa: E402

project = "Takt"
author = "the Takt authors"
project_copyright = author
release = takt.__version__
version = release

extensions = ["myst_parser", "sphinx.ext.autodoc", "tools.doc_strings", "tools.state_diagrams"]
myst_enable_extensions = ["colon_fence", "deflist", "attrs_block"]
myst_heading_anchors = 3
myst_fence_as_directive = ["mermaid"]  # as other readers of Markdown know it; drawn by Graphviz here
default_role = "code"  # doc strings are prose with `names`
highlight_language = "text"
nitpicky = False
smartquotes = False  # "text" is what is typed

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
add_module_names = False
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 100

html_theme = "furo"
html_title = f"Takt {release}"
html_static_path = [str(ROOT / "docs" / "static")]
html_css_files = ["pages.css"]
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#1d5fa8", "color-brand-content": "#1d5fa8"},
    "dark_css_variables": {"color-brand-primary": "#7db4ee", "color-brand-content": "#7db4ee"},
}
