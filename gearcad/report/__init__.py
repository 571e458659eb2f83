"""The reports of a check and of a comparison of stiffness: HTML files that need nothing else."""

from gearcad.report.stiffness import stiffness_html, write_stiffness_report
from gearcad.report.write import report_html, write_report

__all__ = ["report_html", "stiffness_html", "write_report", "write_stiffness_report"]
