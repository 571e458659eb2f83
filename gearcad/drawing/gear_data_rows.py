"""Rows of the gear data table in the order of DIN 3966-1 and ISO 1340."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from gearcad.core.errors import ParameterError
from gearcad.core.quantities import Range, is_given, symbols_of
from gearcad.core.records import Notice
from gearcad.drawing.drawing_subjects import DrawnGear, Mate, material_text, treatment_text
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.requirements import accuracy_grade_of, flank_roughness
from gearcad.drawing.words import SheetWords, kind_of, titled
from gearcad.geometry import NAMED_RACKS, FlankModification, Gear, Rack, RackPair, ReliefShape
from gearcad.geometry.gear_parts import HALF_PITCH
from gearcad.geometry.gear_tools import corner_radius, shaped, tool_pressure_angle
from gearcad.geometry.modification import TransitionSource
from gearcad.geometry.tool_shelf import ToolName
from gearcad.rating.tolerances import Accuracy, covered, gear_tolerances


@dataclass(frozen=True, kw_only=True)
class GearDataRow:
    """A row of the table: a quantity by its words, its symbol ("d_b" has an index) and its value as a text. Lengths are in mm.

    `limits` are the greatest and the least value (or allowance), one above the other behind the text, which may be empty.
    `numbers` are the unrounded values of the numbers in words, text and limits, by their keys in data.json. Keys of a pair
    begin with "pair.", those of the tolerances with "tolerances.". A ring's values are negative as there.
    """

    key: str
    words: str
    symbol: str = ""
    text: str = ""
    limits: tuple[str, str] | None = None
    numbers: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class RowWriter:
    """A writer of rows in the words of a language; lengths have `decimals` decimals. The words of a row are those of its
    key.
    """

    words: SheetWords
    decimals: int = 3

    def word(self, key: str) -> str:
        """Return the words of a key."""
        return self.words[f"data.{key}"]

    def text(
        self, key: str, text: str, symbol: str = "", numbers: Mapping[str, float] | None = None, **named: str
    ) -> GearDataRow:
        """Return a row with a text; the `named` values replace names in braces in its words."""
        return GearDataRow(key=key, words=self.word(key).format(**named), symbol=symbol, text=text, numbers=numbers or {})

    def length(self, key: str, value: float, symbol: str = "", name: str = "") -> GearDataRow:
        """Return the row of a length (mm), a ring's without its sign, under its name in data.json (else the key)."""
        return self.text(key, self.words.number(abs(value), self.decimals), symbol, {name or key: value})

    def plain(self, key: str, value: float, symbol: str = "", unit: str = "", name: str = "") -> GearDataRow:
        """Return the row of a number with no more digits than it has, at most six of them decimals."""
        return self.text(key, f"{self.words.shortest(value, 6)}{unit}", symbol, {name or key: value})

    def between(self, key: str, symbol: str, limits: Mapping[str, float], **named: str) -> GearDataRow:
        """Return the row of the greatest and the least length (mm), each under its name."""
        greatest, least = (self.words.number(value, self.decimals) for value in limits.values())
        words = self.word(key).format(**named)
        return GearDataRow(key=key, words=words, symbol=symbol, limits=(greatest, least), numbers=limits)


_SAME = 1e-9
"""Difference of coefficients that is rounding."""


def teeth_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows that gears and racks have in common: kind, module, teeth, basic rack, pressure angle, helix angle and
    hand.
    """
    part = drawn.gear
    helix = "double_helical" if _double(part) else "helical" if part.helix_angle else "spur"
    form = "rack" if isinstance(part, Rack) else "internal" if part.internal else "external"
    yield write.text("kind", f"{write.word(form)}, {write.word(helix)}")
    if is_given(part.normal_diametral_pitch):
        yield write.plain("normal_diametral_pitch", part.normal_diametral_pitch, "P_nd", " in⁻¹")
    yield write.plain("normal_module", part.normal_module, "m_n")
    assert part.teeth is not None  # derived by now
    yield write.text("teeth", write.words.number(part.teeth, 0), "z", {"teeth": part.teeth})
    yield from rack_rows(part, write)
    if named := tool_text(part):
        yield write.text("tool", named)
    yield write.plain("pressure_angle", part.rack.pressure_angle, "α_n", "°", "rack.pressure_angle")
    angle = abs(part.helix_angle)
    shown = write.words.number(angle, 4) if angle else "0"
    yield write.text("helix_angle", f"{shown}°", "β", {"helix_angle": part.helix_angle})
    if part.helix_angle:
        yield _hand(drawn, write)


def tool_text(part: Gear | Rack) -> str:
    """Return the name of the tool of the shelf that a gear has, with its table; "" without one."""
    name = part.tool if isinstance(part, Gear) else None
    return f"{name.tool.name} ({name.tool.file})" if isinstance(name, ToolName) and name.tool is not None else ""


def _double(part: Gear | Rack) -> bool:
    return isinstance(part, Gear) and part.double_helix.present


def _hand(drawn: DrawnGear, write: RowWriter) -> GearDataRow:
    """Return the row of the hand: right if the helix angle is positive. A double helical gear has two, in the order of the
    section; the half at z = 0 has the hand of the angle.
    """
    part = drawn.gear
    hands = [write.word("right"), write.word("left")][:: 1 if part.helix_angle > 0 else -1]
    if _double(part):
        return write.text("hand_of_halves", " / ".join(hands[:: drawn.direction]))
    return write.text("hand", hands[0])


def rack_rows(part: Gear | Rack, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of the basic rack: its name in ISO 53, else its coefficients."""
    dedendum = part.dedendum
    own = abs(dedendum - part.rack.dedendum) < _SAME
    name = next((name for name, rack in NAMED_RACKS.items() if own and part.rack == rack), None)
    if name is not None and not part.premachining.present:
        yield write.text("basic_rack", name.replace("ISO53_", "ISO 53 "))
        return
    yield write.plain("rack_addendum", part.rack.addendum, "h_aP*", name="rack.addendum")
    if part.premachining.present:  # the tool of its rows makes the root
        return
    yield write.plain("rack_dedendum", dedendum, "h_fP*", name="rack.dedendum" if own else "dedendum")
    if part.rack.root_radius == "full":
        radius = part.root_radius
        text = f"{write.words.number(radius, 4)} ({write.word('full_radius')})"
        yield write.text("rack_root_radius", text, "ρ_fP*", {"root_radius": radius})
    else:
        yield write.plain("rack_root_radius", float(part.rack.root_radius), "ρ_fP*", name="rack.root_radius")


def diameter_rows(gear: Gear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of profile shift, reference, base and root circle, tip alteration, and start of the involute."""
    shift = write.words.number(gear.profile_shift, 4, signed=True)
    sign = "profile_shift_of_ring" if gear.internal else "profile_shift"
    yield write.text(sign, shift, "x", {"profile_shift": gear.profile_shift})
    yield write.length("reference_diameter", gear.reference_diameter, "d")
    yield write.length("base_diameter", gear.base_diameter, "d_b")
    yield write.length("root_diameter", gear.root_diameter, "d_f")
    if gear.tip_alteration and not is_given(gear.tip_diameter):
        altered = write.words.number(gear.tip_alteration, 4, signed=True)
        yield write.text("tip_alteration", altered, "k", {"tip_alteration": gear.tip_alteration})
    plain = gear.undercut and not gear.premachining.present
    yield write.length("undercut" if plain else "form_diameter", gear.form_diameter, "d_Ff", "form_diameter")


_UNFIT = {
    "span_measurement": {"span-off-involute": "off_involute", "narrow-for-span": "narrow"},
    "over_balls": {"balls-off-involute": "off_involute"},
    "between_balls": {"balls-off-involute": "off_involute"},
    "over_pins": {"balls-off-involute": "off_involute", "narrow-for-pins": "narrow"},
}
"""Notices of a gear that a gauge does not fit, and the keys of the words for the reason."""


def thickness_rows(gear: Gear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of a gear's tooth thickness: allowance, thickness, span, and size over or between balls and pins."""
    allowance = gear.thickness_allowance
    if allowance is not None and gear.tooth_allowance is not None:
        bounds = {"thickness_limits.allowance_upper": allowance.upper, "thickness_limits.allowance_lower": allowance.lower}
        upper, lower = (f"{write.words.number(value, 0, signed=True)} µm" for value in bounds.values())
        yield GearDataRow(
            key="tooth_allowance",
            words=write.word("tooth_allowance"),
            symbol="A_sn",
            text=gear.tooth_allowance,
            limits=(upper, lower),
            numbers=bounds,
        )
    yield _gauge(gear, write, "normal_tooth_thickness", "s_n")
    if (count := gear.inspection.spanned) is not None:
        name = "span_spaces" if gear.internal else "span_teeth"
        row = _gauge(gear, write, "span_measurement", "W_k", words=name, k=str(count))
        yield replace(row, numbers={name: count} | dict(row.numbers))
    yield write.plain("ball_diameter", gear.ball_diameter, "D_M")
    name = "between_balls" if gear.internal else "over_balls"
    either = not gear.pin_axial_shift and not (gear.internal and gear.helix_angle)  # pins then find what balls do
    yield replace(_gauge(gear, write, name, "M_dK", words=f"{name}_or_pins" if either else name), key=name)
    if gear.pin_axial_shift:  # else it is that over balls
        yield _gauge(gear, write, "over_pins", "M_dR")


def _gauge(gear: Gear, write: RowWriter, name: str, symbol: str, *, words: str = "", **named: str) -> GearDataRow:
    """Return the row of a gauge's reading (mm): its limits, else the one value, else the reason why there is none."""
    key = words or name
    if (reason := _reason(gear, name)) is not None:
        return write.text(key, f"— ({write.word(reason)})", symbol, None, **named)
    limits = gear.thickness_limits
    if limits is None:
        value = getattr(gear, name)
        return write.text(key, write.words.number(value, write.decimals), symbol, {name: value}, **named)
    found = getattr(limits, name)
    if found is None:
        return write.text(key, f"— ({write.word('off_involute')})", symbol, None, **named)
    bounds = {f"thickness_limits.{name}_greatest": found.greatest, f"thickness_limits.{name}_least": found.least}
    return write.between(key, symbol, bounds, **named)


def _reason(gear: Gear, name: str) -> str | None:
    """Return the reason why a gauge does not fit a gear; None if it fits."""
    codes = {notice.code for notice in gear.notices}
    return next((reason for code, reason in _UNFIT.get(name, {}).items() if code in codes), None)


_TOLERANCES = {
    Accuracy.ISO_1995: {
        "single_pitch": ("f_pt", "f_pt"),
        "cumulative_pitch": ("F_p", "F_p"),
        "profile_total": ("F_alpha", "F_α"),
        "helix_total": ("F_beta", "F_β"),
        "runout": ("F_r", "F_r"),
    },
    Accuracy.ISO_2013: {
        "single_pitch": ("f_pT", "f_pT"),
        "cumulative_pitch": ("F_pT", "F_pT"),
        "profile_total": ("F_alphaT", "F_αT"),
        "helix_total": ("F_betaT", "F_βT"),
        "runout": ("F_rT", "F_rT"),
    },
}
"""Tolerances of the table: their keys in documents, and their symbols."""


def grade_row(drawn: DrawnGear, write: RowWriter) -> GearDataRow:
    """Return the row of accuracy grade, standard and year; a grade that was not given is marked as assumed."""
    grade = accuracy_grade_of(drawn)
    assumed = f" ({write.word('assumed')})" if drawn.grade is None else ""
    return write.text("accuracy", f"{grade}{assumed}", "", {"tolerances.grade": grade}, standard=drawn.accuracy.value)


def tolerance_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of the tolerances (µm) of pitch, profile, helix and run-out. Where the standard does not cover the gear,
    the row names the exceeded limit.
    """
    if not isinstance(drawn.gear, Gear):
        yield write.text("tolerances", f"— ({write.word('not_of_racks')})", standard=drawn.accuracy.value)
        return
    found = gear_tolerances(drawn.gear, accuracy_grade_of(drawn), drawn.accuracy)
    for name, (key, symbol) in _TOLERANCES[drawn.accuracy].items():
        try:
            value = getattr(found, name)
        except ParameterError as error:
            yield write.text(name, f"— ({_why(error, drawn.accuracy, write)})", symbol)
        else:
            yield write.text(name, f"{write.words.shortest(value, 1)} µm", symbol, {f"tolerances.{key}": value})


def tolerance_notices(drawn: DrawnGear) -> Iterator[Notice]:
    """Yield notices of an assumed grade and of missing tolerances."""
    if not isinstance(drawn.gear, Gear):
        said = f"{drawn.accuracy.value} is not for racks: the sheet has no tolerances of pitch, say them in notes"
        text = f"tolerances: {said}; roughness, flatness and parallelism are what goes with grade {accuracy_grade_of(drawn)}"
        yield Notice("rack-tolerances", text)
        return
    if drawn.grade is None:
        said = f"no grade is given; tolerances, run-out and roughness are those of grade {accuracy_grade_of(drawn)}"
        yield Notice("grade-assumed", f"accuracy: {said} of {drawn.accuracy.value}")
    for reason in gear_tolerances(drawn.gear, accuracy_grade_of(drawn), drawn.accuracy).to_dict()["not_covered"]:
        yield Notice("not-covered", f"tolerances: {drawn.accuracy.value} does not cover all: {reason}")


def _why(error: ParameterError, accuracy: Accuracy, write: RowWriter) -> str:
    """Return the exceeded limit of a standard as a text: "face width below 4 mm"."""
    permitted, size = covered(accuracy)[error.parameter], abs(error.value)
    below = permitted.least is not None and size < permitted.least
    unit = permitted.unit if isinstance(permitted, Range) else ""
    limit = permitted.least if below else permitted.most
    assert limit is not None  # it is past one of them
    text = f"{write.words.shortest(limit)} {unit}".replace(" deg", "°").rstrip()
    size_words = write.words.within_text(write.word(error.parameter))
    return write.word("below_limit" if below else "above_limit").format(size=size_words, limit=text)


_SYMBOLS = symbols_of(FlankModification)


def roughness_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of the roughness (µm) of flanks, and of roots if it is given."""
    flanks = flank_roughness(drawn)
    text = f"{flanks.text(write.words.shortest(flanks.value, 2))} µm"
    name = "flank_roughness" if flanks.given else "flank_roughness_of_grade"
    yield write.text("flank_roughness", text, "", {name: flanks.value})
    if isinstance(drawn.gear, Gear) and (root := drawn.gear.root_roughness) is not None:
        yield write.text("root_roughness", f"Rz {write.words.shortest(root, 2)} µm", "", {"root_roughness": root})


def modification_rows(gear: Gear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of the modifications in use: amount (µm), length of a relief and its transition (mm). A last row refers
    to the diagram.
    """
    used, transitions = gear.modification.in_use, gear.flank_form.transitions
    for name in (name for name in used if not name.endswith(("_length", "_shape", "_transition"))):
        text, numbers = f"{write.words.shortest(used[name], 2)} µm", {f"modification.{name}": used[name]}
        if (length := used.get(f"{name}_length")) is not None:
            text += f" / {write.words.shortest(length, 3)} mm"
            numbers[f"modification.{name}_length"] = length
            if used[f"{name}_shape"] == ReliefShape.PARABOLIC.value:
                text += f", {write.word('parabolic')}"
        yield write.text(name, text, _SYMBOLS[name].symbol, numbers)
        if (transition := transitions.get(name)) is not None:
            text = f"{write.words.shortest(transition.length, 3)} mm"
            if transition.source is not TransitionSource.GIVEN:
                text += f" ({write.word(transition.source.value)})"
            yield write.text(f"{name}_transition", text, "t", {f"modification.{name}_transition": transition.length})
    if used:
        yield write.text("modifications", write.word("see_diagram"))


def cutter_rows(gear: Gear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the row of the corner radius that makes the fillets of a shaped gear or a ring. Rows of the shaper cutter follow
    if there is one.
    """
    cutter = gear.root_cutter
    if shaped(gear):
        yield write.length("corner_radius", corner_radius(gear) * gear.normal_module, "ρ_a0")
    if cutter.teeth is None or gear.cutter_tip_diameter is None:
        return
    owner = "premachining.cutter_" if gear.premachining.present else "cutter."
    yield write.text("cutter_teeth", str(cutter.teeth), "z_0", {f"{owner}teeth": cutter.teeth})
    shift = write.words.number(cutter.profile_shift, 4, signed=True)
    yield write.text("cutter_profile_shift", shift, "x_0", {f"{owner}profile_shift": cutter.profile_shift})
    yield write.length("cutter_tip_diameter", gear.cutter_tip_diameter, "d_a0")


def premachining_rows(gear: Gear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of the tool that cuts before the flanks are finished, of the stock, and of gauges before finishing."""
    pre, before, module = gear.premachining, gear.precut, gear.normal_module
    if not pre.present:
        return
    yield from _tool_rows(gear, write)
    if pre.tool_pressure_angle is not None or pre.tool_module is not None:
        angle = tool_pressure_angle(gear)
        cut = module * math.cos(math.radians(gear.rack.pressure_angle)) / math.cos(math.radians(angle))
        text = f"{write.words.shortest(cut, 6)} mm / {write.words.shortest(angle, 4)}°"
        yield write.text("short_lead_tool", text, "m_0 / α_n0")
    yield _stock_row(gear, write)
    if (count := before.inspection.spanned) is not None and before.span_measurement is not None:
        numbers = {"premachining.precut.span_measurement": before.span_measurement}
        text = write.words.number(before.span_measurement, write.decimals)
        yield write.text("precut_span", text, "W_k", numbers, k=str(count))
    size = before.between_balls if gear.internal else before.over_balls
    if size is not None:
        name = "between_balls" if gear.internal else "over_balls"
        numbers = {"premachining.precut.ball_diameter": before.ball_diameter, f"premachining.precut.{name}": size}
        text = f"{write.words.number(size, write.decimals)} / {write.words.shortest(before.ball_diameter, 6)}"
        yield write.text(f"precut_{name}", text, "M_dK / D_M", numbers)


def _tool_rows(part: Gear | Rack, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of addendum, tip radius and protuberance of the tool that cuts before finishing."""
    pre, addendum = part.premachining, part.dedendum
    yield write.plain("tool_addendum", addendum, "h_aP0*", name="premachining.tool_addendum")
    yield write.plain("tool_tip_radius", part.root_radius, "ρ_aP0*", name="premachining.tool_tip_radius")
    if pre.protuberance_angle is not None:
        text = f"{write.words.shortest(pre.protuberance, 4)} mm / {write.words.shortest(pre.protuberance_angle, 4)}°"
        numbers = {"premachining.protuberance": pre.protuberance, "premachining.protuberance_angle": pre.protuberance_angle}
        yield write.text("protuberance", text, "p_rP0", numbers)


def _stock_row(part: Gear | Rack, write: RowWriter) -> GearDataRow:
    """Return the row of the stock on each flank and its tolerance (mm)."""
    stock = f"{write.words.shortest(part.stock, 4)}"
    if tolerance := part.premachining.stock_tolerance:
        stock += f" ± {write.words.shortest(tolerance, 4)}"
    return write.text("stock", f"{stock} mm", "q", {"premachining.stock": part.stock})


def rack_premachining_rows(rack: Rack, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of the tool that cuts the teeth of a rack before they are finished, and of the height over a pin then."""
    if not rack.premachining.present:
        return
    yield from _tool_rows(rack, write)
    yield _stock_row(rack, write)
    before = rack.precut
    if before.over_pin is not None:
        numbers = {"premachining.precut.pin_diameter": before.pin_diameter, "premachining.precut.over_pin": before.over_pin}
        text = f"{write.words.number(before.over_pin, write.decimals)} / {write.words.shortest(before.pin_diameter, 6)}"
        yield write.text("precut_over_pin", text, "M / D_M", numbers)


def chamfer_rows(part: Gear | Rack, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the row of the chamfer along the tip edges of every tooth (mm), if there is one."""
    name, height = ("tip_chamfer", part.tip_chamfer) if isinstance(part, Rack) else ("body.tip_chamfer", part.body.tip_chamfer)
    if height:
        yield write.text("tip_chamfer", f"{write.words.shortest(height)} × 45°", "h_K", {name: height})


def double_helix_rows(gear: Gear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the row of the offset between the halves' teeth: of the left half in the section to the right one.

    It is positive counter-clockwise as seen from the left. This is the direction of the upper half as seen from beyond it, or
    of the lower half as seen from below. Half a pitch is alike in both directions and has no sign.
    """
    if offset := gear.double_helix.offset:
        half = abs(offset) == HALF_PITCH
        shown = write.words.number(HALF_PITCH if half else offset, 4, signed=not half)
        yield write.text("half_offset", shown, "", {"double_helix.offset": offset})


def material_rows(drawn: DrawnGear, write: RowWriter, options: DrawingOptions) -> Iterator[GearDataRow]:
    """Yield the rows of material and heat treatment, as far as they are known."""
    for key, text in (
        ("material", material_text(drawn, options, write.words)),
        ("heat_treatment", treatment_text(drawn, options, write.words)),
    ):
        if text:
            yield write.text(key, text)


def mate_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of each mate: its distance (mm), and its teeth and number, or title. With several mates the keys begin
    with their names.

    A distance that is that of another mate too stands once.
    """
    seen: set[str] = set()
    for mate in drawn.mates:
        lead = f"{mate.name}." if len(drawn.mates) > 1 else ""
        distance = _distance(mate, write)
        if distance.text not in seen:
            yield _led(distance, lead)
        seen.add(distance.text)
        yield _led(_teeth(mate, write), lead)


def _led(row: GearDataRow, lead: str) -> GearDataRow:
    """Return a row with `lead` before its key and the keys of its numbers."""
    return replace(row, key=f"{lead}{row.key}", numbers={f"{lead}{key}": value for key, value in row.numbers.items()})


def _teeth(mate: Mate, write: RowWriter) -> GearDataRow:
    teeth = mate.gear.teeth
    assert teeth is not None  # a rack has counted its own
    name = mate.number or titled(write.words, kind_of(mate.name, mate.gear), mate.gear.name, mate.name)
    return write.text("mate", f"{write.words.number(teeth, 0)} / {name}", "z", {"mate.teeth": teeth})


def _distance(mate: Mate, write: RowWriter) -> GearDataRow:
    pair = mate.pair
    if isinstance(pair, RackPair):
        return write.length("mounting_distance", pair.mounting_distance, "H", "pair.mounting_distance")
    row = write.length("centre_distance", pair.centre_distance, "a", "pair.centre_distance")
    if pair.centre_distance_tolerance is None:
        return row
    allowance = pair.centre_distance_allowance
    text = f"{row.text} ±{write.words.shortest(allowance / 1000, 4)}"
    numbers = {**row.numbers, "pair.backlash_limits.centre_distance_allowance": allowance}
    return write.text("centre_distance", text, "a", numbers)


_SMALL_MODULE = 0.3
"""Module (mm) below which lengths have one more decimal."""


def gear_rows(drawn: DrawnGear, words: SheetWords, options: DrawingOptions | None = None) -> tuple[GearDataRow, ...]:
    """Return the rows of an external gear, a ring, a rack or a double helical gear; every key stands once.

    `options` are those that hold for it (`DrawingOptions.of_part`), in whose words material and heat treatment stand.
    """
    write = RowWriter(words, 4 if drawn.gear.normal_module < _SMALL_MODULE else 3)
    own = _rack(drawn, drawn.gear, write) if isinstance(drawn.gear, Rack) else _gear(drawn, drawn.gear, write)
    return (*own, *material_rows(drawn, write, options or DrawingOptions()))


def _gear(drawn: DrawnGear, gear: Gear, write: RowWriter) -> Iterator[GearDataRow]:
    yield from teeth_rows(drawn, write)
    yield from diameter_rows(gear, write)
    yield from double_helix_rows(gear, write)
    yield grade_row(drawn, write)
    yield from thickness_rows(gear, write)
    yield from mate_rows(drawn, write)
    yield from tolerance_rows(drawn, write)
    yield from roughness_rows(drawn, write)
    yield from modification_rows(gear, write)
    yield from premachining_rows(gear, write)
    yield from cutter_rows(gear, write)
    yield from chamfer_rows(gear, write)


def _rack(drawn: DrawnGear, rack: Rack, write: RowWriter) -> Iterator[GearDataRow]:
    yield from teeth_rows(drawn, write)
    yield write.length("normal_pitch", rack.normal_pitch, "p_n")
    if rack.helix_angle:
        yield write.length("transverse_pitch", rack.transverse_pitch, "p_t")
    yield write.length("reference_height", rack.height, "H_0", "height")
    yield write.length("tip_height", rack.tip_height, "h_a")
    yield write.length("root_depth", rack.root_depth, "h_f")
    yield write.length("normal_tooth_thickness", rack.normal_tooth_thickness, "s_n")
    yield write.plain("ball_diameter", rack.pin_diameter, "D_M", name="pin_diameter")
    if rack.over_pin is None:
        yield write.text("over_pin", f"— ({write.word('off_involute')})", "M")
    else:
        yield write.length("over_pin", rack.over_pin, "M")
    yield from mate_rows(drawn, write)
    yield from tolerance_rows(drawn, write)
    yield from roughness_rows(drawn, write)
    yield from rack_premachining_rows(rack, write)
    yield from chamfer_rows(rack, write)


def gear_notices(drawn: DrawnGear, options: DrawingOptions | None = None) -> tuple[Notice, ...]:
    """Return notices of assumed and missing values in the table."""
    return tuple(_notices(drawn, options or DrawingOptions()))


def _notices(drawn: DrawnGear, options: DrawingOptions) -> Iterator[Notice]:
    yield from tolerance_notices(drawn)
    if isinstance(drawn.gear, Gear) and drawn.gear.tooth_allowance is None:
        text = (
            "tooth thickness: thickness, span and size over balls have no limits: give tooth_allowance in the table of the "
            'gear (such as "cd25" in [pinion])'
        )
        yield Notice("no-thickness-limits", text)
    if not flank_roughness(drawn).given:
        text = (
            "roughness of the flanks: flank_roughness is not given; the Ra shown follows from the accuracy grade by a rule of "
            "this program: verify it"
        )
        yield Notice("roughness-of-grade", text)
    if not options.material and (drawn.material is None or options.material == ""):
        yield Notice("no-material", "material: none is given")
