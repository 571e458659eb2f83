"""What the page is made of in the browser, an element for each script beside this file: they draw, and compute no gear."""

from __future__ import annotations
