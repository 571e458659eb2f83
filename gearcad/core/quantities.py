"""Quantities: permitted ranges of inputs, derived and assumed numbers, and the schema of input fields.

Wide enough for any real gear, narrow enough that no formula overflows. Lengths of teeth stand with the geometry.

A field says it in its annotation, `addendum: Annotated[float, Range("", 0, 5), Words("addendum of the rack", "h_aP*")] = 1.0`:
what it can be (its type, and a Range, a Whole or a Choice), and how it is written. Its default is that of the dataclass.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import MISSING, asdict, dataclass, fields, is_dataclass
from enum import Enum
from functools import cache, cached_property
from types import MappingProxyType, UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Union, get_args, get_origin, get_type_hints

from gearcad.core.errors import (
    ParameterError,
    as_choice,
    format_number,
    is_finite_number,
    plain_numbers,
    require_name,
    require_number,
    require_one_of,
    require_switch,
    require_whole,
)
from gearcad.core.records import is_assumed
from gearcad.core.symbols import Symbol

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


class Range(NamedTuple):
    """A unit, and the least and most that a quantity can be in it; a `signed` one is 0 or of such a size with either sign.

    One that `may_vanish` is 0 or from `least` on; `ends` in round brackets are outside. None has no bound on that side.
    """

    unit: str
    least: float | None
    most: float | None
    signed: bool = False
    may_vanish: bool = False
    ends: str = "[]"

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is a number inside."""
        if not (self.signed or self.may_vanish):
            lower, upper = "above" if self.ends[0] == "(" else "at_least", "below" if self.ends[1] == ")" else "at_most"
            require_number(parameter, value, self.unit, **{lower: self.least, upper: self.most})
            return
        least, most = self.least or 0.0, math.inf if self.most is None else self.most
        inside = is_finite_number(value) and least <= (abs(value) if self.signed else value) <= most
        if not inside and not (is_finite_number(value) and value == 0):
            size = " in size" if self.signed else ""
            permitted = f"must be a number, 0 or from {least:g} to {most:g} {self.unit}{size}"
            raise ParameterError(parameter, value, permitted, self.unit if isinstance(value, int | float) else "")


class Whole(NamedTuple):
    """The least and most that a whole number can be; one that `may_vanish` is 0 or from `least` on.

    With `negative` it may be from minus `most` to that too, which stands for something else.
    """

    least: int
    most: int
    may_vanish: bool = False
    negative: tuple[int, str] | None = None

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is a whole number inside."""
        if self.may_vanish and value == 0:
            return
        if self.negative and is_finite_number(value) and value < 0:
            highest, meaning = self.negative
            if not isinstance(value, int) or not -self.most <= value <= highest:
                also = f"or from {-self.most} to {highest} ({meaning})"
                raise ParameterError(parameter, value, f"must be a whole number from {self.least} to {self.most}, {also}")
            return
        require_whole(parameter, value, at_least=self.least, at_most=self.most)


class Choice(NamedTuple):
    """The words that a text can be."""

    words: tuple[str, ...]

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is one of the words."""
        require_one_of(parameter, value, self.words)


class Member(NamedTuple):
    """Names by which a value, or a text, can denote a member of an enum."""

    choices: type[Enum]

    def require(self, parameter: str, value: Any) -> None:
        """Raise ParameterError unless `value` is a member, or the value of one."""
        as_choice(parameter, value, self.choices)


TORQUE = Range("N·m", 1e-9, 1e9, signed=True)
SPEED = Range("rpm", 1e-6, 1e7, signed=True)
APPLICATION_FACTOR = Range("", 0.01, 100.0)

MODULUS = Range("MPa", 0.1, 1e7)
"""Young's modulus, from a gel to some times diamond."""

POISSON_RATIO = Range("", 0.0, 0.499)
"""Poisson's ratio; an incompressible material locks finite elements."""

DENSITY = Range("kg/m³", 1e-3, 1e5)
"""Permitted density, from nearly 0 to several times that of osmium."""

STRENGTH = Range("MPa", 1e-3, 1e6)
BAND = Range("%", 0.01, 1e4)
FRICTION = Range("", 0.0, 0.5)
OFFSET = Range("mm", 1e-6, 1e5, signed=True)
"""Distance of something from its place."""

INERTIA = Range("kg·m²", 1e-21, 1e12)
TORSIONAL_STIFFNESS = Range("N·m/rad", 1e-12, 1e15)
LENGTH = Range("mm", 1e-3, 1e7)
"""Lengths of shafts, and their diameters."""

STIFFNESS = Range("N/µm", 1e-9, 1e9)
DAMPING_RATIO = Range("", 0.0, 100.0)
DAMPING = Range("N·s/m", 0.0, 1e15)
ANGULAR_DAMPING = Range("N·m·s/rad", 0.0, 1e15)
PRELOAD = Range("N", 1e-9, 1e12, may_vanish=True)
BACKLASH = Range("µm", 0.0, 1e7)
DEVIATION = Range("µm", 1e-6, 1e6, signed=True)
DURATION = Range("s", 1e-9, 1e6)
SAMPLING = Range("Hz", 1e-3, 1e12)


class Derived(float):
    """A float that stands for "not given: derived".

    A field such as `tip_diameter` may be given or left to be derived, and is read as a number either way. Handed back
    unchanged it means "derive again", so that `dataclasses.replace(gear, profile_shift=0.3)` gets the new tip circle,
    not the old one. To prescribe a value that another gear derived, pass `float(other.tip_diameter)`.
    """

    __slots__ = ()

    derived = True


class DerivedCount(int):
    """A whole number that stands for "not given: derived", as Derived; its default is None."""

    __slots__ = ()

    derived = True


NOT_GIVEN = Derived("nan")
"""The default of a field that is derived unless it is given."""


def is_given(value: float | None) -> bool:
    """Return whether a value was given; None asks, as a Derived does, for it to be derived."""
    return value is not None and not isinstance(value, Derived | DerivedCount)


def derive(instance: Any, field: str, value: float) -> None:
    """Let a field of a frozen object be `value`, as Derived, unless it was given."""
    if not is_given(getattr(instance, field)):
        object.__setattr__(instance, field, Derived(value))


def derive_count(instance: Any, field: str, value: int) -> None:
    """Let a field of a frozen object be the whole number `value`, as DerivedCount, unless it was given."""
    if not is_given(getattr(instance, field)):
        object.__setattr__(instance, field, DerivedCount(value))


Permitted = Range | Whole | Choice | Member


WHEN_GIVEN = "when_given"
"""Mark of a field that documents of inputs have only where it is given."""

ELSEWHERE = "written elsewhere"
"""Mark of a field whose own fields are written elsewhere: in tables, or a file, of their own."""


class AssumedNumber(float):
    """A number that is the default of a field and stands for what the program cannot know, such as a material or a load.

    Documents mark it as assumed, since nobody gave it. `dataclasses.replace` hands it on as it is. A number of the same size
    that somebody gives is no AssumedNumber. Defaults of the shape of a gear, which are made so, and of how the program computes
    are plain numbers.
    """

    __slots__ = ()

    assumed = True


class AssumedCount(int):
    """A whole number that is the default of a field, as AssumedNumber."""

    __slots__ = ()

    assumed = True


class AssumedText(str):
    """A text that is the default of a field, as AssumedNumber."""

    __slots__ = ()

    assumed = True


def assumed_values(inputs: Any, key: str = "") -> Iterator[tuple[str, Any]]:
    """Yield all values in `inputs` that the user did not give, under keys such as "load.application_factor".

    `inputs` is a value, a dataclass of them, or a tuple, list or mapping of these; `key` is its own key. Inner documents with a
    list "assumed" of their own are left out.
    """
    if is_assumed(inputs):
        yield key, inputs
        return
    if is_dataclass(inputs) and not isinstance(inputs, type):
        parts: Mapping[Any, Any] = {each.name: getattr(inputs, each.name) for each in fields(inputs)}
    elif isinstance(inputs, Mapping):
        parts = {} if key and "assumed" in inputs else inputs
    elif isinstance(inputs, tuple | list):
        parts = getattr(inputs, "_asdict", lambda: dict(enumerate(inputs, 1)))()
    else:
        return
    for name, value in parts.items():
        yield from assumed_values(value, f"{key}.{name}" if key else str(name))


def inputs_document(inputs: DataclassInstance) -> dict[str, Any]:
    """Return the fields of inputs as documents have them: those marked WHEN_GIVEN only where they are given."""
    schema = schema_of(type(inputs))
    return {key: value for key, value in asdict(inputs).items() if value is not None or WHEN_GIVEN not in schema[key].marks}


def with_assumed(document: dict[str, Any]) -> dict[str, Any]:
    """Return a document with a list "assumed" of all values in it that the user did not give: "load.application_factor = 1"."""
    return document | {"assumed": [f"{key} = {format_number(value)}" for key, value in assumed_values(document)]}


class Words(NamedTuple):
    """Words of a field: plain words, the standard's symbol, and the clause (as in Symbol)."""

    words: str
    symbol: str = ""
    source: str = ""


class InPlaceOf(NamedTuple):
    """The mark of a field that must be given, unless another field is, from which it then follows."""

    other: str


@dataclass(frozen=True)
class FieldSchema:
    """Schema of one field of a type: the members of its type, what is permitted, how it is written, and its marks.

    One without a default is `required`; an `optional` one can be None, where it is absent or is to be derived.
    """

    name: str
    members: tuple[Any, ...]
    permitted: Permitted | None
    symbol: Symbol
    required: bool
    optional: bool
    marks: tuple[Any, ...]
    default: Any

    @cached_property
    def whole(self) -> bool:
        """Whether the numbers of the field are whole: 2 equals 2.0 for all other fields."""
        return int in self.members

    @cached_property
    def switch(self) -> bool:
        """Whether the field is true or false."""
        return self.members == (bool,)

    @cached_property
    def several(self) -> bool:
        """Whether the field can hold several numbers."""
        return any(map(_is_list, self.members)) and not (self.nested or self.texts)

    @cached_property
    def count(self) -> int | None:
        """Count of numbers that the field always holds; None where it can be something else, or a list of any length."""
        parts = get_args(self.members[0]) if len(self.members) == 1 and get_origin(self.members[0]) is tuple else ()
        return len(parts) if set(parts) == {float} else None

    @cached_property
    def nested(self) -> bool:
        """Whether the field is a list of lists of numbers. A cell of a table holds it as text."""
        deep = any(_is_list(member) and any(map(_is_list, get_args(member))) for member in self.members)
        return deep and not self.texts

    @cached_property
    def texts(self) -> bool:
        """Whether the field is a list of texts, or of lists of texts. A cell of a table holds it as text."""
        return any(_is_list(member) and set(_leaves(member)) == {str} for member in self.members)

    @cached_property
    def text(self) -> bool:
        """Whether the field always holds a word, or several words."""
        return self.texts or all(member in (str, type(None)) or _is_enum(member) for member in self.members)

    @cached_property
    def words(self) -> tuple[str, ...]:
        """Words that may stand for a number."""
        return tuple(word for member in self.members if get_origin(member) is Literal for word in get_args(member))

    @cached_property
    def choices(self) -> type[Enum] | None:
        """Enum of which the value is a member; None for other fields."""
        return next(filter(_is_enum, self.members), None)

    @cached_property
    def part(self) -> type[DataclassInstance] | None:
        """Type of the field's value if that has fields of its own; otherwise None."""
        if ELSEWHERE in self.marks:
            return None
        return next((member for member in self.members if isinstance(member, type) and is_dataclass(member)), None)

    @cached_property
    def stand_in(self) -> InPlaceOf | None:
        """The field that may be given in its place."""
        return next((mark for mark in self.marks if isinstance(mark, InPlaceOf)), None)

    def needed(self, given: Collection[str]) -> bool:
        """Return whether the field must be given but is not among the given fields."""
        stands_in = self.stand_in is not None and self.stand_in.other not in given
        return self.name not in given and (self.required or stands_in)

    def require(self, instance: DataclassInstance, owner: str) -> None:
        """Check the value that a frozen instance has, and turn the name of an enum's member into it. Raises ParameterError."""
        value, parameter = getattr(instance, self.name), f"{owner}.{self.name}" if owner else self.name
        if self.stand_in is not None:
            self._require_either(instance, parameter, self.stand_in)
        if (value is None and self.optional) or getattr(value, "derived", False) or _stands_in(value, self.words):
            return
        if self.switch:
            require_switch(parameter, value)
        if self.choices is not None:
            object.__setattr__(instance, self.name, as_choice(parameter, value, self.choices))
        if self.count is not None:
            _require_numbers(parameter, value, self.count)
        if self.permitted is None:
            return
        if not self.several:
            self._require_permitted(self.permitted, parameter, value)
        elif isinstance(value, list | tuple):
            for each in value:
                self.permitted.require(parameter, each)
        elif float in self.members:  # what else is no list, its type explains
            self.permitted.require(parameter, value)

    def _require_permitted(self, permitted: Permitted, parameter: str, value: Any) -> None:
        """Let an error about a text name the words that may stand for a number."""
        try:
            permitted.require(parameter, value)
        except ParameterError as error:
            if not (self.words and isinstance(value, str)):
                raise
            words = " or ".join(f'"{word}"' for word in self.words)
            raise ParameterError(error.parameter, value, f"{error.permitted}, or {words}") from None

    def _require_either(self, instance: DataclassInstance, parameter: str, mark: InPlaceOf) -> None:
        """Raise ParameterError if neither this field nor the one in its place is given."""
        if not any(_has_value(getattr(instance, each)) for each in (self.name, mark.other)):
            try:
                if self.permitted is not None:
                    self.permitted.require(parameter, None)
            except ParameterError as error:
                raise ParameterError(parameter, None, f"{error.permitted}, or give {mark.other} instead") from None


def _require_numbers(parameter: str, value: Any, count: int) -> None:
    """Raise ParameterError unless `value` is a list of so many finite numbers."""
    if not (isinstance(value, list | tuple) and len(value) == count and all(map(is_finite_number, value))):
        given = list(value) if isinstance(value, tuple) else value
        raise ParameterError(parameter, given, f"must be a list of {count} numbers")


def _has_value(value: Any) -> bool:
    return value is not None and not getattr(value, "derived", False)


def _stands_in(value: Any, words: tuple[str, ...]) -> bool:
    return isinstance(value, str) and value in words


def _is_list(member: Any) -> bool:
    origin = get_origin(member)
    return isinstance(origin, type) and issubclass(origin, tuple)


def _leaves(member: Any) -> Iterator[Any]:
    """Yield the types of the elements of lists, and of lists of lists."""
    for each in get_args(member) if _is_list(member) else (member,):
        if each is not Ellipsis:
            yield from _leaves(each) if _is_list(each) else (each,)


def _is_enum(member: Any) -> bool:
    return isinstance(member, type) and issubclass(member, Enum)


@cache
def schema_of(kind: type[DataclassInstance]) -> Mapping[str, FieldSchema]:
    """Return the schema of each field of a type, by name and in the order of the fields."""
    hints = get_type_hints(kind, include_extras=True)
    return MappingProxyType({each.name: _schema(each, hints[each.name]) for each in fields(kind)})


def parts_of(kind: type[DataclassInstance]) -> dict[str, type[DataclassInstance]]:
    """Return the fields of a type that have fields of their own, and their types."""
    return {name: field.part for name, field in schema_of(kind).items() if field.part is not None}


def _schema(field: Any, hint: Any) -> FieldSchema:
    said = hint.__metadata__ if get_origin(hint) is Annotated else ()
    bare = hint.__origin__ if said else hint
    members = get_args(bare) if get_origin(bare) in (Union, UnionType) else (bare,)
    permitted = next((each for each in said if isinstance(each, Range | Whole | Choice | Member)), None)
    words = next((each for each in said if isinstance(each, Words)), Words(""))
    return FieldSchema(
        name=field.name,
        members=members,
        permitted=permitted,
        symbol=Symbol(words.symbol, permitted.unit if isinstance(permitted, Range) else "", words.source, words.words),
        required=field.default is MISSING and field.default_factory is MISSING,
        optional=type(None) in members or getattr(field.default, "derived", False),
        marks=tuple(each for each in said if each is not permitted and each is not words),
        default=_default(field),
    )


def _default(field: Any) -> Any:
    """Return the default of a dataclass's field; None where it has none."""
    if field.default is not MISSING:
        return field.default
    return None if field.default_factory is MISSING else field.default_factory()


def symbols_of(kind: type[DataclassInstance]) -> dict[str, Symbol]:
    """Return the symbols of the fields of a type; fields of its parts are named with a dot: `rack.root_radius`."""
    found: dict[str, Symbol] = {}
    for name, field in schema_of(kind).items():
        if field.part is None:
            found[name] = field.symbol
        else:
            found |= {f"{name}.{inner}": symbol for inner, symbol in symbols_of(field.part).items()}
    return found


class NamedPart:
    """A part of something larger, which is known by its name: errors about its fields begin with that."""

    name: str

    def _check_fields(self) -> None:
        """A name that an error can begin with, and each field by itself. Raises ParameterError."""
        require_name("name", self.name)
        require_fields(self, self.name)


def require_fields(instance: Any, owner: str = "") -> None:
    """Turn numbers into Python's own and members' names into members, and check what fields can be by themselves.

    Values that are derived, and None where it is permitted, are left alone. Raises ParameterError; `owner` leads its parameter.
    """
    plain_numbers(instance)
    for field in schema_of(instance.__class__).values():
        field.require(instance, owner)
