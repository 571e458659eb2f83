"""The pair of Uhlir's thesis, and an integrator of the equations of any ContactModel that shares nothing with ours."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from gearcad import Gear, GearPair
from gearcad.dynamics.time_domain.contact_model import ContactModel, EngagedPairs, disc_inertia

Floats = NDArray[np.float64]

THESIS_SPEEDS = np.arange(0, 20001, 500.0)


def thesis_pair(**changes: float) -> GearPair:
    pinion, wheel = (Gear(teeth=teeth, normal_module=1.75, face_width=20.0, **changes) for teeth in (19, 23))
    return GearPair(pinion=pinion, wheel=wheel)


def thesis_model(pair: GearPair | None = None, **changes: Any) -> ContactModel:
    """Table 3.1: k = 400 000 N/m, b = 4 kg/s, M_1 = 10 N·m, discs of 7250 kg/m³ with the reference diameters."""
    pair = pair or thesis_pair()
    inertias = [disc_inertia(gear.reference_diameter, gear.face_width, 7250.0) for gear in (pair.pinion, pair.wheel)]
    given = {"inertias": tuple(inertias), "pair_stiffness": 0.4, "damping": 4.0, "torque": 10.0}
    return ContactModel.from_pair(pair, **given | changes)


class Witness:
    """J_1 phi_1'' = M_1 - R_b1 f, J_2 phi_2'' = M_2 - R_b2 f by DOP853, stopped at every event; not reduced to one unknown.

    State: R_b1 phi_1, R_b2 phi_2 and their rates in SI units, both counter-clockwise. Tooth i of the pinion touches the wheel
    at rho = R_b1 phi_1 + i p_b from T1 with its front flank, at C - rho from the other base tangent point with its back flank.
    """

    def __init__(self, model: ContactModel) -> None:
        self.model = model
        self.masses = [J / (1e-3 * R) ** 2 for J, R in zip(model.inertias, model.base_radii, strict=True)]
        self.force = model.torque / (1e-3 * model.base_radii[0])
        self.stiffness, self.damping = 1e6 * model.pair_stiffness, model.damping
        self.pitch, self.first, self.last = (1e-3 * x for x in (model.base_pitch, model.first_contact, model.last_contact))
        self.gap = math.inf if model.backlash is None else 1e-3 * model.backlash
        self.mirror = math.nan if model.back_place is None else 1e-3 * model.back_place
        assert model.zone is EngagedPairs.RIGID_TIPS

    def force_of(self, state: Floats, side: int, pairs: int) -> float:
        y, rate = state[0] + state[1], state[2] + state[3]
        depth = {1: y, 0: 0.0, -1: y + self.gap}[side]
        return pairs * self.stiffness * depth + self.damping * rate

    def rates(self, _: float, state: Floats, side: int, pairs: int) -> list[float]:
        resisted = self.force - self.force_of(state, side, pairs)
        return [state[2], state[3], resisted / self.masses[0], resisted / self.masses[1]]

    def teeth(self, side: int, travel: float) -> set[int]:
        """Teeth whose flank is within the zone of contact."""
        around = range(int(-travel / self.pitch) - 6, int(-travel / self.pitch) + 12)
        places = {i: travel + i * self.pitch if side == 1 else self.mirror - travel - i * self.pitch for i in around}
        return {i for i, place in places.items() if self.first <= place <= self.last}

    def levels(self, side: int, teeth: set[int], travel: float) -> list[tuple[float, int, int, int]]:
        """(travel, direction, tooth, +1 to come or -1 to go): the next places at which the set of teeth changes."""
        ends = (self.first, self.last) if side == 1 else (self.mirror - self.last, self.mirror - self.first)
        lowest, highest = min(teeth), max(teeth)
        return [
            (ends[0] - (lowest - 1) * self.pitch, 1, lowest - 1, 1),
            (ends[0] - lowest * self.pitch, -1, lowest, -1),
            (ends[1] - highest * self.pitch, 1, highest, -1),
            (ends[1] - (highest + 1) * self.pitch, -1, highest + 1, 1),
        ]

    def run(self, speed: float, duration: float, samples: int, rtol: float = 1e-10) -> Floats:
        """(4, samples) from flanks that just touch, every duration/samples seconds."""
        times = np.arange(samples) * (duration / samples)
        out = np.full((4, samples), np.nan)
        drift = speed * math.pi / 30 * 1e-3 * self.model.base_radii[0]
        state, t, side = np.array([0.0, 0.0, drift, -drift]), 0.0, 1
        teeth = self.teeth(1, 0.0)
        while t < duration:
            levels = self.levels(side, teeth, state[0]) if side else []
            parting = {1: [(0.0, -1)], 0: [(0.0, 1), (-self.gap, -1)], -1: [(-self.gap, 1)]}[side]
            events = [_event(lambda s: s[0], level, way) for level, way, *_ in levels]
            events += [_event(lambda s: s[0] + s[1], level, way) for level, way in parting if math.isfinite(level)]
            wanted = times[(times >= t) & (times < duration)]
            solution = solve_ivp(
                self.rates, (t, duration), state, "DOP853", t_eval=wanted, events=events, args=(side, len(teeth)),
                rtol=rtol, atol=1e-16, max_step=5e-5,
            )  # fmt: skip
            place = np.searchsorted(times, wanted[0] if len(wanted) else 0)
            out[:, place : place + len(solution.t)] = solution.y
            happened = [number for number, found in enumerate(solution.t_events) if len(found)]
            if not happened:
                break
            number = happened[0]
            t, state = float(solution.t_events[number][0]), solution.y_events[number][0]
            if number < len(levels):
                _, _, tooth, change = levels[number]
                teeth = teeth | {tooth} if change > 0 else teeth - {tooth}
            elif side:
                side, teeth = 0, set()
            else:
                side = 1 if state[2] + state[3] > 0 else -1
                teeth = self.teeth(side, state[0])
        return out


def _event(of: Callable[[Floats], float], level: float, way: int) -> Any:
    def event(_: float, state: Floats, *__: Any) -> float:
        return of(state) - level

    event.terminal, event.direction = True, way  # type: ignore[attr-defined]
    return event
