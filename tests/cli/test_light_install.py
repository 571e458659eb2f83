"""The light installation: commands that need few packages, their files, and the lines for packages that are missing."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from gearcad.cli import main
from gearcad.cli.doctor import _EXTRAS, _FULL, _LIGHT, doctor

ROOT = Path(__file__).parents[2]

WITHOUT = sorted({module for module, *_ in (*_FULL.values(), *_EXTRAS.values())} | {"OCP", "markupsafe", "lxml", "networkx"})
"""Modules that the light installation lacks."""

RUN = """
import sys
class Without:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {without}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Without())
from click.testing import CliRunner
from gearcad.cli import main
import json
told = []
for arguments in json.loads(sys.argv[1]):
    done = CliRunner().invoke(main, arguments)
    told.append([done.exit_code, done.stdout, done.stderr])
print(json.dumps(told))
"""

COMMANDS = {
    "spec": ["new", "reducer", "-o", "reducer.toml"],
    "data": ["data", "reducer.toml", "--json"],
    "build": ["build", "reducer.toml", "--format", "step,stl,3mf,glb,dxf,csv", "-o", "out/build"],
    "rate": ["rate", "reducer.toml", "-o", "out/rate"],
    "draw": ["draw", "reducer.toml", "-o", "out/draw"],
    "export": ["export", "reducer.toml", "-o", "out/export"],
    "import": ["import", "out/export/reducer-21-43.rexs", "-o", "out/import"],
    "identify": "identify --teeth 24 --tip-diameter 52.02 --root-diameter 43.01 --span 3:15.40 --span 4:21.30 --json".split(),
}

LACKING = [
    ("gmsh", ["check", "reducer.toml"]),
    ("scikit-fem", ["check", "reducer.toml", "--model", "3d"]),
    ("vtk", ["picture", "reducer.toml"]),
    ("scipy", ["verify", "reducer.toml"]),
    ("filelock", ["open", "reducer.toml", "--no-browser"]),
]
"""Commands that need more, with the package that they name."""


def _light(arguments: list[list[str]]) -> list[tuple[int, str, str]]:
    """Return exit status, stdout and stderr of commands in a process that lacks all packages of the full installation."""
    command = [sys.executable, "-c", RUN.format(without=set(WITHOUT)), json.dumps(arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [(status, out, err) for status, out, err in json.loads(done.stdout)]


def test_files_are_those_of_the_full_installation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1")
    light, full = tmp_path / "light", tmp_path / "full"
    for folder in (light, full):
        folder.mkdir()
    monkeypatch.chdir(light)
    told = dict(zip(COMMANDS, _light(list(COMMANDS.values())), strict=True))
    monkeypatch.chdir(full)
    for name, arguments in COMMANDS.items():
        done = CliRunner().invoke(main, arguments)
        assert (done.exit_code, told[name][0]) == (0, 0), (name, told[name])
        if not arguments[-1].startswith("out/"):
            assert told[name][1] == done.stdout, name
    made = {path.relative_to(light): path.read_bytes() for path in light.rglob("*") if path.is_file()}
    wanted = {path.relative_to(full): path.read_bytes() for path in full.rglob("*") if path.is_file()}
    assert wanted.keys() - made.keys() == {Path("out/rate/rate.html")}
    assert {path for path in made if made[path] != wanted[path]} == set()
    assert "rate.html is left out: the package jinja2 is not installed: pip install jinja2\n" in told["rate"][2]


def test_a_command_that_lacks_a_package_says_which_in_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert CliRunner().invoke(main, COMMANDS["spec"]).exit_code == 0
    packages, commands = zip(*LACKING, strict=True)
    for package, (status, _, told) in zip(packages, _light(list(commands)), strict=True):
        line = told.strip().splitlines()[-1]
        assert status == 1 and re.match(rf"Error: (the package )?{package} (is not installed|cannot be loaded)", line), told


@pytest.mark.parametrize(
    ("method", "why"),
    [("strain-energy", "gmsh cannot be loaded"), ("potential-energy", "the package scipy is not installed: pip install scipy")],
)
def test_a_planetary_set_without_the_stiffness_of_its_meshes(
    method: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Speeds, torques, forces, assembly and rating are those of the full installation; what needs the stiffness is named."""
    monkeypatch.chdir(tmp_path)
    text = (ROOT / "templates" / "planetary-24-21-66.toml").read_text(encoding="utf-8")
    Path("set.toml").write_text(f'{text}\n[dynamics]\nstiffness = "{method}"\n', encoding="utf-8")
    ((status, told, progress),) = _light([["planetary", "set.toml", "-o", "light"]])
    assert status == 0 and "planetary.html is left out: the package jinja2 is not installed: pip install jinja2\n" in progress
    assert re.search(f"no stiffness of the meshes.*: {why}", told)
    light = json.loads(Path("light/planetary.json").read_text(encoding="utf-8"))
    assert all(light[name] is None for name in ("load_sharing", "torsional_stiffness", "running", "modes", "campbell"))
    full = json.loads(CliRunner().invoke(main, ["data", "set.toml", "--json"]).stdout)["planetary"]
    same = [name for name in full if light.get(name) and name not in ("members", "notices", "warnings")]
    assert set(same) >= {"ratio", "basic_ratio", "planet_angles"}
    assert all(light[name] for name in ("power", "forces", "loads", "phases", "rating"))
    assert {name: light[name] for name in same} == {name: full[name] for name in same}


def test_the_list_of_packages_is_that_of_the_requirements() -> None:
    listed = {
        re.match(r"[\w-]+", line)[0]  # type: ignore[index]
        for line in (ROOT / "requirements-core.txt").read_text(encoding="utf-8").splitlines()
        if not line.startswith("#")
    }
    assert listed == set(_LIGHT)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    needed = {re.match(r"[\w-]+", line)[0] for line in project["dependencies"]}  # type: ignore[index]
    assert needed == set(_LIGHT) | set(_FULL)


def test_doctor_tells_what_is_there() -> None:
    done = CliRunner().invoke(doctor, ["--json"])
    document = json.loads(done.stdout)
    assert (done.exit_code, document["warnings"]) == (0, [])
    there = {part["name"]: part["there"] for part in document["parts"]}
    import numpy

    assert there["numpy"] == numpy.__version__
    assert set(document["missing"]) == {name for name, place in there.items() if not place}
    assert "missing: pip install" not in CliRunner().invoke(doctor, []).stdout.partition("distributed")[0]


def test_doctor_of_a_light_installation_names_what_is_missing() -> None:
    ((status, told, _),) = _light([["doctor"]])
    assert status == 0
    assert re.search(r"^scipy +full +missing: pip install scipy +check, stiffness, dynamics, study$", told, re.MULTILINE)
    assert told.endswith("`pip install gearcad` adds the rest.\n")
