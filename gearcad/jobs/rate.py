"""Rate: Hertz, and ISO 6336 or DIN 3990 by Method B."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Unpack

from gearcad.designs import Design, Inputs, PairDesign
from gearcad.geometry import GearPair
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.subject import as_design
from gearcad.load import Load
from gearcad.material import Material
from gearcad.notice import Notice
from gearcad.progress import Progress
from gearcad.rating.rate import Rating
from gearcad.rating.rate import rate as rate_pair

__all__ = ["Rate", "rate"]


@dataclass(frozen=True, kw_only=True)
class Rate(Job[PairDesign, Rating]):
    """The rating of a pair as mounted, by the standard that its design's [rating] names."""

    verb = "rate"
    accepts = (PairDesign,)
    why = "a single gear carries nothing"
    solves = False

    def _run(self, design: PairDesign, _progress: Progress | None) -> Rating:
        pair = design.pair if design.mounting is None else design.mounting.mounted(design.pair)
        return rate_pair(pair, design.material or Material(), design.loaded("without it there is no stress"), design.rating)

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


def rate(subject: Design | GearPair, load: Load | None = None, **inputs: Unpack[Inputs]) -> Rating:
    """Rate a pair as mounted, under a load, by ISO 6336:2006 or DIN 3990:1987, Method B, and Hertz at the pitch point.

    `material`, `mounting` and `rating` (RatingOptions), as the load, stand in place of those of a design; a pair has the
    defaults.

    >>> from gearcad import Gear, GearPair, Load
    >>> gears = [Gear(teeth=z, normal_module=2, face_width=20) for z in (20, 30)]
    >>> rating = rate(GearPair(pinion=gears[0], wheel=gears[1]), Load(torque=60))
    >>> f"{rating.root_stresses[0]:.0f} and {rating.root_stresses[1]:.0f} MPa in the roots"
    '221 and 211 MPa in the roots'

    Raises ParameterError without a pair or a torque, GeometryError for a pair whose contact the standard does not describe.
    """
    return Rate().run(as_design(subject, load, **inputs))
