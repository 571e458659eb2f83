"""The reports of a check, of a comparison of stiffness and of dynamics: HTML files that need nothing else."""

from gearcad.report.check.report import report_html, write_report
from gearcad.report.dynamics.report import dynamics_html, write_dynamics_report
from gearcad.report.stiffness.report import stiffness_html, write_stiffness_report

__all__ = [
    "dynamics_html",
    "report_html",
    "stiffness_html",
    "write_dynamics_report",
    "write_report",
    "write_stiffness_report",
]
