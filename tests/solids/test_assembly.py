"""Two gears posed in mesh: parts, places, no overlap, and contact after a turn by the backlash."""

import math
from dataclasses import replace
from pathlib import Path

import cadquery
import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Surface
from support.rings import RingSection

from gearcad import BasicRack, Body, Gear, GearPair, GeometryError
from gearcad.core.records import PerGear
from gearcad.geometry import ShaperCutter
from gearcad.solids import pair_assembly, write_step
from gearcad.solids.exact.assemblies import PartNames, part_names

TIP_ALTERATION = -0.007246444637613869  # (80 - a_d)/2.5 - (0.107 - 0.378)


def _volvo() -> GearPair:
    pinion = Gear(
        teeth=13, normal_module=2.5, face_width=18.3, helix_angle=28, profile_shift=0.107, tip_alteration=TIP_ALTERATION,
        tooth_thinning=0.08, rack=BasicRack(root_radius=0.48), body=Body(bore=16),
    )  # fmt: skip
    wheel = Gear(
        teeth=44, normal_module=2.5, face_width=15.1, helix_angle=-28, profile_shift=-0.378, tip_alteration=TIP_ALTERATION,
        tooth_thinning=0.16, rack=BasicRack(root_radius=0.32), body=Body(bore=45),
    )  # fmt: skip
    return GearPair(pinion=pinion, wheel=wheel, centre_distance=80.0)


def _turned(assembly: cadquery.Assembly, degrees: float) -> tuple[cadquery.Shape, cadquery.Shape]:
    """Pinion, and wheel turned about its own axis."""
    pinion, wheel = (assembly.objects[f"pair {role}"] for role in ("pinion", "wheel"))
    place = wheel.loc * cadquery.Location(cadquery.Vector(), cadquery.Vector(0, 0, 1), degrees)
    return pinion.obj, wheel.obj.moved(place)


def _clean() -> GearPair:
    """A helical pair of different widths whose tips stay clear of the fillets."""
    shared = {"normal_module": 2.5, "rack": BasicRack(root_radius=0.3)}
    pinion = Gear(teeth=21, face_width=12.3, helix_angle=28, profile_shift=0.1, tooth_thinning=0.08, **shared)
    wheel = Gear(teeth=30, face_width=8.1, helix_angle=-28, profile_shift=-0.1, tooth_thinning=0.16, **shared)
    pair = GearPair(pinion=pinion, wheel=wheel, axial_offset=0.7)
    assert not pair.warnings
    return pair


def test_solids_touch_only_after_the_backlash() -> None:
    """Independent of the 2D proofs: the kernel's own booleans, on the solids."""
    pair = _clean()
    assembly = pair_assembly(pair)
    half_backlash = math.degrees(pair.circumferential_backlash / pair.working_pitch_diameters[1])
    for side in (-1, 1):
        for share, overlaps in ((0.97, False), (1.1, True)):
            pinion, wheel = _turned(assembly, side * share * half_backlash)
            assert (pinion.intersect(wheel).Volume() > 1e-9) is overlaps, (side, share)


@pytest.mark.parametrize("bracket", [pytest.param(False, marks=pytest.mark.long), True])
def test_parts_reopen_named_coloured_and_separate(tmp_path: Path, bracket: bool) -> None:
    pair = _volvo()
    path = tmp_path / "assembly.step"
    write_step(pair_assembly(pair, bracket=bracket), path, name=pair.name)
    again = cadquery.Assembly.importStep(str(path))
    solids = again.toCompound().Solids()
    assert len(solids) == 2 + bracket
    assert all(solid.isValid() for solid in solids)
    names = ["pair pinion", "pair wheel", "pair bracket"][: 2 + bracket]
    assert [child.name for child in again.children] == names
    assert len({child.color.toTuple() for child in again.children}) == len(names)
    centre = again.children[1].toCompound().BoundingBox()
    assert (centre.xmin + centre.xmax) / 2 == pytest.approx(80.0, abs=0.5)
    assert (centre.zmin + centre.zmax) / 2 == pytest.approx(18.3 / 2, abs=1e-4)


def test_bracket_shafts_fill_the_bores() -> None:
    assembly = pair_assembly(_volvo(), bracket=True)
    bracket = assembly.objects["pair bracket"].obj
    for x, diameter in ((0.0, 16.0), (80.0, 45.0)):
        edge = [cadquery.Vector(x + s * diameter / 2, 0, 9.0) for s in (0.999, 1.001)]
        assert [bracket.isInside(point) for point in edge] == [True, False]
    for role in ("pinion", "wheel"):
        part = assembly.objects[f"pair {role}"]
        assert part.obj.moved(part.loc).intersect(bracket).Volume() < 1e-9


def test_parts_are_products_of_their_pair() -> None:
    """Twelve pairs of a batch are 24 products: two of one name replace each other in CAD and PDM."""
    pair = _clean()
    names = PartNames(PerGear("pair pinion", "pair wheel"), "pair bracket")
    assert part_names(pair) == names
    assert [child.name for child in pair_assembly(pair).children] == ["pair pinion", "pair wheel"]
    pinion, wheel = (replace(gear, name="4711") for gear in (pair.pinion, pair.wheel))
    assert part_names(replace(pair, pinion=pinion)).gears == PerGear("4711", "pair wheel")
    assert part_names(replace(pair, pinion=pinion, wheel=wheel)) == names  # a name must not be that of both
    assert part_names(replace(pair, pinion=pinion, name="4711")).gears.pinion == "4711 pinion"  # nor that of the pair


def _with_ring() -> GearPair:
    shared = {"normal_module": 2.0, "helix_angle": 18.0, "tooth_thinning": 0.05}
    ring = Gear(teeth=-60, face_width=9.5, body=Body(rim_diameter=140), cutter=ShaperCutter(teeth=25), **shared)
    return GearPair(pinion=Gear(teeth=24, face_width=12.3, **shared), wheel=ring, axial_offset=0.7)


def test_a_ring_stands_about_its_pinion(tmp_path: Path) -> None:
    """The pinion's involutes, read back from STEP, leave half of the backlash to the ring's helicoids on both sides."""
    pair, path = _with_ring(), tmp_path / "assembly.step"
    write_step(pair_assembly(pair), path, name=pair.name)
    again = cadquery.Assembly.importStep(str(path))
    assert [child.name for child in again.children] == ["pair pinion", "pair wheel"]
    pinion, ring = (child.obj.moved(child.loc) for child in again.children)
    assert ring.isValid()
    assert pair.centre_distance < 0
    assert ring.Center().toTuple() == pytest.approx((pair.centre_distance, 0.0, 6.15 + 0.7), abs=1e-6)
    pose, section = pair.wheel_pose(), RingSection(pair.wheel)
    points = _flank_points(pinion)
    points = points[np.hypot(*points[:, :2].T) > pair.pinion.form_diameter / 2] - [pose.x, 0, pose.z]
    turn = math.radians(-pose.rotation)
    points[:, :2] @= [[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]]
    radius, angle = section.folded(points)
    inside = (radius > section.tip) & (radius < section.form) & (points[:, 2] > 0) & (points[:, 2] < 9.5)
    gap = section.base * (np.abs(angle[inside]) - section.involute_angle(radius[inside]))
    least = [gap[np.sign(angle[inside]) == side].min() for side in (1, -1)]
    half = pair.normal_backlash / 2 / math.cos(math.radians(pair.wheel.base_helix_angle))
    assert least == pytest.approx([half, half], abs=2e-6)  # both flanks are within 1e-6


def _flank_points(pinion: cadquery.Shape) -> np.ndarray:
    """Points (n, 3) of the sides of the teeth that face +x."""
    faces = [face for face in pinion.Faces() if face.Center().x > 15 and face.geomType() == "BSPLINE"]
    surfaces = [BRepAdaptor_Surface(face.wrapped) for face in faces]
    share = np.linspace(0, 1, 41)
    places = [face.Value(u, v * face.LastVParameter()) for face in surfaces for u in share for v in share]
    return np.array([(place.X(), place.Y(), place.Z()) for place in places])


def test_a_ring_needs_its_rim_and_takes_no_bracket() -> None:
    pair = _with_ring()
    with pytest.raises(GeometryError, match=r"^bracket = True: must be left out with a ring: it has no bore for a shaft"):
        pair_assembly(pair, bracket=True)
    with pytest.raises(GeometryError, match=r"^wheel\.body\.rim_diameter is missing: must be given, at least"):
        pair_assembly(replace(pair, wheel=replace(pair.wheel, body=Body())))


def test_bracket_needs_bores() -> None:
    gear = Gear(teeth=20, normal_module=2, face_width=10)
    with pytest.raises(GeometryError, match=r"pinion\.body\.bore"):
        pair_assembly(GearPair(pinion=gear, wheel=gear), bracket=True)
