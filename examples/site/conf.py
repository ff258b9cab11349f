"""How Sphinx makes the site of README, the pages beside this file, theory and docstrings, without a second copy."""

import meshwind

project = "meshwind"
author = "The meshwind authors"
copyright = author
version = release = meshwind.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
nitpicky = False  # docstrings put file fields and words of the glossary in the same quotes as names
default_role = "py:obj"

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings have the types, in words
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_custom_sections = [("Attributes", "params_style")]  # names that share a line are no single target
napoleon_use_rtype = False

html_theme = "furo"
html_title = f"meshwind {version}"
html_static_path = ["static"]
html_css_files = ["wide.css"]
html_copy_source = False
html_show_sphinx = False
