"""Stepped shafts as solids for CalculiX: rings of hexahedra of second order, bearings and forces spread over their sections.

A section has nodes on rays and on rings at every radius that a segment has. A force, or the springs of a bearing, are shared by
the nodes half-way along the sides of its faces by their areas; the place of a section is the mean of these nodes. So nothing
keeps a section plane.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np

from gearcad.core.records import Floats
from gearcad.shafts.beam import SteppedShaft

RAYS, THICKEST, WIDEST = 12, 8.0, 8.0
"""Sectors around the axis, and the greatest length of an element along the axis and along a radius (mm)."""


def divided(places: Floats, longest: float) -> Floats:
    """Return places (n,) with others between them, no two further apart than that (mm)."""
    places = np.unique(np.round(places, 9))
    parts = [np.linspace(a, b, int(np.ceil((b - a) / longest)) + 1)[:-1] for a, b in pairwise(places.tolist())]
    return np.concatenate([*parts, places[-1:]])


class SolidShaft:
    """A hollow stepped shaft of one bore, bent in the plane x-z by the forces on it."""

    def __init__(self, shaft: SteppedShaft) -> None:
        self.shaft = shaft
        radii = [each.outer_diameter / 2 for each in shaft.segments]
        self.rings = divided(np.array([shaft.segments[0].inner_diameter / 2, *radii]), WIDEST)
        self.heights = divided(shaft.nodes, THICKEST)
        self.numbers: dict[tuple[int, int, int], int] = {}
        self.points: list[tuple[float, float, float]] = []
        middles = (self.heights[1:] + self.heights[:-1]) / 2
        outer = [radii[int(np.searchsorted(shaft.ends[1:-1], z))] for z in middles]
        self.elements = [
            self._element(ring, ray, layer)
            for layer, radius in enumerate(outer)
            for ring in range(len(self.rings) - 1)
            if self.rings[ring + 1] < radius + 1e-6
            for ray in range(RAYS)
        ]

    def _element(self, ring: int, ray: int, layer: int) -> list[int]:
        """Return 20 nodes: corners below and above, then half-way below, above and between, as C3D20R has them."""
        corners = [(0, 0), (2, 0), (2, 2), (0, 2)]
        sides = [(1, 0), (2, 1), (1, 2), (0, 1)]
        local = [(*each, z) for z in (0, 2) for each in corners]
        local += [(*each, 0) for each in sides] + [(*each, 2) for each in sides] + [(*each, 1) for each in corners]
        return [self._node(2 * ring + a, (2 * ray + b) % (2 * RAYS), 2 * layer + c) for a, b, c in local]

    def _node(self, ring: int, ray: int, layer: int) -> int:
        key = (ring, ray, layer)
        if key not in self.numbers:
            radius, height = (
                np.interp(at / 2, np.arange(len(of)), of) for at, of in ((ring, self.rings), (layer, self.heights))
            )
            angle = np.pi * ray / RAYS
            self.points.append((float(radius * np.cos(angle)), float(radius * np.sin(angle)), float(height)))
            self.numbers[key] = len(self.points)
        return self.numbers[key]

    def section(self, position: float) -> dict[int, float]:
        """Return the share of each node of a section: of the thinner one at a step."""
        layer = 2 * int(np.argmin(np.abs(self.heights - position)))
        beside = [
            radius for z in (-1e-3, 1e-3) if 0 < position + z < self.shaft.length for radius in [self._radius(position + z)]
        ]
        shares: dict[int, float] = {}
        for ring in range(len(self.rings) - 1):
            if self.rings[ring + 1] > min(beside) + 1e-6:
                continue
            area = self.rings[ring + 1] ** 2 - self.rings[ring] ** 2
            for ray in range(RAYS):
                for a, b in ((1, 0), (2, 1), (1, 2), (0, 1)):
                    node = self.numbers[2 * ring + a, (2 * ray + b) % (2 * RAYS), layer]
                    shares[node] = shares.get(node, 0.0) + area
        total = sum(shares.values())
        return {node: share / total for node, share in shares.items()}

    def _radius(self, position: float) -> float:
        return self.shaft.segments[int(np.searchsorted(self.shaft.ends[1:-1], position))].outer_diameter / 2

    def write(self, path: Path) -> None:
        """Write the deck; the displacements of all nodes are printed."""
        lines = ["*NODE, NSET=all", *(f"{n}, {x:.9e}, {y:.9e}, {z:.9e}" for n, (x, y, z) in enumerate(self.points, 1))]
        lines.append("*ELEMENT, TYPE=C3D20R, ELSET=shaft")
        for number, nodes in enumerate(self.elements, 1):
            lines += [", ".join(map(str, [number, *nodes[:15]])) + ",", ", ".join(map(str, nodes[15:]))]
        first = self.shaft.segments[0]
        elastic = f"{first.youngs_modulus:.6e}, {first.poisson_ratio}"
        lines += ["*MATERIAL, NAME=steel", "*ELASTIC", elastic, "*SOLID SECTION, ELSET=shaft, MATERIAL=steel"]
        element = len(self.elements) + 1
        for bearing in self.shaft.bearings:
            for node, share in self.section(bearing.position).items():
                for axis in (1, 2):
                    name = f"spring_{element}"
                    lines += [
                        f"*ELEMENT, TYPE=SPRING1, ELSET={name}",
                        f"{element}, {node}",
                        f"*SPRING, ELSET={name}",
                        f"{axis}",
                    ]
                    lines.append(f"{bearing.springs()[0] * share:.9e}")
                    element += 1
        held = self.numbers[0, RAYS // 2, 0]  # on the neutral axis
        lines += ["*BOUNDARY", f"{held}, 3", "*STEP", "*STATIC", "*CLOAD"]
        for force in self.shaft.forces:
            lines += [f"{node}, 1, {force.force[0] * share:.9e}" for node, share in self.section(force.position).items()]
        path.write_text("\n".join([*lines, "*NODE PRINT, NSET=all", "U", "*END STEP", ""]), encoding="ascii")

    def found(self, path: Path, position: float) -> tuple[float, float]:
        """Return deflection (mm) and turn (rad) of a section as a .dat has them."""
        rows = (line.split() for line in path.read_text().splitlines())
        moved = {int(row[0]): [float(each) for each in row[1:]] for row in rows if len(row) == 4}
        shares = self.section(position)
        across = {node: self.points[node - 1][0] for node in shares}
        turn = sum(share * across[node] * moved[node][2] for node, share in shares.items())
        inertia = sum(share * across[node] ** 2 for node, share in shares.items())
        return sum(share * moved[node][0] for node, share in shares.items()), -turn / inertia
