"""The report of a check, put together from its sections."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gearcad import __version__
from gearcad.check.comparison import Comparison, Role
from gearcad.check.run import CheckResult
from gearcad.plots.paper import short
from gearcad.report.figures import make_figures
from gearcad.report.reasons import root_reasons, stiffness_reasons
from gearcad.report.tables import gear_rows, load_rows, pair_rows, rating_rows

if TYPE_CHECKING:
    from markupsafe import Markup

__all__ = ["report_html", "write_report"]


def write_report(result: CheckResult, design_name: str, path: Path) -> None:
    """Write the report of a check of the design to `path`; the same result gives the same bytes."""
    path.write_text(report_html(result, design_name), encoding="utf-8")


def report_html(result: CheckResult, design_name: str) -> str:
    """The report as one HTML document without links: pictures and styles are inside."""
    from jinja2 import Environment, StrictUndefined

    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    environment.filters |= {"short": short, "indexed": _indexed}
    template = environment.from_string(_template().read_text(encoding="utf-8"))
    return template.render(name=design_name, version=__version__, result=result, **_sections(result))


def _indexed(text: str) -> Markup:
    """Symbols with their indices lowered: Y_F, F_t K_A/b."""
    from markupsafe import Markup, escape

    return Markup(re.sub(r"_([^\s*/,;)]+)", r"<sub>\1</sub>", str(escape(text))))


def _template() -> Path:
    """The wheel carries the templates inside the package; a checkout has them beside it."""
    package = Path(__file__).parent.parent
    installed = package / "templates"
    return (installed if installed.is_dir() else package.parent / "templates") / "report.html"


def _sections(result: CheckResult) -> dict[str, Any]:
    gates = [each for each in result.comparisons if each.role is Role.GATE]
    information = [each for each in result.comparisons if each.role is Role.INFORMATION]
    model = result.cycle.model
    return {
        "torque": result.load.torque * result.load.application_factor,
        "gates": [_row(each) for each in gates],
        "information": [_row(each) for each in information],
        "failed": [_row(each) for each in gates if not each.passed],
        "outside": [_row(each) for each in information if not each.passed],
        "gear_rows": gear_rows(result),
        "pair_rows": pair_rows(result),
        "load_rows": load_rows(result),
        "rating_rows": rating_rows(result),
        "figures": make_figures(result),
        "root_reasons": root_reasons(result),
        "stiffness_reasons": stiffness_reasons(result),
        "plane": result.options.plane_state.value,
        "nodes": [len(body.ring.sector.mesh.points) for body in (model.pinion, model.wheel)],
        "places": [len(body.loads) for body in (model.pinion, model.wheel)],
    }


def _row(comparison: Comparison) -> dict[str, str]:
    """A comparison as the tables have it; the verdict is a word, not only a colour."""
    gate = comparison.role is Role.GATE
    word = ("passed" if gate else "in the band") if comparison.passed else ("NOT PASSED" if gate else "outside the band")
    ratio = 100 * comparison.computed / comparison.reference
    return {
        "quantity": comparison.quantity,
        "computed": short(comparison.computed),
        "reference": short(comparison.reference),
        "unit": comparison.unit,
        "permitted": "at most" if comparison.tolerance is None else f"± {100 * comparison.tolerance:g} %",
        "deviation": f"{ratio:.1f} % of it" if comparison.tolerance is None else f"{round(ratio - 100, 2) + 0.0:+.2f} %",
        "word": word,
        "style": "good" if comparison.passed else "bad" if gate else "aside",
        "source": comparison.source,
        "note": comparison.note,
    }
