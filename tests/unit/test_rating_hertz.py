"""Hertz's line contact and the root section of a rating: against integrals, the trochoid, limits and known values."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.cases import STEEL, numbers, sample_pair, swapped

from gearcad import BasicRack, Body, Gear, GearPair, GeometryError, Load, Material, ParameterError
from gearcad.core.records import Role
from gearcad.geometry.curves import CurveKind, Fillet
from gearcad.geometry.fillets import ToolTip
from gearcad.rating import (
    Edition,
    LineContact,
    VirtualGear,
    base_normal_force,
    contact_at,
    pitch_point_contact,
    rate,
    reduced_modulus,
    reduced_radius,
)
from gearcad.rating.root_section import load_point, root_section
from gearcad.rating.root_stress import deep_tooth_factor, helix_angle_factor, loaded_width
from gearcad.rating.tooth_stiffness import rim_thickness_factor

EXACT = 1e-12
"""Relative: closed forms."""

SUMMED = 1e-10
"""Relative: Gauss sums over the contact width."""

CONTACT = LineContact(load_per_width=600.0, radius=5.7, modulus=113000.0, poisson_ratio=0.3)
DEPTHS = np.array([0.15, 0.4, 0.7861513777574233, 1.0, 2.0, 6.0, 50.0])

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(400)
_ANGLES = (_NODES + 1) * math.pi / 2


def _integral(contact: LineContact, kernel: np.ndarray) -> np.ndarray:
    """Integral of pressure times `kernel` (last axis: places a cos phi) over the contact width, by Gauss in phi."""
    a = contact.half_width
    pressure = np.asarray(contact.pressure(a * np.cos(_ANGLES)))
    return kernel @ (pressure * a * np.sin(_ANGLES) * _WEIGHTS * math.pi / 2)


def test_pressure_carries_the_load() -> None:
    assert _integral(CONTACT, np.ones((1, 400))) == pytest.approx(CONTACT.load_per_width, rel=SUMMED)
    # 2 P/(pi a) = p_0 and a^2 = 4 P R/(pi E*), with the numbers worked out by hand.
    assert CONTACT.peak_pressure == pytest.approx(math.sqrt(600 * 113000 / (math.pi * 5.7)), rel=EXACT)
    assert CONTACT.half_width == pytest.approx(2 * 600 / (math.pi * CONTACT.peak_pressure), rel=EXACT)
    assert (CONTACT.half_width, CONTACT.peak_pressure) == pytest.approx((0.196304, 1945.82), rel=3e-6)


def test_pressure_is_an_ellipse() -> None:
    a, p_0 = CONTACT.half_width, CONTACT.peak_pressure
    assert CONTACT.pressure(0.0) == p_0
    assert isinstance(CONTACT.pressure(0.0), float)
    assert CONTACT.pressure(np.array([-2, -1, 0.6, 0.8, 3]) * a) == pytest.approx(np.array([0, 0, 0.8, 0.6, 0]) * p_0, abs=1e-4)


def test_stresses_are_those_of_flamant_integrated() -> None:
    """Johnson 2.23: a line load under a half plane, summed over the pressure."""
    a = CONTACT.half_width
    z, s = (DEPTHS * a)[:, None], a * np.cos(_ANGLES)
    spread = 2 / math.pi / (s**2 + z**2) ** 2
    found = CONTACT.stresses(DEPTHS * a)
    assert found.sigma_z == pytest.approx(-_integral(CONTACT, spread * z**3), rel=SUMMED)
    assert found.sigma_x == pytest.approx(-_integral(CONTACT, spread * z * s**2), rel=SUMMED)
    assert found.sigma_y == pytest.approx(0.3 * (found.sigma_x + found.sigma_z), rel=EXACT)
    deviator = np.stack([found.sigma_x, found.sigma_y, found.sigma_z])
    deviator = deviator - deviator.mean(0)
    assert found.von_mises == pytest.approx(np.sqrt(1.5 * (deviator**2).sum(0)), rel=1e-11)
    spans = np.ptp(np.stack([found.sigma_x, found.sigma_y, found.sigma_z]), axis=0)
    assert found.largest_shear == pytest.approx(spans / 2, rel=1e-11)


def test_surface_and_far_field() -> None:
    a, p_0 = CONTACT.half_width, CONTACT.peak_pressure
    top = CONTACT.stresses(0.0)
    assert [float(top.sigma_x), float(top.sigma_y), float(top.sigma_z)] == pytest.approx([-p_0, -0.6 * p_0, -p_0], rel=EXACT)
    assert float(top.von_mises) == pytest.approx(0.4 * p_0, rel=EXACT)
    # Flamant: sigma_z -> -2 P/(pi z); sigma_x -> -p_0 a^3/(4 z^3), lost to rounding in the textbook's form.
    z = 1e5 * a
    deep = CONTACT.stresses(z)
    assert float(deep.sigma_z) == pytest.approx(-2 * CONTACT.load_per_width / (math.pi * z), rel=1e-9)
    assert float(deep.sigma_x) == pytest.approx(-p_0 / 4e15, rel=1e-9)


def test_greatest_stresses_of_steel() -> None:
    # Johnson 4.48 and textbooks: 0.3003 p_0 at 0.7861 a, 0.558 p_0 at 0.704 a.
    shear, mises = CONTACT.greatest_shear, CONTACT.greatest_von_mises
    assert shear.depth / CONTACT.half_width == pytest.approx(math.sqrt((math.sqrt(5) - 1) / 2), rel=EXACT)
    assert (shear.depth / CONTACT.half_width, shear.value / CONTACT.peak_pressure) == pytest.approx(
        (0.7861514, 0.3002831), abs=5e-8
    )
    assert (mises.depth / CONTACT.half_width, mises.value / CONTACT.peak_pressure) == pytest.approx(
        (0.7042917, 0.5575162), abs=5e-8
    )


@pytest.mark.parametrize("nu", [0.0, 0.1, 0.2, 0.23, 0.25, 0.3, 0.4, 0.5])
def test_nothing_on_the_axis_exceeds_the_greatest(nu: float) -> None:
    contact = replace(CONTACT, poisson_ratio=nu)
    depths = np.linspace(0, 3, 30001) * contact.half_width
    found = contact.stresses(depths)
    for values, peak in ((found.largest_shear, contact.greatest_shear), (found.von_mises, contact.greatest_von_mises)):
        best = int(np.argmax(values))
        assert peak.value == pytest.approx(values[best], rel=2e-9)  # the grid's steps of 1e-4 a
        assert peak.value >= values[best] * (1 - 1e-14)
        assert peak.depth == pytest.approx(depths[best], abs=1e-4 * contact.half_width)


def test_scaling() -> None:
    double = replace(CONTACT, load_per_width=1200.0)
    assert double.half_width / CONTACT.half_width == pytest.approx(math.sqrt(2), rel=EXACT)
    assert double.peak_pressure / CONTACT.peak_pressure == pytest.approx(math.sqrt(2), rel=EXACT)
    softer = replace(CONTACT, modulus=113000.0 / 4)
    assert softer.half_width / CONTACT.half_width == pytest.approx(2, rel=EXACT)
    assert softer.peak_pressure / CONTACT.peak_pressure == pytest.approx(1 / 2, rel=EXACT)
    flatter = replace(CONTACT, radius=5.7 * 4)
    assert flatter.half_width / CONTACT.half_width == pytest.approx(2, rel=EXACT)
    assert flatter.peak_pressure / CONTACT.peak_pressure == pytest.approx(1 / 2, rel=EXACT)


def test_reduced_values() -> None:
    assert reduced_modulus((206000.0, 206000.0), (0.3, 0.3)) == pytest.approx(206000 / 1.82, rel=EXACT)
    assert reduced_modulus((206000.0, 1e30), (0.3, 0.0)) == pytest.approx(206000 / 0.91, rel=EXACT)
    assert reduced_modulus((206000.0, 70000.0), (0.3, 0.33)) == pytest.approx(1 / (0.91 / 206000 + 0.8911 / 70000), rel=EXACT)
    assert reduced_radius((3.0, 6.0)) == pytest.approx(2, rel=EXACT)


def test_results_are_read_only() -> None:
    found = CONTACT.stresses([0.0, 0.1])
    with pytest.raises(ValueError, match="read-only"):
        found.sigma_x[0] = 1.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"load_per_width": 0.0}, "load_per_width = 0 N/mm: must be a number above 0 N/mm"),
        ({"radius": -1.0}, "radius = -1 mm: must be a number above 0 mm"),
        ({"modulus": math.nan}, "modulus = nan MPa: must be a number above 0 MPa"),
        ({"poisson_ratio": 0.6}, "poisson_ratio = 0.6: must be a number at least 0 and at most 0.5"),
    ],
)
def test_refuses(change: dict[str, float], message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        replace(CONTACT, **change)
    assert str(caught.value) == message


@pytest.mark.parametrize("depth", [-0.1, [0.0, -0.1], math.nan])
def test_refuses_a_place_above_the_surface(depth: object) -> None:
    with pytest.raises(ParameterError, match=r"^depth = (-0.1|nan) mm: must be a number at least 0 mm$"):
        CONTACT.stresses(depth)  # type: ignore[arg-type]


# ---------------------------------------------------------------------- in mesh


def _pair(helix: float = 0.0) -> GearPair:
    pinion = Gear(teeth=19, normal_module=3.0, face_width=32.0, helix_angle=helix, profile_shift=0.35)
    return GearPair(pinion=pinion, wheel=replace(pinion, teeth=47, face_width=28.0, helix_angle=-helix, profile_shift=-0.12))


def test_radii_add_up_along_the_line_of_action() -> None:
    pair, steel = _pair(15.0), Material(youngs_modulus=206000.0)
    lean = math.cos(math.radians(pair.pinion.base_helix_angle))
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    for distance in (0.3 * whole, pair.path_of_contact.C, 0.8 * whole):
        contact = contact_at(pair, steel, distance=distance, force=9000.0)
        assert contact.radius == pytest.approx(distance * (whole - distance) / whole / lean, rel=EXACT)
        assert contact.load_per_width == pytest.approx(9000 / (28 / lean), rel=EXACT)
        assert contact.modulus == pytest.approx(206000 / 1.82, rel=EXACT)


def test_force_on_the_base_tangent_plane() -> None:
    pair = _pair(15.0)
    force = base_normal_force(pair, -350.0)
    # 350 N·m over the lever r_b1 of the transverse part of the force.
    lever = pair.pinion.base_diameter / 2000 * math.cos(math.radians(pair.pinion.base_helix_angle))
    assert force * lever == pytest.approx(350, rel=EXACT)


def test_pitch_point_of_a_spur_pair_bears_all_on_one_tooth() -> None:
    pair = _pair()
    contact = pitch_point_contact(pair, Material(poisson_ratio=0.25), 350.0)
    assert contact.load_per_width == pytest.approx(base_normal_force(pair, 350.0) / 28, rel=EXACT)
    assert contact.poisson_ratio == 0.25


@pytest.mark.parametrize("distance", [0.0, -1.0, 40.0, math.nan])
def test_contact_outside_the_base_tangent_points(distance: float) -> None:
    permitted = r"must be above 0 and below \d\d\.\d+ mm, between the base tangent points T1 and T2$"
    with pytest.raises(GeometryError, match=permitted):
        contact_at(_pair(), Material(), distance=distance, force=1.0)


SEEN = 1e-7
"""Relative: from differences between neighbouring points of a curve."""

LOAD = Load(torque=350.0)


def _fillet(gear: Gear) -> Fillet:
    """The fillet of the virtual gear, cut by the same tool; of a spur gear it is the profile's own."""
    if gear.helix_angle == 0:
        (fillet,) = (curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET)
        assert isinstance(fillet, Fillet)
        return fillet
    m, shift = gear.normal_module, gear.profile_shift * gear.normal_module
    tool = ToolTip.cutting(
        normal_module=m,
        pressure_angle=math.radians(gear.rack.pressure_angle),
        helix_angle=0.0,
        reference_radius=m * gear.virtual_teeth / 2,
        depth=gear.dedendum * m - shift,
        shift=shift,
        radius=gear.root_radius * m,
        thinning=gear.tooth_thinning,
    )
    return Fillet(tool, tool.last_angle, math.pi / gear.virtual_teeth)


def _section_seen(fillet: Fillet) -> tuple[float, float, float]:
    """Distance from the axis, half chord and radius of curvature where the outline leans by 30 degrees, all from points."""

    def points(s: float) -> np.ndarray:
        return np.asarray(fillet.points(np.array([s - 1e-4, s, s + 1e-4])))

    low, high = 1e-3, 1 - 1e-3
    for _ in range(60):
        middle = (low + high) / 2
        before, _, after = points(middle)
        lean = math.atan2(before[1] - after[1], after[0] - before[0])
        low, high = (middle, high) if lean > math.pi / 6 else (low, middle)
    before, there, after = points(low)
    sides = [math.dist(before, there), math.dist(there, after), math.dist(after, before)]
    area = abs((there[0] - before[0]) * (after[1] - before[1]) - (there[1] - before[1]) * (after[0] - before[0])) / 2
    return there[0], there[1], math.prod(sides) / (4 * area)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"tooth_thinning": 0.1},
        {"rack": BasicRack(dedendum=1.4, root_radius="full")},
        {"rack": BasicRack(pressure_angle=25.0, root_radius=0.2)},
        {"rack": BasicRack(root_radius=0.0)},
    ],
)
@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_root_section_lies_on_the_trochoid(helix: float, changes: dict[str, Any]) -> None:
    pair = sample_pair(helix, **changes)
    rating = rate(pair, STEEL, LOAD)
    for gear, root in ((pair.pinion, rating.roots.pinion), (pair.wheel, rating.roots.wheel)):
        height, half_chord, radius = _section_seen(_fillet(gear))
        section, load = root.section, root.load_point
        assert section.on_fillet
        assert section.chord == pytest.approx(2 * half_chord, rel=SEEN)
        assert section.fillet_radius == pytest.approx(radius, rel=1e-5)
        # The load acts along a tangent of the base circle, so it meets the middle of the tooth at r_b/cos alpha_Fen.
        base = gear.normal_module * gear.virtual_teeth / 2 * math.cos(math.radians(gear.rack.pressure_angle))
        meets = base / math.cos(math.radians(load.load_angle))
        assert section.moment_arm == pytest.approx(meets - height, rel=1e-6)


def test_load_acts_at_the_outer_point_of_single_contact() -> None:
    pair = sample_pair(0.0, tooth_thinning=0.05, body=Body(tip_chamfer=0.2))
    rating = rate(pair, STEEL, LOAD)
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    path = pair.path_of_contact
    for gear, root, place in ((pair.pinion, rating.roots.pinion, path.D), (pair.wheel, rating.roots.wheel, whole - path.B)):
        diameter = math.hypot(gear.base_diameter, 2 * place)
        assert root.load_point.diameter == pytest.approx(diameter, rel=EXACT)
        assert root.load_point.half_angle == pytest.approx(gear.profile.half_angle(diameter / 2), rel=1e-11)
        slope = math.degrees(math.atan2(2 * place, gear.base_diameter)) - gear.profile.half_angle(diameter / 2)
        assert root.load_point.load_angle == pytest.approx(slope, rel=1e-11)


def test_prescribed_root_circle_is_that_of_the_tool() -> None:
    plain = sample_pair(0.0)
    deep = replace(plain, wheel=replace(plain.wheel, rack=BasicRack(dedendum=1.35)))
    same = replace(plain, wheel=replace(plain.wheel, root_diameter=float(deep.wheel.root_diameter)))
    expected, found = (numbers(rate(pair, STEEL, LOAD).to_dict()) for pair in (deep, same))
    assert found == pytest.approx(expected, rel=1e-11)


def test_undercut() -> None:
    gear = Gear(teeth=8, normal_module=2.0, face_width=20.0)
    pair = GearPair(pinion=gear, wheel=replace(gear, teeth=30, rack=BasicRack(addendum=0.8)))
    rating = rate(pair, STEEL, LOAD)
    expected = f"the tips reach {pair.transverse_contact_ratio:.4f}, which the rating uses, but the fillets leave"
    assert any(expected in warning for warning in rating.warnings)
    # The section lies below what undercut takes away.
    section, height = rating.roots.pinion.section, _section_seen(_fillet(gear))[0]
    assert section.on_fillet
    assert 2 * math.hypot(section.chord / 2, height) < gear.form_diameter


def test_refuses_teeth_without_a_section() -> None:
    """Three teeth cut by a tool without a tip land: their fillets meet in the middle of the space at 30 degrees."""
    wheel = Gear(teeth=3, normal_module=2.0, face_width=40.0, tip_alteration=-0.2, rack=BasicRack(root_radius="full"))
    load_at = load_point(VirtualGear.of(wheel), 1.2)
    with pytest.raises(GeometryError, match=r"^teeth = 3: must be more for a rating: no tangent at 30 deg touches the fillet$"):
        root_section(wheel, VirtualGear.of(wheel), load_at)


# ---------------------------------------------------------------------- the factors one by one


def test_root_factors() -> None:
    helical = [helix_angle_factor(*given) for given in ((0, 0.0), (-24, 0.5), (45, 3.0))]
    assert helical == pytest.approx([1, 0.9, 0.75], rel=EXACT)
    iso, din = Edition.ISO_2006, Edition.DIN_1987
    # The branches meet at 1.2, 2.05 and 2.5 as far as the standard's rounded numbers do.
    rims = [rim_thickness_factor(ratio, iso) for ratio in (5.0, 1.2, 1.2 - 1e-12, 0.8)]
    assert rims == pytest.approx([1, 1, 1, 1.6 * math.log(2.242 / 0.8)], abs=1e-4)
    deep = [deep_tooth_factor(ratio, 4, iso) for ratio in (1.6, 2.05, 2.05 + 1e-12, 2.2, 2.5, 2.6)]
    assert deep == pytest.approx([1, 1, 1.0007, 0.9008, 0.701, 0.7], abs=1e-9)
    assert deep_tooth_factor(2.3, 5, iso) == deep_tooth_factor(2.3, 4, din) == 1
    assert rim_thickness_factor(0.8, din) == 1


@pytest.mark.parametrize(
    ("widths", "offset", "expected"),
    [
        ((32.0, 28.0), 0.0, (32, 28)),
        ((40.0, 28.0), 0.0, (34, 28)),
        ((40.0, 28.0), 5.0, (32, 28)),
        ((30.0, 28.0), 4.0, (28, 28)),
    ],
)
def test_widths_that_carry(widths: tuple[float, float], offset: float, expected: tuple[float, float]) -> None:
    """The common width and at most one module (3 mm) more at either end."""
    plain = sample_pair()
    gears = [replace(gear, face_width=width) for gear, width in zip((plain.pinion, plain.wheel), widths, strict=True)]
    pair = replace(plain, pinion=gears[0], wheel=gears[1], axial_offset=offset)
    assert [loaded_width(pair, role) for role in Role] == pytest.approx(expected, rel=EXACT)
    assert [loaded_width(swapped(pair), role.mate) for role in Role] == pytest.approx(expected, rel=EXACT)
