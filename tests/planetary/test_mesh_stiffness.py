"""Stiffness of the meshes of trains: at contacts that are found by cutting flanks, whoever drives and whichever way."""

import math
from functools import cache

import numpy as np
import pytest
from support.cut_flanks import Contacts, contacts
from support.loaded_trains import alm_set, simple_set

from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import Role
from gearcad.dynamics.planetary.planetary_excitation import NOMINAL_STRESS, PlanetMeshStiffness, mesh_stiffness, train_stiffness
from gearcad.geometry import DoubleHelix, Gear
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.planetary import Central, PlanetaryTrain, Rim, SetMesh, TrainLoad
from gearcad.planetary.poses import Drive, drive_of, mesh_phases, train_pose
from gearcad.planetary.power import mesh_loads, power_flow
from gearcad.stiffness import StrainEnergy

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
