"""Browser elements of the page, one for each script beside this file: they draw and compute no gear."""

from __future__ import annotations
