"""How safely a part bears its duty: safety, damage, life until failure, permissible torque."""

from __future__ import annotations

import math

from gearcad.per_gear import Role
from gearcad.rating.strength.duty import Duty
from gearcad.rating.strength.part import Part, PartStrength
from gearcad.rating.strength.resistance import Resistance
from gearcad.rating.strength.spectrum import damage_sum, life_at_failure, safety_at_failure, torque_at_safety

__all__ = ["judged"]


def judged(part: Part, role: Role, duty: Duty, resistance: Resistance, required: float, *, torque: bool = True) -> PartStrength:
    """What a part bears of its duty: of a spectrum the safety is that at which the damage is 1 (ISO 6336-6).

    Without `torque` the permissible one is left out.
    """
    cycles, rate = duty.cycles.pick(role), duty.cycles_per_hour.pick(role)
    shares, stresses = duty.stresses(part, role)
    spectrum = bool(duty.options.bins)

    def safety(scale: float) -> float:
        _, loads = duty.stresses(part, role, scale)
        if not spectrum or cycles is None:
            return resistance.stress(cycles) / float(loads.max())
        return safety_at_failure(cycles * shares, loads, resistance.curve)

    # A single load is held against the life factor, which stays after the last corner; Miner's line goes on.
    per_cycle = damage_sum(shares, stresses, resistance.curve, safety=required, endurance=not spectrum)
    return PartStrength(
        part=part,
        required=required,
        stress=float(stresses.max()),
        resistance=resistance,
        cycles=cycles,
        safety=safety(1.0),
        damage=None if cycles is None else cycles * per_cycle,
        life=life_at_failure(1.0, rate * per_cycle) if rate else None,
        permissible_torque=_torque(abs(duty.load.torque) * torque_at_safety(safety, required, 1.0)) if torque else None,
    )


def _torque(value: float) -> float | None:
    """None for one beyond all that a search looks at."""
    return value if math.isfinite(value) else None
