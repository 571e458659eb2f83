"""The section of any gear is filled by good quadrangles on its exact outline, as many as the sizes ask for."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from support.strategies import build_gear, gear_inputs

from gearcad import Gear
from gearcad.contact.solid.pair import SolidSizes
from gearcad.core.errors import GeometryError, InputError
from gearcad.meshing.outline import OutlineSide
from gearcad.meshing.quads import QuadMesh, SectorLayout, mesh_quads, scaled_jacobians

SIZES = SolidSizes().section

LEAST_JACOBIAN = 0.2
"""Of the worst quadrangle: its sharpest corner has 12 degrees. A thousand gears drawn had 0.35; a mesher refuses 0.1."""

FOLLOWS = 0.10
"""How far the number of quadrangles may be from the square of the refinement."""

FEWEST = 1.5
"""Edges that the sizes must ask for on each side of a block for the number to follow: whole numbers are coarse below."""

ROUNDING = 1e-9

RIMS = st.one_of(st.just(None), st.floats(0.1, 1.0), st.floats(0.1, 40.0))
"""Body below the root circle in normal modules; None for four, as a check has it without a bore."""


def inner_radius(gear: Gear, rim: float | None) -> float:
    root = gear.root_diameter / 2
    return max(root - (rim or 4.0) * gear.normal_module, 0.3 * root)


def check_section(gear: Gear, rim: float | None, factor: float) -> None:
    radius = inner_radius(gear, rim)
    mesh = mesh_quads(gear, radius, SIZES)
    assert scaled_jacobians(mesh.points[mesh.quads]).min() > LEAST_JACOBIAN
    check_outline(gear, mesh, radius)
    other = SIZES.scaled(factor)
    # A body thinner than an element, or a fillet shorter than one, gets one all the same.
    if min(min(SectorLayout(gear, radius, sizes).wanted) for sizes in (SIZES, other)) > FEWEST:
        event("followed")
        assert len(mesh_quads(gear, radius, other).quads) / len(mesh.quads) == pytest.approx(factor**2, rel=FOLLOWS)


def check_outline(gear: Gear, mesh: QuadMesh, radius: float) -> None:
    """One closed line of edges that belong to one quadrangle each; on the profile; cuts that fit each other."""
    chain = [int(node) for nodes in mesh.sides.values() for node in nodes[:-1]]
    assert len(set(chain)) == len(chain)
    nodes, uses = np.unique(mesh.quads[:, 4:], return_counts=True)
    assert set(nodes[uses == 1].tolist()) == {node for node in chain if node >= mesh.vertices}
    places = mesh.points / gear.tip_diameter
    for side in (OutlineSide.LEFT_FLANK, OutlineSide.LEFT_FILLET, OutlineSide.RIGHT_FLANK, OutlineSide.RIGHT_FILLET):
        x, y = places[mesh.sides[side]].T
        distance = np.hypot(x, y) * gear.tip_diameter
        steep = distance > gear.root_diameter / 2 * (1 + 1e-6)  # below, a radius says little about the angle
        expected = np.radians(gear.profile.half_angle(distance))
        assert np.abs(np.abs(np.arctan2(y, x)) - expected)[steep].max(initial=0.0) < ROUNDING
    pitch = 2 * math.pi / gear.teeth
    turn = np.array([[math.cos(pitch), math.sin(pitch)], [-math.sin(pitch), math.cos(pitch)]])
    assert np.abs(places[mesh.behind] @ turn - places[mesh.ahead]).max() < ROUNDING
    assert np.abs(np.hypot(*mesh.points[mesh.sides[OutlineSide.HELD]].T) - radius).max() < ROUNDING * gear.tip_diameter


def check_inputs(inputs: dict[str, Any], rim: float | None, factor: float) -> None:
    try:
        gear = build_gear(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        return
    try:
        check_section(gear, rim, factor)
    except GeometryError as error:
        event("no fillet")
        assert error.parameter == "rack.root_radius" and gear.rack.root_radius < 1e-6
    else:
        event("section")


@settings(max_examples=60)
@given(gear_inputs(), RIMS, st.floats(0.7, 2.5))
def test_sections_are_good_meshes(inputs: dict[str, Any], rim: float | None, factor: float) -> None:
    check_inputs(inputs, rim, factor)


@pytest.mark.long
@settings(max_examples=1500)
@given(gear_inputs(), RIMS, st.floats(0.7, 2.5))
def test_sections_are_good_meshes_long(inputs: dict[str, Any], rim: float | None, factor: float) -> None:
    check_inputs(inputs, rim, factor)
