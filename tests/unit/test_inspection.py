"""Measuring: span, balls, pins and chords against the same measurements made on the exact outline and screw surface."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq, minimize
from support.samples import SAMPLES

from gearcad import BasicRack, Gear, GeometryError, ParameterError
from gearcad.geometry.profile import Curve, CurveKind

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
