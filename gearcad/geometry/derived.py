"""Derived: a length that an object worked out for itself, told apart from one that was given."""

from __future__ import annotations

__all__ = ["Derived"]


class Derived(float):
    """A float that stands for "not given: derived".

    A field such as `tip_diameter` may be given or left to be derived, and is read as a number either way. Handed back
    unchanged it means "derive again", so that `dataclasses.replace(gear, profile_shift=0.3)` gets the new tip circle,
    not the old one. To prescribe a value that another gear derived, pass `float(other.tip_diameter)`.
    """

    __slots__ = ()

    derived = True
