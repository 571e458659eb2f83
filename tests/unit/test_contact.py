"""Pairs: lines of contact, sliding, clearances and the fillet check; formulas with signed teeth."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from support.cases import volvo_pair
from support.clearance import turn_to_touch

from gearcad import ISO53_A, BasicRack, Body, Gear, GearPair, GeometryError, ShiftSplit
from gearcad.core.records import PerGear
from gearcad.geometry import (
    BaseTangent,
    PathOfContact,
    profile_shift_sum,
    specific_sliding,
    split_profile_shift,
    zero_backlash_centre_distance,
)
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.pair_data import farthest_centre_distance, shift_sum_limit


def _pair(z: tuple[int, int], *, x: tuple[float, float] = (0.0, 0.0), helix: float = 0.0, **common: float) -> GearPair:
    width = common.pop("face_width", 20.0)
    gears = [
        Gear(teeth=teeth, normal_module=2.0, face_width=width, helix_angle=hand * helix, profile_shift=shift, **common)
        for teeth, shift, hand in zip(z, x, (1, -1), strict=True)
    ]
    return GearPair(pinion=gears[0], wheel=gears[1])


PAIRS = {
    "spur": _pair((20, 35)),
    "thesis": volvo_pair(),
    "wide": _pair((20, 35), helix=25.0, face_width=60.0),
    "left": _pair((25, 31), helix=-12.0),
    "nearly spur": _pair((25, 31), helix=0.5),
}
pairs = pytest.mark.parametrize("pair", PAIRS.values(), ids=PAIRS.keys())


# ---------------------------------------------------------------------- lines of contact


@pairs
def test_mean_contact_length_over_the_cycle(pair: GearPair) -> None:
    cycle = 360 / pair.pinion.teeth
    edges = np.linspace(0, cycle, 200_001)
    middles = (edges[1:] + edges[:-1]) / 2
    total = pair.contact_line_length(middles)
    lengths = pair.contact_line_lengths
    # A spur pair jumps, which the midpoint rule misses by one cell of 200,000 at each jump.
    jump = pair.common_width.width / 200_000 if pair.pinion.helix_angle == 0 else 0.0
    assert float(np.mean(total)) == pytest.approx(lengths.mean, abs=1e-6 + 2 * jump, rel=0)
    assert float(total.max()) <= lengths.maximum + 1e-9
    assert float(total.min()) >= lengths.minimum - 1e-9
    # The total is piecewise linear, so the finest scan misses its corners by one cell of a rising line at the most.
    slope = (
        pair.pinion.base_diameter
        / 2
        * math.radians(cycle)
        / 200_000
        / max(math.sin(math.radians(abs(pair.pinion.base_helix_angle))), 1e-3)
        * 4
    )
    assert float(total.max()) == pytest.approx(lengths.maximum, abs=slope)
    assert float(total.min()) == pytest.approx(lengths.minimum, abs=slope)


@pairs
def test_mean_is_contact_ratio_times_width(pair: GearPair) -> None:
    expected = pair.transverse_contact_ratio * pair.common_width.width / math.cos(math.radians(pair.pinion.base_helix_angle))
    assert pair.contact_line_lengths.mean == pytest.approx(expected, rel=1e-12)


@pairs
def test_lines_repeat_every_pitch(pair: GearPair) -> None:
    roll = np.linspace(-7, 9, 31)
    again = pair.contact_line_length(roll + 360 / pair.pinion.teeth)
    assert again == pytest.approx(pair.contact_line_length(roll), abs=1e-9)
    assert isinstance(pair.contact_line_length(0.0), float)


# ---------------------------------------------------------------------- shifts and sliding


def _sliding(pair: GearPair) -> tuple[float, float]:
    """Specific sliding of the pinion in A and of the wheel in E, from the speeds across the line of action."""
    path = pair.path_of_contact
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    slow = pair.pinion.teeth / pair.wheel.teeth

    def speeds(at: float) -> tuple[float, float]:
        return at, slow * (whole - at)

    (pinion_a, wheel_a), (pinion_e, wheel_e) = speeds(path.A), speeds(path.E)
    return (pinion_a - wheel_a) / pinion_a, (wheel_e - pinion_e) / wheel_e


@pytest.mark.parametrize("teeth", [(12, 40), (18, 161), (25, 25), (13, 44)])
@pytest.mark.parametrize("helix", [0.0, 28.0])
@pytest.mark.parametrize("total", [0.0, 0.6])
@pytest.mark.parametrize("k", [0.0, -0.02])
def test_equal_specific_sliding_is_equal(teeth: tuple[int, int], helix: float, total: float, k: float) -> None:
    plain = _pair(teeth, x=(total / 2, total / 2), helix=helix)
    first, second = split_profile_shift(
        total,
        ShiftSplit.EQUAL_SPECIFIC_SLIDING,
        normal_module=2.0,
        teeth=PerGear(*teeth),
        helix_angle=helix,
        pressure_angle=20.0,
        centre_distance=float(plain.centre_distance),
        tip_alteration=k,
    )
    pair = _pair(teeth, x=(first, second), helix=helix, tip_alteration=k)
    assert pair.centre_distance == pytest.approx(plain.centre_distance, abs=1e-9)
    pinion, wheel = _sliding(pair)
    assert pinion == pytest.approx(wheel, rel=1e-9)
    assert pinion < 0


def test_other_splits() -> None:
    inputs = {
        "normal_module": 2.0,
        "teeth": PerGear(20, 30),
        "helix_angle": 0.0,
        "pressure_angle": 20.0,
        "centre_distance": 51.0,
    }
    assert split_profile_shift(0.5, ShiftSplit.EQUAL, **inputs) == (0.25, 0.25)
    assert split_profile_shift(0.5, ShiftSplit.PINION, **inputs) == (0.5, 0.0)


@pytest.mark.parametrize("change", [-0.8, -0.1, 0.0, 0.5, 2.0])
@pytest.mark.parametrize("helix", [0.0, 35.0])
def test_shift_sum_gives_the_centre_distance_back(change: float, helix: float) -> None:
    plain = _pair((20, 35), helix=helix)
    total = profile_shift_sum(
        normal_module=2.0,
        teeth=PerGear(20, 35),
        helix_angle=helix,
        pressure_angle=20.0,
        centre_distance=plain.centre_distance + change,
    )
    pair = _pair((20, 35), x=(total / 2, total / 2), helix=helix)
    assert pair.centre_distance == pytest.approx(plain.centre_distance + change, abs=1e-9)
    assert pair.circumferential_backlash == pytest.approx(0, abs=1e-12)


# ---------------------------------------------------------------------- clearance of fillets


def _touching_error(pair: GearPair, positions: int = 40) -> float:
    """How much earlier (mm on the working circle) the exact outlines touch than the backlash says, at the worst."""
    half, radius = pair.circumferential_backlash / 2, pair.working_pitch_diameters[1] / 2
    turns = np.linspace(0, 360 / pair.pinion.teeth, positions, endpoint=False)
    return max(half - turn_to_touch(pair, float(turn), side) * radius for turn in turns for side in (1, -1))


def test_thesis_pair_cuts_the_fillet_as_reported() -> None:
    (warning,) = PAIRS["thesis"].warnings
    assert warning.startswith("fillet interference: the wheel's tip reaches diameter 34.1388 mm of the pinion")
    assert _touching_error(PAIRS["thesis"]) == pytest.approx(0.0066, abs=0.0005)


def test_tip_edge_may_cut_the_fillet_though_it_leaves_the_involute_in_time() -> None:
    """277/117 with a long addendum: d_Nf is above d_Ff on both, yet the wheel's tip edge sweeps the pinion's fillet."""
    long = BasicRack(addendum=1.2435490459661132, dedendum=1.2123582762838083, root_radius=0.2)
    short = replace(ISO53_A, root_radius=0.1234533159563665)
    k = -0.0006016343369710242
    common = {"normal_module": 1.0, "face_width": 10.0, "tip_alteration": k}
    pinion = Gear(teeth=277, helix_angle=-3.44651538564257, profile_shift=-0.49566812945900907, rack=short, **common)
    wheel = Gear(teeth=117, helix_angle=3.44651538564257, profile_shift=0.31886208368719426, rack=long, **common)
    pair = GearPair(pinion=pinion, wheel=wheel)
    for gear, active in zip((pinion, wheel), pair.active_root_diameters, strict=True):
        assert gear.form_diameter < active
    (warning,) = pair.warnings
    assert "the edge of the wheel's tip cuts" in warning
    assert _touching_error(pair, 15) > 0.003
    # A shorter tip is all it takes: the warning goes exactly when the outlines stop overlapping.
    low, high = wheel.tip_diameter - 0.4, float(wheel.tip_diameter)
    for _ in range(8):
        middle = (low + high) / 2
        cut = bool(replace(pair, wheel=replace(wheel, tip_diameter=middle)).warnings)
        low, high = (low, middle) if cut else (middle, high)
    assert _touching_error(replace(pair, wheel=replace(wheel, tip_diameter=low - 1e-3)), 60) < 1e-9
    between = (high + wheel.tip_diameter) / 2
    assert _touching_error(replace(pair, wheel=replace(wheel, tip_diameter=between)), 15) > 1e-5


# ---------------------------------------------------------------------- placing


@pytest.mark.parametrize("offset", [0.0, 3.0, -4.5])
@pytest.mark.parametrize("helix", [0.0, 28.0, -15.0])
def test_common_width(offset: float, helix: float) -> None:
    pair = _pair((20, 35), helix=helix)
    pair = replace(pair, wheel=replace(pair.wheel, face_width=12.0), axial_offset=offset)
    low, high = max(-10.0, offset - 6), min(10.0, offset + 6)
    assert pair.common_width == pytest.approx((high - low, (high + low) / 2))


@pairs
def test_pose_turns_with_the_pinion(pair: GearPair) -> None:
    start, later = pair.wheel_pose(), pair.wheel_pose(11.0)
    assert later.rotation - start.rotation == pytest.approx(-11.0 / pair.gear_ratio)
    assert (start.x, start.z) == (pair.centre_distance, (pair.pinion.face_width - pair.wheel.face_width) / 2)


def test_axes_too_close_or_too_deep_are_refused() -> None:
    pair = PAIRS["spur"]
    with pytest.raises(GeometryError) as caught:
        replace(pair, centre_distance=54.9)
    assert caught.value.parameter == "centre_distance"
    assert "must be at least 55 mm" in str(caught.value)
    deep = replace(pair.pinion, tip_diameter=46.0, tooth_thinning=0.0)
    with pytest.raises(GeometryError) as caught:
        replace(pair, pinion=deep)
    assert caught.value.parameter == "pinion.tip_diameter"
    assert "must be below 45.000000 mm: the tip reaches the wheel's root circle" in str(caught.value)


def test_tip_chamfer_shortens_the_path() -> None:
    pair = PAIRS["spur"]
    chamfered = replace(pair, wheel=replace(pair.wheel, body=Body(tip_chamfer=0.2)))
    lower = replace(pair, wheel=replace(pair.wheel, tip_diameter=pair.wheel.tip_diameter - 0.4))
    assert chamfered.path_of_contact == pytest.approx(lower.path_of_contact, abs=1e-12)


EXACT = 1e-10


@dataclass
class Internal:
    """A pinion in a ring, and what the formulas must give."""

    gears: PerGear[GearData]
    tip_diameters: PerGear[float]
    centre_distance: float
    pressure_angle: float
    length: float
    path: PathOfContact
    active_root_diameters: PerGear[float]

    @property
    def size(self) -> dict[str, object]:
        pinion = self.gears.pinion
        teeth = self.gears.map(lambda gear: gear.teeth)
        return {"teeth": teeth, "helix_angle": pinion.helix_angle, "pressure_angle": pinion.rack.pressure_angle}


def _gears(module: float, teeth: PerGear[int], shifts: PerGear[float], helix: float = 0.0) -> PerGear[GearData]:
    return PerGear(
        *(
            GearData(teeth=z, normal_module=module, face_width=20.0, helix_angle=helix, profile_shift=x)
            for z, x in zip(teeth, shifts, strict=True)
        )
    )


SIGNED_PAIRS = [
    Internal(
        gears=_gears(2.8, PerGear(22, -70), PerGear(0.5, -1.2025)),
        tip_diameters=PerGear(70.0, -197.134),
        centre_distance=-68.99992099071177,
        pressure_angle=23.76870499066457,
        length=-27.810106575079217,
        path=PathOfContact(7.331152268944393, 11.414728103827295, 12.746298846911309, 15.597120284406332, 19.680696119289234),
        active_root_diameters=PerGear(59.71318091847535, -207.22858641039625),
    ),
    Internal(
        gears=_gears(2.7, PerGear(24, -75), PerGear(0.4, -0.46), helix=15.0),
        tip_diameters=PerGear(74.64589649057339, -207.53742653304184),
        centre_distance=-71.43949816736826,
        pressure_angle=20.986341436945867,
        length=-25.585726648533377,
        path=PathOfContact(8.273770600516531, 11.97564253928789, 12.040341952251005, 16.491267567000715, 20.193139505772074),
        active_root_diameters=PerGear(64.92133278270704, -216.49189255401532),
    ),
]


@pytest.mark.parametrize("pair", SIGNED_PAIRS, ids=["spur", "helical"])
def test_centre_distance_and_shifts_of_an_internal_pair(pair: Internal) -> None:
    pinion, ring = pair.gears
    size = {"normal_module": pinion.normal_module, **pair.size}
    total = pinion.profile_shift + ring.profile_shift
    assert zero_backlash_centre_distance(**size, shift_sum=total) == pytest.approx(pair.centre_distance, rel=EXACT)
    assert profile_shift_sum(**size, centre_distance=pair.centre_distance) == pytest.approx(total, rel=EXACT)
    assert pinion.standard_tip_diameter == pytest.approx(pair.tip_diameters.pinion, rel=EXACT)
    limit = shift_sum_limit(**pair.size)
    with pytest.raises(GeometryError, match=f"must be below {limit:.3f}"[:-1]):
        zero_backlash_centre_distance(**size, shift_sum=limit + 0.1)
    base = (pinion.base_diameter + ring.base_diameter) / 2
    assert zero_backlash_centre_distance(**size, shift_sum=limit - 1e-9) == pytest.approx(base, rel=1e-5)


@pytest.mark.parametrize("pair", SIGNED_PAIRS, ids=["spur", "helical"])
def test_path_of_contact_of_an_internal_pair(pair: Internal) -> None:
    bases = pair.gears.map(lambda gear: gear.base_diameter)
    line = BaseTangent(bases, pair.centre_distance, pair.pressure_angle, pair.gears.pinion.transverse_base_pitch)
    assert line.length == pytest.approx(pair.length, rel=EXACT)
    path = line.path(pair.tip_diameters)
    assert path == pytest.approx(pair.path, rel=EXACT)
    assert line.active_root_diameters(path) == pytest.approx(pair.active_root_diameters, rel=EXACT)
    assert line.usable(path, pair.active_root_diameters) == pytest.approx((path.A, path.E), rel=EXACT)
    distance = -farthest_centre_distance(bases, pair.tip_diameters)
    angle = math.degrees(math.acos(sum(bases) / 2 / distance))
    vanished = BaseTangent(bases, distance, angle, 1.0).path(pair.tip_diameters)
    assert vanished.A == pytest.approx(vanished.E, rel=EXACT)


@pytest.mark.parametrize("pair", SIGNED_PAIRS, ids=["spur", "helical"])
def test_specific_sliding_of_an_internal_pair(pair: Internal) -> None:
    """1 - v_mate/v_own of the flanks where they touch: their velocities along the profile are omega rho."""
    z_1, z_2 = pair.gears.map(lambda gear: gear.teeth)
    found = specific_sliding(
        teeth=PerGear(z_1, z_2),
        base_radii=pair.gears.map(lambda gear: gear.base_diameter / 2),
        tip_radii=pair.tip_diameters.map(lambda diameter: diameter / 2),
        centre_distance=pair.centre_distance,
    )
    ratio, (first, _, _, _, last) = z_1 / abs(z_2), pair.path
    mates = PerGear(first - pair.length, last)
    assert found.pinion == pytest.approx(1 - ratio * mates.pinion / first, rel=1e-9)
    assert found.wheel == pytest.approx(1 - mates.wheel / ratio / (last - pair.length), rel=1e-9)
