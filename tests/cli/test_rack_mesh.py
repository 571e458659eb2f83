"""`gearcad mesh` of a pinion and a rack."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from support.commands import invoke, read_json, run, spec_file

import gearcad
from gearcad.geometry import Gear, Rack, RackPair
from gearcad.meshing.bodies.element_mesh import ElementMesh

SPEC = """
[pair]
name = "rack"
normal_module = 2.0
tooth_thinning = 0.03
[pinion]
teeth = 20
face_width = 20.0
body.bore = 16.0
[rack]
teeth = 40
face_width = 20.0
height = 12.0
"""

PINION = Gear(teeth=20, normal_module=2, face_width=20, tooth_thinning=0.03)
RACK = Rack(teeth=40, normal_module=2, face_width=20, height=12, tooth_thinning=0.03)
PAIR = RackPair(pinion=PINION, rack=RACK)


def distance(mesh: ElementMesh, side: str, point: np.ndarray) -> float:
    """Distance (mm) of a point from the edges of a side, taken as straight between their three nodes."""
    faces = mesh.points[mesh.face_cells(side)][:, [0, 2, 1], :2]
    first, last = faces[:, :-1].reshape(-1, 2), faces[:, 1:].reshape(-1, 2)
    along = last - first
    share = np.clip(((point - first) * along).sum(1) / (along**2).sum(1), 0, 1)
    return float(np.hypot(*(first + share[:, None] * along - point).T).min())


@pytest.mark.parametrize("roll", [5.0, pytest.param(0.0, marks=pytest.mark.long), pytest.param(-6.0, marks=pytest.mark.long)])
def test_sections_stand_in_mesh_on_the_line_of_action(roll: float) -> None:
    mesh = gearcad.mesh(PAIR, roll=roll).mesh
    angle, base = math.radians(20), PINION.base_diameter / 2
    place = base * math.tan(angle) + math.radians(roll) * base
    touching = base * np.array([math.cos(angle), -math.sin(angle)]) + place * np.array([math.sin(angle), math.cos(angle)])
    assert distance(mesh, "pinion_left_flank_0", touching) < 1e-3
    assert distance(mesh, "wheel_left_flank_0", touching) < 1e-3


def test_strip_has_the_area_of_its_teeth_and_nodes_on_the_outline() -> None:
    result = gearcad.mesh(PAIR, what="teeth:5")
    assert result.passed and set(result.meshes) == {"pinion", "rack"}
    judged = result.judged["rack"]
    heights = np.linspace(-RACK.root_depth, RACK.tip_height, 40_001)
    teeth = 5 * 2 * np.trapezoid(RACK.profile.half_thickness(heights), heights)
    area = 5 * RACK.transverse_pitch * (RACK.height - RACK.root_depth) + teeth
    assert judged.exact == pytest.approx(area, rel=1e-8)
    assert judged.whole == pytest.approx(area, rel=1e-6)
    mesh = result.meshes["rack"]
    for tooth in (38, 39, 0, 1, 2):
        height, along = mesh.points[mesh.nodes(f"left_flank_{tooth}"), :2].T
        middle = (tooth - 40 if tooth > 20 else tooth) * RACK.transverse_pitch
        half = RACK.transverse_tooth_thickness / 2 - height * math.tan(math.radians(20))
        assert along - middle == pytest.approx(half, abs=1e-12)
    assert np.ptp(mesh.points[mesh.nodes("back"), 0]) < 1e-12
    moved = mesh.points.copy()
    moved[mesh.nodes("left_fillet_0")[3]] += [1e-3, 0.0, 0.0]
    off = result.plan.gears["rack"].offsets(type(mesh)(mesh.element, moved, mesh.cells, mesh.parts, mesh.sides, mesh.matched))
    assert off.teeth.nodes > 1e-4 and off.teeth.worst == "left_fillet_0"


@pytest.mark.long
def test_files_and_deck(here: Path) -> None:
    content = SPEC + "[load]\ntorque = 60.0\n"
    result = run("mesh", spec_file(content), "--deck", "pair", "--roll", "3", "--format", "vtu")
    assert result.stdout.splitlines()[-3:] == [f"output/rack/{name}" for name in ("pair.vtu", "pair_deck.inp", "mesh.json")]
    document = read_json(here / "output/rack/mesh.json")
    assert document["passed"] and set(document["meshes"]) == {"pinion", "rack"}
    expected = document["decks"]["pair_deck.inp"]
    assert expected["normal_force"] == pytest.approx(60e3 / (20 * math.cos(math.radians(20))), rel=1e-9)
    deck = (here / "output/rack/pair_deck.inp").read_text(encoding="ascii")
    assert "the rack's reference line is at x = 20 mm" in deck


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--model", "3d"), 'must be "2d" for a rack, which is meshed as a section'),
        (("--element", "quad8"), "must be tri6 for a rack"),
        (("--gear", "pinion"), "must be left out for a rack: pinion and rack are both meshed"),
        (("--elements", "5000"), "must be left out for a rack: give a size"),
        (("--what", "sector"), "must be pair, pair:5, teeth:5 or the like for a rack"),
        (("--what", "teeth:41"), "must be of at most 40 teeth, which the rack has"),
        (("--deck", "tooth"), "must be pair, or left out, for a rack"),
        (("--deck", "pair"), "load.torque is missing: must be given"),
    ],
)
def test_bad_input_is_one_line(here: Path, options: tuple[str, ...], message: str) -> None:
    result = invoke("mesh", spec_file(SPEC), *options)
    assert result.exit_code == 2
    assert message in result.stderr.strip().splitlines()[-1] and not list(here.glob("output/*"))
