"""Phases of meshes against exact flanks, and which harmonics shake what."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from support.planetary import gear, simple_train, thesis_train

from gearcad import Gear, GearPair
from gearcad.core.errors import ParameterError
from gearcad.geometry.gear_data import twist
from gearcad.planetary import Drive, MeshPhases, PlanetaryTrain, TrainLoad, drive_of, mesh_phases, phases_between
from gearcad.planetary.poses import Excited, excited_modes, harmonic_sums, train_harmonics
from gearcad.planetary.power import power_flow
from gearcad.planetary.train_data import permitted_steps

REFERENCE = {
    (24, 21, -66): ((0.3, 0.2, -0.7), (0.0, 0.0, 0.0), 0.753861844, 0.992276312),
    (20, 28, -76): ((0.3, 0.3, -0.9), (0.0, 0.0, 0.0, 0.0), 0.255792766, 0.488414468),
    (22, 20, -62): ((0.4, 0.3, -1.0), (0.0, 0.5, 0.0, 0.5), 0.253861844, 0.492276312),
    (21, 18, -57): ((0.3, 0.2, -0.7), (0.0, 0.0, 0.0), 0.253564779, 0.492870442),
    (25, 20, -65): ((0.2, 0.2, -0.6), (0.0, 2 / 3, 1 / 3), 0.247425437, 0.505149126),
}
"""By teeth: shifts, phases of the planets, how far planet 0 is ahead at the sun, and its ring's mesh against it."""

PRINTED = 1e-9
"""Half a digit of the reference, and its own shifts, which are rounded to 1e-15."""


def apart(one: float, other: float) -> float:
    """How far two phases are apart, whole pitches left out."""
    return abs((one - other + 0.5) % 1 - 0.5)


@pytest.mark.parametrize("teeth", REFERENCE)
def test_phases_of_plain_sets_as_computed_elsewhere(teeth: tuple[int, int, int]) -> None:
    shifts, relative, ahead, between = REFERENCE[teeth]
    train = simple_train(teeth, shifts, len(relative))
    sun, ring = train.phases.values()
    for mesh in (sun, ring):
        assert max(map(apart, mesh.relative, relative)) < PRINTED
    assert apart(sun.ahead[0], ahead) < PRINTED
    assert max(apart(found, between) for found in phases_between(sun, ring)) < PRINTED


def flank_point(own: Gear, tooth: float, side: int, radius: float) -> complex:
    """A point of the exact flank (1: left, -1: right) of a tooth whose middle is at an angle (rad), about the gear's axis."""
    return radius * np.exp(1j * (tooth + side * math.radians(float(own.profile.half_angle(radius)))))


def cuts(own: Gear, rotation: float, side: int, start: complex, along: complex) -> dict[int, complex]:
    """By teeth: where their flanks on a side cut a line, which begins at `start` as seen from the gear's axis."""
    ends = abs(own.form_diameter) / 2, own.profile.tip_form_diameter / 2
    found = {}
    for tooth in range(own.tooth_count):
        angle = rotation + 2 * math.pi * tooth / own.tooth_count

        def off(radius: float, angle: float = angle) -> float:
            return ((flank_point(own, angle, side, radius) - start) / along).imag

        near = abs(flank_point(own, angle, side, ends[0]) - start) < 5 * own.transverse_pitch
        if near and off(ends[0]) * off(ends[1]) < 0:
            found[tooth] = flank_point(own, angle, side, brentq(off, *ends, xtol=1e-13)) - start
    return found


def by_cutting(train: PlanetaryTrain, sense: int, turning: int, carrier_angle: float) -> dict[str, list[float]]:
    """Base pitches ahead of the pitch point, where the planets' exact flanks cut the tangent of both base circles.

    The sides that carry follow from moments, the motion from a second pose. That the centrals' flanks, turned on by half the
    backlash, cut it in the same points, is asserted.
    """
    pose, found = train.pose(carrier_angle), {}
    other = train.pose(carrier_angle, 1e-3)
    same = 1 if train.basic_ratio > 0 else -1
    a = train.centrals[0].name
    onwards = turning * math.copysign(1, other.rotations[a] - pose.rotations[a])
    for mesh, torque in zip(train.meshes, (sense, -same * sense), strict=True):
        central, rim, outwards = mesh.central.gear, mesh.rim.gear, 1 if mesh.external else -1
        working = abs(mesh.pair.working_pitch_diameters.pick(mesh.central_role)) / 2
        pressure = math.acos(mesh.central_base_radius / working)
        closed = torque * mesh.pair.circumferential_backlash / 2 / working
        found[mesh.name] = []
        for planet, moved in zip(pose.planets, other.planets, strict=True):
            away = np.exp(1j * math.radians(planet.angle))
            force = away * (1j * torque * math.cos(pressure) + outwards * math.sin(pressure))  # of the central on the planet
            pitch_point = working * away
            from_planet = pitch_point - complex(planet.x, planet.y)
            side = -1 if (np.conj(from_planet) * force).imag > 0 else 1
            rotation = math.radians(planet.rotations[mesh.rim.name]) + twist(rim, rim.face_width / 2)
            on_planet = cuts(rim, rotation, side, from_planet, force)
            step = 1e-4 * onwards * math.copysign(1, moved.rotations[mesh.rim.name] - planet.rotations[mesh.rim.name])
            later = cuts(rim, rotation + step, side, from_planet, force)
            tooth = next(each for each in on_planet if each in later)
            forward = force * math.copysign(1, ((later[tooth] - on_planet[tooth]) / force).real)
            turned = math.radians(pose.rotations[mesh.central.name]) + twist(central, central.face_width / 2) + closed
            on_central = cuts(central, turned, torque, pitch_point, force)
            met = [point for point in on_planet.values() if min(abs(point - mate) for mate in on_central.values()) < 1e-9]
            assert met
            found[mesh.name].append((met[0] / forward).real / rim.transverse_base_pitch)
    return found


def thinned_helical() -> PlanetaryTrain:
    sun = gear(24, 2.0, 0.3, helix_angle=15.0, face_width=17.0, tooth_thinning=0.08)
    planet = gear(23, 2.0, 0.35, helix_angle=-15.0, tooth_thinning=0.02)
    ring = gear(-72, 2.0, -1.1, helix_angle=-15.0, face_width=23.0, tooth_thinning=0.05)
    distance = float(GearPair(pinion=planet, wheel=sun).centre_distance)
    return simple_train((24, 23, -72), (0.3, 0.35, -1.1), 4, gears=(sun, planet, ring), centre_distance=distance)


@pytest.mark.parametrize("train", [thinned_helical(), thesis_train(), thesis_train(planets=2)], ids=["helical", "D", "D2"])
@pytest.mark.parametrize(("sense", "turning"), [(1, 1), (-1, -1), (1, -1), (-1, 1)])
def test_flanks_touch_where_phases_say(train: PlanetaryTrain, sense: int, turning: int) -> None:
    found = mesh_phases(train, Drive(sense, turning), carrier_angle=7.7)
    for name, cut in by_cutting(train, sense, turning, 7.7).items():
        assert max(map(apart, found[name].ahead, cut)) < 1e-9


def test_the_thesis_train_is_out_of_phase_at_ring_4_only() -> None:
    first, second = thesis_train().phases.values()
    assert [round(each, 9) for each in first.relative] == [0, pytest.approx(2 / 3), pytest.approx(1 / 3)]
    assert max(apart(each, 0) for each in second.relative) < 1e-12


def test_contact_moves_on_by_what_rolls() -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3)
    start, later = train.phases, mesh_phases(train, central_turn=-1.0)  # the sun turns by 66/24 degrees
    for name, z in (("sun-planet", 24 * 66 / 24), ("ring-planet", 66)):
        assert apart(later[name].ahead[1] - start[name].ahead[1], z / 360) < 1e-9


def test_a_wheel_that_drives_runs_through_its_cycle_from_the_end() -> None:
    train = simple_train((25, 20, -65), (0.2, 0.2, -0.6), 3)
    sun: MeshPhases = train.phases["sun-planet"]
    assert sun.driver.value == "wheel"
    assert max(apart(a, -b) for a, b in zip(sun.ahead, sun.cycle, strict=True)) < 1e-12
    assert train.phases["ring-planet"].cycle == train.phases["ring-planet"].ahead


@pytest.mark.parametrize("drive", [Drive(0, 1), Drive(1, 2)])
def test_senses_are_1_or_minus_1(drive: Drive) -> None:
    with pytest.raises(ParameterError, match="must be 1 or -1"):
        mesh_phases(thesis_train(), drive)


@pytest.mark.parametrize("fixed", ["sun", "ring", "carrier"])
@pytest.mark.parametrize(("torque", "speed"), [(10.0, 100.0), (10.0, -100.0), (-10.0, 100.0), (-10.0, -100.0)])
def test_what_drives_is_what_the_power_flow_says(fixed: str, torque: float, speed: float) -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3, fixed=None)
    others = [name for name in train.members if name != fixed]
    for given, taken in (others, others[::-1]):
        each = replace(train, fixed=fixed, input=given, output=taken)
        load = TrainLoad(torque=torque, speed=speed)
        flow = power_flow(each, load)
        seen = flow.speeds.members["sun"] - flow.speeds.members["carrier"]
        assert drive_of(each, load) == (math.copysign(1, flow.set_torques["sun"]), math.copysign(1, seen))


def test_the_pre_stage_turns_what_drives_about() -> None:
    load, train = TrainLoad(torque=1600.0, speed=100.0), thesis_train()
    flow = power_flow(train, load)
    seen = flow.speeds.members["ring_4"] - flow.speeds.members["carrier"]
    assert drive_of(train) == (math.copysign(1, flow.set_torques["ring_4"]), math.copysign(1, seen))


def test_a_differential_is_driven_by_its_first_central() -> None:
    assert drive_of(simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3, fixed=None)) == (1, 1)


def test_mirrored_trains_have_equal_phases() -> None:
    """Turned the other way, with planets at mirrored angles, all is as in a mirror."""
    train = simple_train((25, 20, -65), (0.2, 0.2, -0.6), 4, planet_angles="permitted")
    one, other = (replace(train, planet_angles=tuple(sign * angle for angle in train.angles)) for sign in (1, -1))
    for name, phases in one.phases.items():
        mirrored = mesh_phases(other, Drive(-1, -1))[name]
        assert max(map(apart, phases.relative, mirrored.relative)) < 1e-9
        assert phases.left_flanks is not mirrored.left_flanks


RULE = {
    (24, 3): "RRRRRR",
    (25, 3): "TTRTTR",
    (26, 3): "TTRTTR",
    (24, 4): "RRRRRR",
    (25, 4): "TPTRTP",
    (26, 4): "PRPRPR",
    (27, 4): "TPTRTP",
    (24, 5): "TPPTRT",
    (27, 5): "PTTPRP",
    (28, 6): "PPRPPR",
    (27, 6): "PRPRPR",
}
"""Modes that harmonics 1 to 6 shake, by teeth of the central and planets: rotational, translational, planets' only."""

LETTERS = {Excited(True, False): "R", Excited(False, True): "T", Excited(False, False): "P"}


@pytest.mark.parametrize("case", RULE)
def test_equal_planets_follow_the_rule(case: tuple[int, int]) -> None:
    teeth, planets = case
    assert "".join(LETTERS[excited_modes(teeth, planets, harmonic)] for harmonic in range(1, 7)) == RULE[case]


@pytest.mark.parametrize("planets", [1, 2, 3, 4, 5, 6, 7])
@pytest.mark.parametrize("teeth", [24, 25, -66, -71])
def test_sums_say_the_same_as_the_rule(teeth: int, planets: int) -> None:
    angles = [360 * number / planets for number in range(planets)]
    sums = harmonic_sums([-teeth * angle / 360 % 1 for angle in angles], angles)
    assert [each.excited for each in sums] == [excited_modes(teeth, planets, each.harmonic) for each in sums]


def test_both_meshes_of_trains_have_their_own() -> None:
    """The thesis's: ring 4 out of phase, ring 5 in phase; 25/20/-65 alike in both meshes."""
    fourth, fifth = train_harmonics(thesis_train()).values()
    assert [LETTERS[each.excited] for each in fourth] == list("TTRTTR")
    assert [LETTERS[each.excited] for each in fifth] == list("RRRRRR")
    sun, ring = train_harmonics(simple_train((25, 20, -65), (0.2, 0.2, -0.6), 3)).values()
    assert [LETTERS[each.excited] for each in sun] == [LETTERS[each.excited] for each in ring] == list("TTRTTR")


def test_unequal_planets_leave_some_of_everything() -> None:
    """Four planets of 25/20/-65 put in at 0, 22, 45 and 68 ninetieths of a turn, added up as vectors."""
    steps = (0, 22, 45, 68)
    train = simple_train((25, 20, -65), (0.2, 0.2, -0.6), 4, planet_angles=[4.0 * step for step in steps])
    for each in train_harmonics(train)["sun-planet"]:
        waves = [-each.harmonic * 25 * step / 90 * 2 * math.pi for step in steps]
        places = [2 * math.pi * step / 90 for step in steps]
        torque = math.hypot(sum(map(math.cos, waves)), sum(map(math.sin, waves))) / 4
        assert each.torque == pytest.approx(torque, abs=1e-9)
        # A force along x and y that turns with the pitch circle: its real and imaginary parts, at their greatest over time.
        forces = [
            math.hypot(
                sum(math.cos(w + s * p) for w, p in zip(waves, places, strict=True)),
                sum(math.sin(w + s * p) for w, p in zip(waves, places, strict=True)),
            )
            / 4
            for s in (1, -1)
        ]
        assert each.force == pytest.approx(max(forces), abs=1e-9)
        assert 0 < each.torque < 1


def test_permitted_angles_balance_where_positions_are_equally_near() -> None:
    """17/16/-49: of 66 positions 16 and 17, 49 and 50 are equally near to quarters of a turn: opposite ones are chosen."""
    train = simple_train((17, 16, -49), (0.4, 0.4, -1.2), 4, planet_angles="permitted")
    assert train.angles == pytest.approx((0, 92.7272727, 180, 272.7272727))
    assert train.unbalance == pytest.approx(0, abs=1e-12)
    assert train_harmonics(train)["sun-planet"][0].torque == pytest.approx(0, abs=1e-9)
    for positions in range(7, 100):
        for planets in range(2, min(positions, 7)):
            steps = permitted_steps(positions, planets)
            assert len(set(steps)) == planets
            off = [abs(step - positions * number / planets) for number, step in enumerate(steps)]
            assert max(off) <= 0.5
