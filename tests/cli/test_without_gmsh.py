"""gmsh is under the GPL, and some do without: what is not meshed with it runs, the rest says in one line what is missing."""

import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from support.commands import invoke
from support.specs import TEMPLATES

import gearcad
from gearcad.cli import main

MISSING = "gmsh cannot be loaded (import of gmsh halted; None in sys.modules): pip install gmsh; solid checks"


@pytest.fixture(autouse=True)
def no_gmsh(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "gmsh", None)
    monkeypatch.chdir(tmp_path)


def run(*arguments: str) -> str:
    done = CliRunner().invoke(main, [*arguments, "--quiet"] if arguments[0] != "data" else list(arguments))
    assert done.exit_code == 0, done.output
    return done.output


def test_geometry_solids_and_ratings_need_no_gmsh(tmp_path: Path) -> None:
    pair = str(TEMPLATES / "reducer-21-43.toml")
    run("data", pair)
    run("build", pair, "--format", "step,stl")
    assert gearcad.rate(gearcad.read(pair)).verdict == "strength passed"
    assert {"wheel.step", "wheel.stl"} < {each.name for each in (tmp_path / "output" / "reducer-21-43").iterdir()}


def test_a_planetary_train_tells_all_but_what_hangs_on_stiffness() -> None:
    study = gearcad.planetary(gearcad.read(TEMPLATES / "planetary-24-21-66.toml"))
    assert study.forces and study.flow.efficiency > 0.9 and study.rating
    assert set(study.why_not) == {"stiffness", "sharing", "torsion", "running", "modes", "campbell"}
    assert all(reason.startswith(MISSING) for reason in study.why_not.values())


@pytest.mark.parametrize("command", ["mesh", "check", "dynamics"])
def test_what_needs_triangles_says_so_in_one_line_and_leaves_nothing(command: str, tmp_path: Path) -> None:
    done = invoke(command, str(TEMPLATES / "fzg-c.toml"), "--quiet")
    assert done.exit_code == 1
    assert done.stderr.startswith(f"Error: {MISSING}") and done.stderr.count("\n") == 1
    assert not list(tmp_path.rglob("*.*"))


@pytest.mark.long
def test_sheets_pictures_and_solid_bodies_need_no_gmsh(tmp_path: Path) -> None:
    run("draw", str(TEMPLATES / "spur.toml"))
    run("picture", str(TEMPLATES / "spur.toml"), "-o", "spur.png")
    volvo = str(TEMPLATES / "volvo-13-44.toml")
    run("mesh", volvo)
    run("stiffness", volvo, "--method", "potential-energy")
    run("dynamics", volvo)
    done = invoke("check", volvo, "--quiet")
    assert "numerics" in done.output and MISSING not in done.output
    assert (tmp_path / "output" / "volvo-13-44" / "check.json").exists()
