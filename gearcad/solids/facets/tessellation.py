"""A gear as triangles, straight from the exact profile: structured, closed by construction, no more of them than needed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats, Wholes
from gearcad.errors import ParameterError, require_number
from gearcad.geometry import Gear
from gearcad.geometry.limits import at_least
from gearcad.solids.facets.disc import DiscBuilder
from gearcad.solids.facets.double import double_facets
from gearcad.solids.facets.ring import RingBuilder
from gearcad.solids.facets.sampling import tooth_grid
from gearcad.solids.rim import require_rim

__all__ = ["Facets", "gear_chord_error", "permitted_chord_error", "tessellate"]


_LEAST_CHORD_ERROR = 2e-7
"""Least chord error as a share of the tip diameter: mesh files hold float32, which steps by up to 6e-8 of it."""

_MOST_CHORD_ERROR = 0.01
"""Coarsest chord error in normal modules, so that small teeth keep their shape; a tenth of the thinnest wall."""


@dataclass(frozen=True)
class Facets:
    """A closed surface of triangles: `vertices` (n, 3) in mm, `faces` (m, 3), counter-clockwise from outside; read-only."""

    vertices: Floats
    faces: Wholes

    def __post_init__(self) -> None:
        self.vertices.flags.writeable = False
        self.faces.flags.writeable = False

    @property
    def volume(self) -> float:
        """Enclosed volume in mm³."""
        a, b, c = (self.vertices[self.faces[:, corner]] for corner in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


def permitted_chord_error(chord_error: float, size: float, words: str, module: float) -> float:
    """Return the chord error (mm) for a part of a size (mm) and normal module: that asked for, at most 0.01 modules.

    Raises ParameterError for one that is not positive, or below what the float32 of mesh files resolves.
    """
    require_number("chord_error", chord_error, "mm", above=0)
    if chord_error < (least := _LEAST_CHORD_ERROR * size):
        permitted = f"must be at least {at_least(least)} mm for a {words} of {size:.6g} mm (single precision)"
        raise ParameterError("chord_error", chord_error, permitted, "mm")
    return min(chord_error, _MOST_CHORD_ERROR * module)


def gear_chord_error(gear: Gear, chord_error: float) -> float:
    """Return the chord error (mm) that facets of a gear have. Raises as `permitted_chord_error`, and GeometryError."""
    outside, words = (require_rim(gear), "rim diameter") if gear.internal else (gear.tip_diameter, "tip diameter")
    return permitted_chord_error(chord_error, outside, words, gear.normal_module)


def tessellate(gear: Gear, chord_error: float = 0.005) -> Facets:
    """Triangles of the whole gear with its flanks as modified, nowhere more than `chord_error` (mm) from the exact surface.

    Teeth from z = 0 to the face width, hubs beyond. Errors above 0.01 m_n are made that, so that small teeth keep their
    shape. Raises ParameterError for a chord error that is not positive, or below what the float32 of mesh files resolves,
    GeometryError for a ring without a rim.
    """
    error = gear_chord_error(gear, chord_error)
    if gear.double_helix.present:
        return Facets(*double_facets(gear, error))
    grid = tooth_grid(gear, error)
    builder = (RingBuilder if gear.internal else DiscBuilder)(gear, grid, error)
    return Facets(np.concatenate(builder.vertices), np.concatenate(builder.faces))
