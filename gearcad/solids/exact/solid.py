"""The exact solid of a gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.geometry.gear import Gear
from gearcad.solids.exact.blank import add_blank
from gearcad.solids.exact.gap import add_halves
from gearcad.solids.exact.kernel import Kernel
from gearcad.solids.exact.outline import accuracy_for
from gearcad.solids.exact.ring_blank import add_ring_blank
from gearcad.solids.exact.teeth import add_teeth

if TYPE_CHECKING:
    import cadquery

__all__ = ["gear_solid"]


def gear_solid(gear: Gear) -> cadquery.Solid:
    """The gear as a closed boundary representation, within 1 nm of the exact involute and fillet, or of its modified flanks.

    Teeth from z = 0 to the face width, tooth 0 centred on +x at z = 0. Go on in CadQuery with
    `cadquery.Workplane(obj=gear_solid(gear))`. Raises GeometryError for a ring without a rim diameter.
    """
    import cadquery

    kernel = Kernel(accuracy_for(gear))
    lower, upper = (add_halves if gear.double_helix.gap_width else add_teeth)(gear, kernel)
    (add_ring_blank if gear.internal else add_blank)(gear, kernel, lower, upper)
    return cadquery.Solid(kernel.solid())
