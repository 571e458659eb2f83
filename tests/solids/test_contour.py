"""DXF contours and CSV points: on the exact profile and dense, read back by others."""

import csv
import math
from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.document import Drawing
from support.clearance import distance_to_section, section_area
from support.samples import SAMPLES

from gearcad import Body, Gear, ParameterError
from gearcad.geometry.curves import CurveKind
from gearcad.solids.files.dxf import gear_contour, write_dxf
from gearcad.solids.files.points import gear_points, write_points

ACCURACY = 0.0005  # mm, the default
EXACT = 1e-9  # mm: joints and lands are exact but for rounding
TANGENT = 1e-6  # rad: an arc's end tangents follow from its bulge with the rounding of short chords


def _drawn(gear: Gear, path: Path) -> Drawing:
    write_dxf(gear, path)
    document = ezdxf.readfile(path)
    assert not document.audit().has_issues
    return document


def _polyline(document: Drawing, layer: str) -> np.ndarray:
    (line,) = document.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
    assert line.closed
    return np.array(line.get_points("xyb"))


def _along_arcs(contour: np.ndarray, count: int = 9) -> np.ndarray:
    """Points (n, count, 2) on every arc, by its centre and radius: an independent reading of the bulge."""
    start, bulge = contour[:, :2], contour[:, 2]
    chord = np.roll(start, -1, axis=0) - start
    share = np.linspace(0, 1, count)
    angle = 4 * np.arctan(bulge)
    straight = np.abs(angle) < 1e-12
    half = np.where(straight, 1.0, angle / 2)
    radius = np.hypot(*chord.T) / (2 * np.sin(half))
    heading = np.arctan2(chord[:, 1], chord[:, 0]) - half
    centre = start + radius[:, None] * np.stack([-np.sin(heading), np.cos(heading)], -1)
    turned = heading[:, None] + share * 2 * half[:, None]
    arcs = centre[:, None] + radius[:, None, None] * np.stack([np.sin(turned), -np.cos(turned)], -1)
    return np.where(straight[:, None, None], start[:, None] + share[:, None] * chord[:, None], arcs)


def _area(contour: np.ndarray) -> float:
    """Area inside: the polygon and the segments between chords and arcs."""
    x, y, bulge = contour.T
    following = np.roll(contour, -1, axis=0)
    chord = np.hypot(following[:, 0] - x, following[:, 1] - y)
    curved = np.abs(bulge) > 1e-9
    b = np.where(curved, bulge, 1.0)
    angle, radius = 4 * np.arctan(b), chord * (1 + b**2) / (4 * b)
    segments = np.where(curved, radius**2 * (angle - np.sin(angle)) / 2, chord**2 * bulge / 3)
    return float(np.sum(x * following[:, 1] - y * following[:, 0]) / 2 + np.sum(np.sign(b) * np.abs(segments)))


@pytest.mark.parametrize("name", SAMPLES)
def test_contour_is_one_closed_chain_on_the_exact_profile(name: str, tmp_path: Path) -> None:
    gear = SAMPLES[name]
    contour = _polyline(_drawn(gear, tmp_path / "gear.dxf"), "PROFILE")
    assert len(contour) % gear.teeth == 0
    points = _along_arcs(contour)[: len(contour) // gear.teeth]
    flat = np.column_stack([points.reshape(-1, 2), np.zeros(points.size // 2)])
    # A section at z = 0 has not turned yet, so the helix plays no part.
    assert distance_to_section(gear, flat).max() <= ACCURACY
    assert np.hypot(*(points[:-1, -1] - points[1:, 0]).T).max() < EXACT
    chords = np.hypot(*(np.roll(contour, -1, axis=0) - contour)[:, :2].T)
    assert chords.min() > 2e-6  # mm: nothing that a machine would take for a point
    perimeter = np.hypot(*np.diff(points, axis=1).reshape(-1, 2).T).sum() * gear.teeth
    assert _area(contour) == pytest.approx(section_area(gear), abs=ACCURACY * perimeter)


def _corner_count(gear: Gear) -> int:
    """Corners of a tooth: at both ends of the tip land or of the chamfers; at the form circle if undercut."""
    chamfers = 4 if gear.body.tip_chamfer else 2
    return chamfers + (2 if gear.undercut else 0)


@pytest.mark.parametrize("name", ["spur", "helical", "chamfered", "undercut", "deeply undercut", "full radius", "many teeth"])
def test_contour_is_smooth_but_for_the_true_corners(name: str) -> None:
    gear = SAMPLES[name]
    contour = gear_contour(gear)
    chord = (np.roll(contour, -1, axis=0) - contour)[:, :2]
    direction, half = np.arctan2(chord[:, 1], chord[:, 0]), 2 * np.arctan(contour[:, 2])
    arrives, leaves = direction + half, np.roll(direction - half, -1)
    kink = np.abs(np.mod(leaves - arrives + np.pi, 2 * np.pi) - np.pi)
    assert np.count_nonzero(kink > TANGENT) == gear.teeth * _corner_count(gear)


def test_lands_are_single_exact_arcs_and_chamfers_straight() -> None:
    gear = SAMPLES["chamfered"]
    contour = gear_contour(gear)
    radius = np.hypot(contour[:, 0], contour[:, 1])
    for circle, land in ((gear.tip_diameter / 2, gear.profile.curves[-1]), (gear.root_diameter / 2, gear.profile.curves[0])):
        on_circle = np.abs(radius - circle) < EXACT
        assert on_circle.sum() == 2 * gear.teeth
        arcs = contour[on_circle & np.roll(on_circle, -1), 2]
        angles = 2 * np.abs(np.diff(land.polar(np.array([0.0, 1.0]))[1]))
        assert 4 * np.arctan(arcs) == pytest.approx(np.full(gear.teeth, angles[0]), abs=1e-12)
    assert np.count_nonzero(contour[:, 2] == 0) == 2 * gear.teeth


def test_full_radius_root_shares_the_point_between_two_teeth() -> None:
    gear = SAMPLES["full radius"]
    assert gear.profile.curves[0].kind is CurveKind.FILLET
    contour = gear_contour(gear)
    on_root = np.abs(np.hypot(contour[:, 0], contour[:, 1]) - gear.root_diameter / 2) < EXACT
    angle = np.degrees(np.arctan2(contour[on_root, 1], contour[on_root, 0]))
    assert np.sort(np.mod(angle, 360)) == pytest.approx(7.5 + 15.0 * np.arange(24), abs=1e-9)


def test_arcs_converge_with_the_cube_of_their_number() -> None:
    """A pair of arcs is off by some h^3: a thousandth of the error takes ten times the arcs."""
    gear = SAMPLES["spur"]
    coarse, fine = (len(gear_contour(gear, accuracy)) / gear.teeth for accuracy in (1e-4, 1e-7))
    assert fine / coarse == pytest.approx(10, rel=0.15)


def test_accuracy_is_kept_and_not_wasted() -> None:
    gear = SAMPLES["spur"]
    for accuracy in (5e-3, 5e-4, 5e-6):
        points = _along_arcs(gear_contour(gear, accuracy), 17).reshape(-1, 2)
        worst = distance_to_section(gear, np.column_stack([points, np.zeros(len(points))])).max()
        assert 0.2 * accuracy < worst <= accuracy


def test_bore_circles_and_units(tmp_path: Path) -> None:
    gear = Gear(teeth=20, normal_module=2, face_width=10, helix_angle=15, body=Body(bore=14))
    document = _drawn(gear, tmp_path / "gear.dxf")
    assert (document.header["$INSUNITS"], document.header["$MEASUREMENT"]) == (4, 1)
    (bore,) = document.modelspace().query('CIRCLE[layer=="BORE"]')
    assert bore.dxf.radius == 7.0
    assert {entity.dxf.layer for entity in document.modelspace()} == {"PROFILE", "BORE"}  # all of it is to be cut
    write_dxf(gear, tmp_path / "circles.dxf", circles=True)
    document = ezdxf.readfile(tmp_path / "circles.dxf")
    circles = sorted(2 * circle.dxf.radius for circle in document.modelspace().query('CIRCLE[layer=="CIRCLES"]'))
    expected = [gear.root_diameter, gear.base_diameter, gear.reference_diameter, gear.tip_diameter]
    assert circles == pytest.approx(sorted(expected), rel=1e-15)
    assert _header_box(document) == pytest.approx([-gear.tip_diameter / 2] * 2 + [gear.tip_diameter / 2] * 2, rel=1e-15)


@pytest.mark.parametrize("teeth", [5, 8, 13, 22, 41])
def test_header_states_how_far_the_contour_reaches(teeth: int, tmp_path: Path) -> None:
    """Programs zoom to it and nest by it; without it they show nothing at first."""
    gear = Gear(teeth=teeth, normal_module=2, face_width=10, profile_shift=max(0.0, 0.45 - 0.03 * teeth))
    document = _drawn(gear, tmp_path / "gear.dxf")
    points = _along_arcs(_polyline(document, "PROFILE"), 401).reshape(-1, 2)
    box = _header_box(document)
    assert box == pytest.approx([*points.min(axis=0), *points.max(axis=0)], abs=1e-5)  # the samples' distance from the extremes
    assert box[2] == pytest.approx(gear.tip_diameter / 2, rel=1e-14)  # tooth 0 is on +x


def _header_box(document: Drawing) -> list[float]:
    return [*document.header["$EXTMIN"][:2], *document.header["$EXTMAX"][:2]]


def test_keyway_is_part_of_the_bore(tmp_path: Path) -> None:
    gear = Gear(teeth=20, normal_module=2, face_width=10, body=Body(bore=14, keyway_width=5, keyway_depth=2.3))
    bore = _polyline(_drawn(gear, tmp_path / "gear.dxf"), "BORE")
    half_angle = math.asin(2.5 / 7)
    kept = 49 * (math.pi - half_angle) + 2.5 * 7 * math.cos(half_angle)  # the circle without its segment beyond the walls
    assert _area(bore) == pytest.approx(kept + 5 * (9.3 - 7 * math.cos(half_angle)), rel=1e-14)
    assert bore[:, 0].max() == 9.3


def test_equal_gears_give_equal_bytes_and_leave_ezdxf_as_it_was(tmp_path: Path) -> None:
    write_dxf(SAMPLES["spur"], tmp_path / "one.dxf")
    write_dxf(SAMPLES["spur"], tmp_path / "two.dxf")
    assert (tmp_path / "one.dxf").read_bytes() == (tmp_path / "two.dxf").read_bytes()
    assert not ezdxf.options.write_fixed_meta_data_for_testing


@pytest.mark.parametrize("wrong", [0, -1, 1e-9, math.nan])
def test_impossible_accuracies_are_refused(wrong: float) -> None:
    with pytest.raises(ParameterError, match="accuracy"):
        gear_contour(SAMPLES["spur"], wrong)


CHORD_ERROR = 0.0005  # mm, the default
PRINTED = 2e-9  # mm: half a step of the twelfth digit of the largest number here, with some room
TOOTH = ("root land", "trochoid", "involute", "tip chamfer", "tip land")
HEADER = ["curve", "index", "parameter_deg", "radius_mm", "half_angle_deg", "x_mm", "y_mm"]

Table = dict[str, np.ndarray]


def _table(gear: Gear, path: Path, **options: float) -> Table:
    """Rows of every curve: parameter, radius, half angle, x, y."""
    write_points(gear, path, **options)
    with path.open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    assert header == HEADER
    table: dict[str, list[list[float]]] = {}
    for curve, index, *numbers in rows:
        assert int(index) == len(table.setdefault(curve, []))
        table[curve].append([float(number) for number in numbers])
    return {curve: np.array(numbers) for curve, numbers in table.items()}


@pytest.mark.parametrize("name", SAMPLES)
def test_points_lie_on_the_profile_and_are_dense(name: str, tmp_path: Path) -> None:
    gear = SAMPLES[name]
    table = _table(gear, tmp_path / "points.csv")
    blocks = [table[curve] for curve in TOOTH if curve in table]
    assert {"trochoid", "involute", "tip land"} <= table.keys()
    for one, following in pairwise(blocks):
        assert one[-1, 3:] == pytest.approx(following[0, 3:], abs=4e-6)  # an absent root land may be that wide
    for curve in ("trochoid", "involute", "tip chamfer"):
        if curve in table:
            _, radius, angle, x, y = table[curve][1:].T  # at the root circle the angle is no smooth function of the radius
            assert radius * np.radians(angle - gear.profile.half_angle(radius)) == pytest.approx(0, abs=1e-6)
            assert np.hypot(x, y) == pytest.approx(radius, abs=PRINTED)
            assert np.degrees(np.arctan2(y, x)) == pytest.approx(angle, abs=1e-7)
    points = np.concatenate(blocks)[:, 3:]
    between = np.concatenate([points[:-1] + share * np.diff(points, axis=0) for share in (0, 0.25, 0.5, 0.75)])
    distance = distance_to_section(gear, np.column_stack([between, np.zeros(len(between))]))
    assert 0.5 * CHORD_ERROR < distance.max() <= CHORD_ERROR


def test_curves_begin_and_end_where_the_gear_says(tmp_path: Path) -> None:
    gear = SAMPLES["chamfered"]
    table = _table(gear, tmp_path / "points.csv")
    ends = {curve: tuple(2 * table[curve][[0, -1], 1]) for curve in TOOTH}
    assert ends["root land"] == pytest.approx((gear.root_diameter, gear.root_diameter))
    assert ends["trochoid"] == pytest.approx((gear.root_diameter, gear.form_diameter))
    assert ends["involute"] == pytest.approx((gear.form_diameter, gear.tip_form_diameter))
    assert ends["tip chamfer"] == pytest.approx((gear.tip_form_diameter, gear.tip_diameter))
    assert table["root land"][0, 2] == pytest.approx(180 / gear.teeth)
    assert table["tip land"][-1, 2] == 0
    # The parameter of the involute is its roll angle: tan of the pressure angle there.
    roll = np.degrees(np.sqrt((2 * table["involute"][:, 1] / gear.base_diameter) ** 2 - 1))
    assert table["involute"][:, 0] == pytest.approx(roll, abs=1e-8)


# ---------------------------------------------------------------------- the tool


def _rolled(gear: Gear, outline: np.ndarray, roll: float) -> np.ndarray:
    """The tool's outline (n, 2), given where it stands at zero roll, after the gear has turned by `roll` (rad).

    By rigid motions alone: shift along the rolling line, whose normal is the middle of the space, then turn about the axis.
    """
    middle = math.pi / gear.teeth
    shifted = outline + gear.reference_diameter / 2 * roll * np.array([math.sin(middle), -math.cos(middle)])
    cosine, sine = math.cos(roll), math.sin(roll)
    return shifted @ np.array([[cosine, sine], [-sine, cosine]])


def _gap(point: np.ndarray, outline: np.ndarray) -> float:
    """Distance of a point from a polyline."""
    start, chord = outline[:-1], np.diff(outline, axis=0)
    assert np.all(np.hypot(*chord.T) > 0)
    share = np.clip(np.sum((point - start) * chord, 1) / np.sum(chord**2, 1), 0, 1)
    return float(np.hypot(*(start + share[:, None] * chord - point).T).min())


@pytest.mark.parametrize(
    "name", ["spur", "helical", "left hand", "undercut", "few teeth", "full radius", "sharp tool", "many teeth"]
)
def test_rolling_tool_touches_the_fillet_and_never_cuts_into_the_tooth(name: str, tmp_path: Path) -> None:
    gear, fine = SAMPLES[name], 1e-6
    table = _table(gear, tmp_path / "points.csv", chord_error=fine)
    outline, fillet = table["tool outline"][:, 3:], table["trochoid"]
    root, tip = gear.root_diameter / 2, gear.tip_diameter / 2
    for theta, *_, x, y in fillet[:: math.ceil(len(fillet) / 40)]:
        roll = float(gear.profile.tool.roll(math.radians(theta)))
        tool = _rolled(gear, outline, roll)
        assert _gap(np.array([x, y]), tool) < 2 * fine
    for roll in np.linspace(-0.6, 0.6, 41) * 20 / gear.teeth:
        tool = _rolled(gear, outline, roll)
        radius, angle = np.hypot(*tool.T), np.abs(np.degrees(np.arctan2(tool[:, 1], tool[:, 0])))
        assert radius.min() > root - PRINTED
        among = (radius >= root) & (radius <= tip)
        inside = np.radians(gear.profile.half_angle(radius[among]) - angle[among]) * radius[among]
        assert inside.max(initial=-1) < 1e-6


def test_tool_stands_in_the_space_at_zero_roll(tmp_path: Path) -> None:
    gear = SAMPLES["helical"]
    outline = _table(gear, tmp_path / "points.csv")["tool outline"][:, 3:]
    middle = math.pi / gear.teeth
    along = outline @ [math.cos(middle), math.sin(middle)]
    across = outline @ [math.sin(middle), -math.cos(middle)]
    assert across == pytest.approx(-across[::-1], abs=PRINTED)
    assert (along.min(), along.max()) == pytest.approx((gear.root_diameter / 2, gear.tip_diameter / 2))
    # On the rolling line the tool's tooth is as wide as the space: half the pitch, less 2 x tan, plus the thinning.
    width = np.interp(gear.reference_diameter / 2, along[len(along) // 2 :], 2 * across[len(along) // 2 :])
    assert width == pytest.approx(gear.transverse_pitch - gear.transverse_tooth_thickness, abs=PRINTED)


@pytest.mark.parametrize("name", ["spur", "helical", "undercut"])
def test_path_of_the_tip_runs_beside_the_fillet(name: str, tmp_path: Path) -> None:
    """The fillet of a spur gear is the curve at the distance of the tip radius from the path of its centre."""
    gear = SAMPLES[name]
    table = _table(gear, tmp_path / "points.csv", chord_error=1e-6)
    path, fillet = table["tool path"], table["trochoid"]
    first, last = (math.degrees(gear.profile.tool.roll(math.radians(fillet[i, 0]))) for i in (0, -1))
    assert path[[0, -1], 0] == pytest.approx([first, last], abs=1e-9)
    if gear.helix_angle == 0:
        radius = gear.root_radius * gear.normal_module
        gaps = [_gap(point, path[:, 3:]) for point in fillet[:, 3:]]
        assert gaps == pytest.approx([radius] * len(gaps), abs=2e-6)
    corner = table["tool corner path"]
    assert corner[0, 3:] == pytest.approx(fillet[0, 3:], abs=PRINTED)


def test_equal_gears_give_equal_bytes(tmp_path: Path) -> None:
    write_points(SAMPLES["helical"], tmp_path / "one.csv")
    write_points(SAMPLES["helical"], tmp_path / "two.csv")
    assert (tmp_path / "one.csv").read_bytes() == (tmp_path / "two.csv").read_bytes()


@pytest.mark.parametrize("wrong", [0, -1, math.inf])
def test_impossible_chord_errors_are_refused(wrong: float) -> None:
    with pytest.raises(ParameterError, match="chord_error"):
        gear_points(SAMPLES["spur"], wrong)
