"""The B-rep of rings against the helicoid and the cutter's envelope by formulas of the tests' own, before and after STEP."""

import math
import re
from dataclasses import replace
from pathlib import Path

import cadquery
import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_BSplineSurface, GeomAbs_Cylinder
from support.clearance import distance_to_section, solid_volume
from support.rings import RingSection
from support.solids import reopened, valid_and_closed

from gearcad import BasicRack, Body, Gear, GeometryError
from gearcad.geometry import ShaperCutter
from gearcad.solids import gear_solid
from gearcad.solids.exact.inertia import mass_properties

FITTED = 1e-6  # mm: 0.001 µm, what a section is fitted to and what is promised
VOLUME_TOLERANCE = 1e-7  # 0.1 ppm

_PLAIN = {"teeth": -40, "normal_module": 2.0, "face_width": 12.0, "body": Body(rim_diameter=100)}
_CUTTER = ShaperCutter(teeth=25, tip_radius=0.2)
_ALM = ShaperCutter(teeth=25, tip_radius=0.15)
_FULL = BasicRack(root_radius="full")

RINGS = {
    "spur, form root": {},
    "spur, shaped": {"cutter": _CUTTER},
    "15 deg, form root": {"helix_angle": 15.0},
    "15 deg, shaped": {"helix_angle": 15.0, "cutter": _CUTTER},
    "30 deg, form root": {"helix_angle": 30.0, "body": Body(rim_diameter=110)},
    "30 deg left, shaped": {"helix_angle": -30.0, "cutter": _CUTTER, "body": Body(rim_diameter=110)},
    "alm 70": {
        "teeth": -70, "normal_module": 2.8, "face_width": 14.0, "profile_shift": -1.2025, "tooth_thinning": 0.05,
        "cutter": _ALM, "body": Body(rim_diameter=240, bolt_circle=224, bolt_holes=9, bolt_diameter=8, tip_chamfer=0.3),
    },
    "z -30": {"teeth": -30, "profile_shift": -0.3, "cutter": ShaperCutter(tip_radius=0.25)},
    "z -300": {"teeth": -300, "helix_angle": 15.0, "cutter": ShaperCutter(teeth=50), "body": Body(rim_diameter=660)},
    "full radius": {"rack": _FULL},
    "full radius, helical": {"rack": _FULL, "helix_angle": 25.0},
    "full radius of the cutter": {"rack": _FULL, "cutter": ShaperCutter(teeth=25), "helix_angle": -20.0, "teeth": -60,
                                  "body": Body(rim_diameter=150)},
    "sharp corners": {"cutter": ShaperCutter(tip_radius=0.0), "helix_angle": 15.0},
    "sharp cutter": {"cutter": ShaperCutter(teeth=25, tip_radius=0.0)},
    "thin rim": {"body": Body(rim_diameter=85.4)},
    "m 0.05": {"normal_module": 0.05, "face_width": 0.3, "helix_angle": 20.0, "body": Body(rim_diameter=2.5)},
    "m 100": {"normal_module": 100.0, "face_width": 600.0, "cutter": _CUTTER, "body": Body(rim_diameter=5000)},
    "0.2 m wide": {"helix_angle": 15.0, "face_width": 0.4},
    "20 m wide": {"helix_angle": 15.0, "face_width": 40.0},
}  # fmt: skip


def _ring(**changes: object) -> Gear:
    return Gear(**{**_PLAIN, **changes})


def _side_points(solid: cadquery.Shape, most: int = 90, grid: int = 7) -> np.ndarray:
    """Points (n, 3) of the B-spline surfaces (flanks, fillets, chamfers), some of every kind."""
    faces = [BRepAdaptor_Surface(face.wrapped) for face in solid.Faces()]
    faces = [face for face in faces if face.GetType() == GeomAbs_BSplineSurface]
    chosen = faces[:: math.ceil(len(faces) / most)]
    points = []
    for face in chosen:
        heights = np.linspace(face.FirstVParameter(), face.LastVParameter(), grid)
        points += [face.Value(u, v) for u in np.linspace(0, 1, grid) for v in heights]
    return np.array([(p.X(), p.Y(), p.Z()) for p in points])


def _measure(gear: Gear, *shapes: cadquery.Shape) -> None:
    """Flanks, fillets and chamfers, volume, validity."""
    section = RingSection(gear)
    for shape in shapes:
        assert valid_and_closed(shape)
        assert shape.Volume() == pytest.approx(section.volume, rel=VOLUME_TOLERANCE)
    points = _side_points(shapes[0])
    radius = np.hypot(*points[:, :2].T)
    places = [radius > section.form, (radius <= section.form) & (radius >= section.tip_form), radius < section.tip_form]
    assert all(place.sum() > 100 for place in places[: 3 if gear.body.tip_chamfer else 2][0 if section.corner else 1 :])
    assert section.off(points).max() < FITTED


_DEFAULT = (
    "spur, form root",
    "30 deg left, shaped",
    "full radius of the cutter",
    "m 0.05",
)


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name not in _DEFAULT)) for name in RINGS])
def test_sides_volume_and_validity_before_and_after_step(name: str, tmp_path: Path) -> None:
    gear = _ring(**RINGS[name])
    solid = gear_solid(gear)
    _measure(gear, solid, reopened(solid, tmp_path / "ring.step"))


def test_root_lands_are_there_unless_the_radius_is_full() -> None:
    for changes, kinds in (({}, 2), ({"rack": _FULL}, 1), ({"rack": _FULL, "cutter": ShaperCutter(teeth=25)}, 1)):
        gear = _ring(**changes)
        faces = [BRepAdaptor_Surface(face.wrapped) for face in gear_solid(gear).Faces()]
        radii = [face.Cylinder().Radius() for face in faces if face.GetType() == GeomAbs_Cylinder]
        lands = [-gear.tip_diameter / 2] * 40 + [-gear.root_diameter / 2] * 40 * (kinds - 1) + [50.0]
        assert sorted(radii) == pytest.approx(lands, abs=1e-12)


CHAMFERS = {
    "on the tip land": (0.02, 45.0, 0.0),
    "on the flank": (0.8, 30.0, 0.0),
    "over the tip chamfer": (1.0, 45.0, 0.3),
    "into the fillet": (2.4, 60.0, 0.0),
    "beyond the root": (5.2, 45.0, 0.0),
    "flat, beyond the root": (2.2, 70.0, 0.3),
    "begins on the form circle": (None, 45.0, 0.0),
}


HELICES = (0.0, 28.0, -17.0)


@pytest.mark.parametrize(
    ("name", "helix"),
    [
        pytest.param(name, helix, marks=() if (row + column) % 3 == 0 and row not in (1, 3, 4, 6) else pytest.mark.long)
        for row, name in enumerate(CHAMFERS)
        for column, helix in enumerate(HELICES)
    ],
)
def test_end_chamfer(name: str, helix: float, tmp_path: Path) -> None:
    length, angle, tip = CHAMFERS[name]
    bare = _ring(helix_angle=helix, cutter=_CUTTER)
    if length is None:
        length = (bare.tip_diameter - bare.form_diameter) / 2
    body = Body(
        rim_diameter=120, bolt_circle=109, bolt_holes=5, bolt_diameter=5,
        end_chamfer=length, end_chamfer_angle=angle, tip_chamfer=tip,
    )  # fmt: skip
    gear = replace(bare, body=body)
    solid = gear_solid(gear)
    again = reopened(solid, tmp_path / "ring.step")
    assert valid_and_closed(again)
    assert again.Volume() == pytest.approx(RingSection(gear).volume, rel=VOLUME_TOLERANCE)
    face = RingSection(gear).tip + length * math.tan(math.radians(angle))
    cones = [each for each in solid.Faces() if each.geomType() == "CONE"]
    assert len(cones) == 2 * 40
    corners = np.array([vertex.toTuple() for each in cones for vertex in each.Vertices()])
    on_plane = corners[np.minimum(corners[:, 2], 12.0 - corners[:, 2]) < 1e-9]
    assert np.hypot(*on_plane[:, :2].T) == pytest.approx(np.full(len(on_plane), face), abs=1e-5)


def test_right_hand_helix_turns_counter_clockwise_with_z() -> None:
    for helix in (20.0, -20.0):
        gear = _ring(helix_angle=helix, face_width=10.0, body=Body(rim_diameter=110))
        solid = gear_solid(gear)
        turn = math.copysign(2 * math.pi * 5.0 / gear.lead, helix)
        inside = -gear.tip_diameter / 2 + 0.05
        point = cadquery.Vector(inside * math.cos(turn), inside * math.sin(turn), 5.0)
        mirrored = cadquery.Vector(point.x, -point.y, 5.0)
        assert solid.isInside(point)
        assert not solid.isInside(mirrored)
        assert not solid.isInside(cadquery.Vector(0, 0, 5.0))


def test_bolt_holes_begin_on_x() -> None:
    gear = _ring(helix_angle=15.0, body=Body(rim_diameter=120, bolt_circle=105, bolt_holes=7, bolt_diameter=6))
    solid = gear_solid(gear)
    pitch = 2 * math.pi / 7
    for angle, open_there in ((0.0, True), (2 * pitch, True), (0.5 * pitch, False)):
        assert solid.isInside(cadquery.Vector(52.5 * math.cos(angle), 52.5 * math.sin(angle), 6.0)) is not open_there
    holes = [BRepAdaptor_Surface(f.wrapped) for f in solid.Faces() if f.geomType() == "CYLINDER"]
    places = [hole.Cylinder().Location() for hole in holes if hole.Cylinder().Radius() == 3.0]
    assert sorted(math.atan2(p.Y(), p.X()) % (2 * math.pi) / pitch for p in places) == pytest.approx(range(7), abs=1e-12)
    assert [math.hypot(p.X(), p.Y()) for p in places] == pytest.approx([52.5] * 7)


@pytest.mark.parametrize("name", ["15 deg, shaped", "alm 70", "thin rim"])
def test_mass_and_inertia(name: str) -> None:
    gear = _ring(**RINGS[name])
    section = RingSection(gear)
    assert mass_properties(gear, 7850.0) == pytest.approx((section.volume * 7850e-9, section.inertia * 7850e-15), rel=1e-7)


SHAPED = {
    "spur": {"cutter": ShaperCutter(teeth=25, tip_radius=0.2)},
    "helical, thinned": {"helix_angle": 25.0, "tooth_thinning": 0.1, "cutter": ShaperCutter(teeth=20, profile_shift=0.2)},
    "sharp": {"cutter": ShaperCutter(teeth=25, tip_radius=0.0), "helix_angle": -15.0},
    "full radius": {"rack": _FULL, "cutter": ShaperCutter(teeth=25)},
    "chamfered": {"cutter": ShaperCutter(teeth=25), "body": Body(bore=8, end_chamfer=1.5, tip_chamfer=0.3)},
    "undercut": {"teeth": 9, "cutter": ShaperCutter(teeth=16, tip_radius=0.2)},
}


@pytest.mark.parametrize("name", SHAPED)
def test_external_gears_cut_by_a_shaper(name: str, tmp_path: Path) -> None:
    gear = Gear(**{"teeth": 20, "normal_module": 2.0, "face_width": 8.0, **SHAPED[name]})
    solid = gear_solid(gear)
    for shape in (solid, reopened(solid, tmp_path / "gear.step")):
        assert valid_and_closed(shape)
        assert shape.Volume() == pytest.approx(solid_volume(gear), rel=VOLUME_TOLERANCE)
    assert distance_to_section(gear, _side_points(solid)).max() < FITTED


@pytest.mark.parametrize(
    "body, permitted",
    [
        ({}, "body.rim_diameter is missing: must be given, at least 85.4 mm"),
        ({"rim_diameter": 85.0}, "body.rim_diameter = 85 mm: must be at least 85.4 mm"),
        ({"bolt_circle": 90, "bolt_holes": 4, "bolt_diameter": 6}, "body.bolt_circle = 90 mm: must be at least 91.4 mm (walls"),
        (
            {"rim_diameter": 110, "bolt_circle": 105, "bolt_holes": 4, "bolt_diameter": 6},
            "body.bolt_circle = 105 mm: must be at least 91.4 mm and at most 103.6 mm (walls",
        ),
        (
            {"rim_diameter": 90, "bolt_circle": 88, "bolt_holes": 4, "bolt_diameter": 6},
            "body.bolt_diameter = 6 mm: must be at most 2.1 mm (walls",
        ),
        (
            {"rim_diameter": 85.5, "bolt_circle": 88, "bolt_holes": 4, "bolt_diameter": 6},
            "body.bolt_diameter = 6 mm: must be left out (walls",
        ),
        ({"bolt_circle": 98, "bolt_holes": 50, "bolt_diameter": 6.2}, "body.bolt_holes = 50: must be at most 48, to leave"),
        ({"rim_diameter": 100, "end_chamfer": 5.9}, "body.end_chamfer = 5.9 mm: must be at most 5.88 mm at 45 deg"),
        (
            {"rim_diameter": 86.4, "end_chamfer": 5.5},
            "body.end_chamfer = 5.5 mm: must be at most 5 mm at 45 deg (0.49 of the face width, and some end face left)",
        ),
        (
            {"rim_diameter": 110, "bolt_circle": 92.4, "bolt_holes": 4, "bolt_diameter": 6, "end_chamfer": 5.5},
            "body.end_chamfer = 5.5 mm: must be at most 5 mm at 45 deg",
        ),
    ],
)
def test_bodies_that_leave_no_walls(body: dict[str, float], permitted: str) -> None:
    with pytest.raises(GeometryError, match="^" + re.escape(permitted)):
        gear_solid(_ring(body=Body(**body)))


def test_what_is_permitted_can_be_made() -> None:
    """The numbers of the refusals above."""
    bodies = (
        {"rim_diameter": 97.9, "bolt_circle": 91.4, "bolt_holes": 4, "bolt_diameter": 6},
        {"rim_diameter": 110, "bolt_circle": 98, "bolt_holes": 48, "bolt_diameter": 6.2},
        {"rim_diameter": 86.4, "end_chamfer": 5.0},
    )
    for body in bodies:
        gear = _ring(body=Body(**body))
        _measure(gear, gear_solid(gear))
