"""Random planetary sets: speeds and torques in balance; what is admitted stands in mesh without overlap."""

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from support.planetary import MeshWitness
from support.planetary_trains import stage, unchecked_set
from support.random_trains import build_train, train_inputs
from support.ring_pairs import CHORD_ERROR

from gearcad.core.errors import InputError, SolverError
from gearcad.planetary import PlanetaryTrain, TrainLoad, TrainPose
from gearcad.planetary.poses import assembled, train_pose
from gearcad.planetary.power import forces, power_flow
from gearcad.planetary.train_data import TrainData, speeds

TYPES = "ABCD"


@dataclass(frozen=True)
class Bodies:
    """Centrals a and b, planet and carrier; the train's axis is at 0, the planet's at 1 on a line."""

    a: int
    rim: int
    rim_2: int
    b: int

    def pitch_points(self) -> tuple[Fraction, Fraction]:
        """Where a and b touch the planet: they divide the centre distance as the teeth do."""
        return Fraction(self.a, self.a + self.rim), Fraction(self.b, self.b + self.rim_2)

    def turning(self, known: dict[str, int]) -> dict[str, Fraction]:
        """All speeds from two: at each pitch point w_central r = w_carrier 1 + w_planet (r - 1)."""
        names = ["a", "b", "carrier", "planet"]
        first, second = self.pitch_points()
        rows = [[first, 0, -1, 1 - first, 0], [0, second, -1, 1 - second, 0]]
        rows += [[*(Fraction(int(name == each)) for each in names), Fraction(value)] for name, value in known.items()]
        return dict(zip(names, _solved([[Fraction(x) for x in row] for row in rows]), strict=True))

    def torques(self, w: dict[str, Fraction], at: str, torque: float, eta: float) -> dict[str, float] | None:
        """From outside on a, b and carrier; None where no direction of power through the meshes agrees with itself."""
        found = []
        for way_a, way_b in product((1, -1), repeat=2):
            # Unit moment on the planet by mesh a, so -1 by mesh b; each central gives what its mesh takes.
            on_a = float((w["planet"] - w["carrier"]) / (w["a"] - w["carrier"])) / eta**way_a
            on_b = -float((w["planet"] - w["carrier"]) / (w["b"] - w["carrier"])) / eta**way_b
            unit = {"a": on_a, "b": on_b, "carrier": -on_a - on_b}
            size = torque / unit[at] if unit[at] else 0.0
            each = {name: value * size for name, value in unit.items()}
            ways = [each[name] * float(w[name] - w["carrier"]) for name in "ab"]
            if ways[0] * way_a > 0 and ways[1] * way_b > 0:
                found.append(each)
        return min(found, key=lambda each: sum(each[name] * float(w[name]) for name in each)) if found else None


def _solved(rows: list[list[Fraction]]) -> list[Fraction]:
    """Elimination without rounding."""
    for i in range(len(rows)):
        pivot = next(j for j in range(i, len(rows)) if rows[j][i])
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for j in range(len(rows)):
            if j != i and rows[j][i]:
                rows[j] = [x - rows[j][i] * y for x, y in zip(rows[j], rows[i], strict=True)]
    return [row[-1] for row in rows]


def random_bodies(rng: np.random.Generator) -> tuple[str, Bodies]:
    kind = TYPES[rng.integers(4)]
    rim, rim_2 = (int(z) for z in rng.integers(15, 40, 2))
    sun, other = (int(z) for z in rng.integers(15, 80, 2))
    ring, ring_2 = (-int(z) for z in rng.integers(60, 160, 2))
    if kind == "A":
        return kind, Bodies(sun, rim, rim, -sun - 2 * rim)
    return kind, {
        "B": Bodies(sun, rim, rim_2, ring),
        "C": Bodies(sun, rim, rim_2, other),
        "D": Bodies(ring, rim, rim_2, ring_2),
    }[kind]


def compare(seed: int, count: int) -> tuple[int, int]:
    """How many sets agreed to 1e-12 and how many of them lock; fails where one does not."""
    rng = np.random.default_rng(seed)
    agreed = locked = 0
    while agreed < count:
        kind, bodies = random_bodies(rng)
        if bodies.rim * bodies.b == bodies.a * bodies.rim_2:
            continue
        fixed, driving, driven = (str(name) for name in rng.permutation(["a", "b", "carrier"]))
        eta = float(rng.choice([1.0, rng.uniform(0.9, 1.0), rng.uniform(0.98, 1.0)]))
        load = TrainLoad(
            torque=float(rng.choice([1, -1]) * rng.uniform(0.1, 1e4)), speed=float(rng.choice([-3, 7])), mesh_efficiency=eta
        )
        train = unchecked_set(
            bodies.a,
            bodies.rim,
            bodies.rim_2,
            bodies.b,
            stepped=kind != "A",
            fixed=fixed,
            input=driving,
            output=driven,
            planets=3,
        )
        locked += judge(train, bodies, load)
        agreed += 1
    return agreed, locked


def judge(train: TrainData, bodies: Bodies, load: TrainLoad) -> bool:
    """Whether the set locks; fails where program and bodies do not agree."""
    w = bodies.turning({str(train.fixed): 0, train.input: int(load.speed)})
    found = speeds(train, {train.input: load.speed})
    assert [found.members[name] for name in train.members] == pytest.approx([float(w[n]) for n in train.members], rel=1e-12)
    assert found.planet == pytest.approx(float(w["planet"]), rel=1e-12, abs=1e-12 * abs(found.planet_relative))
    assert found.planet_relative == pytest.approx(float(w["planet"] - w["carrier"]), rel=1e-12)
    outside = -load.torque * (1 if w[train.output] > 0 else -1)
    expected = bodies.torques(w, train.output, outside, load.mesh_efficiency)
    if expected is None:
        with pytest.raises(SolverError, match="locks itself"):
            power_flow(train, load)
        return True
    flow = power_flow(train, load)
    largest = max(abs(value) for value in expected.values())
    assert [flow.torques[name] for name in train.members] == pytest.approx(
        [expected[name] for name in train.members], rel=1e-12, abs=1e-12 * largest
    )
    assert sum(flow.torques.values()) == pytest.approx(0, abs=1e-12 * largest)
    assert sum(flow.losses.values()) == pytest.approx(sum(flow.powers.values()), abs=1e-12 * largest * 1e3)
    return False


def test_torques_and_speeds_of_random_sets_are_those_of_bodies_in_balance() -> None:
    agreed, locked = compare(seed=17, count=200)
    assert agreed == 200
    assert locked > 0


@pytest.mark.long
def test_torques_and_speeds_of_many_random_sets() -> None:
    agreed, _ = compare(seed=1717, count=6000)
    assert agreed == 6000


def test_stages_hand_power_on_with_their_own_losses() -> None:
    """Two stages before the input, one behind the output, either way: each stage keeps eta of what goes in, the sum is lost."""
    rng = np.random.default_rng(4)
    for _ in range(60):
        eta, torque = rng.uniform(0.93, 1.0), rng.choice([1, -1]) * rng.uniform(1, 500)
        stages = (
            stage("middle", ("between", 17), ("a", 40)),
            stage("first", ("motor", 20), ("between", 31)),
            stage("last", ("carrier", 50), ("machine", 25)),
        )
        train = unchecked_set(24, 21, 21, -66, stepped=False, fixed="b", input="motor", output="machine", stages=stages)
        flow = power_flow(train, TrainLoad(torque=torque, speed=1000.0, mesh_efficiency=eta))
        assert train_ratio(train) == pytest.approx((-31 / 20) * (-40 / 17) * 3.75 * (-25 / 50), rel=1e-14)
        for each in stages:
            torques = flow.stage_torques[each.name]
            powers = [torques.pinion * flow.speeds.members[each.pinion], torques.wheel * flow.speeds.members[each.wheel]]
            assert -min(powers) / max(powers) == pytest.approx(eta, rel=1e-12)
        assert sum(flow.losses.values()) == pytest.approx(sum(flow.powers.values()), rel=1e-9, abs=1e-9)
        ends = [flow.powers["motor"], flow.powers["machine"]]
        assert -min(ends) / max(ends) == pytest.approx(flow.efficiency if torque > 0 else flow.efficiency_back, rel=1e-12)


def train_ratio(train: TrainData) -> float:
    members = speeds(train, {train.input: 1.0}).members
    return members[train.input] / members[train.output]


def test_forces_hold_every_body() -> None:
    """Without losses: forces at the pitch points hold each central, the planet and the carrier, on random sets."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        sun, rim = (int(z) for z in rng.integers(24, 50, 2))
        bodies = Bodies(sun, rim, rim, -sun - 2 * rim)
        train = unchecked_set(
            bodies.a, bodies.rim, bodies.rim_2, bodies.b, stepped=False, fixed="b", input="a", output="carrier", planets=4
        )
        flow = power_flow(train, TrainLoad(torque=100.0))
        found = forces(train, flow)
        distance = train.meshes[0].pair.centre_distance / 1e3
        arms = [float(point) * distance for point in bodies.pitch_points()]
        on_planet = [found.meshes[mesh.name].tangential for mesh in train.meshes]
        for name, force, arm in zip("ab", on_planet, arms, strict=True):
            assert 4 * force * arm == pytest.approx(flow.set_torques[name], rel=1e-12)
        assert sum(force * (arm - distance) for force, arm in zip(on_planet, arms, strict=True)) == pytest.approx(0, abs=1e-9)
        assert found.pin.tangential * distance * 4 == pytest.approx(-flow.set_torques["carrier"], rel=1e-12)
        assert found.pin.tangential == pytest.approx(2 * on_planet[0], rel=1e-12)


STEP = 4e-3
"""How far (mm, on the working circle) before and behind the used-up backlash the sets are looked at."""


def confirm_mesh(train: PlanetaryTrain, angles: tuple[float, ...]) -> None:
    """No overlap with the backlash split, at some angles of the carrier; at the last of them none STEP before the backlash is
    used up either, and overlap STEP behind, at every planet.
    """
    if any(notice.code == "fillet-interference" for notice in train.notices):
        event("told: fillet")
        return
    for mesh in train.meshes:
        witness, half = MeshWitness(mesh), mesh.pair.circumferential_backlash / 2
        always = mesh.pair.usable_contact_ratio >= 1 + 1e-6
        event(f"type {train.set_type.value}, {train.planets} planets")
        event(f"{'helical' if mesh.central.gear.helix_angle else 'spur'}, {'always' if always else 'not always'} in contact")
        rounding = 4 * CHORD_ERROR * mesh.pair.pinion.transverse_module
        for angle in angles:
            pose = train.pose(angle)
            assert witness.in_pose(pose).min() >= (0 if half > rounding else -rounding)
        for side in (1, -1):
            if half > STEP:
                assert witness.in_pose(pose, side * (half - STEP) / witness.working_radius).min() >= 0
            if always:
                assert witness.in_pose(pose, side * (half + STEP) / witness.working_radius).max() < 0


def confirm_refusal(inputs: dict[str, Any], error: InputError) -> None:
    """That what is refused for its neighbours or its teeth overlaps where it is put together all the same."""
    text = str(error)
    assert "\n" not in text
    if "must let the teeth fit" in text:
        confirm_misfit(build_train(inputs, TrainData), text)
    elif "axes of planets" in text:
        confirm_neighbours(build_train(inputs, TrainData))
    else:
        event(f"refused: {error.parameter}")


def confirm_neighbours(train: TrainData) -> None:
    """That the tip circles of two planets of the forced train cut each other."""
    event("refused: neighbours")
    places = [np.array([planet.x, planet.y]) for planet in train_pose(train).planets]
    apart = min(float(np.hypot(*(one - other))) for i, one in enumerate(places) for other in places[:i])
    assert apart <= max(rim.gear.tip_diameter for rim in train.rims) + 1e-9


def confirm_misfit(train: TrainData, text: str) -> None:
    """That the planet which is named overlaps a central however it is turned, if it is off by more than the backlash."""
    number, angle, pitches = re.search(r"planet (\d+) at ([\d.e-]+) deg is ([\d.e-]+) pitches", text).groups()  # type: ignore[union-attr]
    first, second = train.meshes
    off = float(pitches) * math.pi * abs(first.pair.working_pitch_diameters.pinion) / first.pair.pinion.teeth
    # What both meshes leave to the planet, seen on the working circle of the first one.
    rims = [abs(mesh.pair.working_pitch_diameters.pick(mesh.rim_role)) / 2 for mesh in train.meshes]
    free = first.pair.circumferential_backlash + second.pair.circumferential_backlash * rims[0] / rims[1]
    pose = train_pose(train)
    planet = pose.planets[int(number) - 1]
    assert math.isclose(planet.angle, float(angle), rel_tol=1e-6)
    if off < free / 2 + 4 * STEP:
        event("refused: teeth, by less than the backlash")
        return
    event("refused: teeth")
    turns = np.linspace(-1, 1, 41) * (off + free) / rims[0]
    least = [overlap_of(train, pose, int(number) - 1, mesh_at, turns) for mesh_at in (0, 1)]
    assert np.minimum(*least).max() < 0


def overlap_of(train: TrainData, pose: TrainPose, planet: int, at: int, turns: np.ndarray) -> np.ndarray:
    """Clearances (n,) of one planet in one mesh, turned on by `turns` (n,) in rad, in the plane of the rim's bottom."""
    mesh = train.meshes[at]
    placed = pose.planets[planet]
    height = pose.heights[mesh.rim.name] - pose.heights[mesh.central.name]
    lead = math.tan(math.radians(mesh.central.gear.helix_angle)) / (abs(mesh.central.gear.reference_diameter) / 2)
    central = np.full(len(turns), math.radians(pose.rotations[mesh.central.name]) + lead * height)
    rim = math.radians(placed.rotations[mesh.rim.name]) + turns
    return MeshWitness(mesh).clearance(central, rim, np.full(len(turns), math.radians(placed.angle)))


def check(inputs: dict[str, Any], angles: tuple[float, ...]) -> None:
    try:
        train = build_train(inputs)
    except InputError as error:
        confirm_refusal(inputs, error)
        return
    assert isinstance(train, PlanetaryTrain)
    assert max(map(abs, assembled(train).misfits)) < 1e-9
    confirm_mesh(train, tuple(inputs["carrier_angle"] + angle for angle in angles))


@settings(max_examples=25)
@given(train_inputs())
def test_trains_stand_in_mesh_or_are_refused(inputs: dict[str, Any]) -> None:
    check(inputs, (0.0,))


@pytest.mark.long
@settings(max_examples=2500)
@given(train_inputs())
def test_trains_stand_in_mesh_or_are_refused_long(inputs: dict[str, Any]) -> None:
    check(inputs, (0.0, 33.3, 200.0))
