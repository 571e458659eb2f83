"""How safely a part bears its duty: safety, damage, life until failure, permissible torque."""

from __future__ import annotations

import math
from functools import partial

from gearcad.arrays import Floats
from gearcad.per_gear import Role
from gearcad.rating.strength.duty import Duty
from gearcad.rating.strength.part import Part, PartStrength
from gearcad.rating.strength.resistance import Resistance
from gearcad.rating.strength.spectrum import damage_sum, life_at_failure, safety_at_failure, torque_at_safety

__all__ = ["judged"]


def judged(part: Part, role: Role, duty: Duty, resistance: Resistance, required: float) -> PartStrength:
    """What a part bears of its duty: of a spectrum the safety is that at which the damage is 1 (ISO 6336-6)."""
    cycles, rate = duty.cycles.pick(role), duty.cycles_per_hour.pick(role)
    shares, stresses = duty.stresses(part, role)
    # A single load is held against the life factor, which stays after the last corner; Miner's line goes on.
    per_cycle = damage_sum(shares, stresses, resistance.curve, safety=required, endurance=duty.steady)
    safety = _safety(part, role, duty, resistance, 1.0)
    return PartStrength(
        part=part,
        required=required,
        stress=duty.governing.stresses[part].pick(role),
        resistance=resistance,
        cycles=duty.loaded_cycles.pick(role),
        safety=safety,
        beyond_knee=0.0 if duty.steady or cycles is None else _beyond_knee(cycles * shares, safety * stresses, resistance),
        damage=None if cycles is None else cycles * per_cycle,
        life=life_at_failure(1.0, rate * per_cycle) if rate else None,
        find_torque=partial(_permissible_torque, part, role, duty, resistance, required),
    )


def _safety(part: Part, role: Role, duty: Duty, resistance: Resistance, scale: float) -> float:
    """With all torques times `scale`."""
    cycles = duty.cycles.pick(role)
    shares, stresses = duty.stresses(part, role, scale)
    if duty.steady or cycles is None:
        return resistance.stress(duty.loaded_cycles.pick(role)) / float(stresses.max())
    return safety_at_failure(cycles * shares, stresses, resistance.curve)


def _beyond_knee(cycles: Floats, stresses: Floats, resistance: Resistance) -> float:
    """Share of the damage by stresses (MPa) below the last corner."""
    whole, above = (damage_sum(cycles, stresses, resistance.curve, endurance=end) for end in (False, True))
    return 1 - above / whole if 0 < whole < math.inf else 0.0


def _permissible_torque(part: Part, role: Role, duty: Duty, resistance: Resistance, required: float) -> float | None:
    """In N·m; None for one beyond all that a search looks at."""
    scale = torque_at_safety(partial(_safety, part, role, duty, resistance), required, 1.0)
    return scale * abs(duty.whole_torque) if math.isfinite(scale) else None
