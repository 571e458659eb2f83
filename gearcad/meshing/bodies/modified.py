"""How far modifications of the flanks turn every node of a section: exactly on the outline, harmonically inside it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from gearcad.arrays import Bools, Floats, Wholes
from gearcad.geometry import Gear
from gearcad.geometry.curves import CurveKind, Fillet
from gearcad.geometry.turned import FlankCurve, flank_curves
from gearcad.meshing.bodies.elements import Element
from gearcad.meshing.bodies.mesh import Cells, ElementMesh
from gearcad.meshing.bodies.names import body_side, rises

__all__ = ["Turns", "modification_turns"]


_NEGLIGIBLE = 1e-14
"""Share of the greatest turn that a field may have and be left out."""


@dataclass(frozen=True)
class Turns:
    """Angles (rad) by which the nodes of a section are turned at some heights: sums of a few `fields` (k, nodes), taken with
    `shares` (heights, k).
    """

    shares: Floats
    fields: Floats

    def at(self, height: int) -> Floats:
        """Those of all nodes (n,) at one of the heights, by its number."""
        result: Floats = self.shares[height] @ self.fields
        return result


def modification_turns(section: ElementMesh, gear: Gear, heights: Floats) -> Turns:
    """The turns at heights z (n,) in mm of the nodes of a section of the unmodified gear, its teeth where they are at z = 0.

    Flanks, fillets and chamfers turn by their depth, lands in proportion between their ends, the circle where the body ends
    not at all, both cuts alike. Inside, the turn is harmonic, so that it takes as little as can be from any element; nodes
    between vertices turn by the mean of both.
    """
    if not gear.modification.present:
        return Turns(np.zeros((len(heights), 0)), np.zeros((0, len(section.points))))
    nodes, turns = _on_outline(section, gear, heights)
    shares, sizes, given = np.linalg.svd(turns, full_matrices=False)
    kept = sizes > _NEGLIGIBLE * sizes[0] if sizes[0] else np.zeros(len(sizes), bool)
    return Turns((shares * sizes)[:, kept], _extended(section, nodes, given[kept]))


# ---------------------------------------------------------------------- the outline


class _Part(Enum):
    """Parts of the outline that modifications turn."""

    FLANK = "flank"
    FILLET = "fillet"
    ROOT = "root"
    TIP = "tip"


_TURNED = re.compile(r"(?:(left|right)_(flank|fillet|root)|(tip))_(\d+)")
"""Names of their sides, with the tooth's number."""


def _parts(section: ElementMesh) -> Iterator[tuple[_Part, str, Wholes, Wholes]]:
    """Each part of the outline, with nodes of all teeth and the tooth of each; "left", "right" or None, of both."""
    found: dict[tuple[str, str], list[tuple[Wholes, int]]] = {}
    for name in section.sides:
        if match := _TURNED.fullmatch(name):
            side, part, tip, tooth = match.groups()
            found.setdefault((part or tip, side), []).append((section.nodes(name).astype(np.int64), int(tooth)))
    for (part, side), of_teeth in found.items():
        numbers = np.repeat([tooth for _, tooth in of_teeth], [len(nodes) for nodes, _ in of_teeth])
        yield _Part(part), side, np.concatenate([nodes for nodes, _ in of_teeth]), numbers


def _on_outline(section: ElementMesh, gear: Gear, heights: Floats) -> tuple[Wholes, Floats]:
    """Nodes (m,) whose turns are known, and these (heights, m)."""
    outline = _Outline(gear, heights)
    pitch = 2 * np.pi / gear.tooth_count
    end = body_side(gear)
    held = section.nodes(end).astype(np.int64) if end in section.sides else np.zeros(0, int)
    nodes, turns = [held], [np.zeros((len(heights), len(held)))]
    for part, side, of_part, tooth in _parts(section):
        x, y = section.points[of_part, :2].T
        angle = np.remainder(np.arctan2(y, x) - pitch * tooth + np.pi, 2 * np.pi) - np.pi
        nodes.append(of_part)
        turns.append(outline.turns(part, np.hypot(x, y), angle, left=rises(gear, side)))
    every, first = np.unique(np.concatenate(nodes), return_index=True)
    return every, np.concatenate(turns, axis=1)[:, first]


@dataclass(frozen=True)
class _Outline:
    """The outline of tooth 0 at some heights (mm)."""

    gear: Gear
    heights: Floats

    def turns(self, part: _Part, radius: Floats, angle: Floats, *, left: bool) -> Floats:
        """Turns (heights, n) of points of a part at radii (mm) and angles (rad) from the middle of tooth 0."""
        if part is _Part.FLANK:
            return self._of_lengths(self._rolls(radius), left=left)
        if part is _Part.FILLET:
            return self._of_fillet(self._fillet_parameters(radius), left=left)
        if part is _Part.TIP:
            return self._of_tip(angle)
        return self._of_root_land(np.abs(angle), left=left)

    def _rolls(self, radius: Floats) -> Floats:
        """Roll lengths (mm), as the flank's form has them."""
        base = self.gear.profile.base_diameter / 2
        lengths = np.sqrt(np.maximum((radius - base) * (radius + base), 0.0))
        return -lengths if self.gear.internal else lengths

    def _of_lengths(self, lengths: Floats, *, left: bool) -> Floats:
        return self.gear.flank_form.turn(lengths, self.heights[:, None], left=left)

    @property
    def _fillet(self) -> FlankCurve:
        return next(each for each in flank_curves(self.gear) if each.curve.kind is CurveKind.FILLET)

    def _fillet_parameters(self, radius: Floats) -> Floats:
        """Parameters of the points of the fillet at radii (mm)."""
        fillet = self._fillet.curve
        assert isinstance(fillet, Fillet)
        spread = np.arcsinh(np.tan(fillet.tool.theta_at(radius, fillet.last)))
        result: Floats = spread / np.arcsinh(np.tan(fillet.last))
        return result

    def _of_fillet(self, s: Floats, *, left: bool) -> Floats:
        return self._fillet.turn(self.gear.flank_form, s, self.heights[:, None], left=left)

    def _of_tip(self, angle: Floats) -> Floats:
        """Chamfers turn with the ends of the flanks, the land between its own ends."""
        end = np.array([self.gear.flank_form.last])
        left, right = self._of_lengths(end, left=True), self._of_lengths(end, left=False)
        land = self.gear.profile.curves[-1]
        place = np.clip(angle / float(land.polar(0.0)[1]), -1, 1)
        return left * (1 + place) / 2 + right * (1 - place) / 2

    def _of_root_land(self, angle: Floats, *, left: bool) -> Floats:
        """From the end of this fillet to the cut in the middle of the land, which is between both ends."""
        end = np.zeros(1)
        own, other = self._of_fillet(end, left=left), self._of_fillet(end, left=not left)
        middle = np.pi / self.gear.tooth_count
        place = (middle - angle) / (middle - float(self._fillet.curve.polar(0.0)[1])) / 2
        return other + (own - other) * (place + 0.5)


# ---------------------------------------------------------------------- the inside


def _extended(section: ElementMesh, nodes: Wholes, given: Floats) -> Floats:
    """Fields (k, n) that are `given` (k, m) at some nodes (m,), harmonic at the other vertices and the same on both cuts."""
    shape = section.element.shape
    fields = np.zeros((len(given), len(section.points)))
    fields[:, nodes] = given
    known: Bools = np.zeros(len(section.points), bool)
    known[nodes] = True
    _fill_inside(section, known, fields)
    ends = section.cells[:, np.array(shape.edges)]
    middles = section.cells[:, shape.vertices :]
    inside = ~known[middles]
    middles, ends = middles[inside], ends[inside]
    fields[:, middles] = (fields[:, ends[:, 0]] + fields[:, ends[:, 1]]) / 2
    return fields


def _fill_inside(section: ElementMesh, known: Bools, fields: Floats) -> None:
    """Set the fields (k, n) at vertices that are not known: Laplace's equation, by finite elements of first order."""
    from scipy.sparse import csr_array
    from scipy.sparse.linalg import splu

    vertices, matrix = _laplacian(section)
    same = np.arange(len(section.points))
    for pairs in section.matched.values():
        same[pairs[:, 1]] = pairs[:, 0]
    values, first, column = np.unique(same[vertices], return_index=True, return_inverse=True)
    tie = csr_array((np.ones(len(vertices)), (np.arange(len(vertices)), column)))
    matrix = (tie.T @ matrix @ tie).tocsc()
    free, fixed = np.flatnonzero(~known[values]), np.flatnonzero(known[values])
    found = fields[:, vertices[first]].T.copy()
    found[free] = splu(matrix[free][:, free]).solve(-(matrix[free][:, fixed] @ found[fixed]))
    fields[:, vertices] = found[column].T


def _laplacian(section: ElementMesh) -> tuple[Cells, Any]:
    """The vertices (n,) of a section, and the matrix (n, n) of Laplace's equation on them."""
    from skfem import Basis, ElementQuad1, ElementTriP1, MeshQuad1, MeshTri1
    from skfem.models.poisson import laplace

    corners = section.cells[:, : section.element.shape.vertices]
    vertices, numbers = np.unique(corners, return_inverse=True)
    mesh, element = (MeshQuad1, ElementQuad1) if section.element is Element.QUAD8 else (MeshTri1, ElementTriP1)
    places, numbers = section.points[vertices, :2].T, numbers.reshape(corners.shape).T
    basis = Basis(mesh(np.ascontiguousarray(places), np.ascontiguousarray(numbers)), element())
    return vertices, laplace.assemble(basis)
