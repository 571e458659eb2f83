"""What parts weigh, in kg: the volume of their solids times the density of their material."""

from __future__ import annotations

from gearcad.drawing.subject import DrawnGear, DrawnPair
from gearcad.geometry import Gear, Rack
from gearcad.solids import tessellate, tessellate_rack

__all__ = ["mass_of", "mass_of_pair"]

_CHORD_ERROR = 0.001
"""Of the solid, in normal modules: volumes are then right within 0.02 %, and three digits of them are shown."""

_FINEST = 1e-6
"""Least chord error as a share of the largest size: finer triangles than mesh files can hold are refused."""

_PER_CUBIC_MILLIMETRE = 1e-9
"""From a density in kg/m³."""


def mass_of(drawn: DrawnGear) -> float | None:
    """That of a gear or a rack; None where no material is given, and of a ring that has no rim."""
    volume = _volume(drawn.gear)
    return None if drawn.material is None or volume is None else volume * drawn.material.density * _PER_CUBIC_MILLIMETRE


def _volume(part: Gear | Rack) -> float | None:
    """In mm³."""
    error = _CHORD_ERROR * part.normal_module
    if isinstance(part, Rack):
        size = max(part.length, part.face_width, part.total_height)
        return tessellate_rack(part, max(error, _FINEST * size)).volume
    outside = part.body.rim_diameter if part.internal else part.tip_diameter
    return None if outside is None else tessellate(part, max(error, _FINEST * outside)).volume


def mass_of_pair(drawn: DrawnPair) -> float | None:
    """The sum of both; None where one of them is not known."""
    first, second = (mass_of(part) for part in drawn.parts)
    return None if first is None or second is None else first + second
