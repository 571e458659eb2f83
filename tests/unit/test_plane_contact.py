"""The contact of two flanks: two cylinders against Hertz, the complementarity, gaps, and which teeth can touch."""

import itertools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import nnls
from support.dense_contact import involute, pair_of_tooth_0

from gearcad import BasicRack, FlankModification, Gear, GearPair, Material, ReliefShape
from gearcad.contact.plane.cycle import PlaneCycle, greatest_von_mises, strip_stresses
from gearcad.contact.plane.pair import (
    ContactCells,
    ContactPair,
    PlanePair,
    compliance_matrix,
    contact_pairs,
    plane_pair,
    solve_contact,
)
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.line_of_action import LineOfAction, line_of_action, rigid_approach
from gearcad.contact.shared.local_contact import onsets, rounded_kink_pressure
from gearcad.core.complementarity import complementary
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.rating import LineContact, reduced_modulus

STEEL = Material()

HERTZ = 0.005
"""Cells of a ninth of the half width, as the product uses them, are this close to Hertz."""


@dataclass(frozen=True)
class HalfPlane:
    """A body that is nothing but the straight edge: what contact.py wants of one, with no smooth rest."""

    elasticity: PlaneElasticity
    neighbours: int = 1
    edge_taken_off: bool = True

    def by_unit_loads(self, lengths: Any) -> Any:
        return np.zeros((len(lengths), 2 * self.neighbours + 1, 1))

    def parts_of_loads(self, lengths: Any) -> Any:
        return np.zeros((len(lengths), 1))


def cylinders(radius: float, half_width: float, count: int, *, shift: float = 0.0, tooth: int = 0) -> ContactPair:
    """Two cylinders of reduced radius `radius` (mm) under cells over three half widths; `shift` (mm) off the middle."""
    width = 6 * half_width / count
    place = (np.arange(count) - (count - 1) / 2) * width + shift
    lengths = PerGear(2 * radius + place, 2 * radius - place)
    cells = ContactCells(place, width, lengths, place**2 / 2 / radius + width**2 / 24 / radius)
    return ContactPair(tooth, PerGear(2 * radius, 2 * radius), cells)


def hertz(force: float, radius: float, bodies: tuple[HalfPlane, HalfPlane]) -> LineContact:
    materials = [body.elasticity.material for body in bodies]
    modulus = reduced_modulus(
        (materials[0].youngs_modulus, materials[1].youngs_modulus), (materials[0].poisson_ratio, materials[1].poisson_ratio)
    )
    return LineContact(load_per_width=force, radius=radius, modulus=modulus)


TWO_BODIES = PerGear(
    HalfPlane(PlaneElasticity(STEEL)),
    HalfPlane(PlaneElasticity(Material(youngs_modulus=70e3, poisson_ratio=0.34))),
)


@pytest.mark.parametrize("shift", [0.0, 0.37])
@pytest.mark.parametrize(("force", "radius"), [(100.0, 5.0), (1500.0, 12.0), (0.5, 0.2)])
def test_two_cylinders(force: float, radius: float, shift: float) -> None:
    """Pressure everywhere, its peak, and where it ends; steel on aluminium, the window centred or not."""
    expected = hertz(force, radius, TWO_BODIES)
    pair = cylinders(radius, expected.half_width, 66, shift=shift * expected.half_width)
    solution = solve_contact((pair,), TWO_BODIES, force)
    (pressure,), cells = solution.pressures, pair.cells
    assert pressure.sum() * cells.width == pytest.approx(force, rel=1e-12)
    assert pressure.max() == pytest.approx(expected.peak_pressure, rel=HERTZ)
    inside = np.abs(cells.place) < expected.half_width - cells.width
    assert np.abs(pressure - expected.pressure(cells.place))[inside].max() < 2 * HERTZ * expected.peak_pressure
    assert np.all(pressure[np.abs(cells.place) > expected.half_width + cells.width] == 0)
    middle = pressure > 0.5 * pressure.max()
    slope, top = np.polyfit(cells.place[middle] ** 2, pressure[middle] ** 2, 1)
    assert math.sqrt(-top / slope) == pytest.approx(expected.half_width, rel=HERTZ)


def test_cylinders_converge_with_the_cells() -> None:
    """Pressures at fixed cell middles: the error falls with the square of their width, or faster than the first power."""
    expected = hertz(100.0, 5.0, TWO_BODIES)
    errors = []
    for count in (33, 99, 297):
        pair = cylinders(5.0, expected.half_width, count)
        (pressure,) = solve_contact((pair,), TWO_BODIES, 100.0).pressures
        inside = np.abs(pair.cells.place) < 0.8 * expected.half_width
        errors.append(np.abs(pressure - expected.pressure(pair.cells.place))[inside].max() / expected.peak_pressure)
    orders = -np.diff(np.log(errors)) / math.log(3)
    assert orders.min() > 1.0
    assert errors[-1] < 1e-3


def test_approach_of_cylinders() -> None:
    """Of the middle of the contact against points that Flamant's logarithm makes 1 mm deep.

    u(0) - u(1 mm) by Hertz's pressure: F/(pi E*) (2 ln(2/a) + 1) without the constants of the edge (Johnson 5.56).
    """
    force, radius = 100.0, 5.0
    expected = hertz(force, radius, TWO_BODIES)
    pair = cylinders(radius, expected.half_width, 132)
    solution = solve_contact((pair,), TWO_BODIES, force)
    constants = sum((1 + body.elasticity.ratio) / (math.pi * body.elasticity.modulus) for body in TWO_BODIES)
    by_hertz = force * ((2 * math.log(2 / expected.half_width) + 1) / (math.pi * expected.modulus) - constants)
    assert solution.approach == pytest.approx(by_hertz, rel=1e-3)


def test_shares_of_the_approach_follow_the_moduli() -> None:
    soft = HalfPlane(PlaneElasticity(Material(youngs_modulus=70e3)))
    hard = HalfPlane(PlaneElasticity(Material(youngs_modulus=210e3)))
    first, second = solve_contact((cylinders(5.0, 0.05, 66),), PerGear(soft, hard), 60.0).parts
    assert first / second == pytest.approx(3, rel=1e-9)


def test_two_pairs_of_teeth_that_do_not_feel_each_other_share_alike() -> None:
    force, radius = 100.0, 5.0
    half = hertz(force / 2, radius, TWO_BODIES)
    pairs = tuple(cylinders(radius, half.half_width, 66, tooth=tooth) for tooth in (0, 1))
    solution = solve_contact(pairs, TWO_BODIES, force)
    assert solution.forces == pytest.approx([50, 50], rel=1e-9)
    assert [pressure.max() for pressure in solution.pressures] == pytest.approx([half.peak_pressure] * 2, rel=HERTZ)


def test_a_tooth_that_is_far_away_carries_nothing() -> None:
    one, other = cylinders(5.0, 0.05, 66), cylinders(5.0, 0.05, 66, tooth=1)
    far = replace(other, cells=replace(other.cells, gap=other.cells.gap + 1))
    assert solve_contact((one, far), TWO_BODIES, 50.0).forces == pytest.approx([50, 0], abs=1e-12)


def test_teeth_beyond_the_neighbours_do_not_feel_each_other() -> None:
    pairs = tuple(cylinders(5.0, 0.05, 8, tooth=tooth) for tooth in (-1, 1))
    matrix = compliance_matrix(pairs, TWO_BODIES.pinion, Role.PINION)  # type: ignore[arg-type]
    assert np.all(matrix[:8, 8:] == 0)


# Complementarity


def enumerated(matrix: Any, gap: Any, width: Any, force: float) -> tuple[Any, float]:
    """The one active set, of all there are, whose solution is right."""
    n = len(gap)
    for size in range(1, n + 1):
        for rows in itertools.combinations(range(n), size):
            chosen = list(rows)
            system = np.block(
                [[matrix[np.ix_(chosen, chosen)], -width[chosen][:, None]], [width[chosen][None], np.zeros((1, 1))]]
            )
            solved = np.linalg.solve(system, np.r_[-gap[chosen], force])
            pressure = np.zeros(n)
            pressure[chosen] = solved[:-1]
            if pressure.min() >= 0 and (matrix @ pressure + gap - solved[-1] * width).min() > -1e-10:
                return pressure, float(solved[-1])
    raise AssertionError("no active set is right")


@pytest.mark.parametrize("seed", range(12))
def test_random_problems_against_all_active_sets(seed: int) -> None:
    random = np.random.default_rng(seed)
    n = 8
    half = random.normal(size=(n, n))
    matrix, gap, width = half @ half.T + 0.1 * np.eye(n), random.uniform(0, 2, n), random.uniform(0.5, 2, n)
    force = float(random.uniform(0.1, 5))
    pressure, approach = complementary(matrix, gap, width, force)
    expected, expected_approach = enumerated(matrix, gap, width, force)
    assert pressure == pytest.approx(expected, abs=1e-9)
    assert approach == pytest.approx(expected_approach, abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_larger_problems_against_least_squares(seed: int) -> None:
    """The pressures minimise p C p/2 + g p for the approach found: non-negative least squares of the root of C."""
    random = np.random.default_rng(100 + seed)
    n = 60
    place = np.sort(random.uniform(-3, 3, n))
    matrix = np.exp(-np.abs(place[:, None] - place)) + 0.05 * np.eye(n)
    gap, width = place**2 * random.uniform(0.5, 1.5, n), random.uniform(0.5, 1.5, n)
    pressure, approach = complementary(matrix, gap, width, 3.0)
    opening = matrix @ pressure + gap - approach * width
    assert width @ pressure == pytest.approx(3.0, rel=1e-12)
    assert pressure.min() >= 0
    assert opening.min() > -1e-10
    assert np.abs(pressure * opening).max() < 1e-10
    root = np.linalg.cholesky(matrix)
    expected, _ = nnls(root.T, np.linalg.solve(root, approach * width - gap))
    assert pressure == pytest.approx(expected, abs=1e-7)


# Gaps and positions

PAIR = GearPair(
    pinion=Gear(teeth=18, normal_module=1.5, face_width=10, profile_shift=0.3422),
    wheel=Gear(teeth=41, normal_module=1.5, face_width=10, profile_shift=-0.12),
)


@pytest.mark.parametrize("part", [0.0, 0.3, 0.8, 1.0])
def test_gap_is_the_distance_of_two_involutes(part: float) -> None:
    """Both flanks drawn in a plane whose x axis is the line of action; what lies between them at each place on the tangent."""
    line, path = line_of_action(PAIR), PAIR.path_of_contact
    length = path.A + 0.02 + part * (path.E - path.A - 0.04)
    pair = pair_of_tooth_0(PAIR, length, 0.3, 60)
    gaps = np.zeros(len(pair.cells.place))
    for gear, contact, lengths, sense in (
        (PAIR.pinion, length, pair.cells.lengths.pinion, 1),
        (PAIR.wheel, line.whole - length, pair.cells.lengths.wheel, -1),
    ):
        base = gear.base_diameter / 2
        # Base circle about the origin, unrolled so that the contact's normal is the vertical x = base.
        points = involute(base, -contact / base, lengths)
        assert points[:, 0] - base == pytest.approx(sense * pair.cells.place, abs=1e-9)
        gaps += points[:, 1] + contact
    mean = pair.cells.width**2 / 24 / pair.radius
    assert pair.cells.gap == pytest.approx(gaps + mean, abs=1e-9)


def test_radius_is_that_of_euler_and_savary() -> None:
    pair = pair_of_tooth_0(PAIR, PAIR.path_of_contact.C, 0.1, 66)
    first, second = (
        diameter / 2 * math.sin(math.radians(PAIR.working_transverse_pressure_angle))
        for diameter in PAIR.working_pitch_diameters
    )
    assert pair.radius == pytest.approx(first * second / (first + second), rel=1e-9)


def test_pairs_follow_each_other_by_the_base_pitch_and_end_with_the_path() -> None:
    line, path = line_of_action(PAIR), PAIR.path_of_contact
    for length in np.linspace(path.A - 4 * line.pitch, path.E + 4.1 * line.pitch, 97) + 0.001:
        found = contact_pairs(line, float(length), lambda _tooth, _radius: 0.05, 66, 0.0)
        expected = [tooth for tooth in range(-9, 10) if path.A < length + tooth * line.pitch < path.E]
        assert [pair.tooth for pair in found] == expected
        for pair in found:
            assert pair.lengths.pinion == pytest.approx(length + pair.tooth * line.pitch)
            assert sum(pair.lengths) == pytest.approx(line.whole)


def test_corners_beyond_the_path_count_up_to_the_gap() -> None:
    """Beyond A and E the corner lies off the line of action, where two flanks are s^2/(2 rho) apart, to first order."""
    line, path = line_of_action(PAIR), PAIR.path_of_contact
    beyond = 0.1
    for length, (role, tip) in zip((path.E + beyond, path.A - beyond), line.flanks.items(), strict=True):
        (pair,) = [each for each in contact_pairs(line, length, lambda *_: 0.05, 66, 0.05) if each.tooth == 0]
        contact = pair.lengths.pick(role)
        back = -tip.along_tangent(contact, tip.last)
        assert back == pytest.approx(beyond * contact / tip.base_radius, rel=0.1)
        assert np.abs(pair.cells.place).min() == pytest.approx(back, abs=pair.cells.width)
        assert pair.cells.gap.min() == pytest.approx(back**2 / 2 / pair.radius, rel=0.15)
        nearer = contact_pairs(line, length, lambda *_: 0.05, 66, 0.5 * float(pair.cells.gap.min()))
        assert all(each.tooth != 0 for each in nearer)


def test_cells_are_not_narrower_than_asked() -> None:
    line, length = line_of_action(PAIR), PAIR.path_of_contact.C
    fine = pair_of_tooth_0(PAIR, length, 0.3, 60)
    (coarse,) = [each for each in contact_pairs(line, length, lambda *_: 0.3, 60, 0.01, 0.03) if each.tooth == 0]
    assert (fine.cells.width, coarse.cells.width) == pytest.approx((0.01, 0.03))


# Below the surface


def test_strips_give_the_closed_forms_below_hertz_pressure() -> None:
    expected = LineContact(load_per_width=100, radius=5, modulus=113_187)
    a, p0 = expected.half_width, expected.peak_pressure
    count = 2000
    width = 2 * a / count
    places = -a + width * (np.arange(count) + 0.5)
    depth = a * np.array([0.05, 0.3, 0.70429, 0.78615, 2.0, 6.0])
    across, down, shear = strip_stresses(np.zeros(6), depth, places, width, expected.pressure(places))
    exact = expected.stresses(depth)
    assert across == pytest.approx(exact.sigma_x, rel=2e-4)
    assert down == pytest.approx(exact.sigma_z, rel=2e-4)
    assert np.abs(shear).max() < 1e-9 * p0
    assert (across - down)[3] / 2 == pytest.approx(0.30028 * p0, rel=2e-4)
    mises, at = greatest_von_mises(places, width, expected.pressure(places), a, PlaneElasticity(STEEL))
    assert mises == pytest.approx(0.55752 * p0, rel=5e-4)
    assert at == pytest.approx(0.70429 * a, abs=0.025 * a)  # a lattice of 0.025 a


def test_strips_in_equilibrium() -> None:
    """Tractions on any level below carry the load, and no stress is left on the surface beside it."""
    x = np.linspace(-400, 400, 800_001)
    _, down, shear = strip_stresses(x, np.full_like(x, 0.7), np.array([0.1]), 0.4, np.array([250.0]))
    assert np.trapezoid(down, x) == pytest.approx(-100, rel=1e-4)
    assert np.trapezoid(shear, x) == pytest.approx(0, abs=1e-6)
    _, beside, along = strip_stresses(np.array([1.0]), np.array([1e-12]), np.array([0.1]), 0.4, np.array([250.0]))
    assert (abs(beside[0]), abs(along[0])) == pytest.approx((0, 0), abs=1e-6)


def test_plane_stress_has_no_stress_along_the_tooth() -> None:
    places, width = np.linspace(-0.95, 0.95, 20), 0.1
    pressure = 1000 * np.sqrt(1 - places**2)
    strain, stress = (greatest_von_mises(places, width, pressure, 1.0, PlaneElasticity(STEEL, plane))[0] for plane in Plane)
    # At the surface both principal stresses are -p0 and the third is 0: von Mises p0 in plane stress.
    assert stress == pytest.approx(1000, rel=0.05)
    assert strain == pytest.approx(557.5, rel=0.01)


# The pair


def teeth_in_contact(model: PlanePair, torque: float) -> set[int]:
    return {sum(model.solve(float(angle), torque).forces > 0) for angle in model.roll_angles(24)}


def test_a_contact_ratio_above_two_loads_three_pairs() -> None:
    rack = BasicRack(addendum=1.3, dedendum=1.55, root_radius=0.25)
    gear = Gear(teeth=60, normal_module=1.0, face_width=10, rack=rack)
    pair = GearPair(pinion=gear, wheel=gear)
    assert 2.2 < pair.transverse_contact_ratio < 2.5
    model = plane_pair(pair, STEEL, body=BodyModel(teeth=7))
    assert model.pinion.neighbours == 2
    assert teeth_in_contact(model, 50.0) == {2, 3}


def test_bodies_must_be_odd_and_hold_on_below_the_root() -> None:
    for teeth in (2, 4, 1):
        with pytest.raises(ParameterError, match="teeth"):
            BodyModel(teeth=teeth)
    body = BodyModel(teeth=3, inner_diameters=PerGear(None, PAIR.wheel.root_diameter))
    with pytest.raises(GeometryError, match=r"wheel\.inner_diameter"):
        plane_pair(PAIR, STEEL, body=body)


# Modified flanks


def modified(pinion: FlankModification | None = None, wheel: FlankModification | None = None) -> GearPair:
    """The pair with modifications."""
    none = FlankModification()
    return replace(
        PAIR,
        pinion=replace(PAIR.pinion, modification=pinion or none),
        wheel=replace(PAIR.wheel, modification=wheel or none),
    )


def middle(line: LineOfAction, length: float, reach: float = 0.1) -> ContactPair:
    """The middle pair of flanks, in contact at a roll length of the pinion."""
    (found,) = [each for each in contact_pairs(line, length, lambda *_: reach, 40, 0.05) if each.tooth == 0]
    return found


RELIEF = FlankModification(tip_relief=20.0, tip_relief_length=1.2)


def test_tip_relief_is_added_to_the_gap() -> None:
    """Nothing is taken off below its start, all of it at the tip, and the gap grows by just that.

    Of what has been taken back 20 µm, the point that now lies at a place comes from 20 µm of roll nearer to the root.
    """
    line = line_of_action(modified(replace(RELIEF, tip_relief_transition=0.0)))
    pinion, wheel = line.flanks
    assert pinion.even == (pinion.first, pinion.last)
    parabolic = line_of_action(modified(replace(RELIEF, tip_relief_shape=ReliefShape.PARABOLIC)))
    assert parabolic.flanks.pinion.even == pytest.approx((pinion.first, pinion.last - 1.2))
    lengths = np.array([pinion.last - 2.0, pinion.last - 1.2, pinion.last - 0.6, pinion.last])
    assert pinion.form.depth(lengths, 5.0) == pytest.approx([0, 0, 0.010, 0.020], abs=1e-12)
    slope = 0.020 / 1.2
    assert pinion.depth(lengths) == pytest.approx([0, 0, 0.010 - slope * 0.010, 0.020 - slope * 0.020], abs=1e-12)
    assert not wheel.depth(lengths).any()
    near = middle(line, PAIR.path_of_contact.E - 0.1)
    bare = near.cells.gap - slope * (1 - slope) * (near.cells.lengths.pinion - (pinion.last - 1.2))
    # The same places on exact flanks: s^2/(2 rho) and its next term, from the flanks themselves.
    behind = pinion.facing(near.lengths.pinion, near.cells.place)[1] + wheel.facing(near.lengths.wheel, -near.cells.place)[1]
    radius = near.lengths.pinion * near.lengths.wheel / (near.lengths.pinion + near.lengths.wheel)
    assert bare == pytest.approx(behind + near.cells.width**2 / 24 / radius, abs=1e-12)
    assert not pinion.depth(middle(line, PAIR.path_of_contact.C).cells.lengths.pinion).any()


def test_window_follows_the_place_where_relieved_flanks_come_nearest() -> None:
    """On a relief that grows by c per mm of place, two flanks of reduced radius rho come nearest at -c rho."""
    line = line_of_action(modified(RELIEF))
    found = middle(line, PAIR.path_of_contact.E - 0.3, 0.05)
    slope = 0.020 / 1.2 * line.flanks.pinion.base_radius / found.lengths.pinion
    radius = found.lengths.pinion * found.lengths.wheel / (found.lengths.pinion + found.lengths.wheel)
    assert found.cells.place.mean() == pytest.approx(-slope * radius, rel=0.05)
    assert 0 < found.cells.gap.argmin() < len(found.cells.gap) - 1


def test_the_gap_is_that_of_the_middle_of_the_common_face_width() -> None:
    """Crowning of a wheel moved along the axis: its own height counts."""
    crowned = replace(modified(wheel=FlankModification(lead_crowning=16.0)), axial_offset=2.5)
    line = line_of_action(crowned)
    # The common width is 7.5 mm, its middle 6.25 mm from the pinion's end at z = 0 and 3.75 mm from the wheel's.
    assert (line.flanks.pinion.height, line.flanks.wheel.height) == (6.25, 3.75)
    assert line.flanks.wheel.depth(np.array([3.0])) == pytest.approx(0.016 * 0.25**2)


def test_pitch_error_moves_the_middle_pair_only() -> None:
    line, plain = line_of_action(PAIR, 8.0), line_of_action(PAIR)
    length = PAIR.path_of_contact.B - 0.02
    for tooth, added in ((0, -0.008), (1, 0.0)):
        gaps = [
            next(each for each in contact_pairs(of, length, lambda *_: 0.1, 40, 0.05) if each.tooth == tooth).cells.gap.min()
            for of in (line, plain)
        ]
        assert gaps[0] - gaps[1] == pytest.approx(added, abs=2e-6)


@pytest.mark.parametrize(
    ("modification", "error", "expected"),
    [
        (FlankModification(), 8.0, -0.008),
        (FlankModification(), -8.0, 0.0),
        (FlankModification(tip_relief=20.0, tip_relief_length=1.2), 0.0, 0.0),
        (FlankModification(lead_crowning=20.0), 0.0, 0.0),
    ],
)
def test_rigid_gears_approach_until_the_first_flanks_touch(
    modification: FlankModification, error: float, expected: float
) -> None:
    """Where two pairs are in contact, the better of the two decides; crowning leaves the middle of the face as it is."""
    line = line_of_action(modified(modification), error)
    assert rigid_approach(line, PAIR.path_of_contact.A + 0.2) == pytest.approx(expected, abs=2e-6)


def test_rigid_gears_with_another_pressure_angle_run_ahead_evenly() -> None:
    """One pair alone: what is taken off there, less what the contact gains by moving along the slope."""
    line, path = line_of_action(modified(FlankModification(pressure_angle_modification=30.0))), PAIR.path_of_contact
    whole = line.flanks.pinion.last - line.flanks.pinion.first
    for length in (path.B + 0.1, path.C, path.D - 0.1):
        share = 0.030 / whole
        slope = share * line.flanks.pinion.base_radius / length
        radius = length * (line.whole - length) / line.whole
        expected = share * (1 - share) * (length - line.flanks.pinion.first) - slope**2 * radius / 2
        assert rigid_approach(line, length, single=True) == pytest.approx(expected, abs=2e-5)
        # The tips of the pair before and the pair behind have less taken off, or more.
        assert rigid_approach(line, length) <= rigid_approach(line, length, single=True)


SMALL = BodyModel(teeth=3)
"""Three teeth are enough where stiffness itself does not matter."""


@pytest.mark.parametrize(
    "modification",
    [
        FlankModification(profile_crowning=12.0),
        FlankModification(profile_crowning=-3.0),
        FlankModification(pressure_angle_modification=20.0),
        FlankModification(tip_relief=15.0, tip_relief_length=0.9, root_relief=10.0, root_relief_length=0.5),
        FlankModification(tip_relief=15.0, tip_relief_length=0.9, tip_relief_shape=ReliefShape.PARABOLIC),
    ],
)
def test_modified_flanks_press_as_cylinders_of_their_own_curvature(modification: FlankModification) -> None:
    """Crowning makes the flanks rounder by per cents; Hertz's pressure at the nearest place is still found within 1 %."""
    cycle = PlaneCycle.run(plane_pair(modified(modification), STEEL, body=SMALL), 30.0, 12)
    contacts = [contact for _, contact in cycle.interior_contacts if contact.two_cylinders]
    assert len(contacts) >= 6
    for contact in contacts:
        assert contact.peak_pressure == pytest.approx(contact.hertz_pressure, rel=0.01)


def test_cells_at_the_start_of_a_relief_are_narrow_and_tell_its_pressure() -> None:
    """With the kink in the middle of the contact the pressure is that of the closed form under the load that is carried."""
    relief = FlankModification(tip_relief=18.0, tip_relief_length=1.5, tip_relief_transition=0.1)
    model = plane_pair(modified(relief), STEEL, body=SMALL)
    (onset,) = onsets(model.line.flanks.pinion)
    radius = onset.roll * (model.line.whole - onset.roll) / model.line.whole
    stretch = model.line.flanks.pinion.base_radius / onset.roll
    lengths = onset.roll + np.linspace(0, radius * onset.slope * stretch, 25)
    found = [
        contact
        for angle in model.roll_angle(lengths).tolist()
        for contact in PlaneCycle(model, 30.0).contacts_at(angle)
        if contact.start_pressures.pinion > 0
    ]
    worst = max(found, key=lambda contact: contact.start_pressures.pinion)
    assert worst.pair.cells.width <= onset.length / 8 and not worst.interior
    closed = rounded_kink_pressure(worst.force, radius, onset.slope, onset.length, model.modulus)
    assert worst.start_pressures.pinion == pytest.approx(closed, rel=0.01)
    assert all(math.isnan(contact.start_pressures.wheel) for contact in found)
    kink = replace(relief, tip_relief_transition=0.0)
    sharp = PlaneCycle(plane_pair(modified(kink), STEEL, body=SMALL), 30.0).contacts_at(float(model.roll_angle(lengths)[6]))
    assert all(math.isnan(contact.start_pressures.pinion) for contact in sharp)


def test_flanks_too_hollow_to_touch_inside_have_no_reduced_radius() -> None:
    pair = ContactPair(0, PerGear(5.0, 20.0), middle(line_of_action(PAIR), PAIR.path_of_contact.C).cells, added_curvature=-0.3)
    assert pair.radius == math.inf
    assert replace(pair, added_curvature=-0.2).radius == pytest.approx(20.0)


def test_a_gap_that_all_flanks_have_costs_no_stiffness() -> None:
    """Lead crowning in a plane model, seen off its middle: the same teeth, 4 µm later."""
    plain, late = (
        plane_pair(replace(modified(wheel=of), axial_offset=2.5), STEEL, body=SMALL)
        for of in (FlankModification(), FlankModification(lead_crowning=64.0))
    )
    one, other = PlaneCycle.run(plain, 30.0, 4), PlaneCycle.run(late, 30.0, 4)
    assert other.values("stiffness") == pytest.approx(one.values("stiffness"), rel=2e-4)
    assert other.values("transmission_error") == pytest.approx(one.values("transmission_error") + 4.0, rel=1e-3)
    assert late.single_stiffness(30.0, 3) == pytest.approx(plain.single_stiffness(30.0, 3), rel=2e-4)
