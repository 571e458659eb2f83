"""Racks and rack-pinion pairs by closed forms, by the limit of a wheel of very many teeth, and by what they refuse."""

import math
import re
from dataclasses import replace
from itertools import pairwise
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.path import Path as Outline

from gearcad import BasicRack, Gear, Rack, RackPair
from gearcad.core.errors import GeometryError, InputError, ParameterError
from gearcad.core.records import PerGear
from gearcad.geometry import BaseTangent
from gearcad.geometry.path_of_contact import ContactZone
from gearcad.geometry.rack_pair import cut_by_pinion, cut_by_rack

EXACT = 1e-12

RACK: dict[str, Any] = {"teeth": 10, "normal_module": 2.0, "face_width": 20.0, "height": 18.0}
PINION: dict[str, Any] = {"teeth": 20, "normal_module": 2.0, "face_width": 25.0}


def pair(pinion: dict[str, Any] | None = None, rack: dict[str, Any] | None = None, **inputs: Any) -> RackPair:
    return RackPair(pinion=Gear(**PINION | (pinion or {})), rack=Rack(**RACK | (rack or {})), **inputs)


HELICAL = pair(
    {"helix_angle": 20.0, "profile_shift": 0.2, "tooth_thinning": 0.05},
    {"helix_angle": -20.0, "tooth_thinning": 0.03, "tip_chamfer": 0.15},
    mounting_distance=21.75,
)


# ---------------------------------------------------------------------- the rack


def test_teeth_and_length_follow_from_each_other() -> None:
    rack = Rack(**RACK | {"helix_angle": 15.0})
    pitch = math.pi * 2 / math.cos(math.radians(15))
    assert rack.length == pytest.approx(10 * pitch, rel=EXACT)
    assert replace(rack, normal_module=4.0).length == pytest.approx(20 * pitch, rel=EXACT)
    cut = Rack(**RACK | {"teeth": None, "length": 10.5 * pitch, "helix_angle": 15.0})
    assert (cut.teeth, replace(cut, normal_module=1.0).teeth) == (10, 21)
    assert Rack(**RACK | {"teeth": None, "length": 62.83185307}).teeth == 10  # as printed
    assert eval(repr(cut), {"Rack": Rack}) == cut


@pytest.mark.parametrize("helix", [0.0, 25.0])
@pytest.mark.parametrize("radius", [0.38, 0.0, "full"])
def test_curves_join_and_are_the_half_thickness(helix: float, radius: float | str) -> None:
    rack = Rack(
        **RACK | {"helix_angle": helix, "rack": BasicRack(root_radius=radius), "tip_chamfer": 0.2, "tooth_thinning": 0.1}
    )
    profile, s = rack.profile, np.linspace(0, 1, 21)
    ends = [curve.points(np.array([0.0, 1.0])) for curve in profile.curves]
    assert ends[0][0] == pytest.approx([-rack.transverse_pitch / 2, -2.5], abs=EXACT)
    assert ends[-1][1] == pytest.approx([0, 2], abs=EXACT)
    for before, after in pairwise(ends):
        assert before[1] == pytest.approx(after[0], abs=1e-12)
    for curve in profile.curves:
        x, y = curve.points(s[1:-1]).T
        if np.ptp(y) > 0:
            assert -x == pytest.approx(profile.half_thickness(y), abs=1e-12)
        tangent = curve.points(s + 1e-6) - curve.points(s - 1e-6)
        assert np.arctan2(tangent[:, 1], tangent[:, 0]) == pytest.approx(curve.direction(s), abs=1e-9)


def test_fillets_are_circles_square_to_the_teeth() -> None:
    rack = Rack(**RACK | {"helix_angle": 30.0})
    fillet = next(curve for curve in rack.profile.curves if curve.kind.value == "fillet")
    x, y = fillet.points(np.linspace(0, 1, 30)).T
    x *= math.cos(math.radians(30))
    radius, depth, angle = 0.76, 2.5, math.radians(20)
    assert np.hypot(x - x[0], y + depth - radius) == pytest.approx(radius, rel=EXACT)
    last = fillet.direction(np.array([1.0]))
    assert math.tan(last[0]) == pytest.approx(1 / math.tan(angle) * math.cos(math.radians(30)), rel=EXACT)


def test_full_radius_leaves_no_root_land() -> None:
    rack = Rack(**RACK | {"rack": BasicRack(root_radius="full")})
    assert rack.profile.root_land == 0
    assert rack.profile.curves[0].points(np.array(0.0)) == pytest.approx([-math.pi, -2.5], abs=EXACT)


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_height_over_a_pin_is_where_a_circle_rests_between_flanks(helix: float) -> None:
    """Square to the teeth: the least distance of the pin's centre from the flanks' points is its radius."""
    rack = Rack(**RACK | {"helix_angle": helix, "tooth_thinning": 0.12})
    for pin in (rack.pin_diameter, 3.0, 4.0):
        flank = next(curve for curve in rack.profile.curves if curve.kind.value == "flank")
        points = flank.points(np.linspace(0, 1, 200_001)) * [math.cos(math.radians(helix)), 1]
        centre = np.array([-rack.normal_pitch / 2, rack.inspection.pin_centre(pin)])
        distance = np.hypot(*(points - centre).T)
        assert distance.min() == pytest.approx(pin / 2, abs=1e-9)
        assert points[distance.argmin(), 1] == pytest.approx(rack.inspection.pin_contact(pin), abs=1e-4)
        assert rack.inspection.over_pin(pin) == pytest.approx(18 + centre[1] + pin / 2, rel=EXACT)


def test_pins_that_touch_no_flank_are_refused_with_the_one_that_does() -> None:
    rack = Rack(**RACK | {"tip_chamfer": 0.2, "rack": BasicRack(root_radius=0.1)})
    least, most = rack.inspection.pin_limits
    for pin, words in ((least - 0.01, "falls to the root"), (most + 0.01, "rests on the tips")):
        with pytest.raises(GeometryError, match=words) as caught:
            rack.inspection.over_pin(pin)
        permitted = float(re.search(r"(?:least|most) ([0-9.]+) mm", str(caught.value))[1])  # type: ignore[index]
        rack.inspection.over_pin(permitted)
    assert rack.inspection.pin_contact(most) == pytest.approx(1.8, abs=1e-12)
    touching = min(rack.inspection.pin_contact(least) + rack.form_depth, rack.inspection.pin_centre(least) - least / 2 + 2.5)
    assert touching == pytest.approx(0, abs=1e-12)


# ---------------------------------------------------------------------- the pair


@pytest.mark.parametrize("side", [1, -1])
def test_path_of_contact_is_the_limit_of_a_large_wheel_and_of_a_large_ring(side: int) -> None:
    """BaseTangent with a wheel of radius R (a ring's is negative): what is left of the difference falls like 1/R."""
    found = HELICAL.path_of_contact
    angle = math.radians(HELICAL.working_transverse_pressure_angle)
    misses = []
    for radius in (side * 1e6, side * 1e7):
        bases = PerGear(HELICAL.pinion.base_diameter, 2 * radius * math.cos(angle))
        distance = HELICAL.pitch_radius + radius
        tip = 2 * (radius - HELICAL.pitch_line_height + HELICAL.rack.tip_form_height)
        tangent = BaseTangent(bases, distance, math.degrees(angle), HELICAL.pinion.transverse_base_pitch)
        path = tangent.path(PerGear(HELICAL.pinion.tip_form_diameter, tip))
        misses.append(path.A - found.A)
        assert path.C == found.C and path.E == found.E
    assert abs(misses[1]) < 1e-5 and misses[0] / misses[1] == pytest.approx(10, rel=0.05)


def test_numbers_of_a_pair() -> None:
    """Contact ratio of z 20 and a rack, x 0: (sqrt(r_a^2 - r_b^2) - r sin a + h_a/sin a)/p_b; backlash by both thinnings."""
    spur = pair({"tooth_thinning": 0.04}, {"tooth_thinning": 0.06})
    angle = math.radians(20)
    base = 20 * math.cos(angle)
    ratio = (math.sqrt(22**2 - base**2) - 20 * math.sin(angle) + 2 / math.sin(angle)) / (2 * math.pi * math.cos(angle))
    assert spur.transverse_contact_ratio == pytest.approx(ratio, rel=EXACT)
    assert spur.mounting_distance == 20 and spur.back_distance == 38
    assert spur.circumferential_backlash == pytest.approx(0.1, rel=1e-10)
    assert spur.normal_backlash == pytest.approx(0.1 * math.cos(angle), rel=1e-10)
    assert spur.travel_per_revolution == pytest.approx(40 * math.pi, rel=EXACT)
    assert spur.rack_force(10) == pytest.approx(500) and spur.torque_for(500) == pytest.approx(10)
    assert spur.rack_speed(60) == pytest.approx(0.04 * math.pi, rel=EXACT)
    assert spur.tip_clearances == pytest.approx((0.5, 0.5))
    assert HELICAL.overlap_ratio == pytest.approx(20 * math.sin(math.radians(20)) / 2 / math.pi, rel=EXACT)
    thick = HELICAL.pinion.transverse_tooth_thickness + 2 * HELICAL.rack.profile.half_thickness(HELICAL.pitch_line_height)
    assert HELICAL.circumferential_backlash == pytest.approx(HELICAL.rack.transverse_pitch - thick, abs=1e-12)


def test_contact_lines_are_those_of_the_zone() -> None:
    roll = np.linspace(0, 18, 2001)
    lengths = HELICAL.contact_line_length(roll)
    found = HELICAL.contact_line_lengths
    assert (lengths.min(), lengths.max()) == pytest.approx((found.minimum, found.maximum), rel=1e-4)
    assert isinstance(HELICAL._zone, ContactZone)
    width = HELICAL.common_width / math.cos(math.radians(HELICAL.pinion.base_helix_angle))
    assert found.mean == pytest.approx(HELICAL.transverse_contact_ratio * width, rel=EXACT)


def test_the_rack_moves_as_the_pinion_rolls() -> None:
    start, moved = HELICAL.rack_pose(0.0), HELICAL.rack_pose(10.0)
    assert moved.y - start.y == pytest.approx(math.radians(10) * HELICAL.pitch_radius, rel=EXACT)
    assert start.z == 2.5 and start.x == 21.75 and start.rotation == 90


def test_a_standard_rack_does_not_interfere_and_a_long_tip_does() -> None:
    assert pair().notices == ()
    long = pair({"teeth": 40}, {"tip_alteration": 0.2})
    assert [notice.code for notice in long.notices] == ["fillet-interference"]
    teeth = long.pinion.profile, long.rack.profile
    assert cut_by_rack(*teeth, long._place).depth > 0.01 and cut_by_pinion(*teeth, long._place).depth < 1e-7
    high = pair({"teeth": 200, "tip_alteration": 0.2})
    teeth = high.pinion.profile, high.rack.profile
    assert cut_by_pinion(*teeth, high._place).depth > 0.01 and cut_by_rack(*teeth, high._place).depth < 1e-7


REFUSED = [
    ({"teeth": None}, "teeth"),
    ({"length": 100.0}, "length"),
    ({"teeth": None, "length": 3.0}, "length"),
    ({"height": 2.0}, "height"),
    ({"tip_alteration": 2.0}, "tip_alteration"),
    ({"tip_alteration": -3.0}, "tip_alteration"),
    ({"tip_chamfer": 2.0}, "tip_chamfer"),
    ({"tooth_thinning": 4.0}, "tooth_thinning"),
    ({"rack": BasicRack(root_radius=0.5)}, "rack.root_radius"),
    ({"rack": BasicRack(dedendum=2.5)}, "rack.dedendum"),
    ({"helix_angle": 80.0}, "helix_angle"),
]


@pytest.mark.parametrize(("given", "parameter"), REFUSED)
def test_racks_that_cannot_be(given: dict[str, Any], parameter: str) -> None:
    with pytest.raises(InputError) as caught:
        Rack(**RACK | given)
    assert caught.value.parameter == parameter and "\n" not in str(caught.value)


LIMITS = [
    ({"height": 2.0}, "height", "at least"),
    ({"tip_alteration": 2.0}, "tip_alteration", "at most"),
    ({"tip_chamfer": 2.0}, "tip_chamfer", "below"),
    ({"rack": BasicRack(root_radius=0.5)}, "rack", "at most"),
]


@pytest.mark.parametrize(("given", "field", "words"), LIMITS)
def test_limits_can_be_used_as_they_are_printed(given: dict[str, Any], field: str, words: str) -> None:
    with pytest.raises(GeometryError) as caught:
        Rack(**RACK | given)
    limit = float(str(caught.value).split(f"must be {words} ")[1].split()[0])
    limit = limit * (1 - 1e-9) if words == "below" else limit
    Rack(**RACK | {field: BasicRack(root_radius=limit) if field == "rack" else limit})


def test_pairs_that_cannot_be() -> None:
    with pytest.raises(GeometryError, match=r"= 19 mm: must be at least 20 mm, or pinion.profile_shift at most -0.5"):
        pair(mounting_distance=19.0)
    assert pair({"profile_shift": -0.5}, mounting_distance=19.0).circumferential_backlash == pytest.approx(0, abs=EXACT)
    with pytest.raises(GeometryError, match=r"must be below 23.5719 mm") as caught:
        pair(mounting_distance=24.0)
    assert caught.value.parameter == "mounting_distance"
    assert pair(mounting_distance=23.5718).transverse_contact_ratio == pytest.approx(0, abs=1e-4)
    with pytest.raises(GeometryError, match=r"rack.tip_alteration = 0.25: must be below 0.25"):
        pair({"teeth": 40}, {"tip_alteration": 0.25})
    with pytest.raises(GeometryError, match=r"pinion.tip_diameter = 45.2 mm: must be below 45 mm"):
        pair({"tip_diameter": 45.2})
    with pytest.raises(GeometryError, match="must be -10 deg, opposite to the pinion"):
        pair({"helix_angle": 10.0}, {"helix_angle": 10.0})
    with pytest.raises(GeometryError, match="no rack meshes with a ring"):
        pair({"teeth": -60, "cutter": Gear(**PINION).cutter})
    with pytest.raises(ParameterError, match="must be a Rack"):
        RackPair(pinion=Gear(**PINION), rack=Gear(**PINION))  # type: ignore[arg-type]


def test_a_notebook_shows_both_in_mesh() -> None:
    """Neither outline has points inside the other, but for the pixels they are drawn to."""
    wide = pair({"helix_angle": 20.0, "face_width": 40.0}, {"helix_angle": -20.0, "teeth": 60})
    html = wide._repr_html_()
    outlines = [np.array([place.split(",") for place in found.split()], float) for found in re.findall(r'd="M([^Za]*)Z', html)]
    pinion, rack = (outline * [1, -1] for outline in outlines)
    scale = (wide.pinion.tip_diameter + 24 * wide.rack.transverse_pitch) / 240
    assert rack[:, 0].max() == pytest.approx(wide.back_distance, abs=0.1)
    for one, other in ((pinion, rack), (rack, pinion)):
        inside = one[Outline(other).contains_points(one)]
        assert max((np.hypot(*(other - place).T).min() for place in inside), default=0.0) < scale
    assert min(np.hypot(*(pinion - place).T).min() for place in rack) < scale
    for shown in (wide, wide.rack):
        ElementTree.fromstring(shown._repr_html_().replace("cellpadding=3", ""))
