"""Pressure where linear reliefs start, and meshes of sectors solved by scikit-fem."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sparse
import skfem
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree
from skfem.models.elasticity import lame_parameters, linear_elasticity
from support.checks import COARSE
from support.samples import modified

import gearcad
from gearcad import Gear
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.shared.loaded import Cycle
from gearcad.contact.shared.local_contact import onsets, start_lengths
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidPair, SolidSizes, solid_pair
from gearcad.core.records import PerGear, Role
from gearcad.geometry import GearPair
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import mesh_body
from gearcad.meshing.bodies.element_mesh import skfem_mesh
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.outline import MeshSizes

TORQUE = 200.0

TRIAL = 0.01
"""Relative: a program of its own, with meshes of its own."""

BOTH_MODELS = 0.02
"""Relative: plane strain against the middle of solid bodies 25 mm wide."""

HALVED = 0.01
"""Relative: what every internal length halved may change."""

AWAY = {"plane": 1166.0, "solid": 1180.0}
"""The trial's greatest pressures (MPa) away from ends and starts."""

STARTS = {
    0.15: (PerGear(1319.0, 1621.0), PerGear(1315.0, 1617.0)),
    0.3: (PerGear(1076.0, 1331.0), PerGear(1073.0, 1328.0)),
}
"""By transition (mm of roll), the trial's pressures (MPa): plane, and solid in the middle of the face."""


def pair_with(transition: float) -> GearPair:
    pair = gearcad.read(Path(gearcad.__file__).parents[1] / "templates" / "reducer-21-43.toml").pair
    pinion, wheel = (
        replace(gear, modification=replace(gear.modification, tip_relief_transition=transition)) for gear in pair.gears
    )
    return replace(pair, pinion=pinion, wheel=wheel)


@cache
def plane() -> PlanePair:
    return plane_pair(pair_with(0.3), gearcad.Material(name="steel"))


@cache
def solid() -> SolidPair:
    return solid_pair(pair_with(0.3), gearcad.Material(name="steel"))


def greatest(cycle: Cycle) -> PerGear[float]:
    """Return the greatest pressures (MPa) at the starts as contacts pass them."""
    angles = cycle.model.roll_angle(start_lengths(cycle.model.line)).tolist()
    told = [contact.start_pressures for angle in angles for contact in cycle.contacts_at(angle)]
    return PerGear.each(lambda role: float(np.nanmax([each.pick(role) for each in told])))


def in_the_middle(cycle: SolidCycle) -> PerGear[float]:
    """Return those of solid bodies in the middle of the face, of the contacts at the transitions themselves."""
    line, found = cycle.model.line, PerGear[list[float]]([], [])
    for angle in cycle.model.roll_angle(start_lengths(line)).tolist():
        for contact in cycle.contacts_at(angle):
            middle = int(np.argmin(np.abs(contact.line.across)))
            for role, flank in line.flanks.items():
                length = contact.line.places.pick(role)[0][middle]
                if any(abs(length - onset.roll) < 1.0 for onset in onsets(flank)):
                    found.pick(role).append(float(contact.pressures[middle]))
    return found.map(max)


def away(cycle: Cycle) -> float:
    found = cycle.worst_contact
    assert found is not None and found[1].interior_pressure is not None
    return found[1].interior_pressure


@pytest.mark.parametrize("transition", STARTS)
def test_plane_contact_has_the_pressure_of_the_trial(transition: float) -> None:
    model = plane().with_flanks(pair_with(transition))
    assert greatest(PlaneCycle(model, TORQUE)) == pytest.approx(STARTS[transition][0], rel=TRIAL)


def test_a_kink_leaves_the_pressure_away_from_it_as_it_is() -> None:
    for transition in (0.0, 0.3):
        cycle = PlaneCycle.run(plane().with_flanks(pair_with(transition)), TORQUE, 60)
        assert away(cycle) == pytest.approx(AWAY["plane"], rel=TRIAL)


@pytest.mark.long
@pytest.mark.parametrize("transition", STARTS)
def test_solid_contact_has_the_pressure_of_the_trial_and_of_the_plane(transition: float) -> None:
    flanks = pair_with(transition)
    middle = in_the_middle(SolidCycle(solid().with_flanks(flanks), TORQUE))
    assert middle == pytest.approx(STARTS[transition][1], rel=TRIAL)
    assert middle == pytest.approx(greatest(PlaneCycle(plane().with_flanks(flanks), TORQUE)), rel=BOTH_MODELS)


@pytest.mark.long
def test_a_kink_leaves_the_pressure_of_solid_bodies_away_from_it_as_it_is() -> None:
    for transition in (0.0, 0.3):
        cycle = SolidCycle.run(solid().with_flanks(pair_with(transition)), TORQUE, 24)
        assert away(cycle) == pytest.approx(AWAY["solid"], rel=TRIAL)
        told = [contact.start_pressures.pick(role) for _, contact in cycle.contacts for role in Role]
        assert np.isnan(told).all() == (transition == 0.0)


@pytest.mark.long
def test_no_internal_length_decides_the_pressure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half as long: cells along the line, places across it, steps of slopes and of positions; twice the dofs of the bodies."""
    before = greatest(SolidCycle(solid(), TORQUE))
    plane_before = greatest(PlaneCycle(plane(), TORQUE))
    for name, value in (
        ("gearcad.contact.solid.line_contact.BEND", 0.025),
        ("gearcad.contact.solid.relief_start._STEP", 0.5e-4),
        ("gearcad.contact.shared.local_contact._OF_TRANSITION", 16),
        ("gearcad.contact.shared.local_contact._OF_WIDTH", 96),
        ("gearcad.contact.shared.local_contact._STEPS", 12),
        ("gearcad.contact.plane.pair._OF_TRANSITION", 16),
        ("gearcad.contact.plane.pair._CELLS", 132),
    ):
        monkeypatch.setattr(name, value)
    finer = solid_pair(pair_with(0.3), gearcad.Material(name="steel"), sizes=SolidSizes().refined(1.26), cells=120)
    assert greatest(SolidCycle(finer, TORQUE)) == pytest.approx(before, rel=HALVED)
    assert greatest(PlaneCycle(plane().with_flanks(pair_with(0.3)), TORQUE)) == pytest.approx(plane_before, rel=HALVED)


YOUNG, POISSON = 206e3, 0.3
SHEAR = YOUNG / 2 / (1 + POISSON)

GEAR = Gear(teeth=20, normal_module=2.0, face_width=3.0, helix_angle=25)
INNER = 6.0
"""mm: so deep below the teeth nothing tells a disc that its load comes in at 20 places: that dies as (r/r_f)^20."""

SIZES = replace(COARSE, rim=0.4)
"""Elements over the radius enough for a field that falls with its square."""

DEEP = 11.0
"""mm: radius up to which nodes are looked at."""

OF_DISC = 2e-4
"""What a few elements over the radius leave of the closed form."""

ELEMENTS = {
    Element.QUAD8: skfem.ElementQuadS2,
    Element.TRI6: skfem.ElementTriP2,
    Element.HEX8: skfem.ElementHex1,
    Element.HEX20: skfem.ElementHexS2,
}


class Solved:
    """A mesh, the degrees of freedom (nodes, dimension) of its nodes in scikit-fem, and its stiffness (N/mm, plane strain)."""

    def __init__(self, mesh: ElementMesh) -> None:
        self.mesh, self.dimension = mesh, mesh.element.shape.dimension
        basis = skfem.Basis(skfem_mesh(mesh), skfem.ElementVector(ELEMENTS[mesh.element]()), intorder=5)
        # Components of a node follow one another.
        places = basis.doflocs[:, :: self.dimension].T
        distance, found = cKDTree(places).query(mesh.points[:, : self.dimension])
        assert distance.max() < 1e-9 and len(places) == len(mesh.points)
        self.dofs = found[:, None] * self.dimension + np.arange(self.dimension)
        self.stiffness = linear_elasticity(*lame_parameters(YOUNG, POISSON)).assemble(basis).tocsr()

    def at_nodes(self, values: Any) -> Any:
        """Of degrees of freedom, (nodes, dimension)."""
        return values[self.dofs]


def sector(element: Element, gear: Gear, sizes: MeshSizes) -> ElementMesh:
    if element.shape.dimension == 2:
        return mesh_section(gear, teeth=1, held_radius=INNER, sizes=sizes, element=element)
    return mesh_body(gear, teeth=1, held_radius=INNER, sizes=sizes, planes=None, element=element)


@pytest.mark.parametrize("element", ELEMENTS)
def test_patch_of_constant_strain(element: Element) -> None:
    """Moved on its outside by a linear field, a body moves by it inside too, whatever the form of its elements."""
    mesh = sector(element, modified(GEAR), COARSE)
    solved = Solved(mesh)
    gradient = 1e-3 * np.array([[3, -1, 2], [5, 2, -3], [1, 4, -2]])[: solved.dimension, : solved.dimension]
    moved = np.zeros(solved.stiffness.shape[0])
    expected = mesh.points[:, : solved.dimension] @ gradient.T
    moved[solved.dofs] = expected
    outside = np.unique(np.concatenate([mesh.nodes(name) for name in mesh.sides]))
    inside = np.setdiff1d(np.arange(len(moved)), solved.dofs[outside])
    assert len(inside) > 50
    held = np.setdiff1d(np.arange(len(moved)), inside)
    moved[inside] = spsolve(solved.stiffness[inside][:, inside], -solved.stiffness[inside][:, held] @ moved[held])
    assert solved.at_nodes(moved) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("element", [Element.QUAD8, Element.TRI6, Element.HEX20])
def test_torque_turns_a_disc(element: Element) -> None:
    """phi(r) = T/(4 pi G b) (1/r_i^2 - 1/r^2); one sector stands for all: what happens on both cuts is the same."""
    torque = 1000.0
    mesh = sector(element, GEAR, SIZES)
    solved = Solved(mesh)
    width = GEAR.face_width if solved.dimension == 3 else 1.0
    x, y = mesh.points[:, :2].T
    tip = mesh.nodes("tip_0")
    force = np.zeros(solved.stiffness.shape[0])
    lever = np.stack([-y[tip], x[tip]], -1)
    force[solved.dofs[tip, :2]] = torque / GEAR.teeth * lever / (lever**2).sum()
    tie = tied(solved)
    held = solved.dofs[np.r_[mesh.nodes("bore"), mesh.matched["cut"][:, 1]]]
    free = np.setdiff1d(np.arange(len(force)), held)
    tie = tie[:, free]
    moved = solved.at_nodes(tie @ spsolve((tie.T @ solved.stiffness @ tie).tocsc(), tie.T @ force))
    radius = np.hypot(x, y)
    turn = (x * moved[:, 1] - y * moved[:, 0]) / radius**2
    deep = (radius < DEEP) & (radius > INNER + 1e-6)
    disc = torque / (4 * math.pi * SHEAR * width) * (1 / INNER**2 - 1 / radius**2)
    assert deep.sum() > 40
    assert turn[deep] == pytest.approx(disc[deep], abs=OF_DISC * disc[deep].max())
    assert np.abs(moved[deep, 2:]).max(initial=0.0) < OF_DISC * disc[deep].max() * DEEP


def tied(solved: Solved) -> Any:
    """Matrix of all degrees of freedom by those that are left: a node of the cut ahead moves as that behind, turned."""
    pitch = 2 * math.pi / GEAR.teeth
    turn = np.eye(solved.dimension)
    turn[:2, :2] = [[math.cos(pitch), -math.sin(pitch)], [math.sin(pitch), math.cos(pitch)]]
    tie = sparse.identity(solved.stiffness.shape[0], format="lil")
    for behind, ahead in solved.mesh.matched["cut"]:
        for row, weights in zip(solved.dofs[ahead], turn, strict=True):
            tie[row, row] = 0.0
            tie[row, solved.dofs[behind]] = weights
    return tie.tocsr()
