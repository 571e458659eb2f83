"""The exact solid of a gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.errors import GeometryError
from gearcad.geometry.gear import Gear
from gearcad.solids.exact.blank import add_blank
from gearcad.solids.exact.gap import add_halves
from gearcad.solids.exact.kernel import Kernel
from gearcad.solids.exact.outline import accuracy_for
from gearcad.solids.exact.teeth import add_teeth

if TYPE_CHECKING:
    import cadquery

__all__ = ["gear_solid"]


def gear_solid(gear: Gear) -> cadquery.Solid:
    """The gear as a closed boundary representation, within 1 nm of the exact involute and trochoid, or of its modified flanks.

    Teeth from z = 0 to the face width, tooth 0 centred on +x at z = 0. Go on in CadQuery with
    `cadquery.Workplane(obj=gear_solid(gear))`. Raises GeometryError for a ring.
    """
    import cadquery

    if gear.internal:
        raise GeometryError("teeth", gear.teeth, "must be above 0: there are no exact solids of internal gears yet")

    kernel = Kernel(accuracy_for(gear))
    lower, upper = (add_halves if gear.double_helix.gap_width else add_teeth)(gear, kernel)
    add_blank(gear, kernel, lower, upper)
    return cadquery.Solid(kernel.solid())
