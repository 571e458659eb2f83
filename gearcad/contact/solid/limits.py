"""Where flanks of solid gears are no cylinders."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.contact.shared.conformal import HollowContact, conformal_notices
from gearcad.contact.solid.contact import SolidPairContact
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.notice import Notice

__all__ = ["wide_contacts"]


def wide_contacts(cycle: SolidCycle) -> Iterator[Notice]:
    """Rings whose contact is conformal."""
    if cycle.model.pair.internal:
        yield from conformal_notices(each for _, contact in cycle.interior_contacts for each in _hollow(contact))


def _hollow(contact: SolidPairContact) -> Iterator[HollowContact]:
    """Cells away from all edges."""
    lengths = contact.line.places.pinion[0]
    return map(HollowContact, contact.half_widths[contact.interior].tolist(), lengths[contact.interior].tolist())
