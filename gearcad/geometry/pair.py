"""GearPair: two gears on parallel axes, the wheel external or a ring, and how they mesh (ISO 21771)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from gearcad.core import symbols
from gearcad.core.quantities import derive, is_given, symbols_of
from gearcad.core.records import JsonObject, Notice, PerGear, Role, concise
from gearcad.geometry.gear_data import twist
from gearcad.geometry.gear_pictures import Pose, pair_html, wheel_pose
from gearcad.geometry.interference import FilletCut, InterferenceMargins, fillet_cut
from gearcad.geometry.mating import (
    ROUNDING,
    check_centre_distance,
    check_inputs,
    check_mates,
    check_shift_sum,
    check_teeth,
    check_tolerance,
    clear_tip_diameter,
    interference_margins,
    interference_notices,
)
from gearcad.geometry.pair_data import PairData
from gearcad.geometry.path_of_contact import sliding_document

__all__ = ["GearPair"]

_DERIVED = (
    "gear_ratio reference_centre_distance profile_shift_sum zero_backlash_shift_sum working_transverse_pressure_angle "
    "working_pitch_diameters tip_alteration transverse_contact_ratio usable_contact_ratio overlap_ratio "
    "total_contact_ratio tip_clearances circumferential_backlash normal_backlash active_root_diameters "
    "axial_force_ratio"
).split()
"""Properties in a document beside the inputs."""

_SKETCHED = "centre_distance gear_ratio transverse_contact_ratio overlap_ratio circumferential_backlash".split()
"""Keys of the figures beside the picture of a pair."""


@dataclass(frozen=True, kw_only=True)
class GearPair(PairData):
    """Two gears in mesh; the pinion drives. Lengths in mm, angles in degrees.

    `centre_distance` may be given; else it is the one without backlash for the gears' profile shifts (thinning then
    gives the backlash). It is read as a number either way (see `Derived`). `centre_distance_tolerance` ("js7" of DIN 3964) and
    `tooth_allowance` of the gears leave the backlash between limits. The gears stand with their middles in one
    plane, moved apart by `axial_offset` (of the wheel, along +z).
    Raises GeometryError where the gears do not fit each other, or the teeth would overlap.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        check_inputs(self)
        check_mates(self)
        if not is_given(self.centre_distance):
            check_shift_sum(self)
            derive(self, "centre_distance", self.centre_distance_for(self.profile_shift_sum))
        check_centre_distance(self)
        check_tolerance(self)
        check_teeth(self)

    # ------------------------------------------------------------------ contact

    @property
    def usable_path(self) -> tuple[float, float]:
        """First and last contact (mm from T1) when the root form circles limit the path as well."""
        return self.base_tangent.usable(self.path_of_contact, self.gears.map(lambda gear: gear.form_diameter))

    @property
    def _width_of_one_hand(self) -> float:
        width = self.common_width.width
        return width / 2 if self.double_helical else width

    @property
    def _phases(self) -> tuple[float, ...]:
        return (0.0, self.pinion.double_helix.offset) if self.double_helical else (0.0,)

    @property
    def axial_force_ratio(self) -> float:
        """F_a/F_t of the tangential force on the reference circle: tan |beta|; 0 of two halves, which balance each other."""
        return 0.0 if self.double_helical else math.tan(math.radians(abs(self.pinion.helix_angle)))

    @cached_property
    def active_root_diameters(self) -> PerGear[float]:
        """Start-of-active-profile diameters d_Nf that the mate's tip form circle reaches (mm)."""
        return self.base_tangent.active_root_diameters(self.path_of_contact)

    @cached_property
    def interference_margins(self) -> InterferenceMargins | None:
        """Margins (mm) of the tips against each kind of interference, for a pair with a ring; None without one."""
        return interference_margins(self) if self.internal else None

    @cached_property
    def clear_tip_diameter(self) -> float | None:
        """The largest tip diameter (mm, negative) with which a ring stays off its pinion's fillet.

        None without a ring, and where no tip does. `replace(pair.wheel, tip_diameter=pair.clear_tip_diameter)` has it.
        """
        return clear_tip_diameter(self) if self.internal else None

    # ------------------------------------------------------------------ in mesh

    def wheel_pose(self, pinion_rotation: float = 0.0) -> Pose:
        """Pose of the wheel, the middles of the gears in one plane (moved by `axial_offset`), at any pinion rotation (deg)."""
        z = (self.pinion.face_width - self.wheel.face_width) / 2 + self.axial_offset
        turn = pinion_rotation + math.degrees(twist(self.pinion, z))
        return wheel_pose(teeth=self.gears.map(lambda gear: gear.teeth), centre_distance=self.centre_distance, z=z, turn=turn)

    # ------------------------------------------------------------------ what to know of it, and how it shows itself

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about this pair that an engineer should read before making it."""
        interference = interference_notices(self) if self.internal else self._fillet_interference()
        return (*interference, *self._notices_of_mesh())

    def _notices_of_mesh(self) -> Iterator[Notice]:
        if self.circumferential_backlash < -ROUNDING * self.pinion.normal_module:
            overlap = f"{-self.circumferential_backlash:.3g} mm"
            yield Notice("rounded-shifts", f"zero backlash: the printed profile shifts overlap by {overlap} (rounding)")
        if (limits := self.backlash_limits) and limits.circumferential_least < 0 <= self.circumferential_backlash:
            overlap = f"{-limits.circumferential_least:.3g} mm"
            yield Notice("backlash-may-vanish", f"backlash: within the tolerances teeth may overlap by up to {overlap}")
        if (ratio := self.transverse_contact_ratio) < 1:
            yield Notice("low-contact-ratio", f"contact ratio: transverse contact ratio {ratio:.4f} is below 1")

    def _fillet_cut(self, role: Role) -> FilletCut | None:
        """Return the cut by the mate's tip into the fillet of a gear; None if it is negligible."""
        return fillet_cut(
            self.gears.pick(role).profile,
            self.gears.pick(role.mate).profile,
            centre_distance=self.centre_distance,
            pressure_angle=self.working_transverse_pressure_angle,
            rounding=ROUNDING * self.pinion.normal_module,
        )

    def _fillet_interference(self) -> Iterator[Notice]:
        for role, gear in self.gears.items():
            active, owner, other = self.active_root_diameters.pick(role), role.value, role.mate.value
            form = f"its root form circle {gear.form_diameter:.4f} mm"
            if gear.form_diameter > active:
                text = f"the {other}'s tip reaches diameter {active:.4f} mm of the {owner}, below {form}"
            elif cut := self._fillet_cut(role):
                at = f"diameter {cut.diameter:.4f} mm, below {form}"
                text = f"the edge of the {other}'s tip cuts {cut.depth:.2g} mm into the {owner}'s fillet at {at}"
            else:
                continue
            yield Notice("fillet-interference", f"fillet interference: {text}")

    def _repr_html_(self) -> str:
        written = symbols_of(GearPair) | symbols.PAIR
        figures = [(written[name], getattr(self, name)) for name in _SKETCHED]
        return pair_html(self.name, self.gears, self.gears.map(lambda gear: gear.profile), self.wheel_pose(), figures)

    def _tolerated(self) -> dict[str, Any]:
        """Return the tolerances for `to_dict`: the class of the centre distance and the limits of backlash, where given."""
        limits, name = self.backlash_limits, self.centre_distance_tolerance
        given = {} if name is None else {"centre_distance_tolerance": name}
        return given if limits is None else given | {"backlash_limits": limits._asdict()}

    def to_dict(self) -> JsonObject:
        """Derived properties of the pair under their names, for JSON (the gears have their own)."""
        derived = {name: getattr(self, name) for name in _DERIVED}
        return {
            "centre_distance": self.centre_distance,
            "axial_offset": self.axial_offset,
            "common_width": self.common_width._asdict(),
            **{name: list(value) if isinstance(value, PerGear) else value for name, value in derived.items()},
            "path_of_contact": self.path_of_contact._asdict(),
            "specific_sliding": self.specific_sliding._asdict(),
            "specific_sliding_path": sliding_document(self.usable_path, self.specific_sliding_at),
            "contact_line_lengths": self.contact_line_lengths._asdict(),
            **self._tolerated(),
            **({"interference_margins": margins._asdict()} if (margins := self.interference_margins) else {}),
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }
