"""The live page: a design in the browser that follows every change. It runs the same jobs as the command line."""

from __future__ import annotations
