"""Gears under load, whatever the model: contacts, root stresses, positions over a base pitch, and the extremes between them.

Over the mesh a root stress or a pressure is smooth from one event to the next, and its greatest is most often one: where a
pair of teeth comes in or leaves, the curve has a kink; where a contact comes away from the edge of a flank, its pressure
begins with a jump. So what can stand between two positions follows from the curve on both sides of them.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from operator import attrgetter, itemgetter
from typing import Any, Generic, Self, TypeAlias, TypeVar

import numpy as np

from gearcad.contact.shared.line_of_action import LineOfAction
from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, JsonObject, PerGear, Role
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.involute import involute_at_roll
from gearcad.rating.contact_stress import half_width, reduced_radius

TOOTH_ORDER = PerGear(1, -1)
"""Seen from the wheel the teeth follow each other the other way round; a ring's too, as rings are seen mirrored."""


def roll_lengths(radii: Floats, base_radius: float) -> Floats:
    """Return the roll lengths (mm) of an involute at radii (n,) in mm: from the base tangent point,
    0 inside the base circle.
    """
    result: Floats = np.sqrt(np.maximum((radii - base_radius) * (radii + base_radius), 0))
    return result


class BodyFlank(ABC):
    """The flank of tooth 0 of a gear or a rack that loads press on; places on it (mm) rise from root to tip."""

    @property
    @abstractmethod
    def lever(self) -> float:
        """Work of a normal force (1 N) as the hub turns by 1 rad, or a rack moves by 1 mm: r_b (mm), cos alpha_t of a rack."""

    @property
    @abstractmethod
    def upward(self) -> int:
        """Direction of the tip: 1 where it lies outwards, -1 where it lies inwards, as on a ring."""

    @abstractmethod
    def radii(self, lengths: Floats) -> Floats:
        """Return the radii (mm) of places; of a rack the heights over its reference line."""


@dataclass(frozen=True)
class LoadedFlank(BodyFlank):
    """The exact flank of tooth 0 that loads press on, that with y > 0; places on it are roll lengths (mm).

    Those of a ring are negative, and rise from root to tip as others do: so the formulas of all flanks are the same.
    """

    gear: Gear

    @property
    def base_radius(self) -> float:
        """Base radius r_b (mm); positive for a ring too."""
        return self.gear.profile.base_diameter / 2

    @property
    def lever(self) -> float:
        return self.base_radius

    @property
    def upward(self) -> int:
        """Direction of the tip: 1 where it lies outwards, -1 where it lies inwards, as on a ring."""
        return -1 if self.gear.internal else 1

    def roll_lengths(self, radii: Floats) -> Floats:
        """Return the roll lengths (mm) at radii (n,) in mm."""
        return self.upward * roll_lengths(radii, self.base_radius)

    def radii(self, lengths: Floats) -> Floats:
        return np.hypot(self.base_radius, lengths)

    def polar(self, lengths: Floats) -> tuple[Floats, Floats]:
        """Return the radii (mm) and angles (rad) of places in the transverse section."""
        roll = lengths / self.base_radius
        angle: Floats = math.radians(self.gear.profile.base_half_angle) - involute_at_roll(roll)
        return np.hypot(self.base_radius, lengths), angle

    def heading(self, lengths: Floats) -> Floats:
        """Return the angles (rad) of the tangents of the base circle that places lie on, to the middle of the tooth."""
        return math.radians(self.gear.profile.base_half_angle) - np.asarray(lengths) / self.base_radius


class FlankCompliance(ABC):
    """A gear body's responses to unit loads normal to its flank: what every model tells of a body."""

    flank: BodyFlank
    torques: Floats
    """Torques on the hub by each unit load; of a rack the forces along its back."""

    @property
    @abstractmethod
    def neighbours(self) -> int:
        """Teeth on each side of the loaded one whose responses are known."""

    @property
    @abstractmethod
    def hub_radius(self) -> float:
        """Radius at which the body is held (mm)."""

    @property
    @abstractmethod
    def nodes(self) -> int:
        """Number of nodes in the mesh of one tooth sector."""

    @property
    def unit_loads(self) -> int:
        """Places of the flank that were loaded."""
        return len(self.torques)

    @property
    @abstractmethod
    def mesh_document(self) -> JsonObject:
        """Size and quality of the mesh of one tooth sector, as documents have it."""


@dataclass(frozen=True)
class EngagedPair:
    """A pair in rotation, or a pinion and a rack: place of contact at a roll angle, and force of a torque."""

    pair: GearPair | RackPair

    @property
    def gear_pair(self) -> GearPair:
        """The pair of gears. Raises TypeError for a pinion and a rack."""
        if isinstance(self.pair, RackPair):
            raise TypeError("a pinion and a rack are no pair of gears")
        return self.pair

    @property
    def repeats(self) -> bool:
        """True if one base pitch is like the next: no tooth differs from the others."""
        return True

    @property
    def width(self) -> float:
        """Common face width (mm), on which all of the load is."""
        return width_in_mesh(self.pair)

    @property
    def base_radius(self) -> float:
        """Base radius r_b of the pinion (mm)."""
        return self.pair.pinion.base_diameter / 2

    def force(self, torque: float) -> float:
        """Return the normal force in the transverse section (N per mm of common width) at a torque on the pinion (N·m)."""
        return abs(torque) * 1000 / self.base_radius / self.width

    def require_narrow_contact(self, torque: float, modulus: float) -> None:
        """Raise ParameterError where the contact at the pitch point would be wider than teeth are deep: no small deformation.

        `modulus` is E* (MPa); half width by Hertz.
        """
        radius, depth = _at_pitch_point(self.pair)
        half = float(half_width(self.force(torque), radius, modulus))
        if half > depth:
            most = abs(torque) * (depth / half) ** 2  # the half width goes with the root of the load
            permitted = f"must be at most {most:.4g} N·m in size for these teeth and this modulus of elasticity"
            why = f"the contact would be {2 * half:.4g} mm wide on teeth {depth:.4g} mm deep"
            raise ParameterError("torque", torque, f"{permitted}: {why}", "N·m")

    def roll_length(self, roll_angle: float) -> float:
        """Return the place (mm from T1) where the middle pair touches in the middle of the common width.

        The pinion is at a roll angle (deg).
        """
        return self.pair.path_of_contact.C + math.radians(roll_angle) * self.base_radius

    def roll_angle(self, length: Floats) -> Floats:
        """Return the roll angles (deg) of the pinion at which the middle pair touches at places (n,) in mm from T1."""
        result: Floats = np.degrees((length - self.pair.path_of_contact.C) / self.base_radius)
        return result

    def roll_angles(self, count: int) -> Floats:
        """Return the roll angles (deg) over one base pitch, as many before the pitch point as after it.

        Those that fewer positions have in common with more are the same to the last digit.
        """
        pitch = 360 / self.pair.pinion.teeth
        return (2 * np.arange(count) + 1 - count) / (2 * count) * pitch


def width_in_mesh(pair: GearPair | RackPair) -> float:
    """Return the common face width (mm)."""
    return pair.common_width if isinstance(pair, RackPair) else pair.common_width.width


def _at_pitch_point(pair: GearPair | RackPair) -> tuple[float, float]:
    """Return the reduced radius of curvature at the pitch point, and the least depth of the teeth (mm)."""
    at = pair.path_of_contact.C
    if isinstance(pair, RackPair):
        return at, min((pair.pinion.tip_diameter - pair.pinion.root_diameter) / 2, pair.rack.tip_height + pair.rack.root_depth)
    radius = reduced_radius((at, pair.base_tangent.length - at))
    return radius, min((gear.tip_diameter - gear.root_diameter) / 2 for gear in pair.gears)


Body = TypeVar("Body", bound=FlankCompliance, covariant=True)


@dataclass(frozen=True)
class FlexiblePair(EngagedPair, ABC, Generic[Body]):
    """A pair whose bodies are factorised and solved for loads on their flanks; any position and torque is quick."""

    line: LineOfAction
    bodies: PerGear[Body]

    @property
    def pinion(self) -> Body:
        """The pinion's body."""
        return self.bodies.pinion

    @property
    def wheel(self) -> Body:
        """The wheel's body."""
        return self.bodies.wheel

    @abstractmethod
    def with_flanks(self, pair: Any) -> Self:
        """Return the same bodies with other modifications of an otherwise equal pair - gears, or pinion and rack - as it is
        mounted.
        """

    @property
    @abstractmethod
    def modulus(self) -> float:
        """Reduced modulus of the contact (MPa)."""

    @abstractmethod
    def single_stiffness(self, torque: float) -> float:
        """Return the greatest stiffness (N/(mm·µm)) of one pair of teeth alone, over its path of contact, at a torque (N·m)."""


P = TypeVar("P")
PositionKind = TypeVar("PositionKind", contravariant=True)

_TOLERANCE = 0.0005
"""Part of a value that is told as its error at the least: well within 0.2 %, as the bound is an estimate."""

_STATIONARY = 1e-5
"""Part of a value to which a search goes on: so far below what is told as its error that no comparison of nearly equal numbers
on the way shows in a figure.
"""

_LEAST_GAP = 1e-5
"""Distance of two positions, in base pitches, below which nothing is sought between them."""

_UP, _BEND, _MOST_UP = 1.25, 4.0, 10.0
"""Factor by which a curve can rise more steeply than in the interval beside: more where it has bent already, and at the
most.
"""

_BEYOND = 1.5
"""Factor by which a curve can fall to the higher position more steeply than beyond it."""

_LEAST_CUT = 0.25
"""Least part of an interval that a new position cuts off."""

_FEWEST = 4
"""Number of positions below which nothing can be concluded between them."""

_MOST = 20
"""Positions that are added for one quantity."""


@dataclass(frozen=True)
class ExtremeQuantity(Generic[PositionKind]):
    """Quantity that is to be greatest, or `least`: `value` gives it at a position, NaN where it has none there.

    `swing` measures tolerance and error by how far the quantity goes up and down, not by its size.
    """

    name: str
    value: Callable[[PositionKind], float]
    least: bool = False
    swing: bool = False

    @property
    def sign(self) -> int:
        """Sign of the quantity: 1, or -1 for a quantity whose least value is sought."""
        return -1 if self.least else 1


@dataclass(frozen=True)
class Extreme:
    """The greatest (or least) value, its roll angle (deg), and the part of it (or of its swing) by which it may be exceeded.

    The `error` is what the search tolerates at the least, and infinite where nothing is known of what stands beside it.
    """

    value: float
    roll_angle: float
    error: float


@dataclass(frozen=True)
class RollRange:
    """The roll angles (deg) over which a mesh is looked at: a `pitch`, after which it `repeats` itself or not."""

    pitch: float
    repeats: bool = True


def add_positions(
    known: Iterable[tuple[float, P]], span: RollRange, solve: Callable[[float], P], quantities: Sequence[ExtremeQuantity[P]]
) -> list[P]:
    """Solve further positions at roll angles (deg) between those that are known, and return them."""
    pool, added = sorted(known, key=itemgetter(0)), []
    for quantity in quantities:
        for _ in range(_MOST):
            place = _Sampled.from_positions(pool, span, quantity).doubtful
            if place is None:
                break
            added.append(solve(place))
            pool = sorted([*pool, (place, added[-1])], key=itemgetter(0))
    return added


def extreme(known: Iterable[tuple[float, P]], span: RollRange, quantity: ExtremeQuantity[P]) -> Extreme | None:
    """Return the greatest (or least) value of all positions; None where the quantity has no value at any."""
    course = _Sampled.from_positions(sorted(known, key=itemgetter(0)), span, quantity)
    if course.nothing:
        return None
    at = int(np.nanargmax(course.values))
    value = float(course.values[at])
    above = max(float(course.roofs[0].max(initial=value)) - value, 0.0)
    if math.isfinite(above):
        # Where a curve flickers, lines through neighbours tell nothing; how close the greatest few come does.
        above = min(above, value - float(np.sort(course.values[~np.isnan(course.values)])[-_FEWEST:].min()))
    error = 0.0 if not above else above / course.scale if course.scale else math.inf
    return Extreme(quantity.sign * value, float(course.angles[at]), max(error, _TOLERANCE))


@dataclass(frozen=True)
class _Sampled:
    """Values (n,) of a quantity, to be greatest, at rising angles (n,) in deg."""

    angles: Floats
    values: Floats
    span: RollRange
    swing: bool

    @classmethod
    def from_positions(cls, pool: Sequence[tuple[float, P]], span: RollRange, quantity: ExtremeQuantity[P]) -> _Sampled:
        """Return the values of a quantity at known positions, which are in the order of their angles."""
        angles, positions = zip(*pool, strict=True)
        values = quantity.sign * np.array([quantity.value(each) for each in positions], float)
        return cls(np.array(angles), values, span, quantity.swing)

    @property
    def nothing(self) -> bool:
        """True if there is no value at any position."""
        return bool(np.isnan(self.values).all())

    @property
    def scale(self) -> float:
        """Size by which an error is measured: the swing of the values, or the size of the greatest."""
        least, most = np.nanmin(self.values), np.nanmax(self.values)
        return float(most - least if self.swing else abs(most))

    @property
    def doubtful(self) -> float | None:
        """The angle (deg) at which most can be missed; None where the value is stationary."""
        roofs, places = self.roofs
        if self.nothing or not len(roofs):
            return None
        at = int(np.argmax(roofs))
        return float(places[at]) if roofs[at] > np.nanmax(self.values) + _STATIONARY * self.scale else None

    @cached_property
    def roofs(self) -> tuple[Floats, Floats]:
        """The most that can stand between each position and the next, and where (deg)."""
        x, f = self._around
        wide = np.diff(x)
        slopes = np.diff(f) / wide
        found = [
            _roof(f[i], f[i + 1], slopes[i - 1] * wide[i], slopes[i + 1] * wide[i])
            if wide[i] > _LEAST_GAP * self.span.pitch
            else (float(np.nanmax([f[i], f[i + 1], -math.inf])), 0.5)
            for i in range(1, len(wide) - 1)
        ]
        roofs, parts = np.array(found).reshape(-1, 2).T
        if len(self.angles) < _FEWEST:
            roofs = np.full_like(roofs, math.inf)
        return roofs, x[1:-2] + parts * wide[1:-1]

    @property
    def _around(self) -> tuple[Floats, Floats]:
        """Angles and values with what stands beside them: the next pitch, or the continuation where there is none."""
        count = len(self.angles)
        if self.span.repeats:
            around = np.arange(-1, count + 2)
            return self.angles[around % count] + around // count * self.span.pitch, self.values[around % count]
        if count < 2:
            return np.arange(3.0), np.full(3, self.values[0])  # no interval
        return tuple(np.r_[2 * each[0] - each[1], each, 2 * each[-1] - each[-2]] for each in (self.angles, self.values))


def _roof(first: float, second: float, before: float, after: float) -> tuple[float, float]:
    """Return the most that can stand between two values, and at which part of the way, from the slopes `before` and `after`
    (per interval). Infinite where only one of them is known, and nothing beside it.
    """
    if math.isnan(first) and math.isnan(second):
        return -math.inf, 0.5
    if math.isnan(second) or first > second:
        most, part = _roof(second, first, -after, -before)
        return most, 1 - part
    if math.isnan(after):
        # Values end with the second; if the first is all there is beside it, nothing can be told.
        beyond = first + before
        return (math.inf if math.isnan(beyond) else max(second, beyond)), 0.5
    if after >= 0:
        return second, 0.5
    # Two lines, of which the lower one holds, meet at the kink; steeper ones are above it.
    reached = first + before > second
    part = min(max((second - first - after) / (before - after), _LEAST_CUT), 1 - _LEAST_CUT) if reached else 0.5
    up, down = before, _BEYOND * after
    if before > 0:
        up *= min(_UP + _BEND * abs((second - first) / before - 1), _MOST_UP)
    if not first + up > second:
        # What leads up to the first does not lead to the second: a jump, anywhere between.
        return second - down, part
    return first + up * (second - first - down) / (up - down), part


INTERIOR = 3.0
"""Half widths from the edges of both flanks beyond which a contact is that of two cylinders."""

FAIR = 0.1
"""Share of the load below which a contact is coming in or leaving, and its pressure is not that of the load."""

LEAST_TANGENT_ANGLE = 12.0
"""Tangent angle (deg) from which on a fillet counts as the root: above, a contact near the start of the flank presses on it.

It is negative where undercut draws the tooth in.
"""


@dataclass(frozen=True)
class RootStress:
    """The greatest stress of a fillet (MPa), its radius (mm), and its angle to the middle of the tooth (deg).

    ISO 6336-3 looks where that angle is 30.
    """

    stress: float
    radius: float
    tangent_angle: float


class PairContact(ABC):
    """One pair of teeth in contact: what it carries, and how far its pressure is that of two cylinders."""

    force: float
    """Normal force: N, per mm of width in the plane."""

    share: float
    """Share of the load that all pairs carry."""

    start_pressures: PerGear[float]
    """The greatest (MPa) at the starts of each gear's linear reliefs, NaN where none is told."""

    @property
    @abstractmethod
    def tooth(self) -> int:
        """Tooth of the pinion, 0 is the middle one."""

    @property
    @abstractmethod
    def place(self) -> float:
        """Place on the line of action (mm from T1) where the pair touches in the middle of the common face width."""

    @property
    @abstractmethod
    def edge(self) -> bool:
        """True if the edge of a tip touches."""

    @property
    @abstractmethod
    def arms(self) -> PerGear[float]:
        """Lever arms of the force on both gears, over their base radii: other than 1 where the edge of a gear's tip touches."""

    @property
    @abstractmethod
    def lever_arms(self) -> PerGear[float]:
        """Lever arms of the force and its friction together, over the base radii."""

    @property
    @abstractmethod
    def interior_pressure(self) -> float | None:
        """Greatest pressure (MPa) away from all edges of both flanks; None if all of the contact is near them."""


C = TypeVar("C", bound=PairContact, covariant=True)


@dataclass(frozen=True)
class LoadedPosition(ABC, Generic[C]):
    """One position of engaged gears under load: approach and each gear's part of it along the line of action (mm).

    `rigid_approach` (mm) is what of the approach needs no load: until teeth touch whose flanks are modified or out of place.
    `force` is the normal force in the transverse section (N per mm of common face width), `torques` (N·m) act on the hubs.
    `tension` and `compression` are the greatest of the roots, `bore_tension` (MPa) that of a bore that nothing keeps round.
    `support_approach` (mm) is the part of the approach by which the supports of the gears give way under load, `support_turn`
    (mm) that of their twist up to the middles of the faces. `lost_torque` (N·m) is the power that friction takes over the
    angular speed of the pinion.
    """

    roll_angle: float
    approach: float
    approach_parts: PerGear[float]
    rigid_approach: float
    force: float
    contacts: tuple[C, ...]
    tension: PerGear[RootStress]
    compression: PerGear[RootStress]
    bore_tension: PerGear[float | None]
    torques: PerGear[float]
    support_approach: float = field(default=0.0, kw_only=True)
    support_turn: float = field(default=0.0, kw_only=True)
    lost_torque: float = field(default=0.0, kw_only=True)

    @property
    def torque_ratios(self) -> PerGear[float]:
        """Torque on each gear over that of the force at its base radius: the wheel's is other than 1 where edges of tips touch.

        There the teeth do not turn the wheel evenly, and the ratio of torques is that of the speeds. Friction takes its part.
        """
        turning = PerGear.each(lambda role: sum(contact.force * contact.lever_arms.pick(role) for contact in self.contacts))
        return PerGear(1.0, turning.wheel / turning.pinion)

    @property
    def stiffness(self) -> float:
        """Stiffness (N/(mm·µm)) of teeth and bodies: normal force over the approach under load, per mm of common face width."""
        return self.force / ((self.approach - self.rigid_approach - self.support_approach) * 1000)

    @property
    def transmission_error(self) -> float:
        """Transmission error (µm) along the line of action: the lag of the wheel, between the middles of the faces."""
        return (self.approach - self.support_turn) * 1000

    @property
    @abstractmethod
    def interior_contacts(self) -> tuple[C, ...]:
        """Contacts away from the edges of the flanks that carry a fair share."""

    @property
    def contact_pressure(self) -> float:
        """Greatest pressure (MPa) of the interior contacts; NaN if there are none."""
        pressures = (contact.interior_pressure for contact in self.interior_contacts)
        return max((pressure for pressure in pressures if pressure is not None), default=math.nan)


M = TypeVar("M", bound=FlexiblePair[FlankCompliance], covariant=True)
Position = TypeVar("Position", bound=LoadedPosition[Any], covariant=True)


@dataclass(frozen=True)
class LoadedCycle(ABC, Generic[M, Position, C]):
    """Positions evenly over one base pitch at one torque (N·m on the pinion), and those `between` them at extremes."""

    model: M
    torque: float
    positions: tuple[Position, ...] = ()
    between: tuple[Position, ...] = ()

    @classmethod
    def run(
        cls,
        model: M,  # type: ignore[misc]  # a class method does not go through an instance
        torque: float,
        count: int,
        progress: Callable[[int, int], None] = lambda _done, _all: None,
    ) -> Self:
        """Solve `count` positions over one base pitch. Raises SolverError."""
        cycle, positions = cls(model, torque), []
        for done, angle in enumerate(model.roll_angles(count).tolist()):
            progress(done, count)
            positions.append(cycle.solve(angle))
        return replace(cycle, positions=tuple(positions))

    @abstractmethod
    def solve(self, angle: float) -> Position:
        """Return the position at a roll angle (deg). Raises SolverError."""

    @abstractmethod
    def contacts_at(self, angle: float) -> tuple[C, ...]:
        """Return the contacts alone at a roll angle (deg). Raises SolverError."""

    @property
    def every(self) -> tuple[Position, ...]:
        """All positions in the order of the roll angles."""
        return tuple(sorted((*self.positions, *self.between), key=attrgetter("roll_angle")))

    # ------------------------------------------------------------------ contacts and roots

    @property
    def contacts(self) -> Iterator[tuple[Position, C]]:
        """Contacts of all positions."""
        return ((position, contact) for position in self.every for contact in position.contacts)

    @property
    def interior_contacts(self) -> Iterator[tuple[Position, C]]:
        """Contacts away from the edges of the flanks that carry a fair share, each after its position."""
        return ((position, contact) for position in self.every for contact in position.interior_contacts)

    @property
    def worst_contact(self) -> tuple[Position, C] | None:
        """The contact of the greatest pressure away from the edges of the flanks; None if all are near them."""
        return max(self.interior_contacts, key=lambda found: found[1].interior_pressure or 0.0, default=None)

    @property
    def heaviest_contact(self) -> tuple[Position, C]:
        """The contact of the greatest load, wherever it is."""
        return max(self.contacts, key=lambda found: found[1].force)

    @property
    def pitch_point_contact(self) -> C | None:
        """The contact of the pair that touches at the pitch point in the middle of the face; None if it does not touch."""
        return next((contact for contact in self.contacts_at(0.0) if contact.tooth == 0), None)

    @property
    def edge_positions(self) -> int:
        """Even positions at which the edge of a tip touches."""
        return sum(any(contact.edge for contact in position.contacts) for position in self.positions)

    def tip_positions(self, role: Role) -> int:
        """Return the number of even positions at which the edge of a gear's tip touches beyond the path of contact."""
        return sum(any(each.edge and each.arms.pick(role) != 1 for each in position.contacts) for position in self.positions)

    def worst_position(self, role: Role) -> Position:
        """Return the position of the greatest root tension of a gear."""
        return max(((position.tension.pick(role).stress, position) for position in self.every), key=itemgetter(0))[1]

    # ------------------------------------------------------------------ courses over the base pitch

    def values(self, name: str) -> Floats:
        """Return a quantity at the even positions, such as "stiffness"."""
        return np.array([getattr(position, name) for position in self.positions])

    def course(self, name: str) -> Floats:
        """Return a quantity at all positions, such as "roll_angle", in the order of the roll angles."""
        return np.array([getattr(position, name) for position in self.every])

    def mean(self, name: str) -> tuple[Floats, Floats]:
        """Return the mean of a quantity over the base pitch, by a curve through all positions, and how far straight lines are
        off.
        """
        from scipy.interpolate import PchipInterpolator

        if not self.model.repeats:  # nothing joins the last position to the first
            even = self.values(name).mean(axis=0)
            return even, np.zeros_like(even)
        angles, values, pitch = self.course("roll_angle"), self.course(name), self._span.pitch
        beside = np.r_[angles[-3:] - pitch, angles, angles[:3] + pitch]
        curve = PchipInterpolator(beside, np.r_[values[-3:], values, values[:3]])
        mean = curve.integrate(-pitch / 2, pitch / 2) / pitch
        lines = np.diff(angles, append=angles[0] + pitch) @ (values + np.roll(values, -1, axis=0)) / 2 / pitch
        return mean, np.abs(lines - mean)

    def searched(self, quantities: Sequence[ExtremeQuantity[Position]]) -> Self:
        """Return the cycle with positions between the even ones, so that the quantities' greatest values are found."""
        return replace(self, between=(*self.between, *add_positions(self._known, self._span, self.solve, quantities)))

    def extreme(self, quantity: ExtremeQuantity[Position]) -> Extreme | None:
        """Return the greatest value of all positions, and what may be missed of it; None where there is none."""
        return extreme(self._known, self._span, quantity)

    @property
    def _known(self) -> list[tuple[float, Position]]:
        return [(position.roll_angle, position) for position in self.every]

    @property
    def _span(self) -> RollRange:
        return RollRange(360 / self.model.pair.pinion.teeth, self.model.repeats)


Cycle: TypeAlias = LoadedCycle[FlexiblePair[FlankCompliance], LoadedPosition[PairContact], PairContact]
"""A mesh cycle of either model, plane or solid."""
