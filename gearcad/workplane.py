"""Gears in the chains of CadQuery: `import gearcad.workplane` gives Workplane the methods `gear`, `gear_pair` and `rack`.

>>> import cadquery, gearcad.workplane
>>> from gearcad import Gear
>>> plate = cadquery.Workplane("XY").box(80, 80, 6)  # doctest: +SKIP
>>> part = plate.faces(">Z").workplane().gear(Gear(teeth=24, normal_module=2, face_width=12))  # doctest: +SKIP
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gearcad.geometry import Gear, GearPair, Rack

if TYPE_CHECKING:
    from cadquery import Shape, Workplane

__all__ = ["install"]


def gear(self: Workplane, gear: Gear, *, combine: bool = True, clean: bool = False) -> Workplane:
    """Put a gear at each point of the stack, or at the origin of the plane: teeth along the plane's normal, tooth 0 on its x.

    With `combine` it is joined to the solid of the chain, otherwise it stands by itself. Faces are not merged with those
    beside them unless `clean`, which takes long and would lose nothing but edges. Raises GeometryError as `gear_solid` does.
    """
    from gearcad.solids import gear_solid

    return _put(self, gear_solid(gear), combine=combine, clean=clean)


def gear_pair(self: Workplane, pair: GearPair) -> Workplane:
    """Put pinion and wheel of a pair in mesh at each point of the stack, the wheel on +x: two solids that are not joined."""
    from gearcad.solids import pair_assembly

    return _put(self, pair_assembly(pair).toCompound(), combine=False, clean=False)


def rack(self: Workplane, rack: Rack, *, combine: bool = True, clean: bool = False) -> Workplane:
    """Put a rack at each point of the stack, in the coordinates of the rack."""
    from gearcad.solids import rack_solid

    return _put(self, rack_solid(rack), combine=combine, clean=clean)


def _put(self: Workplane, shape: Shape, *, combine: bool, clean: bool) -> Workplane:
    placed = self.eachpoint(lambda place: shape.moved(place), useLocalCoordinates=True)
    return self._combineWithBase(placed, combine, clean) if combine else placed


def install() -> None:
    """Give CadQuery's Workplane the methods of this module. It is called when the module is imported."""
    from cadquery import Workplane

    for method in (gear, gear_pair, rack):
        setattr(Workplane, method.__name__, method)


install()
