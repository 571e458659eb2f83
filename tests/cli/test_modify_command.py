"""`gearcad modify` as a user meets it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.contact.modification_search import _Sampling
from gearcad.designs import read_spec

SPEC = """\
# Coarse bodies, quickly solved.
[pair]
name = "pair"  # the results go to output/pair/
normal_module = 2.0
helix_angle = 15.0            # right hand
face_width = 6.0
tooth_thinning = 0.05
[pinion]
teeth = 20
body.bore = 28.0
modification.lead_crowning = 9.0  # of a time when nobody asked why
[wheel]
teeth = 30
body.bore = 48.0
[material]
contact_limit = [100.0, 200.0]    # out of reach
[load]
torque = 40.0
application_factor = 1.25
[check]
model = "3d"
positions = 16
refinement = 0.5
body_teeth = 3
convergence = "off"
"""

SAME = 1e-9
"""Relative: the same bodies, positions and contacts."""


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, list(arguments))


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("gearcad.contact.modification_search._GENERATIONS", 3)
    monkeypatch.setattr("gearcad.contact.modification_search._STARTS", 1)
    monkeypatch.setattr("gearcad.jobs.modify._ROUNDS", 2)
    monkeypatch.setattr("gearcad.contact.modification_search._HELICAL", _Sampling(12, 16, 0))
    return tmp_path


def spec(text: str) -> str:
    Path("pair.toml").write_text(text, encoding="utf-8")
    return "pair.toml"


def test_the_written_spec_does_what_the_proposal_says(here: Path) -> None:
    result = run("modify", spec(SPEC), "--json", "--quiet", "--shape", "parabolic")
    assert (result.exit_code, result.stderr) == (0, "")
    document = json.loads(result.stdout)
    assert (document["kind"], document["name"], document["output"]) == ("modify", "pair-modified", "pair-modified.toml")
    assert document["torque"] == 50.0
    before, after = document["before"], document["after"]
    assert after["transmission_error_peak_to_peak"] < 0.8 * before["transmission_error_peak_to_peak"]
    assert after["contact_pressure"] <= document["pressure_bound"]
    assert document["model"] == "3d"
    conditions = [(each["torque"], each["misalignment"], each["pitch_error"]) for each in document["robustness"]]
    assert conditions == [(12.5, 0, 0), (25, 0, 0), (37.5, 0, 0), (50, 0, 0), (50, 10, 0), (50, -10, 0), (50, 0, 10)]
    text = Path("pair-modified.toml").read_text(encoding="utf-8")
    assert "# of a time when nobody asked why" in text
    assert "# the results go to output/pair-modified/" in text
    assert sorted(path.name for path in here.iterdir()) == ["pair-modified.toml", "pair.toml"]
    design = read_spec("pair-modified.toml")
    assert design.name == "pair-modified"
    assert design.pair is not None
    written = {"pair.name": design.name} | {
        f"{owner}.modification.{key}": value
        for owner, gear in design.gears.items()
        for key, value in gear.modification.to_dict().items()
    }
    assert document["changes"].items() <= written.items()
    assert design.pair.pinion.modification.tip_relief_shape.value == "parabolic"
    told(before, "pair.toml")
    told(after, "pair-modified.toml")


def told(figures: dict[str, Any], name: str) -> None:
    """The figures are those of a check of the spec, extremes between its positions included."""
    assert run("check", name, "-o", "checked", "--quiet").exit_code in (0, 1)
    summary = json.loads(Path("checked/check.json").read_text(encoding="utf-8"))["summary"]
    summary["edge_positions"] = summary["corner_positions"]
    assert figures.pop("transmission_error_harmonics") == pytest.approx(summary["transmission_error_harmonics"][:3], rel=SAME)
    assert figures == pytest.approx({key: summary[key] for key in figures}, rel=SAME)


def test_it_prints_before_and_after_and_warns(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.contact.modification_search._GENERATIONS", 1)
    result = run("modify", spec(SPEC), "-o", "other.toml", "--torque", "-30", "--pressure", "150", "--shape", "linear")
    assert result.exit_code == 0, result.output
    lines = result.stdout.splitlines()
    assert lines[0].startswith("pair at -30 N·m, ")
    assert lines[-1] == "other.toml"
    assert any(line.startswith("  pinion.modification.") and line.endswith(" µm") for line in lines)
    row = next(line for line in lines if line.startswith("contact pressure "))
    assert row.endswith(" MPa")
    assert len(row.split()) == 5
    (above,) = [line.split()[-4] for line in lines if line.startswith("bound of the contact pressure: 150 MPa; the")]
    assert float(above) == pytest.approx(100 * (float(row.split()[3]) / 150 - 1), rel=0.06)
    assert "figures of solid bodies, as gearcad check --model 3d has them" in lines
    assert "MPa, above the bound of 150 MPa" in result.stderr
    assert "[ 75 %] robustness\n" in result.stderr


@pytest.mark.parametrize(
    ("text", "arguments", "message"),
    [
        (
            SPEC.replace("[load]\ntorque = 40.0\napplication_factor = 1.25\n", ""),
            (),
            "load.torque is missing: must be given, in N·m on the pinion, here or as --torque",
        ),
        (
            SPEC.replace("torque = 40.0", "torque = 0.0"),
            (),
            "load.torque = 0 N·m: must not be 0: without torque flanks need no",
        ),
        (SPEC, ("--pressure", "-1"), "pressure = -1 MPa: must be a number at least 0.001 MPa and at most 1000000 MPa"),
        (SPEC, ("--torque", "nan"), "torque = nan N·m: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        (SPEC, ("--shape", "cubic"), "shape = 'cubic': must be one of 'linear', 'parabolic'"),
        (SPEC, ("-o", "pair.toml"), "output = 'pair.toml': exists; give another name, or --force to replace it"),
        (
            "[gear]\nteeth = 20\nnormal_module = 2\nface_width = 9\n",
            (),
            "kind = 'gear': must be a pair: flanks are modified for",
        ),
        (SPEC.replace('"pair"', f'"{"n" * 95}"'), (), "must be a plain file name of at most 100 characters"),
        ("teeth = 20\n", (), "pair.toml line 1: teeth: unknown table; permitted are [gear], [pair]"),
    ],
)
def test_wrong_input_is_one_line(here: Path, text: str, arguments: tuple[str, ...], message: str) -> None:
    result = run("modify", spec(text), "--quiet", *arguments)
    assert result.exit_code == 2
    assert message in result.stderr
    assert result.stderr.count("\n") == 1
    assert [path.name for path in here.iterdir()] == ["pair.toml"]
