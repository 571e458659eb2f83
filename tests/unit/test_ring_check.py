"""The check of a pair with a ring, in the plane: what it says of the rim, of bolts, and of flanks that are nearly alike."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.check.comparison import ComparisonRole
from gearcad.check.gates import compare_plane
from gearcad.check.options import CheckOptions
from gearcad.check.result import CheckResult
from gearcad.check.run import check_pair
from gearcad.check.task import check_task
from gearcad.contact.plane.cycle import PlaneCycle, conformal
from gearcad.contact.plane.flank import PlaneCompliance, flank_compliance
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.plane.ring import assemble
from gearcad.contact.plane.sector import PlaneElasticity
from gearcad.contact.shared.bodies import BodyModel, Cuts, Hold, Support, support_of
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear
from gearcad.geometry import ShaperCutter
from gearcad.meshing.outline import MeshSizes
from gearcad.meshing.sector import mesh_sector
from gearcad.plots.gears import pair_inches, plot_pair

STEEL = Material()
ON_BOLTS = {"bolt_circle": 160.0, "bolt_holes": 8, "bolt_diameter": 5.0}
RING = Gear(
    teeth=-70,
    normal_module=2.0,
    face_width=14,
    profile_shift=-0.3,
    tip_alteration=-0.1,
    cutter=ShaperCutter(teeth=25),
    body=Body(rim_diameter=170.0, **ON_BOLTS),
)
PAIR = GearPair(pinion=Gear(teeth=22, normal_module=2.0, face_width=14, profile_shift=0.3, body=Body(bore=16.0)), wheel=RING)
FEW = CheckOptions(convergence="off", torques=(100.0,), positions=16)
NEARLY_ALIKE = GearPair(
    pinion=Gear(teeth=40, normal_module=2.0, face_width=14, tip_alteration=-0.2),
    wheel=Gear(teeth=-60, normal_module=2.0, face_width=14, tip_alteration=-0.3, cutter=ShaperCutter(teeth=15)),
)


def ring(**body: Any) -> GearPair:
    return replace(PAIR, wheel=replace(RING, body=Body(**body)))


def said(result: CheckResult, code: str) -> str:
    return " ".join(notice.text for notice in result.notices if notice.code == code)


@pytest.fixture(scope="module")
def result() -> CheckResult:
    return check_pair(check_task(PAIR, STEEL, Load(torque=100.0), FEW))


def test_a_pair_with_a_ring_is_checked_like_any_other(result: CheckResult) -> None:
    gates = {each.quantity: each for each in result.comparisons if each.role is ComparisonRole.GATE}
    assert result.passed
    assert gates["torque reaction of the wheel"].reference == pytest.approx(100 * 70 / 22, rel=1e-12)
    assert {"peak contact pressure", "half width of contact", "torque reaction of the pinion"} < gates.keys()
    assert result.bodies["wheel"] == "full ring, held on diameter 170 mm"
    assert not said(result, "no-rim") and not said(result, "rigid-rim") and not said(result, "conformal-contact")
    depths = result.explanations.stiffness.rim_depths
    assert depths.wheel == pytest.approx((170 - abs(RING.root_diameter)) / 2 / 2.0, rel=1e-9)


def test_torsional_stiffness_of_both_gears_is_that_of_their_parts_of_the_approach(result: CheckResult) -> None:
    (point,) = result.sweep
    parts = result.mean_lag.parts
    assert point.torsional_stiffness.wheel / point.torsional_stiffness.pinion == pytest.approx(
        (70 / 22) ** 2 * parts.pinion / parts.wheel, rel=0.01
    )


def test_a_ring_without_a_rim_is_held_three_and_a_half_modules_outside_its_roots() -> None:
    bare = check_pair(check_task(ring(), STEEL, Load(torque=100.0), FEW))
    diameter = abs(RING.root_diameter) + 14.0
    assert bare.bodies["wheel"] == f"full ring, held on diameter {diameter:g} mm"
    assert f"held on diameter {diameter:g} mm, 3.5 m_n outside its roots" in said(bare, "no-rim")


def test_a_thin_rim_and_bolts_are_told() -> None:
    thin = check_pair(check_task(ring(rim_diameter=155.0), STEEL, Load(torque=100.0), FEW))
    thickness = (155 - abs(RING.root_diameter)) / 4
    assert f"the ring's rim ({thickness:.3g} m_n, below 3.5) is held all round" in said(thin, "rigid-rim")
    bolted = check_pair(check_task(PAIR, STEEL, Load(torque=100.0), replace(FEW, wheel_support="bolts")))
    assert bolted.bodies["wheel"] == "full ring, held by 8 bolts on diameter 160 mm, the loaded tooth midway between two"
    assert "root stresses are those of the loaded teeth" in said(bolted, "bolted-ring")
    assert bolted.passed


@pytest.mark.parametrize(
    "body, options, message",
    [
        ({}, {"wheel_support": "bolts"}, r"^wheel\.body\.bolt_circle = 0 mm: must be given where bolts hold the ring"),
        ({}, {"wheel_support": "free"}, r"^check\.wheel_support = 'free': must be \"rigid\" or \"bolts\": a ring is held on"),
        ({}, {"wheel_support": "shaft"}, r"^check\.wheel_support = 'shaft': must be \"rigid\" or \"bolts\""),
        ({}, {"wheel_support": "key"}, r"^check\.wheel_support = 'key': must be \"rigid\" or \"bolts\""),
        ({}, {"pinion_support": "bolts"}, r"^check\.pinion_support = 'bolts': must be .*: bolts hold rings only"),
        ({}, {"wheel_inner_diameter": 160.0}, r"inner_diameter = 160 mm: must be left out: a ring is held on body.rim_diam"),
        (ON_BOLTS | {"bolt_holes": 1}, {"wheel_support": "bolts"}, r"^wheel\.body\.bolt_holes = 1: must be at least 2"),
    ],
)
def test_what_cannot_hold_a_ring_is_refused(body: dict[str, Any], options: dict[str, Any], message: str) -> None:
    with pytest.raises((ParameterError, GeometryError), match=message):
        check_pair(check_task(ring(rim_diameter=170.0, **body), STEEL, Load(torque=100.0), replace(FEW, **options)))


# Bolts


def bolted_body(bolts: int, neighbours: int, teeth: int = 41) -> PlaneCompliance:
    gear = Gear(teeth=-teeth, normal_module=2.0, face_width=10, tip_alteration=-0.3, cutter=ShaperCutter(teeth=15))
    gear = replace(gear, body=Body(rim_diameter=100.0, bolt_circle=95.0, bolt_holes=bolts, bolt_diameter=1.0))
    elasticity, mesh = PlaneElasticity(STEEL), mesh_sector(gear, 50.0, MeshSizes().coarse())
    support = support_of(gear, 50.0, Hold.BOLTS)
    return flank_compliance(gear, assemble(mesh, mesh, teeth, neighbours, elasticity, None, Cuts.FIXED, support), elasticity)


def test_sectors_on_bolts_in_a_row_are_what_they_are_in_full() -> None:
    """Condensed one after the other, held and free ones as the bolts stand, or all of the ring at once."""
    chained, whole = bolted_body(5, 1), bolted_body(5, 20)
    assert chained.displacements == pytest.approx(whole.displacements[19:22], rel=1e-9, abs=1e-12)
    assert chained.torques == pytest.approx(whole.torques, rel=1e-9)
    middle = chained.loads[len(chained.loads) // 2 :][:1]
    assert chained.hub_torque(float(middle[0])) == pytest.approx(chained.flank.base_radius, rel=2e-4)


@pytest.mark.parametrize(("bolts", "teeth"), [(2, 41), (5, 41), (6, 60), (8, 70), (41, 41), (70, 70)])
def test_bolts_stand_evenly_with_the_loaded_tooth_between_two(bolts: int, teeth: int) -> None:
    support = Support(Hold.BOLTS, teeth, bolts=bolts, bolt_circle=90.0)
    held = [tooth for tooth in range(teeth) if support.holds(tooth)]
    assert len(held) == bolts
    places = (np.arange(bolts) + 0.5) * teeth / bolts
    away = [abs(tooth - place) for tooth, place in zip(held, sorted(places % teeth), strict=True)]
    apart = [min(each, teeth - each) for each in away]
    assert max(apart) <= 0.5 or bolts == teeth


def test_the_fewer_bolts_the_softer_the_ring_and_bolts_at_every_tooth_are_a_housing() -> None:
    found = []
    for bolts in (70, 8):
        body = Body(rim_diameter=170.0, bolt_circle=169.0, bolt_holes=bolts, bolt_diameter=0.1)
        pair, model = replace(PAIR, wheel=replace(RING, body=body)), BodyModel(holds=PerGear(Hold.AUTO, Hold.BOLTS))
        found.append(PlaneCycle(plane_pair(pair, STEEL, body=model), 100.0).solve(-4.0).stiffness)
    rigid = PlaneCycle(plane_pair(PAIR, STEEL), 100.0).solve(-4.0).stiffness
    assert rigid > found[0] > 1.1 * found[1]
    assert found[0] == pytest.approx(rigid, rel=0.005)


# Flanks that are nearly alike


def test_wide_contacts_are_told_and_not_held_against_cylinders(monkeypatch: pytest.MonkeyPatch) -> None:
    heavy = check_pair(check_task(PAIR, STEEL, Load(torque=400.0), FEW))
    wide = [contact for _, contact in heavy.cycle.interior_contacts if conformal(contact)]
    assert 0 < len(wide) < len(list(heavy.cycle.interior_contacts))
    assert "Hertz can be more than 1 % off" in said(heavy, "conformal-contact")
    monkeypatch.setattr("gearcad.contact.shared.local_contact._WIDE", 0.01)
    found = {each.quantity: each for each in compare_plane(heavy.task, heavy.cycle, heavy.summary, ())}
    assert found["peak contact pressure"].role is ComparisonRole.INFORMATION
    assert found["torque reaction of the wheel"].role is ComparisonRole.GATE


def test_more_pairs_touch_as_nearly_alike_flanks_stay_close() -> None:
    """Teeth further away than the path of contact can reach take part, and each feels all others."""
    model = plane_pair(NEARLY_ALIKE, STEEL)
    carry = max(len(PlaneCycle(model, 600.0).solve(angle).contacts) for angle in (-4.0, -2.0, 0.0, 2.0))
    assert NEARLY_ALIKE.transverse_contact_ratio < 2 < 3 <= carry <= model.pinion.neighbours + 1


# The picture


def test_picture_of_a_pinion_in_its_ring() -> None:
    assert pair_inches(PAIR)[1] == 5.0
    axes = plot_pair(PAIR)
    filled = next(patch for patch in axes.patches if type(patch).__name__ == "PathPatch")
    points = filled.get_path().vertices - [PAIR.centre_distance, 0.0]
    radii = np.hypot(*points.T)
    assert filled.get_path().get_extents().width == pytest.approx(170.0, rel=1e-3)
    assert radii[radii < 80].min() == pytest.approx(abs(RING.tip_diameter) / 2, rel=1e-9)
    low, high = axes.get_xlim()
    assert low < PAIR.centre_distance - 85 and PAIR.centre_distance + 85 < high
    # No point of the ring lies inside a tooth of the pinion.
    space = filled.get_path().vertices[radii < 80]
    near = space[np.hypot(*space.T) < PAIR.pinion.tip_diameter / 2]
    angle, pitch = np.arctan2(near[:, 1], near[:, 0]), 2 * math.pi / 22
    half = np.radians(PAIR.pinion.profile.half_angle(np.clip(np.hypot(*near.T), 20.11, 24.6)))
    assert (np.abs((angle + pitch / 2) % pitch - pitch / 2) - half).min() > -0.02 / 22
