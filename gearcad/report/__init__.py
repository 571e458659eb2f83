"""The reports of a check, of stiffness by several methods, of dynamics and of a planetary train: HTML files by themselves."""

from gearcad.report.check.report import report_html, write_report
from gearcad.report.dynamics.report import dynamics_html, write_dynamics_report
from gearcad.report.planetary.report import planetary_html, write_planetary_report
from gearcad.report.stiffness.report import stiffness_html, write_stiffness_report

__all__ = [
    "dynamics_html",
    "planetary_html",
    "report_html",
    "stiffness_html",
    "write_dynamics_report",
    "write_planetary_report",
    "write_report",
    "write_stiffness_report",
]
