"""Springs of planetary trains and stiffness of their meshes: rigid motions, approach of flanks, contacts cut from flanks."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.planetary import Contacts, contacts
from support.planetary_trains import TRAINS, alm_set, on_springs, simple_set

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Floats, Role
from gearcad.dynamics.planetary.planar_model import SpringKind, TrainSprings, held_members, train_springs
from gearcad.dynamics.planetary.planetary_excitation import NOMINAL_STRESS, PlanetMeshStiffness, mesh_stiffness, train_stiffness
from gearcad.geometry import DoubleHelix, Gear, GearPair
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.planetary import Central, PairStage, PlanetaryTrain, Rim, SetMesh, TrainLoad
from gearcad.planetary.poses import Drive, drive_of, mesh_phases, train_pose
from gearcad.planetary.power import mesh_loads, power_flow
from gearcad.stiffness import StrainEnergy

EVERY = pytest.mark.parametrize("kind", TRAINS)
SENSES = pytest.mark.parametrize("sense", [1, -1])

STIFFNESS = (400.0, 500.0)


def _floating(kind: str, sense: int = 1) -> TrainSprings:
    """Nothing held, pins that give way."""
    return train_springs(on_springs(TRAINS[kind], pin=200.0), STIFFNESS, held=(), sense=sense)


def _with(springs: TrainSprings, **values: float) -> Floats:
    """Coordinates of which some are given, planets alike, the others 0."""
    result = np.zeros(len(springs.coordinates))
    for place, name in enumerate(springs.coordinates):
        owner, coordinate = name.split(".")
        result[place] = values.get(f"{owner.split()[0]}_{coordinate}", 0.0)
    return result


@EVERY
@SENSES
def test_a_rigid_turn_elongates_nothing(kind: str, sense: int) -> None:
    springs = _floating(kind, sense)
    radii = {member.name: member.radius for member in springs.planar.members}
    distance = radii["carrier"]
    q = _with(
        springs, **{f"{name}_u": r for name, r in radii.items()}, planet_eta=distance, planet_u=springs.planar.planet_radius
    )
    assert np.abs(springs.vectors @ q).max() < 1e-15


@EVERY
@SENSES
def test_a_rigid_shift_elongates_nothing(kind: str, sense: int) -> None:
    springs = _floating(kind, sense)
    q = np.zeros(len(springs.coordinates))
    for place, name in enumerate(springs.coordinates):
        owner, coordinate = name.split(".")
        if owner.startswith("planet"):
            psi = springs.planar.angles[int(owner.split()[1]) - 1]
            q[place] = {"zeta": math.cos(psi), "eta": -math.sin(psi), "u": 0.0}[coordinate]
        else:
            q[place] = float(coordinate == "x")
    assert np.abs(springs.vectors @ q).max() < 1e-14


@EVERY
@SENSES
def test_rolling_by_the_basic_ratio_elongates_nothing(kind: str, sense: int) -> None:
    springs, train = _floating(kind, sense), TRAINS[kind]
    a, b = (member.radius for member in springs.planar.members[1:])
    mesh = train.meshes[0]
    planet = -mesh.central.gear.teeth / mesh.rim.gear.teeth
    q = _with(springs, a_u=a, b_u=b / train.basic_ratio, planet_u=planet * springs.planar.planet_radius)
    # u = r theta with the magnitude of a base radius.
    assert np.abs(springs.vectors @ q).max() < 1e-15 * 10


@EVERY
@SENSES
def test_elongations_are_those_of_involutes_after_small_displacements(kind: str, sense: int) -> None:
    springs = _floating(kind, sense)
    rng = np.random.default_rng(5)
    for _ in range(3):
        q = rng.uniform(-1, 1, len(springs.coordinates))
        step = 1e-7
        moved = [_elongations(TRAINS[kind], springs, sign * step * q, sense) for sign in (1, -1)]
        assert springs.vectors @ q == pytest.approx((moved[0] - moved[1]) / (2 * step), abs=1e-6)


def _elongations(train: PlanetaryTrain, springs: TrainSprings, q: Floats, sense: int) -> Floats:
    """Of bodies that stand where `q` puts them: flanks as involutes of base circles, pins as points of the carrier."""
    places = springs.basis @ q
    distance = float(train.centre_distance) / 1000
    result: list[float] = []
    bodies = {name: places[3 * i : 3 * i + 3] for i, name in enumerate(springs.members)}
    planets = []
    for n, psi in enumerate(springs.planar.angles):
        zeta, eta, u = places[9 + 3 * n : 12 + 3 * n]
        out = np.array([math.cos(psi), math.sin(psi)])
        along = np.array([-out[1], out[0]])
        planets.append(((distance + zeta) * out + eta * along, u / springs.planar.planet_radius))
    senses = [sense, sense if train.basic_ratio < 0 else -sense]
    for mesh, flank in zip(train.meshes, senses, strict=True):
        r = mesh.central_base_radius / 1000
        x, y, u = bodies[mesh.central.name]
        for psi, (centre, turn) in zip(springs.planar.angles, planets, strict=True):
            rest = distance * np.array([math.cos(psi), math.sin(psi)])
            approaches = [
                _overlap(psi, np.array(here[:2]), here[2], r, there, turned, mesh.rim_base_radius / 1000, mesh.external, flank)
                for here, there, turned in (((x, y, u / r), centre, turn), ((0.0, 0.0, 0.0), rest, 0.0))
            ]
            result.append(approaches[0] - approaches[1])
    x, y, u = bodies["carrier"]
    for psi, (centre, _) in zip(springs.planar.angles, planets, strict=True):
        angle = psi + u / distance
        pin = np.array([x, y]) + distance * np.array([math.cos(angle), math.sin(angle)])
        gap = pin - centre
        result += [gap @ [math.cos(psi), math.sin(psi)], gap @ [-math.sin(psi), math.cos(psi)]]
    return np.array(result)


def _overlap(
    psi: float, c1: Floats, turn1: float, r1: float, c2: Floats, turn2: float, r2: float, external: bool, flank: int
) -> float:
    """How far two involute flanks overlap on the common tangent of their base circles, but for a constant.

    A flank is where the string that unwinds from its base circle ends: its length grows as the gear turns with it.
    """
    between = c2 - c1
    apart = float(np.hypot(*between))
    off = np.array([math.cos(psi), math.sin(psi)]) @ between, np.array([-math.sin(psi), math.cos(psi)]) @ between
    direction = psi + math.atan2(off[1], off[0])
    alpha = math.acos((r1 + r2 if external else r1 - r2) / apart)
    tangent = direction - flank * alpha if external else direction + flank * alpha
    touch1 = c1 + r1 * np.array([math.cos(tangent), math.sin(tangent)])
    other = tangent + math.pi if external else tangent
    touch2 = c2 + r2 * np.array([math.cos(other), math.sin(other)])
    length = float(np.hypot(*(touch2 - touch1)))
    if external:
        return flank * (r1 * (turn1 - tangent) + r2 * (turn2 - tangent)) - length
    return flank * (r1 * (turn1 - tangent) - r2 * (turn2 - tangent)) + length


@EVERY
def test_the_torques_that_hold_a_train_at_rest_press_all_flanks(kind: str) -> None:
    """With the carrier turned by the sum of both, by T_b = -i0 T_a."""
    train = TRAINS[kind]
    springs = train_springs(on_springs(train, support=None, pin=None), STIFFNESS, held=("carrier",))
    i0 = train.basic_ratio
    load = 100 * (springs.turning("a") - i0 * springs.turning("b"))
    q = np.linalg.lstsq(springs.matrix(), load, rcond=1e-11)[0]
    forces = springs.stiffness * (springs.vectors @ q)
    assert springs.matrix() @ q == pytest.approx(load, rel=1e-9, abs=1e-12 * np.abs(load).max())
    for mesh, torque in zip(train.meshes, (100, 100 * i0), strict=True):
        expected = abs(torque) * 1000 / mesh.central_base_radius / train.planets
        assert forces[springs.select(SpringKind.MESH, mesh.name)] == pytest.approx(expected, rel=1e-9)


@EVERY
def test_what_is_held_is_the_limit_of_stiff_supports(kind: str) -> None:
    train = TRAINS[kind]
    exact = train_springs(on_springs(train, support=None, pin=None), STIFFNESS)
    stiff = train_springs(on_springs(train, support=1e9, pin=1e9), STIFFNESS)
    results = []
    for springs in (exact, stiff):
        load = 50 * springs.turning("a")
        held = springs.matrix() + 1e5 * np.outer(springs.turning("carrier"), springs.turning("carrier"))
        q = np.linalg.solve(held, load)
        results.append((springs.stiffness * (springs.vectors @ q))[: 2 * train.planets])
    assert results[0] == pytest.approx(results[1], rel=1e-5)


def test_only_what_can_move_has_coordinates() -> None:
    springs = train_springs(TRAINS["A"], STIFFNESS)
    assert springs.coordinates == ("carrier.u", "a.u", "planet 1.u", "planet 2.u", "planet 3.u")
    assert springs.names == ("a-rim1 1", "a-rim1 2", "a-rim1 3", "b-rim1 1", "b-rim1 2", "b-rim1 3")
    floating = train_springs(on_springs(TRAINS["A"], support=20.0, pin=200.0, torsion=1e4), STIFFNESS)
    assert len(floating.coordinates) == 18
    assert floating.names[6:] == (
        *(f"pin {n} {way}" for n in (1, 2, 3) for way in ("radial", "tangential")),
        *(f"{member} {way}" for member in ("carrier", "a", "b") for way in ("x", "y", "turning")),
    )
    radius = floating.planar.members[0].radius
    assert floating.stiffness[floating.select(SpringKind.TORSION, "carrier")] == pytest.approx(1e4 / radius**2)


def test_a_fixed_shaft_of_a_stage_holds_the_member_that_it_is_geared_to() -> None:
    train = TRAINS["D"]
    assert held_members(train) == ("b",)
    assert held_members(replace(train, fixed=None)) == ()
    pair = GearPair(pinion=replace(train.rims[0].gear, profile_shift=0.0), wheel=replace(train.rims[0].gear, profile_shift=0.0))
    staged = replace(
        train, fixed="motor", input="a", output="b", stages=(PairStage(name="pre", pair=pair, pinion="motor", wheel="carrier"),)
    )
    assert held_members(staged) == ("carrier",)


def test_what_is_no_stiffness_or_member_is_refused() -> None:
    train = TRAINS["A"]
    with pytest.raises(ParameterError, match=r"held = 'sun': must be one of a, b, carrier"):
        train_springs(train, STIFFNESS, held=("sun",))
    with pytest.raises(ParameterError, match="a number, or one for each of 3 planets"):
        train_springs(train, (np.ones(4), 1.0))
    with pytest.raises(ParameterError, match="must be above 0 N/µm"):
        train_springs(train, (400.0, 0.0))


INTERPOLATED = 5e-5
"""Relative: straight lines between the 200 roll angles of a cycle against its method at the very place."""

LOAD = Load(torque=50)
MESHES = [*simple_set(20, 32).meshes, simple_set(24, 21).meshes[0], alm_set().meshes[0]]


@cache
def strain_energy(mesh: SetMesh) -> StrainEnergy:
    """Its bodies are made once."""
    return StrainEnergy(pair=mesh.pair)


@cache
def cycle(mesh: SetMesh) -> MeshCycle:
    return strain_energy(mesh)(LOAD)


def at(mesh: SetMesh, found: Contacts) -> float:
    """The stiffness of the pairs of teeth that touch, each by the strain energy where it does (N/µm)."""
    method = strain_energy(mesh)
    from_t1 = np.sqrt(found.radii**2 - (mesh.pair.pinion.base_diameter / 2) ** 2)
    return float(method.single(from_t1, LOAD).stiffness.sum() * method.width)


@pytest.mark.parametrize("driver", Role)
@pytest.mark.parametrize("mesh", MESHES, ids=lambda mesh: f"{mesh.name}-{mesh.central.gear.teeth}")
def test_stiffness_is_that_of_the_flanks_that_touch(mesh: SetMesh, driver: Role) -> None:
    stiffness, pitch = PlanetMeshStiffness(mesh=mesh, cycle=cycle(mesh), driver=driver), mesh.pair.pinion.transverse_base_pitch
    for turning, angle in ((1, 0.3), (1, 0.4), (-1, 1.1)):
        found = contacts(mesh, angle=angle, psi=0.7, driver=driver, turning=turning)
        ahead = found.ahead / pitch
        assert np.ptp(np.mod(ahead - ahead[0] + 0.5, 1)) < 1e-8  # all contacts are base pitches apart
        assert stiffness.stiffness_at(ahead[0]) == pytest.approx(at(mesh, found), rel=INTERPOLATED)


@pytest.mark.parametrize("driver", Role)
@pytest.mark.parametrize("mesh", MESHES, ids=lambda mesh: f"{mesh.name}-{mesh.central.gear.teeth}")
def test_both_sides_of_every_jump(mesh: SetMesh, driver: Role) -> None:
    stiffness, pitch = PlanetMeshStiffness(mesh=mesh, cycle=cycle(mesh), driver=driver), mesh.pair.pinion.transverse_base_pitch
    start = contacts(mesh, angle=0.2, psi=-0.4, driver=driver, turning=1).ahead[0] / pitch
    touching = []
    for jump in stiffness.jumps:
        for ahead in (jump - 1e-4, jump + 1e-4):
            angle = 0.2 + 2 * math.pi * (ahead - start) / mesh.central.gear.tooth_count
            found = contacts(mesh, angle=angle, psi=-0.4, driver=driver, turning=1)
            touching.append(len(found.ahead))
            assert stiffness.stiffness_at(ahead) == pytest.approx(at(mesh, found), rel=INTERPOLATED)
    assert sorted(touching) == [1, 1, 2, 2]


def test_a_given_mean_scales_the_course() -> None:
    plain, given = (
        alm_set(),
        alm_set(
            centrals=tuple(
                Central(name=each.name, gear=each.gear, meshes=each.meshes, mesh_stiffness=250) for each in alm_set().centrals
            )
        ),
    )
    first, second = (mesh_stiffness(train.meshes[0], LOAD) for train in (plain, given))
    assert second.mean == second.tangent_mean == 250
    assert mean(second.ahead, second.secant) == pytest.approx(250, rel=1e-4)
    assert mean(second.ahead, second.tangent) == pytest.approx(250, rel=1e-4)
    assert second.secant / first.secant == pytest.approx(250 / first.cycle.mean, rel=1e-12)
    assert [notice.code for notice in second.notices] == [*(each.code for each in first.notices), "stiffness-given"]


def mean(places: np.ndarray, values: np.ndarray) -> float:
    return float(np.trapezoid(values, places))


@pytest.mark.parametrize("drive", [Drive(1, 1), Drive(-1, 1), Drive(1, -1)], ids=str)
@pytest.mark.parametrize("train", [simple_set(24, 21, planets=2), alm_set(planets=1)], ids=lambda train: train.set_type.value)
def test_phases_place_every_planet(train: PlanetaryTrain, drive: Drive) -> None:
    """Contacts of the posed train, which has no backlash, cut with the line of action."""
    pose, phases = train_pose(train, 11.0), mesh_phases(train, drive, carrier_angle=11.0)
    first, second = train.meshes
    turning = {first.name: drive.turning, second.name: drive.turning * (1 if train.basic_ratio > 0 else -1)}
    for mesh in train.meshes:
        own = phases[mesh.name]
        stiffness = PlanetMeshStiffness(mesh=mesh, cycle=cycle(mesh), driver=own.driver)
        angle = math.radians(pose.rotations[mesh.central.name])
        for planet, ahead in zip(pose.planets, own.ahead, strict=True):
            psi = math.radians(planet.angle)
            found = contacts(mesh, angle=angle, psi=psi, driver=own.driver, turning=turning[mesh.name])
            assert stiffness.stiffness_at(ahead) == pytest.approx(at(mesh, found), rel=INTERPOLATED)


def test_what_drives() -> None:
    """By the loads, as by the phases of the same load."""
    for train in (simple_set(20, 32), simple_set(24, 21), alm_set()):
        for load in (None, TrainLoad(torque=90), TrainLoad(torque=-90, speed=100), TrainLoad(torque=-90, speed=-100)):
            loads = None if load is None else mesh_loads(train, power_flow(train, load))
            phases = mesh_phases(train, drive_of(train, load))
            found = train_stiffness(train, loads, method="iso6336")
            assert {name: each.driver for name, each in found.items()} == {name: each.driver for name, each in phases.items()}
            assert all(each.nominal is (load is None) for each in found.values())


def test_an_even_share_without_k_gamma() -> None:
    """The stiffness decides the shares, so it must not wait for them."""
    train = alm_set()
    load = TrainLoad(torque=1600, application_factor=1.25, mesh_load_factor=1.5)
    loads = mesh_loads(train, power_flow(train, load))
    found = train_stiffness(train, loads, method="iso6336")
    assert found["ring_5-rim_3p"].cycle.force == pytest.approx(1.25 * 6063.69, rel=1e-6)


def test_without_a_load_a_small_one_is_named() -> None:
    for load in (None, Load(torque=0)):
        found = mesh_stiffness(alm_set().meshes[0], load, method="iso6336")
        assert found.nominal
        assert found.cycle.force == pytest.approx(NOMINAL_STRESS * 14 * 2.8)
        assert [notice.code for notice in found.notices].count("nominal-load") == 1
    assert not mesh_stiffness(alm_set().meshes[0], LOAD, method="iso6336").nominal


def test_stiffer_under_more_load_and_a_mean_only_method_is_flat() -> None:
    mesh = alm_set().meshes[0]
    by_load = [mesh_stiffness(mesh, load).mean for load in (None, Load(torque=50), Load(torque=-165))]
    assert by_load == sorted(by_load)
    flat = mesh_stiffness(mesh, LOAD, method="iso6336")
    assert flat.jumps.size == 0
    assert flat.stiffness_at([0.0, 0.3, 7.7]) == pytest.approx([flat.mean] * 3)


def test_helical_sets_have_no_jumps() -> None:
    for found in train_stiffness(simple_set(helix_angle=15.0)).values():
        assert found.jumps.size == 0
        assert found.ahead[-1] - found.ahead[0] == pytest.approx(1, abs=1e-12)


def test_a_given_mean_needs_no_method() -> None:
    """Of double helical teeth no method tells the stiffness."""
    gears = [
        Gear(name=name, teeth=teeth, normal_module=2, face_width=24, helix_angle=hand, double_helix=DoubleHelix(gap_width=4))
        for name, teeth, hand in (("sun", 20, 20.0), ("planet", 32, -20.0))
    ]
    rim = Rim(name="planet", gear=gears[1])
    none, given = (
        SetMesh.of(Central(name="sun", gear=gears[0], meshes="planet", mesh_stiffness=mean), rim, math.nan)
        for mean in (None, 300.0)
    )
    with pytest.raises(GeometryError, match="double_helix"):
        mesh_stiffness(none)
    found = mesh_stiffness(given)
    assert found.secant == pytest.approx([300.0, 300.0])
    assert found.stiffness_at(0.3, tangent=True) == pytest.approx(300.0)
    assert found.transmission_error == pytest.approx(found.cycle.force / found.secant)
    assert [notice.code for notice in found.notices] == ["course-unknown", "nominal-load"]


def test_an_unknown_method_names_those_there_are() -> None:
    with pytest.raises(ParameterError, match=r"must be one of .*strain-energy"):
        mesh_stiffness(alm_set().meshes[0], method="guess")
