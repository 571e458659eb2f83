"""Boundaries as objects of CadQuery, to go on with in Python."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.solids.exact.boundary import Boundary
from gearcad.solids.exact.kernel import kernel_solid

if TYPE_CHECKING:
    import cadquery

__all__ = ["cad_solid"]


def cad_solid(boundary: Boundary) -> cadquery.Solid:
    """The solid of a boundary."""
    import cadquery

    return cadquery.Solid(kernel_solid(boundary))
