"""What is shipped: the code, and what stands beside it."""

from __future__ import annotations

from pathlib import Path

__all__ = ["PACKAGE", "templates"]

PACKAGE = Path(__file__).parent
"""The folder of the code."""


def templates() -> Path:
    """The folder of starters and of the templates of reports: inside the package in a wheel, beside it in a checkout."""
    installed = PACKAGE / "templates"
    return installed if installed.is_dir() else PACKAGE.parent / "templates"
