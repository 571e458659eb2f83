"""`gearcad check` and `gearcad stiffness` of a pinion and a rack, and of sections of helical gears."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from support.commands import invoke, read_json, run, spec_file

RACK = """
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
[load]
torque = 40.0
[check]
positions = 12
refinement = 0.5
convergence = "off"
torques = [40.0]
"""

HELICAL = RACK.replace("[pinion]", "helix_angle = 15.0\n[pinion]", 1)

PAIR = HELICAL.replace("[rack]\nteeth = 40", "[wheel]\nteeth = 40").replace("height = 12.0\n", "")


@pytest.mark.usefixtures("no_pictures")
def test_check_of_a_rack_balances_force_and_torque(here: Path) -> None:
    result = run("check", spec_file(RACK))
    assert "force along the rack, from its back" in result.stdout
    document = read_json(here / "output/rack/check.json")
    assert document["passed"] and document["model"] == "2d"
    assert document["rack"]["force"] == pytest.approx(2000 * 40 / 40, rel=1e-12)  # d = 40 mm
    along = [error / math.cos(math.radians(20)) for error in document["mesh_cycle"]["transmission_error"]]
    assert document["rack"]["transmission_error"] == pytest.approx(along, rel=1e-12)
    assert document["body"]["wheel"].startswith("rack, a strip of teeth held along its back")
    text = (here / "output/rack/report.html").read_text(encoding="utf-8")
    assert "part of the rack" in text or "of the rack" in text
    assert "of the wheel" not in text.replace("contact factor of the wheel", "")  # Z_D of the standard


@pytest.mark.long
def test_stiffness_of_a_rack_has_three_methods_and_says_why_not_the_others(here: Path) -> None:
    result = run("stiffness", spec_file(RACK), "--positions", "12")
    document = read_json(here / "output/rack/stiffness.json")
    assert set(document["methods"]) == {"iso6336", "plane-stress", "plane-strain"}
    assert set(document["left_out"]) == {"potential-energy", "weber-banaschek", "strain-energy", "3d"}
    assert "Weber-Banaschek: left out: pair = 'pinion and rack': must be two gears for weber-banaschek" in result.output


@pytest.mark.parametrize("content", [PAIR, pytest.param(HELICAL, marks=pytest.mark.long)])
@pytest.mark.usefixtures("no_pictures")
def test_sections_of_helical_gears_are_said_to_be_sections(here: Path, content: str) -> None:
    rated = content.replace("[check]", "[material]\nroot_limit = 50.0\n[rating]\nrequired_safety_root = 1.4\n[check]")
    result = run("check", spec_file(rated), "--model", "section", status=1)
    document = read_json(next((here / "output").glob("*/check.json")))
    radius = 2 * 20 / math.cos(math.radians(15)) / 2
    transverse = math.atan(math.tan(math.radians(20)) / math.cos(math.radians(15)))
    assert document["section"]["line_load"] == pytest.approx(40e3 / (radius * math.cos(transverse)) / 20, rel=1e-12)
    assert document["section"]["helix_angle"] == 15
    # A root stress above the limit fails no strength: a section has none.
    assert document["summary"]["root_tension_pinion"] > 50
    assert (document["strength"], document["numerics"]) == ("not judged", "passed")
    assert "a transverse section of helical teeth is no model of the gears" in result.output


@pytest.mark.parametrize(
    ("content", "options", "message"),
    [
        (HELICAL, (), "pair.helix_angle = 15 deg: must be 0 for a rack, which has no solid bodies"),
        (RACK, ("--model", "3d"), 'check.model = \'3d\': must be "2d", "section" or "auto" for a rack'),
        (RACK + 'wheel_support = "free"\n', (), "check.wheel_support = 'free': must be \"rigid\" for a rack"),
        (RACK + "wheel_inner_diameter = 20.0\n", (), "check.wheel_inner_diameter = 20 mm: must be left out"),
        (RACK.replace("teeth = 40", "teeth = 2"), (), "rack.teeth = 2: must be at least 3 here"),
    ],
)
def test_bad_input_is_one_line(here: Path, content: str, options: tuple[str, ...], message: str) -> None:
    result = invoke("check", spec_file(content), *options)
    assert result.exit_code == 2
    lines = result.stderr.strip().splitlines()
    assert message in lines[-1] and not list(here.glob("output/*"))
