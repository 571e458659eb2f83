"""Whatever a spec holds, a command answers with a status, and with one line where it refuses: never with a fault of ours."""

from __future__ import annotations

import copy
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from support.hostile import CHEAP, hostile_rows, hostile_specs, physical_specs, put, run_politely, toml_text

from gearcad.core.errors import SpecError
from gearcad.core.output import json_text
from gearcad.core.quantities import TORQUE
from gearcad.designs import read_spec
from gearcad.designs.reader import starter_text
from gearcad.designs.table import open_table

FZG = tomllib.loads(starter_text("fzg-c")[1]) | {"check": CHEAP}
TRAIN = tomllib.loads(starter_text("train-1-stage")[1])

HUGE = 10**400


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for all examples: each writes over what the last one left."""
    return tmp_path_factory.mktemp("hostile")


def spec_file(folder: Path, text: str, name: str = "x.toml") -> str:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return str(path)


@settings(max_examples=100)
@given(text=hostile_specs(trains=False))
def test_data_of_a_hostile_spec(folder: Path, text: str) -> None:
    run_politely("data", spec_file(folder, text))


@settings(max_examples=100)
@given(text=hostile_specs(trains=True))
def test_reading_a_hostile_train(folder: Path, text: str) -> None:
    try:
        read_spec(spec_file(folder, text))
    except SpecError as error:
        assert str(error).isprintable()


@settings(max_examples=100)
@given(text=hostile_specs(planetary=True))
def test_reading_a_hostile_planetary_train(folder: Path, text: str) -> None:
    try:
        json_text(read_spec(spec_file(folder, text)).to_dict())
    except SpecError as error:
        assert str(error).isprintable() and len(str(error)) < 1200


@settings(max_examples=100)
@given(text=hostile_rows())
def test_reading_a_hostile_table(folder: Path, text: str) -> None:
    try:
        faults = [fault for row in open_table(spec_file(folder, text, "x.csv")).rows() for fault in row.all_faults()]
    except SpecError as error:
        faults = str(error).split("\n")
    assert all(fault.isprintable() for fault in faults)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("load.torque", 1e300, "load.torque = 1e+300 N·m: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        ("load.torque", 1e-300, "load.torque = 1e-300 N·m: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        ("load.torque", [[]], "load.torque = [[]]: must be a number, 0 or from 1e-09 to 1e+09 N·m in size"),
        (
            "material.youngs_modulus",
            1e300,
            "material.youngs_modulus = 1e+300 MPa: must be a number at least 0.1 MPa and at",
        ),
        ("material.youngs_modulus", 1e-300, "material.youngs_modulus = 1e-300 MPa: must be a number at least 0.1 MPa and at"),
        ("material.contact_limit", HUGE, "material.contact_limit: must be a smaller number; this is a number of 401 digits"),
        ("material.contact_limit", [1.0, HUGE], "material.contact_limit: must be a smaller number; this is a number of 401"),
        ("check.torques", [HUGE], "check.torques: must be a smaller number; this is a number of 401 digits"),
        ("check.torques", [16**5000], "check.torques: must be a smaller number; this is a number of 6021 digits"),
        ("pair.name", 10**19, "pair.name = 1e+19: must be a text, in quotation marks"),
        ("drawing.title", 10**19, "drawing.title = 1e+19: must be a text, in quotation marks"),
        ("check.plane", [], 'check.plane = []: must be "strain" or "stress"'),
        ("check.convergence", {}, 'check.convergence = {}: must be "on" or "off"'),
        ("dynamics.tooth_errors", {}, 'dynamics.tooth_errors = {}: must be "on" or "off"'),
        ("pinion.\x1b[31m" + "k" * 3000, 1, "pinion.\\x1b[31mkkkk"),
    ],
)
def test_what_no_gear_can_be(folder: Path, key: str, value: Any, said: str) -> None:
    spec = copy.deepcopy(FZG)
    put(spec, tuple(key.split(".", 1)), value)
    result = run_politely("check", spec_file(folder, toml_text(spec)))
    assert result.exit_code == 2 and f": {said}" in result.stderr


LONG = "x" * 5000
LONGEST_LINE = 500
"""Characters of an error line that hold a command, a wrong value and what is permitted."""


@pytest.mark.parametrize(
    "arguments",
    [
        [LONG],
        ["new", LONG],
        ["data", LONG],
        ["data", f"{LONG}.toml"],
        ["batch", f"{LONG}.csv"],
        ["build", "spec.toml", f"--{LONG}"],
        ["build", "spec.toml", "--chord-error", LONG],
        ["build", "spec.toml", "--chord-error", "x " * 2500],
        ["build", "spec.toml", "--format", LONG],
        ["identify", "--teeth", LONG],
        ["plot", f"{LONG}.csv", "--x", "a", "--y", "b"],
        ["completion", LONG],
    ],
)
def test_what_is_wrong_is_repeated_in_part_only(folder: Path, arguments: list[str]) -> None:
    spec_file(folder, toml_text(FZG))
    result = run_politely(*arguments)
    assert result.exit_code == 2 and len(result.stderr) < LONGEST_LINE, len(result.stderr)


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("inertia", 0, "inertia"), HUGE, "train.inertia[0].inertia: must be a smaller number; this is a number of 401 digits"),
        (("mesh", 0, "base_radii"), [HUGE, 1], "train.mesh[0].base_radii: must be a smaller number; this is a number of 401"),
        (("torques", "pinion"), HUGE, "train.torques.pinion: must be a smaller number; this is a number of 401 digits"),
        (
            ("mesh", 0, "stiffness"),
            1e300,
            "stiffness = 1e+300 N/µm: must be a number at least 1e-09 N/µm and at most",
        ),
        (("shaft", 0, "length"), 1e-300, "length = 1e-300 mm: must be a number at least 0.001 mm and at most 10000000 mm"),
        (("shaft", 0, "name"), "x" * 3000, "x..."),
        (("mesh", 0, "preload"), 1e-300, "preload = 1e-300 N: must be a number, 0 or from 1e-09 to 1e+12 N"),
        (("mesh", 0, "teeth"), [1e300, 20], "must be a whole number from 1 to"),
    ],
)
def test_what_no_train_can_be(folder: Path, path: tuple[Any, ...], value: Any, said: str) -> None:
    spec = copy.deepcopy(TRAIN)
    put(spec, ("train", *path), value)
    if path[0] == "shaft":
        put(spec, ("train", "shaft", 0, "start"), "nobody")
    result = run_politely("dynamics", spec_file(folder, toml_text(spec)))
    assert result.exit_code == 2 and said in result.stderr


def test_five_hundred_lists_in_each_other(folder: Path) -> None:
    result = run_politely("data", spec_file(folder, "[gear]\nteeth = " + 500 * "[" + 500 * "]"))
    assert "lists or tables nested hundreds deep" in result.stderr


def test_a_thousand_tables_in_each_other(folder: Path) -> None:
    result = run_politely("data", spec_file(folder, "[gear]\nteeth = 20\n[x" + 1000 * ".a" + "]"))
    assert result.exit_code == 2 and "has lists or tables nested more than 50 deep" in result.stderr


@pytest.mark.parametrize(("torque", "modulus"), [(3e6, 206000.0), (TORQUE.most, 206000.0), (302.0, 0.1)])
def test_load_that_no_teeth_can_carry_is_said_with_its_torque(folder: Path, torque: float, modulus: float) -> None:
    """a = sqrt(4 F rho/(pi E*)) at the pitch point, above the depth of the teeth."""
    spec = copy.deepcopy(FZG)
    put(spec, ("load", "torque"), torque)
    put(spec, ("material", "youngs_modulus"), modulus)
    result = run_politely("check", spec_file(folder, toml_text(spec)), "--quiet")
    assert result.exit_code == 2
    width = 48.88 * (torque / 3e6 * 206000 / modulus) ** 0.5
    assert f"the contact would be {width:.4g} mm wide on teeth 10.04 mm deep" in result.stderr
    (most,) = re.findall(r"must be at most (\S+) N·m in size", result.stderr)
    assert float(most) == pytest.approx(torque * (2 * 10.04 / width) ** 2, rel=2e-3)


PHYSICAL = (
    *(("load", key) for key in ("torque", "speed", "application_factor")),
    *(("material", key) for key in ("youngs_modulus", "poisson_ratio", "density", "yield_strength", "contact_limit")),
    *(("mounting", key) for key in ("misalignment", "pinion_pitch_error", "centre_distance_change")),
    *(("dynamics", key) for key in ("pinion_inertia", "damping_ratio", "speed_to", "bearing_damping", "tooth_stiffness")),
    *(("check", key) for key in ("pinion_inner_diameter", "root_band")),
    *(("pair", key) for key in ("axial_offset", "tooth_thinning", "face_width")),
)
OF_TRAINS = (
    *(("train", "inertia", 0, key) for key in ("inertia",)),
    *(
        ("train", "shaft", 0, key)
        for key in ("torsional_stiffness", "length", "diameter", "density", "damping", "damping_ratio")
    ),
    *(("train", "mesh", 0, key) for key in ("stiffness", "variation", "damping", "damping_ratio", "backlash", "preload")),
    *(("train", key) for key in ("speed", "order")),
    *(("dynamics", key) for key in ("speed_from", "speed_to")),
)


@pytest.mark.long
@pytest.mark.parametrize("command", ["check", "dynamics"])
@settings(max_examples=60)
@given(text=physical_specs(FZG | {"dynamics": {"speeds": 20, "stiffness": "potential-energy"}}, PHYSICAL))
def test_numbers_of_any_size(folder: Path, command: str, text: str) -> None:
    run_politely(command, spec_file(folder, text), "--quiet", "-o", str(folder))


@pytest.mark.long
@settings(max_examples=150)
@given(text=physical_specs(TRAIN | {"dynamics": {"speeds": 20}}, OF_TRAINS))
def test_trains_of_any_size(folder: Path, text: str) -> None:
    run_politely("dynamics", spec_file(folder, text), "--quiet", "-o", str(folder))
