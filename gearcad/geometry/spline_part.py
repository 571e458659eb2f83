"""Spline: the splined shaft or hub of a joint, with its sizes, limits, gauges and the exact outline.

Lengths in mm, angles in degrees, deviations in µm. Sizes of a hub are positive; only its `gear` has the signs of ISO 21771.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.quantities import Whole, Words
from gearcad.core.records import JsonObject, Notice, concise
from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.gear_parts import BasicRack, Body
from gearcad.geometry.inspection import Inspection, inspection_of
from gearcad.geometry.spline_inputs import HubInputs, ShaftInputs, SplineInputs
from gearcad.geometry.spline_standards import (
    B92_1,
    DIN5480,
    HUB,
    ISO4156,
    ROOTS,
    Proportions,
    SplineFit,
    SplineTolerances,
    deviation,
    form_tooth_height,
    proportions,
    read_fit,
    tolerances_of,
)

_RIM = 1.25
"""Outer diameter of a hub over that of its root circle where none is given."""


@dataclass(frozen=True, kw_only=True)
class Spline:
    """The splined shaft or hub of a joint: sizes, limits, gauges and the exact outline. Obtained as `joint.parts["shaft"]`."""

    joint: SplineInputs
    part: str

    __repr__ = concise

    @property
    def inputs(self) -> ShaftInputs | HubInputs:
        """Inputs of this part."""
        return self.joint.hub if self.is_hub else self.joint.shaft

    @property
    def is_hub(self) -> bool:
        """Whether this is the hub."""
        return self.part == HUB

    @property
    def designation(self) -> str:
        """Designation of the part in the manner of its standard, such as "DIN 5480 - W 30 x 1.25 x 22 x 8f"."""
        joint, fit = self.joint, "" if self.fit is None else f" x {self.fit}"
        if joint.basis == DIN5480:
            letter = "N" if self.is_hub else "W"
            return f"{joint.basis} - {letter} {joint.nominal_diameter:g} x {joint.module:g} x {joint.count}{fit}"
        word, root = "INT" if self.is_hub else "EXT", "P" if self.root == "flat" else "R"
        flank = f"{joint.pressure_angle:g}{root}{fit}"
        if joint.basis == ISO4156:
            return f"{joint.basis} - {word} {joint.count}z x {joint.module:g}m x {flank}"
        pitch = joint.diametral_pitch
        return f"{joint.basis} - {word} {joint.count}T x {pitch:g}/{2 * pitch:g}P x {flank}"

    def _said(self, key: str) -> str | None:
        """Return what the designation says of this part under a key."""
        said = self.joint.designated
        return None if said is None else said.parts.get(self.part, {}).get(key)

    @cached_property
    def root(self) -> str:
        """Word for the root."""
        words = ROOTS[self.joint.basis]
        said, given = self._said("root"), self.inputs.root
        if said and given and said != given:
            raise GeometryError("root", given, f"must be left out: the designation says {said}")
        usual = words[-1] if (self.is_hub and self.joint.basis == DIN5480) or self.joint.pressure_angle > 30 else words[0]
        word = given or said or usual
        if word not in words:
            raise ParameterError("root", word, f"must be one of {', '.join(words)} ({self.joint.basis})")
        return word

    @cached_property
    def fit(self) -> SplineFit | None:
        """Tolerance class; None without one, whose sizes are the basic ones."""
        said, given = self._said("fit"), self.inputs.fit
        if said and given and said != given:
            raise GeometryError("fit", given, f"must be left out: the designation says {said}")
        if given is None and said is not None:
            with _of_designation(self.joint):
                return read_fit(self.joint.basis, self.part, said)
        return None if given is None else read_fit(self.joint.basis, self.part, given)

    @cached_property
    def tolerances(self) -> SplineTolerances:
        """T_act and T_eff (µm): given ones, else those of the standard as far as they are known."""
        own, joint = self.inputs, self.joint
        if own.tolerance_actual is not None:
            return SplineTolerances(own.tolerance_actual, own.tolerance_effective)
        if self.fit is None:
            return SplineTolerances(None, None)
        return tolerances_of(
            joint.basis,
            self.fit,
            module=joint.module,
            teeth=joint.count,
            diameter=joint.nominal_diameter,
            thickness=joint.basic_thickness,
            length=joint.length,
        )

    # ------------------------------------------------------------------ diameters

    @cached_property
    def deviation(self) -> float:
        """Fundamental deviation A_s or A_e of the effective size (mm)."""
        if self.fit is None:
            return 0.0
        return deviation(self.joint.basis, self.part, self.fit, self.joint.nominal_diameter, self.tolerances) / 1000

    @property
    def _radial(self) -> float:
        """es_v/tan alpha (mm) of ISO 4156, by which the diameters of a shaft follow its fit; 0 in other standards."""
        of_shaft = self.joint.basis == ISO4156 and not self.is_hub
        return self.deviation / math.tan(math.radians(self.joint.pressure_angle)) if of_shaft else 0.0

    @cached_property
    def tip_diameter(self) -> float:
        """Diameter of the tips (mm): the major one of a shaft, the minor one of a hub."""
        joint = self.joint
        if joint.basis == DIN5480:
            return joint.nominal_diameter - (2.0 if self.is_hub else 0.2) * joint.module
        if joint.basis == ISO4156 and self.is_hub:
            return _iso_form_diameter(joint, 0.0) + 2 * self._clearance
        return joint.module * (joint.count + self._proportions.tip) + self._radial

    @cached_property
    def root_diameter(self) -> float:
        """Diameter of the roots (mm)."""
        joint = self.joint
        if joint.basis == DIN5480:
            depth = 2.4 if self.root == "rolled" else 2.2
            return joint.nominal_diameter - (0.0 if self.is_hub else depth) * joint.module
        return joint.module * (joint.count + self._proportions.root) + self._radial

    @property
    def root_radius(self) -> float:
        """Radius of the fillet, of a shaft that of the tool's tip (mm)."""
        if self.joint.basis != DIN5480:
            return self._proportions.radius * self.joint.module
        return (0.54 if self.root == "rolled" else 0.16) * self.joint.module

    @property
    def _proportions(self) -> Proportions:
        joint = self.joint
        major = joint.centring == "major"
        return proportions(
            joint.basis, self.part, joint.pressure_angle, self.root, pitch=joint.diametral_pitch, major_fit=major
        )

    @property
    def _clearance(self) -> float:
        return self.joint.form_clearance or 0.0

    @cached_property
    def form_limit(self) -> float | None:
        """Circle (mm) to which the involute must reach: of a shaft at most, of a hub at least; None if it is unknown."""
        joint = self.joint
        if joint.form_clearance is None:
            return None
        if joint.basis == DIN5480:
            mate = joint.nominal_diameter - (0.2 if self.is_hub else 2.0) * joint.module
            return mate + (2 if self.is_hub else -2) * joint.form_clearance
        if joint.basis == ISO4156 and not self.is_hub:
            return _iso_form_diameter(joint, self._radial)
        bound = joint.module * (joint.count + self._proportions.form)
        if joint.basis == B92_1 and joint.centring == "major" and self.is_hub:
            bound -= 0.004 * 25.4
        return bound + (2 if self.is_hub else -2) * joint.form_clearance

    @property
    def form_diameter(self) -> float:
        """Circle (mm) at which the involute of the outline ends in the fillet."""
        return abs(self.gear.form_diameter)

    # ------------------------------------------------------------------ thickness, or width of the space

    @property
    def basic_size(self) -> float:
        """Tooth thickness of the shaft, space width of the hub, without deviation (mm, on the reference circle)."""
        return self.joint.basic_thickness

    @property
    def _away(self) -> int:
        """Sign of the change of size that loosens the fit."""
        return 1 if self.is_hub else -1

    @property
    def effective_limit(self) -> float:
        """S_v max of a shaft, E_v min of a hub (mm): the mate's limit of play."""
        return self.basic_size + self.deviation

    @property
    def actual_limit(self) -> float | None:
        """S_max of a shaft, E_min of a hub (mm): the effective limit less or plus T_eff; None where that is unknown."""
        return self._loosened(self.tolerances.effective)

    @property
    def actual_other(self) -> float | None:
        """S_min of a shaft, E_max of a hub (mm); None where the tolerances are unknown."""
        actual, effective = self.tolerances
        return None if actual is None or effective is None else self._loosened(actual + effective)

    @property
    def effective_other(self) -> float | None:
        """S_v min of a shaft, E_v max of a hub (mm): the other actual limit, with T_eff used up."""
        return self._loosened(self.tolerances.actual)

    def _loosened(self, microns: float | None) -> float | None:
        return None if microns is None else self.effective_limit + self._away * microns / 1000

    @property
    def built_size(self) -> float:
        """Size of the solid (mm): the middle of the actual tolerance, or the effective limit where that is unknown."""
        one, other = self.actual_limit, self.actual_other
        return self.effective_limit if one is None or other is None else (one + other) / 2

    # ------------------------------------------------------------------ outline and gauges

    def gear_of(self, size: float) -> Gear:
        """Return the part as a gear (of a hub internal, with the signs of ISO 21771) whose teeth or spaces have a size (mm).

        Raises InputError where such teeth cannot be made.
        """
        return SplineTeeth(**self._gear_inputs(size), body=self._body, name=self.part)

    @cached_property
    def gear(self) -> Gear:
        """The part as a gear: see `gear_of` and `built_size`."""
        return self.gear_of(self.built_size)

    def _gear_inputs(self, size: float) -> JsonObject:
        """Return teeth by the shift that gives their thickness, and a tool that reaches the root circle."""
        joint, sign = self.joint, -1 if self.is_hub else 1
        module, angle = float(joint.module), float(joint.pressure_angle)
        more = (size - module * math.pi / 2) / (2 * module * math.tan(math.radians(angle)))
        depth = (joint.reference_diameter - self.root_diameter) / (2 * module) + more
        addendum = (self.tip_diameter - joint.reference_diameter) / (2 * module) - more
        rack = BasicRack(
            pressure_angle=angle,
            addendum=max(-addendum if self.is_hub else addendum, 0.05),
            dedendum=max(-depth if self.is_hub else depth, 0.05),
            root_radius=self.root_radius / module,
        )
        inputs = {"teeth": sign * int(joint.count), "normal_module": module, "face_width": float(joint.length), "rack": rack}
        diameters = {"tip_diameter": sign * self.tip_diameter, "root_diameter": sign * self.root_diameter}
        return {**inputs, "profile_shift": sign * more, **(diameters if self.is_hub else {"tip_diameter": self.tip_diameter})}

    @property
    def _body(self) -> Body:
        if not self.is_hub:
            return Body(bore=self.joint.shaft.bore)
        given = self.joint.hub.outer_diameter
        return Body(rim_diameter=_RIM * self.root_diameter if given is None else given)

    def inspection_of(self, size: float) -> Inspection:
        """Return the measuring of teeth or spaces of a size (mm) by gauges."""
        data = GearData(**self._gear_inputs(size))
        middle = self.joint.reference_diameter + 2 * self.joint.profile_shift * self.joint.module
        return inspection_of(data, -middle if self.is_hub else middle)

    @cached_property
    def pin_diameter(self) -> float:
        """Diameter of the pins (mm): given, or the one that touches near d + 2 x m, rounded to .05 mm."""
        if self.inputs.pin_diameter is not None:
            return self.inputs.pin_diameter
        suggested = self.inspection_of(self.basic_size).ball_diameter
        return round(round(suggested / _PIN_STEP) * _PIN_STEP, 2) if suggested > 2 * _PIN_STEP else suggested

    def over_pins(self, size: float | None) -> float | None:
        """Return the dimension over (shaft) or between (hub) two pins of teeth or spaces of a size (mm); None of no size."""
        if size is None:
            return None
        inspection = self.inspection_of(size)
        return inspection.between_pins(self.pin_diameter) if self.is_hub else inspection.over_pins(self.pin_diameter)  # type: ignore[attr-defined]

    @property
    def pin_factor(self) -> float:
        """Change of the dimension over or between pins with the size: p cos alpha/sin alpha_M, p = cos(90 deg/z) of odd z."""
        joint, inspection = self.joint, self.inspection_of(self.basic_size)
        circle = abs(inspection._ball_circle(self.pin_diameter))
        at = math.acos(joint.base_diameter / circle)
        across = math.cos(math.pi / (2 * joint.count)) if joint.count % 2 else 1.0
        return across * math.cos(math.radians(joint.pressure_angle)) / math.sin(at)

    @property
    def span_teeth(self) -> int | None:
        """Number of teeth spanned (of spaces in a hub): given, or the one that touches near d + 2 x m."""
        given = self.inputs.span_teeth
        return self.inspection_of(self.basic_size).spanned if given is None else given

    def span_measurement(self, size: float | None) -> float | None:
        """Return the base tangent length (mm) of teeth or spaces of a size (mm); None of no size."""
        count = self.span_teeth
        return None if size is None or count is None else self.inspection_of(size).span_measurement(count)

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """Notices about this part."""
        return tuple(self._found())

    def _found(self) -> Iterator[Notice]:
        if self.fit is None:
            yield Notice("no-fit", "no tolerance class: the sizes are the basic ones")
        elif self.tolerances.actual is None:
            text = f"the tolerances of {self.fit} ({self.joint.basis}) are not known here: give tolerance_actual and"
            yield Notice("unknown-tolerances", f"{text} tolerance_effective (µm); the solid has the effective limit")
        if self.is_hub and self.joint.hub.outer_diameter is None:
            yield Notice("assumed-rim", f"outer diameter of the hub {self.gear.body.rim_diameter:g} mm is assumed")
        limit = self.form_limit
        reached = limit is None or (self.form_diameter >= limit if self.is_hub else self.form_diameter <= limit)
        if not reached:
            text = f"the involute ends at diameter {self.form_diameter:.4f} mm, the standard asks for {limit:.4f} mm"
            yield Notice("short-involute", text)

    def to_dict(self) -> JsonObject:
        """Return sizes, limits and gauges under their names (mm; deviations in µm)."""
        joint, width = self.joint, "space_width" if self.is_hub else "tooth_thickness"
        tight, loose = ("min", "max") if self.is_hub else ("max", "min")
        pins = "between_pins" if self.is_hub else "over_pins"
        limit = "form_diameter_min" if self.is_hub else "form_diameter_max"
        return {
            "designation": self.designation,
            "teeth": joint.teeth,
            "module": joint.module,
            "pressure_angle": joint.pressure_angle,
            "fit": None if self.fit is None else str(self.fit),
            "root": self.root,
            "profile_shift": joint.profile_shift,
            "reference_diameter": joint.reference_diameter,
            "base_diameter": joint.base_diameter,
            "tip_diameter": self.tip_diameter,
            "root_diameter": self.root_diameter,
            "form_diameter": self.form_diameter,
            limit: self.form_limit,
            "root_radius": self.root_radius,
            "length": joint.length,
            width: self.basic_size,
            f"{width}_effective_{tight}": self.effective_limit,
            f"{width}_effective_{loose}": self.effective_other,
            f"{width}_actual_{tight}": self.actual_limit,
            f"{width}_actual_{loose}": self.actual_other,
            f"{width}_built": self.built_size,
            "deviation": 1000 * self.deviation,
            "tolerance_actual": self.tolerances.actual,
            "tolerance_effective": self.tolerances.effective,
            "pin_diameter": self.pin_diameter,
            pins: self.over_pins(self.basic_size),
            f"{pins}_{tight}": self.over_pins(self.actual_limit),
            f"{pins}_{loose}": self.over_pins(self.actual_other),
            "pin_factor": self.pin_factor,
            "span_teeth": self.span_teeth,
            "span_measurement": self.span_measurement(self.basic_size),
            f"span_measurement_{tight}": self.span_measurement(self.actual_limit),
            f"span_measurement_{loose}": self.span_measurement(self.actual_other),
            "bore" if not self.is_hub else "outer_diameter": (
                self.gear.body.rim_diameter if self.is_hub else self.gear.body.bore
            ),
            **notices_document(self.notices),
        }


@dataclass(frozen=True, kw_only=True)
class SplineTeeth(Gear):
    """The outline of a shaft or a hub as a gear, whose teeth may be fewer than those of a ring."""

    teeth: Annotated[int, Whole(6, 500, negative=(-6, "hub")), Words("number of teeth", "z")]


_PIN_STEP = 0.05
"""Step (mm) of the diameters of pins that are suggested."""


@contextmanager
def _of_designation(joint: SplineInputs) -> Iterator[None]:
    """Raise an error about a value that the designation says as one about the designation."""
    try:
        yield
    except ParameterError as error:
        raise ParameterError("designation", joint.designation, error.permitted) from None


def _iso_form_diameter(joint: SplineInputs, radial: float) -> float:
    """D_Fe max of ISO 4156 (mm), with es_v/tan alpha (mm) of the shaft."""
    sine = math.sin(math.radians(joint.pressure_angle))
    height = form_tooth_height(joint.pressure_angle, joint.module) - 0.5 * radial
    along = joint.reference_diameter / 2 * sine - height / sine
    return 2 * math.hypot(joint.base_diameter / 2, along)


def notices_document(notices: tuple[Notice, ...]) -> JsonObject:
    """Return notices as documents hold them: their texts as "warnings", and what they are made of."""
    return {"warnings": [each.text for each in notices], "notices": [each.to_dict() for each in notices]}
