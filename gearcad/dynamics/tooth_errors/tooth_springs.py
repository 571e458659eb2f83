"""Pairs of teeth as springs along their way through the mesh, and the gaps between them before and behind it.

Transverse section; lengths in mm from T1 on the line of action, as the line of action has them. Of a ring roll lengths and base
radius are negative. Stiffness is in N/µm and gaps in µm up to the ToothSpring, which is in SI units. A gap is counted as a
transmission error is: the turn of the wheel that closes it while the pinion stays, times its base radius.

Places are in base pitches from the middle of the path of contact, and rise as teeth go through the mesh.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from gearcad.contact.shared.line_of_action import TransverseFlank, line_of_action
from gearcad.core.errors import ParameterError
from gearcad.core.records import Floats, PerGear, freeze
from gearcad.geometry import GearPair
from gearcad.geometry.involute import root_between
from gearcad.mesh_cycle import MeshCycle

_SAMPLES = 401
"""Places on a modified flank among which the nearest is sought: 0.04 mm apart on teeth of module 5, 0.01 µm of the gap."""

_ROUNDING = 1e-11
"""Gap (mm) below which there is none."""

_HALVINGS = 60
"""Steps of bisection, more than a double has room for."""


def _unmodified(lengths: Floats) -> Floats:
    return np.zeros_like(lengths)


class TurnedFlank(NamedTuple):
    """An involute about its axis: base radius, first and last roll length, and the modification `depth` at roll lengths."""

    base_radius: float
    first: float
    last: float
    depth: Callable[[Floats], Floats] = _unmodified


def _turned_gap(flanks: PerGear[TurnedFlank], whole: float, contact: Floats, length: Floats) -> tuple[Floats, Floats]:
    """Return the gap (mm) between points of the pinion's involute and the wheel's whole involute, and where they meet there.

    The latter is a roll length on the wheel's involute (mm). The points are at roll lengths of a flank that, were it long
    enough, would touch at `contact` on the line of action. Nan where a point lies inside the wheel's base circle.
    """
    own, other = flanks.pinion.base_radius, flanks.wheel.base_radius
    turn = (length - contact) / own
    along = length * np.cos(turn) - own * np.sin(turn)
    across = other + own - own * np.cos(turn) - length * np.sin(turn)
    square = (whole - along) ** 2 + across**2 - other**2
    facing = np.copysign(np.sqrt(np.where(square >= 0, square, np.nan)), other)
    # By how much the wheel's flank is turned from where it has its normal on the line of action.
    turned = np.arctan2(facing, other) - np.arctan2(whole - along, across)
    turned = np.mod(turned + np.pi, 2 * np.pi) - np.pi
    return facing - other * turned - (whole - contact), facing


def tooth_gaps(flanks: PerGear[TurnedFlank], whole: float, places: Floats) -> Floats:
    """Return the least gap (n,) in mm between flanks of two teeth that would touch at `places` (n,) from T1 (mm).

    Infinite where neither flank reaches over to the other. Where exact involutes touch it is 0.
    """
    pinion, wheel = flanks
    contact = places[:, None]
    lengths = np.broadcast_to(np.linspace(pinion.first, pinion.last, _SAMPLES), (len(places), _SAMPLES))
    # Exact flanks touch where both have their normals on the line of action; else at the ends of one of them.
    touching = np.clip(contact, pinion.first, pinion.last)
    ends = [_facing(flanks, whole, contact, end) for end in (wheel.first, wheel.last)]
    points = np.concatenate([lengths, touching, *ends], axis=1)
    apart, facing = _turned_gap(flanks, whole, contact, points)
    slack = 1e-9 * (wheel.last - wheel.first)
    reached = (facing >= wheel.first - slack) & (facing <= wheel.last + slack)
    on_wheel = np.clip(np.nan_to_num(facing, nan=wheel.first), wheel.first, wheel.last)
    taken_back = pinion.depth(points) + wheel.depth(on_wheel)
    gap = np.where(reached, apart + taken_back, np.inf).min(axis=1)
    return np.asarray(np.where(np.abs(gap) < _ROUNDING, 0.0, gap), float)


def _facing(flanks: PerGear[TurnedFlank], whole: float, contact: Floats, end: float) -> Floats:
    """Return roll lengths (n, 1) of the pinion's flank (mm) at the radius of an end of the wheel's flank.

    Where the pinion's flank has no such point, its own end is returned.
    """
    low, high = (np.full_like(contact, each) for each in flanks.pinion[1:3])
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        # Further up on the pinion's flank is further down on the wheel's; a point inside its base circle is lowest.
        beyond = np.nan_to_num(_turned_gap(flanks, whole, contact, middle)[1], nan=-np.inf) > end
        low, high = np.where(beyond, middle, low), np.where(beyond, high, middle)
    return np.asarray((low + high) / 2, float)


@dataclass(frozen=True, eq=False)
class PairErrors:
    """Errors of pair i of teeth, i modulo their number n, as metal that is missing from the flanks.

    `position` (n,) in m is the error in the middle of the path, and `slope` (n,) in m the change for each base pitch further.
    """

    position: Floats = field(default_factory=lambda: np.zeros(1))
    slope: Floats = field(default_factory=lambda: np.zeros(1))

    def __post_init__(self) -> None:
        freeze(self)

    def times(self, factor: float) -> PairErrors:
        """Return the same errors, `factor` times as large."""
        return PairErrors(factor * self.position, factor * self.slope)

    def at(self, tooth: Floats, place: Floats) -> Floats:
        """Return the errors (...) in m of pairs `tooth` (...) at places (...) in base pitches from the middle of the path."""
        which = np.mod(tooth, len(self.position)).astype(np.intp)
        return np.asarray(self.position[which] + self.slope[which] * place, float)

    @property
    def greatest(self) -> float:
        """Greatest error (m), missing or standing out, at places from -1 to 1."""
        return float((np.abs(self.position) + np.abs(self.slope)).max())


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothSpring:
    """A pair of teeth along its path: `stiffness` (n,) in N/m and `gap` (n,) in m at even places from `first` to `last`.

    Straight lines between these; beyond them teeth never meet. `lead` is the place of pair 0 at phase 0 of the mesh;
    `contact_ratio` is the length of the path of contact.
    """

    first: float
    last: float
    stiffness: Floats
    gap: Floats
    lead: float
    contact_ratio: float

    def __post_init__(self) -> None:
        freeze(self)
        if self.stiffness.shape != self.gap.shape or len(self.gap) < 2 or self.last <= self.first:
            raise ParameterError("stiffness", f"{self.stiffness.shape}", f"must be as many as gaps, {self.gap.shape}")
        if not np.isfinite(self.gap).all() or not np.isfinite(self.stiffness).all() or self.stiffness.min() < 0:
            raise ParameterError("stiffness", "not finite", "must be finite numbers of at least 0")

    @property
    def places(self) -> Floats:
        """Places (n,) of both tables, in base pitches."""
        return np.linspace(self.first, self.last, len(self.gap))

    @property
    def pairs(self) -> int:
        """Greatest number of pairs that can be on their path at once."""
        return math.floor(self.last - self.first) + 1

    @property
    def backwards(self) -> ToothSpring:
        """The same spring for teeth that go through the mesh in the opposite direction."""
        return ToothSpring(
            first=-self.last,
            last=-self.first,
            stiffness=self.stiffness[::-1].copy(),
            gap=self.gap[::-1].copy(),
            lead=-self.lead,
            contact_ratio=self.contact_ratio,
        )

    def engaged(self, turns: Floats, errors: PairErrors) -> tuple[Floats, Floats]:
        """Return stiffness (t, p) in N/m and gaps with errors (t, p) in m of the pairs after `turns` (t,) tooth periods.

        A pair that is not on its path has a stiffness of 0 and an infinite gap.
        """
        nearest = np.ceil(turns + self.lead - self.last)
        tooth = nearest[:, None] + np.arange(float(self.pairs))
        place = (turns + self.lead)[:, None] - tooth
        inside = (place >= self.first) & (place <= self.last)
        stiffness = np.where(inside, np.interp(place, self.places, self.stiffness), 0.0)
        gap = np.interp(place, self.places, self.gap) + errors.at(tooth, place)
        return stiffness, np.where(inside, gap, np.inf)


class AtRest(NamedTuple):
    """A mesh at rest after some tooth periods (t,): `approach` (t,) in m, `forces` (t, p) in N of the pairs side by side.

    `stiffness` (N/m) is the mean over the periods of the sum of all pairs that carry.
    """

    approach: Floats
    forces: Floats
    stiffness: float

    @property
    def contact_ratio(self) -> float:
        """Mean number of pairs that carry."""
        return float((self.forces > 0).sum(axis=1).mean())


def at_rest(spring: ToothSpring, force: float, turns: Floats, errors: PairErrors | None = None) -> AtRest:
    """Return the mesh at rest where all pairs together carry a force (N): sum K max(y - gap, 0) = F, which has one root.

    The pairs touch in the order of their gaps; for a known number of pairs the root is that of a straight line.
    """
    stiffness, gap = spring.engaged(np.asarray(turns, float), errors or PairErrors())
    order = np.argsort(gap, axis=1)
    k, g = (np.take_along_axis(each, order, 1) for each in (stiffness, gap))
    closed = np.where(k > 0, k * np.where(np.isfinite(g), g, 0.0), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        each = (force + np.cumsum(closed, axis=1)) / np.cumsum(k, axis=1)
    following = np.concatenate([g[:, 1:], np.full((len(g), 1), np.inf)], axis=1)
    # The first so many pairs whose approach does not reach the next gap.
    which = np.argmax((each <= following) & np.isfinite(each), axis=1)
    approach = np.take_along_axis(each, which[:, None], 1)[:, 0]
    pressed = np.maximum(approach[:, None] - gap, 0.0)
    forces = np.asarray(stiffness * pressed, float)
    return AtRest(approach, forces, float(np.where(forces > 0, stiffness, 0.0).sum(axis=1).mean()))


PRESSURE_ANGLE = 20.0
"""Pressure angle (deg) of teeth for which a train has only base radii and numbers of teeth."""

_STEPS = 256
"""Number of places per base pitch."""

_FARTHEST = 0.6
"""Base pitches before and behind the path of contact at which a gap is looked for: teeth that bend so far have been lost."""

_LEAST_RADIUS = 0.1
"""Radius of curvature (modules) that the flanks of assumed teeth keep at the ends of their path."""

_FAIR = 0.02
"""Share of the load from which on the stiffness of a pair can be read from a mesh cycle."""


@dataclass(frozen=True)
class ToothPath:
    """Path of a pair of teeth (mm): flanks, T1T2 (`whole`) and base pitch, first and last contact, and the pitch point."""

    flanks: PerGear[TurnedFlank]
    whole: float
    pitch: float
    first: float
    last: float
    pitch_point: float

    @property
    def contact_ratio(self) -> float:
        return (self.last - self.first) / self.pitch

    @property
    def middle(self) -> float:
        """Middle of the path (mm from T1)."""
        return (self.first + self.last) / 2

    def gaps(self, places: Floats) -> Floats:
        """Return the gaps (n,) in µm at places (n,) in base pitches from the middle."""
        return 1000 * tooth_gaps(self.flanks, self.whole, self.middle + self.pitch * places)

    def reach(self, depth: float) -> Floats:
        """Return even places (n,), in base pitches from the middle, at which the teeth are at most `depth` (µm) apart.

        There is one more at each end, if flanks face each other there. The ends of the path are among the places.
        """
        even = _even(self.contact_ratio)
        step, half = even[1] - even[0], self.contact_ratio / 2
        beyond = step * np.arange(1, math.ceil(_FARTHEST / step) + 1)
        ends = []
        for side in (-1, 1):
            gap = self.gaps(side * (half + beyond))
            met = len(beyond) if (gap <= depth).all() else int(np.argmin(gap <= depth)) + 1
            ends.append(beyond[:met][np.isfinite(gap[:met])])
        return np.concatenate([-half - ends[0][::-1], even, half + ends[1]])


def standard_path(base_radii: PerGear[float], teeth: int, contact_ratio: float) -> ToothPath | None:
    """Return the path of teeth of 20 degrees that run at their reference circles; None where there is no path so long.

    Equal addenda on both gears give the contact ratio. The base radius (mm) of a ring is negative. Where tips would reach
    beyond the base circle of the mate, the path is moved and keeps its length.
    """
    one, other = base_radii
    tangent = math.tan(math.radians(PRESSURE_ANGLE))
    whole, pitch, middle = (one + other) * tangent, 2 * math.pi * one / teeth, one * tangent
    least = _LEAST_RADIUS * 2 * one / math.cos(math.radians(PRESSURE_ANGLE)) / teeth
    length = contact_ratio * pitch
    first = _first(base_radii, whole, length)
    last_possible = math.inf if other < 0 else whole - least
    first = max(min(first, last_possible - length), least)
    last = first + length
    if last > last_possible:
        return None
    flanks = PerGear(TurnedFlank(one, first, last), TurnedFlank(other, whole - last, whole - first))
    return ToothPath(flanks, whole, pitch, first, last, middle)


def _first(base_radii: PerGear[float], whole: float, length: float) -> float:
    """Return the start (mm from T1) of a path of a given `length` (mm) whose ends lie on the tips.

    Both gears have the same addendum over their reference circles.
    """
    one, other = base_radii
    stretch = 1 / math.cos(math.radians(PRESSURE_ANGLE))

    def excess(first: float) -> float:
        pinion, wheel = math.hypot(one, first + length), math.hypot(other, whole - first)
        return (pinion - one * stretch) - math.copysign(1.0, other) * (wheel - abs(other) * stretch)

    middle = one * math.tan(math.radians(PRESSURE_ANGLE))
    return root_between(excess, middle - length, middle)


def pair_path(pair: GearPair) -> ToothPath:
    """Return the path of a pair as mounted, with the flanks in the middle of the common face width.

    The path of helical teeth is the whole way of their line of contact.
    """
    line = line_of_action(pair)
    first, last = pair.usable_path
    lean = pair.common_width.width * math.tan(math.radians(abs(pair.pinion.base_helix_angle))) / 2
    flanks = line.flanks.map(_turned_flank)
    return ToothPath(flanks, line.whole, line.pitch, first - lean, last + lean, pair.path_of_contact.C)


def _turned_flank(flank: TransverseFlank) -> TurnedFlank:
    return TurnedFlank(flank.base_radius, flank.first, flank.last, flank.depth)


# ---------------------------------------------------------------------- springs


def even_spring(path: ToothPath | None, contact_ratio: float, mean: float, depth: float, lead: float) -> ToothSpring:
    """Return the spring of pairs that are equally stiff all along the path, for a `mean` mesh stiffness (N/µm).

    Gaps reach up to a `depth` (µm). Without a path pairs meet only between its ends, which are a contact ratio apart.
    """
    places = _even(contact_ratio) if path is None else path.reach(depth)
    gaps = np.zeros(len(places)) if path is None else path.gaps(places)
    return _spring(places, np.full(len(places), mean / contact_ratio), gaps, lead, contact_ratio)


def cycle_spring(path: ToothPath, cycle: MeshCycle, depth: float, *, helical: bool) -> ToothSpring:
    """Return the spring with the tangent pair stiffness of a mesh cycle; beyond the path the stiffness is that at its ends.

    Helical teeth come into mesh and leave it gradually: beyond their path nothing carries, and their stiffness at its ends is
    0. A cycle of which only the mean is known gives the same stiffness everywhere.
    """
    lead = (path.pitch_point - path.middle) / path.pitch
    places = _even(path.contact_ratio) if helical else path.reach(depth)
    gaps = np.zeros(len(places)) if helical else path.gaps(places)
    if cycle.mean_only:
        stiffness = np.full(len(places), cycle.tangent_mean / path.contact_ratio)
    else:
        stiffness = np.interp(places, *_pair_stiffness(path, cycle, helical=helical))
    return _spring(places, stiffness, gaps, lead, path.contact_ratio)


def _even(contact_ratio: float) -> Floats:
    """Return even places (n,) along the path in base pitches from its middle, both ends among them."""
    return np.linspace(-contact_ratio / 2, contact_ratio / 2, math.ceil(contact_ratio * _STEPS) + 1)


def _spring(places: Floats, stiffness: Floats, gaps: Floats, lead: float, contact_ratio: float) -> ToothSpring:
    return ToothSpring(
        first=float(places[0]),
        last=float(places[-1]),
        stiffness=1e6 * stiffness,
        gap=1e-6 * gaps,
        lead=lead,
        contact_ratio=contact_ratio,
    )


def _pair_stiffness(path: ToothPath, cycle: MeshCycle, *, helical: bool) -> tuple[Floats, Floats]:
    """Return places (n,) in base pitches from the middle of the path, and the tangent stiffness (n,) of a pair there, in N/µm.

    Each pair carries its share of the load by the approach less its own gap.
    """
    roll = np.radians(cycle.roll_angle) * abs(path.flanks.pinion.base_radius) / path.pitch
    lead = (path.pitch_point - path.middle) / path.pitch
    place = roll[:, None] + lead + np.array(cycle.pairs)
    approach = np.broadcast_to(cycle.transmission_error[:, None], place.shape)
    modified = not np.allclose(cycle.transmission_error * cycle.mesh_stiffness, cycle.force, rtol=1e-6)
    if modified and not helical:
        approach = approach - path.gaps(place.ravel()).reshape(place.shape)
    half = path.contact_ratio / 2
    told = (np.abs(place) <= half) & (cycle.load_share > (0.0 if helical else _FAIR)) & (approach > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        secant = cycle.load_share * cycle.force / approach
    tangent = secant * (cycle.tangent_stiffness / cycle.mesh_stiffness)[:, None]
    order = np.argsort(place[told], kind="stable")
    return place[told][order], tangent[told][order]
