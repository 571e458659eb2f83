"""The built B-rep against the exact surface, before and after STEP; volume, mass and second moments of boundaries."""

import json
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cadquery
import numpy as np
import pytest
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_BSplineSurface
from support.clearance import distance_to_section, solid_volume
from support.solids import reopened, valid_and_closed

from gearcad import BasicRack, Body, FlankModification, Gear, Rack
from gearcad.geometry import DoubleHelix
from gearcad.solids import gear_solid, write_step
from gearcad.solids.exact.boundary import Boundary, Recorder, level_plane
from gearcad.solids.exact.inertia import mass_properties, moments
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import gear_boundary
from gearcad.solids.exact.teeth import tube
from gearcad.solids.files.train_products import carrier_boundary
from gearcad.solids.train_plan import CarrierPlan

FLANK_TOLERANCE = 1e-5  # mm: the promise is 0.01 µm
FITTED = 1e-6  # mm: what a section is fitted to; misses of this size would show a fault in the construction
VOLUME_TOLERANCE = 1e-7  # 0.1 ppm

_TIP = -0.007246444637613869
_QUARTER_TURN = math.pi * 12 / math.tan(math.radians(30)) / math.cos(math.radians(30)) / 2  # z 12, m 2: 90 deg of twist

GEARS = {
    "volvo pinion": {
        "teeth": 13, "normal_module": 2.5, "face_width": 18.3, "helix_angle": 28.0, "profile_shift": 0.107,
        "tip_alteration": _TIP, "tooth_thinning": 0.08, "rack": BasicRack(root_radius=0.48),
    },
    "volvo wheel": {
        "teeth": 44, "normal_module": 2.5, "face_width": 15.1, "helix_angle": -28.0, "profile_shift": -0.378,
        "tip_alteration": _TIP, "tooth_thinning": 0.16, "rack": BasicRack(root_radius=0.32),
    },
    "alm 18": {"teeth": 18, "normal_module": 1.5, "face_width": 15.0, "profile_shift": 0.3422, "tip_alteration": -0.0104},
    "alm 161": {"teeth": 161, "normal_module": 1.5, "face_width": 10.0, "profile_shift": 0.1682, "tip_alteration": -0.0104},
    "z 6 undercut": {"teeth": 6, "normal_module": 2.0, "face_width": 10.0},
    "z 8 undercut": {"teeth": 8, "normal_module": 2.0, "face_width": 10.0},
    "z 10 undercut helical": {"teeth": 10, "normal_module": 2.0, "face_width": 10.0, "helix_angle": 15.0},
    "z 300": {"teeth": 300, "normal_module": 1.0, "face_width": 10.0},
    "twist 90": {"teeth": 12, "normal_module": 2.0, "face_width": _QUARTER_TURN, "helix_angle": 30.0},
    "twist 180": {"teeth": 12, "normal_module": 2.0, "face_width": 2 * _QUARTER_TURN, "helix_angle": -30.0},
    "twist 720": {"teeth": 12, "normal_module": 2.0, "face_width": 7.999 * _QUARTER_TURN, "helix_angle": 30.0},
    "m 0.1": {"teeth": 20, "normal_module": 0.1, "face_width": 1.0, "helix_angle": 20.0},
    "m 20": {"teeth": 20, "normal_module": 20.0, "face_width": 200.0, "helix_angle": -20.0},
    "full radius": {"teeth": 20, "normal_module": 2.0, "face_width": 20.0, "rack": BasicRack(root_radius="full")},
    "sharp tool": {"teeth": 20, "normal_module": 2.0, "face_width": 20.0, "rack": BasicRack(root_radius=0)},
    "nearly pointed": {"teeth": 20, "normal_module": 2.0, "face_width": 20.0, "tip_diameter": 46.0},
    "tip chamfer": {"teeth": 20, "normal_module": 2.0, "face_width": 20.0, "helix_angle": -12.0, "body": Body(tip_chamfer=0.3)},
}  # fmt: skip


def _flank_points(solid: cadquery.Shape, width: float, most: int = 40, grid: int = 11) -> np.ndarray:
    """Points (n, 3) inside the B-spline faces (flanks, fillets, chamfers), from the first and last of them."""
    faces = [BRepAdaptor_Surface(face.wrapped) for face in solid.Faces()]
    faces = [face for face in faces if face.GetType() == GeomAbs_BSplineSurface]
    assert faces, "a gear without flanks"
    chosen = faces if len(faces) <= 2 * most else faces[:most] + faces[-most:]
    points = [face.Value(u, v) for face in chosen for u in np.linspace(0, 1, grid) for v in np.linspace(0, width, grid)]
    return np.array([(p.X(), p.Y(), p.Z()) for p in points])


_LONG = ("alm 161", "z 300", "volvo wheel", "z 8 undercut", "twist 180", "m 20")


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in _LONG)) for name in GEARS])
def test_flanks_volume_and_validity_before_and_after_step(name: str, tmp_path: Path) -> None:
    gear = Gear(**GEARS[name])
    solid = gear_solid(gear)
    again = reopened(solid, tmp_path / "gear.step")
    volume = solid_volume(gear)
    for shape in (solid, again):
        assert valid_and_closed(shape)
        assert shape.Volume() == pytest.approx(volume, rel=VOLUME_TOLERANCE)
    assert distance_to_section(gear, _flank_points(solid, gear.face_width)).max() < FITTED < FLANK_TOLERANCE


@pytest.mark.parametrize("helix", [0.0, 28.0, -17.0])
@pytest.mark.parametrize("side", ["front", "back", "both"])
def test_bore_keyway_and_hub(helix: float, side: str) -> None:
    body = Body(bore=16, keyway_width=5, keyway_depth=2.3, hub_diameter=26, hub_length=4, hub_side=side)
    gear = Gear(teeth=20, normal_module=2, face_width=12, helix_angle=helix, body=body)
    solid = gear_solid(gear)
    hubs = 2 if side == "both" else 1
    expected = solid_volume(gear)
    assert valid_and_closed(solid)
    assert solid.Volume() == pytest.approx(expected, rel=VOLUME_TOLERANCE)
    box = solid.BoundingBox()
    assert box.zmin == pytest.approx(0 if side == "front" else -4, abs=1e-5)
    assert box.zmax == pytest.approx(12 if side == "back" else 16, abs=1e-5)
    assert len(solid.Faces()) == len(gear_solid(Gear(teeth=20, normal_module=2, face_width=12)).Faces()) + 4 + 2 * hubs


CHAMFERS = {
    "on the tip land": (0.02, 45.0, 0.0),
    "on the flank": (0.8, 30.0, 0.0),
    "over the tip chamfer": (1.0, 45.0, 0.3),
    "into the fillet": (2.05, 60.0, 0.0),
    "below the root": (5.2, 45.0, 0.0),
    "flat, below the root": (2.2, 70.0, 0.3),
    "begins on the form circle": (None, 45.0, 0.0),
}


@pytest.mark.parametrize(
    ("name", "helix"),
    [
        pytest.param(name, helix, marks=() if (row + column) % 3 == 0 else pytest.mark.long)
        for row, name in enumerate(CHAMFERS)
        for column, helix in enumerate((0.0, 28.0, -17.0))
    ],
)
def test_end_chamfer(name: str, helix: float, tmp_path: Path) -> None:
    length, angle, tip = CHAMFERS[name]
    plain = {"teeth": 14, "normal_module": 2.0, "face_width": 12.0, "helix_angle": helix, "profile_shift": 0.2}
    if length is None:
        bare = Gear(**plain)
        length = (bare.tip_diameter - bare.form_diameter) / 2
    gear = Gear(**plain, body=Body(bore=12, end_chamfer=length, end_chamfer_angle=angle, tip_chamfer=tip))
    again = reopened(gear_solid(gear), tmp_path / "gear.step")
    assert valid_and_closed(again)
    assert again.Volume() == pytest.approx(solid_volume(gear), rel=VOLUME_TOLERANCE)


def test_a_chamfer_is_what_a_boolean_would_cut() -> None:
    body = Body(end_chamfer=1.2, end_chamfer_angle=40.0)
    plain = {"teeth": 12, "normal_module": 2.0, "face_width": 8.0, "helix_angle": 20.0}
    gear = Gear(**plain, body=body)
    radius, depth = gear.tip_diameter / 2, 1.2 * math.tan(math.radians(40.0))
    blank = cadquery.Workplane("XZ").polyline(
        [(0, 0), (radius - depth, 0), (radius, 1.2), (radius, 6.8), (radius - depth, 8), (0, 8)]
    )
    cut = gear_solid(Gear(**plain)).intersect(blank.close().revolve(360, (0, 0), (0, 1)).val())
    assert gear_solid(gear).Volume() == pytest.approx(cut.Volume(), rel=1e-6)  # the boolean's own tolerance


def test_right_hand_helix_turns_counter_clockwise_with_z() -> None:
    for helix in (20.0, -20.0):
        gear = Gear(teeth=12, normal_module=2.0, face_width=10.0, helix_angle=helix)
        solid = gear_solid(gear)
        turn = math.copysign(2 * math.pi * 5.0 / gear.lead, helix)
        inside = gear.tip_diameter / 2 - 0.05
        point = cadquery.Vector(inside * math.cos(turn), inside * math.sin(turn), 5.0)
        mirrored = cadquery.Vector(point.x, -point.y, 5.0)
        assert solid.isInside(point)
        assert not solid.isInside(mirrored)


def test_equal_input_gives_equal_bytes(tmp_path: Path) -> None:
    gear = Gear(**GEARS["volvo pinion"])
    for name in ("a.step", "b.step"):
        write_step(gear_solid(gear), tmp_path / name, name="pinion")
    assert (tmp_path / "a.step").read_bytes() == (tmp_path / "b.step").read_bytes()
    assert b"'pinion'" in (tmp_path / "a.step").read_bytes()


def test_users_go_on_in_cadquery() -> None:
    gear = Gear(teeth=20, normal_module=2, face_width=10, body=Body(bore=10))
    drilled = cadquery.Workplane(obj=gear_solid(gear)).faces(">Z").workplane(origin=(0, 0, 0)).polarArray(11, 0, 360, 4).hole(4)
    assert drilled.val().isValid()
    removed = gear_solid(gear).Volume() - drilled.val().Volume()
    assert removed == pytest.approx(4 * math.pi * 4 * 10, rel=1e-6)


SAME = 1e-10
"""Relative: faces may miss their common edges by 1 nm, and the kernel integrates curved faces to 3e-11."""

EXACT = 1e-13
"""Relative: rounding, for cylinders and planes."""


def _bodied(teeth: int = 8, **given: Any) -> Gear:
    body = Body(bore=5, keyway_width=2, keyway_depth=1, hub_diameter=9, hub_length=2, end_chamfer=0.4)
    return Gear(teeth=teeth, normal_module=2, **{"face_width": 6, "body": body, **given})


def _ring(**given: Any) -> Gear:
    body = Body(rim_diameter=90, bolt_circle=82, bolt_holes=3, bolt_diameter=4, end_chamfer=0.3)
    return Gear(teeth=-30, normal_module=2, face_width=6, body=body, **given)


_RELIEVED = FlankModification(tip_relief=0.02, tip_relief_length=1.0, lead_crowning=0.01, helix_angle_modification=0.005)
_PINS = ((20.0, 0.0), (-10.0, 17.0), (-10.0, -17.0))

SOLIDS: dict[str, Callable[[], Boundary]] = {
    "spur": lambda: gear_boundary(_bodied(20)),
    "helical": lambda: gear_boundary(_bodied(helix_angle=15)),
    "chamfers below the root": lambda: gear_boundary(_bodied(12, face_width=12, body=Body(bore=5, end_chamfer=5.2))),
    "apex": lambda: gear_boundary(_bodied(helix_angle=25, double_helix=DoubleHelix(gap_width=0))),
    "gap": lambda: gear_boundary(_bodied(helix_angle=25, double_helix=DoubleHelix(gap_width=2, offset=0.3))),
    "modified": lambda: gear_boundary(_bodied(20, helix_angle=-10, modification=_RELIEVED)),
    "ring": lambda: gear_boundary(_ring(helix_angle=-18)),
    "rack": lambda: rack_boundary(Rack(teeth=2, normal_module=2, face_width=8, height=6, helix_angle=17)),
    "straight rack": lambda: rack_boundary(Rack(teeth=3, normal_module=2, face_width=8, height=6)),
    "carrier": lambda: carrier_boundary(CarrierPlan(_PINS, 6.0, 12.0, 28.0, (-2.0, 11.0), ((-2.0, 0.0), (9.0, 11.0)))),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_moments_are_the_kernels(name: str) -> None:
    from OCP.BRepGProp import BRepGProp
    from OCP.gp import gp
    from OCP.GProp import GProp_GProps

    boundary, witness = SOLIDS[name](), GProp_GProps()
    BRepGProp.VolumeProperties_s(kernel_solid(boundary), witness)
    assert moments(boundary) == pytest.approx((witness.Mass(), witness.MomentOfInertia(gp.OZ_s())), rel=SAME)


@pytest.mark.parametrize("axis", [(0.0, 0.0), (40.0, -30.0)])
def test_a_pipe(axis: tuple[float, float]) -> None:
    recorder, ends = Recorder(1e-7), (3.0, 8.0)
    outer, inner = tube(recorder, 10.0, ends, axis, outward=True), tube(recorder, 4.0, ends, axis, outward=False)
    for which, z in enumerate(ends):
        loops = [outer[which].loop(along=True), inner[which].loop(along=False)]
        recorder.face(level_plane(z), loops, outward=which == 1)
    volume = math.pi * (10.0**2 - 4.0**2) * 5.0
    polar = volume * ((10.0**2 + 4.0**2) / 2 + math.hypot(*axis) ** 2)
    assert moments(recorder.boundary()) == pytest.approx((volume, polar), rel=EXACT)


def test_a_lift_and_a_turn_change_neither() -> None:
    def walls(recorder: Recorder) -> None:
        contours = tube(recorder, 3.0, (0.0, 5.0), (20.0, 0.0), outward=True)
        for which, z in enumerate((0.0, 5.0)):
            recorder.face(level_plane(z), [contours[which].loop(along=True)], outward=which == 1)

    here, there = Recorder(1e-7), Recorder(1e-7)
    walls(here)
    walls(there.moved(7.0, 0.3))
    assert moments(here.boundary()) == pytest.approx(moments(there.boundary()), rel=EXACT)


def test_a_carrier_is_its_plates_and_pins() -> None:
    plates = 2 * 2.0 * math.pi * (28.0**2 - 12.0**2)
    pins = [9.0 * math.pi * 9.0] * 3
    apart = [9.0 / 2 + x * x + y * y for x, y in _PINS]
    polar = plates * (28.0**2 + 12.0**2) / 2 + sum(pin * square for pin, square in zip(pins, apart, strict=True))
    assert moments(SOLIDS["carrier"]()) == pytest.approx((plates + sum(pins), polar), rel=EXACT)


_CODE = """
import json, sys
from gearcad import Body, Gear
from gearcad.solids.exact.inertia import mass_properties
mass_properties(Gear(teeth=20, normal_module=2, face_width=6, body=Body(bore=5)), 7850.0)
print(json.dumps([name for name in ("OCP", "cadquery", "scipy") if name in sys.modules]))
"""


def test_mass_and_inertia_need_no_cad_kernel() -> None:
    done = subprocess.run([sys.executable, "-c", _CODE], check=True, capture_output=True, text=True)
    assert json.loads(done.stdout) == []


def _of_outline(gear: Gear, density: float) -> tuple[float, float]:
    """Mass (kg) and inertia (kg·m²) by Green's theorem along a fine polygon, less the bore."""
    x, y = gear.profile.contour(1e-6).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    area = cross.sum() / 2
    square = sum((each**2 + each * np.roll(each, -1) + np.roll(each, -1) ** 2) @ cross for each in (x, y)) / 12
    bore = gear.body.bore / 2
    area, square = area - math.pi * bore**2, square - math.pi * bore**4 / 2
    return area * gear.face_width * density * 1e-9, square * gear.face_width * density * 1e-15


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_a_gear_with_a_bore(helix: float) -> None:
    gear = Gear(teeth=23, normal_module=2.0, face_width=14.0, helix_angle=helix, body=Body(bore=12.0))
    assert mass_properties(gear, 7850.0) == pytest.approx(_of_outline(gear, 7850.0), rel=2e-6)


def test_hubs_add_a_ring() -> None:
    plain = Gear(teeth=23, normal_module=2.0, face_width=14.0, body=Body(bore=12.0))
    hub = Gear(teeth=23, normal_module=2.0, face_width=14.0, body=Body(bore=12.0, hub_diameter=30.0, hub_length=5.0))
    ring = math.pi / 32 * (30.0**4 - 12.0**4) * 5.0 * 7850e-15
    assert mass_properties(hub, 7850.0).inertia - mass_properties(plain, 7850.0).inertia == pytest.approx(ring, rel=1e-6)
