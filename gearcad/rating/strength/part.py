"""PartStrength: what one flank or root of a gear carries, and how safely."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from typing import Any

from gearcad.rating.strength.resistance import Resistance
from gearcad.verdict import Verdict

__all__ = ["INFINITE", "Part", "PartStrength", "told"]

INFINITE = "infinite"
"""What documents say of a life without end."""


class Part(Enum):
    """What of a gear is rated."""

    FLANK = "flank"
    ROOT = "root"

    @property
    def index(self) -> str:
        """That of its symbols: sigma_H, S_F."""
        return "H" if self is Part.FLANK else "F"


@dataclass(frozen=True, kw_only=True)
class PartStrength:
    """Of one gear: stresses in MPa, torque in N·m on the pinion, life in hours; None is what is not known.

    `stress` is sigma_H or sigma_F under all load factors, `strength` sigma_HG or sigma_FG after the load `cycles` (None: the
    endurance limit), whose `factors` stand under their symbols. `damage` and `life` are those at the `required` safety; a life
    can be infinite. `beyond_knee` is the share of the damage of a spectrum, at the safety, that its loads below the last corner
    of the S-N line do. Without a `safety` it was not judged, for the `reason`. `find_torque` finds the permissible torque.
    """

    part: Part
    required: float
    stress: float | None = None
    resistance: Resistance | None = None
    cycles: float | None = None
    safety: float | None = None
    damage: float | None = None
    life: float | None = None
    beyond_knee: float = 0.0
    reason: str = ""
    find_torque: Callable[[], float | None] | None = field(default=None, repr=False, compare=False)

    @cached_property
    def factors(self) -> Mapping[str, float]:
        """Of permissible stress, under their symbols; none where they are not known."""
        return {} if self.resistance is None else self.resistance.factors(self.cycles)

    @cached_property
    def permissible_torque(self) -> float | None:
        """On the pinion at the required safety, with load factors of its own; sought when it is first asked for."""
        return None if self.find_torque is None else self.find_torque()

    @property
    def strength(self) -> float | None:
        """sigma_HG or sigma_FG."""
        return None if self.resistance is None else self.resistance.reference * math.prod(self.factors.values())

    @property
    def permissible_stress(self) -> float | None:
        """sigma_HP or sigma_FP: the strength over the required safety."""
        return None if self.strength is None else self.strength / self.required

    @property
    def verdict(self) -> Verdict:
        """Whether the safety is as large as is required."""
        if self.safety is None:
            return Verdict.NOT_JUDGED
        return Verdict.PASSED if self.safety >= self.required else Verdict.FAILED

    def stresses(self) -> dict[str, float | None]:
        """Under their symbols."""
        of = self.part.index
        return {f"sigma_{of}": self.stress, f"sigma_{of}G": self.strength, f"sigma_{of}P": self.permissible_stress}


def told(value: float | None) -> Any:
    """As JSON has it: a number, or that it is infinite."""
    return INFINITE if value is not None and math.isinf(value) else value
