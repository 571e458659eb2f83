"""What a check says about rims: those too thin to be held rigidly, and what is evaluated of those that bend."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from gearcad.check.comparison import Comparison, Subject, at_most
from gearcad.check.summary import Summary
from gearcad.check.task import CheckTask
from gearcad.contact.shared.holding import Hold, Support, rim_ratio
from gearcad.errors import format_number
from gearcad.geometry import Gear
from gearcad.rating.iso6336_3 import RIM_LIMIT

__all__ = ["bending_limits", "bending_notes", "rim_gates", "rim_warnings"]

_SAME = 1e-9
"""mm: radii that do not differ."""

_SOURCE = "s_R/h_t from 1.2 on, ISO 6336-3:2006 clause 9"


class _Rim(NamedTuple):
    """The rim of one gear: its support, and its thickness over the tooth depth as it is modelled."""

    owner: str
    gear: Gear
    support: Support
    radius: float

    @property
    def ratio(self) -> float:
        return rim_ratio(self.gear, self.radius)

    @property
    def stiffened(self) -> bool:
        """True if the gear has a thin rim, and the model keeps it from bending."""
        bore = self.gear.body.bore / 2
        thin = bool(bore) and rim_ratio(self.gear, bore) < RIM_LIMIT
        return thin and self.support.hold is Hold.RIGID and self.radius > bore - _SAME

    @property
    def words(self) -> str:
        thickness = self.ratio * (self.gear.tip_diameter - self.gear.root_diameter) / 2
        return f"the {self.owner}'s rim ({thickness:.3g} mm, {self.ratio:.3g} tooth depths)"


def _rims(task: CheckTask) -> Iterator[_Rim]:
    body, pair = task.body, task.pair
    gears = zip(("pinion", "wheel"), (pair.pinion, pair.wheel), body.supports(pair), body.inner_radii(pair), strict=True)
    for owner, gear, support, radius in gears:
        yield _Rim(owner, gear, support, radius)


def rim_gates(task: CheckTask) -> Iterator[Comparison]:
    """A thin rim that is held rigidly does not bend: that is no model of it."""
    for rim in _rims(task):
        if rim.stiffened:
            yield at_most(
                f"tooth depth over rim, {rim.owner}",
                1 / rim.ratio if rim.ratio > 0 else None,
                1 / RIM_LIMIT,
                "",
                _SOURCE,
                f'a rim as thin as that bends, which a rigid bore keeps it from: {rim.owner}_support = "free"',
                reason="nothing is left of the rim",
            )


def bending_limits(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """Where a rim bends, its roots are compressed more than stretched, and its bore is stretched too."""
    limit = task.material.root_limit
    least = limit[0] if isinstance(limit, tuple) else limit
    for gear, rim in enumerate(_rims(task)):
        if least is None or not rim.support.bends:
            continue
        for words, value, note in (
            ("root compression", abs(summary.root_compression[gear]), "where a rim bends it changes sign"),
            ("tension on the bore", summary.bore_tension[gear], "where the rim bends"),
        ):
            source = f"limit of {task.material.name}"
            yield at_most(f"{words}, {rim.owner}", value, least, "MPa", source, note, Subject.STRENGTH)


def bending_notes(task: CheckTask, summary: Summary) -> tuple[str, str]:
    """What the comparison of each gear's root tension with the standard's has to add where the rim bends."""
    notes = [
        f"; the rim bends: Y_B = {rating.rim_thickness_factor:.3g} raises ISO's tension, in the FE it is the compression "
        f"({compression:.0f} MPa) that rises"
        if rim.support.bends
        else ""
        for rim, rating, compression in zip(_rims(task), task.rating.roots, summary.root_compression, strict=True)
    ]
    return notes[0], notes[1]


def rim_warnings(task: CheckTask, summary: Summary) -> Iterator[str]:
    """How a thin rim is taken, and what is evaluated of it."""
    for gear, rim in enumerate(_rims(task)):
        if rim.support.bends:
            tension, compression = summary.root_tension[gear], summary.root_compression[gear]
            bore = summary.bore_tension[gear]
            teeth = "all its teeth" if not task.body.solid else "its loaded teeth"
            yield (
                f"{rim.words} bends: its bore is {rim.support.words} {format_number(_bore(task, gear))} mm; root tension "
                f"({tension:.0f} MPa) and compression ({compression:.0f} MPa) are the greatest of {teeth}, the tension "
                f"on its bore is {bore or 0:.0f} MPa"
            )
        elif rim.ratio < RIM_LIMIT and rim.support.hold is Hold.RIGID:
            yield f'{rim.words} is held rigidly, which keeps it from bending; {rim.owner}_support = "free" lets it'
        elif rim.support.hold is Hold.SHAFT:
            yield f"the {rim.owner} is bonded to its shaft: a fit that opens under load is softer"
        if rim.support.hold is Hold.KEY:
            yield (
                f"the {rim.owner}'s stresses are those with the key under the worst of all teeth; its stiffness is that of a "
                "bore without key, and the notch of the keyway is not in the section"
            )


def _bore(task: CheckTask, gear: int) -> float:
    return round(2 * task.body.inner_radii(task.pair)[gear], 4)
