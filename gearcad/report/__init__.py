"""The reports of a check, of a rating, of stiffness by several methods, of dynamics, of a planetary train: HTML files."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from gearcad.report.check.report import report_html, write_report
    from gearcad.report.dynamics.report import dynamics_html, write_dynamics_report
    from gearcad.report.planetary.report import planetary_html, write_planetary_report
    from gearcad.report.stiffness.report import stiffness_html, write_stiffness_report
    from gearcad.report.strength.report import rate_html, write_rate_report
else:
    from gearcad.lazy import lazily

__all__ = [
    "dynamics_html",
    "planetary_html",
    "rate_html",
    "report_html",
    "stiffness_html",
    "write_dynamics_report",
    "write_planetary_report",
    "write_rate_report",
    "write_report",
    "write_stiffness_report",
]

if not TYPE_CHECKING:
    __getattr__ = lazily(
        __name__,
        __all__,
        (),
        (),
        {
            name: f"{room}.report.{name}"
            for room, *names in (
                ("check", "report_html", "write_report"),
                ("dynamics", "dynamics_html", "write_dynamics_report"),
                ("planetary", "planetary_html", "write_planetary_report"),
                ("stiffness", "stiffness_html", "write_stiffness_report"),
                ("strength", "rate_html", "write_rate_report"),
            )
            for name in names
        },
    )
