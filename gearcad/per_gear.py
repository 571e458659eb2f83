"""PerGear: what pinion and wheel each have, and the Role that says which of the two is meant."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import Enum
from typing import Generic, NamedTuple, TypeVar

from gearcad.errors import InputError

__all__ = ["PerGear", "Role", "naming"]

T = TypeVar("T", covariant=True)
U = TypeVar("U")
V = TypeVar("V")


class Role(Enum):
    """Which gear of a pair; the value is its name in specs, documents and files."""

    PINION = "pinion"
    WHEEL = "wheel"

    @property
    def mate(self) -> Role:
        """The other gear."""
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
        """That of one gear."""
        return self.pinion if role is Role.PINION else self.wheel

    def items(self) -> Iterator[tuple[Role, T]]:
        """Each with its Role."""
        return zip(Role, self, strict=True)

    def map(self, function: Callable[[T], U]) -> PerGear[U]:
        """What a function makes of each; errors about a value say whose it is."""
        return PerGear(_named(Role.PINION, function, self.pinion), _named(Role.WHEEL, function, self.wheel))

    @classmethod
    def each(cls, function: Callable[[Role], U]) -> PerGear[U]:
        """What a function makes for each Role; errors about a value say whose it is."""
        return PerGear(_named(Role.PINION, function, Role.PINION), _named(Role.WHEEL, function, Role.WHEEL))


def _named(role: Role, function: Callable[[V], U], argument: V) -> U:
    """What a function makes; an error about a value says whose it is."""
    try:
        return function(argument)
    except InputError as error:
        raise error.within(role.value) from None


@contextmanager
def naming(role: Role) -> Iterator[None]:
    """Let errors about a value inside say whose it is: `pinion.teeth`."""
    try:
        yield
    except InputError as error:
        raise error.within(role.value) from None
