"""Measuring gears and rings: span, balls, pins and chords against the same measurements made on exact outlines and screws."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize
from support.samples import SAMPLES

from gearcad import BasicRack, Gear, GeometryError, ParameterError
from gearcad.geometry.curves import Curve, CurveKind
from gearcad.geometry.inspection import chord_below_tip

LENGTH = 1e-9
"""mm, relative to a module of some mm: the measurements below are minima, found to sqrt(eps) in place, eps in length."""

SPUR = {
    "even": Gear(teeth=20, normal_module=2.0, face_width=10),
    "odd": Gear(teeth=21, normal_module=2.0, face_width=10, profile_shift=0.3, tooth_thinning=0.1),
    "small": Gear(teeth=9, normal_module=3.0, face_width=10, profile_shift=0.5),
    "large": Gear(teeth=161, normal_module=1.5, face_width=10, profile_shift=0.1682),
    "coarse angle": Gear(teeth=25, normal_module=2.0, face_width=10, rack=BasicRack(pressure_angle=25, root_radius=0.2)),
}
HELICAL = {
    "even, left": Gear(
        teeth=44, normal_module=2.5, face_width=15.1, helix_angle=-28, profile_shift=-0.378, tooth_thinning=0.16
    ),
    "odd, right": Gear(teeth=13, normal_module=2.5, face_width=18.3, helix_angle=28, profile_shift=0.107, tooth_thinning=0.08),
    "steep": Gear(teeth=17, normal_module=2.0, face_width=60, helix_angle=50, profile_shift=0.2),
}


def _flank(gear: Gear) -> Curve:
    (found,) = (curve for curve in gear.profile.curves if curve.kind is CurveKind.INVOLUTE)
    return found


def _screwed(gear: Gear, points: np.ndarray, turn: float, z: float) -> np.ndarray:
    """A point of the left flank of tooth 0 turned by `turn` (rad) and moved along the helix to height z (mm)."""
    lead = math.copysign(gear.lead, gear.helix_angle)
    angle = turn + 2 * math.pi * z / lead
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y = points
    return np.array([cosine * x - sine * y, sine * x + cosine * y, z])


def _support(gear: Gear, turn: float) -> tuple[float, float]:
    """How far (mm) the left flank of tooth 0, turned by `turn` (rad), reaches along the normal of an anvil, and at which s.

    The anvil is the plane square to (0, cos beta_b, -sin beta_b), which touches the screw flank along a whole generator.
    """
    flank, helix = _flank(gear), math.radians(gear.base_helix_angle)
    normal = np.array([0.0, math.cos(helix), -math.sin(helix)])

    def short(at: np.ndarray) -> float:
        return -float(_screwed(gear, flank.points(min(max(at[0], 0.0), 1.0)), turn, at[1] if helix else 0.0) @ normal)

    best = min(np.linspace(0, 1, 101), key=lambda s: short(np.array([s, 0.0])))
    found = minimize(short, [best, 0.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-15, "maxiter": 4000})
    return -float(found.fun), float(found.x[0])


@pytest.mark.parametrize("gear", [*SPUR.values(), *HELICAL.values()], ids=[*SPUR, *HELICAL])
@pytest.mark.parametrize("off_centre", [0.0, 0.01])
def test_span_is_the_distance_of_two_parallel_tangent_planes(gear: Gear, off_centre: float) -> None:
    """Half a turn about +x maps the far flank and its anvil onto the near ones, so both are found on a left flank."""
    count = gear.span_teeth
    outer = math.pi / gear.teeth * (count - 1)
    near, at = _support(gear, outer + off_centre)
    far, _ = _support(gear, outer - off_centre)
    assert near + far == pytest.approx(gear.inspection.span_measurement(count), abs=LENGTH, rel=0)
    if off_centre == 0 and gear.helix_angle == 0:
        touching = 2 * float(_flank(gear).polar(at)[0])
        assert touching == pytest.approx(gear.inspection.span_contact_diameter(count), abs=1e-4)
        assert gear.form_diameter < touching < gear.tip_form_diameter


def _ball_place(gear: Gear, ball: float) -> tuple[float, float]:
    """Radius (mm) of the centre of a ball that touches the flanks, and diameter on which it touches, by minimisation.

    The ball lies in the space before tooth 0 is turned back by half a pitch, with its centre on +x.
    """

    flank = _flank(gear)

    def nearest(centre: float) -> tuple[float, float]:
        def squared(at: np.ndarray) -> float:
            away = _screwed(gear, flank.points(at[0]), -math.pi / gear.teeth, float(at[1]))
            return float((away[0] - centre) ** 2 + away[1] ** 2 + away[2] ** 2)

        found = minimize(squared, [0.5, 0.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-15, "maxiter": 2000})
        return math.sqrt(found.fun), 2 * float(flank.polar(found.x[0])[0])

    low = gear.base_diameter / 2
    centre = brentq(lambda c: nearest(c)[0] - ball / 2, low, gear.tip_diameter / 2 + ball, xtol=1e-12)
    return float(centre), nearest(centre)[1]


@pytest.mark.parametrize("gear", [*SPUR.values(), *HELICAL.values()], ids=[*SPUR, *HELICAL])
def test_balls_touch_the_exact_flanks(gear: Gear) -> None:
    ball = gear.ball_diameter
    centre, touching = _ball_place(gear, ball)
    between = 2 * centre * (math.cos(math.pi / (2 * gear.teeth)) if gear.teeth % 2 else 1.0)
    assert gear.inspection.over_balls(ball) == pytest.approx(
        between + ball, abs=2e-8, rel=0
    )  # Nelder-Mead: 1e-15 mm² over ball/2
    assert gear.inspection.ball_contact_diameter(ball) == pytest.approx(touching, abs=1e-5)
    assert gear.form_diameter < touching < gear.tip_form_diameter
    # The ball is that which touches at d + 2 x m_n, rounded up to two digits, so it touches a little further out.
    middle = gear.reference_diameter + 2 * gear.profile_shift * gear.normal_module
    assert middle - 1e-6 <= touching <= middle + 0.4 * gear.normal_module
    diametric = 2 * centre + ball if gear.helix_angle and gear.teeth % 2 else gear.inspection.over_balls(ball)
    assert gear.inspection.over_pins(ball) == pytest.approx(diametric, abs=2e-8, rel=0)


@pytest.mark.parametrize("gear", SPUR.values(), ids=SPUR.keys())
def test_chord_of_a_spur_tooth(gear: Gear) -> None:
    half = math.radians(gear.profile.half_angle(gear.reference_diameter / 2))
    thickness, height = gear.inspection.chordal_thickness
    assert thickness == pytest.approx(gear.reference_diameter * math.sin(half), abs=LENGTH, rel=0)
    expected = (gear.tip_diameter - gear.reference_diameter * math.cos(half)) / 2
    assert height == pytest.approx(expected, abs=LENGTH, rel=0)


@pytest.mark.parametrize("gear", SAMPLES.values(), ids=SAMPLES.keys())
def test_every_gear_has_inspection_data_that_follow_its_thinning(gear: Gear) -> None:
    """Thinner teeth shorten the span by t cos(a_n) and let the same ball sink, whatever the gear."""
    t = 0.02 * gear.normal_module
    thin = replace(gear, tooth_thinning=gear.tooth_thinning + t)
    shorter = gear.inspection.span_measurement(2) - thin.inspection.span_measurement(2)
    assert shorter == pytest.approx(t * math.cos(math.radians(gear.rack.pressure_angle)), rel=1e-9)
    assert thin.inspection.over_balls(gear.ball_diameter) < gear.inspection.over_balls(gear.ball_diameter)


def test_few_teeth_whose_spaces_hold_no_ball_on_the_flank() -> None:
    """z = 3, x = 1: where the flanks' normals meet, they are too far out, so the suggested ball touches lower, and says so."""
    gear = Gear(teeth=3, normal_module=1.0, face_width=5, profile_shift=1.0, rack=BasicRack(addendum=0.4375, dedendum=0.6875))
    contact = gear.inspection.ball_contact_diameter(gear.ball_diameter)
    assert contact < gear.form_diameter
    assert any(f"would touch at diameter {contact:.4f} mm, off the involute" in text for text in gear.warnings)
    assert math.isfinite(gear.over_balls)


def test_wrong_gauges_are_refused() -> None:
    gear = SPUR["even"]
    for count in (0, 21):
        with pytest.raises(ParameterError, match=f"span_teeth = {count}: must be a whole number from 1 to 20"):
            gear.inspection.span_measurement(count)
    with pytest.raises(GeometryError, match=r"ball_diameter = 0\.1 mm: must be larger"):
        gear.inspection.over_balls(0.1)
    with pytest.raises(ParameterError, match="ball_diameter = 0 mm: must be a number above 0 mm"):
        gear.inspection.over_balls(0.0)


EXACT = 1e-10
"""mm: rounding, and the tolerance of the root."""

CALIPER_SPUR = Gear(teeth=23, normal_module=3, face_width=20, profile_shift=0.3, tooth_thinning=0.07)
CALIPER_HELICAL = Gear(teeth=31, normal_module=2.5, face_width=20, helix_angle=17.0, profile_shift=0.21)


@pytest.mark.parametrize("diameter", [70.0, 72.0, 75.0])
def test_chord_of_a_spur_gear_is_that_of_its_outline(diameter: float) -> None:
    half = math.radians(float(CALIPER_SPUR.profile.half_angle(diameter / 2)))
    height = (CALIPER_SPUR.tip_diameter - diameter * math.cos(half)) / 2
    found = chord_below_tip(CALIPER_SPUR.inspection, CALIPER_SPUR.inspection.addendum, height)
    assert found == pytest.approx((diameter * math.sin(half), diameter), abs=EXACT)


@pytest.mark.parametrize("gear", [CALIPER_SPUR, CALIPER_HELICAL])
def test_at_the_chordal_height_it_is_the_chordal_thickness(gear: Gear) -> None:
    chord = gear.inspection.chordal_thickness
    found = chord_below_tip(gear.inspection, gear.inspection.addendum, chord.height)
    assert found == pytest.approx((chord.thickness, gear.reference_diameter), abs=EXACT)


def test_where_no_involute_is_nothing_is_measured() -> None:
    for height in (0.001, 9.0):
        with pytest.raises(GeometryError, match=r"^height = \S+ mm: must be between \S+ and \S+ mm, where the involute is$"):
            chord_below_tip(CALIPER_SPUR.inspection, CALIPER_SPUR.inspection.addendum, height)


BALLS: list[tuple[dict[str, Any], float, float, float, float]] = [
    (
        {"teeth": -70, "normal_module": 2.8, "profile_shift": -1.2025},
        5.0, 199.9215656718382, 194.9215656718382, 4.63834857081674,
    ),
    (
        {"teeth": -75, "normal_module": 2.7, "profile_shift": -0.16},
        4.5, 201.85141366369768, 197.30714431305543, 4.511650856215548,
    ),
    (
        {"teeth": -75, "normal_module": 2.7, "profile_shift": -0.16, "helix_angle": 15.0, "tooth_thinning": 0.1},
        4.5, 209.27522779399808, 204.7293302782374, 4.617604216158366,
    ),
    (
        {"teeth": -60, "normal_module": 4.0, "profile_shift": 0.3, "helix_angle": -28.0},
        7.0, 265.7910398417737, 258.7910398417737, 6.530281125881271,
    ),
]  # fmt: skip
"""A ring, a ball, diameter of its centre, dimension between two of them, and the ball that touches at |d + 2 x m_n|.

Computed apart in closed form; the distance of the centre from the helicoid, minimised, was half the ball within 1e-14 mm.
"""

SPANS = [(BALLS[0][0], 8, 67.0430095104689), (BALLS[1][0], 8, 62.91228870057081)]
"""A spur ring, spaces spanned, and the base tangent length: the base arc between the feet of the two involutes."""


@pytest.mark.parametrize(("inputs", "ball", "circle", "between", "ideal"), BALLS)
def test_between_balls(inputs: dict[str, Any], ball: float, circle: float, between: float, ideal: float) -> None:
    ring = Gear(face_width=20, **inputs)
    assert ring.inspection.between_balls(ball) == pytest.approx(between, rel=EXACT)
    step = 10.0 ** (math.floor(math.log10(ideal)) - 1)
    assert ideal - step < ring.ball_diameter <= ideal  # rounded down
    middle = ring.reference_diameter + 2 * ring.profile_shift * ring.normal_module
    assert ring.inspection.ball_contact_diameter(ideal) == pytest.approx(middle, rel=EXACT)
    assert ring.between_pins == (None if ring.helix_angle else ring.between_balls)


def _nearest(ring: Gear, centre: float) -> tuple[float, float]:
    """Distance (mm) of a point (centre, 0, 0) in the middle of a space from the screw flank, and the diameter there."""
    (flank,) = (curve for curve in ring.profile.curves if curve.kind is CurveKind.INVOLUTE)
    lead = math.copysign(ring.lead, ring.helix_angle)

    def squared(at: np.ndarray) -> float:
        x, y = flank.points(at[0])
        turn = 2 * math.pi * at[1] / lead - math.pi / ring.tooth_count
        cosine, sine = math.cos(turn), math.sin(turn)
        return float((cosine * x - sine * y - centre) ** 2 + (sine * x + cosine * y) ** 2 + at[1] ** 2)

    found = minimize(squared, [0.5, 0.0], method="Nelder-Mead", options={"xatol": 1e-11, "fatol": 1e-16, "maxiter": 4000})
    return math.sqrt(found.fun), 2 * float(flank.polar(found.x[0])[0])


RINGS = [
    *(Gear(face_width=20, **inputs) for inputs, *_ in BALLS),
    Gear(teeth=-31, normal_module=1.0, face_width=10, helix_angle=45.0, profile_shift=-0.2, rack=BasicRack(addendum=0.7)),
    Gear(teeth=-300, normal_module=0.5, face_width=10, rack=BasicRack(pressure_angle=14.5)),
]


@pytest.mark.parametrize("ring", RINGS, ids=repr)
def test_balls_touch_the_exact_flanks_of_a_ring(ring: Gear) -> None:
    ball = ring.ball_diameter
    low, high = ring.base_diameter / -2, ring.root_diameter / -2
    centre = brentq(lambda place: _nearest(ring, place)[0] - ball / 2, low, high, xtol=1e-12)
    apart = 2 * float(centre) * (math.cos(math.pi / (2 * ring.teeth)) if ring.teeth % 2 else 1.0)
    # Nelder-Mead leaves 1e-15 mm² of the square, over half the ball.
    assert ring.between_balls == pytest.approx(apart - ball, abs=2e-8, rel=0)
    touching = -_nearest(ring, float(centre))[1]
    assert ring.inspection.ball_contact_diameter(ball) == pytest.approx(touching, abs=1e-5)
    assert ring.form_diameter < touching < ring.tip_form_diameter


@pytest.mark.parametrize(("inputs", "spaces", "span"), SPANS)
def test_span_of_spaces(inputs: dict[str, Any], spaces: int, span: float) -> None:
    ring = Gear(face_width=20, **inputs)
    assert ring.inspection.span_measurement(spaces) == pytest.approx(span, rel=EXACT)
    assert ring.span_spaces is not None
    assert ring.span_measurement == ring.inspection.span_measurement(ring.span_spaces)
    middle = ring.reference_diameter + 2 * ring.profile_shift * ring.normal_module
    misses = {k: abs(ring.inspection.span_contact_diameter(k) - middle) for k in range(1, 30)}
    assert ring.span_spaces == min(misses, key=lambda k: misses[k])


@pytest.mark.parametrize("ring", [ring for ring in RINGS if not ring.helix_angle], ids=repr)
def test_the_anvils_of_a_span_lie_on_the_exact_flanks(ring: Gear) -> None:
    """Two points of the outline on the contact diameter, symmetric to k spaces, are the span apart, square to both flanks."""
    count, touching = ring.span_spaces, ring.span_contact_diameter
    assert count is not None
    assert touching is not None
    radius = -touching / 2
    # The middle of k spaces from that of the tooth beside them, less half that tooth.
    half = count * math.pi / ring.tooth_count - math.radians(ring.profile.half_angle(radius))
    assert 2 * radius * math.sin(half) == pytest.approx(ring.span_measurement, rel=1e-12)
    step = 1e-4
    outer, inner = (
        2 * r * math.sin(count * math.pi / ring.tooth_count - math.radians(ring.profile.half_angle(r)))
        for r in (radius + step, radius - step)
    )
    heights = [
        r * math.cos(count * math.pi / ring.tooth_count - math.radians(ring.profile.half_angle(r)))
        for r in (radius + step, radius - step)
    ]
    assert (outer - inner) / (heights[0] - heights[1]) == pytest.approx(0, abs=1e-3)


def test_thinner_teeth_of_a_ring_leave_wider_spaces() -> None:
    ring = RINGS[0]
    thin = replace(ring, tooth_thinning=0.05)
    wider = thin.inspection.span_measurement(5) - ring.inspection.span_measurement(5)
    assert wider == pytest.approx(0.05 * math.cos(math.radians(20)), rel=1e-9)
    assert thin.inspection.between_balls(5.0) > ring.inspection.between_balls(5.0)


def test_chord_of_a_rings_tooth() -> None:
    ring = Gear(teeth=-60, normal_module=2.0, face_width=10, profile_shift=0.3)
    half = math.radians(ring.profile.half_angle(-ring.reference_diameter / 2))
    thickness, height = ring.inspection.chordal_thickness
    assert thickness == pytest.approx(-ring.reference_diameter * math.sin(half), rel=1e-12)
    assert height == pytest.approx((ring.tip_diameter - ring.reference_diameter * math.cos(half)) / 2, rel=1e-12)


def test_documents_and_wrong_gauges() -> None:
    spur, helical, external = RINGS[0], RINGS[2], Gear(teeth=20, normal_module=2, face_width=10)
    assert {"over_balls", "over_pins", "span_teeth"} <= external.to_dict().keys()
    assert external.between_balls is external.between_pins is external.span_spaces is None
    for ring in (spur, helical):
        document = ring.to_dict()
        assert {"between_balls", "between_pins", "span_spaces"} <= document.keys()
        assert not {"over_balls", "over_pins", "span_teeth"} & document.keys()
        assert ring.over_balls is ring.over_pins is ring.span_teeth is None
    assert helical.to_dict()["span_measurement"] is None
    with pytest.raises(GeometryError, match=r"must be 0 deg for a span: a helical ring is measured between balls"):
        helical.inspection.span_measurement(3)
    with pytest.raises(ParameterError, match="span_spaces = 71: must be a whole number from 1 to 70"):
        spur.inspection.span_measurement(71)
    with pytest.raises(GeometryError, match="measured between balls, not over them"):
        spur.inspection.over_balls(4.0)
    with pytest.raises(GeometryError, match="must be below 0: an external gear is measured over balls"):
        external.inspection.between_balls(4.0)
    with pytest.raises(GeometryError, match="must be 0 deg for pins"):
        helical.inspection.between_pins(4.0)
    with pytest.raises(GeometryError, match=r"ball_diameter = 50 mm: must be below") as refused:
        spur.inspection.between_balls(50.0)
    limit = float(refused.value.permitted.split()[3])
    assert 0 < spur.inspection.between_balls(limit * 0.9999)


def test_a_ball_for_flanks_that_are_nearly_radial() -> None:
    """5 degrees and few teeth: the normals at mid flank meet inside the base circle, so it touches further out."""
    rack = BasicRack(pressure_angle=5, addendum=0.02, dedendum=0.5, root_radius=0)
    ring = Gear(teeth=-12, normal_module=1, face_width=5, rack=rack, profile_shift=-0.2)
    assert ring.between_balls is not None
    assert 0 < ring.between_balls < -ring.root_diameter
