"""Rows of the data table of a splined shaft or hub, with the fields of DIN 5480-1 (figure 6) and of ISO 4156-1."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gearcad.core.records import Notice
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.gear_data_rows import GearDataRow, RowWriter, material_rows
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.words import SheetWords
from gearcad.geometry.spline_part import Spline
from gearcad.geometry.spline_standards import DIN5480, HUB, SHAFT

_SMALL_MODULE = 0.3
"""Module (mm) below which lengths have one more decimal."""


class SplineWriter(RowWriter):
    """A writer of rows in the words of splines."""

    def word(self, key: str) -> str:
        """Return the words of a key."""
        return self.words[f"splines.{key}"]

    def absent(self, key: str, symbol: str = "", **named: str) -> GearDataRow:
        """Return the row of a value that nobody gave."""
        return self.text(key, f"— ({self.word('not_given')})", symbol, None, **named)

    def known(self, key: str, value: float | None, symbol: str, unit: str = "", name: str = "") -> GearDataRow:
        """Return the row of a number, or that it is not given."""
        return self.absent(key, symbol) if value is None else self.plain(key, value, symbol, unit, name)

    def limits(self, key: str, symbol: str, document: Mapping[str, float | None], name: str, **named: str) -> GearDataRow:
        """Return the row of the greatest and the least length (mm) under their names in data.json, or that they are not
        given.
        """
        found = {f"{name}_{end}": document[f"{name}_{end}"] for end in ("max", "min")}
        values = {each: value for each, value in found.items() if value is not None}
        return self.between(key, symbol, values, **named) if len(values) == 2 else self.absent(key, symbol, **named)


def spline_rows(drawn: DrawnGear, spline: Spline, words: SheetWords, options: DrawingOptions) -> tuple[GearDataRow, ...]:
    """Return the rows of a splined shaft or hub; every key stands once. Values that are not known have a dash."""
    write = SplineWriter(words, 4 if spline.joint.module < _SMALL_MODULE else 3)
    own = (*_teeth(spline, write), *_circles(spline, write), *_fit(spline, write), *_gauges(spline, write))
    return (*own, *material_rows(drawn, RowWriter(words), options))


def _teeth(spline: Spline, write: SplineWriter) -> Iterator[GearDataRow]:
    joint = spline.joint
    yield write.text("designation", spline.designation)
    mate = SHAFT if spline.is_hub else HUB
    named = mate in joint.named_parts
    yield write.text("mate", Spline(joint=joint, part=mate).designation) if named else write.absent("mate")
    yield write.plain("teeth", joint.count, "z")
    yield write.plain("module", joint.module, "m")
    yield write.plain("pressure_angle", joint.pressure_angle, "α", "°")
    yield write.text("root", write.word(spline.root))
    shift = write.words.number(joint.profile_shift * joint.module, write.decimals, signed=True)
    yield write.text("profile_shift", shift, "x·m", {"profile_shift": joint.profile_shift})


def _circles(spline: Spline, write: SplineWriter) -> Iterator[GearDataRow]:
    """Yield the rows of diameters; those of form circles are limits."""
    joint = spline.joint
    if joint.basis == DIN5480:
        yield write.plain("nominal_diameter", joint.nominal_diameter, "d_B")
    yield write.length("reference_diameter", joint.reference_diameter, "d")
    yield write.length("base_diameter", joint.base_diameter, "d_b")
    yield write.length("tip_diameter", spline.tip_diameter, "d_a")
    yield write.length("root_diameter", spline.root_diameter, "d_f")
    yield write.absent("circle_limits")
    key = "form_diameter_min" if spline.is_hub else "form_diameter_max"
    limit = spline.form_limit
    yield write.absent(key, "d_Ff") if limit is None else write.length(key, limit, "d_Ff")
    yield write.plain("root_radius", spline.root_radius, "ρ_f")


def _fit(spline: Spline, write: SplineWriter) -> Iterator[GearDataRow]:
    """Yield the rows of tolerance class, deviation, tolerances (µm), and effective and actual sizes (mm)."""
    letter, name = ("e", "space_width") if spline.is_hub else ("s", "tooth_thickness")
    document = spline.to_dict()
    yield write.absent("fit") if spline.fit is None else write.text("fit", str(spline.fit))
    yield write.plain("deviation", 1000 * spline.deviation, f"A_{letter}", " µm")
    yield write.known("tolerance_actual", spline.tolerances.actual, "T_act", " µm")
    yield write.known("tolerance_effective", spline.tolerances.effective, "T_eff", " µm")
    yield write.length(name, spline.basic_size, letter)
    yield write.limits(f"{name}_effective", f"{letter}_v", document, f"{name}_effective")
    yield write.limits(f"{name}_actual", letter, document, f"{name}_actual")
    tight, loose = ("min", "max") if spline.is_hub else ("max", "min")
    yield write.length("go_gauge", spline.effective_limit, f"{letter}_v", f"{name}_effective_{tight}")
    other = spline.actual_other
    key = "no_go_gauge"
    yield write.absent(key, letter) if other is None else write.length(key, other, letter, f"{name}_actual_{loose}")


def _gauges(spline: Spline, write: SplineWriter) -> Iterator[GearDataRow]:
    """Yield the rows of the dimension over or between pins, and of the span: of the basic size, and their limits."""
    document = spline.to_dict()
    pins, symbol = ("between_pins", "M_2") if spline.is_hub else ("over_pins", "M_1")
    yield write.plain("pin_diameter", spline.pin_diameter, "D_M")
    yield write.limits(pins, symbol, document, pins)
    yield write.length(f"{pins}_basic", document[pins], symbol, pins)
    if (count := spline.span_teeth) is not None and document["span_measurement"] is not None:
        key, k = ("span_spaces" if spline.is_hub else "span_teeth"), str(count)
        row = write.limits(key, "W_k", document, "span_measurement", k=k)
        yield row
        text = write.words.number(document["span_measurement"], write.decimals)
        yield write.text(f"{key}_basic", text, "W_k", {"span_measurement": document["span_measurement"]}, k=k)


def spline_notices(drawn: DrawnGear, spline: Spline, options: DrawingOptions) -> Iterator[Notice]:
    """Yield notices of values that the sheet of a spline cannot have."""
    yield from spline.notices
    if not options.material and (drawn.material is None or options.material == ""):
        yield Notice("no-material", "material: none is given")
