"""Forms of searches: a field for each option, as the schema has them, and what was typed as the options of a run."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

from gearcad.core.errors import ParameterError
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.core.units import ShownUnit, UnitSystem, shown_unit
from gearcad.designs.spec_writers import reading_of, size_of
from gearcad.geometry.gear_parts import NAMED_RACKS
from gearcad.identify.measurements import Gauge, Measurements
from gearcad.jobs.modify import Modify
from gearcad.jobs.set_size_options import SET_OPTIONS, set_option_fields, set_task_of, shared_options
from gearcad.jobs.size_options import SIZE_OPTIONS, SizeOption, option_fields, task_of
from gearcad.material import GRADED_GROUPS, MaterialQuality
from gearcad.page.fields import tool_names
from gearcad.planetary.members import SetType
from gearcad.sizing.task import Criterion

MOST_PAIRS, MOST_CANDIDATES = 100, 20
"""Largest numbers of results of a search for sizes, and of an identification."""

_LONGEST = 200
"""Largest number of characters in a field."""

_COUNT, _ERRORS, _CANDIDATES = 20, 0, 5
"""Numbers of pairs, of pairs with a transmission error, and of candidates, unless something else is typed."""

_MORE, _RATING = "more", "rating"

_FIRST = {
    "size": (
        *("torque", "speed", "ratio", "life", "material", "hardness", "application_factor", "centre_distance"),
        *("max_diameter", "safety_flank", "safety_root"),
    ),
    "size-sets": (
        *("type", "input_torque", "output_torque", "speed", "ratio", "life", "material", "hardness", "application_factor"),
        *("planets", "max_diameter", "safety_flank", "safety_root"),
    ),
    "identify": ("teeth", "tip_diameter", "root_diameter", "span", "over_pins", "helix_angle"),
    "modify": ("torque", "pressure", "shape"),
}
"""Fields that are seen at once; the others are folded."""

REQUIRED = {
    "size": ("torque", "speed", "ratio", "material"),
    "size-sets": ("input_torque", "speed", "ratio", "material"),
    "identify": ("teeth",),
    "modify": (),
}
"""Fields that must be filled in."""

_OWN_WORDS = {
    "power": ("power in place of the torque", "P", "kW"),
    "second_series": ("modules of series II, too", "", ""),
    "rating": ("further keys of [rating]", "", ""),
    "count": ("number of pairs", "", ""),
    "errors": ("pairs with a transmission error", "", ""),
    "candidates": ("number of candidates", "", ""),
}
"""Words, symbols and units of options that no schema has."""

_SET_WORDS = {
    "type": ("kind of set", "", ""),
    "planets": ("number of planets", "N", ""),
    "teeth": ("teeth of suns and planets", "z", ""),
    "ring_teeth": ("teeth of rings", "z", ""),
    "fixed": ("fixed member", "", ""),
    "in": ("driving member", "", ""),
    "out": ("driven member", "", ""),
    "wheel_material": ("material of rings", "", ""),
    "wheel_hardness": ("hardness of rings", "", ""),
    "count": ("number of sets", "", ""),
}
"""Words of options of sets that no schema has, or that mean another thing than for pairs."""

_SET_USUAL = {"teeth": "17:100", "module": "0.5:50", "helix_angle": "0", "width_ratio": "1", "ratio_tolerance": "1"}
"""Texts of empty fields of sets that are other ones than for pairs."""

_MEMBERS = ("sun", "ring", "carrier", "sun_2", "ring_2")

_INSTEAD: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "size": {"torque": ("power",)},
    "size-sets": {"input_torque": ("output_torque", "power")},
}
"""Fields that may be filled in place of a required one."""

_USUAL = {"life": "∞"}
"""Text of an empty field that has no number for it: the endurance limit."""

_OF_DESIGN = {"torque": "that of the load", "pressure": "that of the material"}
"""Texts of empty fields of a search for modifications."""

_WHEEL = "wheel_"
"""Beginning of the names of options that are about the wheel."""

_DEFAULT = re.compile(r"\[default: ([-\d.:,]+)\]")
_NUMBER = re.compile(r"(?<![\w.,])[-+]?(?:\d+(?:[.,]\d+)?|[.,]\d+)(?:[eE][-+]?\d+)?")
_SPAN = re.compile(rf"{_NUMBER.pattern}(?!\d*[.,]?\d*\s*:)")
"""A number; and one that has no colon behind it."""

_SEPARATORS = re.compile(r"[;\s]+|,\s+")
_MINUS = "\N{MINUS SIGN}"


class FormField(NamedTuple):
    """A field of a form: its key, words in English, symbol, unit, what an empty one stands for, and choices if there are any.

    Of `first` rank are those that are seen at once. A `hint` says how it is typed, or more of what it is.
    """

    key: str
    words: str
    symbol: str = ""
    unit: str = ""
    usual: str = ""
    choices: tuple[str, ...] = ()
    first: bool = False
    hint: str = ""
    of_wheel: bool = False
    required: bool = False


@cache
def form_fields(kind: str) -> tuple[FormField, ...]:
    """Return the fields of the form of a search, in the order of use."""
    fields = {"size": _size_fields, "size-sets": _set_fields, "identify": _identify_fields, "modify": _modify_fields}[kind]()
    return tuple(field._replace(required=field.key in REQUIRED[kind]) for field in fields)


_OTHER_NAMES = {"module": "normal_module"}
"""Keys of specs by those of fields: the unit of a module stays mm."""


def unit_of(field: FormField, units: UnitSystem) -> ShownUnit | None:
    """Return the unit in which a field is shown and typed; None where that is its own."""
    return shown_unit(units, field.unit, _OTHER_NAMES.get(field.key, field.key))


@cache
def fields_in(kind: str, units: UnitSystem) -> tuple[FormField, ...]:
    """Return the fields of a form with units and usual texts as they are shown."""
    return tuple(_field_in(field, unit_of(field, units)) for field in form_fields(kind))


def _field_in(field: FormField, unit: ShownUnit | None) -> FormField:
    if unit is None:
        return field
    usual = _NUMBER.sub(lambda number: unit.shown(number[0]), field.usual) if field.usual[:1].isdigit() else field.usual
    return field._replace(unit=unit.name, usual=usual.replace(":mm", f":{unit.name}"))


def stored_text(field: FormField, text: str, units: UnitSystem) -> str:
    """Return what was typed into a field in the unit of documents: every number in it, but the teeth that a span has."""
    if (unit := unit_of(field, units)) is None:
        return text
    pattern = _SPAN if field.key == Gauge.SPAN.value else _NUMBER
    return pattern.sub(lambda number: unit.stored(number[0]), text)


def missing_keys(kind: str, typed: Mapping[str, str]) -> list[str]:
    """Return the required fields of a form that are empty."""
    instead = _INSTEAD.get(kind, {})
    return [key for key in REQUIRED[kind] if not any(typed.get(each) for each in (key, *instead.get(key, ())))]


def _size_fields() -> Iterator[FormField]:
    fields = option_fields()
    for option in SIZE_OPTIONS:
        schema, default = fields.get(option.name), _DEFAULT.search(option.help)
        words = _words(option.name, schema)
        words = words._replace(unit="mm") if option.name in _OTHER_NAMES else words
        usual = default[1] if default else _USUAL.get(option.name, "")
        yield words._replace(
            usual=usual,
            choices=_size_choices(option.name),
            first=option.name in _FIRST["size"],
            of_wheel=option.name.startswith(_WHEEL),
        )
    yield _words("second_series")._replace(choices=("true",))
    yield _words(_RATING)._replace(usual="KEY=VALUE; KEY=VALUE")
    yield _words("count")._replace(usual=str(_COUNT))
    yield _words("errors")._replace(usual=str(_ERRORS))


def _set_fields() -> Iterator[FormField]:
    """Yield a field for each option of a search for planetary sets: first its own, then those that it shares with pairs."""
    fields, own = set_option_fields(), _OWN_WORDS | _SET_WORDS
    for option in (*SET_OPTIONS, *shared_options()):
        name, default = option.name, _DEFAULT.search(option.help)
        field = FormField(name, *own[name]) if name in own else _words(name, fields[name])
        field = field._replace(unit="mm") if name in _OTHER_NAMES else field
        usual = _SET_USUAL.get(name, default[1] if default else _USUAL.get(name, ""))
        yield field._replace(usual=usual, choices=_set_choices(name), first=name in _FIRST["size-sets"])
    yield _words("second_series")._replace(choices=("true",))
    yield _words(_RATING)._replace(usual="KEY=VALUE; KEY=VALUE")
    yield FormField("count", *_SET_WORDS["count"], usual=str(_COUNT))


def _set_choices(name: str) -> tuple[str, ...]:
    if name in ("fixed", "in", "out"):
        return _MEMBERS
    return tuple(each.value for each in SetType) if name == "type" else _size_choices(name)


def _size_choices(name: str) -> tuple[str, ...]:
    if name in ("material", "wheel_material"):
        return tuple(f"{group} {quality}" for group in GRADED_GROUPS for quality in MaterialQuality)
    if name == "tool":
        return tool_names()
    if name == "by":
        return tuple(each.value for each in Criterion)
    return tuple(each.removeprefix("ISO53_") for each in NAMED_RACKS) if name == "rack" else ()


def _words(key: str, schema: FieldSchema | None = None) -> FormField:
    """Return a field with the words, symbol and unit of a schema, or its own."""
    if schema is None:
        return FormField(key, *_OWN_WORDS[key])
    symbol = schema.symbol
    return FormField(key, symbol.words, symbol.symbol, "°" if symbol.unit == "deg" else symbol.unit)


def _identify_fields() -> Iterator[FormField]:
    """Yield a field for each reading; what the schema says more of a reading is its hint."""
    sized = {gauge.value: gauge for gauge in Gauge if gauge.sized}
    for name, schema in schema_of(Measurements).items():
        symbol = schema.symbol
        usual = "" if schema.default is None else f"{schema.default:g}"
        unit = "°" if symbol.unit == "deg" else symbol.unit
        size = {Gauge.SPAN: "K", Gauge.CHORDAL_THICKNESS: "H"}
        typed = f"{size.get(sized[name], 'D')}:mm" if name in sized else usual
        first = name in _FIRST["identify"]
        yield FormField(name, name.replace("_", " "), symbol.symbol, unit, typed, first=first, hint=symbol.words)
    yield _words("candidates")._replace(usual=str(_CANDIDATES))


def _modify_fields() -> Iterator[FormField]:
    for name, schema in schema_of(Modify).items():
        if name in _FIRST["modify"]:
            choices = () if schema.choices is None else tuple(str(each.value) for each in schema.choices)
            yield _words(name, schema)._replace(choices=choices, first=True, usual=_OF_DESIGN.get(name, ""))


def usual_text(field: FormField, *, comma: bool) -> str:
    """Return what an empty field stands for, as somebody with a decimal comma would type it."""
    if not comma or not field.usual[:1].isdigit():
        return field.usual
    return field.usual.replace(",", "; ").replace(".", ",")


# ---------------------------------------------------------------------- what was typed


def options_of(kind: str, typed: Mapping[str, str], *, comma: bool, units: UnitSystem = UnitSystem.METRIC) -> dict[str, Any]:
    """Return the options of a search from what was typed in these units, as plain values for its process.

    With a decimal `comma` numbers of a list are separated by semicolons. Raises ParameterError that names the field.
    """
    given = {}
    for field in form_fields(kind):
        text = typed.get(field.key, "").strip().replace(_MINUS, "-")
        if len(text) > _LONGEST:
            raise ParameterError(field.key, f"{text[:20]}...", f"must have at most {_LONGEST} characters")
        if text:
            given[field.key] = stored_text(field, text, units)
    read: dict[str, Callable[[dict[str, str], bool], dict[str, Any]]] = {
        "size": _size_options,
        "size-sets": _set_options,
        "identify": _identify_options,
        "modify": _modify_options,
    }
    return read[kind](given, comma)


def _size_options(given: dict[str, str], comma: bool) -> dict[str, Any]:
    count = _whole("count", given.pop("count", str(_COUNT)), 1, MOST_PAIRS)
    errors = _whole("errors", given.pop("errors", str(_ERRORS)), 0, MOST_PAIRS)
    options = _plain_options(SIZE_OPTIONS, given, comma)
    try:
        task_of(options)
    except ParameterError as error:
        raise ParameterError(_size_key(error.parameter), error.value, error.permitted, error.unit) from error
    return options | {"count": count, "errors": errors}


_TEXTS = ("material", "wheel_material", "rack", "tool", "by", "type", "fixed", "in", "out")
"""Options whose texts are no numbers."""


def _plain_options(options: Sequence[SizeOption], given: dict[str, str], comma: bool) -> dict[str, Any]:
    """Return options of a search for sizes from what was typed, those of the rating included; None where nothing was."""
    rating = [each.strip() for each in given.pop(_RATING, "").split(";") if each.strip()]
    second = given.pop("second_series", "") == "true"
    found: dict[str, Any] = {option.name: None for option in options}
    for option in options:
        if (text := given.get(option.name)) is None:
            continue
        if option.type is str:
            found[option.name] = text if option.name in _TEXTS else _list(text, comma)
        else:
            found[option.name] = _whole(option.name, text) if option.type is int else number_of(option.name, text)
    return found | {"second_series": second, _RATING: rating}


_SET_KEYS = {"tolerance": "ratio_tolerance", "input": "in", "output": "out", "types": "type", "considered": "count"}
"""Keys of fields by the parameters of the task of sets."""


def _set_options(given: dict[str, str], comma: bool) -> dict[str, Any]:
    count = _whole("count", given.pop("count", str(_COUNT)), 1, MOST_PAIRS)
    options = _plain_options((*SIZE_OPTIONS, *SET_OPTIONS), given, comma)
    try:
        set_task_of(options)
    except ParameterError as error:
        key = _SET_KEYS.get(error.parameter, error.parameter)
        key = key.replace("ring_material.", "wheel.material.")
        raise ParameterError(_size_key(key), error.value, error.permitted, error.unit) from error
    return options | {"count": count}


def _size_key(parameter: str) -> str:
    """Return the key of the field that a parameter of a task belongs to, such as "pinion.material.hardness"."""
    role, _, name = parameter.rpartition("material.")
    return parameter if not role and not name else f"{_WHEEL if role == 'wheel.' else ''}{name or parameter}"


def _identify_options(given: dict[str, str], _comma: bool) -> dict[str, Any]:
    count = _whole("candidates", given.pop("candidates", str(_CANDIDATES)), 1, MOST_CANDIDATES)
    sized = {gauge.value: gauge for gauge in Gauge if gauge.sized}
    plain: dict[str, Any] = {}
    readings: dict[str, list[Any]] = {}
    for key, text in given.items():
        if key in sized:
            readings[key] = [_sized_reading(sized[key], each) for each in _SEPARATORS.split(text) if each]
        elif key.endswith("teeth"):
            plain[key] = _whole(key, text)
        else:
            plain[key] = reading_of(key, text.replace(",", "."))
    if "teeth" not in plain:
        raise ParameterError("teeth", None, "must be given, as counted")
    try:
        Measurements(**(plain | {key: dict(pairs) for key, pairs in readings.items()}))
    except ParameterError as error:
        own = error.parameter.partition(".")[0]
        raise ParameterError("span" if own == "span_teeth" else own, error.value, error.permitted, error.unit) from error
    return plain | {"sized": readings, "count": count}


def _sized_reading(gauge: Gauge, text: str) -> tuple[float, Any]:
    """Return the size and the reading of a text such as "3:15.40"."""
    first, colon, reading = text.partition(":")
    if not colon:
        example = "3:15.40" if gauge is Gauge.SPAN else "3.5:56.21"
        raise ParameterError(gauge.value, text, f"must be {gauge.size_in_words} and reading, such as {example}")
    return size_of(gauge, first.replace(",", ".")), reading_of(gauge.value, reading.replace(",", "."))


def _modify_options(given: dict[str, str], _comma: bool) -> dict[str, Any]:
    options: dict[str, Any] = {key: text if key == "shape" else number_of(key, text) for key, text in given.items()}
    Modify(**options)
    return options


def number_of(key: str, text: str) -> float:
    """Return a number with a decimal point or comma. Raises ParameterError."""
    try:
        return float(text.replace(",", "."))
    except ValueError:
        raise ParameterError(key, text, "must be a number") from None


def _whole(key: str, text: str, least: int | None = None, most: int | None = None) -> int:
    """Return a whole number. Raises ParameterError."""
    within = "" if least is None else f" from {least} to {most}"
    try:
        value = int(text)
    except ValueError:
        raise ParameterError(key, text, f"must be a whole number{within}") from None
    if least is not None and most is not None and not least <= value <= most:
        raise ParameterError(key, value, f"must be a whole number{within}")
    return value


def _list(text: str, comma: bool) -> str:
    """Return several numbers as the command line has them: decimal points, and commas between."""
    parts = [each for each in _SEPARATORS.split(text) if each]
    return ",".join(each.replace(",", ".") if comma else each for each in parts)
