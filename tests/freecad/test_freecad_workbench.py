"""The FreeCAD workbench in FreeCAD without a window; skipped where there is no FreeCAD."""

import json
import math
import runpy
import shutil
import subprocess
import tomllib
from functools import reduce
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any
from xml.etree import ElementTree

import pytest
from support.freecad import WORKBENCH, freecad_environment, install_workbench

import gearcad
from gearcad.designs.reader import starter_text

FREECAD = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
SAME_VOLUME = 1e-9
"""Relative: both are integrals of one kernel over the same surfaces."""

FILLET_RADIUS, BORE_RADIUS = 0.5, 6.0
POCKET_RADIUS, POCKET_DEPTH = 1.5, 4.0
COMMENTED = "[gear]\nteeth = 22  # of the second stage\nnormal_module = 1.5\nface_width = 9.0\n"


def gear_text(teeth: int, more: str = "") -> str:
    """Return the spec of the feature Gear with other teeth, written by hand."""
    return f"[gear]\nteeth = {teeth}\nnormal_module = 2.0\nface_width = 20.0\nbody.bore = 12.0\n{more}"


def run_freecad(folder: Path, texts: dict[str, str], parts: str) -> dict[str, Any]:
    """Build the designs of `texts` with gearcad, run `parts` of lifecycle.py in FreeCAD, and return its figures."""
    if FREECAD is None:
        pytest.skip("FreeCAD is not installed")
    for name, text in texts.items():
        spec = folder / f"{name}.toml"
        spec.write_text(text, encoding="utf-8")
        made = gearcad.build(gearcad.read(spec), folder / f"built-{name}", ["step"])
        steps = {file.stem: file for file in made if file.suffix == ".step"}
        shutil.copy(steps.get("assembly") or next(iter(steps.values())), folder / f"{name}.step")
    home = folder / "home"
    install_workbench(home)
    environment = freecad_environment(home, WORKBENCH_TEST=str(folder), WORKBENCH_PARTS=parts)
    script = Path(__file__).with_name("lifecycle.py")
    subprocess.run([FREECAD, str(script)], env=environment, capture_output=True, timeout=3600, check=False, cwd=folder)
    found: dict[str, Any] = json.loads((folder / "figures.json").read_text(encoding="utf-8"))
    assert "error" not in found, found["error"]
    return found


def specs() -> dict[str, str]:
    """Return the specs of new features."""
    found: dict[str, str] = runpy.run_path(str(WORKBENCH / "gearcad_keys.py"))["SPECS"]
    return {kind: text if "\n" in text else starter_text(text)[1] for kind, text in found.items()}


def test_gear_is_changed_saved_and_reopened(tmp_path):
    texts = {"20": gear_text(20), "31": gear_text(31), "helical": gear_text(25, "helix_angle = 15.0\nprofile_shift = 0.25\n")}
    (tmp_path / "commented.toml").write_text(COMMENTED, encoding="utf-8")
    gear = run_freecad(tmp_path, texts, "single_gear")["single_gear"]
    _require_body_unchanged(gear)
    for step, built in (("20", "20"), ("31", "31"), ("reopened", "31"), ("helical", "helical")):
        assert gear[step]["volume"] == pytest.approx(gear["built"][built], rel=SAME_VOLUME), step
    saved = gearcad.read(tmp_path / "saved.toml").gears["gear"]
    assert (saved.teeth, saved.body.bore, gear["reopened"]["teeth"]) == (31, 12.0, 31)
    assert gear["spec"] == COMMENTED
    assert gear["opened"] == [["Gear", 22, True]]
    assert gear["placed"] == pytest.approx([60.0, -7.0], abs=1e-6)
    assert gear["wrong input is invalid"]
    assert "permitted 3 to 2000; or -2000 to -10 (internal gear)" in gear["tooltips"]["Teeth"]
    assert "unit mm" in gear["tooltips"]["FaceWidth"]
    assert "permitted -75 to 75" in gear["tooltips"]["HelixAngle"]


def _require_body_unchanged(gear: dict[str, Any]) -> None:
    for step in ("20", "31", "reopened", "helical"):
        found = gear[step]
        assert found["valid"] == [True, True, True], step
        assert found["removed"] == pytest.approx(_fillet_volume(), rel=1e-6), step
        assert (found["edges"], found["ends"]) == (gear["20"]["edges"], gear["20"]["ends"]), step
        assert found["sketch"][2:] == pytest.approx([20.0, 1.0]), step
    assert gear["31"]["faces"] - gear["20"]["faces"] == 11 * (gear["20"]["faces"] - 3) / 20  # bore and two ends are no teeth


def _fillet_volume() -> float:
    """Return the volume (mm³) of a fillet by Pappus: a corner between two sides and a quarter of a circle, about the axis."""
    area = (1 - math.pi / 4) * FILLET_RADIUS**2
    centroid = BORE_RADIUS + FILLET_RADIUS * (10 - 3 * math.pi) / (3 * (4 - math.pi))
    return 2 * math.pi * centroid * area


def test_gear_in_a_body_of_part_design(tmp_path):
    """The pocket is a cylinder, the fillet a ring by Pappus: neither knows of teeth."""
    found = run_freecad(tmp_path, {"31": gear_text(31)}, "part_design_body")["part_design_body"]
    for teeth, state in found.items():
        assert state["valid"] == [True] * 6, teeth
        assert state["pocket"] == pytest.approx(math.pi * POCKET_RADIUS**2 * POCKET_DEPTH, rel=1e-6), teeth
        assert state["fillet"] == pytest.approx(_fillet_volume(), rel=1e-6), teeth
        assert state["sketch"] == pytest.approx(20.0), teeth
        assert state["edges"] == found["20"]["edges"], teeth
    assert found["31"]["gear"] / found["20"]["gear"] > 2.0


@pytest.mark.long
def test_data_sheet_and_drawing(tmp_path):
    found = run_freecad(tmp_path, {}, "documents")["documents"]
    pair, gear = found["Pair"], found["Gear"]
    radii = [(2 * teeth / 2, 2 * teeth / 2 * math.cos(math.radians(20)), 2 * teeth / 2 + 2) for teeth in (20, 41)]
    contact = sum(math.sqrt(tip**2 - base**2) - math.sqrt(pitch**2 - base**2) for pitch, base, tip in radii)
    ratio = contact / (2 * math.pi * math.cos(math.radians(20)))
    by_hand = {"pinion_tip_diameter": 44.0, "wheel_tip_diameter": 86.0, "pair_centre_distance": 61.0}
    assert pair["numbers"] == pytest.approx(by_hand | {"pair_transverse_contact_ratio": ratio}, abs=1e-9)
    base = 40.0 * math.cos(math.radians(20.0))
    by_hand = {"gear_tip_diameter": 44.0, "gear_base_diameter": base, "gear_span_teeth": 3}
    assert gear["numbers"] == pytest.approx(by_hand | {"gear_transverse_pressure_angle": 20.0}, abs=1e-9)
    assert pair["texts"] == ["Pair: spur pair, z = 20 / 41", "number of teeth", "z", "20"]
    pages = [f"Drawing of Pair, {name}" for name in ("assembly", "pinion", "wheel")]
    assert pair["pages"] == [[page, 420.0, 297.0] for page in pages]
    assert gear["pages"] == [["Drawing of Gear, gear", 420.0, 297.0]]
    for symbol in pair["symbols"] + gear["symbols"]:
        size = ElementTree.fromstring(symbol).attrib
        assert (float(size["width"]), float(size["height"])) == pytest.approx((420 * 96 / 25.4, 297 * 96 / 25.4), abs=1e-3)
    assert ">⌀44<" in gear["symbols"][0]
    assert found["box"] == pytest.approx(66.0)  # 31 teeth
    assert found["count"] == {"Spreadsheet::Sheet": 2, "TechDraw::DrawPage": 4}


STARTERS = ("spur", "reducer-21-43", "double-23-81", "ring-22-70", "rack", "planetary-24-21-66", "spline")


@pytest.mark.parametrize("starter", STARTERS)
def test_properties_have_the_values_of_the_spec(starter):
    tables = tomllib.loads(starter_text(starter)[1])
    keys = runpy.run_path(str(WORKBENCH / "gearcad_keys.py"))["keys_of"](tables)
    assert len({key.name for key in keys}) == len(keys) > 20
    given = 0
    for key in keys:
        table, _, field = key.dotted.partition(".")
        value = reduce(lambda inner, word: inner.get(word, {}), field.split("."), tables.get(table, {}))
        if value != {}:
            assert key.given(key.shown(tables)) == value, key.dotted
            given += 1
        elif key.type == "App::PropertyString":
            assert key.given(key.shown(tables)) is None, key.dotted
    assert given >= 4


@pytest.mark.long
def test_pair_and_other_kinds(tmp_path):
    texts = specs()
    texts["pair"] = texts.pop("Pair")
    del texts["Gear"]
    figures = run_freecad(tmp_path, texts, "mesh_of_pair other_kinds")
    for kind, (valid, _, volume, built) in figures["other_kinds"].items():
        assert valid, kind
        assert volume == pytest.approx(built, rel=SAME_VOLUME), kind
    solids = {kind: found[1] for kind, found in figures["other_kinds"].items()}
    assert solids == {"Ring": 1, "Rack": 1, "Planetary": 5, "Spline": 2}
    pair, turns = figures["mesh_of_pair"], []
    assert pair["volume"] == pytest.approx(pair["built"], rel=SAME_VOLUME)
    for before, after in zip(pair["before"], pair["after"], strict=True):
        turn = math.degrees(math.atan2(after[1], after[0]) - math.atan2(before[1], before[0]))
        turns.append((turn + 180) % 360 - 180)
    assert turns == pytest.approx([10.0, -10.0 * 20 / 41], abs=1e-6)
    assert pair["overlap"] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.long
def test_twenty_changes(tmp_path):
    changes = run_freecad(tmp_path, {}, "twenty_changes")["twenty_changes"]
    for kind, found in changes.items():
        assert all(valid for valid, _, _ in found), kind
        steps = {after[2] - before[2] for before, after in pairwise(found)}
        assert len(steps) == 1 and steps.pop() > 0, kind  # every tooth has as many faces
        assert len({volume for _, volume, _ in found}) == 20, kind


@pytest.mark.long
def test_random_designs_equal_those_of_build(tmp_path):
    random, texts = Random(43), {}
    for number in range(100):
        module = random.choice([0.5, 1.0, 2.0, 3.5])
        text = f"[gear]\nteeth = {random.randint(14, 60)}\nnormal_module = {module}\n"
        text += f"face_width = {module * random.uniform(4, 12):.3f}\nhelix_angle = {random.choice([0.0, 12.5, -25.0])}\n"
        text += f"profile_shift = {random.uniform(0.25, 0.4):.3f}\nbody.bore = {module * random.uniform(2, 6):.3f}\n"
        text += f"body.end_chamfer = {module * random.choice([0.0, 0.2]):.3f}\n"
        texts[f"random-{number:02}"] = text
    found = run_freecad(tmp_path, texts, "random_designs")["random_designs"]
    assert len(found) == 100
    for name, valid, volume, built in found:
        assert valid, texts[name]
        assert volume == pytest.approx(built, rel=SAME_VOLUME), texts[name]


BODIES = {
    "keyway": "body.keyway = true\n",
    "hub": 'body.hub_diameter = 24.0\nbody.hub_length = 8.0\nbody.hub_side = "both"\n',
    "chamfers": "body.end_chamfer = 0.5\nbody.tip_chamfer = 0.2\n",
    "helical": "helix_angle = 20.0\n",
}
WALLS = {"body-keyway": 4, "body-hub": 5, "body-chamfers": 1, "body-helical": 1, "body-ring": 7}
"""Number of walls: bore and sides of the keyway; bore, two hubs and their ends; outside and six holes of the ring."""


@pytest.mark.long
def test_numbers_of_faces_and_edges_of_bodies(tmp_path):
    texts = {f"body-{name}": gear_text(20, more) for name, more in BODIES.items()}
    ring = "body.rim_diameter = 190.0\nbody.bolt_circle = 178.0\nbody.bolt_holes = 6\nbody.bolt_diameter = 5.0\n"
    texts["body-ring"] = gear_text(-60, ring).replace("body.bore = 12.0\n", "")
    found = run_freecad(tmp_path, texts, "bodies")["bodies"]
    assert {name: len(after[2]) for name, (_, after) in found.items()} == WALLS
    for name, (before, after) in found.items():
        assert before == after, name
        assert len(before[0]) == 2, name  # end faces
