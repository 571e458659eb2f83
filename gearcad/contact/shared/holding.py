"""What holds the bore of a gear body: a rigid hub, a shaft that gives way, a key, nothing but shear; or the rim of a ring."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property

from gearcad.errors import GeometryError, format_number
from gearcad.geometry import Gear
from gearcad.material import Material
from gearcad.rating.rim import RIM_LIMIT

__all__ = ["Hold", "Support", "rim_ratio", "support_of"]


_SAME = 1e-9
"""mm: radii that do not differ."""

_THINNEST_SHAFT = 0.98
"""Greatest bore of a shaft, over its diameter."""


_FEWEST_BOLTS = 2


class Hold(Enum):
    """What holds the bore of a gear, or the rim of a ring."""

    AUTO = "auto"
    """Rigid where the rim is thick; else free, or by the key if there is a keyway."""

    RIGID = "rigid"
    """Held all round, as by a stiff shaft in a tight fit, or by a stiff housing."""

    SHAFT = "shaft"
    """Bonded to a shaft or hub ring that gives way, whose section the torque enters like St Venant's shear, as r."""

    KEY = "key"
    """Free, but the torque comes from a keyway: stresses are those with the key where it is worst."""

    FREE = "free"
    """Shear all round, as from splines or a thin web, gives torque and force; nothing keeps the bore round."""

    BOLTS = "bolts"
    """Of a ring: held from its bolt circle outwards where there are bolts, free between them."""


@dataclass(frozen=True)
class Support:
    """What holds the bore of a body of `teeth` sectors, or the rim of a ring (not AUTO).

    `shaft` is the shaft's material and `shaft_bore` (mm) its own bore; `key` the half width (rad) of the keyway, seen from the
    axis. Of a ring on `bolts` those have `bolt_circle` (mm), and the loaded tooth stands midway between two.
    """

    hold: Hold = Hold.RIGID
    teeth: int = 1
    shaft: Material = field(default_factory=Material)
    shaft_bore: float = 0.0
    key: float = 0.0
    bolts: int = 0
    bolt_circle: float = 0.0

    @property
    def floats(self) -> bool:
        """True if the hub follows the bore in the mean, and so is moved by forces as well as by the torque; else it turns."""
        return self.hold not in (Hold.RIGID, Hold.BOLTS)

    def holds(self, tooth: int) -> bool:
        """Whether anything holds the sector of a tooth, counted from the loaded one."""
        return self.hold is not Hold.BOLTS or tooth % self.teeth in self._bolted

    @cached_property
    def _bolted(self) -> frozenset[int]:
        """Teeth, counted from the loaded one, in whose sectors bolts stand."""
        places = ((bolt + 0.5) * self.teeth / self.bolts for bolt in range(self.bolts))
        return frozenset(math.floor(place + 0.5) % self.teeth for place in places)

    @property
    def words(self) -> str:
        """How the body is held, before "diameter ..." in a sentence; not by bolts."""
        return _WORDS[self.hold]

    def describe(self, held_radius: float) -> str:
        """How the body is held at a radius (mm)."""
        if self.hold is Hold.BOLTS:
            circle = f"diameter {format_number(round(self.bolt_circle, 4))} mm"
            return f"held by {self.bolts} bolts on {circle}, the loaded tooth midway between two"
        return f"{self.words} diameter {format_number(round(held_radius * 2, 4))} mm"

    @property
    def bends(self) -> bool:
        """True if nothing keeps the bore round, so that the whole rim is stressed, not only near the loaded teeth."""
        return self.hold in (Hold.KEY, Hold.FREE)


_WORDS = {
    Hold.RIGID: "held on",
    Hold.SHAFT: "bonded to an elastic shaft on",
    Hold.KEY: "free, but for shear and a key, on",
    Hold.FREE: "free, but for shear, on",
}


def rim_ratio(gear: Gear, held_radius: float) -> float:
    """s_R/h_t: the rim from the root circle down to a radius (mm), or to the keyway if that is the bore, over tooth depth."""
    if gear.internal:
        profile = gear.profile
        return (held_radius - profile.root_diameter / 2) / ((profile.root_diameter - profile.tip_diameter) / 2)
    opening = gear.body.opening_diameter / 2 if abs(held_radius - gear.body.bore / 2) < _SAME else held_radius
    return (gear.root_diameter / 2 - opening) / ((gear.tip_diameter - gear.root_diameter) / 2)


def _support_of_ring(ring: Gear, hold: Hold) -> Support:
    if hold is not Hold.BOLTS:
        return Support(Hold.RIGID, ring.tooth_count)
    if not ring.body.bolt_holes:
        raise GeometryError("body.bolt_circle", 0.0, "must be given where bolts hold the ring", "mm")
    if ring.body.bolt_holes < _FEWEST_BOLTS:
        permitted = f"must be at least {_FEWEST_BOLTS} where bolts hold the ring"
        raise GeometryError("body.bolt_holes", ring.body.bolt_holes, permitted)
    return Support(hold, ring.tooth_count, bolts=ring.body.bolt_holes, bolt_circle=ring.body.bolt_circle)


def support_of(
    gear: Gear, held_radius: float, hold: Hold = Hold.AUTO, shaft: Material | None = None, shaft_bore: float = 0.0
) -> Support:
    """What holds a gear at `held_radius` (mm). Raises GeometryError for what is not there: a keyway, room for the
    shaft's bore, bolts.
    """
    if gear.internal:
        return _support_of_ring(gear, hold)
    if hold is Hold.AUTO:
        thin = Hold.KEY if gear.body.keyway_width else Hold.FREE
        hold = Hold.RIGID if rim_ratio(gear, held_radius) >= RIM_LIMIT else thin
    if hold is Hold.KEY and not gear.body.keyway_width:
        raise GeometryError("body.keyway_width", 0.0, "must be given where the key holds the bore", "mm")
    if hold is Hold.SHAFT and shaft_bore > _THINNEST_SHAFT * 2 * held_radius:
        most = format_number(_THINNEST_SHAFT * 2 * held_radius)
        raise GeometryError("shaft_bore", shaft_bore, f"must be at most {most} mm ({_THINNEST_SHAFT} of the gear's bore)", "mm")
    key = math.asin(min(1.0, gear.body.keyway_width / 2 / held_radius))
    return Support(hold, gear.teeth, shaft or Material(), shaft_bore, key)
