"""Judge of geometry: outlines against the sweep of their tools, gauges on the points of outlines, and outlines that roll.

The outline judged is that of the unmodified teeth (`profile`): modifications are laid on it later, and diameters and gauges are
told of it. Of what the tool does not make - tip circle and tip chamfers - the outline is held against the inputs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gearcad.core.errors import GearcadError
from gearcad.core.quantities import is_given
from gearcad.core.records import Floats
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.geometry.gear_data import section_turn
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.outline_gauges import OutlineGauges, fine_chord
from gearcad.verification.rolled_outlines import RolledPair, rack_points
from gearcad.verification.tool_sweep import Hob, Shaper, counterpart_of, finishing_rack, root_radius, swept_distance, tool_of
from gearcad.verification.tool_teeth import Complexes, peak_of, rolled_half_angle

_CHORD = 5e-4
"""Chord error of the outline that the tool sweeps, in normal modules; its points are on the curves themselves."""

_OUTLINE = 1e-4
"""Distance (mm) of an outline from its tool that is permitted, beside rounding."""

_CIRCLE = 1e-6
"""Difference (mm) of the radius of a land, or distance from a chamfer, that is permitted, beside rounding."""

_ROUNDING = 1e-12
"""Rounding of a length, as a share of the radius."""

_GAUGE = 1e-4
"""Difference (mm) of what a gauge reads on an outline with a normal module of at most 10 mm."""

_BACKLASH = 5e-5
"""Difference (mm) of backlash between outlines with a normal module of at most 10 mm."""

_CONTACT_RATIO = 1e-4
"""Difference of contact ratios that is permitted."""

_SWEEP, _ROLLED, _GAUGED = "sweep of the tool", "rolled outlines", "gauges on the outline"


_TWO_TOOLS = "tool that cuts before finishing, and finishing"
"""Name of the judge of teeth that two tools make."""


def _judge(where: str, name: str) -> Judge:
    return Judge(ClaimSubject.GEOMETRY, VerificationLevel.FILES, where, name)


def _scale(module: float) -> float:
    """Return the factor on what is permitted: the chords of outlines grow with the module from 10 mm on."""
    return max(1.0, module / 10)


# ---------------------------------------------------------------------- gears


def judge_gear(gear: Gear, where: str, sections: int = 1) -> Iterator[Claim]:
    """Judge the outline of a gear in sections over its face width, and what gauges read on it."""
    yield from judge_outline(gear, where, sections)
    yield from judge_gauges(gear, where)


def judge_outline(gear: Gear, where: str, sections: int = 1) -> Iterator[Claim]:
    """Judge the outline of tooth 0 of a gear against the sweep of its tool, in sections over the face width."""
    judge = _judge(where, _SWEEP)
    points = _tooth(gear)
    permitted = _CIRCLE + _ROUNDING * float(np.abs(points).max())
    yield from _judge_circles(judge, gear, points, permitted)
    if gear.body.tip_chamfer:
        off = _off_chamfer(gear, points)
        yield judge.below("distance of the tip chamfers from 45° lines", 1e3 * off, 1e3 * permitted, "µm")
    tool, made = tool_of(gear), _made_by_tool(gear, points)
    heights = _heights(gear, sections)
    turned = section_turn(gear, heights)
    distances = np.stack([_swept(gear, tool, points, *each) for each in zip(heights, turned, strict=True)])
    if gear.premachining.present:
        finished = [_finished(gear, points, *each) for each in zip(heights, turned, strict=True)]
        distances = np.minimum(distances, np.stack(finished))
    trims = next((notice.text for notice in gear.notices if notice.code == "cutter-trims-tips"), "")
    over, inside = "distance of the outline from the tool at its nearest", "depth of the outline in the tool"
    permitted = _OUTLINE * _scale(gear.normal_module) + _ROUNDING * float(np.abs(points).max())
    away = np.where(made, distances, -np.inf)
    yield judge.below(
        f"{over} ({_tool_name(gear)})", 1e3 * float(away.max()), 1e3 * permitted, "µm", place=_place(points, heights, away)
    )
    if trims:
        yield judge.not_judged(inside, trims)
        return
    deep = -distances
    yield judge.below(inside, 1e3 * max(float(deep.max()), 0.0), 1e3 * permitted, "µm", place=_place(points, heights, deep))


def _tooth(gear: Gear) -> Complexes:
    """Return points (n,) of the outline of tooth 0, centred on the real axis."""
    x, y = gear.profile.points(_CHORD * gear.normal_module).T
    points: Complexes = x + 1j * y
    return points


def _judge_circles(judge: Judge, gear: Gear, points: Complexes, permitted: float) -> Iterator[Claim]:
    """Judge the radii of the lands against the inputs, and that the outline spans a pitch."""
    side = -1 if gear.internal else 1
    reference = gear.tooth_count * gear.normal_module / math.cos(math.radians(gear.helix_angle)) / 2
    tip = reference + side * gear.normal_module * (gear.rack.addendum + gear.profile_shift + gear.tip_alteration)
    if gear.premachining.topping is not None:
        tip = reference + gear.profile_shift * gear.normal_module + gear.premachining.topping
    root = root_radius(gear)
    radii = side * np.abs(points)
    for name, told, given, found, defined in (
        ("tip diameter", gear.tip_diameter, is_given(gear.tip_diameter), radii.max(), tip),
        ("root diameter", gear.root_diameter, is_given(gear.root_diameter), radii.min(), root),
    ):
        yield judge.near(f"{name} of the outline", told, 2 * float(found), 2 * permitted, "mm")
        if not given:
            yield judge.near(f"{name} by the inputs", told, 2 * side * defined, 2 * permitted, "mm")
    pitch, angles = 2 * math.pi / gear.tooth_count, np.angle(points[[0, -1]])
    gap = float(np.abs(angles - [-pitch / 2, pitch / 2]).max() * np.abs(points[0]))
    yield judge.below("gap between the outlines of neighbouring teeth", 1e3 * gap, 1e3 * permitted, "µm")


def _tip_form(gear: Gear) -> float:
    """Return the radius (mm) at which the flank ends by the inputs: the tip circle, or the chamfer before it."""
    tip = abs(gear.tip_diameter) / 2
    if gear.premachining.semi_topping.present:  # the ramp of the tool makes the chamfer
        return tip
    return tip + gear.body.tip_chamfer if gear.internal else tip - gear.body.tip_chamfer


def _made_by_tool(gear: Gear, points: Complexes) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Return which points (n,) the tool makes: all but those of tip land and chamfers."""
    side, end = (-1 if gear.internal else 1), _tip_form(gear)
    return side * np.abs(points) < side * end - 1e-9 * end


def _off_chamfer(gear: Gear, points: Complexes) -> float:
    """Return the greatest distance (mm) of a tip chamfer from its line at 45° to the radius through the end of the flank."""
    side, end = (-1 if gear.internal else 1), _tip_form(gear)
    folded = points.real + 1j * np.abs(points.imag)
    radii = side * np.abs(folded)
    start = folded[np.abs(radii - side * end).argmin()]
    below = radii < radii.max() - 1e-9 * end
    corner = folded[~below]
    chamfer = np.r_[folded[below & (radii >= side * end - 1e-9 * end)], corner[np.angle(corner).argmax()]]
    local = (chamfer - start) / (start / abs(start))
    away = abs(float(abs(start)) - end)  # where the flank ends
    return max(away, float(np.abs(side * local.real + local.imag).max()) / math.sqrt(2))


def _heights(gear: Gear, sections: int) -> Floats:
    """Return heights (sections,) in mm over the teeth, those of double helical gears in both halves."""
    share = (np.arange(sections) + 0.5) / sections
    if not gear.double_helix.present:
        return share * gear.face_width
    return np.where(np.arange(sections) % 2, gear.face_width - share * gear.half_width, share * gear.half_width)


def _swept(gear: Gear, tool: Hob | Shaper, points: Complexes, height: float, turned: float) -> Floats:
    """Return signed distances (n,) in mm of a tooth from the tool in the section at a height, where the program turns it.

    The tool has the helix of the half that the section is in, and begins at that half's outer end.
    """
    pitch, offset = 2 * math.pi / gear.tooth_count, 0.0
    if gear.double_helix.present and height > gear.face_width / 2:
        # The halves are mirror images, the upper one turned on: seen from its own end it has the helix of the lower one.
        height, offset = gear.face_width - height, pitch * gear.double_helix.offset
    own = turned - offset - tool.section(height).gear
    return swept_distance(tool, points * np.exp(1j * (pitch / 2 + own)), gear.normal_module, height)


def _finished(gear: Gear, points: Complexes, height: float, turned: float) -> Floats:
    """Return signed distances (n,) in mm from what finishes the flanks of a gear that another tool has cut before.

    A wheel that ends on a circle is a rack with its rounding; one that runs free ends where the flank is told to begin, and has
    no distance from points below. On a ring, and by a form wheel, the flank alone is held against the involute that a rack
    leaves.
    """
    end, finishing = gear.profile.form_diameter / 2, gear.finishing
    above = np.abs(points) * (-1 if gear.internal else 1) >= (end - 1e-9 * end) * (-1 if gear.internal else 1)
    if gear.internal:
        return np.where(above, _from_rolled_flank(gear, points), np.inf)
    if finishing.end_diameter is None or finishing.kind == "form":
        rack = finishing_rack(gear, end, 0.0)
        off: Floats = np.where(above, _swept(gear, rack, points, height, turned), np.inf)
        return off if finishing.end_diameter is None else np.minimum(off, _from_wheel_tip(gear, points))
    radius = finishing.wheel_tip_radius or 0.2 * gear.normal_module
    return _swept(gear, finishing_rack(gear, finishing.end_diameter / 2, radius), points, height, turned)


def _from_wheel_tip(gear: Gear, points: Complexes) -> Floats:
    """Return signed distances (n,) in mm from the rounded tip of a form wheel, a circle that touches the end of the flank."""
    end, radius = abs(gear.finishing.end_diameter or 0.0) / 2, gear.finishing.wheel_tip_radius or 0.2 * gear.normal_module
    m, cosine = gear.normal_module, math.cos(math.radians(gear.helix_angle))
    tangent = math.tan(math.radians(gear.rack.pressure_angle))
    thickness = m * (math.pi / 2 + 2 * gear.profile_shift * tangent) - gear.tooth_thinning
    near = end + np.linspace(0.0, 2.0, 5) * _WHEEL_STEP * m
    halves = rolled_half_angle(near, gear.teeth * m / cosine / 2, math.atan(tangent / cosine), thickness / cosine)
    flank = near * np.exp(1j * halves)
    along = flank @ np.array([-25.0, 48.0, -36.0, 16.0, -3.0])  # the first difference of fourth order
    centre = flank[0] + 1j * radius * along / abs(along)
    folded = points.real + 1j * np.abs(points.imag)
    away: Floats = np.abs(folded - centre) - radius
    return away


_WHEEL_STEP = 1e-3
"""Step of the radius, in normal modules, over which the direction of a flank is taken."""


def _from_rolled_flank(gear: Gear, points: Complexes) -> Floats:
    """Return distances (n,) in mm across the spaces of a ring from the flank that a rack leaves on its counterpart."""
    m, cosine = gear.normal_module, math.cos(math.radians(gear.helix_angle))
    tangent = math.tan(math.radians(gear.rack.pressure_angle))
    thickness = m * (math.pi / 2 + 2 * gear.profile_shift * tangent) - gear.tooth_thinning
    reference, radii = gear.tooth_count * m / cosine / 2, np.abs(points)
    space = rolled_half_angle(radii, reference, math.atan(tangent / cosine), (math.pi * m - thickness) / cosine)
    across: Floats = (math.pi / gear.tooth_count - np.abs(np.angle(points)) - space) * radii
    return across


def _tool_name(gear: Gear) -> str:
    if gear.premachining.present:
        return _TWO_TOOLS
    if gear.cutter.teeth is not None:
        return f"shaper cutter of {gear.cutter.teeth} teeth"
    return "counterpart of the ring" if gear.internal else "basic rack"


def _place(points: Complexes, heights: Floats, off: Floats) -> str:
    """Return in words where the greatest of the deviations (heights, points) is."""
    row, column = np.unravel_index(int(np.argmax(off)), off.shape)
    worst = points[column]
    angle = math.degrees(np.angle(worst))
    return f"at radius {abs(worst):.6g} mm, {angle:.4g}° from the middle of the tooth, z {heights[row]:.4g} mm"


# ---------------------------------------------------------------------- gauges


def judge_gauges(gear: Gear, where: str) -> Iterator[Claim]:
    """Judge span, and dimensions over or between balls and pins, by gauges that touch the points of the outline."""
    judge = _judge(where, _GAUGED)
    gauges = OutlineGauges.of(gear)
    permitted = _GAUGE * _scale(gear.normal_module)
    off = {notice.code: notice.text for notice in gear.notices}
    name = f"base tangent length over {gear.inspection.spanned} {gear.inspection.spanned_is}"
    if gear.inspection.spanned is None or gear.span_measurement is None:
        yield judge.not_judged("base tangent length", "none is told: a helical ring has no base tangent length")
    elif "span-off-involute" in off:
        yield judge.not_judged(name, off["span-off-involute"])
    else:
        height = 0.5 * gear.span_measurement * math.sin(math.radians(abs(gear.base_helix_angle)))
        measured = gauges.span(gear.inspection.spanned, height)
        yield judge.near(name, gear.span_measurement, measured, permitted, "mm")
    yield from _judge_balls(judge, gear, gauges, permitted, off.get("balls-off-involute", ""))


def _judge_balls(judge: Judge, gear: Gear, gauges: OutlineGauges, permitted: float, off: str) -> Iterator[Claim]:
    """Judge the dimensions over or between two balls, and over two pins; `off` is why they do not touch the flanks."""
    ball, word = gear.ball_diameter, "between" if gear.internal else "over"
    told = gear.between_balls if gear.internal else gear.over_balls
    if off or told is None:
        yield judge.not_judged(f"dimension {word} two balls of {ball:g} mm", off or "none is told")
        return
    circle = 2 * gauges.ball_centre(ball)
    rests = abs(abs(circle - abs(gear.root_diameter)) - ball) < permitted
    place = "the ball rests on the root circle, not on the flanks" if rests else ""
    # Two spaces as nearly opposite as there are: their middles are half a pitch off the diameter where z is odd.
    facing = math.cos(math.pi / (2 * gear.tooth_count)) if gear.tooth_count % 2 else 1.0
    size = -ball if gear.internal else ball
    between = circle * facing + size
    yield judge.near(f"dimension {word} two balls of {ball:g} mm", told, between, permitted, "mm", place=place)
    if gear.over_pins is None:
        if gear.between_pins is not None:
            name = f"dimension between two pins of {ball:g} mm"
            yield judge.near(name, gear.between_pins, between, permitted, "mm", place=place)
        return
    # A pin follows its helical space along the axis until it is opposite to the other.
    over = 2 * gauges.pin_centre(ball) + size if gear.helix_angle else between
    yield judge.near(f"dimension over two pins of {ball:g} mm", gear.over_pins, over, permitted, "mm", place=place)


# ---------------------------------------------------------------------- racks


def judge_rack(rack: Rack, where: str) -> Iterator[Claim]:
    """Judge the outline of a rack against its basic rack, and the height over a pin that rests in the outline."""
    judge = _judge(where, _TWO_TOOLS if rack.premachining.present else "basic rack")
    profile, m = rack.profile, rack.normal_module
    points = rack_points(profile, fine_chord(m))
    cosine = math.cos(math.radians(rack.helix_angle))
    pitch, tip = math.pi * m, m * (rack.rack.addendum + rack.tip_alteration)
    counterpart = counterpart_of(rack)
    name = "tools" if rack.premachining.present else "basic rack"
    permitted = _CIRCLE + _ROUNDING * pitch
    distances = counterpart.distance(points + pitch / cosine / 2)
    if rack.premachining.topping is not None:
        tip = rack.premachining.topping
    chamfered = rack.premachining.semi_topping.present  # the ramp of the tool makes the chamfer
    made = points.imag < tip - (0.0 if chamfered else rack.tip_chamfer) - 1e-9 * m
    off = np.where(made, np.abs(distances), np.maximum(-distances, 0.0))
    yield judge.below(f"distance of the outline from the {name}", 1e3 * float(off.max()), 1e3 * permitted, "µm")
    yield judge.near("tip height of the outline", rack.tip_height, float(points.imag.max()), permitted, "mm")
    yield judge.near("tip height by the inputs", rack.tip_height, tip, permitted, "mm")
    pin = rack.pin_diameter
    if rack.over_pin is None:
        yield judge.not_judged(f"height over a pin of {pin:g} mm", "none is told: the pin touches no flank")
        return
    # The pin rests on the points of a space square to the teeth, from above.
    across = (points.real + pitch / cosine / 2) * cosine
    inside = np.abs(across) <= pin / 2
    centre = peak_of(points.imag[inside] + np.sqrt(pin**2 / 4 - across[inside] ** 2))
    gauged = _judge(where, _GAUGED)
    over = rack.height + centre + pin / 2
    yield gauged.near(f"height over a pin of {pin:g} mm", rack.over_pin, over, _GAUGE * _scale(m), "mm")


# ---------------------------------------------------------------------- pairs


def judge_pair(pair: GearPair | RackPair, where: str) -> Iterator[Claim]:
    """Judge backlash, contact ratio, interference and centre distance of a pair by rolling the outlines on each other."""
    judge = _judge(where, _ROLLED)
    rolled, m = RolledPair.of(pair), pair.pinion.normal_module
    permitted = _BACKLASH * _scale(m)
    gaps = rolled.flank_gaps
    if gaps is None or pair.usable_contact_ratio <= 0:
        # Both must say so, or one of them is wrong.
        yield judge.near("usable contact ratio", pair.usable_contact_ratio, rolled.contact_ratios()[1], _CONTACT_RATIO)
        yield judge.not_judged(
            "backlash, contact ratio", "no flank reaches its mate's flank: teeth touch with edges and fillets"
        )
        return
    least = gaps.min(axis=0)
    backlash = float(least.sum())
    yield judge.near("circumferential backlash", pair.circumferential_backlash, backlash, permitted, "mm")
    normal = backlash * rolled.normal_share(_twist(pair))
    yield judge.near("normal backlash", pair.normal_backlash, normal, permitted, "mm")
    split = abs(float(least[0] - least[1]))
    yield judge.below("difference of the gaps on both sides of the teeth", 1e3 * split, 1e3 * permitted, "µm")
    spread = float(np.ptp(gaps, axis=0).max())
    yield judge.below("change of the gaps while flanks roll in contact", 1e3 * spread, 1e3 * permitted, "µm")
    yield from _judge_contact_ratios(judge, pair, rolled)
    yield from _judge_interference(judge, pair, rolled, least, permitted)
    if isinstance(pair, GearPair):
        yield from _judge_centre_distance(judge, pair)


def _twist(pair: GearPair | RackPair) -> float:
    """Return by how much (rad/mm or mm/mm) the teeth of the mate are turned or moved along z."""
    if isinstance(pair, RackPair):
        return math.tan(math.radians(pair.rack.helix_angle))
    wheel = pair.wheel
    reference = wheel.tooth_count * wheel.normal_module / math.cos(math.radians(wheel.helix_angle)) / 2
    return math.tan(math.radians(wheel.helix_angle)) / reference


def _judge_contact_ratios(judge: Judge, pair: GearPair | RackPair, rolled: RolledPair) -> Iterator[Claim]:
    tips, usable = rolled.contact_ratios()
    name = "transverse contact ratio"
    if tips is None:
        reason = "a tip ends beyond the other's flank, so that it touches nothing there; the usable contact ratio is judged"
        yield judge.not_judged(name, reason)
    else:
        yield judge.near(name, pair.transverse_contact_ratio, tips, _CONTACT_RATIO)
    if math.isnan(usable):
        yield judge.not_judged("usable contact ratio", "contact ends so near a base circle that the outlines do not show where")
        return
    yield judge.near("usable contact ratio", pair.usable_contact_ratio, usable, _CONTACT_RATIO)


def _judge_interference(
    judge: Judge, pair: GearPair | RackPair, rolled: RolledPair, least: Floats, permitted: float
) -> Iterator[Claim]:
    """Judge that nothing but the flanks touches first, or that a notice tells so."""
    name = "depth of tips in fillets with flanks touching"
    told = next((notice.text for notice in pair.notices if notice.code == "fillet-interference"), "")
    if told:
        yield judge.not_judged(name, told)
        return
    depth = max(float((least - rolled.gaps_over_roll()).max()), 0.0)
    yield judge.below(name, 1e3 * depth, 1e3 * permitted, "µm")


def _judge_centre_distance(judge: Judge, pair: GearPair) -> Iterator[Claim]:
    """Judge a centre distance that was not given: teeth that are not thinned have no backlash there."""
    name = "centre distance"
    if is_given(pair.centre_distance):
        yield judge.not_judged(name, "it is an input")
        return
    try:
        full = replace(pair, pinion=_unthinned(pair.pinion), wheel=_unthinned(pair.wheel), centre_distance=pair.centre_distance)
    except GearcadError as error:
        yield judge.not_judged(name, f"the teeth cannot be without thinning: {error}")
        return

    def backlash(distance: float) -> float:
        gaps = RolledPair.of(full, distance).flank_gaps
        return math.nan if gaps is None else float(gaps.min(axis=0).sum())

    m = pair.pinion.normal_module
    one, other = pair.centre_distance, pair.centre_distance + 0.001 * m
    at_one, at_other = backlash(one), backlash(other)
    for _ in range(2):
        if at_other == at_one:
            break
        one, other, at_one = other, other - at_other * (other - one) / (at_other - at_one), at_other
        at_other = backlash(other)
    yield judge.near(name, pair.centre_distance, other, 2 * _BACKLASH * _scale(m), "mm")


def _unthinned(gear: Gear) -> Gear:
    """Return the gear with its full tooth thickness, without a body that thicker teeth might not fit."""
    if not gear.tooth_thinning:
        return gear
    return replace(gear, tooth_thinning=0.0, tooth_allowance=None)
