"""Pairs with a gear of plastic in a check: contact ratio under load, and root stress with true sharing beside VDI 2736-2.

Teeth of plastic bend by so much that contact begins before the path of contact and ends after it, so more pairs share the load
than the teeth have without it. The guideline puts the whole load on the tip of one tooth.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcad.check.comparison import Comparison, beside
from gearcad.check.task import CheckTask
from gearcad.contact.shared.loaded import Cycle
from gearcad.core.records import JsonObject, Notice, PerGear, Role

if TYPE_CHECKING:
    from gearcad.check.summary import Summary

_HALVINGS = 20
"""Steps by which the end of a contact is found between two positions: a millionth of their distance."""

_RELIEF = 0.5
"""Tip relief that deformed teeth need, over the deformation of a pair of them."""


@dataclass(frozen=True, kw_only=True)
class PlasticCheck:
    """Figures of a check with a gear of plastic, to stand beside those of VDI 2736-2; stresses in MPa, tip relief in µm.

    `contact_ratio` is that of the teeth without load, of helical pairs in total. `moduli` are those of the check, at the
    temperature of the roots (°C) where it is known.
    """

    temperature: float | None
    moduli: PerGear[float]
    contact_ratio: float
    contact_ratio_under_load: float
    root_stresses: PerGear[float | None]
    guideline: PerGear[float]
    tip_relief: float | None

    def to_dict(self) -> JsonObject:
        """Return the values as `check.json` has them."""
        roots = {
            role.value: {"under_load": self.root_stresses.pick(role), "guideline": self.guideline.pick(role)} for role in Role
        }
        return {
            "temperature": self.temperature,
            "youngs_modulus": {role.value: modulus for role, modulus in self.moduli.items()},
            "contact_ratio": self.contact_ratio,
            "contact_ratio_under_load": self.contact_ratio_under_load,
            "root_stress": roots,
            "tip_relief": self.tip_relief,
        }

    def comparisons(self, band: float) -> tuple[Comparison, ...]:
        """Return the values beside the guideline's, for information; `band` is that of root stresses."""
        source = "VDI 2736-2, all of the load at the tip"
        note = "the teeth under load share it over a longer contact"
        roots = (
            beside(f"root stress, {role.value}, VDI 2736-2", stress, self.guideline.pick(role), band, "MPa", source, note)
            for role, stress in self.root_stresses.items()
            if stress is not None
        )
        ratio = beside(
            "contact ratio under load",
            self.contact_ratio_under_load,
            self.contact_ratio,
            band,
            "",
            "contact ratio of the teeth without load",
            "contact begins before the path of contact and ends after it",
        )
        return (*roots, ratio)


def plastic_check(task: CheckTask, cycle: Cycle, summary: Summary) -> PlasticCheck | None:
    """Return what a check has beside VDI 2736-2; None for a pair without a gear of plastic, and for a ring."""
    rated = task.strength_rating.plastic
    if rated is None:
        return None
    bent, found = rated.deformation.value, rated.temperatures
    return PlasticCheck(
        temperature=None if found is None else found.root,
        moduli=task.materials.map(lambda each: float(each.youngs_modulus)),
        contact_ratio=task.pair.total_contact_ratio,
        contact_ratio_under_load=contact_ratio_under_load(cycle),
        root_stresses=summary.root_tension,
        guideline=rated.root_stresses,
        tip_relief=None if bent is None else 1000 * _RELIEF * bent,
    )


def contact_ratio_under_load(cycle: Cycle) -> float:
    """Return the mean number of pairs of teeth that touch over a base pitch; their first and last contacts are sought."""
    pitch = 360 / cycle.model.pair.pinion.teeth
    angles = [-pitch / 2, *(each.roll_angle for each in cycle.every), pitch / 2]

    def touching(angle: float) -> frozenset[int]:
        return frozenset(contact.tooth for contact in cycle.contacts_at(angle))

    known = [touching(angles[0]), *(frozenset(c.tooth for c in each.contacts) for each in cycle.every), touching(angles[-1])]
    touched = 0.0
    for start, end, before, after in zip(angles, angles[1:], known, known[1:], strict=False):
        touched += len(before & after) * (end - start)
        for tooth in before ^ after:
            low, high = start, end
            for _ in range(_HALVINGS):
                middle = (low + high) / 2
                low, high = (middle, high) if (tooth in touching(middle)) is (tooth in before) else (low, middle)
            touched += low - start if tooth in before else end - low
    return touched / pitch


def plastic_notices(task: CheckTask, found: PlasticCheck | None) -> tuple[Notice, ...]:
    """Return a notice on moduli whose temperature is not known."""
    if found is None or found.temperature is not None or task.rated_material is None:
        return ()
    text = "the temperature of the teeth is not known: the check takes the moduli of plastics at room temperature"
    return (Notice("plastic-modulus", text),)
