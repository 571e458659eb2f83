"""A witness of contact in a ring: both gears whole, meshed finely where they touch, and nothing else taken from the product.

Straight-sided quadratic triangles fill the exact outlines, all teeth and the body; nodes of the pinion's flanks press on the
ring's, along the line of action. No sector, no condensation to cuts, no field of a point load: only `gear.profile` and the
pose of the pair are the product's own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcad import Gear, GearPair, Material
from gearcad.geometry.profile import CurveKind

Floats = NDArray[np.float64]

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
