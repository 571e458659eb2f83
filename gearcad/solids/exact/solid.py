"""The exact solid of a gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.geometry.gear import Gear
from gearcad.solids.exact.blank import add_blank
from gearcad.solids.exact.boundary import Boundary, Recorder
from gearcad.solids.exact.cad import cad_solid
from gearcad.solids.exact.gap import add_halves
from gearcad.solids.exact.outline import accuracy_for
from gearcad.solids.exact.ring_blank import add_ring_blank
from gearcad.solids.exact.teeth import add_teeth

if TYPE_CHECKING:
    import cadquery

__all__ = ["gear_boundary", "gear_solid"]


def gear_boundary(gear: Gear) -> Boundary:
    """The gear as a closed boundary, within 1 nm of the exact involute and fillet, or of its modified flanks.

    Teeth from z = 0 to the face width, tooth 0 centred on +x at z = 0. Raises GeometryError for a ring
    without a rim diameter.
    """
    recorder = Recorder(accuracy_for(gear))
    lower, upper = (add_halves if gear.double_helix.gap_width else add_teeth)(gear, recorder)
    (add_ring_blank if gear.internal else add_blank)(gear, recorder, lower, upper)
    return recorder.boundary()


def gear_solid(gear: Gear) -> cadquery.Solid:
    """The same as a solid to go on with in CadQuery, by `cadquery.Workplane(obj=gear_solid(gear))`: see `gear_boundary`."""
    return cad_solid(gear_boundary(gear))
