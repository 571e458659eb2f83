"""How the load of a pair of teeth comes and goes while it is in mesh."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.shared.loaded import Cycle

__all__ = ["LoadShare", "PlaceOfShare"]


class PlaceOfShare(NamedTuple):
    """A place on the line of action (mm from T1), and the part of the load that a pair of teeth carries there."""

    place: float
    share: float


class LoadShare(NamedTuple):
    """Places (n,) on the line of action (mm from T1), in the order in which one pair of teeth goes through them; its shares."""

    places: Floats
    shares: Floats

    @classmethod
    def of(cls, cycle: Cycle) -> LoadShare:
        """Of a mesh cycle."""
        places, shares = np.array(sorted((contact.place, contact.share) for _, contact in cycle.contacts)).T
        return cls(places, shares)

    def at(self, place: float) -> float:
        """Between the positions solved."""
        return float(np.interp(place, self.places, self.shares))

    @property
    def most(self) -> PlaceOfShare:
        """The greatest share."""
        at = self.shares.argmax()
        return PlaceOfShare(float(self.places[at]), float(self.shares[at]))
