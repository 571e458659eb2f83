"""How Sphinx builds the manual: `sphinx-build -W docs output/manual`. Nothing is fetched, neither to build nor to read it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

from gearcad import __version__

project = "gearcad"
author = "The gearcad authors"
version = release = __version__
copyright = "The gearcad authors"  # a name that Sphinx has chosen

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx_copybutton",
    "manual.mathml",
    "manual.made",
    "manual.table_pages",
    "manual.command_pages",
    "manual.python_pages",
    "manual.validation_pages",
]
exclude_patterns = ["README.md", "manual", "paper", "figures/*.py"]
nitpicky = True
smartquotes = False

myst_enable_extensions = ["attrs_block", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
html_math_renderer = "mathml"

default_role = "literal"  # docstrings have code between single backquotes
add_module_names = False
toc_object_entries_show_parents = "hide"
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True

html_theme = "furo"
html_title = f"gearcad {version.partition('+')[0]}"
html_static_path = ["static"]
html_css_files = ["manual.css"]
html_copy_source = False
html_show_sphinx = False
html_show_search_summary = False  # its excerpts are fetched, which no browser does of files
html_theme_options = {"top_of_page_buttons": []}

copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True


def setup(app: Sphinx) -> None:
    app.add_lexer("csv", TextLexer)  # Pygments has none for design tables
