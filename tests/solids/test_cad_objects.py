"""Gears as features of parts: CadQuery's chains, and objects of build123d with their joints."""

import math

import cadquery
import pytest

import gearcad.workplane  # noqa: F401 - gives Workplane its methods
from gearcad import Body, Gear, GearPair, Rack
from gearcad import build123d as objects
from gearcad.core.errors import ParameterError
from gearcad.solids import gear_solid, pair_assembly, rack_solid

PINION = Gear(teeth=20, normal_module=2, face_width=20, helix_angle=15, body=Body(bore=10), tooth_thinning=0.05, name="small")
WHEEL = Gear(teeth=41, normal_module=2, face_width=18, helix_angle=-15, tooth_thinning=0.05, name="large")
PAIR = GearPair(pinion=PINION, wheel=WHEEL)


def test_a_gear_on_a_bracket_is_one_solid() -> None:
    plate = cadquery.Workplane("XY").box(120, 60, 6)
    part = plate.faces(">Z").workplane().pushPoints([(-28, 0), (28, 0)]).gear(PINION)
    assert part.solids().size() == 1 and part.val().isValid()
    assert part.val().Volume() == pytest.approx(120 * 60 * 6 + 2 * gear_solid(PINION).Volume(), rel=1e-9)
    box = part.val().BoundingBox()
    assert (box.zmin, box.zmax) == pytest.approx((-3, 3 + PINION.face_width), abs=1e-6)


def test_a_housing_with_a_bearing_seat_goes_round_a_pair() -> None:
    """What a designer does with a boolean: a block less the room of the gears and a seat behind the pinion."""
    pair = cadquery.Workplane("XY").gear_pair(PAIR)
    assert [each.Volume() for each in pair.solids().vals()] == pytest.approx(
        [each.Volume() for each in pair_assembly(PAIR).toCompound().Solids()], rel=1e-12
    )
    distance = PAIR.centre_distance
    room = cadquery.Workplane("XY").circle(PINION.tip_diameter / 2 + 2).extrude(PINION.face_width)
    room = room.union(
        cadquery.Workplane("XY").center(distance, 0).circle(WHEEL.tip_diameter / 2 + 2).extrude(PINION.face_width)
    )
    seat = cadquery.Workplane("XY").workplane(offset=PINION.face_width).circle(13).extrude(10)
    block = cadquery.Workplane("XY").workplane(offset=-5).center(distance / 2, 0).rect(220, 120).extrude(35)
    housing = block.cut(room).cut(seat)
    assert housing.val().isValid() and housing.solids().size() == 1
    assert housing.val().Volume() == pytest.approx(220 * 120 * 35 - room.val().Volume() - math.pi * 13**2 * 10, rel=1e-9)
    assert sum(each.Volume() for each in housing.intersect(pair).solids().vals()) == pytest.approx(0, abs=1e-9)


def test_a_gear_by_itself_and_a_rack_stand_where_the_chain_is() -> None:
    apart = cadquery.Workplane("XZ").pushPoints([(0, 0), (100, 0)]).gear(PINION, combine=False)
    assert [each.BoundingBox().ymin for each in apart.solids().vals()] == pytest.approx([-PINION.face_width] * 2, abs=1e-6)
    rack = Rack(teeth=5, normal_module=2, face_width=10, height=12)
    assert cadquery.Workplane("XY").rack(rack).val().Volume() == pytest.approx(rack_solid(rack).Volume(), rel=1e-12)


def test_objects_of_build123d_are_the_same_solids_and_their_joints_bring_them_into_mesh() -> None:
    build123d = pytest.importorskip("build123d")
    part = objects.gear(PINION)
    assert part.label == "small" and part.volume == pytest.approx(gear_solid(PINION).Volume(), rel=1e-12)
    small, large = objects.pair(PAIR, angle=33.0)
    there = large.location
    posed = PAIR.wheel_pose(33.0)
    assert tuple(there.position) == pytest.approx((posed.x, 0, posed.z), abs=1e-9)
    assert small.distance_to(large) > 1e-3  # half the backlash, about
    large.location = build123d.Location((500, 3, 2), (10, 20, 30))
    small.joints["mesh"].connect_to(large.joints["mesh"])
    assert tuple(large.location.position) == pytest.approx(tuple(there.position), abs=1e-9)
    assert tuple(large.location.orientation) == pytest.approx(tuple(there.orientation), abs=1e-9)
    rack = Rack(teeth=5, normal_module=2, face_width=10, height=12)
    assert objects.rack(rack).volume == pytest.approx(rack_solid(rack).Volume(), rel=1e-12)
    with pytest.raises(ParameterError, match="angle"):
        objects.pair(PAIR, angle="far")  # type: ignore[arg-type]
