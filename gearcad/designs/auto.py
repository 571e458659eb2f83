""" "auto" in a pair's spec: profile shifts from the centre distance, tip alteration from the tip clearance."""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from typing import Any

from gearcad.errors import GeometryError, InputError, ParameterError, format_number
from gearcad.geometry import Gear, GearPair, ShiftSplit, profile_shift_sum, split_profile_shift, zero_backlash_centre_distance
from gearcad.per_gear import PerGear

__all__ = ["AUTO", "make_gears", "resolve_profile_shifts", "resolve_tip_alterations"]

AUTO = "auto"

_SAME = 1e-9
"""Difference of two modules or pressure angles that is rounding, as in GearPair."""

_FOLLOWING = ("profile_shift", "tip_alteration", "tip_diameter", "root_diameter")
"""What of a gear may follow from the centre distance."""

GearInputs = Mapping[str, Any]
"""Keyword arguments of Gear, where `profile_shift` and `tip_alteration` may still be "auto"."""


def resolve_profile_shifts(
    pinion: GearInputs, wheel: GearInputs, centre_distance: float | None, split: ShiftSplit | None
) -> tuple[float, float]:
    """Profile shifts (x_1, x_2) with each "auto" replaced.

    One "auto" takes the rest of the sum that meshes without backlash at `centre_distance` (mm; thinning then gives the
    backlash). Two share the sum by `split` (None: equal specific sliding). Raises GeometryError where no shift can do it,
    and ParameterError for a number that is not permitted whatever the shifts are; parameters are led by their gear.
    """
    shifts = [gear.get("profile_shift", 0.0) for gear in (pinion, wheel)]
    _require_sound_numbers(pinion, wheel)
    automatic = [shift == AUTO for shift in shifts]
    if split is not None and not all(automatic):
        raise GeometryError("profile_shift_split", split, 'needs profile_shift = "auto" on both gears')
    if not any(automatic):
        return shifts[0], shifts[1]
    if centre_distance is None:
        owner = "pinion" if automatic[0] else "wheel"
        raise GeometryError(f"{owner}.profile_shift", AUTO, "needs centre_distance in [pair]")
    if not _mate(pinion, wheel):
        return 0.0, 0.0  # GearPair refuses them, and says why
    total = profile_shift_sum(**_common(pinion, wheel), centre_distance=centre_distance)
    if all(automatic):
        return _shared(total, pinion, wheel, centre_distance, split or ShiftSplit.EQUAL_SPECIFIC_SLIDING)
    return (total - shifts[1], shifts[1]) if automatic[0] else (shifts[0], total - shifts[0])


def resolve_tip_alterations(
    pinion: GearInputs, wheel: GearInputs, shifts: tuple[float, float], centre_distance: float | None
) -> tuple[float, float]:
    """Tip alterations (k_1, k_2), in normal modules, with each "auto" (the default) replaced.

    k = (a - a_d)/m_n - (x_1 + x_2), never positive (DIN 3960). `centre_distance` None stands for the one without backlash.
    A gear whose tip diameter is given has none.
    """
    keeping = _clearance_keeping(pinion, wheel, sum(shifts), centre_distance) if _mate(pinion, wheel) else 0.0

    def of(gear: GearInputs) -> float:
        value: Any = gear.get("tip_alteration", AUTO)
        automatic = 0.0 if "tip_diameter" in gear else keeping
        return automatic if value == AUTO else float(value)

    return of(pinion), of(wheel)


def make_gears(
    gears: Mapping[str, GearInputs], automatic: Mapping[str, Container[str]], centre_distance: float | None
) -> dict[str, Gear]:
    """Both gears from their resolved inputs, of which `automatic` names those that stood as "auto".

    Raises InputError: of the gear, its parameter led by the gear, or of the centre distance (mm) if that is what made it fail.
    """
    made = {}
    for owner, inputs in gears.items():
        try:
            made[owner] = Gear(**inputs)
        except InputError as error:
            fault = error.within(owner)
            own = error.parameter in inputs and error.parameter not in automatic[owner]
            if centre_distance is None or own or error.parameter not in _FOLLOWING:
                raise fault from error
            raise _led_back(fault, gears, automatic, centre_distance) from error
    return made


def _led_back(
    fault: InputError,
    gears: Mapping[str, GearInputs],
    automatic: Mapping[str, Container[str]],
    centre_distance: float,
) -> InputError:
    """The fault of a gear as one of the centre distance (mm), if it is one: tips that are not shortened tell."""
    made = {}
    for each, inputs in gears.items():
        try:
            made[each] = Gear(**{**inputs, "tip_alteration": 0.0} if "tip_alteration" in automatic[each] else inputs)
        except InputError as error:
            if "profile_shift" not in automatic[each]:
                return error.within(each)
    try:
        if len(made) == len(gears):
            GearPair(pinion=made["pinion"], wheel=made["wheel"], centre_distance=centre_distance)
    except InputError as error:
        if error.parameter == "centre_distance":
            return error
    unit = f" {fault.unit}" if fault.unit else ""
    asked = sum(inputs["profile_shift"] for inputs in gears.values())
    shifted = any("profile_shift" in fields for fields in automatic.values())
    asks = f"asks for x1 + x2 = {asked:.6g} and " if shifted else ""
    makes = f"{asks}makes {fault.parameter} = {format_number(fault.value)}{unit}, which {fault.permitted}"
    return GeometryError("centre_distance", centre_distance, makes, "mm")


def _common(pinion: GearInputs, wheel: GearInputs) -> dict[str, Any]:
    return {
        "normal_module": pinion["normal_module"],
        "teeth": PerGear(pinion["teeth"], wheel["teeth"]),
        "helix_angle": pinion.get("helix_angle", 0.0),
        "pressure_angle": pinion["rack"].pressure_angle,
    }


def _mate(pinion: GearInputs, wheel: GearInputs) -> bool:
    sizes = [(gear["normal_module"], gear["rack"].pressure_angle) for gear in (pinion, wheel)]
    return all(abs(one - other) <= _SAME for one, other in zip(*sizes, strict=True))


def _require_sound_numbers(pinion: GearInputs, wheel: GearInputs) -> None:
    """Find single values out of range before any formula meets them; what depends on the shift is judged later."""
    for owner, gear in (("pinion", pinion), ("wheel", wheel)):
        trial = {name: value for name, value in gear.items() if name != "tip_diameter"}
        for automatic in ("profile_shift", "tip_alteration"):
            if trial.get(automatic) == AUTO:
                del trial[automatic]
        try:
            Gear(**trial)
        except ParameterError as error:
            raise error.within(owner) from error
        except GeometryError:
            continue


def _shared(
    total: float, pinion: GearInputs, wheel: GearInputs, centre_distance: float, split: ShiftSplit
) -> tuple[float, float]:
    """Split the shift sum; equal sliding looks at the tips, so their alteration and chamfer count."""
    if split is ShiftSplit.EQUAL_SPECIFIC_SLIDING:
        for owner, gear in (("pinion", pinion), ("wheel", wheel)):
            if "tip_diameter" in gear:
                permitted = "leaves no equal sliding to find: give the profile shifts, or another profile_shift_split"
                raise GeometryError(f"{owner}.tip_diameter", gear["tip_diameter"], permitted, "mm")
    altered = resolve_tip_alterations(pinion, wheel, (total, 0.0), centre_distance)
    rises = (
        gear["rack"].addendum + change - gear["body"].tip_chamfer / gear["normal_module"]
        for gear, change in zip((pinion, wheel), altered, strict=True)
    )
    addenda = PerGear(*rises)
    return split_profile_shift(total, split, **_common(pinion, wheel), centre_distance=centre_distance, addenda=addenda)


def _clearance_keeping(pinion: GearInputs, wheel: GearInputs, shift_sum: float, centre_distance: float | None) -> float:
    """k that keeps the rack's tip clearance at the given, or else the backlash-free, centre distance."""
    module: float = pinion["normal_module"]
    common = _common(pinion, wheel)
    if centre_distance is None:
        try:
            centre_distance = zero_backlash_centre_distance(**common, shift_sum=shift_sum)
        except GeometryError:
            return 0.0  # no such centre distance: GearPair says so
    reference: float = module * sum(common["teeth"]) / math.cos(math.radians(common["helix_angle"])) / 2
    return min((centre_distance - reference) / module - shift_sum, 0.0)
