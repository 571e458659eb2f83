"""Nodes of sections turned by modifications: against depths by formulas of the tests' own (reference)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.exact import distance_to_section
from support.modified import depth_off, unturned
from support.modifying import GEARS, modified
from support.sections import COARSE

from gearcad import BasicRack, Gear
from gearcad.meshing.bodies import Element, ElementMesh
from gearcad.meshing.bodies.section_mesh import mesh_section, modification_turns

ROUNDING = 1e-12
"""mm, or rad: of sums and of a table of singular values; the promise is 1e-9 mm."""

FULL = Gear(teeth=17, normal_module=3.0, face_width=20, helix_angle=-20, rack=BasicRack(root_radius="full"))
"""Fillets meet in the middle of the space: their turn fades."""


def tooth_section(gear: Gear, teeth: int | None = 1) -> ElementMesh:
    inner = gear.root_diameter / 2 - 1.5 * gear.normal_module
    return mesh_section(gear, modified=False, teeth=teeth, held_radius=inner, sizes=COARSE, element=Element.QUAD8)


def at_height(gear: Gear, section: ElementMesh, angles: np.ndarray, z: float) -> np.ndarray:
    """Nodes (n, 3) at a height, turned by the helix and by angles (n,) of their own."""
    turn = angles + math.tan(math.radians(gear.helix_angle)) / (gear.reference_diameter / 2) * z
    x, y, _ = section.points.T
    return np.stack([np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y, np.full(len(x), z)], -1)


@pytest.mark.parametrize("name", [*GEARS, "full"])
def test_flanks_have_their_depth(name: str) -> None:
    """And fillets turn with the ends of the flanks, or less the deeper they are where their turn fades."""
    gear = modified({**GEARS, "full": FULL}[name])
    section, heights = tooth_section(gear), np.linspace(0, gear.face_width, 7)
    turns = modification_turns(section, gear, heights)
    for number, z in enumerate(heights):
        points = at_height(gear, section, turns.at(number), z)
        for side in ("left", "right"):
            assert np.abs(depth_off(gear, points[section.nodes(f"{side}_flank_0")])).max() < ROUNDING
            if name != "full":
                fillet = unturned(gear, points[section.nodes(f"{side}_fillet_0")])
                assert distance_to_section(gear, fillet).max() < ROUNDING


def test_inside_is_between() -> None:
    """No node turns by more than the outline does; bore not at all; both cuts, and lands in their middle, as the mean."""
    gear = modified(GEARS["chamfered"])
    section = tooth_section(gear)
    turns = modification_turns(section, gear, np.array([0.0, 5.0])).at(0)
    outline = np.concatenate([section.nodes(name) for name in section.sides if name not in ("bore", "cut_behind", "cut_ahead")])
    assert np.abs(turns).max() == np.abs(turns[outline]).max()
    assert np.abs(turns[section.nodes("bore")]).max() < ROUNDING
    behind, ahead = section.matched["cut"].T
    assert turns[ahead] == pytest.approx(turns[behind], abs=ROUNDING)
    left, right = (gear.flank_form.turn(gear.flank_form.last, 0.0, left=side) for side in (True, False))
    tip = section.nodes("tip_0")
    middle = tip[np.argmin(np.abs(section.points[tip, 1]))]
    assert turns[middle] == pytest.approx((left + right) / 2, abs=ROUNDING)
    assert turns[tip].min() == pytest.approx(min(left, right), abs=ROUNDING)


def test_all_teeth_turn_alike() -> None:
    """In the ring as in one sector with its cuts."""
    gear = modified(GEARS["undercut"])
    one, ring = (modification_turns(tooth_section(gear, teeth), gear, np.array([3.0])).at(0) for teeth in (1, None))
    assert np.unique(ring[np.abs(ring) > ROUNDING].round(12)) == pytest.approx(np.unique(one[np.abs(one) > ROUNDING].round(12)))


def test_nothing_where_nothing_is_modified() -> None:
    turns = modification_turns(tooth_section(GEARS["spur"]), GEARS["spur"], np.linspace(0, 10, 3))
    assert not turns.at(2).any() and turns.fields.size == 0
