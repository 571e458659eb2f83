"""Bores that are not held rigidly: against the same ring in full, thin rings in closed form, and limits of stiffness."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg
from support.brute import stiffness_matrix, tip_loads

from gearcad import Body, Gear, GearPair, Material
from gearcad.contact.plane.flank import Fillets, PlaneCompliance, ToothLoad, flank_compliance
from gearcad.contact.plane.pair import flank_body
from gearcad.contact.plane.ring import Ring, SurfaceStresses, assemble, far_responses
from gearcad.contact.plane.sector import PlaneElasticity, hub_tractions, key_load, with_support
from gearcad.contact.shared.bodies import BodyModel, Cuts, Hold, Support, rim_ratio, support_of
from gearcad.core.errors import GeometryError, ParameterError
from gearcad.core.records import PerGear
from gearcad.meshing.outline import MeshSizes, OutlineSide
from gearcad.meshing.sector import SectorMesh, mesh_sector
from gearcad.rating.editions import Edition
from gearcad.rating.tooth_stiffness import rim_thickness_factor

STEEL = Material()
ELASTIC = PlaneElasticity(STEEL)
GEAR = Gear(teeth=13, normal_module=2.0, face_width=10, profile_shift=0.2, body=Body(bore=18, keyway_width=4, keyway_depth=0.3))
INNER = 9.0
"""mm: radius of the bore; the rim below the root is 1.9 mm thick."""

SIZES = MeshSizes(flank=0.25, corner=0.1, fillet=0.2, outline=0.4, cut=0.3)
"""Coarse: equality of two ways through the same mesh does not depend on its fineness."""

EXACT = 1e-8
"""Relative: rounding of a solution with some thousand unknowns."""


@pytest.fixture(scope="module")
def mesh() -> SectorMesh:
    return mesh_sector(GEAR, INNER, SIZES)


# ---------------------------------------------------------------------- the same ring in full


class InFull:
    """A ring of equal sectors, turned into place and merged, held by bordered equations; nothing of `ring.py` is used."""

    def __init__(self, whole: SectorMesh, teeth: int, stiffness: Any, weights: Any) -> None:
        pitch, count = 2 * np.pi / teeth, len(whole.points)
        self.turns = [_turn((k - teeth // 2) * pitch) for k in range(teeth)]
        self.number, points = np.full((teeth, count), -1), []
        for k, turn in enumerate(self.turns):
            if k:
                self.number[k, whole.behind] = self.number[k - 1, whole.ahead]
            if k == teeth - 1:
                self.number[k, whole.ahead] = self.number[0, whole.behind]
            new = np.flatnonzero(self.number[k] < 0)
            self.number[k, new] = len(points) + np.arange(len(new))
            points.extend(whole.points[new] @ turn.T)
        self.size = 2 * len(points)
        matrix = scipy.sparse.csr_matrix((self.size, self.size))
        mean = np.zeros((self.size, 3))
        for row, turn in zip(self.number, self.turns, strict=True):
            place = self._place(row, turn)
            matrix = matrix + place @ stiffness @ place.T
            own = place @ weights
            mean[:, 0] += own[:, 0]
            # Forces along x and y are the same all round.
            mean[:, 1:] += own[:, 1:] @ turn.T
        self.matrix = scipy.sparse.bmat([[matrix, mean], [mean.T, None]], format="csc")

    def _place(self, row: Any, turn: Any) -> Any:
        """From a sector's dofs in its own frame to all dofs."""
        dofs = (2 * row[:, None] + np.arange(2)).ravel()
        many = scipy.sparse.kron(scipy.sparse.eye(len(row)), turn).tocoo()
        return scipy.sparse.csr_matrix((many.data, (dofs[many.row], many.col)), shape=(self.size, 2 * len(row)))

    def solve(self, loads: dict[int, Any]) -> Any:
        """Displacements (teeth, 2 n, m) in each sector's frame by loads (2 n, m) on some teeth, the middle one being 0."""
        middle = len(self.turns) // 2
        right = sum(self._place(self.number[middle + k], self.turns[middle + k]) @ load for k, load in loads.items())
        moved = scipy.sparse.linalg.splu(self.matrix).solve(np.r_[right, np.zeros((3, right.shape[1]))])[:-3]
        return np.stack([self._place(row, turn).T @ moved for row, turn in zip(self.number, self.turns, strict=True)])


def _turn(angle: float) -> Any:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _bore_weights(mesh: SectorMesh) -> Any:
    """Integral of N (e.m) e over the bore, e along it, m a turn and two shifts: three points an edge, by Simpson's elements."""
    weights = np.zeros((2 * len(mesh.points), 3))
    arc = mesh.sides[OutlineSide.HELD]
    s, weight = np.polynomial.legendre.leggauss(6)
    for a, b, c in zip(arc[:-1:2], arc[1::2], arc[2::2], strict=True):
        for at, w in zip(s, weight, strict=True):
            shape = np.array([at * (at - 1) / 2, 1 - at * at, at * (at + 1) / 2])
            slope = np.array([at - 0.5, -2 * at, at + 0.5])
            x, y = shape @ mesh.points[[a, b, c]]
            length = w * np.hypot(*(slope @ mesh.points[[a, b, c]]))
            e = np.array([-y, x]) / np.hypot(x, y)
            along = np.array([np.hypot(x, y), e[0], e[1]])
            for node, n in zip((a, b, c), shape, strict=True):
                weights[2 * node : 2 * node + 2] += n * length * np.outer(e, along)
    return weights


@pytest.fixture(scope="module")
def in_full(mesh: SectorMesh) -> InFull:
    return InFull(mesh, GEAR.teeth, stiffness_matrix(mesh, ELASTIC), _bore_weights(mesh))


def _free(mesh: SectorMesh, neighbours: int, hold: Hold = Hold.FREE) -> Ring:
    return assemble(mesh, mesh, GEAR.teeth, neighbours, ELASTIC, None, Cuts.FIXED, support_of(GEAR, INNER, hold))


@pytest.mark.parametrize("neighbours", [1, 2, 6])
def test_a_free_bore_is_that_of_the_ring_in_full(mesh: SectorMesh, in_full: InFull, neighbours: int) -> None:
    """Condensed sectors and all; and from their cuts come the displacements of the teeth that do not stand in full."""
    ring, loads = _free(mesh, neighbours), tip_loads(mesh)
    moved, torques = ring.solve(loads)
    expected = in_full.solve({0: loads})
    middle, scale = GEAR.teeth // 2, np.abs(expected).max()
    assert np.abs(moved - expected[middle - neighbours : middle + neighbours + 1]).max() < EXACT * scale
    x, y = mesh.points[mesh.sides[OutlineSide.LEFT_FLANK][0]]
    assert torques == pytest.approx([-y, x], rel=1e-9)
    every = np.arange(2 * len(mesh.points))[:, None]
    everything = SurfaceStresses(every, np.ones(every.shape))
    far = far_responses(ring, everything, moved, ring.hub_forces(loads))
    assert len(far) == GEAR.teeth - 2 * neighbours - 1
    for k, found in enumerate(far, neighbours + 1):
        assert np.abs(found - expected[(middle + k) % GEAR.teeth]).max() < EXACT * scale


def test_a_shaft_is_that_of_the_ring_in_full(mesh: SectorMesh) -> None:
    """A hollow shaft of another modulus, its section led by the torque in the mean."""
    support = support_of(GEAR, INNER, Hold.SHAFT, Material(youngs_modulus=70000.0), 8.0)
    whole = with_support(mesh, support)
    assert np.hypot(*whole.points[whole.sides[OutlineSide.HELD]].T) == pytest.approx(4.0)
    gear, shaft = np.arange(len(mesh.triangles)), np.arange(len(mesh.triangles), len(whole.triangles))
    soft = PlaneElasticity(Material(youngs_modulus=70000.0))
    stiffness = stiffness_matrix(whole, ELASTIC, gear) + stiffness_matrix(whole, soft, shaft)
    weights = hub_tractions(mesh, whole, support)
    # The whole section, by what is known of an annulus: its area, and its polar moment.
    x, y = whole.points.T
    turn, shift = np.stack([-y, x], -1).ravel(), np.tile([1.0, 0.0], len(x))
    assert GEAR.teeth * (turn @ weights[:, 0]) == pytest.approx(math.pi / 2 * (9**4 - 4**4), rel=1e-4)
    assert GEAR.teeth * (shift @ weights[:, 1]) == pytest.approx(math.pi * (9**2 - 4**2), rel=1e-4)
    ring = assemble(mesh, mesh, GEAR.teeth, 1, ELASTIC, None, Cuts.FIXED, support)
    loads = tip_loads(mesh)
    more = np.zeros((2 * len(whole.points), 2))
    more[: len(loads)] = loads
    expected = InFull(whole, GEAR.teeth, stiffness, weights).solve({0: more})[:, : len(loads)]
    moved, _ = ring.solve(loads)
    assert np.abs(moved - expected[5:8]).max() < EXACT * np.abs(expected).max()


def test_a_stiff_shaft_is_a_rigid_bore(mesh: SectorMesh) -> None:
    """A gear of 1 MPa on a shaft of 1e7 MPa."""
    soft, loads = PlaneElasticity(Material(youngs_modulus=1.0)), tip_loads(mesh)
    supports = (support_of(GEAR, INNER, Hold.SHAFT, Material(youngs_modulus=1e7)), Support(teeth=GEAR.teeth))
    stiff, rigid = (assemble(mesh, mesh, GEAR.teeth, 1, soft, None, Cuts.FIXED, each).solve(loads)[0] for each in supports)
    assert np.abs(stiff - rigid).max() < 1e-4 * np.abs(rigid).max()


def test_responses_of_two_loads_are_symmetric(mesh: SectorMesh) -> None:
    """What a load on one tooth does to another is what the other's does to it, whatever holds the bore."""
    nodes = mesh.sides[OutlineSide.LEFT_FLANK][[0, 8]]
    loads = np.zeros((2 * len(mesh.points), 2))
    loads[2 * nodes, [0, 1]] = 1
    for hold in (Hold.FREE, Hold.SHAFT):
        moved = _free(mesh, 1, hold).solve(loads)[0]
        ahead, behind = loads.T @ moved[2], loads.T @ moved[0]
        assert ahead == pytest.approx(behind.T, rel=1e-7)
        assert loads.T @ moved[1] == pytest.approx((loads.T @ moved[1]).T, rel=1e-9)


# ---------------------------------------------------------------------- a thin ring


def annulus(outer: float, inner: float, sectors: int, along: int, through: int) -> SectorMesh:
    """A plain ring's sector: quadratic triangles in a grid."""
    radii, angles = np.linspace(outer, inner, 2 * through + 1), np.pi / sectors * np.linspace(1, -1, 2 * along + 1)
    points = (radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], -1)).reshape(-1, 2)
    number = np.arange(len(points)).reshape(len(radii), -1)
    triangles = []
    for i in range(0, 2 * through, 2):
        for j in range(0, 2 * along, 2):
            cell = number[i : i + 3, j : j + 3]
            triangles.append([cell[0, 0], cell[2, 0], cell[2, 2], cell[1, 0], cell[2, 1], cell[1, 1]])
            triangles.append([cell[0, 0], cell[2, 2], cell[0, 2], cell[1, 1], cell[1, 2], cell[0, 1]])
    sides = {
        OutlineSide.AHEAD: number[:, 0],
        OutlineSide.HELD: number[-1],
        OutlineSide.BEHIND: number[::-1, -1],
        OutlineSide.TIP: number[0, ::-1],
    }
    return SectorMesh(points, np.array(triangles), sides)


def test_a_thin_ring_bends_as_in_closed_form() -> None:
    """A force on a ring that shear of its bore balances: u_n = W R^3/(pi E' I (n^2 - 1)^2) of the radial displacement.

    Inextensional ring (Timoshenko, Strength of Materials II); the shear, of harmonics 0 and 1, does not bend it. The sum of
    the displacements at four places a quarter apart, with alternating signs, holds harmonics 2, 6, 10 ... alone.
    """
    radius, depth, teeth = 50.0, 1.0, 12
    mesh = annulus(radius + depth / 2, radius - depth / 2, teeth, 12, 2)
    ring = assemble(mesh, mesh, teeth, 1, ELASTIC, None, Cuts.FIXED, Support(Hold.FREE, teeth))
    middle = np.flatnonzero(np.hypot(*(mesh.points - [radius, 0]).T) < 1e-9)
    assert len(middle) == 1
    loads = np.zeros((2 * len(mesh.points), 1))
    loads[2 * middle] = -1.0
    row = SurfaceStresses(2 * middle[:, None], np.ones((1, 1)))
    moved, torques = ring.solve(loads)
    assert torques == pytest.approx(0.0, abs=1e-9)
    far = far_responses(ring, row, moved, ring.hub_forces(loads))
    radial = [float(row.by(moved[1])[0, 0]), *(float(far[k - 2][0, 0]) for k in (3, 6, 9))]
    series = sum(4 / (n * n - 1) ** 2 for n in range(2, 400, 4))
    bending = radius**3 / (math.pi * ELASTIC.modulus * depth**3 / 12) * series
    assert radial[0] - radial[1] + radial[2] - radial[3] == pytest.approx(-bending, rel=0.005)


# ---------------------------------------------------------------------- stresses of a rim that bends

FZG = Gear(teeth=16, normal_module=4.5, face_width=14, profile_shift=0.1817, body=Body(bore=30))
LOAD = ToothLoad(0, 18.0, 680.0)
"""About point D of the FZG pinion, with the whole load of stage 9."""


def _body(bore: float, hold: Hold, refined: float = 1.0, **body: float) -> PlaneCompliance:
    gear = replace(FZG, body=Body(bore=bore, **body))
    support = support_of(gear, bore / 2, hold)
    return flank_body(gear, bore / 2, ELASTIC, BodyModel(), 1, MeshSizes().refined(refined), flank_compliance, support)


def test_the_root_of_a_free_rim_is_stressed_more_the_thinner_it_is() -> None:
    """As Y_B of ISO 6336-3 has it within a fifth, where a rigid bore lets the stress fall."""
    thick = Fillets(_body(30, Hold.RIGID)).extreme(OutlineSide.RIGHT_FILLET, [LOAD]).stress
    kept = 1.0
    for bore in (40.0, 50.0, 55.0):
        ratio = rim_ratio(FZG, bore / 2)
        free, rigid = (
            Fillets(_body(bore, hold)).extreme(OutlineSide.RIGHT_FILLET, [LOAD]).stress for hold in (Hold.FREE, Hold.RIGID)
        )
        assert free / thick == pytest.approx(rim_thickness_factor(ratio, Edition.ISO_2006), rel=0.2)
        assert rigid / thick < kept
        kept = rigid / thick


def test_a_rim_that_bends_is_stretched_on_its_bore_and_at_other_teeth() -> None:
    """Under the load the bore is stretched and the roots are compressed; further round the roots are stretched."""
    free, rigid = (Fillets(_body(56, hold)) for hold in (Hold.FREE, Hold.RIGID))
    assert rigid.bore_tension([LOAD]) is None
    under = free.greatest(OutlineSide.LEFT_FILLET, [LOAD]).stress
    assert (free.bore_tension([LOAD]) or 0) > free.extreme(OutlineSide.LEFT_FILLET, [LOAD]).stress > 1.2 * under


def test_a_key_adds_what_the_ring_in_full_has(mesh: SectorMesh, in_full: InFull) -> None:
    """Its torque instead of that all round the bore, with the key under each tooth in turn: the worst of them is told.

    Strains of the ring in full are those of whole edges.
    """
    key = key_load(mesh, support_of(GEAR, INNER, Hold.KEY))
    loaded = np.flatnonzero(np.abs(key[::2, 0]) + np.abs(key[1::2, 0]))
    x, y = mesh.points.T
    assert key[:, 0] @ np.stack([-y, x], -1).ravel() == pytest.approx(1.0)
    # Edges of the bore that the keyway, 4 mm wide, reaches.
    assert 1.0 < np.abs(y[loaded]).max() < 2.0 + 1.5
    free, keyed = (Fillets(flank_compliance(GEAR, _free(mesh, 1, hold), ELASTIC)) for hold in (Hold.FREE, Hold.KEY))
    load = ToothLoad(0, float(free.body.loads[5]), 100.0)
    torque = load.force * GEAR.base_diameter / 2
    by_key = in_full.solve({0: torque * key})
    found = []
    for side in (OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FILLET):
        ends = mesh.sides[side][::2]
        root = free.places(side)[1].reshape(-1, 2).mean(axis=1) >= 12.0
        chord = np.diff(mesh.points[ends], axis=0)
        moved = by_key.reshape(GEAR.teeth, -1, 2)[:, ends]
        added = ELASTIC.modulus * (np.diff(moved, axis=1) * chord).sum(-1) / (chord**2).sum(-1)
        for own in range(GEAR.teeth):
            alone = free.stresses(side, [load._replace(tooth=-own)]).reshape(-1, 2).mean(axis=1)
            found.append((alone + added)[:, root].min())
    assert keyed.extreme(OutlineSide.RIGHT_FILLET, [load]).stress == pytest.approx(min(found), rel=0.02)
    assert min(found) < 1.1 * free.extreme(OutlineSide.RIGHT_FILLET, [load]).stress


# ---------------------------------------------------------------------- what is chosen, and refused


@pytest.mark.parametrize(("bore", "keyway", "expected"), [(30, 0, Hold.RIGID), (45, 0, Hold.FREE), (45, 10, Hold.KEY)])
def test_the_rim_chooses_its_support(bore: float, keyway: float, expected: Hold) -> None:
    gear = replace(FZG, body=Body(bore=bore, keyway_width=keyway, keyway_depth=3.0 if keyway else 0.0))
    assert support_of(gear, bore / 2).hold is expected


def test_a_keyway_takes_from_the_rim() -> None:
    gear = replace(FZG, body=Body(bore=36, keyway_width=10, keyway_depth=3.3))
    depth = (gear.tip_diameter - gear.root_diameter) / 2
    assert rim_ratio(gear, 18.0) == pytest.approx((gear.root_diameter / 2 - math.hypot(21.3, 5)) / depth)
    assert rim_ratio(gear, 17.0) == pytest.approx((gear.root_diameter / 2 - 17) / depth)


def test_what_cannot_hold_a_body_is_refused() -> None:
    pair = GearPair(pinion=FZG, wheel=replace(FZG, teeth=24))
    with pytest.raises(GeometryError, match=r"pinion.*keyway_width"):
        BodyModel(holds=PerGear(Hold.KEY, Hold.AUTO)).supports(pair)
    with pytest.raises(GeometryError, match=r"shaft_bore.*at most 29\.4 mm"):
        BodyModel(holds=PerGear(Hold.SHAFT, Hold.AUTO), shaft_bores=PerGear(29.9, 0.0)).supports(pair)
    with pytest.raises(ParameterError, match=r"wheel_support.*rigid"):
        BodyModel(teeth=5, holds=PerGear(Hold.AUTO, Hold.FREE)).supports(pair)
