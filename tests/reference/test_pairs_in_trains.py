"""Pairs in trains against equations of motion written out by hand, where flanks part; and the energy that teeth put in."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
import pytest
from support.trains import ByHand, Drive

from gearcad import Gear, GearPair
from gearcad.core.errors import GeometryError
from gearcad.core.records import Floats
from gearcad.dynamics import DynamicsOptions, Inertia, Shaft, ToothMesh, Train
from gearcad.dynamics.engagement import engaged
from gearcad.dynamics.response.speed_charts import over_speed
from gearcad.dynamics.trains.mesh_excitation import train_excitation
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.steady_response import PeriodicResponse
from gearcad.dynamics.trains.train_modes import natural_modes

SAME = 1e-4
"""Of amplitudes, and of forces at rest: some ten times what harmonics and steps leave."""

NEAR = 0.01
"""Teeth: two samples and more."""

BALANCED = 1e-3
"""Of the power that is lost: courses have corners where flanks meet, and a few hundred samples."""

SENSE = np.array([1.0, -1.0, -1.0, 1.0])
"""How each of the four gears turns, counter-clockwise positive."""


def pair(pinion: int, wheel: int, module: float, **more: Any) -> GearPair:
    shared = {"normal_module": module, "face_width": 20.0, "tooth_thinning": 0.02, **more}
    return GearPair(pinion=Gear(teeth=pinion, **shared), wheel=Gear(teeth=wheel, **shared))


def train_of(drive: Drive, speed: float) -> Train:
    """The same drive as a train."""
    names = "abcd"
    given = zip(("ab", "cd"), drive.pairs, drive.mesh_dampers, drive.phases, drive.clearances, strict=True)
    return Train(
        model="massless",
        inertias=[Inertia(name=name, inertia=j) for name, j in zip(names, drive.inertias, strict=True)],
        shafts=[Shaft(name="s", start="b", end="c", torsional_stiffness=drive.spring, damping=drive.damper)],
        meshes=[
            ToothMesh(name=a + b, pinion=a, wheel=b, pair=of, damping=damper, phase=phase, backlash=clearance)
            for (a, b), of, damper, phase, clearance in given
        ],
        torques={"a": drive.torque, "d": -drive.torque * drive.ratios[0] * drive.ratios[1]},
        speed=speed,
    )


def motion(drive: Drive, speed: float, of_run_up: tuple[float, float] = (0.7, 1.1)) -> PeriodicResponse:
    """The train's own motion at a speed (rpm), of a run up through parts of it."""
    train = engaged(train_of(drive, speed), DynamicsOptions(stiffness=drive.method))
    frequency = speed * math.pi / 30 * drive.pairs[0].pinion.teeth
    run_up = np.union1d(np.linspace(*of_run_up, 25), 1.0) * frequency
    over = over_speed(system(train), train_excitation(train), run_up)
    assert over.down is not None  # flanks part
    return over.response(frequency)


@dataclass(frozen=True)
class Both:
    """Our motion over one common period, and that of the equations by hand which starts where ours does."""

    drive: Drive
    response: PeriodicResponse
    turns: Floats
    rates: Floats
    springs: Floats
    by_hand: Floats
    end: Floats

    @classmethod
    def of(cls, drive: Drive, speed: float) -> Both:
        """At a speed (rpm) of the first pinion."""
        response, hand = motion(drive, speed), ByHand(drive, speed)
        count = max(256 * max(response.excitation.orders), 4 * int(response.harmonics[-1]))
        turns = response.turns(count=count)[0] * SENSE
        fundamental = float(response.frequencies[0]) * response.excitation.fundamental
        rates = _slope(turns) * fundamental
        times = 2 * math.pi / fundamental * np.arange(count + 1) / count
        states = hand.run(np.concatenate([turns[0], rates[0]]), times)
        forces = [[spring for spring, _ in hand.forces(t, x[:4], x[4:])] for t, x in zip(times[:-1], states, strict=False)]
        springs = (response.spring_forces(count=count) * response.senses)[0]
        return cls(drive, response, turns, rates, springs, np.array(forces), states[-1])

    @property
    def differences(self) -> dict[str, float]:
        """Of turns after a period, over the amplitude; of forces, over those at rest; of moments of greatest force (teeth)."""
        # A sample at a jump may show either side.
        near = [np.abs(np.roll(self.springs, shift, axis=0) - self.by_hand) for shift in (-1, 0, 1)]
        count, orders = len(self.springs), np.array(self.response.excitation.orders)
        apart = self.springs.argmax(axis=0) - self.by_hand.argmax(axis=0)
        apart = np.abs((apart + count // 2) % count - count // 2)
        return {
            "return": float(np.abs(self.end[:4] - self.turns[0]).max() / np.ptp(self.turns, axis=0).max()),
            "force": float((np.minimum.reduce(near) / self.drive.forces).max()),
            "greatest": float((np.abs(self.springs.max(axis=0) - self.by_hand.max(axis=0)) / self.drive.forces).max()),
            "moment": float((apart / count * orders).max()),
        }

    @property
    def parted(self) -> float:
        """Share of the time for which the flanks of one mesh at least are apart."""
        return float((self.by_hand <= 0).any(axis=1).mean())

    @property
    def energy_left(self) -> float:
        """What teeth put in less what all dampers take out, over that; torques that stay as they are do no work beside it."""
        count, response = len(self.springs), self.response
        dampers = (response.damping_forces(count=count) * response.senses)[0]
        fundamental = float(response.frequencies[0]) * response.excitation.fundamental
        rates = _slope((response.approach(count=count) * response.senses)[0]) * fundamental
        in_meshes = (dampers**2 / response.system.mesh_damping).mean(axis=0).sum()
        in_shaft = self.drive.damper * ((self.rates[:, 1] - self.rates[:, 2]) ** 2).mean()
        # Work on the flanks as they run: what the dampers there take, less what comes out as vibration of the gears.
        put_in = in_meshes - ((self.springs + dampers) * rates).mean(axis=0).sum()
        return float(abs(put_in - in_meshes - in_shaft) / (in_meshes + in_shaft))


def _slope(course: Floats) -> Floats:
    """Derivative of a periodic course (t, n) with respect to its phase."""
    spectrum = np.fft.rfft(course, axis=0)
    return np.asarray(np.fft.irfft(spectrum * 1j * np.arange(len(spectrum))[:, None], len(course), axis=0), float)


def require_agreement(drive: Drive, speed: float, apart: float) -> None:
    both = Both.of(drive, speed)
    assert both.parted > apart
    found = both.differences
    assert found["return"] < SAME and found["force"] < SAME and found["greatest"] < SAME and found["moment"] < NEAR, found
    assert both.energy_left < BALANCED


def random_drive(seed: int) -> Drive:
    """Any two pairs of which the second comes as often as the first, or half as often; damped by some per cent."""
    rng = Random(seed)
    z1, z3 = rng.randint(17, 26), rng.randint(18, 26)
    z2 = z3 if z3 > z1 and rng.random() < 0.5 else 2 * z3
    return Drive(
        pairs=(pair(z1, z2, 2.0), pair(z3, rng.randint(28, 50), rng.choice([1.5, 2.0, 2.5, 3.0]))),
        inertias=tuple(10 ** rng.uniform(-3.3, -1.8) for _ in range(4)),
        spring=10 ** rng.uniform(3, 5),
        damper=10 ** rng.uniform(-1, 0.5),
        mesh_dampers=(rng.uniform(2500, 6000), rng.uniform(2500, 6000)),
        torque=rng.uniform(20, 80),
        phases=(rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5)),
        clearances=(rng.uniform(5, 60), rng.uniform(5, 60)),
    )


def tooth_resonance(drive: Drive, mode: int) -> float:
    """Speed (rpm) at which a mode meets the mesh that has its energy."""
    modes = natural_modes(engaged(train_of(drive, 0.0), DynamicsOptions(stiffness=drive.method)), count=4)
    return float(modes.rpm[mode, int(modes.potential_meshes[mode].argmax())])


@pytest.mark.long
def test_flanks_that_part_by_hand() -> None:
    """At the resonance of the second pair's teeth."""
    drive = random_drive(4)
    require_agreement(drive, tooth_resonance(drive, 2), apart=0.1)


@pytest.mark.long
@pytest.mark.parametrize("seed", [2, 5, 6, 7, 8, 9])
def test_random_drives_by_hand(seed: int) -> None:
    drive = random_drive(seed)
    require_agreement(drive, tooth_resonance(drive, 2), apart=0.02)


FZG = {"normal_module": 4.5, "face_width": 14.0, "tooth_thinning": 0.05}


def known(which: str) -> Drive:
    """The FZG-C pair twice, or that of Uhlir's thesis (z 19/23, m 1.75) and its mirror image, by finite elements."""
    if which == "fzg":
        pinion = Gear(teeth=16, profile_shift=0.1817, **FZG)
        pairs = (GearPair(pinion=pinion, wheel=Gear(teeth=24, profile_shift=0.1715, **FZG), centre_distance=91.5),) * 2
    else:
        pairs = (pair(19, 23, 1.75), pair(23, 19, 1.75))
    inertias = (0.0027, 0.0139, 0.0027, 0.0139) if which == "fzg" else (1.74e-5, 3.74e-5, 3.74e-5, 1.74e-5)
    return Drive(
        pairs=pairs,
        inertias=inertias,
        spring=2e4 if which == "fzg" else 300.0,
        damper=0.5 if which == "fzg" else 0.01,
        mesh_dampers=(4000.0, 4000.0) if which == "fzg" else (600.0, 600.0),
        torque=302.0 if which == "fzg" else 10.0,
        phases=(0.0, 0.5),
        clearances=(60.0, 60.0),
        method="plane-strain",
    )


@pytest.mark.long
@pytest.mark.parametrize("which", ["fzg", "thesis"])
def test_known_pairs_by_hand(which: str) -> None:
    drive = known(which)
    require_agreement(drive, tooth_resonance(drive, 2), apart=0.0)


def test_the_same_delay_of_all_meshes_only_comes_later() -> None:
    """A tenth of a tooth of the first mesh, half of that of the second, which comes half as often."""
    drive = random_drive(1)
    assert drive.pairs[0].wheel.teeth == 2 * drive.pairs[1].pinion.teeth
    excitations = [
        train_excitation(engaged(train_of(replace(drive, phases=phases), 0.0), DynamicsOptions(stiffness=drive.method)))
        for phases in ((0.1, 0.2), (0.2, 0.25), (0.1, 0.7))
    ]
    theta = np.linspace(0, 2 * np.pi, 200, endpoint=False) + 1e-3
    first, later, half = excitations
    assert first.orders == (2, 1)
    delay = 0.1 * 2 * np.pi / 2
    assert later.ratios(theta + delay) == pytest.approx(first.ratios(theta), rel=1e-9)
    assert later.errors(theta + delay) == pytest.approx(first.errors(theta), rel=1e-9)
    assert half.ratios(theta)[:, 0] == pytest.approx(first.ratios(theta)[:, 0], rel=1e-12)
    assert half.ratios(theta + np.pi)[:, 1] == pytest.approx(first.ratios(theta)[:, 1], rel=1e-9)


def test_tooth_numbers_on_one_shaft() -> None:
    """z3/z2 in lowest terms; a common period of too many teeth is refused in words."""
    drive = random_drive(1)
    mixed = replace(drive, pairs=(pair(18, 51, 2.0), pair(19, 40, 2.5)))
    options = DynamicsOptions(stiffness=drive.method)
    excitation = train_excitation(engaged(train_of(mixed, 0.0), options))
    assert excitation.meshes[1].frequency_ratio == Fraction(19, 51) and excitation.orders == (51, 19)
    prime = engaged(train_of(replace(mixed, pairs=(pair(101, 211, 2.0), pair(97, 40, 2.5))), 0.0), options)
    with pytest.raises(GeometryError, match=r"frequency_ratio = 21311 teeth: must let all meshes come again within 20000"):
        train_excitation(prime, grade=5)
