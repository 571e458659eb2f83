"""CSV of points: on the exact profile and dense; the tool rolls along them without cutting into the tooth (identity)."""

from __future__ import annotations

import csv
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from support.exact import distance_to_section
from support.samples import SAMPLES

from gearcad import Gear, ParameterError
from gearcad.solids.files.points import gear_points, write_points

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
