"""Derived: a length or a count that an object worked out for itself, told apart from one that was given."""

from __future__ import annotations

from typing import Any

__all__ = ["NOT_GIVEN", "Derived", "DerivedCount", "derive", "derive_count", "is_given"]


class Derived(float):
    """A float that stands for "not given: derived".

    A field such as `tip_diameter` may be given or left to be derived, and is read as a number either way. Handed back
    unchanged it means "derive again", so that `dataclasses.replace(gear, profile_shift=0.3)` gets the new tip circle,
    not the old one. To prescribe a value that another gear derived, pass `float(other.tip_diameter)`.
    """

    __slots__ = ()

    derived = True


class DerivedCount(int):
    """The same of a whole number, whose default is None."""

    __slots__ = ()

    derived = True


NOT_GIVEN = Derived("nan")
"""The default of such a field."""


def is_given(value: float | None) -> bool:
    """Whether a value was given; None asks, as a Derived does, for it to be derived."""
    return value is not None and not isinstance(value, Derived | DerivedCount)


def derive(instance: Any, field: str, value: float) -> None:
    """Let a field of a frozen object be `value`, as Derived, unless it was given."""
    if not is_given(getattr(instance, field)):
        object.__setattr__(instance, field, Derived(value))


def derive_count(instance: Any, field: str, value: int) -> None:
    """The same of a whole number."""
    if not is_given(getattr(instance, field)):
        object.__setattr__(instance, field, DerivedCount(value))
