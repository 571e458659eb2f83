"""One HTML document from a template: what every report shares."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad import __version__
from gearcad.plots.paper import short

if TYPE_CHECKING:
    from markupsafe import Markup

__all__ = ["page_html"]


def page_html(template: str, design_name: str, **values: Any) -> str:
    """The page without links: pictures and styles are inside."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(_templates())
    environment = Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters |= {"short": short, "indexed": _indexed}
    return environment.get_template(template).render(name=design_name, version=__version__, **values)


def _indexed(text: str) -> Markup:
    """Symbols with their indices lowered: Y_F, F_t K_A/b."""
    from markupsafe import Markup, escape

    return Markup(re.sub(r"_([^\s*/,;)]+)", r"<sub>\1</sub>", str(escape(text))))


def _templates() -> Path:
    """The wheel carries the templates inside the package; a checkout has them beside it."""
    package = Path(__file__).parent.parent
    installed = package / "templates"
    return installed if installed.is_dir() else package.parent / "templates"
