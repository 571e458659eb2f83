"""Options of a search for sizes: what each stands for in the task, and the task that they make.

The command `size` has an option for each, and the page a field.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad.core.errors import ParameterError, require_number

if TYPE_CHECKING:
    from gearcad.core.quantities import FieldSchema
    from gearcad.load import Load
    from gearcad.material import Material
    from gearcad.rating.options import RatingOptions
    from gearcad.sizing import SizeTask


class SizeOption(NamedTuple):
    """An option of a search for pairs: its name, the type of its value, what stands for the value, and help.

    `field` is the table and the name of the field of the task that the option sets; "" for none.
    """

    name: str
    type: type
    metavar: str
    help: str
    field: str = ""


SIZE_OPTIONS = (
    SizeOption("torque", float, "NM", "Pairs: on the pinion; or --power, of which it follows.", "load.torque"),
    SizeOption("power", float, "KW", "In place of the torque, at the speed.", ""),
    SizeOption("speed", float, "RPM", "Of the pinion.", "load.speed"),
    SizeOption("ratio", float, "U", "Teeth of the wheel over those of the pinion, 1 to 20.", "task.ratio"),
    SizeOption("ratio_tolerance", float, "%", "Most deviation of the ratio.  [default: 2]", "task.ratio_tolerance"),
    SizeOption("life", float, "H", "In operation.  [default: endurance limit]", "rating.life"),
    SizeOption("application_factor", float, "K_A", "[default: 1]", "load.application_factor"),
    SizeOption("material", str, "NAME", 'A group and a quality of ISO 6336-5, such as "Eh MQ".', "material.name"),
    SizeOption("hardness", float, "H", "HV, of iron and St HBW; groups such as V need it.", "material.hardness"),
    SizeOption("wheel_material", str, "NAME", "[default: that of the pinion]", "material.name"),
    SizeOption("wheel_hardness", float, "H", "[default: that of the pinion, of the same material]", "material.hardness"),
    SizeOption("grade", int, "Q", "Accuracy grade of ISO 1328-1:1995.  [default: 6]", "rating.accuracy_grade"),
    SizeOption("safety_flank", float, "S", "Required S_H.  [default: 1]", "rating.required_safety_flank"),
    SizeOption("safety_root", float, "S", "Required S_F.  [default: 1.4]", "rating.required_safety_root"),
    SizeOption(
        "safety_scuffing", float, "S", "Required; needs --rating scuffing_stage=... too.", "rating.required_safety_scuffing"
    ),
    SizeOption("centre_distance", float, "MM", "[default: that of the shift sums, in round figures]", "task.centre_distance"),
    SizeOption("teeth", str, "Z:Z", "Of the pinion.  [default: 14:40]", "task.teeth"),
    SizeOption("module", str, "MM", "2,2.5,3; or 1:10, those of ISO 54 series I within.  [default: 1:10]", "task.modules"),
    SizeOption("helix_angle", str, "DEG", "[default: 0,8:24:2]", "task.helix_angles"),
    SizeOption(
        "width_ratio",
        str,
        "B/D1",
        "Face width over the pinion's reference diameter.  [default: 0.3:1.2:0.1]",
        "task.width_ratios",
    ),
    SizeOption("shift", str, "X", "Profile shift of the pinion.  [default: 0:0.7:0.1]", "task.shifts"),
    SizeOption(
        "shift_sum", str, "X", "Of both, about, where no centre distance is given.  [default: 0:1:0.25]", "task.shift_sums"
    ),
    SizeOption("max_diameter", float, "MM", "Of any tip circle.", "task.max_diameter"),
    SizeOption("max_mass", float, "KG", "Of both gears.  [default: 1.5 of the lightest, with --by]", "task.max_mass"),
    SizeOption("max_width", float, "B/M", "Face width over module.  [default: 30]", "task.max_width_in_modules"),
    SizeOption("contact_ratio", float, "EPS", "Least transverse.  [default: 1.2]", "task.least_contact_ratio"),
    SizeOption("tip_thickness", float, "S/M", "Least, in modules.  [default: 0.2; Eh 0.4]", "task.least_tip_thickness"),
    SizeOption("rack", str, "NAME", "A, B, C or D of ISO 53.  [default: A]", "task.rack"),
    SizeOption("tool", str, "NAME", "A hob of the shelf in place of the rack (gearcad tools).", "task.tool"),
    SizeOption(
        "by", str, "CRITERION", "mass, safety, quiet, sliding, scuffing or efficiency.  [default: mass]", "task.criterion"
    ),
    SizeOption(
        "friction",
        str,
        "MU",
        "Of the flanks: a coefficient, integral or niemann.  [default: integral, with --by efficiency]",
        "task.friction",
    ),
)
"""The options of a search for pairs, in the order of use."""


_RANGES = ("helix_angle", "width_ratio", "shift", "shift_sum")
"""Options whose texts are several numbers."""

_PLAIN = (
    "ratio",
    "ratio_tolerance",
    "centre_distance",
    "max_diameter",
    "max_mass",
    "max_width",
    "contact_ratio",
    "tip_thickness",
)
"""Options whose numbers are fields of the task as they are."""

_FIELDS = {option.name: option.field.rpartition(".")[2] for option in SIZE_OPTIONS}
_OF_RATING = tuple(option.name for option in SIZE_OPTIONS if option.field.startswith("rating."))
_CALLED = {_FIELDS[option.name]: option.name for option in SIZE_OPTIONS if option.field.startswith(("task.", "rating."))}
"""Options by the fields that they set, for messages."""

_MOST_VALUES = 1000
_KILOWATTS = 30_000 / math.pi
"""Torque (N·m) of 1 kW at 1 rpm."""


@cache
def option_fields() -> Mapping[str, FieldSchema]:
    """Return the field of the task that each option sets, by the name of the option, for its words, unit and range."""
    from gearcad.core.quantities import schema_of
    from gearcad.load import Load
    from gearcad.material import Material
    from gearcad.rating.options import RatingOptions
    from gearcad.sizing import SizeTask

    owners = {"load": schema_of(Load), "task": schema_of(SizeTask), "rating": schema_of(RatingOptions)}
    owners["material"] = schema_of(Material)
    parted = {option.name: option.field.partition(".") for option in SIZE_OPTIONS if option.field}
    return {name: owners[table][field] for name, (table, _, field) in parted.items()}


def task_of(given: Mapping[str, Any]) -> SizeTask:
    """The task of the options that are given, under their own names in messages. Raises ParameterError."""
    try:
        return _task(given)
    except ParameterError as error:
        called = _CALLED.get(error.parameter, error.parameter)
        raise ParameterError(called, error.value, error.permitted, error.unit) from error


def _task(given: Mapping[str, Any]) -> SizeTask:
    from gearcad.core.records import PerGear
    from gearcad.geometry.gear_parts import NAMED_RACKS
    from gearcad.sizing import SizeTask

    for needed, what in (("ratio", "teeth of the wheel over those of the pinion"), ("material", 'such as "Eh MQ"')):
        if given[needed] is None:
            raise ParameterError(needed, None, f"must be given, {what}")
    pinion = material_of("material", given["material"], given["hardness"])
    wheel_hardness = given["wheel_hardness"]
    if wheel_hardness is None and given["wheel_material"] is None:
        wheel_hardness = given["hardness"]
    wheel = material_of(
        "wheel_material", given["material" if given["wheel_material"] is None else "wheel_material"], wheel_hardness
    )
    fields: dict[str, Any] = {_FIELDS[name]: given[name] for name in _PLAIN if given[name] is not None}
    fields |= {_FIELDS[name]: values_of(name, given[name]) for name in _RANGES if given[name] is not None}
    if given["teeth"] is not None:
        fields["teeth"] = ends_of("teeth", given["teeth"])
    if given["module"] is not None or given["second_series"]:
        fields["modules"] = modules_of("1:10" if given["module"] is None else given["module"], second=given["second_series"])
    if given["rack"] is not None:
        racks = {name.removeprefix("ISO53_"): rack for name, rack in NAMED_RACKS.items()}
        if (rack := racks.get(given["rack"].upper())) is None:
            raise ParameterError("rack", given["rack"], "must be A, B, C or D, a basic rack of ISO 53")
        fields["rack"] = rack
    if given["tool"] is not None:
        if given["rack"] is not None:
            raise ParameterError("tool", given["tool"], "must not stand beside --rack")
        fields["tool"] = given["tool"]
        if "modules" not in fields and (own := _modules_of_tool(given["tool"])):
            fields["modules"] = own
    if given["by"] is not None:
        fields["criterion"] = given["by"]
    if given["friction"] is not None:
        fields["friction"] = _number_or_word(given["friction"])
    return SizeTask(load=load_of(given), materials=PerGear(pinion, wheel), rating=rating_of(given), **fields)


def _number_or_word(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _modules_of_tool(name: str) -> tuple[float, ...]:
    """Return the modules (mm) for which a tool is on the shelf; none for one that is there for every module."""
    from gearcad.geometry.tool_shelf import Shelf

    modules = [row.module for row in Shelf().named(name)]
    return () if None in modules else tuple(module for module in modules if module is not None)


def load_of(given: Mapping[str, Any]) -> Load:
    from gearcad.load import Load

    torque, power, speed = given["torque"], given["power"], given["speed"]
    if speed is None:
        raise ParameterError("speed", None, "must be given, in rpm of the pinion")
    if (torque is None) == (power is None):
        if torque is None:
            raise ParameterError("torque", None, "must be given, in N·m on the pinion, or --power in kW")
        raise ParameterError("torque", torque, "must not stand beside --power", "N·m")
    if power is not None:
        require_number("speed", speed, "rpm", above=0)
        require_number("power", power, "kW", above=0)
        torque = power * _KILOWATTS / speed
    factor = {} if given["application_factor"] is None else {"application_factor": given["application_factor"]}
    return Load(torque=torque, speed=speed, **factor)


def material_of(option: str, name: str, hardness: float | None) -> Material:
    from gearcad.material import GRADED_GROUPS, Material, grade_of

    if grade_of(name) is None:
        groups = ", ".join(group.value for group in GRADED_GROUPS)
        permitted = f'must be a group and a quality (ML, MQ, ME) of ISO 6336-5, such as "Eh MQ": {groups}'
        raise ParameterError(option, name, permitted)
    try:
        return Material(name=name.strip(), hardness=hardness)
    except ParameterError as error:
        raise ParameterError(option.replace("material", error.parameter), error.value, error.permitted, error.unit) from error


def rating_of(given: Mapping[str, Any]) -> RatingOptions:
    from gearcad.core.quantities import schema_of
    from gearcad.rating.options import RatingOptions

    fields: dict[str, Any] = {_FIELDS[name]: given[name] for name in _OF_RATING if given[name] is not None}
    for text in given["rating"]:
        key, equals, value = (part.strip() for part in text.partition("="))
        if not equals or key not in schema_of(RatingOptions):
            raise ParameterError("rating", text, "must be KEY=VALUE with a key of [rating], such as oil_viscosity_40=320")
        fields[key] = _value(key, value, whole=schema_of(RatingOptions)[key].whole)
    return RatingOptions(**fields)


def _value(key: str, text: str, *, whole: bool) -> Any:
    """A number, two of them, a word, or true and false."""
    if text.lower() in ("true", "false"):
        return text.lower() == "true"
    try:
        numbers = [int(each) if whole else float(each) for each in text.split()]
    except ValueError:
        return text
    if not numbers:
        raise ParameterError(key, text, "must have a value")
    return numbers[0] if len(numbers) == 1 else tuple(numbers)


def values_of(name: str, text: str) -> tuple[float, ...]:
    """The numbers of "0,10:25:5": single ones, and from first to last by a step. Raises ParameterError."""
    values: list[float] = []
    for item in text.split(","):
        parts = [_number(name, text, each) for each in item.split(":")]
        if len(parts) == 1:
            values.append(float(parts[0]))
            continue
        if len(parts) != 3 or parts[2] <= 0 or parts[1] < parts[0]:
            raise ParameterError(name, text, "must be numbers with commas between, or FIRST:LAST:STEP: 0,10:25:5")
        first, last, step = parts
        if (last - first) / step >= _MOST_VALUES:
            raise ParameterError(name, text, f"must make at most {_MOST_VALUES} values")
        values += [float(first + step * number) for number in range(int((last - first) / step) + 1)]
    return tuple(values)


def _number(name: str, text: str, part: str) -> Fraction:
    try:
        return Fraction(part.strip())
    except (ValueError, ZeroDivisionError):
        raise ParameterError(name, text, "must be numbers with commas between, or FIRST:LAST:STEP: 0,10:25:5") from None


def ends_of(name: str, text: str) -> tuple[int, int]:
    """Least and most of "14:40", or twice the one of "17"."""
    try:
        ends = [int(each) for each in text.split(":")]
    except ValueError:
        ends = []
    if len(ends) not in (1, 2):
        raise ParameterError(name, text, "must be a whole number or two, the least and the most: 14:40")
    return ends[0], ends[-1]


def modules_of(text: str, *, second: bool) -> tuple[float, ...]:
    """Return the modules (mm) of a list, or those of ISO 54 in a range. Raises ParameterError.

    `second` adds series II of ISO 54.
    """
    from gearcad.sizing import ISO_54_I, ISO_54_II

    if not text.strip():
        raise ParameterError("module", text, "must be numbers with commas between, or the least and the most: 1:10")
    if ":" not in text:
        return values_of("module", text)
    parts = [float(_number("module", text, each)) for each in text.split(":")]
    if len(parts) != 2:
        raise ParameterError("module", text, "must be numbers with commas between, or the least and the most: 1:10")
    series = (*ISO_54_I, *(ISO_54_II if second else ()))
    found = tuple(float(each) for each in series if parts[0] <= each <= parts[1])
    if not found:
        permitted = "must have a module of ISO 54 between its ends, which are from 1 to 50 mm; or name modules: 0.5,0.7"
        raise ParameterError("module", text, permitted)
    return found
