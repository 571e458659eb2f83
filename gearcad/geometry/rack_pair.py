"""RackPair: a pinion and a rack in mesh (ISO 21771, the wheel's diameter infinite).

A rack is a gear of infinite diameter: its pitch line rolls on the pinion's reference circle at any distance, and the pressure
angle in mesh is that of the rack.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.

As with gears (see `interference`) the classical comparison of lines is not enough: an edge that leaves the flank in time may
still cut the fillet further down.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core import symbols
from gearcad.core.errors import GeometryError, ParameterError, at_least, at_most, require_name
from gearcad.core.quantities import NOT_GIVEN, Range, Words, derive, require_fields, symbols_of
from gearcad.core.records import Floats, JsonObject, Notice, PerGear, concise
from gearcad.geometry.fits import settled
from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_data import twist
from gearcad.geometry.gear_pictures import RackPose
from gearcad.geometry.involute import tangent_length
from gearcad.geometry.mating import ROUNDING, ROUNDING_OVERLAP, check_common, check_hand
from gearcad.geometry.path_of_contact import MatedPair, PathOfContact, sliding_document
from gearcad.geometry.profile import ToothProfile
from gearcad.geometry.rack import Rack, RackProfile, rack_pair_html

_DISTANCE = Range("mm", 0, None, ends="(]")


class OfPinionAndRack(NamedTuple):
    """Length (mm) that a pinion and a rack each have."""

    pinion: float
    rack: float


@dataclass(frozen=True, kw_only=True)
class RackPairData(MatedPair):
    """The fields of a `RackPair`, unchecked, and what needs no path of contact. Lengths in mm, angles in degrees."""

    pinion: Gear
    rack: Rack
    mounting_distance: Annotated[float, _DISTANCE, Words("mounting distance to reference line", "H")] = NOT_GIVEN
    name: Annotated[str, Words("name")] = "pair"

    @property
    def pitch_radius(self) -> float:
        """Reference radius r of the pinion, on which the rack's pitch line rolls."""
        return self.pinion.reference_diameter / 2

    @property
    def pitch_line_height(self) -> float:
        """Height (mm) of the pitch line on the rack above its reference line: H - r."""
        return self.mounting_distance - self.pitch_radius

    @property
    def back_distance(self) -> float:
        """Distance (mm) from the pinion's axis to the rack's back."""
        return self.mounting_distance + self.rack.height

    @property
    def common_width(self) -> float:
        """Width over which they face each other, their middles in one plane."""
        return min(self.pinion.face_width, self.rack.face_width)

    @property
    def _width_of_one_hand(self) -> float:
        return self.common_width

    @property
    def _base_pitch(self) -> float:
        return self.pinion.transverse_base_pitch

    @property
    def shifted_distance(self) -> float:
        """r + x m_n: the mounting distance at which the thinning alone gives the backlash."""
        return self.pitch_radius + self.pinion.profile_shift * self.pinion.normal_module

    @property
    def zero_backlash_distance(self) -> float:
        """The mounting distance without backlash: r + x m_n - (A_s1 + A_s2)/(2 tan alpha_n)."""
        thinning = self.pinion.tooth_thinning + self.rack.tooth_thinning
        return self.shifted_distance - thinning / 2 / math.tan(math.radians(self.pinion.rack.pressure_angle))

    @property
    def tip_alteration(self) -> float:
        """k of the pinion that keeps the rack's tip clearance: (H - r)/m_n - x, never positive ("auto" in a spec)."""
        return min(self.pitch_line_height / self.pinion.normal_module - self.pinion.profile_shift, 0.0)

    @property
    def tip_clearances(self) -> OfPinionAndRack:
        """Clearance of each one's tip in the other's root."""
        return OfPinionAndRack(
            self.mounting_distance + self.rack.root_depth - self.pinion.tip_diameter / 2,
            self.mounting_distance - self.rack.tip_height - self.pinion.root_diameter / 2,
        )

    @property
    def circumferential_backlash(self) -> float:
        """Circumferential backlash j_wt along the pitch line: 2 tan alpha_t (H - r - x m_n) and both thinnings (transverse)."""
        tangent = math.tan(math.radians(self.pinion.transverse_pressure_angle))
        return settled(2 * tangent * (self.mounting_distance - self.zero_backlash_distance), self.mounting_distance)

    @property
    def normal_backlash(self) -> float:
        """Normal backlash j_bn along the base normal: j_wt cos alpha_t cos beta_b."""
        across = math.cos(math.radians(self.pinion.transverse_pressure_angle))
        return self.circumferential_backlash * across * math.cos(math.radians(self.pinion.base_helix_angle))

    # ------------------------------------------------------------------ motion

    @property
    def travel_per_revolution(self) -> float:
        """Travel of the rack in one revolution of the pinion: pi d."""
        return math.pi * self.pinion.reference_diameter

    @property
    def travel_per_degree(self) -> float:
        """Travel (mm) of the rack per degree of the pinion."""
        return self.travel_per_revolution / 360

    def rack_force(self, torque: float) -> float:
        """Return the force (N) on the rack along its length for a torque on the pinion (N·m), without losses: 2000 T/d."""
        return 2000 * torque / self.pinion.reference_diameter

    def torque_for(self, force: float) -> float:
        """Return the torque on the pinion (N·m) for a force along the rack (N), without losses."""
        return force * self.pinion.reference_diameter / 2000

    def rack_speed(self, speed: float) -> float:
        """Return the speed of the rack (m/s), which is that of the pitch line, for a speed of the pinion (rpm)."""
        return self.travel_per_revolution * speed / 60_000


def check_rack_inputs(pair: RackPairData) -> None:
    """Raise ParameterError for an input that is not permitted by itself."""
    if not isinstance(pair.pinion, Gear):
        raise ParameterError("pinion", pair.pinion, "must be a Gear")
    if not isinstance(pair.rack, Rack):
        raise ParameterError("rack", pair.rack, "must be a Rack")
    require_fields(pair)
    require_name("name", pair.name)


def check_rack_mates(pair: RackPairData) -> None:
    """Raise GeometryError unless the pinion is external, and module, pressure angle and helix angle fit together."""
    pinion, rack = pair.pinion, pair.rack
    if pinion.internal:
        raise GeometryError("pinion.teeth", pinion.teeth, "must be above 0: no rack meshes with a ring")
    if pinion.double_helix.present:
        permitted = "must be left out: a rack has one helix"
        raise GeometryError("pinion.double_helix.gap_width", pinion.double_helix.gap_width, permitted, "mm")
    check_common("rack", pinion, rack)
    check_hand("rack", rack, -pinion.helix_angle, "opposite to the pinion")


def check_rack_mesh(pair: RackPairData) -> None:
    """Raise GeometryError if flanks overlap, tips touch roots, or no path of contact is left between the tips."""
    backlash, m = pair.circumferential_backlash, pair.pinion.normal_module
    if backlash < -ROUNDING_OVERLAP * m:
        least = at_least(pair.zero_backlash_distance, digits=9)
        shift = at_most(pair.pinion.profile_shift + (pair.mounting_distance - pair.zero_backlash_distance) / m)
        permitted = (
            f"must be at least {least} mm, or pinion.profile_shift at most {shift}: the backlash would be {backlash:.6f} mm"
        )
        raise GeometryError("mounting_distance", pair.mounting_distance, permitted, "mm")
    clearances = pair.tip_clearances
    if clearances.pinion <= 0:
        tip = pair.pinion.tip_diameter
        permitted = f"must be below {at_most(tip + 2 * clearances.pinion)} mm: the tip reaches the rack's root"
        raise GeometryError("pinion.tip_diameter", tip, permitted, "mm")
    if clearances.rack <= 0:
        most = at_most(pair.rack.tip_alteration + clearances.rack / m)
        permitted = f"must be below {most}: the tip reaches the pinion's root circle"
        raise GeometryError("rack.tip_alteration", pair.rack.tip_alteration, permitted)
    if pair.mounting_distance >= (farthest := _farthest(pair)):
        permitted = f"must be below {at_most(farthest)} mm, where the tips reach each other's flanks"
        raise GeometryError("mounting_distance", pair.mounting_distance, permitted, "mm")


def _farthest(pair: RackPairData) -> float:
    """Return the mounting distance at which the path of contact vanishes: the rack's tip form line through the path's last
    point.
    """
    pinion, sine = pair.pinion, math.sin(math.radians(pair.pinion.transverse_pressure_angle))
    last = tangent_length(pinion.tip_form_diameter, pinion.base_diameter)
    return pair.pitch_radius * (1 - sine**2) + last * sine + pair.rack.tip_form_height


_STEPS = 513
_FINE = 65


class EdgeCut(NamedTuple):
    """Depth (mm) of an edge's cut along pitch line or circle, below 0 if it stays clear, and the place where it is deepest."""

    depth: float
    place: float


class RackPlace(NamedTuple):
    """Position of a rack to its pinion while their flanks touch (mm).

    `distance` of the reference line from the axis, and how far along the pitch line the middles of two teeth in contact are
    apart there: half of both transverse thicknesses.
    """

    distance: float
    touching: float


def cut_by_rack(pinion: ToothProfile, rack: RackProfile, place: RackPlace) -> EdgeCut:
    """Return the deepest cut (mm) by the tip edges of a rack into the pinion's fillet while flanks touch.

    The cut's `place` is a diameter (mm) of the pinion.
    """
    working, reach = pinion.reference_diameter / 2, pinion.form_diameter / 2

    def clearance(height: float, half: float) -> tuple[float, Callable[[Floats], tuple[Floats, Floats]]]:
        distance = place.distance - height
        farthest = math.sqrt(max(reach**2 - distance**2, 0.0))

        def clear(t: Floats) -> tuple[Floats, Floats]:
            # The edge is t beyond the line of centres; the pinion has then rolled by (t + half - place.touching)/r.
            at = np.clip(np.hypot(distance, t), pinion.root_diameter / 2, reach)
            turned = (t + half - place.touching) / working
            return at, (np.arctan2(t, distance) - turned - np.radians(pinion.half_angle(at))) * at

        return farthest, clear

    cuts = []
    for height, half in _rack_edges(rack):
        farthest, clear = clearance(height, half)
        if farthest > 0:
            at, depth = _deepest(clear, farthest)
            cuts.append(EdgeCut(depth, 2 * at))
    return max(cuts, default=EdgeCut(0.0, 0.0))


def cut_by_pinion(pinion: ToothProfile, rack: RackProfile, place: RackPlace) -> EdgeCut:
    """Return the deepest cut (mm) by the tip edges of the pinion into the rack's fillet.

    The cut's `place` is a height (mm) over the reference line.
    """
    working = pinion.reference_diameter / 2
    edges = {(pinion.tip_form_diameter / 2, math.radians(pinion.half_angle(pinion.tip_form_diameter / 2)))}
    edges.add((pinion.tip_diameter / 2, float(pinion.curves[-1].polar(0.0)[1])))
    cuts = []
    for radius, angle in sorted(edges):
        cosine = (place.distance + rack.form_depth) / radius
        if cosine >= 1:
            continue

        def clear(t: Floats, radius: float = radius, angle: float = angle) -> tuple[Floats, Floats]:
            # The edge is at the angle t, so the pinion has turned by t - angle, and the rack has moved with it.
            height = np.clip(place.distance - radius * np.cos(t), -rack.root_depth, -rack.form_depth)
            middle = working * (t - angle) + place.touching
            return height, middle - radius * np.sin(t) - rack.half_thickness(height)

        at, depth = _deepest(clear, math.acos(cosine))
        cuts.append(EdgeCut(depth, at))
    return max(cuts, default=EdgeCut(0.0, 0.0))


def _rack_edges(rack: RackProfile) -> list[tuple[float, float]]:
    """Return the height and half thickness (mm) at the ends of the flank and of the tip land."""
    end, tip = rack.tip_form_height, rack.tip_height
    return sorted({(end, rack.half_thickness_on_flank(end)), (tip, rack.half_thickness(tip))})


def _deepest(clear: Callable[[Floats], tuple[Floats, Floats]], farthest: float) -> tuple[float, float]:
    """Return where the pinion or rack is cut deepest, for t between -farthest and farthest, and how deep.

    The place is the first result of `clear`, where the second is least; the depth is how far the second is below zero there.
    """
    t = np.linspace(-farthest, farthest, _STEPS)
    for _ in range(3):
        at, room = clear(t)
        worst = int(np.argmin(room))
        found = float(at[worst]), -float(room[worst])
        t = np.linspace(t[max(worst - 1, 0)], t[min(worst + 1, t.size - 1)], _FINE)
    return found


FELT = 1e-7
"""Depth in normal modules from which a tip is said to cut a fillet: as ISO 53's root radius is rounded, its racks cut 1e-9."""

_DERIVED = (
    "back_distance shifted_distance zero_backlash_distance working_transverse_pressure_angle pitch_line_height "
    "travel_per_revolution travel_per_degree tip_alteration transverse_contact_ratio usable_contact_ratio overlap_ratio "
    "total_contact_ratio circumferential_backlash normal_backlash active_root_diameter active_root_depth"
).split()
"""Properties in a document beside the inputs."""

_SKETCHED = "mounting_distance travel_per_revolution transverse_contact_ratio overlap_ratio circumferential_backlash".split()
"""Keys of the figures beside the picture of a pinion and a rack."""


@dataclass(frozen=True, kw_only=True)
class RackPair(RackPairData):
    """A pinion and a rack in mesh; the pinion drives. Lengths in mm, angles in degrees.

    `mounting_distance` is from the pinion's axis to the rack's reference line; not given it is r + x m_n, where the thinning
    gives the backlash. It is read as a number either way (see `Derived`). Their middles stand in one plane.
    Raises GeometryError where they do not fit each other, or the teeth would overlap.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        check_rack_inputs(self)
        check_rack_mates(self)
        derive(self, "mounting_distance", self.shifted_distance)
        check_rack_mesh(self)

    # ------------------------------------------------------------------ contact

    @property
    def working_transverse_pressure_angle(self) -> float:
        """alpha_t: that of the rack, at any mounting distance."""
        return self.pinion.transverse_pressure_angle

    @cached_property
    def path_of_contact(self) -> PathOfContact[float]:
        """A, B, C, D, E on the line of action, as distances from T1 (mm).

        T1A = T1C - (r - H + h_Fa2)/sin alpha_t, between the rack's tip (form) line and the pinion's tip (form) circle.
        """
        pinion, pitch = self.pinion, self.pinion.transverse_base_pitch
        middle = self._along(self.pitch_line_height)
        start = self._along(self.rack.tip_form_height)
        end = tangent_length(pinion.tip_form_diameter, pinion.base_diameter)
        return PathOfContact(start, end - pitch, middle, start + pitch, end)

    def _along(self, height: float) -> float:
        """Return the place (mm from T1, on the line of action) of the rack at a height over its reference line."""
        angle = math.radians(self.working_transverse_pressure_angle)
        return self.pinion.base_diameter / 2 * math.tan(angle) - (height - self.pitch_line_height) / math.sin(angle)

    @property
    def usable_path(self) -> tuple[float, float]:
        """First and last contact (mm from T1) when the ends of the flanks at both roots limit the path as well."""
        path = self.path_of_contact
        first = max(path.A, tangent_length(self.pinion.form_diameter, self.pinion.base_diameter))
        return first, min(path.E, self._along(-self.rack.form_depth))

    def rolling_speeds(self, distances: ArrayLike) -> PerGear[Floats]:
        """Velocities (n,) of both flanks along their common tangent (mm per radian of the pinion) at distances (mm) from T1."""
        along = np.atleast_1d(np.asarray(distances, float))
        return PerGear(along, np.full_like(along, self.path_of_contact.C))

    @property
    def active_root_diameter(self) -> float:
        """d_Nf of the pinion, that the rack's tip form line reaches (mm); the base circle where it passes beyond T1."""
        return math.hypot(self.pinion.base_diameter, 2 * max(self.path_of_contact.A, 0.0))

    @property
    def active_root_depth(self) -> float:
        """Depth (mm) below the rack's reference line to which the pinion's tip form circle reaches on the rack's flank."""
        path, angle = self.path_of_contact, math.radians(self.working_transverse_pressure_angle)
        return (path.E - path.C) * math.sin(angle) - self.pitch_line_height

    # ------------------------------------------------------------------ in mesh

    def rack_pose(self, pinion_rotation: float = 0.0) -> RackPose:
        """Pose of the rack at any pinion rotation (degrees): a space near its middle faces tooth 0, the backlash split evenly.

        The middles stand in one plane. The rack moves along +y by r per rad.
        """
        pinion, z = self.pinion, (self.pinion.face_width - self.rack.face_width) / 2
        turned = math.radians(pinion_rotation) + twist(pinion, z)
        space = (self.rack.whole_pitches // 2) * self.rack.transverse_pitch
        return RackPose(90.0, self.mounting_distance, self.pitch_radius * turned - space, z)

    # ------------------------------------------------------------------ what to know of it, and how it shows itself

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about this pair that an engineer should read before making it."""
        return (*self._interference(), *self._notices_of_mesh())

    def _notices_of_mesh(self) -> Iterator[Notice]:
        if self.circumferential_backlash < -ROUNDING * self.pinion.normal_module:
            overlap = f"{-self.circumferential_backlash:.3g} mm"
            yield Notice("rounded-shifts", f"zero backlash: the printed numbers overlap by {overlap} (rounding)")
        if (ratio := self.usable_contact_ratio) < 1:
            yield Notice("low-contact-ratio", f"contact ratio: {ratio:.4f} above the ends of the flanks is below 1")

    @cached_property
    def _place(self) -> RackPlace:
        thick = self.pinion.transverse_tooth_thickness / 2
        touching = thick + self.rack.profile.half_thickness_on_flank(self.pitch_line_height)
        return RackPlace(self.mounting_distance, touching)

    def _interference(self) -> Iterator[Notice]:
        """Yield a notice for each tip that cuts into the other's fillet. A pinion that is merely undercut loses contact, no
        material.
        """
        teeth = self.pinion.profile, self.rack.profile
        if (cut := cut_by_rack(*teeth, self._place)).depth > FELT * self.pinion.normal_module:
            text = f"the rack's tip cuts {cut.depth:.2g} mm into the pinion's fillet at diameter {cut.place:.4f} mm"
            yield Notice("fillet-interference", f"fillet interference: {text}")
        if (cut := cut_by_pinion(*teeth, self._place)).depth > FELT * self.pinion.normal_module:
            text = (
                f"the pinion's tip cuts {cut.depth:.2g} mm into the rack's fillet {-cut.place:.4f} mm below its reference line"
            )
            yield Notice("fillet-interference", f"fillet interference: {text}")

    def _repr_html_(self) -> str:
        written = symbols_of(RackPair) | symbols.PAIR | symbols.RACK_PAIR
        figures = [(written[name], getattr(self, name)) for name in _SKETCHED]
        return rack_pair_html(self.name, self.pinion, self.rack, self.rack.profile, self.rack_pose(), figures)

    def to_dict(self) -> JsonObject:
        """Derived properties of the pair under their names, for JSON (pinion and rack have their own)."""
        return {
            "mounting_distance": self.mounting_distance,
            **{name: getattr(self, name) for name in _DERIVED},
            "common_width": {"width": self.common_width},
            "tip_clearances": self.tip_clearances._asdict(),
            "path_of_contact": self.path_of_contact._asdict(),
            "specific_sliding": self.specific_sliding._asdict(),
            "specific_sliding_path": sliding_document(self.usable_path, self.specific_sliding_at),
            "contact_line_lengths": self.contact_line_lengths._asdict(),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }
