"""Bodies of any gear, modified or not, are meshed with good hexahedra whose nodes are on the exact flanks, or refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from support.exact import distance_to_section
from support.modified import depth_off, folded, unturned
from support.sections import COARSE
from support.strategies import MODIFICATIONS, build_gear, gear_inputs, modified

from gearcad import Gear
from gearcad.core.errors import GeometryError, InputError, SolverError
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.body_mesh import mesh_body
from gearcad.meshing.bodies.exactness import deviations
from gearcad.meshing.bodies.quality import quality, require_good

OFF = 1e-9
"""mm, for gears up to a metre: the promise; of larger ones the share of it that rounding takes."""

STEEP = 50.0
"""Degrees: up to this helix angle no gear is refused for its elements, but for those whose edges are straight."""

NEXT_TO_NOTHING = 1e-3
"""Normal modules: a land or fillet so short makes elements that no refinement makes less narrow."""

NOTHING = {"bore": 0.0, "keyway": 0.0, "hub": 0.0, "hub_side": "front", "end_chamfer": 0.0, "end_chamfer_angle": 45.0}
"""Of what a sweep leaves out, and of which many a gear could not be made."""

HALVES = (("left", "flank"), ("left", "fillet"), ("right", "flank"), ("right", "fillet"))

RIMS = st.one_of(st.floats(0.1, 1.0), st.floats(0.1, 10.0))
"""Body below the root circle in normal modules."""

WIDTHS = st.one_of(st.just(None), st.floats(0.1, 1.0), st.floats(10.0, 50.0))
"""Face width in normal modules; None: as drawn with the gear."""


def check_body(gear: Gear, rim: float, element: Element) -> None:
    root = gear.root_diameter / 2
    inner = max(root - rim * gear.normal_module, 0.3 * root)
    mesh = mesh_body(gear, teeth=1, held_radius=inner, sizes=COARSE, planes=None, element=element)
    check_nodes(gear, mesh)
    require_good(quality(mesh))


def check_nodes(gear: Gear, mesh: ElementMesh) -> None:
    """Nodes of flanks and fillets are on the modified helicoid, by two ways.

    Formulas of the tests' own know a flank by its half of the pitch: in which it stays if land is left between the fillets.
    """
    off = OFF * max(1.0, gear.tip_diameter / 1000)
    assert deviations(mesh, gear).nodes < off
    if gear.modification.present and ("left_root_0" not in mesh.sides or beyond(gear, mesh)):
        return
    for side in ("left", "right"):
        flank, fillet = (mesh.points[mesh.nodes(f"{side}_{part}_0")[::7]] for part in ("flank", "fillet"))
        assert np.abs(depth_off(gear, flank)).max() < off
        assert distance_to_section(gear, unturned(gear, fillet)).max() < off


def beyond(gear: Gear, mesh: ElementMesh) -> bool:
    """Whether some of tooth 0 is turned into the other half of its pitch, or of the next."""
    turned = [folded(gear, mesh.points[mesh.nodes(f"{side}_{part}_0")])[1] for side, part in HALVES]
    return bool(min(turned[0].min(), turned[1].min()) <= 0 or max(turned[2].max(), turned[3].max()) >= 0)


def check_inputs(
    inputs: dict[str, Any], drawn: dict[str, float] | None, rim: float, width: float | None, element: Element
) -> None:
    inputs |= {"body": NOTHING | {"tip_chamfer": inputs["body"]["tip_chamfer"]}}
    try:
        gear = modified(build_gear(inputs | ({} if width is None else {"width": width})), drawn)
    except InputError as error:
        event(f"no gear: {error.parameter}")
        return
    try:
        check_body(gear, rim, element)
    except GeometryError as error:
        event("no fillet")
        assert error.parameter == "rack.root_radius" and gear.rack.root_radius < 1e-6
    except SolverError as error:
        event("refused")
        assert "distorted" in str(error)
        assert abs(gear.helix_angle) > STEEP or element is Element.HEX8 or _shortest_curve(gear) < NEXT_TO_NOTHING
    else:
        event("meshed, modified" if drawn else "meshed")


def _shortest_curve(gear: Gear) -> float:
    """Length of the shortest curve of the profile over the normal module."""
    ends = [curve.points(np.array([0.0, 1.0])) for curve in gear.profile.curves]
    return min(float(np.hypot(*(end - start))) for start, end in ends) / gear.normal_module


DRAWN = (gear_inputs(), MODIFICATIONS, RIMS, WIDTHS, st.sampled_from([Element.HEX20, Element.HEX8]))


@settings(max_examples=40)
@given(*DRAWN)
def test_bodies_are_good_meshes(
    inputs: dict[str, Any], drawn: dict[str, float] | None, rim: float, width: float | None, element: Element
) -> None:
    check_inputs(inputs, drawn, rim, width, element)


@pytest.mark.long
@settings(max_examples=3000)
@given(*DRAWN)
def test_bodies_are_good_meshes_long(
    inputs: dict[str, Any], drawn: dict[str, float] | None, rim: float, width: float | None, element: Element
) -> None:
    check_inputs(inputs, drawn, rim, width, element)
