"""What a plane check says of rims, bolts, rings, thin faces and roots wider than the mesh."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from support.checks import small_check

from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.check.comparison import ComparisonRole, Subject
from gearcad.check.gates import compare_plane, standards
from gearcad.check.options import CheckOptions
from gearcad.check.result import CheckResult
from gearcad.check.run import check_pair, plane_notices
from gearcad.check.summary import SummaryFigures, figures
from gearcad.check.task import CheckTask, check_task
from gearcad.contact.plane.cycle import PlaneCycle, conformal
from gearcad.contact.plane.flank import PlaneCompliance, flank_compliance
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.plane.ring import assemble
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.shared.bodies import BodyModel, Cuts, Hold, Support, support_of
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidSizes, solid_pair
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear, texts
from gearcad.geometry import ShaperCutter
from gearcad.meshing.outline import MeshSizes
from gearcad.meshing.sector import mesh_sector
from gearcad.plots.gears import pair_inches, plot_pair
from gearcad.rating import Edition, RatingOptions
from gearcad.stiffness import PlaneStrainContact, PlaneStressContact, StrainEnergy

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


LIMIT = 300.0
"""MPa: above the greatest root tension of the thin rim at half the load, below its compression."""


def _checked(bore: float, load: float = 150.0, **options: Any) -> CheckResult:
    """The FZG pair, its pinion with a bore of 50 mm at half the load of stage 9."""
    pinion = Gear(teeth=16, normal_module=4.5, face_width=14, profile_shift=0.1817, body=Body(bore=bore))
    wheel = replace(pinion, teeth=24, profile_shift=0.1715, body=Body(bore=30))
    chosen = CheckOptions(convergence="off", torques=(load,), positions=12, **options)
    material = Material(root_limit=LIMIT)
    return check_pair(check_task(GearPair(pinion=pinion, wheel=wheel), material, Load(torque=load), chosen))


def _gate(result: CheckResult, quantity: str) -> Any:
    return next((each for each in result.comparisons if each.quantity == quantity), None)


def test_a_thin_rim_held_rigidly_fails_the_check_and_a_free_one_is_judged_by_what_it_bends() -> None:
    rigid, free = _checked(50, pinion_support="rigid"), _checked(50)
    gate = _gate(rigid, "tooth depth over rim, pinion")
    assert not gate.passed and not rigid.passed
    pinion = rigid.pair.pinion
    ratio = (pinion.root_diameter / 2 - 25) / ((pinion.tip_diameter - pinion.root_diameter) / 2)
    assert gate.computed == pytest.approx(1 / ratio, rel=1e-12)
    assert any("held rigidly" in each for each in rigid.warnings)
    assert rigid.summary.bore_tension_pinion is None
    assert _gate(free, "tooth depth over rim, pinion") is None
    assert "free" in free.bodies["pinion"]
    compression = _gate(free, "root compression, pinion")
    assert compression.computed == -free.summary.root_compression.pinion > LIMIT > free.summary.root_tension.pinion
    assert not compression.passed
    bore = free.summary.bore_tension_pinion
    assert _gate(free, "tension on the bore, pinion").computed == bore
    assert any(f"bore is {bore:.0f} MPa" in each and f"{ratio:.3g} tooth depths" in each for each in free.warnings)
    notes = {each.quantity: each.note for each in free.comparisons if each.subject is Subject.STANDARD}
    assert f"({free.summary.root_compression.pinion:.0f} MPa)" in notes["root stress, pinion"]
    assert "Y_B" not in notes["root stress, wheel"]
    # The wheel is thick, and nobody bends it.
    assert _gate(free, "root compression, wheel") is None
    assert free.summary.bore_tension_wheel is None


def test_hertz_holds_for_flanks_of_a_rim_that_bends() -> None:
    """The rim turns the tooth, so that other parts of its involute meet: their curvature is what is compared."""
    free = _checked(50, load=302.0)
    assert _gate(free, "peak contact pressure").passed
    assert _gate(free, "half width of contact").passed


def test_solid_bodies_know_no_shaft_and_no_key() -> None:
    keyed = Gear(teeth=16, normal_module=4.5, face_width=14, body=Body(bore=45, keyway_width=10, keyway_depth=2))
    pair = GearPair(pinion=keyed, wheel=replace(keyed, teeth=24))
    assert [each.hold for each in BodyModel().supports(pair)] == [Hold.KEY, Hold.RIGID]
    assert [each.hold for each in BodyModel().for_solids().supports(pair)] == [Hold.FREE, Hold.RIGID]
    with pytest.raises(ParameterError, match=r'pinion_support.*must be "rigid" or "free" for solid bodies'):
        BodyModel(holds=PerGear(Hold.SHAFT, Hold.AUTO)).for_solids().supports(pair)


@pytest.mark.long
def test_solid_rims_bend_like_those_of_a_plane() -> None:
    """A spur gear of 14 mm: the solid one a little more at the root, where the load is uneven, as a thick one is too."""
    thick, plane, solid = (
        _checked(bore, model=model, refinement=fineness).summary
        for bore, model, fineness in ((30.0, "2d", 1.0), (50.0, "2d", 1.0), (50.0, "3d", 0.7))
    )
    assert plane.root_compression.pinion < 1.5 * thick.root_compression.pinion
    assert solid.root_compression.pinion == pytest.approx(plane.root_compression.pinion, rel=0.05)
    assert solid.bore_tension_pinion == pytest.approx(plane.bore_tension_pinion, rel=0.05)
    assert solid.mesh_stiffness_mean == pytest.approx(plane.mesh_stiffness_mean, rel=0.06)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"pinion_support": "loose"}, "pinion_support.*'rigid'.*'free'"),
        ({"wheel_support": ["free"]}, "wheel_support"),
        ({"shaft_modulus": 0.0}, "shaft_modulus"),
        ({"wheel_shaft_bore": -1.0}, "wheel_shaft_bore"),
    ],
)
def test_options_of_a_support(options: Any, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        CheckOptions(**options)


STRAIN, STRESS = (PlaneElasticity(Material(), plane) for plane in Plane)


def task_of(pair: GearPair, **changes: object) -> CheckTask:
    """The task of a small check with another pair, and changes."""
    return replace(small_check().task, pair=pair, **changes)


def fzg(pinion_width: float, wheel_width: float) -> GearPair:
    """FZG's C gears in other widths; the teeth of both are 7.66 and 7.63 mm thick."""
    pinion, wheel = (
        Gear(teeth=teeth, normal_module=4.5, profile_shift=shift, face_width=width, body=Body(bore=30))
        for teeth, shift, width in ((16, 0.1817, pinion_width), (24, 0.1715, wheel_width))
    )
    return GearPair(pinion=pinion, wheel=wheel)


def plane_texts(task: CheckTask, elasticity: PlaneElasticity) -> tuple[str, ...]:
    plane = "strain" if elasticity.plane is Plane.STRAIN else "stress"
    return texts(plane_notices(replace(task, material=elasticity.material, options=replace(task.options, plane=plane))))


def test_a_face_thinner_than_its_teeth_is_told() -> None:
    thin, wide = plane_texts(task_of(fzg(14.0, 7.0)), STRAIN)
    assert thin.startswith("the wheel's face width of 7 mm is below its tooth thickness, 7.63 mm: so thin a body is nearer to ")
    assert "up to 9 % too stiff" in thin
    assert wide.startswith("the pinion is 14 mm wide, and the plane model has the 7 mm in mesh; by ISO 6336-3 14 mm carry")
    assert plane_texts(task_of(fzg(14.0, 14.0)), STRAIN) == ()
    (pressure,) = plane_texts(task_of(fzg(5.0, 5.0)), STRESS)
    assert pressure == "plane stress: the contact itself stays in plane strain, where its pressure is up to 4.8 % higher"


def test_methods_in_plane_strain_tell_a_thin_face() -> None:
    load = Load(torque=10.0)
    for method in (PlaneStrainContact, StrainEnergy):
        (thin,) = method(pair=fzg(7.0, 14.0)).notices(load)
        assert thin.code == "thin-face" and "nearer to plane stress" in thin.text
        assert not list(method(pair=fzg(14.0, 14.0)).notices(load))
    assert not list(PlaneStressContact(pair=fzg(7.0, 14.0)).notices(load))


def test_a_wider_root_is_told() -> None:
    """16 mm on 14 mm: ISO's root carries on all of it, at most m_n on either side; by the standard asked for."""
    (found,) = plane_texts(task_of(fzg(16.0, 14.0)), STRAIN)
    assert found == (
        "the pinion is 16 mm wide, and the plane model has the 14 mm in mesh; by ISO 6336-3 16 mm carry at its root, with 12 % "
        "less stress; --model 3d has the whole width"
    )
    german = task_of(fzg(14.0, 40.0), rating_options=RatingOptions(standard=Edition.DIN_1987))
    (found,) = plane_texts(german, STRAIN)
    assert "the wheel is 40 mm wide" in found and "by DIN 3990-3 23 mm carry" in found
    source = next(each.source for each in standards(german, small_check().summary) if each.quantity == "root stress, wheel")
    assert source == "sigma_F0, DIN 3990-3:1987 Method B, over b = 23 mm"


@pytest.mark.long
def test_solid_bodies_show_what_is_told() -> None:
    """A thin pair is almost as soft as in plane stress; a pinion that stands over has less stress at its root."""

    def solid(pair: GearPair, torque: float) -> SummaryFigures:
        return figures(SolidCycle.run(solid_pair(pair, Material(), sizes=SolidSizes().refined(0.8)), torque, 12))

    strain, stress = (figures(PlaneCycle.run(plane_pair(fzg(1.5, 1.5), Material(), plane=plane), 32.4, 12)) for plane in Plane)
    thin = solid(fzg(1.5, 1.5), 32.4)
    assert thin.mesh_stiffness - stress.mesh_stiffness < 0.2 * (strain.mesh_stiffness - stress.mesh_stiffness)
    # 4.5 mm on both sides, one module: ISO has 14/23 = 0.61 of the stress.
    even, wider = solid(fzg(14.0, 14.0), 302.0), solid(fzg(23.0, 14.0), 302.0)
    assert wider.root_tension.pinion / even.root_tension.pinion == pytest.approx(0.705, abs=0.01)
    assert wider.root_tension.wheel == pytest.approx(even.root_tension.wheel, rel=0.01)
