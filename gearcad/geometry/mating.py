"""Checks that two gears can mesh: common sizes, centre distance, fitting teeth, and interference inside a ring.

Raises ParameterError or GeometryError, whose limits can be used as they are printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING

from gearcad.core.errors import GeometryError, InputError, ParameterError, at_least, at_most, format_number, require_name
from gearcad.core.quantities import is_given, require_fields
from gearcad.core.records import Notice, PerGear, Role
from gearcad.geometry.fits import LARGEST_DISTANCE, require_class
from gearcad.geometry.gear import Gear
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.interference import FilletCut, InterferenceMargins, InternalTips, ToothTips, internal_fillet_cut
from gearcad.geometry.involute import involute, tangent_length
from gearcad.geometry.pair_data import PairData, farthest_centre_distance, shift_sum_limit, zero_backlash_centre_distance
from gearcad.geometry.toothed import ToothedPart

if TYPE_CHECKING:
    from gearcad.geometry.profile import ToothProfile

ROUNDING = 1e-9
"""Overlap in normal modules, of flanks or of an edge and a fillet, that counts as rounding."""

_TIP_CLEARANCE = 1e-6
"""Clearance that a limit keeps from a tip that would just touch, in normal modules."""

_HALVINGS = 40
_COARSE_HALVINGS = 20

_SHORTER = 0.5
"""Largest reduction of a tip circle for its edge to clear a fillet, in normal modules of diameter."""

_MOST_STEPS = 400
"""Rings of more teeth that are looked at, to say which would do."""

_MOST_TRIALS = 4
"""Largest number of rings with enough room that are made as trials; some are not permitted for other reasons, such as their
rim.
"""


def internal_tips(pair: PairData, ring: ToothProfile | None = None) -> InternalTips:
    """Return the tips of both gears, or of another ring at their centre distance."""
    mate = ToothTips.of(pair.wheel.profile if ring is None else ring)
    return InternalTips(ToothTips.of(pair.pinion.profile), mate, -pair.centre_distance)


def interference_margins(pair: PairData) -> InterferenceMargins:
    """Return the margins (mm) of the pair against each kind of interference."""
    tips = internal_tips(pair)
    pinion, ring = (abs(tangent_length(gear.form_diameter, gear.base_diameter)) for gear in pair.gears)
    return InterferenceMargins(
        involute=tips.first,
        pinion_fillet=tips.first - pinion,
        wheel_fillet=ring - tips.tangent - tips.last,
        trochoid=tips.trochoid_margin,
        radial=tips.radial_margin,
    )


# ---------------------------------------------------------------------- what is refused


def check_interference(pair: PairData) -> None:
    """Raise GeometryError if tips interfere inside a ring.

    The ring's tip must stay off what the pinion has below its base circle, and both tips off each other beside the mesh.
    """
    tips = internal_tips(pair)
    if tips.first <= 0 and (cut := _fillet_cut(pair, Role.PINION)):
        limit = 2 * math.hypot(pair.wheel.base_diameter / 2, tips.tangent) - 2 * pair.wheel.body.tip_chamfer
        permitted = (
            f"must be {ring_tip_limit(pair) or f'below {at_most(-limit)}'} mm: involute interference, the tip reaches"
            f" {-tips.first:.4g} mm beyond the base tangent point T1 and cuts {cut.depth:.2g} mm into the pinion's"
            f" root{_clearing(pair, Role.WHEEL)}"
        )
        raise GeometryError("wheel.tip_diameter", pair.wheel.tip_diameter, permitted, "mm")
    if (margin := tips.trochoid_margin) < 0:
        raise _trochoid_interference(pair, -margin)


def ring_tip_limit(pair: PairData) -> str | None:
    """ "at most" the ring's tip diameter (mm) that fouls nothing of the pinion but perhaps its fillet; None if none does."""
    root, aside = -pair.centre_distance + pair.pinion.root_diameter / 2, _TIP_CLEARANCE * pair.pinion.normal_module

    def room(tips: InternalTips) -> float:
        return min(tips.first - aside, tips.trochoid_margin, tips.ring.edges[-1][0] - root - aside)

    limit = _shorter_tip(pair, room)
    return None if limit is None else f"at most {limit}"


def _trochoid_interference(pair: PairData, depth: float) -> GeometryError:
    """Return the error of trochoid interference, with the shorter tip or the number of teeth of the ring that would do."""
    why = f"trochoid interference, beside the mesh the tips interfere by {depth:.4g} mm"
    tip = _shorter_tip(pair, lambda tips: tips.trochoid_margin)
    teeth = _more_teeth(pair, lambda tips: tips.trochoid_margin)
    if tip is not None:
        other = "" if teeth is None else f"; or wheel.teeth at most {teeth}"
        return GeometryError("wheel.tip_diameter", pair.wheel.tip_diameter, f"must be at most {tip} mm: {why}{other}", "mm")
    if teeth is not None:
        return GeometryError("wheel.teeth", pair.wheel.teeth, f"must be at most {teeth}: {why}")
    permitted = f"must differ more from the pinion's {pair.pinion.teeth}: {why}"
    return GeometryError("wheel.teeth", pair.wheel.teeth, permitted)


def _shorter_tip(pair: PairData, margin: Callable[[InternalTips], float]) -> str | None:
    """Return the longest tip of the ring (its diameter in mm, as text) whose margin is not negative, flanks in contact all
    along.
    """
    profile, tips = pair.wheel.profile, internal_tips(pair)
    pitch = min(pair.pinion.transverse_base_pitch, tips.last - tips.first)
    reach = tips.tangent + tips.last - pitch
    longest = 2 * math.hypot(profile.base_diameter / 2, reach) - 2 * profile.tip_chamfer if reach > 0 else 0.0

    def fits(diameter: float) -> bool:
        try:
            return margin(internal_tips(pair, replace(profile, tip_diameter=diameter))) >= 0
        except GeometryError:
            return False

    low, high = profile.tip_diameter, longest
    if high <= low or not fits(high):
        return None
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if fits(middle) else (middle, high)
    limit = at_most(-high)
    return limit if _permitted(pair, lambda: replace(pair.wheel, tip_diameter=float(limit))) else None


def _more_teeth(pair: PairData, margin: Callable[[InternalTips], float]) -> int | None:
    """Return the nearest number of teeth of the ring, negative, whose margin is not;
    None where it could not be changed alone.
    """
    if is_given(pair.centre_distance) or is_given(pair.wheel.tip_diameter):
        return None
    clear = _is_clear(pair)
    more = range(pair.wheel.tooth_count + 1, pair.wheel.tooth_count + _MOST_STEPS)
    for teeth in islice(filter(partial(_has_room, pair, margin, clear), more), _MOST_TRIALS):
        alteration = _tip_alteration(pair, teeth, clear)
        if _permitted(pair, partial(replace, pair.wheel, teeth=-teeth, tip_alteration=alteration)):
            return -teeth
    return None


def _has_room(pair: PairData, margin: Callable[[InternalTips], float], clear: bool, teeth: int) -> bool:
    """Return whether a margin is not negative with so many teeth of the ring."""
    try:
        return margin(_sharp_tips(pair, teeth, _tip_alteration(pair, teeth, clear))) >= 0
    except (InputError, ValueError):  # no such pair, or a tip inside its base circle
        return False


def _sharp_tips(pair: PairData, teeth: int, tip_alteration: float) -> InternalTips:
    """Return the tips of the same pair with `teeth` teeth and another `tip_alteration` of the ring. Calculated by formula,
    without the ring's tip chamfers.
    """
    pinion, ring = pair.gears
    share = teeth / ring.tooth_count
    half_angle = ring.normal_tooth_thickness / (ring.normal_module * teeth) - involute(ring.transverse_pressure_angle)
    rise = ring.tip_diameter - ring.reference_diameter + 2 * ring.normal_module * (tip_alteration - ring.tip_alteration)
    tip = -(ring.reference_diameter * share + rise) / 2
    tips = ToothTips.sharp(teeth, -ring.base_diameter / 2 * share, half_angle, tip)
    return InternalTips(ToothTips.of(pinion.profile), tips, -_distance_with(pair, teeth))


def _distance_with(pair: PairData, teeth: int) -> float:
    """Return the centre distance (mm, negative) without backlash for another number of teeth of the ring."""
    return zero_backlash_centre_distance(
        normal_module=pair.wheel.normal_module,
        teeth=PerGear(pair.pinion.teeth, -teeth),
        helix_angle=pair.wheel.helix_angle,
        pressure_angle=pair.wheel.rack.pressure_angle,
        shift_sum=pair.profile_shift_sum,
    )


def _is_clear(pair: PairData) -> bool:
    """Return whether the ring's tip was drawn in just to stay off the pinion's fillet ("clear" in a spec): it follows the
    teeth.
    """
    if pair.wheel.tip_alteration >= 0 or (clear := clear_tip_diameter(pair)) is None:
        return False
    return abs(clear - pair.wheel.tip_diameter) <= _TIP_CLEARANCE * pair.wheel.normal_module


def _tip_alteration(pair: PairData, teeth: int, clear: bool) -> float:
    """k of the ring with another number of teeth: its own, or what is then clear. More teeth need less."""
    ring = pair.wheel
    if not clear:
        return ring.tip_alteration
    given = {each.name: getattr(ring, each.name) for each in fields(GearData)}
    other = GearData(**given | {"teeth": -teeth, "tip_alteration": 0.0})
    tip = tip_on_form_circle(other, pair.pinion, _distance_with(pair, teeth))
    drawn_in = 0.0 if tip is None else min((tip - other.standard_tip_diameter) / (2 * ring.normal_module), 0.0)
    return max(ring.tip_alteration, drawn_in)


def _permitted(pair: PairData, ring: Callable[[], Gear]) -> bool:
    """Return whether the pair is permitted with another ring."""
    try:
        replace(pair, wheel=ring())
    except InputError:
        return False
    return True


# ---------------------------------------------------------------------- what is told


def interference_notices(pair: PairData) -> Iterator[Notice]:
    """Tips that reach fillets, and pinions that cannot be put in along the line of centres."""
    for role in Role:
        if (cut := _fillet_cut(pair, role)) is not None:
            yield Notice("fillet-interference", f"fillet interference: {_fillet_text(pair, role, cut)}")
        elif _fillet_margin(pair, role) < -ROUNDING * pair.pinion.normal_module:
            form = f"{role.value}'s root form circle {pair.gears.pick(role).form_diameter:.4f} mm"
            yield Notice(
                "undercut-contact",
                f"undercut: contact ends at the {form}; the {role.mate.value}'s tip reaches beyond it without contact",
            )
    if (margin := internal_tips(pair).radial_margin) < 0:
        yield Notice("radial-assembly", f"radial assembly: {_radial_text(pair, -margin)}")


def _fillet_margin(pair: PairData, role: Role) -> float:
    """Return the roll length (mm) from the root form circle of a gear to the end of its mate's tip."""
    margins = interference_margins(pair)
    return margins.pinion_fillet if role is Role.PINION else margins.wheel_fillet


def _fillet_text(pair: PairData, role: Role, cut: FilletCut) -> str:
    """Return, in words, how the mate's tip cuts into the fillet of a gear, and which tip would not."""
    owner, other, gear, margin = role.value, role.mate.value, pair.gears.pick(role), _fillet_margin(pair, role)
    form = f"{'outside' if gear.internal else 'below'} its root form circle {gear.form_diameter:.4f} mm"
    if margin < -ROUNDING * pair.pinion.normal_module:
        roll = abs(tangent_length(gear.form_diameter, gear.base_diameter)) + (-margin if gear.internal else margin)
        reached = math.copysign(math.hypot(gear.base_diameter, 2 * max(roll, 0.0)), gear.teeth)
        text = (
            f"the {other}'s tip reaches diameter {reached:.4f} mm of the {owner}, {form}, and cuts {cut.depth:.2g} mm into it"
        )
    else:
        at = f"diameter {math.copysign(cut.diameter, gear.teeth):.4f} mm, {form}"
        text = f"the edge of the {other}'s tip cuts {cut.depth:.2g} mm into the {owner}'s fillet at {at}"
    return text + _clearing(pair, role.mate)


def _clearing(pair: PairData, role: Role) -> str:
    """Return the tip of a gear that clears its mate's fillet, for the end of a message."""
    limit = clear_tip_diameter(pair, role)
    return (
        ""
        if limit is None
        else f"; {role.value}.tip_diameter at most {at_most(limit)} mm clears the {role.mate.value}'s fillet"
    )


def _radial_text(pair: PairData, depth: float) -> str:
    text = f"moved in along the line of centres the pinion hits the ring's tips by {depth:.4g} mm: assemble it along the axis"
    if (teeth := _more_teeth(pair, lambda tips: tips.radial_margin)) is not None:
        return f"{text}; from wheel.teeth = {teeth} on it goes in either way"
    if (tip := _shorter_tip(pair, lambda tips: tips.radial_margin)) is not None:
        return f"{text}; with wheel.tip_diameter at most {tip} mm it goes in either way"
    return text


# ---------------------------------------------------------------------- tips that clear fillets


def clear_tip_diameter(pair: PairData, role: Role = Role.WHEEL) -> float | None:
    """Return the largest tip diameter (mm; negative of a ring) with which a gear stays off its mate's fillet; None where none
    does.

    Its flank ends on the mate's root form circle, or before, where its edge would still cut the fillet.
    """
    gear, mate = pair.gears.pick(role), pair.gears.pick(role.mate)
    longest = tip_on_form_circle(gear, mate, pair.centre_distance)
    if longest is None:
        return None

    def clears(diameter: float) -> bool:
        try:
            shortened = replace(gear.profile, tip_diameter=abs(diameter))
        except GeometryError:
            return False
        return _cut(mate.profile, shortened, pair) is None

    if clears(longest):
        return longest
    low, high = longest, longest - _SHORTER * gear.normal_module
    if not clears(high):
        return None
    for _ in range(_COARSE_HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if clears(middle) else (middle, high)
    return high


def tip_on_form_circle(gear: GearData, mate: Gear, centre_distance: float) -> float | None:
    """Tip diameter (mm, signed) of a gear whose flank ends on the root form circle of its mate; None where none does.

    |d_Fa2| = 2 sqrt(r_b2^2 + (|T1T2| + t_Ff1)^2) of a ring, d_Fa1 = 2 sqrt(r_b1^2 + (t_Ff2 - |T1T2|)^2) of a pinion.
    """
    bases = (gear.base_diameter + mate.base_diameter) / 2
    tangent = -math.sqrt(max((centre_distance - bases) * (centre_distance + bases), 0.0))
    reach = tangent - tangent_length(mate.form_diameter, mate.base_diameter)
    if reach * gear.teeth <= 0:
        return None
    return math.copysign(math.hypot(gear.base_diameter, 2 * reach), gear.teeth) + 2 * gear.body.tip_chamfer


def _fillet_cut(pair: PairData, role: Role) -> FilletCut | None:
    """Return the cut by the mate's tip into the fillet of a gear; None without one."""
    return _cut(pair.gears.pick(role).profile, pair.gears.pick(role.mate).profile, pair)


def _cut(own: ToothProfile, mate: ToothProfile, pair: PairData) -> FilletCut | None:
    rounding = ROUNDING * pair.pinion.normal_module
    return internal_fillet_cut(own, mate, centre_distance=-pair.centre_distance, rounding=rounding)


ROUNDING_OVERLAP = 1e-4
"""Overlap at the working circle, in normal modules, that comes from shifts printed to four digits: reported, not refused."""

SAME = 1e-9


def check_inputs(pair: PairData) -> None:
    """Raise ParameterError for an input that is not permitted by itself."""
    for role, gear in pair.gears.items():
        if not isinstance(gear, Gear):
            raise ParameterError(role.value, gear, "must be a Gear")
    require_fields(pair)
    if is_given(distance := pair.centre_distance) and distance * (pair.pinion.teeth + pair.wheel.teeth) <= 0:
        raise wrong_side(distance, ring=pair.internal)
    if pair.centre_distance_tolerance is not None:
        require_class(pair.centre_distance_tolerance)
    require_name("name", pair.name)


def wrong_side(distance: float, *, ring: bool) -> ParameterError:
    """Return the error for a centre distance (mm) that is 0 or has the wrong sign."""
    if not ring:
        return ParameterError("centre_distance", distance, "must be a number above 0 mm", "mm")
    write = f": write {format_number(-distance)}" if distance > 0 else ""
    return ParameterError("centre_distance", distance, f"must be a number below 0 mm with a ring (ISO 21771){write}", "mm")


def check_ring(teeth: PerGear[int]) -> None:
    """Raise GeometryError unless a ring, if there is one, is the wheel, and the pinion fits inside."""
    pinion, wheel = teeth
    if pinion < 0:
        raise GeometryError("pinion.teeth", pinion, "must be above 0: of an internal pair the ring is the wheel")
    if wheel < 0 and -wheel <= pinion:
        raise GeometryError("wheel.teeth", wheel, f"must be far below {-pinion}: the pinion stands inside the ring")


def check_mates(pair: PairData) -> None:
    """Raise GeometryError unless module, pressure angle and helix angle fit together, and the gears face each other."""
    pinion, wheel = pair.gears
    check_ring(pair.gears.map(lambda gear: gear.teeth))
    check_common("wheel", pinion, wheel)
    _check_halves(pair)
    hand, words = (1, "as on the pinion of an internal pair") if wheel.internal else (-1, "opposite to the pinion")
    check_hand("wheel", wheel, hand * pinion.helix_angle, words)
    if pair.common_width.width <= 0:
        most = at_most((pinion.face_width + wheel.face_width) / 2)
        permitted = f"must be between -{most} and {most} mm, for the gears to face each other"
        raise GeometryError("axial_offset", pair.axial_offset, permitted, "mm")


def check_common(mate: str, pinion: ToothedPart, other: ToothedPart) -> None:
    """Raise GeometryError unless module and pressure angle of a `mate`, wheel or rack, are those of its pinion."""
    for name, unit, own, given in (
        ("normal_module", "mm", pinion.normal_module, other.normal_module),
        ("rack.pressure_angle", "deg", pinion.rack.pressure_angle, other.rack.pressure_angle),
    ):
        if abs(own - given) > SAME:
            raise GeometryError(f"{mate}.{name}", given, f"must be {format_number(own)} {unit}, as on the pinion", unit)


def check_hand(mate: str, other: ToothedPart, helix_angle: float, words: str) -> None:
    """Raise GeometryError unless the helix angle of a `mate`, wheel or rack, is `helix_angle` (degrees), in `words`."""
    if abs(other.helix_angle - helix_angle) > SAME:
        permitted = f"must be {format_number(helix_angle)} deg, {words}"
        raise GeometryError(f"{mate}.helix_angle", other.helix_angle, permitted, "deg")


def _check_halves(pair: PairData) -> None:
    """Raise GeometryError unless both gears or neither are double helical, with equal offsets, and their halves face each
    other.
    """
    pinion, wheel = pair.gears.map(lambda gear: gear.double_helix)
    if pinion.present != wheel.present:
        permitted = "must be given for both gears of a double helical pair, or for neither"
        raise GeometryError("wheel.double_helix.gap_width", wheel.gap_width, permitted, "mm")
    if not pinion.present:
        return
    wanted = pinion.offset if pair.internal else -pinion.offset
    if abs((wheel.offset - wanted + 0.5) % 1 - 0.5) > SAME:
        permitted = f"must be {format_number(wanted)}, for both halves to mesh"
        raise GeometryError("wheel.double_helix.offset", wheel.offset, permitted)
    if pair.axial_offset:
        permitted = "must be 0 mm: double helical gears centre each other"
        raise GeometryError("axial_offset", pair.axial_offset, permitted, "mm")
    if pair.common_width.width <= 0:
        most = min(gear.face_width for gear in pair.gears)
        permitted = f"must be below {at_most(most)} mm, for the halves to face each other"
        role = max(pair.gears.items(), key=lambda item: item[1].double_helix.gap_width or 0.0)[0]
        raise GeometryError(
            f"{role.value}.double_helix.gap_width", pair.gears.pick(role).double_helix.gap_width, permitted, "mm"
        )


def check_shift_sum(pair: PairData) -> None:
    """Raise GeometryError if no centre distance is given and none meshes without backlash."""
    pinion, wheel = pair.gears
    limit = shift_sum_limit(
        teeth=pair.gears.map(lambda gear: gear.teeth),
        helix_angle=pinion.helix_angle,
        pressure_angle=pinion.rack.pressure_angle,
    )
    if (pair.profile_shift_sum - limit) * (-1 if pair.internal else 1) <= 0:
        most = limit - pinion.profile_shift
        side = f"below {at_most(most)}" if pair.internal else f"above {at_least(most)}"
        permitted = f"must be {side}: no centre distance meshes without backlash"
        raise GeometryError("wheel.profile_shift", wheel.profile_shift, permitted)


def check_centre_distance(pair: PairData) -> None:
    """Raise GeometryError unless the centre distance is beyond the one at which base circles touch."""
    least = (pair.pinion.base_diameter + pair.wheel.base_diameter) / 2
    if pair.internal:
        if pair.centre_distance >= least:
            permitted = f"must be below {at_most(min(least, _nearest_to_ring(pair)))} mm, where the base circles touch"
            raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")
        return
    if pair.centre_distance <= least:
        permitted = f"must be above {at_least(least)} mm, where the base circles touch"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def check_tolerance(pair: PairData) -> None:
    """Raise GeometryError if the tolerance of the centre distance lets base circles touch, or if ISO 286 does not define it."""
    if (name := pair.centre_distance_tolerance) is None:
        return
    if abs(pair.centre_distance) > LARGEST_DISTANCE:
        permitted = f"must be left out: ISO 286 has no tolerances above {LARGEST_DISTANCE:g} mm"
        raise GeometryError("centre_distance_tolerance", name, permitted)
    touching = abs(pair.pinion.base_diameter + pair.wheel.base_diameter) / 2
    if abs(pair.centre_distance) - pair.centre_distance_allowance / 1000 <= touching:
        permitted = f"must be finer: the axes could come within {at_most(touching)} mm, where the base circles touch"
        raise GeometryError("centre_distance_tolerance", name, permitted)


def check_teeth(pair: PairData) -> None:
    """Raise GeometryError if flanks overlap, tips touch roots or each other, or no path of contact is left between tips."""
    _check_backlash(pair)
    for role, clearance in pair.tip_clearances.items():
        if clearance <= 0:
            tip = pair.gears.pick(role).tip_diameter
            limit = f"below {tip + 2 * clearance:.6f}"
            if pair.internal and role is Role.WHEEL:
                limit = ring_tip_limit(pair) or limit
            permitted = f"must be {limit} mm: the tip reaches the {role.mate.value}'s root circle"
            raise GeometryError(f"{role.value}.tip_diameter", tip, permitted, "mm")
    if pair.internal:
        _check_path(pair)
        check_interference(pair)
        return
    farthest = farthest_centre_distance(
        pair.gears.map(lambda gear: gear.base_diameter), pair.gears.map(lambda gear: gear.tip_form_diameter)
    )
    if pair.centre_distance >= farthest:
        permitted = f"must be below {at_most(farthest)} mm, where the tips reach each other's flanks"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def _check_path(pair: PairData) -> None:
    """Raise GeometryError unless some path of contact is left in a ring: E beyond A, T1T2 < t_a1 + t_a2."""
    if pair.centre_distance >= (nearest := _nearest_to_ring(pair)):
        permitted = f"must be below {at_most(nearest)} mm, where the tips reach each other's flanks"
        raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")


def _nearest_to_ring(pair: PairData) -> float:
    """Return the centre distance (mm, negative) in a ring at which the path of contact vanishes;
    infinite where it never does.
    """
    reach = sum(tangent_length(gear.tip_form_diameter, gear.base_diameter) for gear in pair.gears)
    bases = sum(gear.base_diameter for gear in pair.gears) / 2
    return -math.hypot(bases, reach) if reach < 0 else math.inf


def _check_backlash(pair: PairData) -> None:
    backlash = pair.circumferential_backlash
    if backlash >= -ROUNDING_OVERLAP * pair.pinion.normal_module:
        return
    least = at_least(pair.centre_distance_for(pair.profile_shift_sum - pair.thinning_as_shift), digits=9)
    permitted = (
        f"must be at least {least} mm for these profile shifts and thinning, or the"
        f" shift sum at most {pair.fitting_shift_sum:.6f}: the backlash would be {backlash:.6f} mm"
    )
    raise GeometryError("centre_distance", pair.centre_distance, permitted, "mm")
