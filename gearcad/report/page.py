"""One HTML document from a template: what every report shares - contents, date, versions, and room to scroll."""

from __future__ import annotations

import html
import platform
import re
from collections.abc import Container
from datetime import date
from importlib import metadata
from itertools import count
from typing import TYPE_CHECKING, Any

from gearcad.output import source_date
from gearcad.plots.paper import short
from gearcad.report.written import indexed, listed, written
from gearcad.shipped import templates
from gearcad.version import __version__

if TYPE_CHECKING:
    from markupsafe import Markup

__all__ = ["page_html"]


_LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh", "matplotlib")
"""What the figures of a report rest on, besides our own code."""

_HEADING = re.compile(r"<h2>(.*?)</h2>")


def page_html(template: str, design_name: str, **values: Any) -> str:
    """The page without links to elsewhere: pictures and styles are inside. Its date is that of `source_date`, or today."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(templates())
    environment = Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters |= {"short": short, "finished": _finished}
    environment.filters |= {"written": written, "indexed": indexed, "listed": listed}
    fixed = source_date()
    made = {"version": __version__, "versions": _versions(), "date": (fixed.date() if fixed else date.today()).isoformat()}
    return environment.get_template(template).render(name=design_name, **made, **values)


def _versions() -> list[str]:
    libraries = (f"{name} {metadata.version(name)}" for name in _LIBRARIES)
    return [f"gearcad {__version__}", f"Python {platform.python_version()}", *libraries]


def _finished(content: Markup) -> Markup:
    """The content with a name for each section, a list of them before the first, and tables that scroll by themselves."""
    from markupsafe import Markup

    sections: dict[str, str] = {}

    def named(heading: re.Match[str]) -> str:
        anchor = _anchor(heading[1], sections)
        sections[anchor] = heading[1]
        return f'<h2 id="{anchor}">{heading[1]}</h2>'

    text = _HEADING.sub(named, str(content))
    text = text.replace("<table>", '<div class="scroll"><table>').replace("</table>", "</table></div>")
    entries = "".join(f'<li><a href="#{anchor}">{title}</a></li>\n' for anchor, title in sections.items())
    before, first, rest = text.partition("<h2 id=")
    return Markup(f'{before}<nav aria-label="Contents">\n<ul>\n{entries}</ul>\n</nav>\n{first}{rest}')


def _anchor(title: str, taken: Container[str]) -> str:
    """A name for a section, made of the words of its title."""
    plain = html.unescape(re.sub(r"<[^>]*>", "", title)).lower()
    words = "-".join(re.findall(r"[a-z0-9]+", plain)) or "section"
    return next(name for number in count(1) if (name := f"section-{words}" + f"-{number}" * (number > 1)) not in taken)
