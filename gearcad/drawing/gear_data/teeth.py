"""What cuts and names the teeth of a gear: kind, module, number, basic rack, angles, profile shift, diameters."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.drawing.subject import DrawnGear
from gearcad.geometry import NAMED_RACKS, Gear, Rack
from gearcad.geometry.derived import is_given

__all__ = ["diameter_rows", "rack_rows", "teeth_rows"]

_SAME = 1e-9
"""Difference of coefficients that is rounding."""


def teeth_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[Row]:
    """What gears and racks are alike in."""
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
    yield write.plain("pressure_angle", part.rack.pressure_angle, "α_n", "°", "rack.pressure_angle")
    angle = abs(part.helix_angle)
    shown = write.words.number(angle, 4) if angle else "0"
    yield write.text("helix_angle", f"{shown}°", "β", {"helix_angle": part.helix_angle})
    if part.helix_angle:
        yield _hand(drawn, write)


def _double(part: Gear | Rack) -> bool:
    return isinstance(part, Gear) and part.double_helix.present


def _hand(drawn: DrawnGear, write: RowWriter) -> Row:
    """Right where the helix angle is positive; of two halves, of which the one at z = 0 has it, in the order of the section."""
    part = drawn.gear
    hands = [write.word("right"), write.word("left")][:: 1 if part.helix_angle > 0 else -1]
    if _double(part):
        return write.text("hand_of_halves", " / ".join(hands[:: drawn.direction]))
    return write.text("hand", hands[0])


def rack_rows(part: Gear | Rack, write: RowWriter) -> Iterator[Row]:
    """The basic rack by its name in ISO 53, else by its coefficients."""
    dedendum = part.dedendum if isinstance(part, Gear) else part.rack.dedendum
    own = abs(dedendum - part.rack.dedendum) < _SAME
    name = next((name for name, rack in NAMED_RACKS.items() if own and part.rack == rack), None)
    if name is not None:
        yield write.text("basic_rack", name.replace("ISO53_", "ISO 53 "))
        return
    yield write.plain("rack_addendum", part.rack.addendum, "h_aP*", name="rack.addendum")
    yield write.plain("rack_dedendum", dedendum, "h_fP*", name="rack.dedendum" if own else "dedendum")
    if part.rack.root_radius == "full":
        radius = part.root_radius
        text = f"{write.words.number(radius, 4)} ({write.word('full_radius')})"
        yield write.text("rack_root_radius", text, "ρ_fP*", {"root_radius": radius})
    else:
        yield write.plain("rack_root_radius", float(part.rack.root_radius), "ρ_fP*", name="rack.root_radius")


def diameter_rows(gear: Gear, write: RowWriter) -> Iterator[Row]:
    """Profile shift, reference, base and root circle, tip alteration, and where the involute begins."""
    shift = write.words.number(gear.profile_shift, 4, signed=True)
    sign = "profile_shift_of_ring" if gear.internal else "profile_shift"
    yield write.text(sign, shift, "x", {"profile_shift": gear.profile_shift})
    yield write.length("reference_diameter", gear.reference_diameter, "d")
    yield write.length("base_diameter", gear.base_diameter, "d_b")
    yield write.length("root_diameter", gear.root_diameter, "d_f")
    if gear.tip_alteration and not is_given(gear.tip_diameter):
        altered = write.words.number(gear.tip_alteration, 4, signed=True)
        yield write.text("tip_alteration", altered, "k", {"tip_alteration": gear.tip_alteration})
    yield write.length("undercut" if gear.undercut else "form_diameter", gear.form_diameter, "d_Ff", "form_diameter")
