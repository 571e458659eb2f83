"""RackPair: a pinion and a rack, and how they mesh (ISO 21771, the wheel's diameter infinite)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad import symbols
from gearcad.arrays import Floats
from gearcad.geometry.derived import derive
from gearcad.geometry.helix import twist
from gearcad.geometry.involute import tangent_length
from gearcad.geometry.pair import ROUNDING
from gearcad.geometry.path import (
    ContactLineLengths,
    ContactZone,
    PathOfContact,
    SpecificSliding,
    sliding_along,
    sliding_document,
)
from gearcad.geometry.pose import RackPose
from gearcad.geometry.rack_interference import RackPlace, cut_by_pinion, cut_by_rack
from gearcad.geometry.rack_mating import check_rack_inputs, check_rack_mates, check_rack_mesh
from gearcad.geometry.rack_pair_data import RackPairData
from gearcad.geometry.rack_picture import rack_pair_html
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear
from gearcad.reprs import concise
from gearcad.schema import symbols_of

__all__ = ["RackPair"]

FELT = 1e-7
"""Depth in normal modules from which a tip is said to cut a fillet: as ISO 53's root radius is rounded, its racks cut 1e-9."""

_DERIVED = (
    "back_distance shifted_distance zero_backlash_distance working_transverse_pressure_angle pitch_line_height "
    "travel_per_revolution travel_per_degree tip_alteration transverse_contact_ratio usable_contact_ratio overlap_ratio "
    "total_contact_ratio circumferential_backlash normal_backlash active_root_diameter active_root_depth"
).split()
"""What a document has beside what was given."""

_SKETCHED = "mounting_distance travel_per_revolution transverse_contact_ratio overlap_ratio circumferential_backlash".split()
"""The figures beside its picture."""


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
    def path_of_contact(self) -> PathOfContact:
        """A, B, C, D, E on the line of action, as distances from T1 (mm).

        T1A = T1C - (r - H + h_Fa2)/sin alpha_t, between the rack's tip (form) line and the pinion's tip (form) circle.
        """
        pinion, pitch = self.pinion, self.pinion.transverse_base_pitch
        middle = self._along(self.pitch_line_height)
        start = self._along(self.rack.tip_form_height)
        end = tangent_length(pinion.tip_form_diameter, pinion.base_diameter)
        return PathOfContact(start, end - pitch, middle, start + pitch, end)

    def _along(self, height: float) -> float:
        """Where on the line of action (mm from T1) the rack is at a height over its reference line."""
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

    def specific_sliding_at(self, distances: ArrayLike) -> PerGear[Floats]:
        """Specific sliding zeta (n,) of pinion and rack at distances (mm) from T1 along the path of contact (ISO 21771)."""
        return sliding_along(self.rolling_speeds(distances))

    @property
    def specific_sliding(self) -> SpecificSliding:
        """Specific sliding of both flanks at the first and the last contact, and the greatest; `wheel` is the rack."""
        return SpecificSliding.between(self.rolling_speeds(self.usable_path))

    @property
    def transverse_contact_ratio(self) -> float:
        """epsilon_alpha from the tips, less tip chamfers."""
        path = self.path_of_contact
        return (path.E - path.A) / self.pinion.transverse_base_pitch

    @property
    def usable_contact_ratio(self) -> float:
        """epsilon_alpha also limited by the ends of the flanks at the roots; 0 where nothing is left."""
        first, last = self.usable_path
        return max(last - first, 0.0) / self.pinion.transverse_base_pitch

    @property
    def overlap_ratio(self) -> float:
        """epsilon_beta = b sin |beta|/(pi m_n) on the common face width."""
        sine = math.sin(math.radians(abs(self.pinion.helix_angle)))
        return self.common_width * sine / (math.pi * self.pinion.normal_module)

    @property
    def total_contact_ratio(self) -> float:
        """epsilon_gamma = epsilon_alpha + epsilon_beta."""
        return self.transverse_contact_ratio + self.overlap_ratio

    @property
    def active_root_diameter(self) -> float:
        """d_Nf of the pinion, that the rack's tip form line reaches (mm); the base circle where it passes beyond T1."""
        return math.hypot(self.pinion.base_diameter, 2 * max(self.path_of_contact.A, 0.0))

    @property
    def active_root_depth(self) -> float:
        """How far below its reference line the pinion's tip form circle reaches on the rack's flank (mm)."""
        path, angle = self.path_of_contact, math.radians(self.working_transverse_pressure_angle)
        return (path.E - path.C) * math.sin(angle) - self.pitch_line_height

    @cached_property
    def _zone(self) -> ContactZone:
        pinion = self.pinion
        pitch, helix = pinion.transverse_base_pitch, pinion.base_helix_angle
        return ContactZone(self.path_of_contact, pitch, self.common_width, helix, pinion.base_diameter)

    def contact_line_length(self, roll_angle: ArrayLike) -> Any:
        """Total length (mm) of the lines of contact at a roll angle of the pinion (degrees), as of a GearPair."""
        return self._zone.line_length(roll_angle)

    @cached_property
    def contact_line_lengths(self) -> ContactLineLengths:
        """Least, mean and greatest total length of the lines of contact over the cycle (mm)."""
        return self._zone.line_lengths

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
        """What an engineer should know about this pair before making it."""
        return (*self._interference(), *self._notices_of_mesh())

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

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
        """What the tip of one cuts from the other's fillet; a pinion that is merely undercut loses contact, no material."""
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

    def to_dict(self) -> dict[str, Any]:
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
