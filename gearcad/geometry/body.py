"""Body: what surrounds the teeth - bore, keyway, hub, chamfers."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from gearcad.errors import GeometryError, ParameterError, as_choice, plain_numbers, require_number
from gearcad.geometry.limits import at_most
from gearcad.reprs import concise

__all__ = ["Body", "HubSide"]

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

    `keyway_depth` is measured from the bore outwards (t2 of DIN 6885), the keyway lies on +x, under tooth 0.
    `hub_length` is how far the hub stands out on each `hub_side`. `rim_diameter` is the outside of an internal gear.
    `end_chamfer` is the axial length of the cone turned on both ends of the tip cylinder, `end_chamfer_angle` the angle
    between that cone and the gear axis, so that the radial depth is end_chamfer * tan(end_chamfer_angle).
    `tip_chamfer` is the radial height of the 45-degree chamfer along both tip edges of each tooth (transverse section).
    `web_thickness` b_s and `rim_thickness` s_R (below the root circle) are those of a blank that is no solid disc: only the
    rating knows them (C_R, Y_B), the solid is a full disc.
    Raises ParameterError, or GeometryError for a keyway that does not fit its bore.
    """

    bore: float = 0.0
    keyway_width: float = 0.0
    keyway_depth: float = 0.0
    hub_diameter: float = 0.0
    hub_length: float = 0.0
    hub_side: HubSide = HubSide.FRONT
    rim_diameter: float | None = None
    end_chamfer: float = 0.0
    end_chamfer_angle: float = 45.0
    tip_chamfer: float = 0.0
    web_thickness: float = 0.0
    rim_thickness: float = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        plain_numbers(self)
        holes = ("bore", "keyway_width", "keyway_depth", "hub_diameter", "hub_length")
        for name in (*holes, "end_chamfer", "tip_chamfer", "web_thickness", "rim_thickness"):
            value = getattr(self, name)
            require_number(name, value, "mm", at_least=0)
            if 0 < value < LEAST_FEATURE:
                raise ParameterError(name, value, f"must be 0 or at least {LEAST_FEATURE} mm", "mm")
        object.__setattr__(self, "hub_side", as_choice("hub_side", self.hub_side, HubSide))
        if self.rim_diameter is not None:
            require_number("rim_diameter", self.rim_diameter, "mm", above=0)
        require_number("end_chamfer_angle", self.end_chamfer_angle, "deg", at_least=5, at_most=85)
        for pair in (("keyway_width", "keyway_depth"), ("hub_diameter", "hub_length"), ("web_thickness", "rim_thickness")):
            self._check_both(*pair)
        self._check_keyway()

    def _check_both(self, first: str, second: str) -> None:
        """Two sizes of one feature: neither stands alone."""
        for one, other in ((first, second), (second, first)):
            if getattr(self, one) and not getattr(self, other):
                raise GeometryError(other, getattr(self, other), f"must be above 0 mm, as {one} is given", "mm")

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
