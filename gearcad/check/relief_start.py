"""The pressure where linear reliefs start: with their transitions, and with half and twice as long ones."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from gearcad.check.comparison import Comparison, beside_limit
from gearcad.check.task import CheckTask
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.contact.shared.loaded import Cycle, FlankCompliance, FlexiblePair, PairContact
from gearcad.contact.shared.local_contact import onsets, start_lengths
from gearcad.core.records import JsonObject, Notice, PerGear, Role
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.modification import ReliefTransition, TransitionSource, longest_transition

__all__ = ["ReliefStart", "relief_starts", "start_comparisons", "start_notice", "start_notices"]

_HALF, _TWICE = 0.5, 2.0
"""Factors on the transitions for which the pressure is reported too, because it depends on them."""


class StartedRelief(NamedTuple):
    """A linear relief that starts where flanks carry: its name, its transition, and that one's length t_s (mm) on the flank."""

    name: str
    transition: ReliefTransition
    along_flank: float


@dataclass(frozen=True)
class ReliefStart:
    """The greatest pressure (MPa) where the linear reliefs of a gear start; None, for the `reason`, where none is told.

    `half` and `twice` are those with transitions half and twice as long, or as long as fits.
    """

    role: Role
    reliefs: tuple[StartedRelief, ...]
    pressure: float | None
    half: float | None
    twice: float | None
    reason: str = ""

    @property
    def assumed(self) -> bool:
        """Whether the length of a transition is assumed because none is given."""
        return any(of.transition.source is not TransitionSource.GIVEN for of in self.reliefs)

    @property
    def words(self) -> str:
        """The transitions, and the pressures with half and twice their lengths."""
        of_each = (
            f"{of.name.replace('_', ' ')}: t = {of.transition.length:.4g} mm of roll ({of.transition.source.value}), "
            f"t_s = {of.along_flank:.3g} mm along the flank, w = {1000 * of.transition.rounding:.3g} µm"
            for of in self.reliefs
        )
        others = [f"{value:.5g} MPa with {words} t" for value, words in ((self.half, "half"), (self.twice, "twice")) if value]
        return "; ".join([*of_each, *others])

    def to_dict(self) -> JsonObject:
        """Return the start as `check.json` has it: lengths in mm, w in µm, pressures in MPa."""
        reliefs = {
            of.name: {
                "transition": of.transition.length,
                "source": of.transition.source.value,
                "along_flank": of.along_flank,
                "rounding": 1000 * of.transition.rounding,
            }
            for of in self.reliefs
        }
        pressures = {"pressure": self.pressure, "pressure_half": self.half, "pressure_twice": self.twice}
        return {"gear": self.role.value, **pressures, "reason": self.reason, "reliefs": reliefs}


def relief_starts(cycle: Cycle) -> tuple[ReliefStart, ...]:
    """Return the pressures at the starts of linear reliefs of each gear that has one where flanks carry. Raises SolverError."""
    model = cycle.model
    started = _started(model.pair)
    if not any(started):
        return ()
    angles = model.roll_angle(start_lengths(model.line)).tolist()
    passing = (contact for angle in angles for contact in cycle.contacts_at(angle))
    own = _greatest((*passing, *(contact for _, contact in cycle.contacts)))
    half, twice = (_again(cycle, angles, factor) for factor in (_HALF, _TWICE))
    return tuple(
        _start(role, reliefs, own.pick(role), half.pick(role), twice.pick(role)) for role, reliefs in started.items() if reliefs
    )


def _start(role: Role, reliefs: tuple[StartedRelief, ...], pressure: float, half: float, twice: float) -> ReliefStart:
    """Return the pressures (MPa) at the starts of one gear's reliefs, with the reason where there is no pressure."""
    told = [value if value > 0 else None for value in (pressure, half, twice)]
    if any(not of.transition.length for of in reliefs):
        return ReliefStart(role, reliefs, None, None, None, "unbounded: a relief with a transition of 0 starts with a kink")
    reason = (
        "" if told[0] else "not resolved: the contact there reaches an end of the flank, or the transition is too short for it"
    )
    return ReliefStart(role, reliefs, told[0], told[1], told[2], reason)


def _started(pair: GearPair | RackPair) -> PerGear[tuple[StartedRelief, ...]]:
    """Return the linear reliefs of each gear that start where flanks carry."""
    line = line_of_action(pair)
    ends = [line.lengths(end) for end in pair.usable_path]

    def of(role: Role) -> tuple[StartedRelief, ...]:
        flank = line.flanks.pick(role)
        first, last = sorted(end.pick(role) for end in ends)
        every = zip(flank.form.transitions.items(), onsets(flank), strict=True)
        return tuple(StartedRelief(*item, onset.length) for item, onset in every if first < onset.roll < last)

    return PerGear.each(of)


def _greatest(found: Iterable[PairContact]) -> PerGear[float]:
    """Return the greatest pressures (MPa) at the starts of each gear's reliefs, 0 where there are none."""
    every = [contact.start_pressures for contact in found]
    return PerGear.each(lambda role: max((told.pick(role) for told in every if told.pick(role) > 0), default=0.0))


def _again(cycle: Cycle, angles: list[float], factor: float) -> PerGear[float]:
    """Return the greatest pressures (MPa) at roll angles (deg) with transitions as long as `factor` times these."""
    model: FlexiblePair[FlankCompliance] = cycle.model
    if isinstance(pair := model.pair, RackPair):  # flanks of a rack are not modified
        changed = model.with_flanks(replace(pair, pinion=_with_transitions(pair.pinion, factor)))
    else:
        pinion, wheel = (_with_transitions(gear, factor) for gear in pair.gears)
        changed = model.with_flanks(replace(pair, pinion=pinion, wheel=wheel))
    other: Cycle = replace(cycle, model=changed, positions=(), between=())
    return _greatest(contact for angle in angles for contact in other.contacts_at(angle))


def _with_transitions(gear: Gear, factor: float) -> Gear:
    """Return a gear whose linear reliefs have transitions `factor` times as long, or as long as fits."""
    form = gear.flank_form
    changed: dict[str, Any] = {
        f"{name}_transition": min(
            factor * of.length, float(longest_transition(getattr(gear.modification, f"{name}_length"), form.last - form.first))
        )
        for name, of in form.transitions.items()
    }
    return replace(gear, modification=replace(gear.modification, **changed))


def start_comparisons(task: CheckTask, starts: tuple[ReliefStart, ...]) -> Iterator[Comparison]:
    """Yield the pressure at each start beside the contact limit, for information."""
    limit, source = _limit(task)
    for start in starts:
        reason = start.reason or ("" if limit else f"no contact_limit is given; {start.pressure:.5g} MPa")
        words = f"pressure at the start of the relief, {start.role.value}"
        yield beside_limit(words, start.pressure, limit, "MPa", source, start.words, reason)


def start_notices(task: CheckTask, starts: tuple[ReliefStart, ...]) -> Iterator[Notice]:
    """Yield what to know of the pressures at the starts: transitions that are assumed, a limit that is exceeded, none told."""
    limit, _ = _limit(task)
    for start in starts:
        exceeded = start.pressure is not None and limit is not None and start.pressure > limit
        if not (start.assumed or exceeded or start.pressure is None):
            continue
        told = start.reason if start.pressure is None else f"{start.pressure:.0f} MPa"
        if exceeded:
            told += f", above the contact limit of {limit:g} MPa: a caution, no failure"
        advice = "a longer transition or the parabolic shape lowers it"
        if start.assumed:
            advice += "; give the transition that is made (tip_relief_transition, root_relief_transition)"
        yield Notice(
            "relief-start", f"linear relief of the {start.role.value}, pressure at its start: {told}; {start.words}; {advice}"
        )


def start_notice(pair: GearPair) -> Iterator[Notice]:
    """Yield a notice if a linear relief of the pair starts where its flanks carry: its pressure there is local."""
    found = [
        f"{of.name.replace('_', ' ')} of the {role.value} {of.transition.length:.4g} mm ({of.transition.source.value})"
        for role, reliefs in _started(pair).items()
        for of in reliefs
    ]
    if found:
        yield Notice(
            "relief-start",
            "linear relief starts where the flanks carry: the bound is kept more than three half widths of the contact away "
            "from there; at the start itself the pressure depends on the transition (mm of roll), and a check tells it: "
            + ", ".join(found),
        )


def _limit(task: CheckTask) -> tuple[float | None, str]:
    """Return the lesser contact limit of both gears (MPa), and whose it is."""
    known = []
    for material in task.materials:
        if (limit := material.contact_limit) is not None:
            known.append((limit[0] if isinstance(limit, tuple) else limit, f"limit of {material.name}"))
    return min(known, default=(None, "local: no verdict"))
