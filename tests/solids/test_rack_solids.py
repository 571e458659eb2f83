"""Solids, facets, drawings and points of racks against formulas of the tests' own, before and after STEP."""

import csv
import math
from pathlib import Path
from typing import Any

import cadquery
import ezdxf
import numpy as np
import pytest
import trimesh
from hypothesis import event, given, settings
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Cylinder, GeomAbs_Plane
from support.rack_clearance import rack_height, rack_volume, section_area
from support.solids import reopened, valid_and_closed
from support.strategies import build_rack, rack_inputs

from gearcad import BasicRack, Body, Gear, Rack, RackPair
from gearcad.core.errors import InputError, ParameterError
from gearcad.solids import rack_assembly, rack_solid, tessellate_rack, write_rack_dxf, write_rack_points, write_step
from gearcad.solids.exact.inertia import rack_mass
from gearcad.solids.files.dxf import rack_contour

VOLUME_TOLERANCE = 1e-7  # 0.1 ppm
ON_SURFACE = 1e-9  # mm: planes, cylinders and ellipses are exact

PLAIN: dict[str, Any] = {"teeth": 3, "normal_module": 2.0, "face_width": 20.0, "height": 10.0}

RACKS: dict[str, dict[str, Any]] = {
    "spur": {},
    "ends in a flank": {"teeth": None, "length": 20.3},
    "ends in a fillet": {"teeth": None, "length": 18.4, "rack": BasicRack(root_radius="full")},
    "right hand": {"helix_angle": 20.0},
    "left hand, chamfered": {"helix_angle": -20.0, "tip_chamfer": 0.2},
    "full radius": {"rack": BasicRack(root_radius="full")},
    "full radius, right hand": {"helix_angle": 30.0, "rack": BasicRack(root_radius="full")},
    "full radius, left hand": {"helix_angle": -30.0, "rack": BasicRack(root_radius="full")},
    "sharp": {"helix_angle": 5.0, "rack": BasicRack(root_radius=0)},
    "hardly helical": {"helix_angle": 1e-3},
    "short and steep": {"teeth": None, "length": 15.0, "helix_angle": 45.0},
    "steepest": {"teeth": 1, "helix_angle": -75.0},
    "m 0.01": {"normal_module": 0.01, "face_width": 0.1, "height": 0.05, "helix_angle": 15.0},
    "m 200": {"normal_module": 200.0, "face_width": 2000.0, "height": 1000.0, "helix_angle": 15.0},
}


def _miss(rack: Rack, points: np.ndarray) -> np.ndarray:
    """How far (mm, along y) points (n, 3) on the toothed side are off."""
    drift = -math.tan(math.radians(rack.helix_angle))
    return np.abs(points[:, 1] - rack_height(rack, points[:, 0] - drift * points[:, 2]))


@pytest.mark.parametrize("name", RACKS)
def test_surfaces_volume_and_validity_before_and_after_step(name: str, tmp_path: Path) -> None:
    rack = Rack(**PLAIN | RACKS[name])
    solid = rack_solid(rack)
    again = reopened(solid, tmp_path / "rack.step", "rack")
    volume = rack_volume(rack)
    for shape in (solid, again):
        assert valid_and_closed(shape)
        assert shape.Volume() == pytest.approx(volume, rel=VOLUME_TOLERANCE)
    kinds = {BRepAdaptor_Surface(face.wrapped).GetType() for face in again.Faces()}
    assert kinds == {GeomAbs_Plane} | ({GeomAbs_Cylinder} if rack.root_radius else set())
    vertices, triangles = again.tessellate(0.01 * rack.normal_module)
    points = np.array([vertex.toTuple() for vertex in vertices])
    inside = points[points[:, 1] > -rack.height + 1e-9]
    assert len(triangles) and _miss(rack, inside).max() < ON_SURFACE * max(1, rack.normal_module)
    box = solid.BoundingBox()
    assert (box.xmax - box.xmin, box.zmax, -box.ymin) == pytest.approx((rack.length, rack.face_width, rack.height), rel=1e-5)


def test_fillets_are_cylinders_of_the_racks_radius() -> None:
    rack = Rack(**PLAIN | RACKS["right hand"])
    surfaces = [BRepAdaptor_Surface(face.wrapped) for face in rack_solid(rack).Faces()]
    cylinders = [each.Cylinder() for each in surfaces if each.GetType() == GeomAbs_Cylinder]
    assert [each.Radius() for each in cylinders] == pytest.approx([0.76] * len(cylinders), rel=1e-14)
    axis = cylinders[0].Axis().Direction()
    assert math.degrees(math.atan2(axis.X(), axis.Z())) == pytest.approx(-20, abs=1e-12)  # right hand: -x with z, teeth up


def test_mass_is_that_of_the_volume() -> None:
    rack = Rack(**PLAIN)
    assert rack_mass(rack, 7850) == pytest.approx(rack_volume(rack) * 7850e-9, rel=VOLUME_TOLERANCE)


def test_equal_input_gives_equal_bytes(tmp_path: Path) -> None:
    rack = Rack(**PLAIN | RACKS["right hand"])
    for name in ("a", "b"):
        write_step(rack_solid(rack), tmp_path / f"{name}.step", name="rack")
        write_rack_dxf(rack, tmp_path / f"{name}.dxf")
    assert (tmp_path / "a.step").read_bytes() == (tmp_path / "b.step").read_bytes()
    assert (tmp_path / "a.dxf").read_bytes() == (tmp_path / "b.dxf").read_bytes()


# ---------------------------------------------------------------------- facets


def check_facets(rack: Rack, chord_error: float) -> None:
    facets = tessellate_rack(rack, chord_error)
    mesh = trimesh.Trimesh(facets.vertices, facets.faces, process=False)
    assert mesh.is_watertight and mesh.is_winding_consistent and len(facets.vertices) == len(np.unique(facets.faces))
    toothed = rack.length * rack.face_width / math.cos(math.radians(rack.helix_angle)) * 2
    assert facets.volume == pytest.approx(rack_volume(rack), rel=1e-9, abs=toothed * chord_error)
    corners = facets.vertices[facets.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    up = corners[normal[:, 1] > 1e-9 * np.linalg.norm(normal, axis=1)]
    points = np.concatenate([up.mean(axis=1), (up[:, 0] + up[:, 1]) / 2, up[:, 0]])
    # Heights differ by more than distances: by the slope of the fillets, at the most.
    slope = 1 / math.tan(math.radians(rack.rack.pressure_angle))
    assert _miss(rack, points).max() <= chord_error * math.hypot(1, slope) * 1.0001 + 1e-9 * rack.total_height


@pytest.mark.parametrize("name", RACKS)
def test_facets_are_closed_and_within_the_chord_error(name: str) -> None:
    rack = Rack(**PLAIN | RACKS[name])
    for share in (0.01, 0.0005):
        check_facets(rack, share * rack.normal_module)


@pytest.mark.parametrize("hand", [30.0, -30.0])
@pytest.mark.parametrize("width", [30.0, 41.0, 50.0])
def test_corners_of_helical_facets_lie_on_the_fillets(width: float, hand: float) -> None:
    """Where an end of the rack cuts through a fillet, no line of the facets meets its corner: it was on a chord, 3.5 µm off."""
    rack = Rack(**PLAIN | {"teeth": 12, "normal_module": 5, "helix_angle": hand, "face_width": width, "height": 15})
    vertices = tessellate_rack(rack, 0.005).vertices
    assert _miss(rack, vertices[vertices[:, 1] > -rack.height]).max() < 1e-9


def test_chord_error_finer_than_mesh_files_resolve() -> None:
    with pytest.raises(ParameterError, match=r"must be at least 4e-06 mm for a rack of 20 mm"):
        tessellate_rack(Rack(**PLAIN), 1e-7)


# ---------------------------------------------------------------------- random racks


def check_random(inputs: dict[str, Any]) -> None:
    try:
        rack = build_rack(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert "\n" not in str(error)
        return
    event("made")
    solid = rack_solid(rack)
    assert valid_and_closed(solid)
    assert solid.Volume() == pytest.approx(rack_volume(rack), rel=VOLUME_TOLERANCE)
    check_facets(rack, 0.005 * rack.normal_module)


@settings(max_examples=6)
@given(rack_inputs())
def test_random_racks(inputs: dict[str, Any]) -> None:
    check_random(inputs)


@pytest.mark.long
@settings(max_examples=2000)
@given(rack_inputs())
def test_random_racks_long(inputs: dict[str, Any]) -> None:
    check_random(inputs)


# ---------------------------------------------------------------------- drawings and points


def _enclosed(contour: np.ndarray) -> float:
    """Area of a contour of arcs: the polygon's, and the segments between chords and arcs."""
    start, bulge = contour[:, :2], contour[:, 2]
    end = np.roll(start, -1, axis=0)
    chord, angle = np.hypot(*(end - start).T), 4 * np.arctan(bulge)
    polygon = np.sum(start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]) / 2
    bent = np.abs(angle) > 0
    radius = chord[bent] / 2 / np.sin(np.abs(angle[bent]) / 2)
    segments = np.sign(angle[bent]) * radius**2 * (np.abs(angle[bent]) - np.sin(np.abs(angle[bent]))) / 2
    return float(polygon + segments.sum())


@pytest.mark.parametrize("name", RACKS)
def test_contour_encloses_the_section(name: str) -> None:
    rack = Rack(**PLAIN | RACKS[name])
    accuracy = 1e-4 * rack.normal_module
    contour = rack_contour(rack, accuracy)
    exact = 1e-9 if rack.helix_angle == 0 else accuracy / rack.height
    assert _enclosed(contour) == pytest.approx(section_area(rack), rel=exact)
    on_outline = contour[2:]
    assert np.abs(on_outline[:, 1] - rack_height(rack, on_outline[:, 0])).max() < 5 * accuracy


def test_drawing_holds_one_contour_and_lines(tmp_path: Path) -> None:
    rack = Rack(**PLAIN)
    write_rack_dxf(rack, tmp_path / "rack.dxf", lines=True)
    document = ezdxf.readfile(tmp_path / "rack.dxf")
    space = document.modelspace()
    (profile,) = space.query("LWPOLYLINE")
    assert profile.closed and profile.dxf.layer == "PROFILE"
    assert [line.dxf.start.y for line in space.query("LINE")] == pytest.approx([2.0, 0.0, -2.5])
    assert document.header["$EXTMIN"][:2] == pytest.approx((0.0, -10.0)) and document.header["$EXTMAX"][1] == pytest.approx(2.0)
    arcs = [bulge for *_, bulge in profile.get_points("xyb") if bulge]
    assert len(arcs) == 6  # a true arc for each fillet
    assert arcs == pytest.approx([-math.tan(math.radians(70) / 4)] * 6)


def test_points_are_on_the_outline(tmp_path: Path) -> None:
    rack = Rack(**PLAIN | RACKS["right hand"])
    write_rack_points(rack, tmp_path / "rack.csv")
    with (tmp_path / "rack.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert list(dict.fromkeys(row["curve"] for row in rows)) == ["root land", "fillet", "flank", "tip land"]
    x, y = (np.array([float(row[f"{axis}_mm"]) for row in rows]) for axis in "xy")
    assert y == pytest.approx(rack_height(rack, x + rack.transverse_pitch / 2), abs=1e-9)


# ---------------------------------------------------------------------- in mesh


@pytest.mark.parametrize("helix", [pytest.param(0.0, marks=pytest.mark.long), 20.0])
def test_posed_solids_touch_when_the_backlash_is_used_up(helix: float) -> None:
    pinion = Gear(teeth=9, normal_module=2.0, face_width=8.0, helix_angle=helix, profile_shift=0.5, tooth_thinning=0.1)
    rack = Rack(teeth=4, normal_module=2.0, face_width=6.0, height=6.0, helix_angle=-helix, tooth_thinning=0.1)
    pair = RackPair(pinion=pinion, rack=rack)
    one, other = (part.obj.moved(part.loc) for part in rack_assembly(pair).children)
    half = pair.circumferential_backlash / 2
    assert one.intersect(other).Volume() == pytest.approx(0, abs=1e-9)
    for side in (1, -1):
        assert one.distance(other.moved(cadquery.Location((0, side * (half - 0.002), 0)))) == pytest.approx(0.0018, abs=2e-4)
        assert one.intersect(other.moved(cadquery.Location((0, side * (half + 0.002), 0)))).Volume() > 1e-4


def test_parts_of_the_assembly_have_names_of_their_own() -> None:
    gear = Gear(teeth=20, normal_module=2, face_width=20, body=Body(bore=10))
    pair = RackPair(pinion=gear, rack=Rack(**PLAIN | {"name": "bar"}), name="drive")
    assert [part.name for part in rack_assembly(pair).children] == ["drive pinion", "bar"]
