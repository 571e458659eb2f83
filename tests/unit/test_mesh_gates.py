"""Meshes that are spoilt after they were made: each gate catches what it is there for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gearcad import Body, FlankModification, Gear
from gearcad.meshing import ElementMesh, Faces
from gearcad.meshing.options import MeshOptions
from gearcad.meshing.plan import plan_mesh
from gearcad.meshing.result import JudgedMesh, _judged

GEAR = Gear(teeth=20, normal_module=2, face_width=8, body=Body(bore=16))

CHAMFERED = Gear(
    teeth=25,
    normal_module=3,
    face_width=20,
    helix_angle=-20,
    body=Body(bore=30, tip_chamfer=0.3),
    modification=FlankModification(tip_relief=30, tip_relief_length=2, lead_crowning=12),
)

OTHERS, CUTS, CLOSED, MEAN = "nodes from the other exact sides", "nodes of matched cuts", "share of the surface", "surface "


def judged(spoil: Callable[[ElementMesh], ElementMesh], options: MeshOptions, gear: Gear = GEAR) -> JudgedMesh:
    plan = plan_mesh(options, {"gear": gear}, None)
    return _judged(spoil(plan.gears["gear"].mesh(lambda *_: None)), plan.gears["gear"], plan)


def moved(mesh: ElementMesh, nodes: np.ndarray, scale: float, up: float = 0.0) -> ElementMesh:
    points = mesh.points.copy()
    points[nodes, :2] *= scale
    points[nodes, 2] += up
    return replace(mesh, points=points)


def cut_node_out(mesh: ElementMesh) -> ElementMesh:
    """By 20 µm."""
    points = mesh.points.copy()
    points[mesh.matched["cut"][5, 1], 1] += 0.02
    return replace(mesh, points=points)


def root_in(mesh: ElementMesh) -> ElementMesh:
    """By 17 µm."""
    return moved(mesh, np.setdiff1d(mesh.nodes("left_root_0"), mesh.nodes("left_fillet_0")), 0.999)


def end_out(mesh: ElementMesh) -> ElementMesh:
    return moved(mesh, mesh.nodes("end_front"), 1.0, 0.003)


def bore_in(mesh: ElementMesh) -> ElementMesh:
    """By 24 µm."""
    return moved(mesh, mesh.nodes("bore"), 0.997)


def without(side: str) -> Callable[[ElementMesh], ElementMesh]:
    return lambda mesh: replace(mesh, sides={name: faces for name, faces in mesh.sides.items() if name != side})


def twice(mesh: ElementMesh) -> ElementMesh:
    tip = mesh.sides["tip_0"]
    both = Faces(np.tile(tip.elements, 2), np.tile(tip.sides, 2))
    return replace(mesh, sides={**mesh.sides, "tip_0": both})


SECTION, BODY = MeshOptions(what="sector"), MeshOptions(what="sector", model="3d", size=1.0)
FIRST, RING = MeshOptions(what="sector", element="hex8", size=1.0), MeshOptions(what="ring", element="hex8", size=2.0)


@pytest.mark.parametrize(
    ("spoil", "options", "caught"),
    [
        (cut_node_out, SECTION, CUTS),
        (root_in, SECTION, OTHERS),
        (end_out, BODY, OTHERS),
        (end_out, BODY, MEAN),
        (bore_in, FIRST, OTHERS),
        (bore_in, SECTION, MEAN),
        (without("left_flank_0"), FIRST, CLOSED),
        (without("left_flank_0"), FIRST, MEAN),
        (without("bore"), RING, CLOSED),
        (without("end_back"), RING, CLOSED),
        (twice, RING, CLOSED),
    ],
)
def test_what_is_spoilt_fails(spoil: Callable[[ElementMesh], ElementMesh], options: MeshOptions, caught: str) -> None:
    failed = [gate.quantity for gate in judged(spoil, options).gates if not gate.passed]
    assert any(quantity.startswith(caught) for quantity in failed), failed


@pytest.mark.parametrize(
    ("options", "gear"),
    [(SECTION, GEAR), (FIRST, GEAR), (RING, GEAR), (BODY, CHAMFERED), (replace(SECTION, model="2d"), CHAMFERED)],
)
def test_what_is_not_passes(options: MeshOptions, gear: Gear) -> None:
    """Also nodes of tip chamfers, which turn with modified flanks, are where they should be."""
    found = judged(lambda mesh: mesh, options, gear)
    assert found.passed, [str(gate) for gate in found.gates if not gate.passed]
    assert {"longest over shortest edge", OTHERS} <= {gate.quantity for gate in found.gates}
