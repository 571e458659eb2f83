"""`gearcad check` and `gearcad modify` as a user meets them."""

import json
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from support.commands import invoke, read_json, run, spec_file

from gearcad.contact.modification_search import _Sampling
from gearcad.core.records import NOT_ASKED_WORDS
from gearcad.designs import read_spec
from gearcad.jobs.strength import Check

SPUR = """
[pair]
normal_module = 2.0
face_width = 20.0
tooth_thinning = 0.05
[pinion]
teeth = 20
body.bore = 12.0
[wheel]
teeth = 30
body.bore = 20.0
[load]
torque = 50.0
[check]
positions = 12
torques = [25.0, 50.0]
"""


_EXTREME, _FEW = 0.002, 0.01
"""What a search between the positions may miss of an extreme; what 12 positions miss of a mean (a quarter of an extreme's)."""


QUICK = SPUR.replace("torques = [25.0, 50.0]", 'convergence = "off"')
"""One torque, one mesh, for what does not ask for more."""


@pytest.fixture
def no_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is solved and drawn for it, which takes longer than all that is asked here; tests of reports have it."""
    monkeypatch.setattr(import_module("gearcad.jobs.strength"), "Check", partial(Check, report=False))


@pytest.mark.usefixtures("no_pictures")
def test_check_prints_the_verdict_and_writes_both_files(here: Path) -> None:
    result = run("check", spec_file(SPUR))
    assert f"pair at 50 N·m: numerics passed; strength {NOT_ASKED_WORDS}\n" in result.stdout
    assert result.stdout.splitlines()[-2:] == ["output/pair/check.json", "output/pair/report.html"]
    assert sorted(path.name for path in (here / "output/pair").iterdir()) == ["check.json", "report.html"]
    document = read_json(here / "output/pair/check.json")
    assert document["kind"] == "check"
    assert (document["passed"], document["numerics"], document["strength"]) == (True, "passed", "not asked for")
    assert [point["torque"] for point in document["torque_sweep"]] == [25.0, 50.0]
    assert len(document["mesh_cycle"]["roll_angle"]) == document["positions"] == 12
    for mesh in document["mesh"].values():
        assert mesh["least_angle"] > 20  # degrees
        assert mesh["least_jacobian"] > 0.7
    cycle, summary = document["mesh_cycle"], document["summary"]
    # The lists are those of the even positions; extremes and means count those between them too, at every torque alike.
    assert summary["mesh_stiffness_mean"] == pytest.approx(sum(cycle["mesh_stiffness"]) / 12, rel=_FEW)
    for gear in ("pinion", "wheel"):
        found, most = document["extremes"][f"root_tension_{gear}"], max(cycle[f"root_stress_{gear}"])
        assert most <= found["value"] == summary[f"root_tension_{gear}"] < (1 + 4 * _FEW) * most
        assert document["torque_sweep"][1][f"root_tension_{gear}"] == pytest.approx(found["value"], rel=_EXTREME)
        assert 0 < found["error"] < _EXTREME and -9 <= found["roll_angle"] <= 9
    assert document["torque_sweep"][1]["contact_pressure"] == pytest.approx(summary["contact_pressure"], rel=_EXTREME)
    assert document["not_evaluated"] == {}
    assert all(sum(shares) == pytest.approx(1, abs=1e-9) for shares in cycle["load_share"])
    # Both torques are in equilibrium: 50 N·m on the pinion is 75 on the wheel.
    reactions = {each["quantity"]: each["computed"] for each in document["comparisons"] if "reaction" in each["quantity"]}
    assert reactions["torque reaction of the pinion"] == pytest.approx(50, rel=0.005)
    assert reactions["torque reaction of the wheel"] == pytest.approx(75, rel=0.005)


@pytest.mark.usefixtures("no_report")
def test_limits_that_are_passed_over_are_exit_status_1_and_json_is_one_document(here: Path) -> None:
    limits = "[material]\nname = 'tin'\ncontact_limit = [500, 900]\nroot_limit = 900\nyield_strength = 2000\n"
    result = invoke("check", spec_file(QUICK + limits), "--quiet", "--json")
    assert (result.exit_code, result.stderr) == (1, "")
    document = json.loads(result.stdout)
    assert (document["passed"], document["numerics"], document["strength"]) == (False, "passed", "failed")
    verdict = {
        each["quantity"]: (each["passed"], each["reference"])
        for each in document["comparisons"]
        if each["source"] == "limit of tin"
    }
    assert verdict == {
        "contact pressure": (False, 500.0),  # the lower end of the range counts
        "root stress, pinion": (True, 900.0),
        "root stress, wheel": (True, 900.0),
        "von Mises stress below the flank": (True, 2000.0),
    }


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            SPUR.replace("[load]\ntorque = 50.0", ""),
            "load.torque is missing: must be given, in N·m on the pinion: without it there is no stress",
        ),
        (
            SPUR.replace("torque = 50.0", "torque = 0"),
            "load.torque = 0 N·m: must not be 0: without torque there is nothing to check",
        ),
        (
            SPUR.replace("positions = 12", "body_teeth = 4"),
            "pair.toml line 15: check.body_teeth = 4: must be odd (the loaded tooth stands in the middle), or 0",
        ),
        (
            SPUR.replace("positions = 12", "positions = 5"),
            "pair.toml line 15: check.positions = 5: must be a whole number from 12 to 1000",
        ),
        (
            SPUR.replace("positions = 12", 'plane = "flat"'),
            'pair.toml line 15: check.plane = \'flat\': must be "strain" or "stress"',
        ),
        (
            SPUR.replace("positions = 12", 'model = "4d"'),
            'pair.toml line 15: check.model = \'4d\': must be "2d", "3d", "section" or "auto"',
        ),
        (
            SPUR.replace("positions = 12", 'model = "2d"').replace("[pair]", "[pair]\nhelix_angle = 12.0"),
            "pair.helix_angle = 12 deg: must be 0 for model 2d: "
            "the lines of contact of helical teeth run across the flank, as in model 3d",
        ),
        (
            SPUR.replace("positions = 12", "convergence = 1"),
            'pair.toml line 15: check.convergence = 1: must be "on" or "off"',
        ),
        (
            SPUR.replace("positions = 12", "postions = 12"),
            "pair.toml line 15: check.postions: unknown key; did you mean positions?",
        ),
        (
            SPUR.replace("positions = 12", "pinion_inner_diameter = 36"),
            "pinion.inner_diameter = 36 mm: must be at most 34.6 mm, below the root circle",
        ),
        (
            "[gear]\nteeth = 20\nnormal_module = 2.0\nface_width = 20.0\n",
            "kind = 'gear': must be a pair or a rack and pinion: a single gear has nothing to press against",
        ),
    ],
)
def test_what_cannot_be_checked_is_one_line(here: Path, text: str, message: str) -> None:
    result = invoke("check", spec_file(text), "--quiet")
    assert (result.exit_code, result.stderr) == (2, f"Error: {message}\n")
    assert not Path("output").exists()


@pytest.mark.long
@pytest.mark.usefixtures("no_report")
def test_absurd_load_and_thin_rim_are_warnings_with_their_numbers(here: Path) -> None:
    result = invoke("check", spec_file(QUICK.replace("torque = 50.0", "torque = 50000.0")), "--quiet")
    assert "of the modulus: linear elasticity means little there" in result.stdout
    thin = QUICK.replace("bore = 12.0", "bore = 32.0")
    result = invoke("check", spec_file(thin), "--quiet")
    assert "the pinion's rim (1.5 mm, 0.333 tooth depths) bends: its bore is free, but for shear, on 32 mm;" in result.stdout
    held = QUICK.replace("positions = 12", "positions = 12\npinion_inner_diameter = 32")
    result = run("check", spec_file(held), "--quiet")
    assert "the pinion's rim (1.5 mm, 0.333 tooth depths) is held rigidly" in result.stdout


@pytest.mark.usefixtures("no_pictures")
def test_modified_and_misaligned_gears_are_checked_as_far_as_a_plane_goes(here: Path, request: pytest.FixtureRequest) -> None:
    """Reliefs and pitch errors count; what depends on z is named and left out; the report lists all of it."""
    changes = "pinion_pitch_error = 4\ncentre_distance_change = 0.05\nmisalignment = 10\n"
    crowned = "modification.tip_relief = 15\nmodification.tip_relief_length = 1\nmodification.lead_crowning = 5\n[wheel]"
    text = QUICK.replace("[wheel]", crowned) + f"[mounting]\n{changes}"
    result = run("check", spec_file(text), "--quiet")
    left_out = "the plane model leaves out the pinion's modifications along the face width and the misalignment"
    assert f"Warning: {left_out}; --model 3d has them" in result.stdout
    document = read_json(here / "output/pair/check.json")
    report = (here / "output/pair/report.html").read_text(encoding="utf-8")
    assert document["mounting"]["pinion_pitch_error"] == 4.0
    # The middle pair stands proud: unloaded it would be 4 µm ahead, and loaded it is still less behind than without.
    request.getfixturevalue("no_report")
    plain = invoke("check", spec_file(QUICK), "--quiet", "--json")
    errors = [max(each["mesh_cycle"]["transmission_error"]) for each in (document, json.loads(plain.stdout))]
    assert errors[0] < errors[1]
    for shown in ("tip relief, length of roll", "lead crowning", "change of the centre distance", "50.05"):
        assert shown in report
    assert "root relief" not in report


def test_a_centre_distance_that_parts_the_teeth_is_refused(here: Path) -> None:
    result = run("check", spec_file(SPUR + "[mounting]\ncentre_distance_change = 5\n"), "--quiet", status=2)
    assert result.stderr.startswith(
        "Error: mounting.centre_distance_change = 5 mm: makes a centre distance of 55 mm, but must be below "
    )


def test_solver_failure_leaves_nothing_half_written(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import gmsh

    def fail(_dimension: int) -> None:
        raise RuntimeError("no mesh today")

    monkeypatch.setattr(gmsh.model.mesh, "generate", fail)
    result = invoke("check", spec_file(SPUR), "--quiet")
    assert (result.exit_code, result.stderr) == (1, "Error: gmsh could not mesh the section: no mesh today\n")
    assert not Path("output").exists()


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
positions = 12
refinement = 0.5
body_teeth = 3
convergence = "off"
"""

SAME = 1e-9
"""Relative: the same bodies, positions and contacts."""


@pytest.fixture
def modify_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("gearcad.contact.modification_search._GENERATIONS", 3)
    monkeypatch.setattr("gearcad.contact.modification_search._STARTS", 1)
    monkeypatch.setattr("gearcad.jobs.modify._ROUNDS", 2)
    monkeypatch.setattr("gearcad.jobs.modify._NEARBY", 1)
    monkeypatch.setattr("gearcad.contact.shared.loaded._MOST", 3)  # of checks too
    monkeypatch.setattr("gearcad.contact.modification_search._HELICAL", _Sampling(12, 16, 0))
    return tmp_path


@pytest.mark.long
@pytest.mark.usefixtures("no_report")
def test_the_written_spec_does_what_the_proposal_says(modify_here: Path) -> None:
    result = invoke("modify", spec_file(SPEC), "--json", "--quiet", "--shape", "parabolic")
    assert (result.exit_code, result.stderr) == (0, "")
    document = json.loads(result.stdout)
    assert (document["kind"], document["name"], document["output"]) == ("modify", "pair-modified", "pair-modified.toml")
    assert {"passed", "strength", "not_judged", "warnings"} <= document.keys()
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
    assert sorted(path.name for path in modify_here.iterdir()) == ["pair-modified.toml", "pair.toml"]
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
    assert invoke("check", name, "-o", "checked", "--quiet").exit_code in (0, 1)
    summary = read_json("checked/check.json")["summary"]
    summary["edge_positions"] = summary["corner_positions"]
    assert figures.pop("transmission_error_harmonics") == pytest.approx(summary["transmission_error_harmonics"][:3], rel=SAME)
    assert figures == pytest.approx({key: summary[key] for key in figures}, rel=SAME)


def test_it_prints_before_and_after_and_warns(modify_here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gearcad.contact.modification_search._GENERATIONS", 1)
    result = run("modify", spec_file(SPEC), "-o", "other.toml", "--torque", "-30", "--pressure", "150", "--shape", "linear")
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
def test_wrong_input_is_one_line(modify_here: Path, text: str, arguments: tuple[str, ...], message: str) -> None:
    result = run("modify", spec_file(text), "--quiet", *arguments, status=2)
    assert message in result.stderr
    assert result.stderr.count("\n") == 1
    assert [path.name for path in modify_here.iterdir()] == ["pair.toml"]


SPLINE = """
[spline]
designation = "N 15 x 1.25 x 10 x 9H / W 15 x 1.25 x 10 x 9g"
length = 20.0
shaft = {tolerance_actual = 20.0, tolerance_effective = 10.0}
hub = {tolerance_actual = 20.0, tolerance_effective = 10.0}
[load]
torque = 80.0
"""


def test_a_spline_is_checked_tooth_by_tooth_and_says_what_was_not_judged(here: Path) -> None:
    result = run("check", spec_file(SPLINE), "-o", here / "out")
    assert "numerics passed; strength not judged: flank pressure, root stress, torsion" in result.stdout
    document = read_json(here / "out" / "check.json")
    assert (document["passed"], document["strength"]) == (True, None) and document["not_judged"]
    assert document["contact"]["shares"] == pytest.approx([0.1] * 10, abs=1e-9)
    assert sum(document["contact"]["torques"]) == pytest.approx(80.0, rel=1e-9)
    refused = invoke("check", spec_file(SPLINE.partition("[load]")[0]))
    assert refused.exit_code != 0 and "load.torque" in refused.output and "Traceback" not in refused.output


@pytest.mark.long
@pytest.mark.usefixtures("no_report")
def test_a_proposal_over_loads_is_what_checks_under_each_find(modify_here: Path) -> None:
    loads = "[modify]\nloads = [[50, 1], [30, 3]]\n"
    text = SPEC.replace("contact_limit = [100.0, 200.0]    # out of reach", "contact_limit = 3000.0")
    text = text.replace("modification.lead_crowning = 9.0  # of a time when nobody asked why", "")
    result = invoke("modify", spec_file(text + loads), "--json", "--quiet", "--shape", "parabolic")
    assert (result.exit_code, result.stderr) == (0, "")
    document = json.loads(result.stdout)
    found = document["loads"]
    assert (document["torque"], found["objective"], [each["torque"] for each in found["each"]]) == (50, "mean", [50, 30])
    assert found["after"] == pytest.approx(sum(each["after"] * each["weight"] for each in found["each"]) / 4, rel=1e-12)
    assert found["after"] < 0.5 * found["before"]
    written = Path("pair-modified.toml").read_text(encoding="utf-8").replace("application_factor = 1.25", "")
    assert "loads = [[50, 1], [30, 3]]" in written
    for each in found["each"]:
        Path("one.toml").write_text(written.replace("torque = 40.0", f"torque = {each['torque']}"), encoding="utf-8")
        assert invoke("check", "one.toml", "-o", "checked", "--quiet").exit_code in (0, 1)
        summary = read_json("checked/check.json")["summary"]
        # A check seeks the extremes of pressures and root stresses too, and so has a few positions more.
        assert summary["transmission_error_peak_to_peak"] == pytest.approx(each["after"], rel=2e-3)
        assert summary["contact_pressure"] <= document["pressure_bound"]
