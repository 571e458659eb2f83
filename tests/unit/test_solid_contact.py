"""Contact along lines: the half-space's field, gaps against points in space, ellipses against Hertz."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.dense_contact import gap_along_action, hertz_ellipse, middle_height

from gearcad import Body, FlankModification, Gear, GearPair, Material, Mounting, ReliefShape
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.contact.shared.tip_edge import TipEdges
from gearcad.contact.solid.cycle import SolidCycle, SolidPairContact
from gearcad.contact.solid.elements import lame
from gearcad.contact.solid.flank import (
    SolidFlank,
    half_space_displacement,
    half_space_normal_displacement,
    half_space_traction,
    surface_displacement,
)
from gearcad.contact.solid.line_contact import (
    ContactLine,
    Gaps,
    LineSolution,
    Responses,
    contact_lines,
    gaps,
    half_widths,
    solve_lines,
)
from gearcad.contact.solid.pair import SolidSizes, solid_pair
from gearcad.core.errors import SolverError
from gearcad.core.records import Floats, PerGear, Role

STEEL = Material()
LOAD = np.array([0.3, -0.2, 0.1])
INWARD = np.array([2.0, -1.0, 2.0]) / 3


# ---------------------------------------------------------------------- the half-space


def inside(count: int = 40) -> Floats:
    """Points below the surface, some way from the load."""
    draw = np.random.default_rng(3).normal(size=(count, 3))
    depth = draw @ INWARD
    return LOAD + draw + (np.abs(depth) - depth + 0.3)[:, None] * INWARD


def test_stress_is_hookes_of_the_displacement() -> None:
    """The tractions on three planes are those of the strains, by differences of the displacement."""
    points, step = inside(), 1e-4
    slope = np.zeros((len(points), 3, 3))
    for axis in range(3):
        shift = np.eye(3)[axis] * step
        ahead, behind = (half_space_displacement(points + sign * shift, LOAD, INWARD, STEEL) for sign in (1, -1))
        slope[:, :, axis] = (ahead - behind) / (2 * step)
    strain, (first, second) = (slope + slope.transpose(0, 2, 1)) / 2, lame(STEEL)
    stress = first * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3) + 2 * second * strain
    for axis in range(3):
        normal = np.broadcast_to(np.eye(3)[axis], points.shape)
        found = half_space_traction(points, normal, LOAD, INWARD, STEEL)
        assert found == pytest.approx(stress[:, axis], rel=1e-5, abs=1e-6 * np.abs(stress).max())


def test_surface_is_free_and_sinks_by_the_closed_form() -> None:
    across = np.cross(INWARD, [1.0, 0, 0])
    points = LOAD + np.outer([0.5, 1.0, 3.0], across / np.linalg.norm(across))
    normals = np.broadcast_to(-INWARD, points.shape)
    assert np.abs(half_space_traction(points, normals, LOAD, INWARD, STEEL)).max() < 1e-12
    sunk = half_space_displacement(points, LOAD, INWARD, STEEL) @ INWARD
    assert sunk == pytest.approx(surface_displacement(np.array([0.5, 1.0, 3.0]), STEEL), rel=1e-12)


def test_groups_of_loads_move_along_normals() -> None:
    """Each group is the sum of its loads' vectors, along the normals; a point under a load is not moved by it."""
    at, forces = np.stack([[LOAD, 3 * INWARD], [2 * LOAD, -LOAD]]), np.array([1.0, -0.4])
    inward = np.stack([[INWARD, -INWARD], [-INWARD, INWARD]])
    points = np.vstack([inside(), LOAD])
    normals = np.random.default_rng(5).normal(size=points.shape)
    found = half_space_normal_displacement(points, normals, at, inward, STEEL, forces)
    groups = zip(at, inward, strict=True)
    vectors = np.stack([half_space_displacement(points, where, to, STEEL, forces) for where, to in groups], -1)
    assert found == pytest.approx(np.einsum("nc,ncm->nm", normals, vectors), rel=1e-12)


def test_plane_below_carries_the_load() -> None:
    """The traction on a plane at some depth has the load as its resultant."""
    first = np.cross(INWARD, [1.0, 0, 0])
    first /= np.linalg.norm(first)
    second = np.cross(INWARD, first)
    s, w = np.polynomial.legendre.leggauss(60)
    radius, around = (s + 1) / 2, np.linspace(0, 2 * np.pi, 24, endpoint=False)
    r, factor = radius / (1 - radius), 1 / (1 - radius) ** 2 / 2  # out to infinity
    ring = np.cos(around)[:, None] * first + np.sin(around)[:, None] * second
    points = LOAD + INWARD + r[:, None, None] * ring
    normals = np.broadcast_to(INWARD, points.shape)
    traction = half_space_traction(points, normals, LOAD, INWARD, STEEL)
    total = np.einsum("r,rac->c", w * factor * r * 2 * np.pi / len(around), traction)
    assert total == pytest.approx(-INWARD, abs=1e-6)


# ---------------------------------------------------------------------- gaps

PINION = Gear(teeth=17, normal_module=3.0, face_width=22, helix_angle=18.0, profile_shift=0.2)
WHEEL = Gear(teeth=31, normal_module=3.0, face_width=18, helix_angle=-18.0, profile_shift=0.1)
RING = Gear(teeth=-53, normal_module=3.0, face_width=18, helix_angle=18.0, profile_shift=-0.3)
MODIFIED = (
    FlankModification(
        tip_relief=18,
        tip_relief_length=2.5,
        tip_relief_shape=ReliefShape.PARABOLIC,
        lead_crowning=9,
        helix_angle_modification=14,
        profile_crowning=5,
    ),
    FlankModification(root_relief=11, root_relief_length=1.8, end_relief=12, end_relief_length=5, twist=8, lead_crowning=3),
)
MODIFIED_WITH_RING = (
    FlankModification(
        tip_relief=10, tip_relief_length=4, tip_relief_shape=ReliefShape.PARABOLIC, lead_crowning=9, helix_angle_modification=14
    ),
    FlankModification(
        tip_relief=10,
        tip_relief_length=6,
        tip_relief_shape=ReliefShape.PARABOLIC,
        end_relief=12,
        end_relief_length=5,
        twist=8,
        helix_angle_modification=-9,
        pressure_angle_modification=4,
    ),
)
"""Gaps with a ring bend less, so that flanks are nearest further aside: reliefs are longer."""

MOUNTINGS = (
    Mounting(),
    Mounting(misalignment=25),
    Mounting(misalignment_across=-40),
    Mounting(pinion_pitch_error=6, wheel_pitch_error=-2, centre_distance_change=0.15),
)
GAP = 1e-4
"""mm: 0.1 µm; the gap is taken along the normal of the exact flanks, and nearest places to second order in slopes."""

EDGE = 3e-3
"""The same at the edge of a tip: where it stands is that of the exact flanks as drawn."""

NEAR_EDGE = 4e-4
"""The same on the last tenth of a module, where slopes are taken over the end of the flank."""


def lines_of(pair: GearPair, roll_length: float, cells: int = 24) -> tuple[ContactLine, ...]:
    gear = pair.pinion
    rate = math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2)
    return contact_lines(pair, line_of_action(pair), SolidFlank(gear, rate), roll_length, cells, 0.05)


@pytest.mark.parametrize("mounting", MOUNTINGS, ids=["drawing", "in plane", "across", "pitch and centre"])
@pytest.mark.parametrize("modified", [False, True])
@pytest.mark.parametrize("mate", [WHEEL, RING], ids=["wheel", "ring"])
def test_gaps_are_those_of_the_flanks_in_space(mounting: Mounting, modified: bool, mate: Gear) -> None:
    """Against the nearest of many points of both surfaces in each transverse section.

    A rigid displacement of the wheel along the axis is not in that picture: it is taken off (see `gaps`).
    """
    pinion, wheel = PINION, mate
    if modified:
        first, second = MODIFIED_WITH_RING if mate.internal else MODIFIED
        pinion, wheel = replace(PINION, modification=first), replace(mate, modification=second)
    pair = mounting.mounted(GearPair(pinion=pinion, wheel=wheel, axial_offset=1.5))
    helix = math.radians(pair.pinion.base_helix_angle)
    for roll_length in (pair.path_of_contact.C, pair.path_of_contact.C + 2.0):
        lines = lines_of(pair, roll_length)
        found, start = gaps(lines, pair, mounting, helix).normal, 0
        for line in lines:
            here = found[start : start + len(line.across)] / math.cos(helix)
            start += len(line.across)
            turn = mounting.misalignment / 1000 / pair.common_width.width
            here = here + turn * line.places.wheel[0] * math.tan(helix)
            heights = line.across + middle_height(pair)
            for row in range(0, len(heights), 5):
                places = line.aside[row] + 1e-3 * np.arange(-400, 401)
                witness = gap_along_action(pair, mounting, roll_length, line.tooth, heights[row : row + 1], places)
                near = line.edge_distance[row] < 0.1 * PINION.normal_module
                tolerance = EDGE if line.on_edge[row] else NEAR_EDGE if near else GAP
                assert here[row] == pytest.approx(float(np.nanmin(witness)), abs=tolerance)


def test_line_lies_at_the_base_helix_angle() -> None:
    pair = GearPair(pinion=PINION, wheel=WHEEL)
    helix = math.radians(pair.pinion.base_helix_angle)
    for line in lines_of(pair, pair.path_of_contact.C):
        on_flank = ~line.on_edge
        lean = np.diff(line.nominal[on_flank]) / np.diff(line.across[on_flank])
        assert lean == pytest.approx(math.tan(helix), rel=1e-9)
        # A generator of the involute helicoid: cells are equally long, and their points lie on one straight line.
        assert line.lengths[on_flank] == pytest.approx(18 / 24 / math.cos(helix), rel=1e-9)
        points = line.points[on_flank]
        if len(points) > 2:
            assert np.abs(np.diff(points, 2, axis=0)).max() < 1e-9


# ---------------------------------------------------------------------- ellipses


def half_spaces(width: float, cells: int) -> Responses:
    """One line across two half-spaces, without anything smooth."""
    across = (np.arange(cells) + 0.5) * width / cells - width / 2
    zero, one = np.zeros(cells), np.ones(cells)
    line = ContactLine(
        tooth=0,
        across=across,
        nominal=zero,
        places=PerGear((one, across), (one, across)),
        lengths=one * width / cells,
        aside=zero,
        gap=zero,
        points=np.stack([zero, zero, across], -1),
        edge_distance=one,
        slope=0.0,
        edges=TipEdges.none(cells),
    )
    modulus = STEEL.youngs_modulus / (1 - STEEL.poisson_ratio**2) / 2
    return Responses((line,), PerGear(*np.zeros((2, cells, cells))), np.abs(across[:, None] - across), line.lengths, modulus)


@pytest.mark.parametrize(("along", "tolerance"), [(2000.0, 0.005), (500.0, 0.007), (120.0, 0.02)])
@pytest.mark.parametrize("cells", [60, 200])
def test_crowned_contact_is_hertzs_ellipse(along: float, tolerance: float, cells: int) -> None:
    """A crowned line presses an ellipse; the slimmer, the better the line's ellipses are those of the whole: 2 % is asked."""
    given, force, across = half_spaces(20.0, cells), 3000.0, 8.0
    place = given.lines[0].across
    solved = solve_lines(given, Gaps(place**2 / (2 * along), np.full(cells, across)), force)
    pressure, greater, lesser = hertz_ellipse(force, across, along, given.modulus)
    assert solved.forces.sum() == pytest.approx(force, rel=1e-12)
    assert solved.pressures.max() == pytest.approx(pressure, rel=tolerance)
    assert solved.half_widths.max() == pytest.approx(lesser, rel=tolerance)
    fit = np.polyfit(place[solved.pressures > 0.3 * pressure] ** 2, solved.pressures[solved.pressures > 0.3 * pressure] ** 2, 1)
    assert math.sqrt(-fit[1] / fit[0]) == pytest.approx(greater, rel=2 * tolerance)


def test_hertz_ellipse_of_a_sphere() -> None:
    """The witness itself: equal radii give a circle, a^3 = 3 F R/(4 E*)."""
    _, greater, lesser = hertz_ellipse(1000.0, 9.999, 10.0, 1e5)
    assert greater == pytest.approx((3 * 1000 * 10 / 4 / 1e5) ** (1 / 3), rel=1e-3)
    assert lesser == pytest.approx(greater, rel=1e-3)


def test_solution_is_complementary() -> None:
    """Loaded cells touch, the others are open; a gap that is the same everywhere only adds to the approach."""
    given = half_spaces(12.0, 40)
    gap = np.abs(given.lines[0].across) ** 3 / 4e3
    radii = np.full(40, 6.0)
    plain, apart = (solve_lines(given, Gaps(gap + more, radii), 500.0) for more in (0.0, 0.01))
    moved = given.half_space(plain.half_widths + (plain.forces == 0) * 1e-3) @ plain.forces + gap - plain.approach
    assert np.abs(moved[plain.forces > 0]).max() < 1e-6
    assert moved[plain.forces == 0].min() > -1e-9
    assert apart.approach - plain.approach == pytest.approx(0.01, rel=1e-9)
    assert apart.rigid == pytest.approx(0.01 + gap.min())
    assert sum(plain.parts) == pytest.approx(plain.approach - plain.forces @ gap / 500, rel=1e-9)


@pytest.mark.parametrize(("forces", "edge"), [((5.0, 5.0, 0.0), False), ((5.0, 5.0, 1.0), True)])
def test_an_edge_counts_where_it_carries(forces: tuple[float, ...], edge: bool) -> None:
    """The last cell of three lies on the edge of a tip: it is an edge contact with a force there, not without."""
    (line,) = half_spaces(3.0, 3).lines
    loads = np.array(forces)
    contact = SolidPairContact(
        line=replace(line, aside=np.array([0.0, 0.0, 0.1])),
        forces=loads,
        half_widths=0.1 * (loads > 0),
        pressures=loads,
        radii=np.ones(3),
        margin=np.ones(3),
        start_pressures=PerGear(math.nan, math.nan),
        edge_pressure=0.0,
        force=float(loads.sum()),
        share=1.0,
    )
    assert contact.edge is edge


def test_flanks_of_too_few_elements_are_refused() -> None:
    """Loads stand on vertices where the flank carries; of one row nothing is known between."""
    pinion, wheel = (Gear(teeth=teeth, normal_module=2, face_width=8, body=Body(bore=12)) for teeth in (17, 23))
    with pytest.raises(SolverError, match="the flanks of the gear with 17 teeth have too few elements to be loaded"):
        solid_pair(GearPair(pinion=pinion, wheel=wheel), STEEL, sizes=SolidSizes().refined(0.25))


UNSETTLED = [(20, 29, 15.0, 0.0), (25, 41, 45.0, 60.0)]
"""Teeth, helix angle and the pinion's bore (mm) of pairs, m 3, b 12, whose contact once did not settle."""

SAME_WIDTH = 1e-8
"""Relative: the half widths solve Hertz's equation for the loads that were found, within ten times the solver's own bound."""


@pytest.mark.long
@pytest.mark.parametrize("count", [pytest.param(25, id="quick"), pytest.param(500, id="1,000 in all", marks=pytest.mark.long)])
@pytest.mark.parametrize(("teeth", "mate", "helix", "bore"), UNSETTLED)
def test_contact_settles_whatever_the_misalignment(teeth: int, mate: int, helix: float, bore: float, count: int) -> None:
    """Random torques, misalignments, reliefs and roll angles: the force is all there, no cell overlaps, widths are Hertz's."""
    common = {"normal_module": 3.0, "face_width": 12.0}
    pinion = Gear(teeth=teeth, helix_angle=helix, body=Body(bore=bore), **common)  # type: ignore[arg-type]
    wheel = Gear(teeth=mate, helix_angle=-helix, body=Body(bore=bore and 100.0), **common)  # type: ignore[arg-type]
    body = BodyModel(teeth=5) if not bore else BodyModel()
    model = solid_pair(GearPair(pinion=pinion, wheel=wheel), STEEL, body=body)
    random = np.random.default_rng(teeth)
    for _ in range(count):
        relief = FlankModification(tip_relief=random.uniform(2, 40), tip_relief_length=random.uniform(0.5, 1.5))
        gear = replace(pinion, modification=relief) if random.random() < 0.6 else pinion
        mounting = Mounting(misalignment=random.choice([0.0, random.normal(0, 40), random.uniform(-300, 300)]))
        moved = replace(model, pair=replace(model.pair, pinion=gear), mounting=mounting, known={}, solved={})
        torque, angle = 10 ** random.uniform(0.5, 2.7), random.uniform(-8, 8)
        solved = moved.solve(angle, torque)
        force = moved.force(torque) * moved.width / math.cos(moved.helix)
        assert (solved.forces * solved.given.arms).sum() == pytest.approx(force, rel=1e-9)
        assert solved.forces.min() >= 0
        assert_widths_are_hertzs(solved)


def assert_widths_are_hertzs(solved: LineSolution, times: int = 1) -> None:
    """Rebuild the equation of the widths from the forces alone: loads evened out over `times` the even load's half widths."""
    given, radii, total = solved.given, solved.gaps.radii, (solved.forces * solved.given.arms).sum()
    even = total * given.lengths / given.lengths.sum()
    near = np.exp(-((given.apart / (times * half_widths(given, radii, even)[:, None])) ** 2)) * given.lengths
    weights = near / near.sum(axis=1, keepdims=True)
    loads = weights @ (np.maximum(solved.forces, 1e-3 * even) / given.lengths)
    kernel = given.half_space(half_widths(given, radii, loads * given.lengths))
    moved = (given.both + kernel) @ solved.forces + solved.gaps.normal - given.arms * solved.approach
    carries = solved.forces > 0
    assert np.abs(moved[carries]).max() < SAME_WIDTH * max(solved.approach - solved.rigid, 1e-3)
    assert moved.min() > -SAME_WIDTH


@pytest.mark.parametrize(("angle", "times"), [(-1.5, 1), (1.5, 2)])
def test_contact_settles_where_few_cells_carry_all_of_it(angle: float, times: int) -> None:
    """The ends of the lines are pressed 2.5 times as wide as an even load would be: loads can be evened out over more of it."""
    common = {"normal_module": 3.0, "tooth_thinning": 0.06}
    pinion = Gear(teeth=20, face_width=10.0, helix_angle=-10.0, profile_shift=0.154, body=Body(bore=24.0), **common)
    wheel = Gear(teeth=67, face_width=8.24, helix_angle=10.0, profile_shift=0.28, body=Body(bore=80.0), **common)
    sizes, mounting = SolidSizes().refined(0.5), Mounting(misalignment=-150.0)
    model = solid_pair(GearPair(pinion=pinion, wheel=wheel), STEEL, body=BodyModel(teeth=5), sizes=sizes, mounting=mounting)
    solved = model.solve(angle, 35.66)
    carried = (solved.forces * solved.given.arms).sum()
    assert carried == pytest.approx(model.force(35.66) * model.width / math.cos(model.helix), rel=1e-9)
    assert_widths_are_hertzs(solved, times=times)


def test_a_contact_wider_than_teeth_are_deep_is_refused() -> None:
    """The torque is spread over the face, but the misaligned end carries all of it: both are named, and what to do."""
    gears = [Gear(teeth=teeth, normal_module=1.0, face_width=12.0, body=Body(bore=8.0)) for teeth in (20, 30)]
    soft = Material(youngs_modulus=100.0, poisson_ratio=0.4)
    sizes = SolidSizes().refined(0.5)
    model = solid_pair(GearPair(pinion=gears[0], wheel=gears[1]), soft, body=BodyModel(teeth=5), sizes=sizes)
    moved = replace(model, mounting=Mounting(misalignment=1000.0), known={}, solved={})
    assert moved.solve(0.0, 0.02).half_widths.max() < 2.25
    with pytest.raises(SolverError, match=r"half width, .* mm at 13 N·m, is more than .*; reduce load.torque or mounting"):
        moved.solve(0.0, 13.0)


SAME = 1e-4
"""Relative: pressures at and away from the starts of reliefs, whatever the length over which slope and curvature are taken."""


@pytest.mark.long
def test_pressure_beside_the_start_of_a_relief_has_no_internal_length(monkeypatch: pytest.MonkeyPatch) -> None:
    """The transition makes it finite; within three half widths of it cells are pressed by their exact gap."""
    relief = FlankModification(tip_relief=40.0, tip_relief_length=4.5)
    gears = [
        Gear(teeth=teeth, normal_module=3.0, face_width=10.0, body=Body(bore=bore), modification=relief)
        for teeth, bore in ((21, 30.0), (43, 60.0))
    ]
    model = solid_pair(GearPair(pinion=gears[0], wheel=gears[1]), STEEL, body=BodyModel(teeth=5))
    found, told = [], []
    for bend in (0.025, 0.05, 0.1):
        monkeypatch.setattr("gearcad.contact.solid.line_contact.BEND", bend)
        fresh = replace(model, known={}, solved={})
        cycle = SolidCycle.run(fresh, 150.0, 16)
        contacts = [contact for position in cycle.positions for contact in position.contacts]
        found.append(np.nanmax([contact.peak_pressure for contact in contacts]))
        told.append([np.nanmax([each.start_pressures.pick(role) for each in contacts]) for role in Role])
    assert found == pytest.approx([found[0]] * 3, rel=SAME)
    for each in told[1:]:
        assert each == pytest.approx(told[0], rel=SAME)
