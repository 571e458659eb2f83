"""Rack: a spur or helical toothed bar, and everything that follows from what was given (ISO 21771)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from gearcad.errors import GeometryError
from gearcad.geometry.derived import derive, derive_count
from gearcad.geometry.diametral import derive_module
from gearcad.geometry.gear import THIN_TIP
from gearcad.geometry.profile import LEAST_LAND
from gearcad.geometry.rack_data import RackData
from gearcad.geometry.rack_feasibility import check_rack_fields, check_rack_length, check_rack_numbers, check_rack_teeth
from gearcad.geometry.rack_inspection import RackInspection
from gearcad.geometry.rack_picture import rack_html
from gearcad.geometry.rack_profile import RackProfile
from gearcad.notice import Notice, texts
from gearcad.reprs import concise

__all__ = ["Rack"]

_DERIVED = (
    "transverse_module transverse_pressure_angle base_helix_angle normal_pitch transverse_pitch transverse_base_pitch "
    "tip_height tip_form_height form_depth root_depth total_height normal_tooth_thickness transverse_tooth_thickness "
    "tip_thickness pin_diameter over_pin"
).split()
"""What a document has beside the inputs."""


@dataclass(frozen=True, kw_only=True)
class Rack(RackData):
    """One spur or helical rack. Lengths in mm, angles in degrees.

    It lies along x from x = 0 to the `length`, teeth up (+y) and z = 0 ... face width; y = 0 is the reference line, `height`
    above the back. At z = 0 the middle of a space is at x = 0, so tooth 0 is centred half a pitch on. The end faces are square
    to the length: they cut helical teeth obliquely, and whatever a length that is no whole number of pitches ends in. Of
    `teeth` and `length` one is given: so many pitches are the length, and the teeth then are the whole pitches in it.
    `helix_angle` is signed as a gear's: right hand positive; a right-hand rack meshes with a left-hand pinion.
    `tip_alteration` k is in normal modules, `tooth_thinning` the reduction of the normal tooth thickness (mm), `tip_chamfer`
    the height of the 45-degree chamfer along both tip edges (transverse section). A rack has no profile shift: what that does
    on a gear, the mounting distance of its pair does.
    Raises ParameterError for one value out of range, GeometryError for a combination that makes no rack.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        check_rack_fields(self)
        derive_module(self)
        check_rack_numbers(self)
        derive(self, "length", (self.teeth or 0) * self.transverse_pitch)
        check_rack_length(self)
        derive_count(self, "teeth", self.whole_pitches)
        check_rack_teeth(self)

    @cached_property
    def profile(self) -> RackProfile:
        """The exact outline of one tooth."""
        radius = self.root_radius * self.normal_module
        return RackProfile(
            normal_pitch=self.normal_pitch,
            normal_thickness=self.normal_tooth_thickness,
            pressure_angle=self.rack.pressure_angle,
            helix_angle=self.helix_angle,
            tip_height=self.tip_height,
            root_depth=self.root_depth,
            root_radius=radius if radius >= LEAST_LAND else 0.0,
            tip_chamfer=self.tip_chamfer,
        )

    # ------------------------------------------------------------------ inspection

    @cached_property
    def inspection(self) -> RackInspection:
        """Measuring over any pin; the properties below are those of the pin suggested."""
        return RackInspection(
            normal_pitch=self.normal_pitch,
            normal_tooth_thickness=self.normal_tooth_thickness,
            pressure_angle=self.rack.pressure_angle,
            height=self.height,
            tip_height=self.tip_height,
            tip_form_height=self.tip_form_height,
            form_depth=self.form_depth,
            root_depth=self.root_depth,
        )

    @property
    def pin_diameter(self) -> float:
        """Pin or ball that touches near the reference line, rounded up to two digits."""
        return self.inspection.pin_diameter

    @property
    def over_pin(self) -> float | None:
        """Height over a pin of `pin_diameter` in a space, from the back; None where it touches no flank."""
        try:
            return self.inspection.over_pin(self.pin_diameter)
        except GeometryError:
            return None

    # ------------------------------------------------------------------ what to know of it, and how it shows itself

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """What an engineer should know about this rack before making it."""
        return (*self._notices_of_teeth(), *self.inspection.notices())

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def _notices_of_teeth(self) -> Iterator[Notice]:
        if self.tip_thickness < THIN_TIP * self.normal_module:
            thickness = f"normal thickness {self.tip_thickness:.4f} mm is below {THIN_TIP} m_n"
            yield Notice("thin-tip", f"thin tip: {thickness} (0.4 m_n if case-hardened)")

    def _repr_html_(self) -> str:
        return rack_html(self, self.profile)

    def to_dict(self) -> dict[str, Any]:
        """Inputs and derived properties under their field names, for JSON."""
        inputs = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "rack"}
        rack = {f.name: getattr(self.rack, f.name) for f in fields(self.rack)}
        warnings = {"warnings": list(self.warnings), "notices": [notice.to_dict() for notice in self.notices]}
        return {**inputs, "rack": rack, **{name: getattr(self, name) for name in _DERIVED}, **warnings}
