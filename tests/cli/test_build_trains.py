"""`gearcad build` of planetary trains: which files appear, and what is refused in a line."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.designs import read_spec
from gearcad.jobs.build import Build
from gearcad.solids import FileOptions

TEMPLATES = Path(__file__).parents[2] / "templates"
ALM = TEMPLATES / "planetary-alm.toml"


def build(*arguments: object, status: int = 0) -> Result:
    result = CliRunner().invoke(main, ["build", *map(str, arguments), "--quiet"])
    assert result.exit_code == status, result.stderr
    return result


def test_every_gear_has_files_of_its_own_and_the_train_an_assembly(tmp_path: Path) -> None:
    build(ALM, "--format", "dxf,csv", "--circles", "-o", tmp_path / "out")
    gears = list(read_spec(ALM).gears)
    assert len(gears) == 6
    files = {"data.json", "assembly.dxf", *(f"{gear}.{suffix}" for gear in gears for suffix in ("dxf", "csv"))}
    assert {file.name for file in (tmp_path / "out").iterdir()} == files


def test_a_carrier_has_files_of_its_own_in_the_formats_of_bodies() -> None:
    job = Build(formats=("step", "stl", "dxf", "csv"), options=FileOptions(carrier=True))
    files = job.files(job.run(read_spec(ALM)))
    assert [file for file in files if file.startswith("carrier.")] == ["carrier.stl", "carrier.step"]
    assert not any(file.startswith("carrier.") for file in Build(formats=("step",)).files(read_spec(ALM)))


PLAIN = """
[planetary]
planets = 3
input = "sun"
output = "carrier"
fixed = "ring"
normal_module = 2.0
face_width = 20.0

[sun]
teeth = 24

[planet]
teeth = 21

[ring]
teeth = -66
"""


@pytest.mark.parametrize(
    ("spec", "arguments", "message"),
    [
        ("plain", ["--format", "step"], "ring.body.rim_diameter is missing: must be given, at least 137.4 mm: a solid of"),
        ("alm", ["--format", "dxf", "--exploded"], "exploded = True: needs the format step or 3mf or glb or png"),
        ("alm", ["--format", "step", "--turning"], "turning = True: needs the format glb: it is an animation of assembly.glb"),
        ("alm", ["--bracket"], "bracket = True: needs a pair of gears: a planetary train has a carrier"),
        ("pair", ["--carrier"], "carrier = True: needs a planetary train"),
        ("pair", ["--format", "glb", "--turning"], "turning = True: needs a planetary train"),
    ],
)
def test_what_cannot_be_built_is_one_line_and_leaves_nothing(
    spec: str, arguments: list[str], message: str, tmp_path: Path
) -> None:
    (tmp_path / "plain.toml").write_text(PLAIN)
    path = {"plain": tmp_path / "plain.toml", "alm": ALM, "pair": TEMPLATES / "volvo-13-44.toml"}[spec]
    result = build(path, *arguments, "-o", tmp_path / "out", status=2)
    assert result.stderr.startswith(f"Error: {message}") and result.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_row_has_the_options_that_its_kind_has_use_for() -> None:
    options = FileOptions(bracket=True, carrier=True, exploded=True, turning=True)
    job = Build(formats=("step", "glb"), options=options)
    of_pair = job.for_row(read_spec(TEMPLATES / "volvo-13-44.toml"), ["step", "glb"])
    of_train = job.for_row(read_spec(ALM), ["step", "glb"])
    of_step = job.for_row(read_spec(ALM), ["step"])
    assert of_pair.options == FileOptions(bracket=True)  # type: ignore[attr-defined]
    assert of_train.options == FileOptions(carrier=True, exploded=True, turning=True)  # type: ignore[attr-defined]
    assert of_step.options == FileOptions(carrier=True, exploded=True)  # type: ignore[attr-defined]
