"""Sections of one tooth as element meshes, made here from the quadrangles that contact uses."""

from __future__ import annotations

import numpy as np

from gearcad import Gear
from gearcad.meshing.bodies import Element, ElementMesh, Faces
from gearcad.meshing.section import MeshSizes
from gearcad.meshing.section.outline import Side
from gearcad.meshing.section.quads import mesh_quads

__all__ = ["COARSE", "tooth_section"]

COARSE = MeshSizes(flank=0.6, corner=0.5, fillet=0.4, outline=0.75, cut=0.75, rim=2.0, growth=0.5)

_NAMES = {
    Side.RIGHT_ROOT: "right_root_0",
    Side.RIGHT_FILLET: "right_fillet_0",
    Side.RIGHT_FLANK: "right_flank_0",
    Side.TIP: "tip_0",
    Side.LEFT_FLANK: "left_flank_0",
    Side.LEFT_FILLET: "left_fillet_0",
    Side.LEFT_ROOT: "left_root_0",
    Side.AHEAD: "cut_ahead",
    Side.INNER: "bore",
    Side.BEHIND: "cut_behind",
}


def tooth_section(gear: Gear, rim: float = 1.5, sizes: MeshSizes = COARSE) -> ElementMesh:
    """Quadrangles of tooth 0 and a body of `rim` normal modules below the root circle."""
    quads = mesh_quads(gear, gear.root_diameter / 2 - rim * gear.normal_module, sizes)
    place = {int(node): (row, k) for row, middles in enumerate(quads.quads[:, 4:]) for k, node in enumerate(middles)}
    sides = {}
    for side, chain in quads.sides.items():
        elements, local = np.array([place[int(node)] for node in chain[1::2]]).T
        sides[_NAMES[side]] = Faces(elements.astype(np.int32), local.astype(np.int8))
    points = np.c_[quads.points, np.zeros(len(quads.points))]
    whole, cut = {"gear": slice(0, len(quads.quads))}, {"cut": np.c_[quads.behind, quads.ahead]}
    return ElementMesh(Element.QUAD8, points, quads.quads.astype(np.int32), whole, sides, cut)
