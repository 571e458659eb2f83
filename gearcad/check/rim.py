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
from gearcad.notice import Notice
from gearcad.per_gear import PerGear, Role
from gearcad.rating.rim import RIM_LIMIT, RING_RIM_LIMIT

__all__ = ["bending_limits", "bending_notes", "rim_gates", "rim_notices"]

_SAME = 1e-9
"""mm: radii that do not differ."""

_SOURCE = "s_R/h_t from 1.2 on, ISO 6336-3:2006 clause 9"


class _Rim(NamedTuple):
    """The rim of one gear: its support, and its thickness over the tooth depth as it is modelled."""

    role: Role
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
        return f"the {self.role.value}'s rim ({thickness:.3g} mm, {self.ratio:.3g} tooth depths)"


def _rims(task: CheckTask) -> PerGear[_Rim]:
    supports, radii, gears = task.body.supports(task.pair), task.body.inner_radii(task.pair), task.pair.gears
    return PerGear.each(lambda role: _Rim(role, gears.pick(role), supports.pick(role), radii.pick(role)))


def rim_gates(task: CheckTask) -> Iterator[Comparison]:
    """A thin rim that is held rigidly does not bend: that is no model of it."""
    for rim in _rims(task):
        if rim.stiffened:
            yield at_most(
                f"tooth depth over rim, {rim.role.value}",
                1 / rim.ratio if rim.ratio > 0 else None,
                1 / RIM_LIMIT,
                "",
                _SOURCE,
                f'a rim as thin as that bends, which a rigid bore keeps it from: {rim.role.value}_support = "free"',
                reason="nothing is left of the rim",
            )


def bending_limits(task: CheckTask, summary: Summary) -> Iterator[Comparison]:
    """Where a rim bends, its roots are compressed more than stretched, and its bore is stretched too."""
    for role, rim in _rims(task).items():
        material = task.materials.pick(role)
        limit = material.root_limit
        least = limit[0] if isinstance(limit, tuple) else limit
        if least is None or not rim.support.bends:
            continue
        for words, value, note in (
            ("root compression", abs(summary.root_compression.pick(role)), "where a rim bends it changes sign"),
            ("tension on the bore", summary.bore_tension.pick(role), "where the rim bends"),
        ):
            source = f"limit of {material.name}"
            yield at_most(f"{words}, {rim.role.value}", value, least, "MPa", source, note, subject=Subject.STRENGTH)


def bending_notes(task: CheckTask, summary: Summary) -> PerGear[str]:
    """What the comparison of each gear's root tension with the standard's has to add where the rim bends."""

    def note(rim: _Rim) -> str:
        factor, compression = task.rating.roots.pick(rim.role).rim_thickness_factor, summary.root_compression.pick(rim.role)
        return (
            f"; the rim bends: Y_B = {factor:.3g} raises ISO's tension, in the FE it is the compression "
            f"({compression:.0f} MPa) that rises"
        )

    return _rims(task).map(lambda rim: note(rim) if rim.support.bends else "")


def rim_notices(task: CheckTask, summary: Summary) -> Iterator[Notice]:
    """How a thin rim is taken, and what is evaluated of it."""
    for rim in _rims(task):
        owner, hold = rim.role.value, rim.support.hold
        if rim.gear.internal:
            yield from _of_ring(rim)
        elif rim.support.bends:
            yield Notice("thin-rim", _bending(rim, task, summary))
        elif rim.ratio < RIM_LIMIT and hold is Hold.RIGID:
            text = f'{rim.words} is held rigidly, which keeps it from bending; {owner}_support = "free" lets it'
            yield Notice("rigid-rim", text)
        elif hold is Hold.SHAFT:
            yield Notice("bonded-shaft", f"the {owner} is bonded to its shaft: a fit that opens under load is softer")
        if hold is Hold.KEY:
            yield Notice(
                "key",
                f"the {owner}'s stresses are those with the key under the worst of all teeth; its stiffness is that of a "
                "bore without key, and the notch of the keyway is not in the section",
            )


def _of_ring(rim: _Rim) -> Iterator[Notice]:
    thickness = rim.ratio * (rim.gear.tip_diameter - rim.gear.root_diameter) / 2 / rim.gear.normal_module
    if rim.support.hold is Hold.BOLTS:
        text = (
            f"the ring is {rim.support.describe(rim.radius)}: at each the sector of a tooth is rigid from there outwards, and "
            "nothing holds the rim between them; root stresses are those of the loaded teeth"
        )
        yield Notice("bolted-ring", text)
    elif thickness < RING_RIM_LIMIT:
        text = (
            f"the ring's rim ({thickness:.3g} m_n, below {RING_RIM_LIMIT:g}) is held all round, as by a stiff housing, which "
            f'keeps it from bending; {rim.role.value}_support = "bolts" lets it bend between them'
        )
        yield Notice("rigid-rim", text)


def _bending(rim: _Rim, task: CheckTask, summary: Summary) -> str:
    tension, compression, bore = (
        each.pick(rim.role) for each in (summary.root_tension, summary.root_compression, summary.bore_tension)
    )
    teeth = "its loaded teeth" if task.body.solid else "all its teeth"
    return (
        f"{rim.words} bends: its bore is {rim.support.words} {format_number(round(2 * rim.radius, 4))} mm; root tension "
        f"({tension:.0f} MPa) and compression ({compression:.0f} MPa) are the greatest of {teeth}, the tension "
        f"on its bore is {bore or 0:.0f} MPa"
    )
