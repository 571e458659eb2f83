"""GearPair: two external gears on parallel axes, and how they mesh (ISO 21771)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from gearcad.errors import GeometryError, ParameterError, format_number, plain_numbers, require_name, require_number
from gearcad.geometry import path
from gearcad.geometry.derived import Derived
from gearcad.geometry.gear import Gear
from gearcad.geometry.interference import fillet_cut
from gearcad.geometry.involute import involute
from gearcad.geometry.limits import at_least, at_most
from gearcad.geometry.path import ContactLineLengths, PathOfContact
from gearcad.geometry.picture import pair_html
from gearcad.geometry.shift import least_profile_shift_sum, profile_shift_sum, zero_backlash_centre_distance
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear
from gearcad.ranges import OFFSET
from gearcad.reprs import concise

__all__ = ["CommonWidth", "GearPair"]

ROUNDING_OVERLAP = 1e-4
"""Overlap at the working circle, in normal modules, that comes from shifts printed to four digits: reported, not refused."""

_SAME = 1e-9

_DERIVED = (
    "gear_ratio reference_centre_distance profile_shift_sum zero_backlash_shift_sum working_transverse_pressure_angle "
    "working_pitch_diameters tip_alteration transverse_contact_ratio usable_contact_ratio overlap_ratio "
    "total_contact_ratio tip_clearances circumferential_backlash normal_backlash active_root_diameters"
).split()


class CommonWidth(NamedTuple):
    """Width (mm) over which the gears face each other, and the offset (mm) of its middle from the pinion's middle."""

    width: float
    offset: float


@dataclass(frozen=True, kw_only=True)
class GearPair:
    """Two gears in mesh; the pinion drives. Lengths in mm, angles in degrees.

    `centre_distance` may be given; else it is the one without backlash for the gears' profile shifts (thinning then
    gives the backlash). It is read as a number either way (see `Derived`). The gears stand with their middles in one
    plane, moved apart by `axial_offset` (of the wheel, along +z).
    Raises GeometryError where the gears do not fit each other, or the teeth would overlap.
    """

    pinion: Gear
    wheel: Gear
    centre_distance: float = Derived("nan")
    axial_offset: float = 0.0
    name: str = "pair"

    __repr__ = concise
    _repr_html_ = pair_html

    def __post_init__(self) -> None:
        plain_numbers(self)
        for role, gear in self.gears.items():
            if not isinstance(gear, Gear):
                raise ParameterError(role.value, gear, "must be a Gear")
        OFFSET.require("axial_offset", self.axial_offset)
        require_name("name", self.name)
        self._check_mates()
        given = self.centre_distance
        if given is None or isinstance(given, Derived):
            self._check_shift_sum()
            object.__setattr__(self, "centre_distance", Derived(self._centre_distance_for(self.profile_shift_sum)))
        else:
            require_number("centre_distance", given, "mm", above=0)
        least = (self.pinion.base_diameter + self.wheel.base_diameter) / 2
        if self.centre_distance <= least:
            raise GeometryError(
                "centre_distance",
                self.centre_distance,
                f"must be above {at_least(least)} mm, where the base circles touch",
                "mm",
            )
        self._check_overlap()
        self._check_reach()

    def _check_reach(self) -> None:
        """Some path of contact must be left between the tip form circles."""
        farthest = path.farthest_centre_distance(self.pinion, self.wheel)
        if self.centre_distance >= farthest:
            permitted = f"must be below {at_most(farthest)} mm, where the tips reach each other's flanks"
            raise GeometryError("centre_distance", self.centre_distance, permitted, "mm")

    def _check_mates(self) -> None:
        pinion, wheel = self.pinion, self.wheel
        for name, unit, one, other in (
            ("normal_module", "mm", pinion.normal_module, wheel.normal_module),
            ("rack.pressure_angle", "deg", pinion.rack.pressure_angle, wheel.rack.pressure_angle),
        ):
            if abs(one - other) > _SAME:
                raise GeometryError(f"wheel.{name}", other, f"must be {format_number(one)} {unit}, as on the pinion", unit)
        if abs(pinion.helix_angle + wheel.helix_angle) > _SAME:
            raise GeometryError(
                "wheel.helix_angle",
                wheel.helix_angle,
                f"must be {format_number(-pinion.helix_angle)} deg, opposite to the pinion",
                "deg",
            )
        if self.common_width.width <= 0:
            most = at_most((pinion.face_width + wheel.face_width) / 2)
            permitted = f"must be between -{most} and {most} mm, for the gears to face each other"
            raise GeometryError("axial_offset", self.axial_offset, permitted, "mm")

    def _check_overlap(self) -> None:
        backlash = self.circumferential_backlash
        if backlash < -ROUNDING_OVERLAP * self.pinion.normal_module:
            least = at_least(self._centre_distance_for(self.profile_shift_sum - self._thinning_as_shift), digits=9)
            raise GeometryError(
                "centre_distance",
                self.centre_distance,
                f"must be at least {least} mm for these profile shifts and thinning, or the"
                f" shift sum at most {self._fitting_shift_sum:.6f}: the backlash would be {backlash:.6f} mm",
                "mm",
            )
        for role, clearance in self.tip_clearances.items():
            if clearance <= 0:
                tip = self.gears.pick(role).tip_diameter
                permitted = f"must be below {tip + 2 * clearance:.6f} mm: the tip reaches the {role.mate.value}'s root circle"
                raise GeometryError(f"{role.value}.tip_diameter", tip, permitted, "mm")

    @property
    def gears(self) -> PerGear[Gear]:
        """Pinion and wheel."""
        return PerGear(self.pinion, self.wheel)

    # ------------------------------------------------------------------ working data

    @property
    def gear_ratio(self) -> float:
        """u = z_2/z_1."""
        return self.wheel.teeth / self.pinion.teeth

    @property
    def reference_centre_distance(self) -> float:
        """a_d = (d_1 + d_2)/2."""
        return (self.pinion.reference_diameter + self.wheel.reference_diameter) / 2

    @property
    def profile_shift_sum(self) -> float:
        """x_1 + x_2 of the gears."""
        return self.pinion.profile_shift + self.wheel.profile_shift

    @property
    def zero_backlash_shift_sum(self) -> float:
        """x_1 + x_2 that would mesh without backlash at this centre distance (no thinning)."""
        return profile_shift_sum(**self._common, centre_distance=self.centre_distance)

    @property
    def _common(self) -> dict[str, Any]:
        """What the formulas of profile shift and centre distance want to know of both gears."""
        return {
            "normal_module": self.pinion.normal_module,
            "teeth": (self.pinion.teeth, self.wheel.teeth),
            "helix_angle": self.pinion.helix_angle,
            "pressure_angle": self.pinion.rack.pressure_angle,
        }

    @property
    def _thinning_as_shift(self) -> float:
        """Change of the shift sum that thins the teeth as much as their tooth thinning does."""
        thinning = self.pinion.tooth_thinning + self.wheel.tooth_thinning
        return thinning / (2 * self.pinion.normal_module * math.tan(math.radians(self.pinion.rack.pressure_angle)))

    @cached_property
    def _fitting_shift_sum(self) -> float:
        return self.zero_backlash_shift_sum + self._thinning_as_shift

    def _centre_distance_for(self, shift_sum: float) -> float:
        return zero_backlash_centre_distance(**self._common, shift_sum=shift_sum)

    def _check_shift_sum(self) -> None:
        size = {name: value for name, value in self._common.items() if name != "normal_module"}
        least = least_profile_shift_sum(**size)
        if self.profile_shift_sum <= least:
            permitted = (
                f"must be above {at_least(least - self.pinion.profile_shift)}: no centre distance meshes without backlash"
            )
            raise GeometryError("wheel.profile_shift", self.wheel.profile_shift, permitted)

    @cached_property
    def working_transverse_pressure_angle(self) -> float:
        """cos alpha_wt = (d_b1 + d_b2)/(2 a)."""
        cosine = (self.pinion.base_diameter + self.wheel.base_diameter) / (2 * self.centre_distance)
        return math.degrees(math.acos(cosine))

    @property
    def working_pitch_diameters(self) -> PerGear[float]:
        """d_w1 = 2 a/(1 + u), d_w2 = u d_w1."""
        pinion = 2 * self.centre_distance / (1 + self.gear_ratio)
        return PerGear(pinion, self.gear_ratio * pinion)

    @property
    def tip_alteration(self) -> float:
        """k that keeps the rack's tip clearance: (a - a_d)/m_n - (x_1 + x_2), never positive ("auto" in a spec)."""
        change = (self.centre_distance - self.reference_centre_distance) / self.pinion.normal_module
        return min(change - self.profile_shift_sum, 0.0)

    @property
    def tip_clearances(self) -> PerGear[float]:
        """Clearance of each gear's tip in the mate's root."""
        return PerGear(
            self.centre_distance - (self.pinion.tip_diameter + self.wheel.root_diameter) / 2,
            self.centre_distance - (self.wheel.tip_diameter + self.pinion.root_diameter) / 2,
        )

    @property
    def circumferential_backlash(self) -> float:
        """j_wt: working pitch less both tooth thicknesses on the working pitch circles (transverse)."""
        working = involute(self.working_transverse_pressure_angle)
        gap = 2 * math.pi / self.pinion.teeth
        for gear, turn in ((self.pinion, 1.0), (self.wheel, self.gear_ratio)):
            gap -= 2 * turn * (math.radians(gear.profile.base_half_angle) - working)
        return gap * self.working_pitch_diameters.pinion / 2

    @property
    def normal_backlash(self) -> float:
        """j_bn along the base normal: j_wt cos alpha_wt cos beta_b."""
        across = math.cos(math.radians(self.working_transverse_pressure_angle))
        return self.circumferential_backlash * across * math.cos(math.radians(self.pinion.base_helix_angle))

    # ------------------------------------------------------------------ contact

    @cached_property
    def common_width(self) -> CommonWidth:
        """Common face width and where its middle lies, seen from the pinion's middle."""
        own, mate = self.pinion.face_width / 2, self.wheel.face_width / 2
        low, high = max(-own, self.axial_offset - mate), min(own, self.axial_offset + mate)
        return CommonWidth(high - low, (high + low) / 2)

    @cached_property
    def path_of_contact(self) -> PathOfContact:
        """A, B, C, D, E on the line of action between the tip (form) circles, as distances from T1 (mm)."""
        return path.path_of_contact(self)

    @property
    def transverse_contact_ratio(self) -> float:
        """epsilon_alpha from the tip circles, less tip chamfers."""
        path = self.path_of_contact
        return (path.E - path.A) / self.pinion.transverse_base_pitch

    @property
    def usable_contact_ratio(self) -> float:
        """epsilon_alpha also limited by the root form circles; 0 where nothing is left."""
        first, last = path.usable_path(self)
        return max(last - first, 0.0) / self.pinion.transverse_base_pitch

    @property
    def overlap_ratio(self) -> float:
        """epsilon_beta = b sin |beta|/(pi m_n) on the common face width."""
        sine = math.sin(math.radians(abs(self.pinion.helix_angle)))
        return self.common_width.width * sine / (math.pi * self.pinion.normal_module)

    @property
    def total_contact_ratio(self) -> float:
        """epsilon_gamma = epsilon_alpha + epsilon_beta."""
        return self.transverse_contact_ratio + self.overlap_ratio

    @property
    def active_root_diameters(self) -> PerGear[float]:
        """Start-of-active-profile diameters d_Nf that the mate's tip form circle reaches (mm)."""
        return path.active_root_diameters(self)

    @cached_property
    def contact_line_lengths(self) -> ContactLineLengths:
        """Least, mean and greatest total length of the lines of contact over the cycle (mm)."""
        return path.contact_line_lengths(self)

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """What an engineer should know about this pair before making it."""
        return (*self._fillet_interference(), *self._notices_of_mesh())

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def _notices_of_mesh(self) -> Iterator[Notice]:
        if self.circumferential_backlash < -_SAME * self.pinion.normal_module:
            overlap = f"{-self.circumferential_backlash:.3g} mm"
            yield Notice("rounded-shifts", f"zero backlash: the printed profile shifts overlap by {overlap} (rounding)")
        if (ratio := self.transverse_contact_ratio) < 1:
            yield Notice("low-contact-ratio", f"contact ratio: transverse contact ratio {ratio:.4f} is below 1")

    def _fillet_interference(self) -> Iterator[Notice]:
        for role, gear in self.gears.items():
            active, owner, other = self.active_root_diameters.pick(role), role.value, role.mate.value
            form = f"its root form circle {gear.form_diameter:.4f} mm"
            if gear.form_diameter > active:
                text = f"the {other}'s tip reaches diameter {active:.4f} mm of the {owner}, below {form}"
            elif cut := fillet_cut(self, gear, self.gears.pick(role.mate)):
                at = f"diameter {cut.diameter:.4f} mm, below {form}"
                text = f"the edge of the {other}'s tip cuts {cut.depth:.2g} mm into the {owner}'s fillet at {at}"
            else:
                continue
            yield Notice("fillet-interference", f"fillet interference: {text}")

    def to_dict(self) -> dict[str, Any]:
        """Derived properties of the pair under their names, for JSON (the gears have their own)."""
        derived = {name: getattr(self, name) for name in _DERIVED}
        return {
            "centre_distance": self.centre_distance,
            "axial_offset": self.axial_offset,
            "common_width": self.common_width._asdict(),
            **{name: list(value) if isinstance(value, tuple) else value for name, value in derived.items()},
            "path_of_contact": self.path_of_contact._asdict(),
            "contact_line_lengths": self.contact_line_lengths._asdict(),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }
