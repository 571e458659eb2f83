"""The contact that the pictures of a check show."""

from __future__ import annotations

from typing import Any, Generic, NamedTuple, TypeVar

from gearcad.contact.shared.loaded import LoadedCycle, LoadedPosition, PairContact

__all__ = ["ShownContact", "shown_contact"]

P = TypeVar("P", bound=LoadedPosition[Any])
C = TypeVar("C", bound=PairContact)


class ShownContact(NamedTuple, Generic[P, C]):
    """A contact and its position; `interior` if part of it is away from the edges of the flanks."""

    position: P
    contact: C
    interior: bool


def shown_contact(cycle: LoadedCycle[Any, P, C]) -> ShownContact[P, C]:
    """That of the greatest pressure away from edges, or that of the greatest load where all are near them."""
    worst = cycle.worst_contact
    position, contact = worst or cycle.heaviest_contact
    return ShownContact(position, contact, worst is not None)
