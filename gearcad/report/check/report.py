"""The report of a check, put together from its sections."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gearcad.check.comparison import Comparison, Role
from gearcad.check.convergence import SOLID_ORDER
from gearcad.check.plane.result import PlaneCheck
from gearcad.check.result import CheckResult
from gearcad.check.solid.result import SolidCheck
from gearcad.plots.paper import short
from gearcad.report.check.figures import make_figures, pair_picture
from gearcad.report.check.reasons import stiffness_reasons
from gearcad.report.check.reasons_plane import plane_root_reasons
from gearcad.report.check.reasons_solid import face_reasons, solid_root_reasons
from gearcad.report.check.tables import gear_rows, load_rows, pair_rows, rating_rows
from gearcad.report.check.views import tooth_views
from gearcad.report.page import page_html
from gearcad.report.stiffness.report import section_of_check

__all__ = ["report_html", "write_report"]


def write_report(result: CheckResult, design_name: str, path: Path) -> None:
    """Write the report of a check of the design to `path`; the same result gives the same bytes."""
    path.write_text(report_html(result, design_name), encoding="utf-8")


def report_html(result: CheckResult, design_name: str) -> str:
    """The report as one HTML document without links: pictures and styles are inside."""
    return page_html("report.html", design_name, result=result, **_sections(result))


def _sections(result: CheckResult) -> dict[str, Any]:
    gates = [each for each in result.comparisons if each.role is Role.GATE]
    information = [each for each in result.comparisons if each.role is Role.INFORMATION]
    return {
        "torque": result.torque,
        "verdict": result.verdict[0].upper() + result.verdict[1:],
        "gates": [_row(each) for each in gates],
        "information": [_row(each) for each in information],
        "failed": [_row(each) for each in gates if not each.passed],
        "outside": [_row(each) for each in information if each.evaluated and not each.passed],
        "pair_picture": pair_picture(result.pair),
        "gear_rows": gear_rows(result.pair),
        "pair_rows": pair_rows(result.pair),
        "load_rows": load_rows(result.material, result.load, result.mounting),
        "rating_rows": rating_rows(result),
        "figures": make_figures(result),
        "views": tooth_views(result),
        "stiffness": section_of_check(result),
        "stiffness_reasons": stiffness_reasons(result),
        **_of_model(result),
    }


def _of_model(result: CheckResult) -> dict[str, Any]:
    """What the models tell differently."""
    if isinstance(result, SolidCheck):
        solids = (result.cycle.model.pinion, result.cycle.model.wheel)
        return {
            "solid": True,
            "solid_order": SOLID_ORDER,
            "root_reasons": solid_root_reasons(result),
            "face_reasons": face_reasons(result),
            "nodes": [body.body.sector.mesh.nodes for body in solids],
            "places": [len(body.torques) for body in solids],
        }
    assert isinstance(result, PlaneCheck)  # there are two
    bodies = (result.cycle.model.pinion, result.cycle.model.wheel)
    return {
        "solid": False,
        "root_reasons": plane_root_reasons(result),
        "nodes": [len(body.ring.sector.mesh.points) for body in bodies],
        "places": [len(body.loads) for body in bodies],
    }


def _row(comparison: Comparison) -> dict[str, str]:
    """A comparison as the tables have it; the verdict is a word, not only a colour."""
    gate = comparison.role is Role.GATE
    if comparison.passed:
        word = "passed" if gate else "in the band"
    else:
        word = "NOT PASSED" if gate else "outside the band" if comparison.evaluated else "not evaluated"
    return {
        "quantity": comparison.quantity,
        "computed": _number(comparison.computed),
        "reference": _number(comparison.reference),
        "unit": comparison.unit,
        "permitted": "at most" if comparison.tolerance is None else f"± {100 * comparison.tolerance:g} %",
        "deviation": _deviation(comparison),
        "word": word,
        "style": "good" if comparison.passed else "bad" if gate else "aside",
        "source": comparison.source,
        "note": comparison.note,
        "reason": comparison.reason,
    }


def _number(value: float | None) -> str:
    return "-" if value is None else short(value)


def _deviation(comparison: Comparison) -> str:
    """From a value, or how much of a limit is used up."""
    if comparison.deviation is None:
        return "-"
    percent = 100 * comparison.deviation
    return f"{100 + percent:.1f} % of it" if comparison.tolerance is None else f"{round(percent, 2) + 0.0:+.2f} %"
