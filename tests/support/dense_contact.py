"""Witnesses of contact: a ring and its pinion meshed whole, gaps between modified flanks, Hertz's elliptical contact."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize
from scipy.special import ellipe, ellipk

from gearcad import FlankModification, Gear, GearPair, Material, Mounting, ReliefShape
from gearcad.contact.plane.pair import contact_pairs
from gearcad.contact.shared.line_of_action import line_of_action
from gearcad.core.records import Floats
from gearcad.geometry.curves import CurveKind
from support.modified import relieved

_FINE, _FILLET, _COARSE, _BODY = 0.015, 0.03, 0.5, 2.0
"""Edges (mm per 2 mm of module) of flanks that touch, their fillets, other outlines, and bore or rim."""

_NEAR = 0.02
"""Gap (mm) within which nodes can come to touch."""


_AT_ONCE = 50
"""Loads that are solved together: all of them would fill the memory."""


@dataclass(frozen=True)
class Found:
    """Stiffness (N/(mm·µm)), greatest root tension of pinion and ring (MPa), and what each pair of teeth carries (N per mm)."""

    stiffness: float
    tension: tuple[float, float]
    forces: tuple[float, ...]


@dataclass(frozen=True)
class _Body:
    """A gear as it stands: nodes of the flank and the fillet of each loaded tooth, and a factor of its held stiffness."""

    points: Floats
    flanks: list[NDArray[np.int64]]
    fillets: list[NDArray[np.int64]]
    solve: Any


def _outline(gear: Gear, turn: float, loaded: dict[int, int]) -> tuple[Floats, dict[int, slice], dict[int, slice]]:
    """Polygon (n, 2) about the origin, and where on it the flanks with y > 0 (1) or y < 0 (-1) of `loaded` teeth, and their
    fillets, lie.
    """
    scale, points, count = gear.normal_module / 2, list[Floats](), 0
    flanks, fillets = dict[int, slice](), dict[int, slice]()
    for tooth in range(gear.tooth_count):
        key = tooth if 2 * tooth < gear.tooth_count else tooth - gear.tooth_count
        side = loaded.get(key)
        angle = turn + 2 * math.pi * tooth / gear.tooth_count
        rotation = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        for own in (-1, 1):
            curves = gear.profile.curves if own < 0 else gear.profile.curves[::-1]
            for curve in curves:
                size = scale * _COARSE
                if own == side:
                    size = scale * {CurveKind.INVOLUTE: _FINE, CurveKind.FILLET: _FILLET}.get(curve.kind, 0.05)
                s = np.linspace(0, 1, 2001)
                run = np.r_[0.0, np.cumsum(np.hypot(*np.diff(curve.points(s), axis=0).T))]
                edges = max(2, math.ceil(run[-1] / size))
                at = np.interp(np.linspace(0, run[-1], edges + 1), run, s)
                each = curve.points(at if own < 0 else at[::-1]) * [1.0, own]
                points.append((each @ rotation)[:-1])
                if own == side and curve.kind in (CurveKind.INVOLUTE, CurveKind.FILLET):
                    (flanks if curve.kind is CurveKind.INVOLUTE else fillets)[key] = slice(count, count + edges + 1)
                count += edges
    return np.concatenate(points), flanks, fillets


def _filled(outer: Floats, inner: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """Points and triangles between two polygons, whose corners come first."""
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.set_number("General.Terminal", 0)
        gmsh.option.set_number("Mesh.MeshSizeFromPoints", 0)
        gmsh.option.set_number("Mesh.Algorithm", 6)
        loops, first = [], 1
        for polygon in (outer, inner):
            numbers = range(first, first + len(polygon))
            for number, (x, y) in zip(numbers, polygon, strict=True):
                gmsh.model.geo.add_point(x, y, 0, tag=number)
            for number in numbers:
                gmsh.model.geo.add_line(number, number + 1 if number < numbers[-1] else first, tag=number)
                gmsh.model.geo.mesh.set_transfinite_curve(number, 2)
            loops.append(gmsh.model.geo.add_curve_loop(list(numbers)))
            first += len(polygon)
        surface = gmsh.model.geo.add_plane_surface(loops)
        gmsh.model.geo.synchronize()
        gmsh.model.mesh.generate(2)
        tags, coordinates, _ = gmsh.model.mesh.get_nodes()
        corners = [int(gmsh.model.mesh.get_nodes(0, number)[0][0]) for number in range(1, first)]
        found = gmsh.model.mesh.get_elements_by_type(2, surface)[1].astype(int)
    finally:
        gmsh.finalize()
    known = set(corners)
    order = np.array([*corners, *(int(tag) for tag in tags if int(tag) not in known)])
    place = np.zeros(int(tags.max()) + 1, int)
    place[order] = np.arange(len(order))
    row = np.zeros(int(tags.max()) + 1, int)
    row[tags.astype(int)] = np.arange(len(tags))
    return coordinates.reshape(-1, 3)[row[order], :2], place[found].reshape(-1, 3)


def _body(gear: Gear, turn: float, loaded: dict[int, int], material: Material) -> _Body:
    """Mesh and factorise a gear whose bore, or rim, is held."""
    import scipy.sparse.linalg
    from skfem import Basis, ElementTriP2, ElementVector, MeshTri
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    teeth, flanks, fillets = _outline(gear, turn, loaded)
    radius = (gear.body.rim_diameter if gear.internal else gear.body.bore) / 2  # type: ignore[operator]
    angle = np.linspace(0, 2 * np.pi, math.ceil(2 * np.pi * radius / (gear.normal_module / 2 * _BODY)), endpoint=False)
    held = radius * np.stack([np.cos(angle), np.sin(angle)], -1)
    points, triangles = _filled(held, teeth) if gear.internal else _filled(teeth, held)
    mesh = MeshTri(points.T.copy(), triangles.T.copy())
    basis = Basis(mesh, ElementVector(ElementTriP2()), intorder=4)
    stiffness = linear_elasticity(*lame_parameters(material.youngs_modulus, material.poisson_ratio)).assemble(basis)
    at = basis.doflocs
    # Dofs of a node: x and y of a vertex, or of the middle of an edge.
    places = {(round(x, 9), round(y, 9)): dof for dof, (x, y) in enumerate(at.T) if dof % 2 == 0}
    distance, least = np.hypot(*at), radius * math.cos(math.pi / len(held))  # chords of the circle, and what they shut off
    fixed = np.flatnonzero(distance > least - 1e-9 if gear.internal else distance < radius + 1e-9)
    free = np.setdiff1d(np.arange(stiffness.shape[0]), fixed)
    factor = scipy.sparse.linalg.splu(stiffness[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01)

    def solve(forces: Any) -> Floats:
        moved = np.zeros(forces.shape)
        moved[free] = factor.solve(forces[free])
        return moved

    def nodes(span: slice, middles: bool) -> NDArray[np.int64]:
        chain = teeth[np.arange(span.start, span.stop) % len(teeth)]
        both = np.empty((2 * len(chain) - 1, 2))
        both[::2], both[1::2] = chain, (chain[1:] + chain[:-1]) / 2
        return np.array([places[round(x, 9), round(y, 9)] for x, y in (both if middles else chain)])

    order = sorted(loaded)
    return _Body(
        at.T, [nodes(flanks[tooth], True) for tooth in order], [nodes(fillets[tooth], False) for tooth in order], solve
    )


def dense_contact(pair: GearPair, material: Material, torque: float, length: float) -> Found:
    """Press a pinion (torque in N·m) into its ring where the middle pair touches at `length` (mm from T1), without backlash."""
    import scipy.sparse

    along, base = math.radians(pair.working_transverse_pressure_angle), pair.pinion.base_diameter / 2
    normal, tangent = np.array([math.sin(along), math.cos(along)]), np.array([math.cos(along), -math.sin(along)])
    turn = -along - (math.radians(pair.pinion.base_half_angle) - length / base)
    pose, pitch = pair.wheel_pose(math.degrees(turn)), 2 * math.pi / pair.wheel.tooth_count
    # The ring's tooth whose flank with y < 0 meets tooth 0 of the pinion on the line of action.
    touch = base * tangent + length * normal - [pose.x, 0.0]
    half = math.radians(float(pair.wheel.profile.half_angle(float(np.hypot(*touch)))))
    meets = round((math.atan2(touch[1], touch[0]) + half - math.radians(pose.rotation)) / pitch)
    pinion = _body(pair.pinion, turn, {-1: 1, 0: 1, 1: 1}, material)
    ring = _body(pair.wheel, math.radians(pose.rotation) + meets * pitch, {-1: -1, 0: -1, 1: -1}, material)
    rows = [
        _facing(pinion.points[own], ring.points[mate] + [pose.x, 0.0], normal, tangent)
        for own, mate in zip(pinion.flanks, ring.flanks, strict=True)
    ]
    gap = np.concatenate([each[1] for each in rows])
    arms, own, mates = [], [], []
    for flank, mate, (chosen, _, low, share) in zip(pinion.flanks, ring.flanks, rows, strict=True):
        at = pinion.points[flank[chosen]]
        arms.append(at[:, 0] * normal[1] - at[:, 1] * normal[0])
        own.append(_loads(flank[chosen], np.ones(len(chosen)), -normal, len(pinion.points)))
        mates.append(
            _loads(mate[low], 1 - share, normal, len(ring.points)) + _loads(mate[low + 1], share, normal, len(ring.points))
        )
    arm, on_pinion, on_ring = np.concatenate(arms), scipy.sparse.hstack(own, "csc"), scipy.sparse.hstack(mates, "csc")
    matrix = _compliance(pinion, on_pinion) + _compliance(ring, on_ring)
    forces, angle = _pressed(matrix, gap, arm, abs(torque) * 1000 / pair.common_width.width)
    modulus = material.youngs_modulus / (1 - material.poisson_ratio**2)
    tension = tuple(
        max(_greatest(body, fillet, body.solve(each @ forces), modulus) for fillet in body.fillets)
        for body, each in ((pinion, on_pinion), (ring, on_ring))
    )
    force = abs(torque) * 1000 / pair.common_width.width / base
    ends = np.cumsum([len(each[0]) for each in rows])[:-1]
    carried = tuple(float(part.sum()) for part in np.split(forces, ends))
    return Found(force / (angle * base * 1000), (tension[0], tension[1]), carried)


def _compliance(body: _Body, loads: Any) -> Floats:
    """What loads (dofs, n) move each other, (n, n)."""
    found = [loads.T @ body.solve(loads[:, k : k + _AT_ONCE].toarray()) for k in range(0, loads.shape[1], _AT_ONCE)]
    return np.concatenate(found, axis=1)


def _facing(points: Floats, mates: Floats, normal: Floats, tangent: Floats) -> tuple[Any, Floats, Any, Floats]:
    """Nodes that have a mate along the normal nearby: which, their gaps, between which nodes of the mate, with what share."""
    order = np.argsort(mates @ tangent)
    across, place = (mates @ tangent)[order], points @ tangent
    inside = np.flatnonzero((place > across[0]) & (place < across[-1]))
    after = np.searchsorted(across, place[inside])
    share = (place[inside] - across[after - 1]) / (across[after] - across[after - 1])
    height = (mates @ normal)[order]
    gap = (1 - share) * height[after - 1] + share * height[after] - points[inside] @ normal
    near = gap < _NEAR
    low, high = order[after - 1][near], order[after][near]
    rising = high > low
    return inside[near], gap[near], np.where(rising, low, high), np.where(rising, share[near], 1 - share[near])


def _loads(dofs: Any, amounts: Floats, direction: Floats, count: int) -> Any:
    """A force at each node, whose first dof is given: one column each of a sparse matrix."""
    import scipy.sparse

    rows, column = np.r_[dofs, dofs + 1], np.tile(np.arange(len(dofs)), 2)
    return scipy.sparse.csc_matrix((np.r_[amounts * direction[0], amounts * direction[1]], (rows, column)), (count, len(dofs)))


def _pressed(matrix: Floats, gap: Floats, arm: Floats, moment: float) -> tuple[Floats, float]:
    """Forces that press (N per mm) and the turn of the pinion (rad) that a moment (N mm per mm) makes."""
    active = gap < 0.01
    for _ in range(200):
        rows = np.flatnonzero(active)
        system = np.block([[matrix[np.ix_(rows, rows)], -arm[rows][:, None]], [arm[rows][None], np.zeros((1, 1))]])
        solved = np.linalg.solve(system, np.r_[-gap[rows], moment])
        forces = np.zeros(len(gap))
        forces[rows], angle = solved[:-1], float(solved[-1])
        opening = matrix @ forces + gap - angle * arm
        wrong = np.where(active, forces <= 0, opening < -1e-12)
        if not wrong.any():
            return forces, angle
        active = active ^ wrong
    raise AssertionError("the witness did not settle")


def _greatest(body: _Body, fillet: Any, moved: Floats, modulus: float) -> float:
    """Greatest tension (MPa) along a fillet, by how far its chords stretch."""
    chord = np.diff(body.points[fillet], axis=0)
    stretch = np.diff(np.stack([moved[fillet], moved[fillet + 1]], -1), axis=0)
    return float((modulus * (stretch * chord).sum(1) / (chord**2).sum(1)).max())


_SAMPLES = 40_001
"""Points of a flank in one transverse section: a quarter of a µm apart, chords 1e-9 mm off the curve."""


def middle_height(pair: GearPair) -> float:
    """z of the middle of the common face width (mm)."""
    return pair.pinion.face_width / 2 + pair.common_width.offset


def _rolls(gear: Gear) -> tuple[float, float]:
    """Roll lengths of the ends of the flank, root and tip (mm): r_b tan of the pressure angle there, negative on a ring."""
    ends = (gear.form_diameter, gear.tip_form_diameter)
    return tuple(gear.base_diameter / 2 * math.tan(math.acos(min(gear.base_diameter / end, 1.0))) for end in ends)  # type: ignore[return-value]


def _relief(amount: float, length: float, shape: ReliefShape, from_end: Floats) -> Floats:
    """Of a relief at distances from the end where it is deepest (µm)."""
    if not amount:
        return np.zeros_like(from_end)
    linear = np.interp(from_end, [0.0, length], [1.0, 0.0])
    return amount * (linear if shape is ReliefShape.LINEAR else linear * linear)


def taken_back(gear: Gear, lengths: Floats, heights: Floats) -> Floats:
    """How far (mm) the flank that meets its mate is taken back at roll lengths and heights over the gear's own z = 0."""
    of: FlankModification = gear.modification
    first, last = _rolls(gear)
    lengths, heights = np.broadcast_arrays(np.clip(lengths, first, last), np.clip(heights, 0, gear.face_width))
    middle, half = (first + last) / 2, (last - first) / 2
    centre, side = gear.face_width / 2, gear.face_width / 2
    amount = relieved(gear, "tip", lengths - last + of.tip_relief_length)
    amount = amount + relieved(gear, "root", first + of.root_relief_length - lengths)
    for from_end in (heights, gear.face_width - heights):
        amount = amount + _relief(of.end_relief, of.end_relief_length, of.end_relief_shape, from_end)
    amount = amount + of.profile_crowning * ((lengths - middle) / half) ** 2
    amount = amount + of.lead_crowning * ((heights - centre) / side) ** 2
    amount = amount + np.interp(lengths, [first, last], [0.0, of.pressure_angle_modification])
    # A right-hand screw turns counter-clockwise with z, the left flank away from its tooth: more of it adds material above.
    # Of a ring it is the other flank that meets the pinion.
    hand = (-1.0 if gear.helix_angle < 0 else 1.0) * math.copysign(1.0, gear.teeth)
    amount = amount - hand * np.interp(heights, [0.0, gear.face_width], [-0.5, 0.5]) * of.helix_angle_modification
    # Opposite corners alike: the diagonals rise and fall by a quarter.
    amount = amount + of.twist / 4 * ((lengths - middle) / half) * ((heights - centre) / side)
    return amount / 1000


def _section(base: float, contact: Floats, lengths: Floats, turned: Floats) -> tuple[Floats, Floats]:
    """Involute through (base, contact) with its normal along y, its points turned clockwise about the origin by an angle."""
    angle = (contact - lengths) / base - turned
    return base * np.cos(angle) - lengths * np.sin(angle), base * np.sin(angle) + lengths * np.cos(angle)


def _contact(pair: GearPair, roll_length: float, tooth: int, heights: Floats) -> Floats:
    """Roll length on the pinion at which exact flanks touch at heights: the line of contact leans by the base helix angle."""
    lean = math.tan(math.radians(pair.pinion.base_helix_angle))
    return roll_length + tooth * pair.pinion.transverse_base_pitch + (np.asarray(heights) - middle_height(pair)) * lean


def _whole(pair: GearPair) -> float:
    """T1T2 (mm), negative where the wheel is a ring."""
    square = pair.centre_distance**2 - ((pair.pinion.base_diameter + pair.wheel.base_diameter) / 2) ** 2
    return math.copysign(math.sqrt(square), pair.wheel.teeth)


def pinion_points(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, lengths: Floats, heights: Floats
) -> Floats:
    """Points (..., 3) of the pinion's flank at roll lengths and heights z, when tooth 0 touches at `roll_length` in the middle.

    The pair is as mounted (`Mounting.mounted`).
    """
    base = pair.pinion.base_diameter / 2
    proud = mounting.pinion_pitch_error / 1000 if tooth == 0 else 0.0
    turned = (taken_back(pair.pinion, lengths, heights) - proud) / base
    x, y = _section(base, _contact(pair, roll_length, tooth, heights), lengths, turned)
    return np.stack(np.broadcast_arrays(x, y, heights), -1)


def wheel_points(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, lengths: Floats, heights: Floats
) -> Floats:
    """The same of the wheel's flank that faces it; heights are z of the pinion, lengths the wheel's own from T2."""
    base, whole = abs(pair.wheel.base_diameter) / 2, _whole(pair)
    own = heights - (pair.pinion.face_width - pair.wheel.face_width) / 2 - pair.axial_offset
    proud = mounting.wheel_pitch_error / 1000 if tooth == 0 else 0.0
    turned = (taken_back(pair.wheel, lengths, own) - proud) / base
    touching, first = _contact(pair, roll_length, tooth, heights), pair.pinion.base_diameter / 2
    if pair.wheel.teeth > 0:
        # Half a turn about the middle of T1T2 lays the wheel's flank where a pinion's would be.
        x, y = _section(base, whole - touching, lengths, turned)
        x, y = first + base - x, whole - y
    else:
        # The base circles touch the line of action from the same side; what comes off the ring's flank moves it towards +y.
        x, y = _section(base, touching - whole, -lengths, -turned)
        x, y = first - base + x, whole + y
    along = (heights - middle_height(pair)) / pair.common_width.width / 1000
    x, y = x + mounting.misalignment_across * along, y + mounting.misalignment * along
    return np.stack(np.broadcast_arrays(x, y, heights), -1)


def gap_along_action(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, heights: Floats, places: Floats
) -> Floats:
    """Gap (mm) in the direction of the line of action at heights z and places x - r_b1 on the tangent: (heights, places).

    NaN where one of the flanks does not reach the place.
    """
    gap = np.full((len(heights), len(places)), math.nan)
    for row, z in enumerate(heights):
        curves = []
        for gear, points in ((pair.pinion, pinion_points), (pair.wheel, wheel_points)):
            lengths = np.linspace(*_rolls(gear), _SAMPLES)
            found = points(pair, mounting, roll_length, tooth, lengths, np.full_like(lengths, z))
            x, y = found[:, 0] - pair.pinion.base_diameter / 2, found[:, 1]
            order = np.argsort(x)
            curves.append(np.interp(places, x[order], y[order], left=math.nan, right=math.nan))
        gap[row] = curves[1] - curves[0]
    return gap


def distance_in_space(
    pair: GearPair, mounting: Mounting, roll_length: float, tooth: int, length: float, height: float
) -> float:
    """Distance (mm) of one point of the pinion's flank from the wheel's flank, the nearest of all its points."""
    point = pinion_points(pair, mounting, roll_length, tooth, np.array(length), np.array(height))

    def squared(where: Floats) -> float:
        other = wheel_points(pair, mounting, roll_length, tooth, np.array(where[0]), np.array(where[1]))
        return float(1e6 * ((other - point) ** 2).sum())

    start = _whole(pair) - float(_contact(pair, roll_length, tooth, np.array(height)))
    best = minimize(squared, [start, height], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-15, "maxiter": 4000})
    return math.sqrt(best.fun) / 1000


def hertz_ellipse(force: float, across: float, along: float, modulus: float) -> tuple[float, float, float]:
    """p_0 (MPa), greater and lesser half axis (mm) of an elliptical contact (Johnson, Contact Mechanics, 4.26 to 4.32)."""

    def ratio(slim: float) -> float:
        m = 1 - slim**2
        return float((ellipe(m) / slim**2 - ellipk(m)) / (ellipk(m) - ellipe(m))) - along / across

    slim = float(brentq(ratio, 1e-4, 1 - 1e-9))
    m = 1 - slim**2
    greater = (3 * force * (ellipk(m) - ellipe(m)) * along / (math.pi * m * modulus)) ** (1 / 3)
    return 3 * force / (2 * math.pi * greater**2 * slim), greater, greater * slim


def involute(base: float, start: float, lengths: Any) -> Any:
    """Points of an involute that begins on the base circle at the angle `start`, unrolled counter-clockwise."""
    angle = start + lengths / base
    return np.stack([base * np.cos(angle) + lengths * np.sin(angle), base * np.sin(angle) - lengths * np.cos(angle)], -1)


def pair_of_tooth_0(pair: GearPair, length: float, span: float, cells: int) -> Any:
    """The flanks of tooth 0 in a section, so far (mm) along the line of action, with `cells` over a `span` (mm)."""
    found = contact_pairs(line_of_action(pair), length, lambda _tooth, _radius: span, cells, 0.01)
    (only,) = [each for each in found if each.tooth == 0]
    return only
