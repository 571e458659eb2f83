"""How much of each gear is flexible, and where and how it is held."""

from __future__ import annotations

from dataclasses import dataclass, replace

from gearcad.contact.shared.chain import Cuts
from gearcad.contact.shared.holding import Hold, Support, support_of
from gearcad.errors import GeometryError, ParameterError, require_number, require_whole
from gearcad.geometry import Gear, GearPair
from gearcad.material import STEEL_MODULUS, Material
from gearcad.meshing.section.held import held_radius
from gearcad.per_gear import PerGear, Role, naming

__all__ = ["BodyModel"]


_OWN_BORES: PerGear[float | None] = PerGear(None, None)
_AUTO = PerGear(Hold.AUTO, Hold.AUTO)
_NO_BORES = PerGear(0.0, 0.0)


@dataclass(frozen=True, kw_only=True)
class BodyModel:
    """The part of each gear that is flexible: all teeth, or `teeth` of them (odd) between cuts; held on a circle.

    `inner_diameters` (mm) None stands for the bore, or 4 m_n below the root circle where there is none; `holds` is how they are
    held there, with a shaft of `shaft_modulus` (MPa) and `shaft_bores` (mm, 0 for solid ones). `solid` bodies know no shaft and
    no key. Raises ParameterError.
    """

    teeth: int | None = None
    cuts: Cuts = Cuts.FIXED
    inner_diameters: PerGear[float | None] = _OWN_BORES
    holds: PerGear[Hold] = _AUTO
    shaft_modulus: float = STEEL_MODULUS
    shaft_bores: PerGear[float] = _NO_BORES
    solid: bool = False

    def __post_init__(self) -> None:
        if self.teeth is None:
            return
        require_whole("teeth", self.teeth, at_least=3, at_most=999)
        if self.teeth % 2 == 0:
            raise ParameterError("teeth", self.teeth, "must be odd: the loaded tooth stands in the middle")

    def teeth_held(self, gear: Gear) -> int | None:
        """How many teeth of a gear stand between cuts; None for the full ring."""
        return self.teeth if self.teeth is not None and self.teeth < gear.tooth_count else None

    def inner_radii(self, pair: GearPair) -> PerGear[float]:
        """Where the bodies of pinion and wheel are held (mm). Raises ParameterError and GeometryError."""
        return PerGear.each(lambda role: _inner_radius(pair.gears.pick(role), self.inner_diameters.pick(role)))

    def supports(self, pair: GearPair) -> PerGear[Support]:
        """What holds the bodies of pinion and wheel there. Raises ParameterError and GeometryError."""
        radii = self.inner_radii(pair)
        pinion, wheel = (self._support(gear, radii.pick(role), role) for role, gear in pair.gears.items())
        return PerGear(pinion, wheel)

    def _support(self, gear: Gear, radius: float, role: Role) -> Support:
        hold, ring = self.holds.pick(role), self.teeth_held(gear) is None
        key = f"check.{role.value}_support"
        if not ring and hold not in (Hold.AUTO, Hold.RIGID):
            raise ParameterError(key, hold.value, 'must be "rigid" where body_teeth is less than the full ring')
        if gear.internal:
            self._check_ring(hold, key)
        elif hold is Hold.BOLTS:
            raise ParameterError(key, hold.value, "must be another: bolts hold rings")
        elif self.solid and hold in (Hold.SHAFT, Hold.KEY):
            raise ParameterError(key, hold.value, 'must be "rigid" or "free" for solid bodies')
        if hold is Hold.AUTO and (not ring or self.inner_diameters.pick(role) is not None):
            hold = Hold.RIGID  # a circle that is given is where the body is held
        with naming(role):
            found = support_of(gear, radius, hold, Material(youngs_modulus=self.shaft_modulus), self.shaft_bores.pick(role))
        return replace(found, hold=Hold.FREE) if self.solid and found.hold is Hold.KEY else found

    def _check_ring(self, hold: Hold, key: str) -> None:
        if hold not in (Hold.AUTO, Hold.RIGID, Hold.BOLTS):
            raise ParameterError(key, hold.value, 'must be "rigid" or "bolts": a ring is held on its rim, it has no bore')
        if self.solid and hold is Hold.BOLTS:
            raise ParameterError(key, hold.value, 'must be "rigid" for the solid body of a ring: bolts hold sections only (2d)')

    def for_solids(self) -> BodyModel:
        """The same bodies as solids: of what can hold them, only "rigid" and "free"."""
        return replace(self, solid=True)

    def describe(self, pair: GearPair) -> dict[str, str]:
        """The bodies of pinion and wheel in words, as documents have them."""
        radii, supports = self.inner_radii(pair), self.supports(pair)
        each = PerGear.each(lambda role: self._words(pair.gears.pick(role), radii.pick(role), supports.pick(role)))
        return each._asdict()

    def _words(self, gear: Gear, radius: float, support: Support) -> str:
        inner = support.describe(radius)
        if (held := self.teeth_held(gear)) is None:
            return f"full ring, {inner}"
        return f"{held} teeth with {self.cuts.value} cuts, {inner}"


def _inner_radius(gear: Gear, inner_diameter: float | None) -> float:
    """Where the body is held (mm)."""
    if inner_diameter is not None:
        if gear.internal:
            raise GeometryError("inner_diameter", inner_diameter, "must be left out: a ring is held on body.rim_diameter", "mm")
        require_number("inner_diameter", inner_diameter, "mm", above=0)
        if inner_diameter / 2 > gear.root_diameter / 2 - 0.1 * gear.normal_module:
            most = gear.root_diameter - 0.2 * gear.normal_module
            raise GeometryError("inner_diameter", inner_diameter, f"must be at most {most:.6g} mm, below the root circle", "mm")
        return inner_diameter / 2
    return held_radius(gear)
