"""The report of a check, put together from its sections."""

from __future__ import annotations

from functools import singledispatch
from pathlib import Path
from typing import Any

from gearcad.check.plane.result import PlaneCheck
from gearcad.check.result import CheckResult
from gearcad.check.solid.result import SolidCheck
from gearcad.report.check.plane import PlaneSections
from gearcad.report.check.sections import CheckSections
from gearcad.report.check.solid import SolidSections
from gearcad.report.page import page_html

__all__ = ["report_html", "write_report"]


def write_report(result: CheckResult, design_name: str, path: Path) -> None:
    """Write the report of a check of the design to `path`; the same result gives the same bytes."""
    path.write_text(report_html(result, design_name), encoding="utf-8")


def report_html(result: CheckResult, design_name: str) -> str:
    """The report as one HTML document without links: pictures and styles are inside."""
    sections = _sections(result)
    return page_html(sections.template, design_name, result=result, of=sections)


@singledispatch
def _sections(result: CheckResult) -> CheckSections[Any]:
    """Those of its model."""
    raise NotImplementedError(type(result).__name__)


_sections.register(PlaneCheck, PlaneSections)
_sections.register(SolidCheck, SolidSections)
