"""What to know of a full rating: what was assumed, what is to be verified, notices."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gearcad.errors import InputError, format_number
from gearcad.geometry import GearPair, RackPair
from gearcad.material import Material
from gearcad.notice import Notice
from gearcad.per_gear import PerGear, Role
from gearcad.rating.factors import to_verify
from gearcad.rating.factors.life import endurance_cycles
from gearcad.rating.strength.part import Part, PartStrength
from gearcad.rating.strength.root import notch_strength
from gearcad.rating.strength.task import StrengthTask
from gearcad.schema import assumed_values, is_assumed, schema_of

__all__ = ["assumed_of", "notices_of", "verify_of"]


def assumed_of(task: StrengthTask) -> Iterator[str]:
    """Yield one sentence for each input that was assumed."""
    yield from _defaults(task)
    yield from task.conditions.assumed
    if task.hardening.assumed:
        yield task.hardening.assumed
    for role, material in task.materials.items():
        if material.group is not None and task.limits.pick(role).root is not None:
            notch = task.nominal.roots.pick(role).section.notch_parameter
            if said := notch_strength(material, material.group, notch).assumed:
                yield f"{said} ({task.nominal.names.pick(role)})"
    if isinstance(task.rated, RackPair) and task.duty.cycles.wheel is not None and task.options.load_cycles is None:
        yield "load cycles of the rack are those of the pinion"
    if task.duty.cycles.pinion is None and task.load.speed:
        yield "no life and no load cycles are given: endurance limits hold, with Z_NT = Y_NT = 1"
    if not isinstance(task.load_factors, InputError):
        yield from task.load_factors.assumed
    if task.scuffing is not None and task.scuffing.judged:
        yield from task.scuffing.assumed


def _defaults(task: StrengthTask) -> Iterator[str]:
    """Yield the defaults that a rating goes by and that nobody gave: of [rating], of the load and of the materials."""
    options = task.options
    for key, _ in assumed_values(options):
        if _counts(task, key):
            of = f" of {options.accuracy.value}" if key == "accuracy_grade" else ""
            yield f"{key} = {getattr(options, key):g}{of}"
    if is_assumed(task.load.application_factor) and not options.bins:
        yield f"application_factor = {task.load.application_factor:g}"
    found: dict[str, list[str]] = {}
    for role, material in task.materials.items():
        said = ", ".join(_constant(material, key) for key, _ in assumed_values(material) if key != "name")
        found.setdefault(said, []).append(task.nominal.names.pick(role))
    yield from (f"{said} of {' and '.join(names)}" for said, names in found.items() if said)


def _constant(material: Material, key: str) -> str:
    """A property of a material with its key and unit."""
    unit = schema_of(Material)[key].symbol.unit
    return f"material.{key} = {format_number(getattr(material, key))}{f' {unit}' if unit else ''}"


def _counts(task: StrengthTask, key: str) -> bool:
    """Whether an option plays a part: the grade where a gear has none of its own, cycles where any are counted."""
    if key == "accuracy_grade":
        return any(gear.accuracy_grade is None for gear in task.pair_gears)
    if key in ("contacts_per_turn", "long_life_factor"):
        cycles = any(each is not None for each in task.duty.cycles)
        return cycles and not (key == "contacts_per_turn" and task.options.load_cycles is not None)
    return True


def verify_of(task: StrengthTask) -> Iterator[str]:
    """Symbols of what is to be verified."""
    yield from task.nominal.verify
    for each in task.limits:
        yield from each.verify
    yield from to_verify(
        task.options.standard,
        internal=isinstance(task.rated, GearPair) and task.rated.internal,
        limited_flank=_limited(task, Part.FLANK),
        limited_root=_limited(task, Part.ROOT),
    )
    if not isinstance(task.load_factors, InputError):
        yield from task.load_factors.verify
    if task.scuffing is not None and task.scuffing.judged:
        yield from task.scuffing.verify


def _limited(task: StrengthTask, part: Part) -> bool:
    """Whether a gear has fewer load cycles than its endurance limit asks for."""
    found = ((task.resistance(part, role), task.duty.cycles.pick(role)) for role in Role)
    return any(each is not None and cycles is not None and cycles < endurance_cycles(each.points) for each, cycles in found)


_MATTERS = 0.01
"""Share of a damage from which it is told what it rests on."""


def notices_of(task: StrengthTask, parts: Mapping[Part, PerGear[PartStrength]]) -> Iterator[Notice]:
    """Of the nominal rating, of load factors and scuffing, and of damage by loads that a life factor would have none of."""
    yield from task.nominal.notices
    if not isinstance(task.load_factors, InputError):
        yield from task.load_factors.notices
    if task.scuffing is not None and task.scuffing.judged:
        yield from task.scuffing.notices
    yield from _beyond_knee(parts, task.nominal.names)


def _beyond_knee(parts: Mapping[Part, PerGear[PartStrength]], names: PerGear[str]) -> Iterator[Notice]:
    """Of all parts in one."""
    found = [
        f"{share:.0%} of the {part.value} of the {names.pick(role)}"
        for part, both in parts.items()
        for role, each in both.items()
        if (share := each.beyond_knee) >= _MATTERS
    ]
    if found:
        text = "damage by loads that alone could be borne beyond 10^10 load cycles, where the S-N line goes on (ISO 6336-6)"
        yield Notice("beyond-knee", f"spectrum: {text}: {', '.join(found)}")
