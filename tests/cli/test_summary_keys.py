"""`--json` of every command has passed, strength, not_judged and warnings at its top, and so has the file that it writes."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from gearcad.cli import main
from gearcad.cli.group import job_commands
from gearcad.jobs import VERBS, WITHOUT_DESIGN, job_of
from gearcad.jobs.job import with_summary

PAIR = """
[pair]
normal_module = 2.0
face_width = 20.0
helix_angle = 0.0
tooth_thinning = 0.05
[pinion]
teeth = 20
[wheel]
teeth = 30
[load]
torque = 50.0
[check]
positions = 12
convergence = "off"
refinement = 0.5
body_teeth = 3
torques = [50.0]
"""

TABLE = "name,teeth,normal_module,face_width\nthe-gear,20,2,20\n"

SIZE = "--torque 100 --ratio 2 --material 'Eh MQ' --speed 1500 --life 1e4 --teeth 17:20 --module 2,2.5 --errors 0 --count 1"

COMMANDS = {
    "data": "data pair.toml",
    "build": "build pair.toml --format csv",
    "draw": "draw pair.toml --format svg",
    "picture": "picture pair.toml --size 200x150",
    "verify": "verify gear.toml",
    "check": "check pair.toml --model 2d",
    "mesh": "mesh gear.toml",
    "rate": "rate pair.toml",
    "stiffness": "stiffness pair.toml --method iso6336",
    "dynamics": "dynamics train.toml",
    "planetary": "planetary planetary.toml",
    "shafts": "shafts shaft.toml",
    "planetary sets": "planetary --ratio 5 --module 2 --planets 3",
    "identify": "identify --teeth 24 --tip-diameter 52.02 --root-diameter 43.01",
    "tools": "tools",
    "tools of a design": "tools pair.toml -o output/tools",
    "export": "export pair.toml --quiet",
    "import": "import pair.rexs --quiet -o output/import",
    "size": f"size {SIZE}",
    "batch": "batch gears.csv --do data",
}

TRAIN = """
[train]
name = "shaft"
[[train.inertia]]
name = "motor"
inertia = 0.01
[[train.inertia]]
name = "load"
inertia = 0.02
[[train.shaft]]
name = "between"
start = "motor"
end = "load"
torsional_stiffness = 1e4
"""

SHAFT = """
[[shaft]]
length = 200.0
outer_diameter = 30.0
[[bearing]]
position = 10.0
axial_stiffness = "rigid"
[[bearing]]
position = 190.0
"""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in {"pair.toml": PAIR, "train.toml": TRAIN, "gears.csv": TABLE, "shaft.toml": SHAFT}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert CliRunner().invoke(main, ["export", "pair.toml", "-o", "."]).exit_code == 0
    for kind, name in (("spur", "gear.toml"), ("planetary-24-21-66", "planetary.toml")):
        assert CliRunner().invoke(main, ["new", kind, "-o", name]).exit_code == 0
    return tmp_path


def test_every_command_of_a_job_is_among_them() -> None:
    of_modify = "modify"  # test_check_command: its search takes long
    assert {*job_commands(), *VERBS, *WITHOUT_DESIGN, "size", "batch"} - {of_modify} <= set(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_a_document_has_the_keys_at_its_top(command: str, here: Path) -> None:
    result = CliRunner().invoke(main, [*shlex.split(COMMANDS[command]), "--json"])
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    _require_summary(document)
    for path in here.glob("output/**/*.json"):
        if path.name != "manifest.json":
            _require_summary(json.loads(path.read_text(encoding="utf-8")))


def _require_summary(document: dict[str, object]) -> None:
    assert document["passed"] in (True, False, None)
    assert document["strength"] is None or isinstance(document["strength"], str | bool)
    unjudged, warnings = document["not_judged"], document["warnings"]
    assert isinstance(unjudged, dict | list) and all(isinstance(each, str) for each in unjudged)
    assert isinstance(warnings, list) and all(isinstance(each, str) for each in warnings)


@pytest.mark.parametrize("verb", VERBS)
def test_no_job_writes_a_document_of_its_own(verb: str) -> None:
    assert "complete_document" not in vars(job_of(verb))
    assert "write_document" not in vars(job_of(verb))


def test_keys_that_a_document_has_are_kept() -> None:
    own = {"passed": False, "strength": "failed", "not_judged": {"root": "no limit"}, "warnings": ["thin"]}
    assert with_summary({"kind": "rate", **own}, ["another"]) == {"kind": "rate", **own}
    assert list(with_summary({"kind": "data"}, ["thin"]).items()) == [
        ("kind", "data"),
        ("passed", None),
        ("strength", None),
        ("not_judged", []),
        ("warnings", ["thin"]),
    ]
