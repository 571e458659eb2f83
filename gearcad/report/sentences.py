"""Sentences of a report: they stand whole in the macros of templates, which put the figures of results into them."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

from gearcad.plots.paper import short
from gearcad.report.written import listed
from gearcad.shipped import templates

if TYPE_CHECKING:
    from jinja2 import Environment

__all__ = ["sentences"]


def sentences(template: str, macro: str, *values: object) -> str:
    """What a macro of a template says of values: plain text, in which its lines follow each other."""
    said = str(getattr(_plain().get_template(template).module, macro)(*values))
    return re.sub(r"[ \n]*\n[ \n]*", " ", said).strip(" ")


@cache
def _plain() -> Environment:
    """Of texts, in which nothing is escaped: a page does that, where it shows them."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    loader = FileSystemLoader(templates())
    environment = Environment(loader=loader, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters |= {"short": _short, "to": format, "beyond": _beyond, "listed": listed}
    return environment


def _short(value: float | None) -> str:
    """A figure, or that there is none."""
    return "none" if value is None else short(value)


def _beyond(value: float, reference: float, digits: int = 1) -> str:
    """By how many percent a value is above its reference, or with a minus below it."""
    return f"{100 * (value / reference - 1):+.{digits}f}"
