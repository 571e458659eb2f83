"""Internal pairs and shaped gears: factors by hand, sections held against curves and limits, and what is refused."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest

from gearcad import BasicRack, Body, Gear, GearcadError, GearPair, GeometryError, Load, Material, rate
from gearcad.core.symbols import GEAR_RATING, RING_FORMULA
from gearcad.designs.variations import column_symbol
from gearcad.geometry import ShaperCutter
from gearcad.geometry.fillets import FilletTool
from gearcad.rating import Edition, RatingOptions, RootSection, VirtualGear, contact_at
from gearcad.rating.root_section import _half_width, generated_section, hob_section, load_point, root_section, virtual_tool
from gearcad.rating.tooth_stiffness import ring_rim_factor

EXACT = 1e-11
STEEL, LOAD = Material(), Load(torque=300.0)
MODULUS = 206000 / (2 * (1 - 0.3**2))
"""E* (MPa)."""


def _pair(helix: float = 0.0, cutter: ShaperCutter | None = None, **ring: object) -> GearPair:
    pinion = Gear(teeth=24, normal_module=2.7, face_width=22.0, helix_angle=helix, profile_shift=0.4)
    given = {"profile_shift": -0.46, "rack": BasicRack(addendum=0.85), "body": Body(rim_diameter=250.0)} | ring
    cutter = cutter or ShaperCutter(teeth=30, tip_radius=0.2)
    wheel = Gear(teeth=-75, normal_module=2.7, face_width=20.0, helix_angle=helix, cutter=cutter, **given)
    return GearPair(pinion=pinion, wheel=wheel)


# ---------------------------------------------------------------------- flanks and stiffness, worked out once more


class _ByHand:
    """The pair above from its inputs alone, with unsigned lengths: radii of curvature are drawn, not taken from formulas."""

    def __init__(self, helix: float) -> None:
        m, beta, a_n = 2.7, math.radians(helix), math.radians(20)
        a_t = math.atan(math.tan(a_n) / math.cos(beta))
        self.beta_b = math.asin(math.sin(beta) * math.cos(a_n))
        m_t = m / math.cos(beta)
        self.r_b1, self.r_b2 = 12 * m_t * math.cos(a_t), 37.5 * m_t * math.cos(a_t)
        # Without backlash inv a_w = inv a_t + 2 tan a_n (x_1 + x_2)/(z_1 - 75), by halving.
        goal = math.tan(a_t) - a_t + 2 * math.tan(a_n) * (0.4 - 0.46) / (24 - 75)
        low, high = 0.0, 1.5
        for _ in range(100):
            middle = (low + high) / 2
            low, high = (middle, high) if math.tan(middle) - middle < goal else (low, middle)
        self.a_w, self.a_t = low, a_t
        self.apart = (self.r_b2 - self.r_b1) * math.tan(low)  # T1 from T2
        tip_1, tip_2 = 12 * m_t + (1 + 0.4) * m, 37.5 * m_t - (0.85 - 0.46) * m
        self.pitch = math.pi * m_t * math.cos(a_t)
        self.last = math.sqrt(tip_1**2 - self.r_b1**2)
        self.first = math.sqrt(tip_2**2 - self.r_b2**2) - self.apart
        self.eps_alpha = (self.last - self.first) / self.pitch
        self.eps_beta = 20 * math.sin(beta) / (math.pi * m)
        self.force = 1000 * 300 / self.r_b1  # F_bt

    def radius(self, along: float) -> float:
        """R in the normal section of flanks that touch `along` mm from T1: a hollow one of rho_2 round one of rho_1."""
        own, other = along / math.cos(self.beta_b), (along + self.apart) / math.cos(self.beta_b)
        return 1 / (1 / own - 1 / other)

    @property
    def pitch_point(self) -> float:
        return self.r_b1 * math.tan(self.a_w)


@pytest.mark.parametrize("helix", [0.0, 4.0, 15.0])
def test_contact_stress_is_hertz_of_a_hollow_flank(helix: float) -> None:
    """sigma_H0 is Hertz at the pitch point times Z_eps Z_beta; Z_B goes with the root of the curvatures; Z_D is 1."""
    pair, hand = _pair(helix), _ByHand(helix)
    assert pair.transverse_contact_ratio == pytest.approx(hand.eps_alpha, rel=EXACT)
    flank = rate(pair, LOAD).nominal.flank
    peak = math.sqrt(hand.force / 20 * MODULUS / (math.pi * hand.radius(hand.pitch_point)))
    beta = min(hand.eps_beta, 1.0)
    ratio = math.sqrt((4 - hand.eps_alpha) / 3 * (1 - beta) + beta / hand.eps_alpha)
    expected = peak * ratio / math.sqrt(math.cos(math.radians(helix)))
    assert flank.nominal_stress == pytest.approx(expected, rel=EXACT)
    inner = math.sqrt(hand.radius(hand.pitch_point) / hand.radius(hand.last - hand.pitch))
    assert flank.contact_factors == pytest.approx((max(inner - beta * (inner - 1), 1.0), 1.0), rel=EXACT)
    contact = contact_at(pair, STEEL, distance=hand.pitch_point, force=hand.force / math.cos(hand.beta_b))
    assert contact.peak_pressure == pytest.approx(peak, rel=EXACT)


def test_stiffness_of_a_ring_is_that_of_a_rack_with_its_shift() -> None:
    found = rate(_pair(), LOAD).nominal.stiffness
    q = 0.04723 + 0.15551 / 24 - 0.00635 * 0.4 - 0.11654 * 0.4 / 24 + 0.00193 * 0.46 + 0.00529 * 0.16 + 0.00182 * 0.46**2
    assert found.flexibility == pytest.approx(q, rel=EXACT)
    assert found.single == pytest.approx(0.8 * 0.975 / q, rel=EXACT)


def test_limit_of_large_rings() -> None:
    """A ring and an external wheel of 2000 teeth: both are nearly racks, and differ as 1/z does."""

    def rated(teeth: int) -> tuple[float, float, float]:
        pinion = Gear(teeth=24, normal_module=2.0, face_width=20.0)
        wheel = replace(pinion, teeth=teeth, cutter=ShaperCutter(teeth=25, tip_radius=0.25))
        found = rate(GearPair(pinion=pinion, wheel=wheel), LOAD).nominal
        return found.contact_stresses.pinion, found.stiffness.single, found.roots.pinion.form_factor

    ring, wheel, near, far = (rated(teeth) for teeth in (-2000, 2000, -1000, 1000))
    assert ring == pytest.approx(wheel, rel=0.03)
    for of_ring, of_wheel, of_near, of_far in zip(ring, wheel, near, far, strict=True):
        assert (of_far - of_near) / (of_wheel - of_ring) == pytest.approx(2, rel=0.1)


# ---------------------------------------------------------------------- root sections


def _section_of(tool: FilletTool, half_pitch: float, lean: float, internal: bool) -> tuple[float, float, float]:
    """Place, half chord and radius of curvature where a curve of many points leans by an angle (deg), from the points alone."""
    radius, angle = tool.cut(np.linspace(0, tool.last_angle, 20001))
    x, y = radius * np.cos(half_pitch - angle), radius * np.sin(half_pitch - angle)
    along, across = np.gradient(x), np.gradient(y)
    leans = np.degrees(np.arctan2(-across, -along if internal else along))
    at = int(np.argmin(np.abs(leans - lean)))
    turn = np.radians(np.gradient(leans))[at]
    return float(x[at]), float(y[at]), abs(math.hypot(along[at], across[at]) / turn)


SHAPED = {
    "spur ring": (_pair().wheel, 60.0),
    "helical ring": (_pair(15.0).wheel, 60.0),
    "left-hand ring": (_pair(-28.0, tooth_thinning=0.1).wheel, 60.0),
    "form root": (Gear(teeth=-75, normal_module=2.7, face_width=20.0, helix_angle=15.0), 60.0),
    "external": (Gear(teeth=24, normal_module=2.0, face_width=20.0, cutter=ShaperCutter(teeth=20, tip_radius=0.2)), 30.0),
    "helical": (
        Gear(teeth=24, normal_module=2.0, face_width=20.0, helix_angle=20.0, cutter=ShaperCutter(teeth=20, tip_radius=0.3)),
        30.0,
    ),
}


@pytest.mark.parametrize("gear, lean", SHAPED.values(), ids=SHAPED)
def test_generated_section_lies_on_the_fillet(gear: Gear, lean: float) -> None:
    """Chord, radius and arm from points of the curve and a straight line of force, tangential to the base circle."""
    virtual = VirtualGear.of(gear)
    load = load_point(virtual, 1.5)
    section = root_section(gear, virtual, load)
    place, half_chord, radius = _section_of(virtual_tool(gear, virtual), math.pi / abs(virtual.teeth), lean, gear.internal)
    assert section.lean == lean
    assert section.chord == pytest.approx(2 * half_chord, rel=1e-3)
    assert section.fillet_radius == pytest.approx(radius, rel=1e-3)
    base = abs(virtual.base_diameter) / 2
    r, half = abs(load.diameter) / 2, math.radians(abs(load.half_angle))
    # The flank's normal there touches the base circle, r from the axis: it leans to the radius by arcsin(base/r).
    slope = half + math.acos(base / r) if gear.internal else half - math.acos(base / r)
    crossing = r * math.cos(half) + r * math.sin(half) * math.tan(slope)
    assert section.moment_arm == pytest.approx(abs(crossing - place), rel=2e-3)


def test_fillets_of_large_rings_and_wheels_are_one() -> None:
    """That of the same cutter in 2000 teeth inside and outside, at the same lean: both are the root of a rack."""
    ring = Gear(teeth=-2000, normal_module=2.0, face_width=20.0, cutter=ShaperCutter(teeth=25, tip_radius=0.25))
    virtual = VirtualGear.of(ring)
    section = root_section(ring, virtual, load_point(virtual, 1.6))
    wheel = replace(ring, teeth=2000)
    _, half_chord, radius = _section_of(wheel.profile.tool, math.pi / 2000, 60.0, internal=False)
    assert (section.chord, section.fillet_radius) == pytest.approx((2 * half_chord, radius), rel=6e-3)


def test_load_on_a_ring_acts_at_its_outer_point_of_single_contact() -> None:
    """B, where the tooth's arm to the root is longest while it carries alone."""
    pair = _pair(tooth_thinning=0.05)
    load = rate(pair, LOAD).nominal.roots.wheel.load_point
    along = pair.path_of_contact.B - pair.base_tangent.length
    diameter = math.hypot(pair.wheel.base_diameter, 2 * along)
    assert load.diameter == pytest.approx(-diameter, rel=EXACT)
    assert -load.half_angle == pytest.approx(pair.wheel.profile.half_angle(diameter / 2), rel=1e-10)
    slope = math.degrees(math.atan2(2 * along, -pair.wheel.base_diameter)) + pair.wheel.profile.half_angle(diameter / 2)
    assert load.load_angle == pytest.approx(slope, rel=1e-10)


def _values(section: RootSection) -> tuple[float, float, float]:
    return section.chord, section.fillet_radius, section.moment_arm


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_large_cutters_leave_the_root_of_a_hob(helix: float) -> None:
    """Shaped by more and more teeth, an external gear comes to what the standard's formulas say of its rack, as 1/z_0."""
    hobbed = Gear(teeth=24, normal_module=2.0, face_width=20.0, helix_angle=helix, profile_shift=0.2, tooth_thinning=0.05)
    virtual = VirtualGear.of(hobbed)
    load = load_point(virtual, 1.6)
    expected = np.array(_values(hob_section(hobbed, virtual, load)))
    off = []
    for teeth in (1000, 2000):
        gear = replace(hobbed, cutter=ShaperCutter(teeth=teeth, tip_radius=0.38))
        off.append(np.array(_values(generated_section(gear, virtual, load))) / expected - 1)
    assert off[0] / off[1] == pytest.approx([2, 2, 2], rel=0.01)
    assert 2 * off[1] - off[0] == pytest.approx([0, 0, 0], abs=5e-5)


@pytest.mark.parametrize("teeth", [-75, 40])
def test_virtual_cutter_goes_over_into_the_cutter_of_a_spur_gear(teeth: int) -> None:
    gear = Gear(
        teeth=teeth, normal_module=2.7, face_width=20.0, profile_shift=0.1, cutter=ShaperCutter(teeth=30, tip_radius=0.2)
    )
    found = []
    for helix in (0.0, 1e-3):
        each = replace(gear, helix_angle=helix)
        virtual = VirtualGear.of(each)
        found.append(_values(root_section(each, virtual, load_point(virtual, 1.6))))
    assert found[0] == pytest.approx(found[1], rel=1e-8)


@pytest.mark.parametrize("gear", [_pair().wheel, replace(_pair().wheel, teeth=40, rack=BasicRack(), body=Body())])
def test_fillet_radius_is_that_of_euler_and_savary(gear: Gear) -> None:
    """rho_F = rho + l w/(dpsi): the middle of the corner, l beyond the pitch point, turns with w about it."""
    virtual = VirtualGear.of(gear)
    tool = virtual_tool(gear, virtual)
    section = root_section(gear, virtual, load_point(virtual, 1.6))
    z, z_0, sign = abs(gear.teeth), 30, -1 if gear.internal else 1
    theta, pitch = math.radians(section.tangent_angle), tool.centre_distance * z_0 / (z + sign * z_0)  # type: ignore[attr-defined]
    middle = tool.tip_radius - tool.radius  # type: ignore[attr-defined]
    gamma = math.asin(middle * math.sin(theta) / pitch)
    rate_of_gamma = middle * math.cos(theta) / (pitch * math.cos(gamma))
    turn = rate_of_gamma - 1
    beyond = middle * math.cos(theta) - pitch * math.cos(gamma)
    bend = rate_of_gamma + sign * turn * z_0 / z
    expected = tool.radius + beyond * turn * (1 + sign * z_0 / z) / bend  # type: ignore[attr-defined]
    assert section.fillet_radius == pytest.approx(abs(expected), rel=1e-9)


# ---------------------------------------------------------------------- rims, notices, documents


def test_rim_factor_of_a_ring() -> None:
    """It meets 1 at 3.5 m_n as far as rounded numbers do; the German standard has none."""
    iso, din = Edition.ISO_2006, Edition.DIN_1987
    found = [ring_rim_factor(ratio, iso) for ratio in (6.0, 3.5, 3.5 - 1e-12, 2.0)]
    assert found == pytest.approx([1, 1, 1, 1.15 * math.log(8.324 / 2)], abs=4e-3)
    assert ring_rim_factor(2.0, din) == 1


def test_what_is_said_of_a_ring() -> None:
    pair = _pair(body=Body(rim_diameter=222.0))
    rating = rate(pair, LOAD).nominal
    codes = {notice.code for notice in rating.notices}
    assert {"ring-to-verify", "generated-root", "thin-rim", "stiffness-ring-rim", "stiffness-ring-to-verify"} <= codes
    assert rating.to_dict()["verify"] == ["q_prime", "Z_D", "wheel.Y_B", "wheel.formula"]
    bare = rate(_pair(body=Body()), LOAD).nominal
    assert {"rim-not-given"} < {notice.code for notice in bare.notices}
    assert bare.roots.wheel.rim_thickness_factor == 1
    own = rate(_pair(cutter=ShaperCutter(tip_radius=0.3)), LOAD).nominal
    assert own.verify == ("q_prime", "Z_D", "wheel.Y_B")
    form = own.roots.wheel
    assert form.formula is None
    assert form.section.fillet_radius == pytest.approx(0.3 * 2.7, rel=1e-9)
    german = rate(pair, LOAD, rating=RatingOptions(standard=Edition.DIN_1987)).nominal
    assert german.roots.wheel.rim_thickness_factor == 1


def test_documents_of_external_pairs_know_nothing_of_rings() -> None:
    gear = Gear(teeth=24, normal_module=2.0, face_width=20.0)
    document = rate(GearPair(pinion=gear, wheel=gear), LOAD).nominal.to_dict()
    assert "verify" not in document
    assert set(document["wheel"]) == set(GEAR_RATING)


def test_every_figure_of_a_ring_has_a_symbol() -> None:
    wheel = rate(_pair(), LOAD).nominal.to_dict()["wheel"]
    assert set(wheel) == {*GEAR_RATING, "formula"}
    assert set(wheel["formula"]) == set(RING_FORMULA)
    owner, symbol = column_symbol("check.rating.wheel.formula.rho_F") or ("", None)
    assert owner == "wheel"
    assert symbol == RING_FORMULA["rho_F"]


# ---------------------------------------------------------------------- refused, or rated


def test_sharp_corners_are_refused() -> None:
    with pytest.raises(
        GeometryError, match=r"^wheel\.cutter\.tip_radius = 0: must be above 0\.0001 for a rating: stress has no limit"
    ):
        rate(_pair(cutter=ShaperCutter(tip_radius=0.0)), LOAD)


@pytest.mark.parametrize("wanted", [50, pytest.param(200, marks=pytest.mark.long)])
def test_random_internal_pairs_are_rated_or_refused_in_a_line(wanted: int) -> None:
    """sigma_H0 without Z_eps and Z_beta is Hertz at the pitch point, whatever the pair; sections lie within their teeth."""
    draw, rated = random.Random(16), 0
    while rated < wanted:
        teeth, helix = draw.randint(12, 60), draw.choice([0.0, draw.uniform(-40, 40)])
        shift = draw.uniform(-0.2, 0.6)
        ring = teeth + draw.randint(10, 150)
        cutter = ShaperCutter(teeth=draw.randint(12, ring - 8)) if draw.random() < 0.7 else ShaperCutter()
        common = {"normal_module": draw.choice([0.01, 0.5, 3.0, 200.0]), "helix_angle": helix}
        common["face_width"] = min(draw.uniform(2, 20) * common["normal_module"], 9000.0)
        try:
            pair = GearPair(
                pinion=Gear(teeth=teeth, profile_shift=shift, **common),
                wheel=Gear(
                    teeth=-ring,
                    profile_shift=-draw.uniform(-0.3, 1.2) + 0.2 * shift,
                    cutter=replace(cutter, profile_shift=draw.uniform(-0.1, 0.2)),
                    rack=BasicRack(addendum=draw.uniform(0.6, 1.0)),
                    **common,
                ),
            )
        except GearcadError:
            continue
        try:
            rating = rate(pair, LOAD).nominal
        except GeometryError as error:
            assert "\n" not in str(error)
            assert pair.transverse_contact_ratio < 1 or "for a rating" in str(error)
            continue
        rated += 1
        flank, root = rating.flank, rating.roots.wheel
        peak = contact_at(
            pair,
            STEEL,
            distance=pair.path_of_contact.C,
            force=rating.normal_force,
            length=pair.common_width.width / math.cos(math.radians(pair.pinion.base_helix_angle)),
        ).peak_pressure
        assert flank.nominal_stress == pytest.approx(peak * flank.contact_ratio_factor * flank.helix_angle_factor, rel=1e-9)
        pitch = math.pi * pair.wheel.normal_module
        assert 0 < root.section.chord < 1.2 * pitch
        assert root.section.moment_arm > 0
        assert root.form_factor > 0
        assert math.isfinite(root.nominal_stress)


@pytest.mark.parametrize("module", [0.5, 2.7, 8.0])
def test_thinner_teeth_widen_the_substitute_rack_of_a_ring(module: float) -> None:
    """E in modules does not depend on the module, and grows by half of the thinning."""
    ring = Gear(teeth=-75, normal_module=module, face_width=8 * module, rack=BasicRack(addendum=0.85))
    thin = replace(ring, tooth_thinning=0.06 * module)
    assert thin.dedendum == pytest.approx(1.25, rel=EXACT)
    a_n = math.radians(20)
    expected = math.pi / 4 - 1.25 * math.tan(a_n) - 0.3 * (1 - math.sin(a_n)) / math.cos(a_n)
    assert _half_width(ring, 0.3) == pytest.approx(expected, rel=EXACT)
    assert _half_width(thin, 0.3) == pytest.approx(expected + 0.03, rel=EXACT)
