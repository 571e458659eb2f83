"""Files of gears as they are made: paths of wire and laser, solids of moulds and prints, sets that are printed assembled."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.nearest import nearest

from gearcad import build
from gearcad.core.dxf import ezdxf
from gearcad.core.errors import GeometryError
from gearcad.designs.reader import read_spec
from gearcad.geometry import Body, Gear
from gearcad.geometry.making import Making
from gearcad.geometry.modification import FlankModification
from gearcad.solids.exact.solid import gear_solid
from gearcad.solids.files.cut_path import write_path_dxf
from gearcad.solids.files.products import FileOptions, GearProduct
from gearcad.solids.train_plan import Standing, TrainLayout
from gearcad.verification.as_made_files import judge_made

WIRE = Making(process="wire", kerf=0.25, spark_gap=0.02, path_tolerance=0.0002, lead_in=1.5)
OFFSET = 0.145
"""mm: half the wire and the gap."""

GEARS = {
    "spur": (Gear(teeth=24, normal_module=1.0, face_width=4.0, body=Body(bore=6.0), making=WIRE), ["PROFILE", "BORE"]),
    "chamfered": (
        Gear(teeth=18, normal_module=1.0, face_width=4.0, body=Body(bore=6.0, tip_chamfer=0.15), making=WIRE),
        ["PROFILE", "BORE"],
    ),
    "undercut": (Gear(teeth=9, normal_module=1.0, face_width=4.0, making=WIRE), ["PROFILE"]),
    "ring": (
        Gear(teeth=-40, normal_module=1.0, face_width=4.0, body=Body(rim_diameter=50.0), making=WIRE),
        ["PROFILE", "RIM"],
    ),
}


def _arcs(entity: Any) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """Start, end and bulge of every arc of a closed polyline."""
    points = np.array(entity.get_points("xyb"))
    return [(a[:2], b[:2], a[2]) for a, b in zip(points, np.roll(points, -1, axis=0), strict=True)]


def _ends(entity: Any) -> tuple[Any, Any]:
    return (entity.start_point, entity.end_point) if entity.dxftype() == "ARC" else (entity.dxf.start, entity.dxf.end)


def _headings(start: np.ndarray, end: np.ndarray, bulge: float) -> tuple[float, float]:
    chord = math.atan2(end[1] - start[1], end[0] - start[0])
    return chord - 2 * math.atan(bulge), chord + 2 * math.atan(bulge)


def _inside(start: np.ndarray, end: np.ndarray, bulge: float, shares: np.ndarray) -> np.ndarray:
    """Points on an arc, by its bulge: turning about its centre."""
    if abs(bulge) < 1e-12:
        return start + shares[:, None] * (end - start)
    chord = end - start
    centre = start + chord / 2 + (1 / bulge - bulge) / 4 * np.array([-chord[1], chord[0]])
    away = start - centre
    angle = 4 * math.atan(bulge) * shares
    cosine, sine = np.cos(angle), np.sin(angle)
    turned = np.stack([cosine * away[0] - sine * away[1], sine * away[0] + cosine * away[1]], -1)
    return centre + turned


@pytest.mark.parametrize("name", GEARS)
def test_a_path_is_closed_smooth_and_as_far_from_the_part_as_told(name: str, tmp_path: Path) -> None:
    gear, layers = GEARS[name]
    write_path_dxf(gear, tmp_path / "path.dxf")
    space = ezdxf().readfile(tmp_path / "path.dxf").modelspace()
    paths = {each.dxf.layer: each for each in space.query("LWPOLYLINE")}
    assert list(paths) == layers
    assert all(path.closed for path in paths.values())
    for path in paths.values():
        arcs = _arcs(path)
        turns = [_headings(*after)[0] - _headings(*before)[1] for before, after in zip(arcs, arcs[1:] + arcs[:1], strict=True)]
        assert max(abs(math.remainder(turn, 2 * math.pi)) for turn in turns) < 1e-9
        curves = list(path.virtual_entities())
        ends = [[np.array(place)[:2] for place in _ends(each)] for each in curves]
        assert (
            max(min(math.dist(p, q) for p in one for q in other) for one, other in itertools.pairwise([*ends, ends[0]])) < 1e-9
        )
    teeth = _arcs(paths["PROFILE"])
    near = [arc for arc in teeth if abs(math.atan2(*arc[0][::-1])) < math.pi / gear.tooth_count and arc[0][0] > 0]
    points = np.concatenate([_inside(*arc, np.linspace(0.1, 0.9, 3)) for arc in near])
    points[:, 1] = np.abs(points[:, 1])  # the other flank is the mirror image
    pitch = math.pi / gear.tooth_count
    points = points[np.arctan2(points[:, 1], points[:, 0]) < pitch]
    away = nearest(gear, 1.0, points)
    assert np.abs(away - OFFSET).max() < 0.0002 + 1e-9
    radius, tip = np.hypot(*points.T), abs(gear.tip_diameter) / 2
    reach = tip - radius.min() if gear.internal else radius.max() - tip
    assert reach == pytest.approx(OFFSET, abs=1e-6)
    circles = {"BORE": gear.body.bore / 2 - OFFSET, "RIM": (gear.body.rim_diameter or 0) / 2 + OFFSET}
    for layer in layers[1:]:
        on = np.concatenate([_inside(*arc, np.linspace(0, 1, 9)) for arc in _arcs(paths[layer])])
        np.testing.assert_allclose(np.hypot(*on.T), circles[layer], atol=1e-12)
    leads = space.query('LINE[layer=="LEAD"]')
    assert len(leads) == len(layers)
    for lead, path in zip(leads, paths.values(), strict=True):
        begins, ends_at = np.array(lead.dxf.start)[:2], np.array(lead.dxf.end)[:2]
        assert math.dist(ends_at, path.get_points("xy")[0]) < 1e-12
        material = 1 if path.dxf.layer in ("PROFILE", "RIM") else -1
        material *= -1 if gear.internal and path.dxf.layer == "PROFILE" else 1
        assert material * (math.hypot(*begins) - math.hypot(*ends_at)) == pytest.approx(1.5)


KEYED = Body(bore=8.0, keyway_width=2.0, keyway_depth=1.0)


def test_a_keyway_is_entered_and_its_edges_are_gone_round() -> None:
    """Every point of the path is the offset away from bore and keyway, but for the corners of the floor."""
    from gearcad.solids.files.cut_path import cut_paths

    gear = Gear(teeth=24, normal_module=1.0, face_width=4.0, body=KEYED, making=WIRE)
    contour = next(path.contour for path in cut_paths(gear) if path.layer == "BORE")
    x = math.sqrt(16 - 1)
    angle = np.linspace(math.atan2(1, x), 2 * math.pi - math.atan2(1, x), 200001)
    wall = np.linspace(x, 5.0, 20001)
    floor = np.linspace(-1, 1, 20001)
    outline = np.concatenate(
        [
            4 * np.stack([np.cos(angle), np.sin(angle)], -1),
            *(np.stack([wall, np.full_like(wall, y)], -1) for y in (-1.0, 1.0)),
            np.stack([np.full_like(floor, 5.0), floor], -1),
        ]
    )
    for start, end, bulge in zip(contour[:, :2], np.roll(contour[:, :2], -1, axis=0), contour[:, 2], strict=True):
        for point in _inside(start, end, bulge, np.linspace(0.05, 0.95, 7)):
            assert np.hypot(*(outline - point).T).min() == pytest.approx(OFFSET, abs=1e-6)


RELIEVED = FlankModification(tip_relief=5.0, tip_relief_length=0.3)
SHRUNK = Making(process="mould", shrinkage_radial=2.0, shrinkage_axial=1.0)


@pytest.mark.parametrize("teeth", [21, -40])
def test_volumes_of_a_mould_and_its_part_are_as_the_shrinkage_says(teeth: int) -> None:
    body = Body(rim_diameter=50.0) if teeth < 0 else Body(bore=6.0, hub_diameter=10.0, hub_length=2.0, end_chamfer=0.2)
    gear = Gear(teeth=teeth, normal_module=1.0, face_width=5.0, helix_angle=12.0, body=body, making=SHRUNK)
    part, mould = (gear_solid(each) for each in (gear, gear.as_made))
    assert mould.isValid()
    assert mould.Volume() * 0.98**2 * 0.99 == pytest.approx(part.Volume(), rel=1e-9)


@pytest.mark.parametrize("teeth", [13, pytest.param(-40, marks=pytest.mark.long)])
def test_the_first_layer_of_a_print_is_set_back(teeth: int) -> None:
    """Below the step the section is that of a print whose outline is smaller by as much; facets agree with the solid."""
    making = {"process": "print", "offset": -0.05}
    body = Body(rim_diameter=50.0) if teeth < 0 else Body(bore=6.0)
    gear = {"teeth": teeth, "normal_module": 1.0, "body": body}
    stepped = Gear(**gear, face_width=5.0, making=Making(**making, first_layer=0.2)).as_made
    above = Gear(**gear, face_width=4.8, making=Making(**making)).as_made
    below = Gear(**gear, face_width=0.2, making=Making(process="print", offset=-0.25)).as_made
    solid = gear_solid(stepped)
    assert solid.isValid()
    assert solid.Volume() == pytest.approx(gear_solid(above).Volume() + gear_solid(below).Volume(), rel=1e-9)
    facets = GearProduct(gear=stepped, name="stepped", options=FileOptions(chord_error=0.005)).facets
    assert facets.to_trimesh().is_watertight
    assert facets.volume == pytest.approx(solid.Volume(), rel=2e-3)


SET = """
[planetary]
planets = 3
input = "sun"
output = "carrier"
fixed = "ring"
normal_module = 1.0
face_width = 5.0
making.process = "print"
making.offset = -0.08
[sun]
teeth = 24
[planet]
teeth = 21
[ring]
teeth = -66
tip_alteration = "clear"
body.rim_diameter = 75.0
"""


def _outline(standing: Standing) -> np.ndarray:
    contour = standing.body.gear.profile.contour(2e-4)
    shares = np.linspace(0, 1, 4, endpoint=False)[:, None, None]
    points = (contour * (1 - shares) + np.roll(contour, -1, axis=0) * shares).reshape(-1, 2)
    angle = math.radians(standing.rotation)
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    return np.asarray(points @ turn + np.array(standing.offset[:2]))


def test_a_set_that_is_printed_assembled_has_the_gap_all_round(tmp_path: Path) -> None:
    """The nominal flanks touch without backlash, so the least gap is twice the offset: of all points of the outlines, posed."""
    from scipy.spatial import cKDTree

    (tmp_path / "set.toml").write_text(SET, encoding="utf-8")
    design = read_spec(tmp_path / "set.toml")
    layout = TrainLayout(design.train, design.train.pose(7.0, 3.0), as_made=True)  # type: ignore[attr-defined]
    placed = [(standing, _outline(standing)) for standing in layout.standing]
    gaps = {}
    for (one, points), (other, others) in itertools.combinations(placed, 2):
        gaps[one.name, other.name] = float(cKDTree(others).query(points)[0].min())
    meshing = [gap for names, gap in gaps.items() if sum(name.startswith("planet") for name in names) == 1]
    assert len(meshing) == 6
    assert all(gap == pytest.approx(0.16, abs=5e-4) for gap in meshing)
    assert min(gaps.values()) > 0.1595
    files = {file.name for file in build(design, tmp_path / "files", ["3mf", "dxf"], as_made=True)}
    assert {"sun-as-made.3mf", "assembly.3mf", "assembly-as-made.3mf", "assembly-as-made.dxf"} <= files


def test_verify_notices_files_that_are_not_as_made(tmp_path: Path) -> None:
    """A path and a print are as they should be; the path of another tolerance, and the nominal solid in its place, are not."""
    path, wire = tmp_path / "path.dxf", GEARS["spur"][0]
    write_path_dxf(wire, path)
    assert all(claim.passed for claim in judge_made(path, wire))
    write_path_dxf(replace(wire, making=replace(WIRE, kerf=0.26)), path)
    assert [claim.quantity for claim in judge_made(path, wire) if not claim.passed] == ["area inside"]
    gear = Gear(teeth=13, normal_module=1.0, face_width=5.0, body=Body(bore=6.0, keyway_width=2.0, keyway_depth=1.0))
    printed = replace(gear, making=Making(process="print", offset=-0.05, first_layer=0.2))
    build(printed, tmp_path, ["step"], as_made=True)
    assert all(claim.passed for claim in judge_made(tmp_path / "gear-as-made.step", printed))
    assert [claim.quantity for claim in judge_made(tmp_path / "gear.step", printed) if not claim.passed] == ["volume"]


@pytest.mark.parametrize(
    ("changes", "formats", "message"),
    [
        ({"making": Making()}, ["step"], "as_made = True: needs a gear with a table making"),
        ({"making": WIRE}, ["step"], "as_made = True: needs the format dxf, for the path of gear"),
        ({"making": SHRUNK}, ["csv"], "as_made = True: needs the format one other than csv of gear"),
        ({"making": SHRUNK, "modification": RELIEVED}, ["step"], "as_made = True: needs flanks without mod"),
    ],
)
def test_what_has_no_files_as_made_is_told(changes: dict[str, Any], formats: list[str], message: str, tmp_path: Path) -> None:
    gear = Gear(**{"teeth": 24, "normal_module": 1.0, "face_width": 4.0, **changes})
    with pytest.raises(GeometryError, match=f"^{message}"):
        build(gear, tmp_path, formats, as_made=True)
