"""Flexible bodies: how much of each gear is flexible, what holds it, and substructures condensed to their cuts.

That makes a full ring as cheap as a few teeth.

The dofs of a cut are radial, tangential and, in solid bodies, axial, node by node, so the matrices of all sectors are the same
and need no turning.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad.core.errors import GeometryError, ParameterError, format_number, require_number, require_whole
from gearcad.core.records import Floats, PerGear, Role, naming
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.material import STEEL_MODULUS, Material
from gearcad.meshing.outline import held_radius
from gearcad.rating.tooth_stiffness import RIM_LIMIT


class Cuts(Enum):
    """Support of the outer cuts of a body that is not a full ring."""

    FIXED = "fixed"
    SLIDING = "sliding"
    FREE = "free"


@dataclass(frozen=True)
class Chain:
    """Sectors in a row, condensed: symmetric matrix on [cut behind, cut ahead, hub] (N/mm, N, N mm).

    The hub's dofs are its turn, or the forces with which it follows the body (see `support`), as the first sector sees them;
    `onward` turns them to what the sector after the last one sees. In the plane all of it is per mm of width.
    """

    matrix: Floats
    onward: Floats = field(default_factory=lambda: np.eye(1))

    @property
    def cut(self) -> int:
        """Dofs of one cut."""
        return (len(self.matrix) - len(self.onward)) // 2

    @cached_property
    def _double(self) -> Chain:
        return self.followed_by(self)

    def followed_by(self, other: Chain) -> Chain:
        """Return this chain and the other one ahead of it, the cut between them condensed."""
        n, hub = self.cut, len(self.onward)
        keep = 2 * n + hub  # behind, ahead, hub, and last the cut between
        both = np.zeros((keep + n, keep + n))
        first = np.r_[0:n, keep : keep + n, 2 * n : keep]
        second = np.r_[keep : keep + n, n : 2 * n, 2 * n : keep]
        both[np.ix_(first, first)] += self.matrix
        both[np.ix_(second, second)] += other.seen(self.onward)
        return Chain(condensed(both, keep), other.onward @ self.onward)

    def seen(self, turn: Floats) -> Floats:
        """Return the matrix on the hub's dofs from which `turn` makes those that the first sector sees."""
        hub = len(self.onward)
        matrix = self.matrix.copy()
        matrix[:, -hub:] = matrix[:, -hub:] @ turn
        matrix[-hub:] = turn.T @ matrix[-hub:]
        return matrix

    def repeated(self, times: int) -> Chain:
        """Return so many of this chain in a row, by doubling."""
        result, power = None, self
        while times:
            if times & 1:
                result = power if result is None else result.followed_by(power)
            times >>= 1
            power = power._double if times else power
        assert result is not None  # times is at least 1
        return result

    def ended(self, cuts: Cuts, radii: Floats, *, ahead: bool) -> Floats:
        """This chain, ahead of other sectors or behind them, its far cut held: matrix on [the cut to them, turn of the hub].

        `radii` (mm) are those of the nodes of a cut. The hub is one that turns with the bore.
        """
        n, components = self.cut, self.cut // len(radii)
        near, far = (np.arange(n), np.arange(n, 2 * n)) if ahead else (np.arange(n, 2 * n), np.arange(n))
        tangential = np.arange(n) % components == 1
        kept = far[~cut_held(cuts, n, components)]
        motions = np.zeros((2 * n + 1, n + 1 + len(kept)))
        motions[near, np.arange(n)] = 1
        motions[-1, n] = 1
        motions[kept, n + 1 + np.arange(len(kept))] = 1
        if cuts is not Cuts.FREE:
            motions[far[tangential], n] = radii
        return condensed(motions.T @ self.matrix @ motions, n + 1)


def polar_turn(angles: Floats, components: int) -> Any:
    """Return the matrix (scipy CSR) from radial and tangential dofs of nodes at `angles` (n,) in rad to those along x and y.

    Of three `components` the third, along the axis, stays. An angle of 0 leaves a node as it is.
    """
    import scipy.sparse

    cosine, sine = np.cos(angles), np.sin(angles)
    diagonal = np.stack([cosine, cosine, *(components - 2) * [np.ones(len(angles))]], -1).ravel()
    upper, lower = np.zeros(len(diagonal) - 1), np.zeros(len(diagonal) - 1)
    upper[::components], lower[::components] = -sine, sine
    return scipy.sparse.diags([diagonal, upper, lower], [0, 1, -1], format="csr")


def cut_held(cuts: Cuts, dofs: int, components: int) -> NDArray[np.bool_]:
    """Return which dofs (n,) of a cut are held."""
    if cuts is Cuts.SLIDING:
        tangential: NDArray[np.bool_] = np.arange(dofs) % components == 1
        return tangential
    return np.full(dofs, cuts is Cuts.FIXED)


def condensed(matrix: Floats, keep: int) -> Floats:
    """Return the symmetric matrix with the dofs from `keep` on free of load."""
    inner = np.linalg.solve(matrix[keep:, keep:], matrix[keep:, :keep])
    reduced: Floats = matrix[:keep, :keep] - matrix[:keep, keep:] @ inner
    return (reduced + reduced.T) / 2


_SAME = 1e-9
"""Difference of radii (mm) below which they count as equal."""

_THINNEST_SHAFT = 0.98
"""Greatest bore of a shaft, over its diameter."""


_FEWEST_BOLTS = 2


class Hold(Enum):
    """Support of the bore of a gear, or of the rim of a ring."""

    AUTO = "auto"
    """Automatic choice: rigid if the rim is thick; otherwise free, or by the key if there is a keyway."""

    RIGID = "rigid"
    """Held all round, as by a stiff shaft in a tight fit, or by a stiff housing."""

    SHAFT = "shaft"
    """Bonded to a shaft or hub ring that gives way, whose section the torque enters like St Venant's shear, as r."""

    KEY = "key"
    """Free bore whose torque comes from a keyway: stresses are those with the key at the worst place."""

    FREE = "free"
    """Free bore: shear all round, as from splines or a thin web, gives torque and force; nothing keeps the bore round."""

    BOLTS = "bolts"
    """Support of a ring: held from its bolt circle outwards where there are bolts, free between them."""


@dataclass(frozen=True)
class Support:
    """Support of the bore of a body of `teeth` sectors, or the rim of a ring (not AUTO).

    `shaft` is the shaft's material and `shaft_bore` (mm) its own bore; `key` the half width (rad) of the keyway, seen from the
    axis. Of a ring on `bolts` those have `bolt_circle` (mm), and the loaded tooth stands midway between two. A `straight` body
    is a rack's, held along its back.
    """

    hold: Hold = Hold.RIGID
    teeth: int = 1
    shaft: Material = field(default_factory=Material)
    shaft_bore: float = 0.0
    key: float = 0.0
    bolts: int = 0
    bolt_circle: float = 0.0
    straight: bool = False

    @property
    def floats(self) -> bool:
        """True if the hub follows the bore in the mean, and so is moved by forces as well as by the torque; else it turns."""
        return self.hold not in (Hold.RIGID, Hold.BOLTS)

    def holds(self, tooth: int) -> bool:
        """Return whether anything holds the sector of a tooth, counted from the loaded one."""
        return self.hold is not Hold.BOLTS or tooth % self.teeth in self._bolted

    @cached_property
    def _bolted(self) -> frozenset[int]:
        """Teeth, counted from the loaded one, in whose sectors bolts stand."""
        places = ((bolt + 0.5) * self.teeth / self.bolts for bolt in range(self.bolts))
        return frozenset(math.floor(place + 0.5) % self.teeth for place in places)

    @property
    def words(self) -> str:
        """Words on how the body is held, before "diameter ..." in a sentence; not by bolts."""
        return _WORDS[self.hold]

    def describe(self, held_radius: float) -> str:
        """Return in words how the body is held at a radius (mm)."""
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
    """Return s_R/h_t: the rim thickness from the root circle down to a radius (mm), or to the keyway if that is the bore, over
    the tooth depth.
    """
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
    """Return the support of a gear at `held_radius` (mm).

    Raises GeometryError for what is not there: a keyway, room for the shaft's bore, bolts.
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
        """Return the number of teeth of a gear between cuts; None for the full ring."""
        return self.teeth if self.teeth is not None and self.teeth < gear.tooth_count else None

    def inner_radii(self, pair: GearPair | RackPair) -> PerGear[float]:
        """Return the radii (mm) at which the bodies of pinion and wheel are held; infinite for a rack.

        Raises ParameterError and GeometryError.
        """
        if isinstance(pair, RackPair):
            return PerGear(self.of_pinion(pair.pinion)[0], math.inf)
        return PerGear.each(lambda role: _inner_radius(pair.gears.pick(role), self.inner_diameters.pick(role)))

    def supports(self, pair: GearPair | RackPair) -> PerGear[Support]:
        """Return the supports of the bodies of pinion and wheel at these radii. Raises ParameterError and GeometryError."""
        if isinstance(pair, RackPair):
            self._check_rack()
            return PerGear(self.of_pinion(pair.pinion)[1], Support(Hold.RIGID, pair.rack.whole_pitches, straight=True))
        radii = self.inner_radii(pair)
        pinion, wheel = (self._support(gear, radii.pick(role), role) for role, gear in pair.gears.items())
        return PerGear(pinion, wheel)

    def of_pinion(self, pinion: Gear) -> tuple[float, Support]:
        """Return the radius (mm) at which a pinion is held, and its support, whatever its mate. Raises as `supports` does."""
        radius = _inner_radius(pinion, self.inner_diameters.pinion)
        return radius, self._support(pinion, radius, Role.PINION)

    def _support(self, gear: Gear, radius: float, role: Role) -> Support:
        hold, ring = self.holds.pick(role), self.teeth_held(gear) is None
        key = f"check.{role.value}_support"
        if not ring and hold not in (Hold.AUTO, Hold.RIGID):
            raise ParameterError(key, hold.value, 'must be "rigid" where body_teeth is less than the full ring')
        if gear.internal:
            self._check_ring(hold, key)
        elif hold is Hold.BOLTS:
            raise ParameterError(key, hold.value, 'must be "rigid", "free", "key" or "shaft": bolts hold rings only')
        elif self.solid and hold in (Hold.SHAFT, Hold.KEY):
            raise ParameterError(key, hold.value, 'must be "rigid" or "free" for solid bodies')
        if hold is Hold.AUTO and (not ring or self.inner_diameters.pick(role) is not None):
            hold = Hold.RIGID  # a circle that is given is where the body is held
        with naming(role):
            found = support_of(gear, radius, hold, Material(youngs_modulus=self.shaft_modulus), self.shaft_bores.pick(role))
        return replace(found, hold=Hold.FREE) if self.solid and found.hold is Hold.KEY else found

    def _check_rack(self) -> None:
        if (hold := self.holds.wheel) not in (Hold.AUTO, Hold.RIGID):
            raise ParameterError("check.wheel_support", hold.value, 'must be "rigid" for a rack, which is held along its back')
        if (diameter := self.inner_diameters.wheel) is not None:
            permitted = "must be left out: a rack is held along its back, at rack.height"
            raise ParameterError("check.wheel_inner_diameter", diameter, permitted, "mm")

    def _check_ring(self, hold: Hold, key: str) -> None:
        if hold not in (Hold.AUTO, Hold.RIGID, Hold.BOLTS):
            raise ParameterError(key, hold.value, 'must be "rigid" or "bolts": a ring is held on its rim, it has no bore')
        if self.solid and hold is Hold.BOLTS:
            raise ParameterError(key, hold.value, 'must be "rigid" for the solid body of a ring: bolts hold sections only (2d)')

    def for_solids(self) -> BodyModel:
        """Return the same bodies as solids: of what can hold them, only "rigid" and "free"."""
        return replace(self, solid=True)

    def describe(self, pair: GearPair | RackPair) -> dict[str, str]:
        """Return the bodies of pinion and wheel in words, as documents have them."""
        radii, supports = self.inner_radii(pair), self.supports(pair)
        if isinstance(pair, RackPair):
            back = f"{format_number(round(pair.rack.height, 4))} mm below its reference line"
            pinion = self._words(pair.pinion, radii.pinion, supports.pinion)
            return {"pinion": pinion, "wheel": f"rack, a strip of teeth held along its back, {back}"}
        each = PerGear.each(lambda role: self._words(pair.gears.pick(role), radii.pick(role), supports.pick(role)))
        return each._asdict()

    def _words(self, gear: Gear, radius: float, support: Support) -> str:
        inner = support.describe(radius)
        if (held := self.teeth_held(gear)) is None:
            return f"full ring, {inner}"
        return f"{held} teeth with {self.cuts.value} cuts, {inner}"


def _inner_radius(gear: Gear, inner_diameter: float | None) -> float:
    """Return the radius at which the body is held (mm). Raises ParameterError and GeometryError."""
    if inner_diameter is not None:
        if gear.internal:
            raise GeometryError("inner_diameter", inner_diameter, "must be left out: a ring is held on body.rim_diameter", "mm")
        require_number("inner_diameter", inner_diameter, "mm", above=0)
        if inner_diameter / 2 > gear.root_diameter / 2 - 0.1 * gear.normal_module:
            most = gear.root_diameter - 0.2 * gear.normal_module
            raise GeometryError("inner_diameter", inner_diameter, f"must be at most {most:.6g} mm, below the root circle", "mm")
        return inner_diameter / 2
    return held_radius(gear)
