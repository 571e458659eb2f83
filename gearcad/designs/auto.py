""" "auto" and "clear" in a pair's spec: profile shifts from the centre distance, tips from tip clearance or a fillet."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

from gearcad.errors import GeometryError, InputError, ParameterError, format_number
from gearcad.geometry import Gear, GearPair, ShiftSplit, profile_shift_sum, split_profile_shift, zero_backlash_centre_distance
from gearcad.geometry.diametral import module_of_pitch
from gearcad.geometry.feasibility import check_given
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.internal_mating import tip_on_form_circle
from gearcad.per_gear import PerGear, Role, naming

__all__ = [
    "AUTO",
    "CLEAR",
    "backlash_free_distance",
    "clear_tip_alteration",
    "make_gears",
    "module_of",
    "require_sound_numbers",
    "resolve_profile_shifts",
    "resolve_tip_alterations",
]

AUTO = "auto"

CLEAR = "clear"
"""Tip alteration of a ring whose tip stays off its pinion's fillet."""

_SAME = 1e-9
"""Difference of two modules or pressure angles that is rounding, as in GearPair."""

_FOLLOWING = ("profile_shift", "tip_alteration", "tip_diameter", "root_diameter")
"""What of a gear may follow from the centre distance."""

GearInputs = Mapping[str, Any]
"""Keyword arguments of a Gear, where `profile_shift` and `tip_alteration` may still be "auto"."""


def resolve_profile_shifts(
    gears: PerGear[GearInputs], centre_distance: float | None, split: ShiftSplit | None
) -> PerGear[float]:
    """Profile shifts x with each "auto" replaced.

    One "auto" takes the rest of the sum that meshes without backlash at `centre_distance` (mm; thinning then gives the
    backlash). Two share the sum by `split` (None: equal specific sliding). Raises GeometryError where no shift can do it,
    and ParameterError for a number that is not permitted whatever the shifts are; parameters are led by their gear.
    """
    shifts: PerGear[Any] = gears.map(lambda gear: gear.get("profile_shift", 0.0))
    for role, gear in gears.items():
        require_sound_numbers(gear, role.value)
    automatic = [role for role, shift in shifts.items() if shift == AUTO]
    if split is not None and len(automatic) < len(Role):
        raise GeometryError("profile_shift_split", split, 'needs profile_shift = "auto" on both gears')
    if not automatic:
        return shifts
    if centre_distance is None:
        raise GeometryError(f"{automatic[0].value}.profile_shift", AUTO, "needs centre_distance in [pair]")
    if not _mate(gears):
        return PerGear(0.0, 0.0)  # GearPair refuses them, and says why
    total = profile_shift_sum(**_sizes(gears), centre_distance=centre_distance)
    if len(automatic) == len(Role):
        return _shared(total, gears, centre_distance, split or ShiftSplit.EQUAL_SPECIFIC_SLIDING)
    return PerGear.each(lambda role: total - shifts.pick(role.mate) if role in automatic else shifts.pick(role))


def resolve_tip_alterations(gears: PerGear[GearInputs], shift_sum: float, centre_distance: float | None) -> PerGear[float]:
    """Tip alterations k, in normal modules, with each "auto" (the default) replaced.

    k = (a - a_d)/m_n - (x_1 + x_2), never positive (DIN 3960). `centre_distance` None stands for the one without backlash.
    A gear whose tip diameter is given has none.
    """
    keeping = _clearance_keeping(gears, shift_sum, centre_distance) if _mate(gears) else 0.0

    def of(gear: GearInputs) -> float:
        value: Any = gear.get("tip_alteration", AUTO)
        automatic = 0.0 if "tip_diameter" in gear else keeping
        return automatic if value in (AUTO, CLEAR) else float(value)

    return gears.map(of)


def backlash_free_distance(gears: PerGear[GearInputs], shift_sum: float) -> float:
    """Centre distance (mm) at which these gears would mesh without backlash; negative with a ring. Raises GeometryError."""
    return zero_backlash_centre_distance(**_sizes(gears), shift_sum=shift_sum)


def clear_tip_alteration(gears: PerGear[GearInputs], centre_distance: float | None) -> float:
    """Tip alteration k of the ring, in normal modules, that ends its flank on the pinion's root form circle; never positive.

    The gears are resolved but for it. Raises InputError of the pinion, its parameter led by it.
    """
    with naming(Role.PINION):
        pinion = Gear(**gears.pinion)
    ring = GearData(**{**gears.wheel, "normal_module": module_of(gears.wheel), "tip_alteration": 0.0})
    if centre_distance is None:
        shift_sum = sum(gears.map(lambda gear: gear["profile_shift"]))
        try:
            centre_distance = zero_backlash_centre_distance(**_sizes(gears), shift_sum=shift_sum)
        except GeometryError:
            return 0.0  # no such centre distance: GearPair says so
    tip = tip_on_form_circle(ring, pinion, centre_distance)
    return 0.0 if tip is None else min((tip - ring.standard_tip_diameter) / (2 * ring.normal_module), 0.0)


def make_gears(gears: PerGear[GearInputs], automatic: PerGear[Collection[str]], centre_distance: float | None) -> PerGear[Gear]:
    """Both gears from their resolved inputs, of which `automatic` names those that stood as "auto".

    Raises InputError: of the gear, its parameter led by the gear, or of the centre distance (mm) if that is what made it fail.
    """

    def made(role: Role) -> Gear:
        inputs = gears.pick(role)
        try:
            return Gear(**inputs)
        except InputError as error:
            own = error.parameter in inputs and error.parameter not in automatic.pick(role)
            if centre_distance is None or own or error.parameter not in _FOLLOWING:
                raise error.within(role.value) from error
            raise _led_back(error.within(role.value), gears, automatic, centre_distance) from error

    return PerGear(*map(made, Role))


def _led_back(
    fault: InputError, gears: PerGear[GearInputs], automatic: PerGear[Collection[str]], centre_distance: float
) -> InputError:
    """The fault of a gear as one of the centre distance (mm), if it is one: tips that are not shortened tell."""
    made = []
    for role, inputs in gears.items():
        unshortened = {"tip_alteration": 0.0} if "tip_alteration" in automatic.pick(role) else {}
        try:
            made.append(Gear(**{**inputs, **unshortened}))
        except InputError as error:
            if "profile_shift" not in automatic.pick(role):
                return error.within(role.value)
    try:
        if len(made) == len(Role):
            pinion, wheel = made
            GearPair(pinion=pinion, wheel=wheel, centre_distance=centre_distance)
    except InputError as error:
        if error.parameter == "centre_distance":
            return error
    unit = f" {fault.unit}" if fault.unit else ""
    asked = sum(gears.map(lambda inputs: inputs["profile_shift"]))
    asks = f"asks for x1 + x2 = {asked:.6g} and " if any("profile_shift" in names for names in automatic) else ""
    makes = f"{asks}makes {fault.parameter} = {format_number(fault.value)}{unit}, which {fault.permitted}"
    return GeometryError("centre_distance", centre_distance, makes, "mm")


def _sizes(gears: PerGear[GearInputs]) -> dict[str, Any]:
    """What the formulas of profile shift and centre distance want to know of both gears, as GearPair has it."""
    return {
        "normal_module": module_of(gears.pinion),
        "teeth": gears.map(lambda gear: gear["teeth"]),
        "helix_angle": gears.pinion.get("helix_angle", 0.0),
        "pressure_angle": gears.pinion["rack"].pressure_angle,
    }


def module_of(gear: GearInputs) -> float:
    """The normal module, given itself or as a diametral pitch."""
    module: float | None = gear.get("normal_module")
    return module_of_pitch(gear["normal_diametral_pitch"]) if module is None else module


def _mate(gears: PerGear[GearInputs]) -> bool:
    """Whether both have one module and one pressure angle."""
    pinion, wheel = gears.map(lambda gear: (module_of(gear), gear["rack"].pressure_angle))
    return all(abs(one - other) <= _SAME for one, other in zip(pinion, wheel, strict=True))


def require_sound_numbers(gear: GearInputs, owner: str) -> None:
    """Find single values out of range before any formula meets them; what depends on the shift is judged later.

    Raises ParameterError, led by the owner.
    """
    trial = {name: value for name, value in gear.items() if name != "tip_diameter"}
    for automatic in ("profile_shift", "tip_alteration"):
        if trial.get(automatic) in (AUTO, CLEAR):
            del trial[automatic]
    try:
        check_given(GearData(**trial))
    except ParameterError as error:
        raise error.within(owner) from error
    except GeometryError:
        return


def _shared(total: float, gears: PerGear[GearInputs], centre_distance: float, split: ShiftSplit) -> PerGear[float]:
    """Split the shift sum; equal sliding looks at the tips, so their alteration and chamfer count."""
    if split is ShiftSplit.EQUAL_SPECIFIC_SLIDING:
        for role, gear in gears.items():
            if "tip_diameter" in gear:
                permitted = "leaves no equal sliding to find: give the profile shifts, or another profile_shift_split"
                raise GeometryError(f"{role.value}.tip_diameter", gear["tip_diameter"], permitted, "mm")
    altered = resolve_tip_alterations(gears, total, centre_distance)

    def addendum(role: Role) -> float:
        gear = gears.pick(role)
        return float(gear["rack"].addendum + altered.pick(role) - gear["body"].tip_chamfer / module_of(gear))

    addenda = PerGear.each(addendum)
    return split_profile_shift(total, split, **_sizes(gears), centre_distance=centre_distance, addenda=addenda)


def _clearance_keeping(gears: PerGear[GearInputs], shift_sum: float, centre_distance: float | None) -> float:
    """k that keeps the rack's tip clearance at the given, or else the backlash-free, centre distance."""
    sizes = _sizes(gears)
    if gears.wheel["teeth"] < 0:
        return 0.0  # as of PairData.tip_alteration
    module: float = sizes["normal_module"]
    if centre_distance is None:
        try:
            centre_distance = zero_backlash_centre_distance(**sizes, shift_sum=shift_sum)
        except GeometryError:
            return 0.0  # no such centre distance: GearPair says so
    reference: float = module * sum(sizes["teeth"]) / math.cos(math.radians(sizes["helix_angle"])) / 2
    return min((centre_distance - reference) / module - shift_sum, 0.0)
