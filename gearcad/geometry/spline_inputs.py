"""Inputs of a spline: standard, size, and what is given of shaft and hub (DIN 5480, ISO 4156, ANSI B92.1).

Lengths in mm, angles in degrees, tolerances in µm. Teeth and diameters of a hub are positive here, and its profile shift is
that of the shaft.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Annotated

from gearcad.core.errors import GeometryError, at_least, at_most, require_name
from gearcad.core.quantities import (
    NOT_GIVEN,
    AssumedNumber,
    Choice,
    Range,
    Whole,
    Words,
    derive,
    derive_count,
    is_given,
    require_fields,
)
from gearcad.core.records import concise
from gearcad.core.units import module_of_pitch
from gearcad.geometry.spline_standards import (
    ANGLES,
    DIN5480,
    GREATEST_SHIFT,
    HUB,
    ISO4156,
    LEAST_SHIFT,
    SHAFT,
    STANDARDS,
    Designation,
    basic_thickness,
    din_profile_shift,
    form_clearance,
    read_designation,
)

_MM = Range("mm", 0, 10_000, ends="(]")
_MICRONS = Range("µm", 0, 10_000)


@dataclass(frozen=True, kw_only=True)
class _PartInputs:
    """Inputs of one part of a spline joint.

    `fit` is the tolerance class ("8f", "9H"; a grade in ANSI B92.1); `root` says how the root is made (DIN 5480) or its form.
    Without `tolerance_actual` T_act and `tolerance_effective` T_eff they are those of the standard where these are known.
    Without `pin_diameter` and `span_teeth` those are chosen that touch near the middle of the teeth. Raises ParameterError.
    """

    fit: Annotated[str | None, Words("tolerance class")] = None
    root: Annotated[str | None, Words("root")] = None
    pin_diameter: Annotated[float | None, _MM, Words("pin diameter", "D_M")] = None
    span_teeth: Annotated[int | None, Whole(1, 2000), Words("number of teeth spanned", "k")] = None
    tolerance_actual: Annotated[float | None, _MICRONS, Words("tolerance of the actual size", "T_act")] = None
    tolerance_effective: Annotated[float | None, _MICRONS, Words("tolerance of form and pitch", "T_eff")] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        for text in ("fit", "root"):
            if getattr(self, text) is not None:
                require_name(text, getattr(self, text))
        for one, other in (("tolerance_actual", "tolerance_effective"), ("tolerance_effective", "tolerance_actual")):
            if getattr(self, one) is not None and getattr(self, other) is None:
                raise GeometryError(other, None, f"must be given where {one} is (in µm)")

    @property
    def given(self) -> bool:
        """Whether anything is given."""
        return any(getattr(self, each.name) != each.default for each in fields(self))


@dataclass(frozen=True, kw_only=True)
class ShaftInputs(_PartInputs):
    """Inputs of the shaft of a spline joint; `bore` (mm) makes it hollow."""

    bore: Annotated[float, Range("mm", 0, 10_000), Words("bore of the shaft")] = 0.0


@dataclass(frozen=True, kw_only=True)
class HubInputs(_PartInputs):
    """Inputs of the hub of a spline joint; without an `outer_diameter` (mm) it is 1.25 times that of the root circle."""

    outer_diameter: Annotated[float | None, _MM, Words("outer diameter of the hub")] = None


@dataclass(frozen=True, kw_only=True)
class SplineInputs:
    """Standard and size of a spline, and what is given of its shaft and its hub.

    A `designation` says standard, size and classes; else `standard`, `teeth`, and `module` (mm) or `diametral_pitch` (1/inch)
    are given, in DIN 5480 with the `nominal_diameter` d_B (mm). `centring` is by the flanks, or by the major diameter.
    `length` (mm) is that of the engagement; without one it is the nominal diameter. A check has a `radial_force` (N) on the
    shaft beside its torque; `carrying_share` is that of the flanks that carry in its mean stresses.
    Raises ParameterError for one value out of range, GeometryError for a combination that makes no spline.
    """

    name: Annotated[str, Words("name")] = "spline"
    standard: Annotated[str | None, Choice(STANDARDS), Words("standard of the spline")] = None
    designation: Annotated[str | None, Words("designation")] = None
    nominal_diameter: Annotated[float, Range("mm", 1, 10_000), Words("nominal diameter", "d_B", "DIN 5480-1")] = NOT_GIVEN
    module: Annotated[float, Range("mm", 0.1, 100), Words("module", "m")] = NOT_GIVEN
    diametral_pitch: Annotated[float, Range("1/inch", 0.25, 254), Words("diametral pitch", "P")] = NOT_GIVEN
    teeth: Annotated[int | None, Whole(6, 500), Words("number of teeth", "z")] = None
    pressure_angle: Annotated[float, Range("deg", 30, 45), Words("pressure angle", "α")] = NOT_GIVEN
    centring: Annotated[str, Choice(("flank", "major")), Words("centring")] = "flank"
    length: Annotated[float, _MM, Words("length of the engagement", "b")] = NOT_GIVEN
    radial_force: Annotated[float, Range("N", 0, 1e9), Words("radial force on the shaft", "F_r")] = 0.0
    carrying_share: Annotated[float, Range("", 0.01, 1), Words("share of the flanks that carry", "φ")] = AssumedNumber(0.75)
    shaft: ShaftInputs = field(default=ShaftInputs())
    hub: HubInputs = field(default=HubInputs())

    __repr__ = concise

    def __post_init__(self) -> None:
        require_name("name", self.name)
        require_fields(self)
        if self.designation is not None:
            require_name("designation", self.designation)
        said = self.designated
        self._take(said)
        standard = self.standard
        if standard is None:
            raise GeometryError("standard", None, f"must be given, one of {', '.join(STANDARDS)}, or a designation")
        self._derive_module(standard)
        if self.teeth is None:
            raise GeometryError("teeth", None, "must be given, or a designation")
        if is_given(self.nominal_diameter) and standard != DIN5480:
            permitted = f"must be left out: it is of DIN 5480, and {standard} has d = m z"
            raise GeometryError("nominal_diameter", self.nominal_diameter, permitted, "mm")
        if standard == DIN5480 and math.isnan(self.nominal_diameter):
            raise GeometryError("nominal_diameter", None, "must be given for DIN 5480 (in mm), or a designation")
        if standard != DIN5480:
            derive(self, "nominal_diameter", self.module * self.teeth)
        if math.isnan(self.pressure_angle):
            derive(self, "pressure_angle", 30.0)
        if self.pressure_angle not in ANGLES[standard]:
            angles = " or ".join(f"{each:g}" for each in ANGLES[standard])
            raise GeometryError("pressure_angle", self.pressure_angle, f"must be {angles} deg ({standard})", "deg")
        self._check_shift()
        derive(self, "length", self.nominal_diameter)

    @cached_property
    def designated(self) -> Designation | None:
        """Content of the designation; None without one."""
        return None if self.designation is None else read_designation(self.designation)

    def _take(self, said: Designation | None) -> None:
        """Take from a designation what it says. Raises GeometryError for a key that it says too."""
        if said is None:
            return
        if self.standard is not None and self.standard != said.standard:
            raise GeometryError("standard", self.standard, f"must be {said.standard}, as the designation is of it")
        object.__setattr__(self, "standard", said.standard)
        for key, value in said.values.items():
            now = getattr(self, key)
            if is_given(now):
                if now != value:
                    raise GeometryError(key, now, f"must be left out: the designation says {value:g}")
                continue
            if isinstance(value, int):
                derive_count(self, key, value)
            else:
                derive(self, key, value)

    def _derive_module(self, standard: str) -> None:
        """Let the module follow from the diametral pitch, or that from it."""
        module, pitch = self.module, self.diametral_pitch
        if math.isnan(module) and math.isnan(pitch):
            raise GeometryError("module", None, "must be given (in mm), or diametral_pitch, or a designation")
        if is_given(module) and is_given(pitch):
            raise GeometryError("diametral_pitch", pitch, "must be left out where module is given", "1/inch")
        if math.isnan(module):
            derive(self, "module", module_of_pitch(pitch))
        derive(self, "diametral_pitch", module_of_pitch(self.module))
        if standard == ISO4156 and is_given(pitch):
            raise GeometryError("diametral_pitch", pitch, "must be left out: ISO 4156 has a module", "1/inch")

    def _check_shift(self) -> None:
        if not LEAST_SHIFT <= self.profile_shift <= GREATEST_SHIFT:
            least, most = (self.module * (self.count + 1.1 + 2 * each) for each in (LEAST_SHIFT, GREATEST_SHIFT))
            permitted = (
                f"must be from {at_least(least)} to {at_most(most)} mm for {self.teeth} teeth of module {self.module:g} mm"
            )
            raise GeometryError("nominal_diameter", self.nominal_diameter, permitted, "mm")

    # ------------------------------------------------------------------ what both parts have

    @property
    def count(self) -> int:
        """Number of teeth z."""
        assert self.teeth is not None
        return self.teeth

    @property
    def basis(self) -> str:
        """The standard."""
        assert self.standard is not None
        return self.standard

    @property
    def reference_diameter(self) -> float:
        """Reference diameter d = m z."""
        return self.module * self.count

    @property
    def base_diameter(self) -> float:
        """Base diameter d_b = d cos alpha."""
        return self.reference_diameter * math.cos(math.radians(self.pressure_angle))

    @property
    def profile_shift(self) -> float:
        """Profile shift coefficient x of shaft and hub, with the shaft's sign; 0 in ISO 4156."""
        if self.basis == DIN5480:
            return din_profile_shift(self.nominal_diameter, self.module, self.count)
        more = basic_thickness(self.basis, self.pressure_angle, self.module) - self.module * math.pi / 2
        return more / (2 * self.module * math.tan(math.radians(self.pressure_angle)))

    @property
    def basic_thickness(self) -> float:
        """Basic tooth thickness and space width s = e = m pi/2 + 2 x m tan alpha (mm)."""
        return self.module * (math.pi / 2 + 2 * self.profile_shift * math.tan(math.radians(self.pressure_angle)))

    @property
    def form_clearance(self) -> float | None:
        """Form clearance c_F (mm) of the standard; None where it is not known."""
        return form_clearance(self.basis, self.module, self.reference_diameter)

    @cached_property
    def named_parts(self) -> tuple[str, ...]:
        """Shaft and hub, as far as they are asked for: by the designation and by tables of their own, else both."""
        said = self.designated
        named = {part for part, own in ((SHAFT, self.shaft), (HUB, self.hub)) if own.given}
        if said is not None:
            named |= set(said.parts)
        return tuple(part for part in (SHAFT, HUB) if part in named or not named)
