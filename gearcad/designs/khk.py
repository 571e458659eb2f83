"""Profile shifts of rings taken from KHK and others, who give them the opposite sign."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from gearcad.designs.spec import OF_SHIFT
from gearcad.errors import GeometryError, InputError, format_number

__all__ = ["khk_reminder"]

_OF_PAIR = ("centre_distance", "teeth")
"""Faults of a pair that may come from the shift of its ring."""


@contextmanager
def khk_reminder(role: str, ring: Mapping[str, Any], make: Callable[[Mapping[str, Any]], object]) -> Iterator[None]:
    """Add to a GeometryError that may come from a ring's profile shift that the opposite one would do, where it would.

    `ring` are the inputs of the gear of `role`; `make` raises InputError for those that will not do. Nothing is added where
    the gear is no ring or its shift no number.
    """
    try:
        yield
    except GeometryError as error:
        shift, teeth = ring.get("profile_shift"), ring["teeth"]
        field = error.parameter.removeprefix(f"{role}." if role else "")
        if not isinstance(shift, float) or shift == 0 or teeth >= 0 or field not in (*OF_SHIFT, *_OF_PAIR):
            raise
        try:
            make({**ring, "profile_shift": -shift})
        except InputError:
            raise error from None
        key = f"{role}.profile_shift" if role else "profile_shift"
        reminder = f"; is the profile shift in KHK's sign? then write {key} = {format_number(-shift)}"
        raise GeometryError(error.parameter, error.value, error.permitted + reminder, error.unit) from error
