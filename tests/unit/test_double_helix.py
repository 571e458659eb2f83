"""Double helical gears and pairs: halves, limits, what two halves carry, and their meshes."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcad import Body, FlankModification, Gear, GearPair
from gearcad.core.errors import GeometryError, InputError
from gearcad.geometry.gear import halves
from gearcad.geometry.gear_data import section_turn, twist
from gearcad.geometry.gear_parts import DoubleHelix
from gearcad.meshing.fem import Element
from gearcad.meshing.options import MeshOptions
from gearcad.meshing.plan import plan_mesh
from gearcad.meshing.result import run_mesh


def _gear(teeth: int = 24, helix: float = 25.0, width: float = 50.0, **double: Any) -> Gear:
    given = DoubleHelix(**{"gap_width": 10.0} | double)
    return Gear(teeth=teeth, normal_module=2.0, face_width=width, helix_angle=helix, double_helix=given)


def test_the_upper_half_goes_on_where_the_lower_one_ends() -> None:
    lower, upper = halves(_gear(offset=0.25))
    assert (lower.z, upper.z, lower.gear.face_width) == (0.0, 30.0, 20.0)
    assert (lower.gear.helix_angle, upper.gear.helix_angle) == (25.0, -25.0)
    assert upper.rotation == pytest.approx(lower.gear.twist + 0.25 * 15, abs=1e-12)
    assert halves(_gear(helix=-25.0))[1].rotation == pytest.approx(-lower.gear.twist, abs=1e-12)


@pytest.mark.parametrize("offset", [0.0, 0.3, 0.5])
def test_two_halves_carry_what_their_pairs_do(offset: float) -> None:
    """The overlap ratio is that of one half; lines of contact are those of both, each where its teeth are."""
    pinion, wheel = _gear(offset=offset), _gear(54, -25.0, 46.0, offset=-offset)
    pair = GearPair(pinion=pinion, wheel=wheel)
    half = GearPair(pinion=halves(pinion)[0].gear, wheel=replace(halves(wheel)[0].gear, face_width=18.0))
    assert pair.common_width == (36.0, 0.0)
    assert pair.overlap_ratio == pytest.approx(half.overlap_ratio, rel=1e-12)
    roll = np.linspace(0, 15, 3001)
    total = half.contact_line_length(roll) + half.contact_line_length(roll + offset * 15)
    assert pair.contact_line_length(roll) == pytest.approx(total, rel=1e-12)
    lengths = pair.contact_line_lengths
    assert lengths.minimum == pytest.approx(total.min(), rel=1e-3)
    assert lengths.maximum == pytest.approx(total.max(), rel=1e-3)
    assert lengths.mean == pytest.approx(2 * half.contact_line_lengths.mean, rel=1e-12)


@pytest.mark.parametrize("gap", [0.0, 10.0])
def test_two_halves_need_a_fiftieth_of_the_module_beside_the_gap(gap: float) -> None:
    assert _gear(width=gap + 0.0401, gap_width=gap).half_width == pytest.approx(0.02005, abs=1e-12)
    with pytest.raises(InputError, match=rf"gap_width = {gap:g} mm: must be at most .* to leave two halves"):
        _gear(width=gap + 0.0399, gap_width=gap)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: _gear(gap_width=60.0), "double_helix.gap_width = 60 mm: must be at most 49.96 mm"),
        (lambda: _gear(helix=0.0), "helix_angle = 0 deg: must not be 0 deg on a double helical gear"),
        (lambda: _gear(gap_diameter=70.0), "double_helix.gap_diameter = 70 mm: must be from 0.4 to 47.5621 mm"),
        (
            lambda: Gear(teeth=-40, normal_module=2, face_width=50, helix_angle=9, double_helix=DoubleHelix(gap_width=9)),
            "double_helix.gap_width = 9 mm: must be left out on a ring",
        ),
        (lambda: DoubleHelix(gap_width=0.0, offset=0.5), "gap_width = 0 mm: must be above 0 mm where offset is 0.5"),
        (lambda: DoubleHelix(gap_width=-1.0), "gap_width = -1 mm: must be a number"),
        (
            lambda: GearPair(pinion=_gear(), wheel=Gear(teeth=30, normal_module=2, face_width=50, helix_angle=-25)),
            "wheel.double_helix.gap_width is missing: must be given for both gears",
        ),
        (
            lambda: GearPair(pinion=_gear(offset=0.2), wheel=_gear(54, -25.0)),
            "wheel.double_helix.offset = 0: must be -0.2, for both halves to mesh",
        ),
        (
            lambda: GearPair(pinion=_gear(), wheel=_gear(54, -25.0, 12.0, gap_width=11.0), axial_offset=1.0),
            "axial_offset = 1 mm: must be 0 mm: double helical gears centre each other",
        ),
        (
            lambda: GearPair(pinion=_gear(gap_width=14.0), wheel=_gear(54, -25.0, 12.0)),
            "pinion.double_helix.gap_width = 14 mm: must be below 12 mm",
        ),
    ],
)
def test_what_makes_no_double_helical_gear(make: Any, message: str) -> None:
    with pytest.raises(InputError) as raised:
        make()
    assert str(raised.value).startswith(message)


_RELIEVED = FlankModification(tip_relief=20, tip_relief_length=1, lead_crowning=20, twist=5, end_relief=5, end_relief_length=2)


def _mesh_gear(teeth: int = 14, helix: float = 25.0, **given: Any) -> Gear:
    common = {"normal_module": 2.0, "face_width": 24.0, "body": Body(bore=16.0), "double_helix": DoubleHelix(gap_width=0)}
    return Gear(**{"teeth": teeth, "helix_angle": helix} | common | given)


def test_sections_turn_as_the_halves_do() -> None:
    gear = _mesh_gear(double_helix=DoubleHelix(gap_width=4, offset=0.5))
    lower, upper = halves(gear)
    assert float(section_turn(gear, np.array(7.0))) == pytest.approx(twist(lower.gear, 7.0), abs=1e-15)
    above = math.radians(upper.rotation) + twist(upper.gear, 7.0)
    assert float(section_turn(gear, np.array(upper.z + 7.0))) == pytest.approx(above, abs=1e-12)


@pytest.mark.parametrize("element", ["hex20", "hex8"])
@pytest.mark.parametrize("modification", [FlankModification(), _RELIEVED], ids=["exact", "modified"])
def test_an_apex_is_swept(modification: FlankModification, element: str) -> None:
    """Nodes on both halves, as their own surfaces are; the mesh is the mirror image of itself."""
    gear = _mesh_gear(modification=modification)
    plan = plan_mesh(MeshOptions(element=element, what="teeth:3"), {"gear": gear}, None)
    result = run_mesh(plan, "double")
    judged, mesh = result.judged["gear"], result.meshes["gear"]
    assert [gate for gate in judged.gates if not gate.passed] == []
    assert plan.amount is not None and judged.elements == plan.amount.elements
    points = np.round(mesh.points, 7) + 0.0
    mirrored = np.round(mesh.points * [1, 1, -1] + [0, 0, gear.face_width], 7) + 0.0
    assert {tuple(point) for point in points} == {tuple(point) for point in mirrored}


def test_a_gap_is_filled_by_tetrahedra_alone() -> None:
    gear = _mesh_gear(double_helix=DoubleHelix(gap_width=4))
    with pytest.raises(GeometryError, match=r"^element = 'hex20': must be tet10 for a body with a gap of 4 mm"):
        plan_mesh(MeshOptions(element="hex20"), {"gear": gear}, None)
    assert plan_mesh(MeshOptions(), {"gear": gear}, None).element is Element.TET10


@pytest.mark.long
@pytest.mark.parametrize("double", [DoubleHelix(gap_width=4, offset=0.5), DoubleHelix(gap_width=0)], ids=["gap", "apex"])
def test_tetrahedra(double: DoubleHelix) -> None:
    gear = _mesh_gear(double_helix=double)
    judged = run_mesh(plan_mesh(MeshOptions(element="tet10", size=3.0, fillet_elements=1), {"gear": gear}, None), "d")
    found = judged.judged["gear"]
    assert [gate for gate in found.gates if not gate.passed] == []
    assert ("gap" in found.sides) == bool(double.gap_width)


def test_a_pair_touches_in_the_middle_of_the_lower_halves() -> None:
    """The section there stands as that of the lower halves in mesh, which is a single helical pair."""
    from gearcad.meshing.bodies.body_mesh import poses

    pinion, wheel = _mesh_gear(19), _mesh_gear(31, -25.0, face_width=20.0)
    pair = GearPair(pinion=pinion, wheel=wheel)
    half = GearPair(pinion=halves(pinion)[0].gear, wheel=halves(wheel)[0].gear, axial_offset=1.0)
    ours, theirs = (poses(each, 3.0, solid=True) for each in (pair, half))
    assert ours.pinion == pytest.approx(theirs.pinion, abs=1e-9)
    assert ours.wheel == pytest.approx(theirs.wheel, abs=1e-9)
