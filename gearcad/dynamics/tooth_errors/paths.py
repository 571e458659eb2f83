"""The way of a pair of teeth through the mesh as a ToothSpring: of a GearPair, or of teeth of which a train tells little.

Lengths in mm from T1 on the line of action; stiffness in N/µm, gaps in µm up to the ToothSpring, which is in SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.line_of_action import TransverseFlank, line_of_action
from gearcad.dynamics.tooth_errors.gaps import TurnedFlank, tooth_gaps
from gearcad.dynamics.tooth_errors.springs import ToothSpring
from gearcad.geometry import GearPair
from gearcad.geometry.bracketed import root_between
from gearcad.mesh_cycle import MeshCycle
from gearcad.per_gear import PerGear

__all__ = ["PRESSURE_ANGLE", "ToothPath", "cycle_spring", "even_spring", "pair_path", "standard_path"]

PRESSURE_ANGLE = 20.0
"""Of teeth of which a train tells only base radii and numbers (deg)."""

_STEPS = 256
"""Places on a base pitch."""

_FARTHEST = 0.6
"""Base pitches before and behind the path of contact at which a gap is looked for: teeth that bend so far have been lost."""

_LEAST_RADIUS = 0.1
"""Radius of curvature (modules) that the flanks of assumed teeth keep at the ends of their path."""

_FAIR = 0.02
"""Share of the load from which on the stiffness of a pair can be read from a mesh cycle."""


@dataclass(frozen=True)
class ToothPath:
    """Where a pair of teeth is on its way: flanks, T1T2 and base pitch, first and last contact, and the pitch point."""

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
        """Of the path, from T1."""
        return (self.first + self.last) / 2

    def gaps(self, places: Floats) -> Floats:
        """In µm at places in base pitches from the middle."""
        return 1000 * tooth_gaps(self.flanks, self.whole, self.middle + self.pitch * places)

    def reach(self, depth: float) -> Floats:
        """Even places (n,) in base pitches from the middle, at which the teeth are no farther apart than `depth` (µm), and one
        more at each end, if flanks face each other there; the ends of the path are among them."""
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
    """Of teeth of 20 degrees that run at their reference circles; addenda, alike on both gears, give the contact ratio.

    The base radius of a ring is negative. Where tips would reach beyond the base circle of the mate, the path is moved, and as
    long. None where there is no path so long.
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
    """Where a path of a length begins (mm from T1) whose ends lie on tips that stand alike over the reference circles."""
    one, other = base_radii
    stretch = 1 / math.cos(math.radians(PRESSURE_ANGLE))

    def excess(first: float) -> float:
        pinion, wheel = math.hypot(one, first + length), math.hypot(other, whole - first)
        return (pinion - one * stretch) - math.copysign(1.0, other) * (wheel - abs(other) * stretch)

    middle = one * math.tan(math.radians(PRESSURE_ANGLE))
    return root_between(excess, middle - length, middle)


def pair_path(pair: GearPair) -> ToothPath:
    """Of a pair as mounted, its flanks in the middle of the common face width; of helical teeth the whole way of their line."""
    line = line_of_action(pair)
    first, last = pair.usable_path
    lean = pair.common_width.width * math.tan(math.radians(abs(pair.pinion.base_helix_angle))) / 2
    flanks = line.flanks.map(_turned)
    return ToothPath(flanks, line.whole, line.pitch, first - lean, last + lean, pair.path_of_contact.C)


def _turned(flank: TransverseFlank) -> TurnedFlank:
    return TurnedFlank(flank.base_radius, flank.first, flank.last, flank.depth)


# ---------------------------------------------------------------------- springs


def even_spring(path: ToothPath | None, contact_ratio: float, mean: float, depth: float, lead: float) -> ToothSpring:
    """Pairs that are equally stiff all along the path, of a `mean` mesh stiffness (N/µm); gaps reach up to a `depth` (µm).

    Without a path they meet only between its ends, a contact ratio apart.
    """
    places = _even(contact_ratio) if path is None else path.reach(depth)
    gaps = np.zeros(len(places)) if path is None else path.gaps(places)
    return _spring(places, np.full(len(places), mean / contact_ratio), gaps, lead, contact_ratio)


def cycle_spring(path: ToothPath, cycle: MeshCycle, depth: float, *, helical: bool) -> ToothSpring:
    """The pair stiffness that a mesh cycle tells, tangent, at the ends of the path what it is there.

    Helical teeth come and go by and by: before and behind their way nothing carries, and their stiffness at its ends is none.
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
    """Places (n,) along the path, both ends among them."""
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
    """Places (n,) in base pitches from the middle of the path, and the tangent stiffness (n,) of a pair there, in N/µm.

    Each pair carries its share of the load by what the approach leaves of its own gap.
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
