"""Contacts that are too wide for two cylinders.

In a ring with few more teeth than its pinion flanks are nearly alike, one hollow, one round, and the contact can be as wide as
their radii.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from gearcad.notice import Notice

__all__ = ["HollowContact", "conformal_notices"]

_WIDE = 0.04
"""Half width over the pinion's radius of curvature up to which Hertz's pressure is within 1 % of that in a ring, for as few as
ten teeth of difference; contact between external gears is that good up to 0.1.
"""


class HollowContact(NamedTuple):
    """A contact in the hollow flank of a ring: Hertz's half width and the pinion's radius of curvature (mm)."""

    half_width: float
    radius: float

    @property
    def conformal(self) -> bool:
        """Whether it is too wide for two cylinders."""
        return self.half_width > _WIDE * self.radius


def conformal_notices(contacts: Iterable[HollowContact]) -> Iterator[Notice]:
    """Of the widest of contacts, if it is too wide."""
    worst = max(contacts, key=lambda contact: contact.half_width / contact.radius, default=None)
    if worst is not None and worst.conformal:
        text = (
            f"the contact is up to {2 * worst.half_width:.3g} mm wide in the ring's hollow flank, where the pinion has a "
            f"radius of {worst.radius:.3g} mm: that is no contact of two cylinders, and Hertz can be more than 1 % off"
        )
        yield Notice("conformal-contact", text)
