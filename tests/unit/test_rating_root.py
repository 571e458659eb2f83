"""The root section against the trochoid itself, and the factors of the root stress one by one."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.ratings import STEEL, numbers, sample_pair, swapped

from gearcad import BasicRack, Body, Gear, GearPair, GeometryError, Load
from gearcad.core.records import Role
from gearcad.geometry.fillets import ToolTip
from gearcad.geometry.profile import CurveKind, Fillet
from gearcad.rating import Edition, VirtualGear, rate
from gearcad.rating.root_section import load_point, root_section
from gearcad.rating.root_stress import deep_tooth_factor, helix_angle_factor, loaded_width
from gearcad.rating.tooth_stiffness import rim_thickness_factor

EXACT = 1e-12
"""Relative: the same quantity by two formulas."""

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
