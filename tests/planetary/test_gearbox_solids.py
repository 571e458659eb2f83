"""Solids of a gearbox: parts, places and volumes after STEP, gaps of teeth by the kernel, and what cannot be built."""

import json
import math
from pathlib import Path

import cadquery
import pytest
import trimesh
from click.testing import CliRunner
from support.clearance import solid_volume
from support.rings import RingSection
from support.train_solids import distance_of, faces_near

import gearcad
from gearcad.cli import main
from gearcad.designs import PlanetaryGearboxDesign
from gearcad.designs.reader import starter_text

TOUCH = 1e-6
"""mm: flanks are within 1 nm of exact ones, distances of the kernel within a few tenths of a micrometre."""


def _built(folder: Path, *arguments: str, text: str = "") -> object:
    (folder / "it.toml").write_text(text or starter_text("ravigneaux")[1], encoding="utf-8")
    return CliRunner().invoke(main, ["build", str(folder / "it.toml"), "-o", str(folder / "out"), *arguments])


@pytest.mark.long
def test_a_gearbox_in_step_has_every_gear_in_mesh(tmp_path: Path) -> None:
    """Names and places after STEP, volumes by quadrature of exact outlines, and half the normal backlash between flanks."""
    done = _built(tmp_path, "--format", "step,stl", "--json")
    document = json.loads(done.stdout)  # type: ignore[attr-defined]
    parts = ["r.small", "r.large", "r.ring", "r.long", "r.short"]
    names = sorted(each.name for each in (tmp_path / "out").iterdir())
    assert names == sorted(["data.json", "assembly.step", *(f"{part}.{kind}" for part in parts for kind in ("step", "stl"))])
    opened = cadquery.Assembly.importStep(str(tmp_path / "out" / "assembly.step"))
    planets = [f"r.{name} {number}" for name in ("long", "short") for number in (1, 2, 3)]
    assert sorted(child.name for child in opened.children) == sorted([*parts[:3], *planets])
    assert set(document["places"]) == {*parts[:3], *planets}
    design = gearcad.read(tmp_path / "it.toml")
    assert isinstance(design, PlanetaryGearboxDesign)
    shapes = {}
    for child in opened.children:
        gear = design.gears[child.name.split(" ")[0]]
        exact = RingSection(gear).volume if gear.internal else solid_volume(gear)
        assert child.obj.isValid() and child.obj.Volume() == pytest.approx(exact, rel=2e-7), child.name
        shapes[child.name] = child.obj.moved(child.loc)
    for mesh, number in (("small-short", 1), ("large-long", 2), ("ring-long", 3), ("short-long", 2)):
        first, second = mesh.split("-")
        pair = design.pairs[f"r.{mesh}"]
        one = f"r.{first} {number}" if first == "short" else f"r.{first}"
        other = f"r.{second} {number}"
        x, y = ([document["places"][name][axis] for name in (one, other)] for axis in ("x", "y"))
        ratio = abs(design.gears[f"r.{first}"].teeth / pair.centre_distance * pair.pinion.normal_module / 2)
        near = x[0] + ratio * (x[1] - x[0]), y[0] + ratio * (y[1] - y[0]), 6 * pair.pinion.normal_module
        gap = distance_of(faces_near(shapes[one], *near), faces_near(shapes[other], *near))
        assert gap == pytest.approx(pair.normal_backlash / 2, abs=TOUCH), mesh
    assert math.isclose(document["places"]["r.ring"]["height"], 27.0)


def test_every_gear_is_a_file_and_all_stand_in_the_assembly(tmp_path: Path) -> None:
    done = _built(tmp_path, "--format", "csv,3mf", "--quiet")
    files = [Path(line).name for line in done.stdout.splitlines()]  # type: ignore[attr-defined]
    assert {"assembly.3mf", "r.small.csv", "r.long.3mf"} <= set(files) and len(files) == 12
    scene = trimesh.load_scene(tmp_path / "out" / "assembly.3mf")
    assert len(scene.graph.nodes_geometry) == 9
    low, high = scene.bounds
    assert low == pytest.approx((-65, -65, 0), abs=0.02) and high == pytest.approx((65, 65, 48), abs=0.02)


@pytest.mark.parametrize(
    ("change", "arguments", "message"),
    [
        (("ring.body.rim_diameter = 130.0\n", ""), (), r"r.ring.body.rim_diameter"),
        (None, ("--carrier",), "carrier = True: must be left out: a gearbox of planetary sets has none"),
        (None, ("--stage", "precut"), "must be left out: the gears of a gearbox are finished"),
    ],
)
def test_what_cannot_be_built_is_one_line(
    change: tuple[str, str] | None, arguments: tuple[str, ...], message: str, tmp_path: Path
) -> None:
    text = starter_text("ravigneaux")[1]
    done = _built(tmp_path, *arguments, text=text.replace(*change) if change else text)
    assert done.exit_code == 2 and message in done.stderr and done.stderr.count("\n") == 1  # type: ignore[attr-defined]
    assert not (tmp_path / "out").exists()


def test_a_gearbox_of_which_only_teeth_are_known_has_no_solid(tmp_path: Path) -> None:
    text = """
[planetary]
input = "s.sun"
output = "s.carrier"
set = [{ name = "s", sun.teeth = 24, ring.teeth = -66, planet = [{ teeth = 21 }] }]
states.1 = { held = ["s.ring"] }
"""
    done = _built(tmp_path, text=text)
    assert done.exit_code == 2 and "planets is missing: must be given in each [[planetary.set]]" in done.stderr  # type: ignore[attr-defined]
