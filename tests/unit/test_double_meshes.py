"""Meshes of double helical gears: hexahedra up to an apex and back, tetrahedra round a gap (identity)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gearcad import Body, FlankModification, Gear, GearPair
from gearcad.core.errors import GeometryError
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_data import section_turn, twist
from gearcad.geometry.gear_parts import DoubleHelix
from gearcad.meshing.bodies.element_mesh import Element
from gearcad.meshing.options import MeshOptions
from gearcad.meshing.plan import plan_mesh
from gearcad.meshing.result import run_mesh

_RELIEVED = FlankModification(tip_relief=20, tip_relief_length=1, lead_crowning=20, twist=5, end_relief=5, end_relief_length=2)


def _gear(teeth: int = 14, helix: float = 25.0, **given: Any) -> Gear:
    common = {"normal_module": 2.0, "face_width": 24.0, "body": Body(bore=16.0), "double_helix": DoubleHelix(gap_width=0)}
    return Gear(**{"teeth": teeth, "helix_angle": helix} | common | given)


def test_sections_turn_as_the_halves_do() -> None:
    gear = _gear(double_helix=DoubleHelix(gap_width=4, offset=0.5))
    lower, upper = halves(gear)
    assert float(section_turn(gear, np.array(7.0))) == pytest.approx(twist(lower.gear, 7.0), abs=1e-15)
    above = math.radians(upper.rotation) + twist(upper.gear, 7.0)
    assert float(section_turn(gear, np.array(upper.z + 7.0))) == pytest.approx(above, abs=1e-12)


@pytest.mark.parametrize("element", ["hex20", "hex8"])
@pytest.mark.parametrize("modification", [FlankModification(), _RELIEVED], ids=["exact", "modified"])
def test_an_apex_is_swept(modification: FlankModification, element: str) -> None:
    """Nodes on both halves, as their own surfaces are; the mesh is the mirror image of itself."""
    gear = _gear(modification=modification)
    plan = plan_mesh(MeshOptions(element=element, what="teeth:3"), {"gear": gear}, None)
    result = run_mesh(plan, "double")
    judged, mesh = result.judged["gear"], result.meshes["gear"]
    assert [gate for gate in judged.gates if not gate.passed] == []
    assert plan.amount is not None and judged.elements == plan.amount.elements
    points = np.round(mesh.points, 7) + 0.0
    mirrored = np.round(mesh.points * [1, 1, -1] + [0, 0, gear.face_width], 7) + 0.0
    assert {tuple(point) for point in points} == {tuple(point) for point in mirrored}


def test_a_gap_is_filled_by_tetrahedra_alone() -> None:
    gear = _gear(double_helix=DoubleHelix(gap_width=4))
    with pytest.raises(GeometryError, match=r"^element = 'hex20': must be tet10 for a body with a gap of 4 mm"):
        plan_mesh(MeshOptions(element="hex20"), {"gear": gear}, None)
    assert plan_mesh(MeshOptions(), {"gear": gear}, None).element is Element.TET10


@pytest.mark.long
@pytest.mark.parametrize("double", [DoubleHelix(gap_width=4, offset=0.5), DoubleHelix(gap_width=0)], ids=["gap", "apex"])
def test_tetrahedra(double: DoubleHelix) -> None:
    gear = _gear(double_helix=double)
    judged = run_mesh(plan_mesh(MeshOptions(element="tet10", size=3.0, fillet_elements=1), {"gear": gear}, None), "d")
    found = judged.judged["gear"]
    assert [gate for gate in found.gates if not gate.passed] == []
    assert ("gap" in found.sides) == bool(double.gap_width)


def test_a_pair_touches_in_the_middle_of_the_lower_halves() -> None:
    """The section there stands as that of the lower halves in mesh, which is a single helical pair."""
    from gearcad.meshing.bodies.body_mesh import poses

    pinion, wheel = _gear(19), _gear(31, -25.0, face_width=20.0)
    pair = GearPair(pinion=pinion, wheel=wheel)
    half = GearPair(pinion=halves(pinion)[0].gear, wheel=halves(wheel)[0].gear, axial_offset=1.0)
    ours, theirs = (poses(each, 3.0, solid=True) for each in (pair, half))
    assert ours.pinion == pytest.approx(theirs.pinion, abs=1e-9)
    assert ours.wheel == pytest.approx(theirs.wheel, abs=1e-9)
