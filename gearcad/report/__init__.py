"""The report of a check: one HTML file that needs nothing else."""

from gearcad.report.write import report_html, write_report

__all__ = ["report_html", "write_report"]
