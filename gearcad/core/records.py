"""Records that all rooms share: array types, PerGear, Notice, Verdict, and short representations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import MISSING, dataclass, fields, replace
from enum import Enum
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from gearcad.callable_room import function_of
from gearcad.core.errors import InputError

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Bools = NDArray[np.bool_]

Wholes = NDArray[np.int64]
"""Counts and numbers of things, of one size on all machines."""

Indices = NDArray[np.intp]
"""Places in arrays, of the machine's own size."""

JsonObject: TypeAlias = dict[str, Any]
"""An object of a JSON document: numbers, texts, lists and further objects by their keys."""


def distinct(values: Floats) -> Floats:
    """Return values (n,) in their order, each once. NumPy's own function imports all of masked arrays for that."""
    ordered = np.sort(values)
    kept: Floats = ordered[np.concatenate([[True], ordered[1:] != ordered[:-1]])]
    return kept


def freeze(result: DataclassInstance) -> None:
    """Make all arrays among the fields of a frozen dataclass read-only."""
    for each in fields(result):
        value = getattr(result, each.name)
        if isinstance(value, np.ndarray):
            value.flags.writeable = False


T = TypeVar("T", covariant=True)
U = TypeVar("U")
V = TypeVar("V")


class Role(Enum):
    """Role of a gear in a pair; the value is its name in specs, documents and files."""

    PINION = "pinion"
    WHEEL = "wheel"

    @property
    def mate(self) -> Role:
        """Role of the other gear."""
        return Role.WHEEL if self is Role.PINION else Role.PINION


class PerGear(NamedTuple, Generic[T]):
    """A quantity of both gears: asked for by name or by Role, unpacked in this order, never by number.

    >>> teeth = PerGear(20, 30)
    >>> teeth.pinion, teeth.pick(Role.WHEEL), teeth.map(float)
    (20, 30, PerGear(pinion=20.0, wheel=30.0))
    >>> [f"{role.value} {number}" for role, number in teeth.items()]
    ['pinion 20', 'wheel 30']
    """

    pinion: T
    wheel: T

    def pick(self, role: Role) -> T:
        """Return the value of one gear."""
        return self.pinion if role is Role.PINION else self.wheel

    def items(self) -> Iterator[tuple[Role, T]]:
        """Yield the value of each gear with its Role."""
        return zip(Role, self, strict=True)

    def map(self, function: Callable[[T], U]) -> PerGear[U]:
        """Return the results of a function for both values. Errors about a value name its gear."""
        return PerGear(_named(Role.PINION, function, self.pinion), _named(Role.WHEEL, function, self.wheel))

    @classmethod
    def each(cls, function: Callable[[Role], U]) -> PerGear[U]:
        """Return the results of a function for both Roles. Errors about a value name its gear."""
        return PerGear(_named(Role.PINION, function, Role.PINION), _named(Role.WHEEL, function, Role.WHEEL))


def _named(role: Role, function: Callable[[V], U], argument: V) -> U:
    """Return the result of a function. An error about a value names the gear."""
    try:
        return function(argument)
    except InputError as error:
        raise error.within(role.value) from None


@contextmanager
def naming(role: Role | str) -> Iterator[None]:
    """Let errors about a value inside this context name the gear: `pinion.teeth`."""
    try:
        yield
    except InputError as error:
        raise error.within(role.value if isinstance(role, Role) else role) from None


@dataclass(frozen=True)
class Notice:
    """One notice: `code` names its kind for programs, `text` states it, `where` names its subject ("" for the whole result).

    >>> notice = Notice("thin-rim", "the rim bends", where="wheel")
    >>> print(notice)
    wheel: the rim bends
    >>> print(notice.within("check"))
    check: wheel: the rim bends
    """

    code: str
    text: str
    where: str = ""

    def __str__(self) -> str:
        return f"{self.where}: {self.text}" if self.where else self.text

    def within(self, owner: str) -> Notice:
        """Return the notice with `owner` in front of its place."""
        return replace(self, where=f"{owner}: {self.where}" if self.where else owner)

    def to_dict(self) -> dict[str, str]:
        """Return the notice as documents have it."""
        return {"code": self.code, "where": self.where, "text": self.text}


def texts(notices: Iterable[Notice]) -> tuple[str, ...]:
    """Return each notice in a line, without repetitions."""
    return tuple(dict.fromkeys(map(str, notices)))


def joined(notices: Iterable[Notice]) -> Sequence[Notice]:
    """Return each text once, at its first place, with all places that it is about.

    >>> stiff = Notice("rigid", "taken for rigid")
    >>> print(*joined([stiff.within("sharing"), stiff.within("running")]))
    sharing, running: taken for rigid
    """
    places: dict[tuple[str, str], dict[str, None]] = {}
    for notice in notices:
        places.setdefault((notice.code, notice.text), {})[notice.where] = None
    return [Notice(code, text, where=", ".join(filter(None, where))) for (code, text), where in places.items()]


class Verdict(Enum):
    """The result of judging something; `falls_short` decides exit statuses."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_JUDGED = "not judged"
    NOT_ASKED = "not asked for"

    @property
    def falls_short(self) -> bool:
        """Whether a command ends with exit status 1: failed, or not judged although it was asked for."""
        return self in (Verdict.FAILED, Verdict.NOT_JUDGED)


def together(verdicts: Iterable[Verdict]) -> Verdict:
    """Return failed if one verdict failed, passed if all passed, otherwise not judged.

    >>> together([Verdict.PASSED, Verdict.NOT_JUDGED]).value
    'not judged'
    """
    found = set(verdicts)
    if Verdict.FAILED in found:
        return Verdict.FAILED
    return Verdict.PASSED if found == {Verdict.PASSED} else Verdict.NOT_JUDGED


def strength_verdict(asked: bool, required: Iterable[Verdict], limits: Iterable[Verdict] = ()) -> Verdict:
    """Return the verdict on strength of a pair or a train: the only rule of ratings, checks, tables, page and reports.

    `required` are flanks and roots of all gears, and scuffing where its safety is required; each must be judged to pass.
    `limits` are further gates, such as local limits: one that is not passed fails, and none replaces a required verdict.

    >>> strength_verdict(True, [Verdict.PASSED, Verdict.NOT_JUDGED], [Verdict.PASSED]).value
    'not judged'
    >>> strength_verdict(False, [Verdict.NOT_JUDGED]).value
    'not asked for'
    """
    every = [*required, *limits]
    return together(every) if asked or Verdict.FAILED in every else Verdict.NOT_ASKED


NOT_ASKED_WORDS = "not asked for: no endurance limit, local limit, quality or required safety is given"
"""Words of a verdict on strength that was not requested."""


class Pictured:
    """A result that a notebook shows as its first picture, which `plots` draws when it is asked for."""

    def _repr_html_(self) -> str:
        html: str = function_of("shown_in_notebook")(self)
        return html


def is_assumed(value: Any) -> bool:
    """Return whether a value of a field is its default, which the user did not give (see `AssumedNumber`).

    >>> from gearcad.core.quantities import AssumedCount
    >>> is_assumed(AssumedCount(6)), is_assumed(6)
    (True, False)
    """
    return bool(getattr(value, "assumed", False))


def is_usual(value: Any, default: Any) -> bool:
    """Return whether a value of a field says no more than its default: equal to it, and not given where that is assumed.

    >>> from gearcad.core.quantities import AssumedCount
    >>> is_usual(AssumedCount(6), AssumedCount(6)), is_usual(6, AssumedCount(6)), is_usual(0.0, 0.0)
    (True, False, True)
    """
    return bool(value == default) and (is_assumed(value) or not is_assumed(default))


def concise(self: Any) -> str:
    """Return the `__repr__` of a dataclass: the fields that differ from their defaults, as one would type them.

    Values that say they are `derived` are left out, so that the text evaluates to an equal object.
    """
    given = []
    for each in fields(self):
        value, default = getattr(self, each.name), each.default
        if each.default_factory is not MISSING:
            default = each.default_factory()
        if not getattr(value, "derived", False) and (default is MISSING or not is_usual(value, default)):
            given.append(f"{each.name}={(value.value if isinstance(value, Enum) else value)!r}")
    return f"{type(self).__name__}({', '.join(given)})"


def grouped(number: int) -> str:
    """Return a whole number as text, with its thousands apart."""
    return f"{number:,}".replace(",", "\u202f")
