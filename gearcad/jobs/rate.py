"""Rate: Hertz, and ISO 6336 or DIN 3990 by Method B."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Unpack

from gearcad.designs import Inputs, PairDesign, RackPairDesign
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.subject import Subject, as_design
from gearcad.load import Load
from gearcad.notice import Notice
from gearcad.progress import Progress
from gearcad.rating.rack_rating import rate_rack
from gearcad.rating.rate import Rating
from gearcad.rating.rate import rate as rate_pair

__all__ = ["Rate", "rate"]

_NO_LOAD = "without it there is no stress"


@dataclass(frozen=True, kw_only=True)
class Rate(Job[PairDesign | RackPairDesign, Rating]):
    """The rating of a pair as mounted, by the standard that its design's [rating] names."""

    verb = "rate"
    accepts = (PairDesign, RackPairDesign)
    why = "a single gear carries nothing"
    solves = False

    def _run(self, design: PairDesign | RackPairDesign, _progress: Progress | None) -> Rating:
        if isinstance(design, RackPairDesign):
            return rate_rack(design.pair, design.materials, design.loaded(_NO_LOAD), design.rating)
        pair = design.pair if design.mounting is None else design.mounting.mounted(design.pair)
        return rate_pair(pair, design.materials, design.loaded(_NO_LOAD), design.rating)

    def document(self, result: Rating) -> dict[str, Any]:
        """Values under their symbols, those of one gear under "pinion" and "wheel"; `gearcad.symbols.RATING` has the words."""
        return {"kind": "rate", **result.to_dict()}

    def notices(self, result: Rating) -> Sequence[Notice]:
        return result.notices

    def files(self, _result: Rating) -> dict[str, Writer]:
        """None: a rating is not written by itself yet."""
        return {}

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """None, as it has no files."""
        return {}


def rate(subject: Subject, load: Load | None = None, **inputs: Unpack[Inputs]) -> Rating:
    """Rate a pair as mounted, under a load, by ISO 6336 or DIN 3990, Method B, and Hertz at the pitch point.

    `material` (of both gears, or PerGear of each), `mounting` and `rating` (RatingOptions), as the load, stand in place of
    those of a design; a pair has the defaults. A pinion and a rack are rated as a wheel of infinitely many teeth, without
    mounting.

    >>> from gearcad import Gear, GearPair, Load
    >>> gears = [Gear(teeth=z, normal_module=2, face_width=20) for z in (20, 30)]
    >>> rating = rate(GearPair(pinion=gears[0], wheel=gears[1]), Load(torque=60))
    >>> f"{rating.root_stresses[0]:.0f} and {rating.root_stresses[1]:.0f} MPa in the roots"
    '221 and 211 MPa in the roots'

    Raises ParameterError without a pair or a torque, GeometryError for a pair whose contact the standard does not describe.
    """
    return Rate().run(as_design(subject, load, **inputs))
