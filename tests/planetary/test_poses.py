"""Poses of trains: reference rotations, exact outlines that do not overlap, and turns that follow Willis."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from support.planetary import clearance, gear, simple_train, stage_clearance, thesis_train, train_clearance
from support.planetary_trains import TRAINS
from support.ring_pairs import CHORD_ERROR

from gearcad import BasicRack, Gear, GearPair
from gearcad.geometry import DoubleHelix
from gearcad.geometry.gear import halves
from gearcad.planetary import Central, GearPlace, PairStage, PlanetaryTrain, Rim

POLYGONS = 8 * CHORD_ERROR
"""What chords of a ring's polygons may seem to overlap (mm, module 2), where there is no backlash."""

REFERENCE = {
    (24, 21, -66): ((0.3, 0.2, -0.7), 7.5, (351.42857142857144, 94.28571428571433, 197.14285714285722)),
    (20, 28, -76): ((0.3, 0.3, -0.9), 0.0, (353.57142857142856, 199.28571428571428, 45.00000000000006, 250.71428571428578)),
    (22, 20, -62): ((0.4, 0.3, -1.0), 0.0, (351.0, 162.0, 333.00000000000006, 144.0000000000001)),
    (21, 18, -57): ((0.3, 0.2, -0.7), 17.14285714285711, (350.0, 90.0, 190.0)),
    (25, 20, -65): ((0.2, 0.2, -0.6), 14.4, (351.0, 81.00000000000006, 171.0)),
}
"""By teeth: shifts; rotation of the sun in its pitch, and of the planets (degrees), from an own computation apart from this."""


@pytest.mark.parametrize("teeth", REFERENCE)
def test_plain_sets_stand_as_computed_elsewhere(teeth: tuple[int, int, int]) -> None:
    shifts, sun, planets = REFERENCE[teeth]
    train = simple_train(teeth, shifts, len(planets))
    pose = train.pose()
    pitch = 360 / teeth[0]
    assert (pose.rotations["sun"] - sun + pitch / 2) % pitch - pitch / 2 == pytest.approx(0, abs=1e-9)
    assert [planet.rotations["planet"] for planet in pose.planets] == pytest.approx(planets, abs=1e-9)
    assert train_clearance(train, train.pose(3.7)) > -POLYGONS


def helical(widths: tuple[float, float, float]) -> PlanetaryTrain:
    """A train with thinned teeth at 15 degrees, of three face widths."""
    thin = {"tooth_thinning": 0.03}
    sun = gear(24, 2.0, 0.3, helix_angle=15.0, face_width=widths[0], **thin)
    planet = gear(23, 2.0, 0.35, helix_angle=-15.0, face_width=widths[1], **thin)
    distance = float(GearPair(pinion=planet, wheel=sun).centre_distance)
    ring = gear(-72, 2.0, -1.1, helix_angle=-15.0, face_width=widths[2], **thin)
    return simple_train((24, 23, -72), (0.3, 0.35, -1.1), 4, gears=(sun, planet, ring), centre_distance=distance)


@pytest.mark.parametrize("widths", [(20.0, 20.0, 20.0), (25.0, 21.0, 14.0), (10.0, 33.0, 17.0)])
def test_helical_teeth_mesh_at_every_height(widths: tuple[float, float, float]) -> None:
    train = helical(widths)
    for angle in (0.0, 12.3):
        assert train_clearance(train, train.pose(angle)) > 1e-4


@pytest.mark.parametrize("clocking", [0.0, 1.7])
def test_the_thesis_train_stands_in_mesh_with_its_pre_stage(clocking: float) -> None:
    train = thesis_train()
    train = replace(train, rims=(train.rims[0], replace(train.rims[1], clocking=clocking)))
    for angle in (0.0, 5.1, -400.0):
        pose = train.pose(angle)
        assert train_clearance(train, pose) > 0.01
        assert stage_clearance(train.stages[0], pose.stages[0].gears) > 1e-3
        assert pose.rotations["ring_4"] == pytest.approx(train.pose().rotations["ring_4"], abs=1e-9)
        for planet in pose.planets:
            assert planet.rotations["rim_3p"] - planet.rotations["rim_3"] == pytest.approx(clocking, abs=1e-9)


def test_a_turn_of_the_carrier_is_geared_down() -> None:
    train = thesis_train()
    start, pose = train.pose(), train.pose(10.0)
    assert pose.rotations["ring_5"] - start.rotations["ring_5"] == pytest.approx(10 * (1 - 70 * 21 / (22 * 72)), abs=1e-9)
    pinion = pose.stages[0].gears.pinion.rotation - start.stages[0].gears.pinion.rotation
    assert pinion == pytest.approx(-10 * 161 / 18, abs=1e-9)
    assert pose.planets[1].angle - start.planets[1].angle == 10.0


def test_a_central_can_be_turned_while_the_carrier_stands() -> None:
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3)
    start, pose = train.pose(), train.pose(0.0, central_turn=4.0)
    assert pose.rotations["ring"] - start.rotations["ring"] == 4.0
    assert pose.rotations["sun"] - start.rotations["sun"] == pytest.approx(-11.0, abs=1e-9)
    assert train_clearance(train, pose) > -POLYGONS


def test_stages_stand_in_mesh_on_whatever_member_and_either_way_round() -> None:
    ring = GearPair(
        pinion=gear(20, 2.0, face_width=12.0, tooth_thinning=0.05, helix_angle=10.0),
        wheel=gear(-70, 2.0, tooth_thinning=0.05, helix_angle=10.0),
        axial_offset=1.5,
    )
    pair = GearPair(pinion=gear(17, 2.0, 0.3, tooth_thinning=0.05), wheel=gear(31, 2.0, tooth_thinning=0.05))
    stages = (
        PairStage(name="behind", pair=ring, pinion="carrier", wheel="drum", angle=40.0, axial_position=40.0),
        PairStage(name="before", pair=pair, pinion="motor", wheel="sun", angle=-100.0, axial_position=-30.0),
        PairStage(name="inner", pair=ring, pinion="lay", wheel="drum", angle=200.0, axial_position=90.0),
    )
    train = simple_train((24, 21, -66), (0.3, 0.2, -0.7), 3, stages=stages, input="motor", output="lay")
    for angle in (0.0, 33.0):
        pose = train.pose(angle)
        for stage, placed in zip(stages, pose.stages, strict=True):
            assert stage_clearance(stage, placed.gears) > 1e-3
        behind, before, inner = (placed.gears for placed in pose.stages)
        assert math.dist(behind.wheel[1:3], (0, 0)) == pytest.approx(-ring.centre_distance)
        assert math.dist(inner.pinion[1:3], behind.wheel[1:3]) == pytest.approx(-ring.centre_distance)
        assert behind.wheel.height == pytest.approx(40 + (12 - 20) / 2 + 1.5)
    assert before.wheel.rotation == pytest.approx(pose.rotations["sun"] - train.pose().rotations["sun"], abs=1e-9)


@pytest.mark.parametrize("angles", ["equal", (0.0, 85.0, 171.3, 260.0)])
def test_planets_clocked_by_themselves_stand_in_mesh_anywhere(angles: object) -> None:
    train = thesis_train()
    adjusted = (train.rims[0], replace(train.rims[1], clocking="adjusted"))
    train = replace(train, planets=4, planet_angles=angles, rims=adjusted, tip_distance=1.0)
    pose = train.pose(3.3)
    assert train_clearance(train, pose) > 0.01
    clockings = [planet.rotations["rim_3p"] - planet.rotations["rim_3"] for planet in pose.planets]
    assert clockings[0] == pytest.approx(0, abs=1e-9)
    assert max(map(abs, clockings)) <= 360 / (2 * 21 * 22) + 1e-9  # a turn by pitches of either rim leaves no more
    assert any(abs(each) > 0.01 for each in clockings)
    assert "adjusted-planets" in {notice.code for notice in train.notices}


def test_double_helical_teeth_mesh_in_both_halves() -> None:
    """The halves of each gear, each with its own hand, in the place that it has in the pose."""

    def double(teeth: int, shift: float, helix: float, width: float, gap: float) -> Gear:
        halved = DoubleHelix(gap_width=gap, offset=math.copysign(0.2, helix))
        return gear(teeth, 2.0, shift, helix_angle=helix, face_width=width, tooth_thinning=0.03, double_helix=halved)

    suns = double(30, 0.2, 25.0, 44.0, 4.0), double(31, 0.0, -25.0, 38.0, 5.0)
    planets = double(24, 0.1, -25.0, 40.0, 6.0), double(23, 0.3, 25.0, 42.0, 4.0)
    train = PlanetaryTrain(
        planets=3,
        centrals=tuple(Central(name=name, gear=sun, meshes=f"rim_{name}") for name, sun in zip("ab", suns, strict=True)),
        rims=(Rim(name="rim_a", gear=planets[0]), Rim(name="rim_b", gear=planets[1], clocking=3.0, axial_position=60.0)),
        input="a",
        output="carrier",
        fixed="b",
    )
    pose = train.pose(8.0)
    for mesh in train.meshes:
        central, rim = mesh.central, mesh.rim
        for half in (0, 1):
            lower, upper = halves(central.gear)[half], halves(rim.gear)[half]
            placed = pose.planets[1]
            places = (
                GearPlace(pose.rotations[central.name] + lower.rotation, 0.0, 0.0, pose.heights[central.name] + lower.z),
                GearPlace(placed.rotations[rim.name] + upper.rotation, placed.x, placed.y, pose.heights[rim.name] + upper.z),
            )
            bottom = max(place.height for place in places)
            for height in (bottom, bottom + 10.0):
                assert clearance(lower.gear, upper.gear, places, height) > 1e-4


@pytest.mark.parametrize(("name", "planets"), [("B", 4), ("B", 2), ("C", 3), ("C", 2), ("C", 6), ("A helical", 4), ("D", 3)])
def test_stepped_planets_are_turned_on_by_pitches_until_both_rims_fit(name: str, planets: int) -> None:
    train = replace(TRAINS[name], planets=planets)
    if any(notice.code == "fillet-interference" for notice in train.notices):
        ring = replace(train.centrals[1], gear=replace(train.centrals[1].gear, rack=BasicRack(addendum=0.8)))
        train = replace(train, centrals=(train.centrals[0], ring))
    assert train_clearance(train, train.pose(5.0)) > -2 * POLYGONS
