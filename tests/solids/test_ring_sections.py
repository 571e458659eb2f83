"""DXF contours and CSV points of rings and of shaped gears: on the exact profile, and the cutter as it rolls (identity)."""

import math
from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.document import Drawing
from scipy.integrate import quad
from support.clearance import distance_to_section
from support.samples import RINGS, SHAPED

from gearcad import Gear
from gearcad.solids.files.dxf import gear_contour, write_dxf
from gearcad.solids.files.points import gear_points

ACCURACY = 0.0005  # mm, of both files
EXACT = 1e-9  # mm
FINE = 1e-6  # mm: chord error where tools are looked at
UNMODIFIED = [name for name, gear in RINGS.items() if not gear.modification.present]


def _along_arcs(contour: np.ndarray, count: int = 17) -> np.ndarray:
    """Points (n, count, 2) on every arc, by the rational form of a circle."""
    start, bulge = contour[:, None, :2], contour[:, None, 2:]
    half = (np.roll(contour[:, :2], -1, axis=0)[:, None] - start) / 2
    t = np.linspace(-1, 1, count)[None, :, None]
    normal = np.stack([half[..., 1], -half[..., 0]], -1)
    # With b t = tan of a quarter of the way about the middle of the arc.
    along = t * (1 + bulge**2) / (1 + bulge**2 * t**2)
    across = bulge * (1 - t**2) / (1 + bulge**2 * t**2)
    return start + half + half * along + normal * across


def _on_section(gear: Gear, points: np.ndarray) -> np.ndarray:
    flat = points.reshape(-1, 2)
    return distance_to_section(gear, np.column_stack([flat, np.zeros(len(flat))]))


def _opening_area(gear: Gear) -> float:
    """Inside the root circle, less the teeth: quadrature of the half angle over R = r_f - t^2, piece by piece."""
    profile = gear.profile
    root, tip = profile.root_diameter / 2, profile.tip_diameter / 2
    ends = [0.0, *(math.sqrt(root - r / 2) for r in (profile.form_diameter, profile.tip_form_diameter)), math.sqrt(root - tip)]

    def width(t: float) -> float:
        radius = max(root - t * t, tip)
        return float(2 * math.radians(profile.half_angle(radius)) * radius * 2 * t)

    teeth = sum(quad(width, low, high, epsabs=1e-12, limit=200)[0] for low, high in pairwise(ends))
    return math.pi * root**2 - gear.tooth_count * teeth


@pytest.mark.parametrize("name", UNMODIFIED)
def test_contour_of_a_ring_is_one_closed_chain_on_the_exact_profile(name: str) -> None:
    gear = RINGS[name]
    contour = gear_contour(gear)
    arcs = _along_arcs(contour)
    tooth = len(contour) // gear.tooth_count
    assert len(contour) % gear.tooth_count == 0
    assert _on_section(gear, arcs[:tooth]).max() <= ACCURACY
    polyline = arcs[:, :-1].reshape(-1, 2)
    x, y = polyline.T
    area = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2  # counter-clockwise: positive
    bend = np.hypot(*np.diff(arcs, 2, axis=1).reshape(-1, 2).T).max() / 8
    perimeter = np.hypot(*(np.roll(polyline, -1, axis=0) - polyline).T).sum()
    assert area == pytest.approx(_opening_area(gear), abs=(ACCURACY + bend) * perimeter)
    assert np.hypot(x, y).min() == pytest.approx(gear.profile.tip_diameter / 2, abs=EXACT)


def _drawn(gear: Gear, path: Path, **options: bool) -> Drawing:
    write_dxf(gear, path, **options)
    document = ezdxf.readfile(path)
    assert not document.audit().has_issues
    return document


def test_drawing_of_a_ring_has_its_rim_and_its_holes(tmp_path: Path) -> None:
    gear = RINGS["form root"]
    document = _drawn(gear, tmp_path / "ring.dxf")
    space = document.modelspace()
    assert {entity.dxf.layer for entity in space} == {"PROFILE", "RIM", "BOLTS"}
    assert "BORE" not in document.layers
    (rim,) = space.query('CIRCLE[layer=="RIM"]')
    assert rim.dxf.radius == 75.0
    holes = [(hole.dxf.center.x, hole.dxf.center.y, hole.dxf.radius) for hole in space.query('CIRCLE[layer=="BOLTS"]')]
    angles = np.radians(60 * np.arange(6))
    assert np.array(holes) == pytest.approx(np.stack([69 * np.cos(angles), 69 * np.sin(angles), np.full(6, 3.0)], -1))
    assert [*document.header["$EXTMIN"][:2], *document.header["$EXTMAX"][:2]] == [-75, -75, 75, 75]
    document = _drawn(gear, tmp_path / "circles.dxf", circles=True)
    circles = sorted(2 * circle.dxf.radius for circle in document.modelspace().query('CIRCLE[layer=="CIRCLES"]'))
    diameters = (gear.tip_diameter, gear.base_diameter, gear.reference_diameter, gear.root_diameter)
    assert circles == pytest.approx(sorted(-d for d in diameters), rel=1e-15)


def test_a_ring_without_a_rim_is_drawn_all_the_same(tmp_path: Path) -> None:
    gear = Gear(teeth=-37, normal_module=2, face_width=10)
    document = _drawn(gear, tmp_path / "ring.dxf")
    assert {entity.dxf.layer for entity in document.modelspace()} == {"PROFILE"}
    box = [*document.header["$EXTMIN"][:2], *document.header["$EXTMAX"][:2]]
    points = _along_arcs(gear_contour(gear), 101).reshape(-1, 2)
    assert box == pytest.approx([*points.min(axis=0), *points.max(axis=0)], abs=1e-4)


@pytest.mark.parametrize("name", UNMODIFIED)
def test_points_of_a_ring_lie_on_its_profile_and_are_dense(name: str) -> None:
    gear = RINGS[name]
    chain = np.concatenate([block.points for block in gear_points(gear) if not block.curve.startswith("tool")])
    radius = np.hypot(*chain.T)
    assert radius[[0, -1]] * 2 == pytest.approx([gear.profile.root_diameter, gear.profile.tip_diameter])
    between = np.concatenate([chain[:-1] + share * np.diff(chain, axis=0) for share in (0, 0.25, 0.5, 0.75)])
    assert 0.4 * ACCURACY < _on_section(gear, between).max() <= ACCURACY


# ---------------------------------------------------------------------- the cutter


def _rolled(gear: Gear, outline: np.ndarray, roll: float) -> np.ndarray:
    """The cutter's outline (n, 2), given where it stands at zero roll, seen from the gear after that has turned by `roll`.

    By rigid motions alone: about the cutter's axis, then about the gear's.
    """
    tool, teeth = gear.profile.tool, gear.teeth
    ratio = abs(teeth) / gear.cutter.teeth * (1 if gear.internal else -1)
    axis = tool.centre_distance * np.exp(1j * math.pi / gear.tooth_count)
    # In space the middle of the space turns the way a wheel does that is drawn left-handed: the gear clockwise.
    turned = axis + ((outline @ [1, 1j]) - axis) * np.exp(-1j * roll * ratio)
    back = turned * np.exp(1j * roll)
    return np.stack([back.real, back.imag], -1)


def _gap(point: np.ndarray, outline: np.ndarray) -> float:
    """Distance of a point from a polyline."""
    start, chord = outline[:-1], np.diff(outline, axis=0)
    share = np.clip(np.sum((point - start) * chord, 1) / np.sum(chord**2, 1), 0, 1)
    return float(np.hypot(*(start + share[:, None] * chord - point).T).min())


CUT = {f"ring, {name}": gear for name, gear in RINGS.items() if gear.cutter.teeth} | SHAPED


@pytest.mark.parametrize("name", CUT)
def test_rolling_cutter_touches_the_fillet_and_never_cuts_into_the_tooth(name: str) -> None:
    gear = CUT[name]
    blocks = {block.curve: block for block in gear_points(gear, FINE)}
    outline, profile, tool = blocks["tool outline"].points, gear.profile, gear.profile.tool
    assert np.hypot(*np.diff(outline, axis=0).T).min() > 0
    fillet = next(curve for curve in profile.curves if curve.kind.value == "trochoid")
    rolls, touched = [], []
    for s in np.linspace(0, 1, 21):
        theta = fillet.theta(s)
        roll = float(tool.turn(theta)) * tool.share
        rolls.append(roll)
        touched.append(_gap(fillet.points(s), _rolled(gear, outline, roll)))
    assert max(touched) < 2 * FINE
    path, corner = blocks["tool path"], blocks["tool corner path"]
    assert path.parameter[[0, -1]] == pytest.approx(np.degrees([rolls[0], rolls[-1]]), abs=1e-9)
    assert corner.points[0] == pytest.approx(fillet.points(0.0), abs=EXACT)
    edges = sorted((profile.tip_diameter / 2, profile.root_diameter / 2))
    for roll in np.linspace(-0.6, 0.6, 41) * 20 / gear.tooth_count:
        moved = _rolled(gear, outline, roll)
        radius, angle = np.hypot(*moved.T), np.abs(np.arctan2(moved[:, 1], moved[:, 0]))
        assert (edges[1] - radius.max() if gear.internal else radius.min() - edges[0]) > -EXACT
        # At the root circle itself the angle is no smooth function of the radius.
        among = (radius >= edges[0] + FINE) & (radius <= edges[1] - FINE)
        inside = (np.radians(profile.half_angle(radius[among])) - angle[among]) * radius[among]
        assert inside.max(initial=-1) < 2 * FINE


def test_path_of_the_corner_runs_beside_the_fillet() -> None:
    """The fillet of a spur gear is the curve at the distance of the tip radius from the path of the corner's middle."""
    for gear in (RINGS["shaped"], SHAPED["spur"], SHAPED["undercut"]):
        blocks = {block.curve: block.points for block in gear_points(gear, FINE)}
        gaps = [_gap(point, blocks["tool path"]) for point in blocks["trochoid"]]
        assert gaps == pytest.approx([gear.cutter.tip_radius * gear.normal_module] * len(gaps), abs=3 * FINE)


def test_a_form_root_has_no_tool() -> None:
    assert {block.curve for block in gear_points(RINGS["form root"])} == {"root land", "trochoid", "involute", "tip land"}


def test_outline_of_a_cutter_ends_on_the_gears_tip_circle_or_its_own_base_circle() -> None:
    for gear in (RINGS["shaped"], RINGS["thinned"], SHAPED["helical"]):
        blocks = {block.curve: block.points for block in gear_points(gear)}
        end, tool = blocks["tool outline"][-1], gear.profile.tool
        middle = math.pi / gear.tooth_count
        from_axis = np.hypot(*(end - tool.centre_distance * np.array([math.cos(middle), math.sin(middle)])))
        to_tip = abs(gear.profile.tip_diameter / 2 - tool.centre_distance)
        assert from_axis == pytest.approx(max(to_tip, tool.base_radius), rel=1e-12)
