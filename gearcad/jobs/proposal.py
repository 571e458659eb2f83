"""Proposal: flank modifications for a load, and what they do to the mesh."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

from gearcad.check.extremes import SOLID
from gearcad.check.options import Model
from gearcad.check.relief_start import start_notice
from gearcad.contact.optimum.variants import Condition
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.designs import PairDesign
from gearcad.errors import ParameterError
from gearcad.geometry import GearPair
from gearcad.notice import Notice, texts
from gearcad.reprs import Pictured

__all__ = ["SUFFIX", "CycleFigures", "Proposal", "Robustness"]

SUFFIX = "-modified"
"""What the name of a modified design ends in."""


@dataclass(frozen=True, kw_only=True)
class CycleFigures:
    """What a check says of a mesh cycle: transmission error in µm, stresses in MPa, and at how many positions a tip's edge
    carries.
    """

    transmission_error_peak_to_peak: float
    transmission_error_harmonics: tuple[float, float, float]
    contact_pressure: float
    root_tension_pinion: float
    root_tension_wheel: float
    face_load_factor: float
    edge_positions: int

    @classmethod
    def of(cls, cycle: SolidCycle) -> CycleFigures:
        """Those of a cycle with the extremes of a check. Raises ParameterError where all contact is beside edges."""
        extremes = {quantity.name: found.value for quantity in SOLID if (found := cycle.extreme(quantity)) is not None}
        if "contact_pressure" not in extremes:
            permitted = "must leave a place of contact away from the edges of the flanks: beside them no pressure is told"
            raise ParameterError("torque", cycle.torque, permitted, "N·m")
        first, second, third = cycle.harmonics[:3].tolist()
        return cls(
            transmission_error_peak_to_peak=extremes["transmission_error_max"] - extremes["transmission_error_min"],
            transmission_error_harmonics=(first, second, third),
            contact_pressure=extremes["contact_pressure"],
            root_tension_pinion=extremes["root_tension_pinion"],
            root_tension_wheel=extremes["root_tension_wheel"],
            face_load_factor=cycle.face_load_factor,
            edge_positions=cycle.edge_positions,
        )


class Robustness(NamedTuple):
    """Transmission error, peak to peak (µm), as the pair is and as proposed, under another condition than the load."""

    condition: Condition
    before: float
    after: float

    def to_dict(self) -> dict[str, float]:
        """As the document of a proposal has it: the condition's fields, and both errors."""
        return {**asdict(self.condition), "before": self.before, "after": self.after}


@dataclass(frozen=True, kw_only=True)
class Proposal(Pictured):
    """Modifications for a design at a torque (N·m on the pinion), and what they do; `pair` is the design's with them.

    `bound` (MPa) is that of the contact pressure. All figures are those that a check of solid bodies finds.
    """

    model: ClassVar[Model] = Model.SOLID

    design: PairDesign
    pair: GearPair
    torque: float
    bound: float
    variants: int
    before: CycleFigures
    after: CycleFigures
    robustness: tuple[Robustness, ...]

    def __repr__(self) -> str:
        errors = (each.transmission_error_peak_to_peak for each in (self.before, self.after))
        return f"<Proposal for {self.design.name!r} at {self.torque:g} N·m: {' -> '.join(f'{each:.3g}' for each in errors)} µm>"

    @property
    def name(self) -> str:
        """Of the modified design."""
        return self.design.name + SUFFIX

    @cached_property
    def changes(self) -> dict[str, float | str]:
        """The keys of the spec that change, with their values."""
        found: dict[str, float | str] = {"pair.name": self.name}
        for role, gear in self.pair.gears.items():
            old, new = self.design.pair.gears.pick(role).modification.to_dict(), gear.modification.to_dict()
            for name, value in new.items():
                if value != old[name] and (name in gear.modification.in_use or not name.endswith(("_length", "_shape"))):
                    found[f"{role.value}.modification.{name}"] = value
        return found

    @property
    def notes(self) -> dict[str, str]:
        """Units, to stand behind new keys."""
        numbers = [key for key, value in self.changes.items() if not isinstance(value, str)]
        return {key: "mm of roll" if key.endswith("_length") else "µm" for key in numbers}

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What an engineer should know before making this."""
        after, bound, found = self.after, self.bound, []
        if after.contact_pressure > bound:
            text = f"the contact pressure is {after.contact_pressure:.0f} MPa, above the bound of {bound:.0f} MPa"
            found.append(Notice("pressure-above-bound", text))
        if after.edge_positions:
            text = (
                f"a tip edge still touches at {after.edge_positions} positions: to free it would cost transmission error or "
                "pressure above the bound"
            )
            found.append(Notice("tip-edge-contact", text))
        if after.transmission_error_peak_to_peak > self.before.transmission_error_peak_to_peak:
            text = "the transmission error is not less than it was: the flanks as they are break the bounds"
            found.append(Notice("transmission-error-not-less", text))
        found.extend(start_notice(self.pair))
        return tuple(found)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices as texts."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """The proposal under the names of its document."""
        return {
            "model": self.model.value,
            "torque": self.torque,
            "pressure_bound": self.bound,
            "variants": self.variants,
            "changes": self.changes,
            "before": asdict(self.before),
            "after": asdict(self.after),
            "robustness": [each.to_dict() for each in self.robustness],
            "warnings": list(self.warnings),
            "notices": [each.to_dict() for each in self.notices],
        }
