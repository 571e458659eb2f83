"""Trains and pairs that several tests use, an integrator of their equations, and a drive written out by hand."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from gearcad import Gear, GearPair, Load
from gearcad.core.records import Floats
from gearcad.dynamics.time_domain.contact_model import ContactModel, EngagedPairs, disc_inertia
from gearcad.dynamics.trains.members import GROUND, Inertia, Shaft, ToothMesh
from gearcad.dynamics.trains.train import Train
from gearcad.mesh_cycle import MeshCycle
from gearcad.stiffness.methods import METHODS

LONG, SHORT = ((750.0, 56.7), (1000.0, 18.5)), ((100.0, 34.4), (200.0, 12.4))
"""Lengths and diameters (mm) of input and output shaft: (2.1) and (2.4) of the paper."""


def one_stage(model: str, shafts: tuple[tuple[float, float], ...] = LONG, **more: Any) -> Train:
    """Figure 1 of the paper, its far ends clamped; two modes of the first shaft and one of the second where modes are kept."""
    damping_ratio = more.pop("damping_ratio", 0.05)
    return Train(
        model=model,
        inertias=(Inertia(name="pinion", inertia=0.0058), Inertia(name="wheel", inertia=0.2228)),
        shafts=tuple(
            Shaft(name=name, start=GROUND, end=gear, length=length, diameter=diameter, modes=modes, damping_ratio=damping_ratio)
            for name, gear, (length, diameter), modes in zip(
                ("input", "output"), ("pinion", "wheel"), shafts, (2, 1), strict=True
            )
        ),
        meshes=(
            ToothMesh(
                name="mesh",
                pinion="pinion",
                wheel="wheel",
                base_radii=(50.7, 135.3),
                stiffness=705.0,
                teeth=18,
                damping=14660.0,
                variation=0.206,
                preload=2256 / 0.0507,
            ),
        ),
        **more,
    )


def two_stages(between: float, model: str = "massless") -> Train:
    """Figure 7 of the paper: equal gears, `between` (N·m/rad) the shaft from one stage to the next."""
    springs = (("input", GROUND, "1", 1e5), ("between", "2", "3", between), ("output", "4", GROUND, 921.0))
    return Train(
        model=model,
        inertias=tuple(Inertia(name=name, inertia=0.0446) for name in "1234"),
        shafts=tuple(Shaft(name=name, start=a, end=b, torsional_stiffness=k) for name, a, b, k in springs),
        meshes=tuple(
            ToothMesh(name=a + b, pinion=a, wheel=b, base_radii=(90.2, 90.2), stiffness=750.0, teeth=32)
            for a, b in ("12", "34")
        ),
        torques={"1": 2256.0, "4": -2256.0},
    )


@st.composite
def random_trains(draw: st.DrawFn, *, order: int = 24) -> Train:
    """Two to five inertias joined one after the other by a mesh, a coupling or a shaft, and held by up to two shafts more."""

    def number(low: float, high: float) -> float:
        return draw(st.floats(low, high))

    def shaft(name: str, start: str, end: str) -> Shaft:
        if draw(st.booleans()):
            return Shaft(name=name, start=start, end=end, torsional_stiffness=10 ** number(2, 6))
        return Shaft(name=name, start=start, end=end, length=number(100, 1000), diameter=number(15, 80))

    count = draw(st.integers(2, 5))
    names = [f"i{place}" for place in range(count)]
    shafts, meshes = [], []
    for place in range(1, count):
        before, here = names[draw(st.integers(0, place - 1))], names[place]
        if draw(st.booleans()):
            shafts.append(shaft(f"s{place}", before, here))
        else:
            radii = (number(20, 100), number(101, 200))
            internal, k = draw(st.booleans()), number(50, 900)
            meshes.append(
                ToothMesh(
                    name=f"m{place}", pinion=before, wheel=here, base_radii=radii, stiffness=k, teeth=20, internal=internal
                )
            )
    for place in range(draw(st.integers(0, 2))):
        shafts.append(shaft(f"g{place}", GROUND, draw(st.sampled_from(names))))
    inertias = [Inertia(name=name, inertia=10 ** number(-3, 0)) for name in names]
    return Train(model="elements", inertias=inertias, shafts=shafts, meshes=meshes, order=order)


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


@dataclass(frozen=True, kw_only=True)
class Drive:
    """Two pairs in a row on four inertias (kg·m²), a spring (N·m/rad) with a damper (N·m·s/rad) between their shafts.

    `mesh_dampers` in N·s/m, `torque` on the first pinion in N·m, `phases` in teeth, `clearances` in µm.
    """

    pairs: tuple[GearPair, GearPair]
    inertias: tuple[float, ...]
    spring: float
    damper: float
    mesh_dampers: tuple[float, float]
    torque: float
    phases: tuple[float, float]
    clearances: tuple[float, float]
    method: str = "potential-energy"

    @cached_property
    def ratios(self) -> tuple[float, float]:
        """Turns of each pinion per turn of its wheel."""
        first, second = (each.wheel.teeth / each.pinion.teeth for each in self.pairs)
        return first, second

    @cached_property
    def torques(self) -> tuple[float, float]:
        """On both pinions, by the lever."""
        return self.torque, self.torque * self.ratios[0]

    @cached_property
    def cycles(self) -> list[MeshCycle]:
        """Of both pairs under these."""
        return [METHODS[self.method](pair=of)(Load(torque=each)) for of, each in zip(self.pairs, self.torques, strict=True)]

    @cached_property
    def forces(self) -> Floats:
        """At rest in both meshes (N)."""
        return np.array([2000 * each / of.pinion.base_diameter for of, each in zip(self.pairs, self.torques, strict=True)])


class _Course:
    """Stiffness and free error of a cycle over time counted in teeth, with straight lines between its points."""

    def __init__(self, cycle: MeshCycle, phase: float) -> None:
        self.start = cycle.roll_angle[0] / cycle.pitch_angle + phase
        self.places = (cycle.roll_angle - cycle.roll_angle[0]) / cycle.pitch_angle
        self.stiffness = 1e6 * cycle.tangent_stiffness
        self.error = 1e-6 * (cycle.transmission_error - cycle.force / cycle.tangent_stiffness)
        self.jumps = np.unique(np.mod(self.places[np.flatnonzero(np.diff(self.places) == 0)] + self.start, 1.0))

    def at(self, teeth: float) -> tuple[float, float, float]:
        """Stiffness (N/m), error (m) and its slope (m per tooth)."""
        place = (teeth - self.start) % 1.0
        right = min(max(int(np.searchsorted(self.places, place, side="right")), 1), len(self.places) - 1)
        step = self.places[right] - self.places[right - 1]
        part = (place - self.places[right - 1]) / step
        rise = self.error[right] - self.error[right - 1]
        stiffness = self.stiffness[right - 1] + part * (self.stiffness[right] - self.stiffness[right - 1])
        return stiffness, self.error[right - 1] + part * rise, rise / step


@dataclass(frozen=True)
class ByHand:
    """The four equations of a drive at a speed (rpm).

    Angles count the way each gear turns, beside its mean turn: a pinion's closes the flanks, a wheel's opens them.
    """

    drive: Drive
    speed: float

    @cached_property
    def teeth_per_second(self) -> tuple[float, float]:
        first, second = self.drive.pairs
        return first.pinion.teeth * self.speed / 60, second.pinion.teeth * self.speed / 60 / self.drive.ratios[0]

    @cached_property
    def courses(self) -> list[_Course]:
        return [_Course(*each) for each in zip(self.drive.cycles, self.drive.phases, strict=True)]

    @cached_property
    def radii(self) -> list[tuple[float, float]]:
        """Base radii of the pinions and wheels (m)."""
        return [(of.pinion.base_diameter / 2000, of.wheel.base_diameter / 2000) for of in self.drive.pairs]

    def forces(self, time: float, phi: Floats, rate: Floats) -> list[tuple[float, float]]:
        """Of spring and damper of each mesh (N)."""
        found = []
        for stage, ((pinion, wheel), clearance) in enumerate(zip(self.radii, self.drive.clearances, strict=True)):
            frequency = self.teeth_per_second[stage]
            stiffness, error, slope = self.courses[stage].at(time * frequency)
            gap = pinion * phi[2 * stage] - wheel * phi[2 * stage + 1] - error
            closing = pinion * rate[2 * stage] - wheel * rate[2 * stage + 1] - slope * frequency
            spring = stiffness * (max(gap, 0.0) + min(gap + 1e-6 * clearance, 0.0))
            found.append((spring, self.drive.mesh_dampers[stage] * closing))
        return found

    def derivative(self, time: float, state: Floats) -> Floats:
        phi, rate, drive = state[:4], state[4:], self.drive
        torque = np.array([drive.torque, 0.0, 0.0, -drive.torques[1] * drive.ratios[1]])
        for stage, force in enumerate(map(sum, self.forces(time, phi, rate))):
            torque[2 * stage] -= self.radii[stage][0] * force
            torque[2 * stage + 1] += self.radii[stage][1] * force
        shaft = drive.spring * (phi[1] - phi[2]) + drive.damper * (rate[1] - rate[2])
        torque[1] -= shaft
        torque[2] += shaft
        return np.concatenate([rate, torque / drive.inertias])

    def run(self, state: Floats, times: Floats) -> Floats:
        """States (t, 8) at rising times (t,) from 0 on, from jump to jump of the stiffness."""
        end = float(times[-1])
        cuts = {0.0, end}
        for of, frequency in zip(self.courses, self.teeth_per_second, strict=True):
            every = (np.arange(-2, math.ceil(end * frequency) + 2)[:, None] + of.jumps).ravel() / frequency
            cuts |= {float(each) for each in every if 1e-9 * end < each < end * (1 - 1e-9)}
        rows: list[Floats] = []
        for begin, stop in pairwise(sorted(cuts)):
            inside = times[(times >= begin) & (times < stop)]
            edge = 1e-9 * (stop - begin)

            def rates(time: float, x: Floats, a: float = begin + edge, b: float = stop - edge) -> Floats:
                return self.derivative(min(max(time, a), b), x)

            told = np.append(inside, stop)
            found = solve_ivp(rates, (begin, stop), state, "DOP853", told, rtol=1e-8, atol=1e-12, max_step=(stop - begin) / 2)
            assert found.success
            rows.extend(found.y.T[:-1])
            state = found.y[:, -1]
        return np.array([*rows, state])


def torqued_pair(teeth: int, **mesh: Any) -> Train:
    """A pinion of `teeth` and a wheel of half its speed under 200 and 400 N·m at 3000 rpm; `mesh` describes their mesh."""
    return Train(
        inertias=(Inertia(name="pinion", inertia=0.004), Inertia(name="wheel", inertia=0.03)),
        meshes=(ToothMesh(name="mesh", pinion="pinion", wheel="wheel", base_radii=(40, 80), teeth=teeth, **mesh),),
        torques={"pinion": 200.0, "wheel": 400.0},
        speed=3000.0,
    )
