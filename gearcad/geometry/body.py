"""Body: what surrounds the teeth - bore, keyway, hub, chamfers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated

from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry.derived import Derived, is_given
from gearcad.geometry.din6885 import keyway_of
from gearcad.geometry.limits import at_most
from gearcad.ranges import Range, Whole
from gearcad.reprs import concise
from gearcad.schema import Words, require_fields, schema_of

__all__ = ["LEAST_FEATURE", "Body", "HubSide"]

FEATURE = Range("mm", 0, None)

LEAST_FEATURE = 0.001
"""Smallest size (mm) of anything on a body; less could be neither made nor measured."""


class HubSide(Enum):
    """Where the hub stands out: beyond z = face width (front), below z = 0 (back), or both."""

    FRONT = "front"
    BACK = "back"
    BOTH = "both"


@dataclass(frozen=True, kw_only=True)
class Body:
    """The gear's body. Lengths in mm, angles in degrees; 0 leaves a feature out.

    `keyway_depth` is measured from the bore outwards (t2 of DIN 6885), the keyway lies on +x, under tooth 0. With `keyway` its
    width and depth are those of DIN 6885-1 for the bore, and read as numbers (see `Derived`).
    `hub_length` is how far the hub stands out on each `hub_side`. `rim_diameter` is the outside of an internal gear.
    `end_chamfer` is the axial length of the cone turned on both ends of the tip cylinder, `end_chamfer_angle` the angle
    between that cone and the gear axis, so that the radial depth is end_chamfer * tan(end_chamfer_angle).
    `tip_chamfer` is the radial height of the 45-degree chamfer along both tip edges of each tooth (transverse section).
    A ring has no bore, hub or keyway; its `bolt_circle` (mm) has `bolt_holes` holes of `bolt_diameter`, the first on +x.
    `web_thickness` b_s and `rim_thickness` s_R (below the root circle) are those of a blank that is no solid disc: only the
    rating knows them (C_R, Y_B), the solid is a full disc.
    Raises ParameterError, or GeometryError for a keyway that does not fit its bore, or is none of DIN 6885.
    """

    bore: Annotated[float, FEATURE, Words("bore")] = 0.0
    keyway: Annotated[bool, Words("keyway by the bore", "", "DIN 6885")] = False
    keyway_width: Annotated[float, FEATURE, Words("keyway width", "", "DIN 6885")] = 0.0
    keyway_depth: Annotated[float, FEATURE, Words("keyway depth from the bore", "t_2", "DIN 6885")] = 0.0
    hub_diameter: Annotated[float, FEATURE, Words("hub diameter")] = 0.0
    hub_length: Annotated[float, FEATURE, Words("hub length on each side")] = 0.0
    hub_side: Annotated[HubSide, Words("side of the hub")] = HubSide.FRONT
    rim_diameter: Annotated[float | None, Range("mm", 0, None, ends="(]"), Words("rim diameter (rings)")] = None
    bolt_circle: Annotated[float, FEATURE, Words("bolt circle diameter (rings)")] = 0.0
    bolt_holes: Annotated[int, Whole(1, 1000, may_vanish=True), Words("number of bolt holes (rings)")] = 0
    bolt_diameter: Annotated[float, FEATURE, Words("bolt hole diameter (rings)")] = 0.0
    end_chamfer: Annotated[float, FEATURE, Words("end chamfer, axial length")] = 0.0
    end_chamfer_angle: Annotated[float, Range("deg", 5, 85), Words("end chamfer, angle to the axis")] = 45.0
    tip_chamfer: Annotated[float, FEATURE, Words("tip chamfer, radial height", "h_K", "6.1")] = 0.0
    web_thickness: Annotated[float, FEATURE, Words("web of the blank, for the rating", "b_s", "ISO 6336-1")] = 0.0
    rim_thickness: Annotated[float, FEATURE, Words("rim of the blank, for the rating", "s_R", "ISO 6336-1")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        for name in (name for name, field in schema_of(Body).items() if field.permitted is FEATURE):
            if 0 < (value := getattr(self, name)) < LEAST_FEATURE:
                raise ParameterError(name, value, f"must be 0 or at least {LEAST_FEATURE} mm", "mm")
        self._derive_keyway()
        for pair in (("keyway_width", "keyway_depth"), ("hub_diameter", "hub_length"), ("web_thickness", "rim_thickness")):
            self._check_both(*pair)
        for pair in (("bolt_circle", "bolt_holes"), ("bolt_holes", "bolt_diameter"), ("bolt_diameter", "bolt_circle")):
            self._check_both(*pair)
        self._check_keyway()

    def _derive_keyway(self) -> None:
        """Width and depth by the bore, where `keyway` asks for them; 0 where it does no more."""
        sizes = ("keyway_width", "keyway_depth")
        for name in sizes:
            if self.keyway and is_given(value := getattr(self, name)) and value:
                permitted = "must be left out where keyway is true: it follows from the bore by DIN 6885"
                raise GeometryError(name, value, permitted, "mm")
        if self.keyway and not self.bore:
            raise GeometryError("keyway", True, "must be left out without a bore: it is a keyway by the bore (DIN 6885)")
        found = keyway_of(self.bore) if self.keyway else (0.0, 0.0)
        for name, value in zip(sizes, found, strict=True):
            if self.keyway or not is_given(getattr(self, name)):
                object.__setattr__(self, name, Derived(value))

    def _check_both(self, first: str, second: str) -> None:
        """Two sizes of one feature: neither stands alone."""
        for one, other in ((first, second), (second, first)):
            if getattr(self, one) and not getattr(self, other):
                unit = "" if other == "bolt_holes" else "mm"
                permitted = f"must be above 0{unit and f' {unit}'}, as {one} is given"
                raise GeometryError(other, getattr(self, other), permitted, unit)

    def _check_keyway(self) -> None:
        if self.keyway_width and self.keyway_width > 0.9 * self.bore:
            raise GeometryError(
                "keyway_width", self.keyway_width, f"must be at most {at_most(0.9 * self.bore)} mm (0.9 of the bore)", "mm"
            )

    @property
    def opening_diameter(self) -> float:
        """Diameter of the circle about the axis that clears bore and keyway (mm); 0 without a bore."""
        if not self.keyway_width:
            return self.bore
        return float(((self.bore + 2 * self.keyway_depth) ** 2 + self.keyway_width**2) ** 0.5)

    @property
    def hub_ends(self) -> tuple[float, float]:
        """How far the hub stands out below z = 0 and beyond z = face width (mm)."""
        back = self.hub_length if self.hub_side in (HubSide.BACK, HubSide.BOTH) else 0.0
        front = self.hub_length if self.hub_side in (HubSide.FRONT, HubSide.BOTH) else 0.0
        return back, front
