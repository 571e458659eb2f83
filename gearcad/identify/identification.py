"""What came of a search: candidates, how good they are, and what else to measure where several are left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gearcad.identify.candidate import Candidate
from gearcad.identify.measured import Measured, Reading
from gearcad.identify.unknowns import Unknown
from gearcad.notice import Notice, texts
from gearcad.reprs import Pictured

__all__ = ["Deciding", "Identification"]

_CERTAIN = 0.95
"""The least probability of what is called certain."""

_WORN = 0.12
"""Tooth thinning in modules above that of gears as they are made."""

_OFF = 2.0
"""Uncertainties that a reading is off and is told."""

_UNUSUAL = {
    Unknown.MODULE: "module",
    Unknown.PRESSURE_ANGLE: "pressure angle",
    Unknown.HELIX_ANGLE: "helix angle",
    Unknown.SHIFT: "profile shift",
    Unknown.ADDENDUM: "height of the tips",
    Unknown.DEDENDUM: "depth of the roots",
    Unknown.THINNING: "tooth thinning",
    Unknown.MATE_SHIFT: "profile shift of the mate",
}

_LEAST_FIT = 0.002
"""The least probability that a chi-square as great as the best would have by chance, of readings that fit."""


@dataclass(frozen=True, kw_only=True)
class Deciding:
    """Something else to measure, what each candidate would have there, and how far apart that is.

    With `less` it is two readings, of which the difference counts. `apart` is the distance of each other candidate from the
    first, in units of what a reading of `place.uncertainty` and the fits leave open.
    """

    place: Reading
    less: Reading | None
    predicted: tuple[float, ...]
    apart: tuple[float, ...]

    def to_dict(self) -> dict[str, Any]:
        """As identify.json has it."""
        said, less = self.place.to_dict(), None if self.less is None else self.less.to_dict()
        for each in (said, less or {}):
            each.pop("value", None)
        return {**said, "less": less, "predicted": list(self.predicted), "apart": list(self.apart)}


@dataclass(frozen=True, kw_only=True)
class Identification(Pictured):
    """Candidates, the most probable first; what would decide between those that are left; and the chance of such residuals.

    Those that are `alike` have the flanks of the best under another name, and run in its place.
    """

    measured: Measured
    candidates: tuple[Candidate, ...]
    deciding: tuple[Deciding, ...]
    alike: tuple[Candidate, ...]
    chance: float

    def __repr__(self) -> str:
        gear, best = self.best.gear, self.best
        size = f"m_n {gear.normal_module:.5g}"
        if best.diametral_pitch is not None:
            size = f"DP {best.diametral_pitch:g}{' transverse' if best.transverse else ''}"
        turned = f", helix {gear.helix_angle:.4g} deg" if gear.helix_angle else ""
        angle = f"{gear.rack.pressure_angle:g} deg{turned}, x {gear.profile_shift:.3f}"
        sure = "certain" if self.certain else "not certain"
        return f"<Identification of z = {self.measured.teeth}: {size}, {angle}, {100 * best.probability:.1f} %, {sure}>"

    @property
    def best(self) -> Candidate:
        return self.candidates[0]

    @property
    def fits(self) -> bool:
        """Whether the best has residuals as uncertainties make them."""
        return self.chance >= _LEAST_FIT

    @property
    def certain(self) -> bool:
        """Whether the best fits, every gauge touches its flanks, and all others together are improbable."""
        return self.fits and not self.best.off_involute and self.best.probability >= _CERTAIN

    @property
    def unlisted(self) -> float:
        """How probable it is that the gear is none of the candidates listed."""
        return max(1 - sum(each.probability for each in self.candidates), 0.0)

    @property
    def rivals(self) -> tuple[Candidate, ...]:
        """Those that are left beside the best."""
        return () if self.certain else tuple(each for each in self.candidates[1:] if each.probability >= (1 - _CERTAIN) / 5)

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before a gear is made by this."""
        found = list(self.measured.notices)
        if not self.fits:
            found.append(Notice("no-fit", f"no candidate fits: {self._misfit}; count and measure again"))
        if (thinning := self.best.gear.tooth_thinning) > _WORN * self.best.gear.normal_module:
            text = f"the teeth of the first candidate are {thinning:.2g} mm thinner than without backlash: worn, perhaps"
            found.append(Notice("thin-teeth", f"{text}; a gear that is made again has less tooth_thinning"))
        for each in self.best.off_involute:
            text = f"the {self.measured.label(each)} would not touch the involute of the first candidate"
            found.append(Notice("off-involute", text))
        return tuple(found)

    @property
    def _misfit(self) -> str:
        """What is wrong with the best: a reading, or else what such a gear has that hardly any has."""
        worst = max(range(len(self.measured.readings)), key=lambda each: abs(self.best.residuals[each]))
        if abs(off := self.best.residuals[worst]) >= _OFF:
            return f"the {self.measured.label(self.measured.readings[worst])} is {off:+.1f} uncertainties off"
        unusual = " and ".join(_UNUSUAL[each] for each in self.best.fit.unusual)
        return f"the first has the readings, but with a {unusual} as hardly any gear has"

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """What identify.json holds."""
        return {
            "kind": "identify",
            "teeth": self.measured.teeth,
            "mate_teeth": self.measured.mate_teeth,
            "readings": [each.to_dict() for each in self.measured.readings],
            "certain": self.certain,
            "chance": self.chance,
            "unlisted": self.unlisted,
            "candidates": [each.to_dict() for each in self.candidates],
            "alike": [self.candidates.index(each) + 1 for each in self.alike],
            "deciding": [each.to_dict() for each in self.deciding],
            "warnings": list(self.warnings),
            "notices": [each.to_dict() for each in self.notices],
        }
