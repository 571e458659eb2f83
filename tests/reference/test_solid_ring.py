"""Solid pairs with a ring against the plane model, Hertz's ellipse and equilibrium; a ring meshed whole as a witness."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.checks import check_between_plane_states, check_ellipse, check_mirrored, check_reactions, load_tilt
from support.dense_contact import dense_contact

from gearcad import Body, FlankModification, Gear, GearPair, Material, Mounting
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.shared.bodies import BodyModel, Cuts
from gearcad.contact.solid.cycle import SolidCycle, solid_field
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.core.records import PerGear, Role
from gearcad.geometry import ShaperCutter
from gearcad.geometry.curves import CurveKind
from gearcad.meshing.outline import MeshSizes

STEEL = Material()
SECTORS = BodyModel(teeth=3, cuts=Cuts.FIXED)
FIVE = BodyModel(teeth=5, cuts=Cuts.FIXED)
"""As many as sections have at the least where flanks stay close."""

SECTION = MeshSizes(flank=0.5, corner=0.1, fillet=0.2, outline=0.6, cut=0.4, rim=6.0, growth=0.6)
QUICK = SolidSizes(section=SECTION, layer=1.4, fewest_layers=5)
"""Coarse: 7 to 12 thousand dofs a gear."""

BENT = SolidSizes(section=replace(SECTION, fillet=0.14), layer=1.4, fewest_layers=5)
"""Finer along the fillets."""

POSITIONS = 8

CUTTER = ShaperCutter(teeth=25, tip_radius=0.25)
SPUR = GearPair(
    pinion=Gear(teeth=22, normal_module=4.0, face_width=20, profile_shift=0.3),
    wheel=Gear(teeth=-70, normal_module=4.0, face_width=20, profile_shift=-0.3, tip_alteration=-0.1, cutter=CUTTER),
)
SPUR_TORQUE = 300.0

HELICAL = GearPair(
    pinion=Gear(teeth=22, normal_module=3.0, face_width=22, helix_angle=18.0, profile_shift=0.3),
    wheel=Gear(teeth=-61, normal_module=3.0, face_width=18, helix_angle=18.0, profile_shift=-0.3, cutter=CUTTER),
    axial_offset=1.0,
)
HELICAL_TORQUE = 180.0


@pytest.fixture(scope="module")
def spur() -> SolidPair:
    return solid_pair(SPUR, STEEL, body=FIVE, sizes=BENT)


@pytest.fixture(scope="module")
def helical() -> SolidPair:
    return solid_pair(HELICAL, STEEL, body=SECTORS, sizes=QUICK)


def test_spur_gear_lies_between_the_plane_states(spur: SolidPair) -> None:
    """As external ones do: thin gears are in plane stress, wide ones in plane strain. Mean root stresses differed by 1 %."""
    check_between_plane_states(spur, SPUR_TORQUE, FIVE, POSITIONS)


def test_reactions_are_the_torques(spur: SolidPair, helical: SolidPair) -> None:
    """On both hubs at every position: 0.5 % is asked. The ring is turned the way the pinion turns; its rim may be thin."""
    rim = Body(rim_diameter=SPUR.wheel.profile.root_diameter + 2.0)
    thin = solid_pair(replace(SPUR, wheel=replace(SPUR.wheel, body=rim)), STEEL, body=SECTORS, sizes=QUICK)
    for model, torque in ((spur, SPUR_TORQUE), (helical, HELICAL_TORQUE), (thin, SPUR_TORQUE)):
        check_reactions(model, torque, POSITIONS)


ASYMMETRY, BESIDE = 0.07, 0.003
"""Of these coarse meshes, in greatest responses of a tooth, by quadrature and interpolation; 0.059 and 0.002 of external gears,
and half or less on the meshes of a check."""


def test_a_load_moves_another_place_as_one_there_moves_its_own() -> None:
    """In full rings: tooth k at i by a load on tooth 0 at j is tooth -k at j by one at i."""
    for body in solid_pair(replace(HELICAL, axial_offset=0.0), STEEL, sizes=QUICK).bodies:
        weights = body.moved_weights(body.loads.places)
        greatest = np.abs(weights @ body.moved[0]).max()
        for tooth in range(body.neighbours + 1):
            one, other = weights @ body.moved[tooth], weights @ body.moved[-tooth]
            assert np.abs(one - other.T).max() < (BESIDE if tooth else ASYMMETRY) * greatest


def test_hand_does_not_matter(helical: SolidPair) -> None:
    """The mirror image in a plane across the axes has the same figures to rounding."""
    pinion, wheel = (replace(gear, helix_angle=-18.0) for gear in HELICAL.gears)
    other_hand = replace(HELICAL, pinion=pinion, wheel=wheel, axial_offset=-1.0)
    check_mirrored(helical, solid_pair(other_hand, STEEL, body=SECTORS, sizes=QUICK), HELICAL_TORQUE)


def test_one_base_pitch_is_like_the_next(helical: SolidPair) -> None:
    pitch = 360 / HELICAL.pinion.teeth
    for angle in (-3.0, 1.0):
        here, next_one = (helical.solve(angle + turn, HELICAL_TORQUE) for turn in (0.0, pitch))
        assert next_one.approach == pytest.approx(here.approach, rel=1e-9)
        assert sorted(next_one.forces) == pytest.approx(sorted(here.forces), rel=1e-6, abs=1e-6)


def test_rings_and_wheels_of_many_teeth_are_the_same_rack() -> None:
    """The same pinion, with a wheel of 2000 teeth beside it and a ring of 2000 around it, both held as deep: 1/z is left."""
    pinion = Gear(teeth=22, normal_module=3.0, face_width=18, helix_angle=18.0, profile_shift=0.2)
    cycles = []
    for side in (1, -1):
        # The hob's tip and the form root of a ring of as many teeth are both the tip of the rack.
        wheel = Gear(teeth=side * 2000, normal_module=3.0, face_width=20, helix_angle=-side * 18.0)
        body = replace(wheel.body, rim_diameter=wheel.profile.root_diameter + 24) if side < 0 else wheel.body
        pair = GearPair(pinion=pinion, wheel=replace(wheel, body=body), axial_offset=1.5)
        held = BodyModel(teeth=3, inner_diameters=PerGear(None, wheel.profile.root_diameter - 24 if side > 0 else None))
        cycles.append(SolidCycle.run(solid_pair(pair, STEEL, body=held, sizes=QUICK), HELICAL_TORQUE, 4))
    beside, around = cycles
    assert around.values("stiffness") == pytest.approx(beside.values("stiffness"), rel=0.008)
    (_, load), (_, expected_load) = around.load_along_face, beside.load_along_face
    assert np.abs(load - expected_load).max() < 0.03 * expected_load.mean()
    for one, other in zip(around.positions, beside.positions, strict=True):
        for name in ("tension", "compression"):
            found, expected = ([root.stress for root in getattr(position, name)] for position in (one, other))
            assert found == pytest.approx(expected, rel=0.015)


def test_crowned_flanks_touch_in_hertzs_ellipse(spur: SolidPair) -> None:
    """One pair at the pitch point, its ellipse well inside the face: 2 % is asked. A hollow flank has a negative radius."""
    first, second = (
        abs(diameter) / 2 * math.sin(math.radians(SPUR.working_transverse_pressure_angle))
        for diameter in SPUR.working_pitch_diameters
    )
    across = first * second / (second - first)
    for amount in (60.0, 100.0):
        crowned = replace(SPUR, wheel=replace(SPUR.wheel, modification=FlankModification(lead_crowning=amount)))
        check_ellipse(spur.remade(crowned, Mounting()), SPUR_TORQUE / 3, across, amount)


def test_an_even_load_has_hertzs_pressure(spur: SolidPair) -> None:
    """In the middle of the face, of two cylinders of infinite length with the mean load: 1 % is asked."""
    across = SPUR.path_of_contact.C
    radius = across * (across - spur.line.whole) / -spur.line.whole
    modulus = STEEL.youngs_modulus / (1 - STEEL.poisson_ratio**2) / 2
    solved = spur.solve(0.0, SPUR_TORQUE, single=True)
    middle = np.abs(solved.given.lines[0].across) < 4
    load = solved.forces[middle].sum() / solved.given.lengths[middle].sum()
    assert solved.pressures[middle].mean() == pytest.approx(math.sqrt(load * modulus / math.pi / radius), rel=0.01)


def test_misalignment_moves_the_load_and_the_rings_helix_brings_it_back(helical: SolidPair) -> None:
    """As in `test_solid_pair`; of a ring it is the other flank that carries, so its helix has to turn the other way."""

    def with_helix(amount: float) -> SolidPair:
        turned = replace(HELICAL.wheel, modification=FlankModification(helix_angle_modification=amount))
        return helical.remade(replace(HELICAL, wheel=turned), mounting)

    mounting = Mounting(misalignment=30.0)
    even, askew = load_tilt(helical, HELICAL_TORQUE), load_tilt(helical.remade(HELICAL, mounting), HELICAL_TORQUE)
    assert askew < even - 0.2
    flat = math.cos(math.radians(HELICAL.pinion.base_helix_angle))
    needed = mounting.misalignment / HELICAL.common_width.width * HELICAL.wheel.face_width / flat**2
    assert abs(load_tilt(with_helix(-needed), HELICAL_TORQUE) - even) < 0.2 * abs(askew - even)
    assert load_tilt(with_helix(needed), HELICAL_TORQUE) < askew - 0.1


def test_the_field_of_a_ring_is_that_of_the_ring_as_it_stands(helical: SolidPair) -> None:
    """The pinion turns counter-clockwise and takes the ring with it, pressing on flanks with y < 0 of teeth on +x."""
    cycle = SolidCycle.run(helical, HELICAL_TORQUE, 1)
    field = solid_field(cycle, cycle.positions[0], Role.WHEEL)
    corners = field.points[field.hexahedra[:, [0, 1, 3, 8]]]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
    assert volumes.min() > 0
    x, y, z = field.points.T
    radius, angle = np.hypot(x, y), np.degrees(np.arctan2(y, x))
    ring = HELICAL.wheel
    straight = angle - 360 * z / ring.lead  # the section turns counter-clockwise with z
    flank = (radius < ring.profile.form_diameter / 2 - 1e-6) & (radius > ring.profile.tip_diameter / 2 + 1e-6)
    inside = np.clip(radius, ring.profile.tip_diameter / 2, ring.profile.root_diameter / 2)
    surface = flank & (np.abs(np.abs(straight) - ring.profile.half_angle(inside)) < 1e-6)
    assert surface.sum() > 100
    pressed, behind = (surface & (sign * straight > 0) for sign in (-1, 1))
    assert min(field.displacement[pressed, 1].mean(), field.displacement[behind, 1].mean()) > 0
    assert field.stress[pressed, 1].min() < 3 * field.stress[behind, 1].min() < 0  # square to the flank, about


def test_edges_are_shorter_where_a_cutter_leaves_sharp_fillets() -> None:
    """And those of other gears are what they were."""
    sizes = SolidSizes()
    for gear in (*HELICAL.gears, replace(SPUR.wheel, cutter=ShaperCutter(teeth=25, tip_radius=0.1))):
        fillet = next(curve for curve in gear.profile.curves if curve.kind is CurveKind.FILLET)
        points = fillet.points(np.linspace(0, 1, 2001))
        one, two, chord = (np.hypot(*(points[k:] - points[:-k]).T) for k in (1, 1, 2))
        double = np.abs(np.linalg.det(np.stack([points[1:-1] - points[:-2], points[2:] - points[:-2]], -1)))
        least = (one[:-1] * two[1:] * chord / (2 * double)).min() / gear.normal_module  # of circles through three points
        expected = min(0.3 * least, sizes.section.fillet) if gear.internal else sizes.section.fillet
        assert sizes.section_of(gear).fillet == pytest.approx(expected, rel=1e-3)
        assert sizes.refined(2).section_of(gear).fillet == pytest.approx(expected / 2, rel=1e-3)


PAIR = GearPair(
    pinion=Gear(teeth=22, normal_module=2.0, face_width=14, profile_shift=0.3, body=Body(bore=16.0)),
    wheel=Gear(
        teeth=-70,
        normal_module=2.0,
        face_width=14,
        profile_shift=-0.3,
        tip_alteration=-0.1,
        cutter=ShaperCutter(teeth=25),
        body=Body(rim_diameter=170.0),
    ),
)
TORQUE, ROLL_ANGLE = 100.0, -5.1136

STIFFNESS, PINION, RING = 25.5317, 263.496, 210.027
"""What the witness finds with edges of 0.015 mm on flanks: N/(mm·µm) and MPa; the long test below finds it again."""

SAME_STIFFNESS, SAME_STRESS = 0.005, 0.01


@pytest.fixture(scope="module")
def model() -> PlanePair:
    return plane_pair(PAIR, Material())


def test_stiffness_and_root_stress_are_those_of_the_witness(model: PlanePair) -> None:
    position = PlaneCycle(model, TORQUE).solve(ROLL_ANGLE)
    assert position.stiffness == pytest.approx(STIFFNESS, rel=SAME_STIFFNESS)
    assert position.tension.pinion.stress == pytest.approx(PINION, rel=SAME_STRESS)
    assert position.tension.wheel.stress == pytest.approx(RING, rel=SAME_STRESS)


@pytest.mark.long
def test_the_witness_says_so_today(model: PlanePair) -> None:
    found = dense_contact(PAIR, Material(), TORQUE, model.roll_length(ROLL_ANGLE))
    assert found.stiffness == pytest.approx(STIFFNESS, rel=1e-3)
    assert found.tension == pytest.approx((PINION, RING), rel=2e-3)
    shares = [contact.force for contact in PlaneCycle(model, TORQUE).solve(ROLL_ANGLE).contacts]
    assert [force for force in found.forces if force] == pytest.approx(shares, rel=SAME_STIFFNESS)
