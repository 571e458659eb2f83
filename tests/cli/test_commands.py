"""The commands as a user meets them: starters, data sheet, JSON, options, wrong input."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from support.commands import invoke, read_json, run

import gearcad
from gearcad.designs import read_spec
from gearcad.designs.reader import starters

VOLVO = "volvo-13-44"
PLANETARY = ["planetary-24-21-66", "planetary-alm", "planetary-alm-in-phase", "planetary-differential", "printed-planetary"]
PAIRS = [
    "ground-25-41",
    "alm-18-161",
    "case-depth",
    "double-23-81",
    "fzg-c",
    "plastic-51-52",
    "reducer-21-43",
    "ring-22-70",
    "uhlir-19-23",
    "uhlir-19-23-simple",
    VOLVO,
]
GEARBOXES = ["ravigneaux", "simpson"]
STARTERS = [*PAIRS, *PLANETARY, "rack", "spline", "spur", "wire-cut"]
TRAINS = ["train-1-stage", "train-2-stage", "train-pairs", "two-stage"]
TABLES = ["gears", "pairs", "planetary-sets", "rings"]
NAMED = sorted([*STARTERS, *TRAINS, *TABLES, *GEARBOXES, "drawing_title", "measured"])
LISTED = sorted([*NAMED, "ci-github", "ci-gitlab"])

RATIO = 1e-9
"""Absolute, for contact ratios of about 1: what the references promise."""


def starter(folder: Path, kind: str = VOLVO, *changes: tuple[str, str]) -> Path:
    """A starter spec with texts replaced, each of which must be there."""
    text = run("new", kind, "-o", "-").stdout
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / f"{kind}.toml"
    path.write_text(text, encoding="utf-8")
    return path


pytestmark = pytest.mark.usefixtures("here")


# ---------------------------------------------------------------------- new


def test_new_without_a_kind_lists_the_starters() -> None:
    lines = run("new").stdout.splitlines()
    assert [line.split()[0] for line in lines] == LISTED
    assert all(len(line.split()) > 5 for line in lines)


@pytest.mark.parametrize(
    ("kind", "name"), [("pair", VOLVO), ("volvo", VOLVO), ("gear", "spur"), ("spur", "spur"), ("alm", "alm-18-161")]
)
def test_new_writes_a_spec_that_reads_and_names_the_next_command(kind: str, name: str) -> None:
    result = run("new", kind)
    assert result.stdout == f"{name}.toml\n"
    assert result.stderr == f"Next: gearcad data {name}.toml\n"
    assert read_spec(Path(f"{name}.toml")).name == name
    assert [path.name for path in Path().iterdir()] == [f"{name}.toml"]


def test_new_refuses_to_overwrite_unless_forced() -> None:
    Path("mine.toml").write_text("precious")
    result = run("new", "spur", "-o", "mine.toml", status=2)
    assert result.stderr == "Error: output = 'mine.toml': exists; give another name, or --force to replace it\n"
    assert Path("mine.toml").read_text() == "precious"
    run("new", "spur", "-o", "mine.toml", "--force")
    assert read_spec(Path("mine.toml")).name == "spur"


def test_new_refuses_what_it_does_not_have() -> None:
    result = run("new", "bevel", status=2)
    assert (
        result.stderr == "Error: kind = 'bevel': must be gear, pair, ring, planetary, uhlir, or one that `gearcad new` lists\n"
    )
    result = run("new", "planetry-alm", status=2)
    assert result.stderr.startswith("Error: kind = 'planetry-alm': must be a starter; did you mean planetary-alm or ")


@pytest.mark.parametrize("output", ["blocked/x.toml", "folder"])
def test_new_to_an_impossible_place_is_one_line(output: str) -> None:
    Path("blocked").write_text("a file, not a folder")
    Path("folder").mkdir()
    result = run("new", "spur", "-o", output, status=2)
    assert result.stderr.startswith("Error: output = ") and result.stderr.count("\n") == 1
    assert sorted(path.name for path in Path().rglob("*")) == ["blocked", "folder"]


def test_starters_are_found_in_an_installed_package_too(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import gearcad.core.runtime

    package = tmp_path / "site" / "gearcad"
    (package / "templates").mkdir(parents=True)
    (package / "templates" / "only.toml").write_text("# The only one.\n")
    monkeypatch.setattr(gearcad.core.runtime, "PACKAGE", package)
    assert starters() == {"only": "The only one"}


# ---------------------------------------------------------------------- data


def test_data_json_holds_the_reference_values(tmp_path: Path) -> None:
    """Chalmers/Volvo thesis, table 2, verified to all digits: contact ratios 1.363079284, 1.335147988 above the form circle."""
    data = json.loads(run("data", str(starter(tmp_path)), "--json").stdout)
    assert (data["kind"], data["name"], data["gearcad"]) == ("pair", VOLVO, gearcad.__version__)
    pair = data["pair"]
    assert pair["transverse_contact_ratio"] == pytest.approx(1.363079284108014, abs=RATIO)
    assert pair["usable_contact_ratio"] == pytest.approx(1.3351479875350558, abs=RATIO)
    assert pair["overlap_ratio"] == pytest.approx(0.9026021358900956, abs=RATIO)
    assert pair["active_root_diameters"][0] == pytest.approx(34.138822072090015, abs=RATIO)
    assert data["pinion"]["form_diameter"] == pytest.approx(34.17844815853416, abs=RATIO)
    assert data["wheel"]["tip_diameter"] == pytest.approx(127.65647335260623, abs=RATIO)
    assert data["wheel"]["helix_angle"] == -28.0
    assert data["material"]["youngs_modulus"] == 205000.0
    assert data["load"]["torque"] == 220.0


def test_alm_starter_has_the_contact_ratio_of_its_thesis(tmp_path: Path) -> None:
    """Alm thesis, first pair: 1.573 printed, 1.573509033 with k on both gears."""
    pair = json.loads(run("data", str(starter(tmp_path, "alm")), "--json").stdout)["pair"]
    assert pair["transverse_contact_ratio"] == pytest.approx(1.573509033274298, abs=RATIO)


@pytest.mark.parametrize("kind", STARTERS)
def test_data_runs_on_every_starter_and_json_is_strict(kind: str, tmp_path: Path) -> None:
    path = starter(tmp_path, kind)
    assert kind in run("data", str(path)).stdout

    def refuse(constant: str) -> None:
        raise AssertionError(constant)

    json.loads(run("data", str(path), "--json").stdout, parse_constant=refuse)


def test_data_warns_of_fillet_interference_with_both_diameters(tmp_path: Path) -> None:
    sheet = run("data", str(starter(tmp_path))).stdout
    warnings = sheet[sheet.index("\nWarnings") :]
    assert "fillet interference" in warnings
    assert "34.1388 mm" in warnings and "34.1784 mm" in warnings


@pytest.mark.parametrize(
    ("changes", "warning"),
    [
        ([("teeth = 30", "teeth = 12")], "undercut: the involute begins at diameter"),
        ([("teeth = 30", "teeth = 20"), ("profile_shift = 0.0", "profile_shift = 1.1")], "thin tip: normal thickness"),
    ],
)
def test_data_warns_of_what_a_gear_suffers_from(changes: list[tuple[str, str]], warning: str, tmp_path: Path) -> None:
    bare = [("body.bore = 20.0", ""), ("body.keyway_width = 6.0", ""), ("body.keyway_depth = 2.8", "")]
    sheet = run("data", str(starter(tmp_path, "spur", *bare, *changes))).stdout
    assert warning in sheet[sheet.index("\nWarnings") :]


def test_data_warns_of_zero_backlash(tmp_path: Path) -> None:
    assert "zero backlash" in run("data", str(starter(tmp_path, "alm"))).stdout


def test_a_date_that_is_none_is_told_before_any_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    told = "Error: SOURCE_DATE_EPOCH = 'yesterday': must be a whole number of seconds since 1970"
    assert run("check", "nowhere.toml", status=2).stderr.startswith(told)


# ---------------------------------------------------------------------- a table for a spec, and the other way round


@pytest.mark.parametrize("command", ["data", "build", "check", "stiffness", "dynamics", "modify"])
def test_a_table_is_sent_to_batch(command: str, tmp_path: Path) -> None:
    run("new", "pairs")
    Path("gears.xlsx").write_bytes(b"PK\x03\x04\xff")
    for table in ("pairs.csv", "gears.xlsx"):
        told = f"Error: {table}: is a design table, not the spec of one design; use `gearcad batch {table}`\n"
        assert run(command, table, status=2).stderr == told


def test_a_spec_is_sent_from_batch_to_build(tmp_path: Path) -> None:
    run("new", "spur")
    told = "Error: spur.toml: is the spec of one design, no design table; use `gearcad build spur.toml`\n"
    assert run("batch", "spur.toml", status=2).stderr == told
    assert "cannot be read" in run("batch", "nowhere.toml", status=2).stderr


# ---------------------------------------------------------------------- build, without waiting for solids


def test_build_refuses_unknown_formats_before_anything_is_written(tmp_path: Path) -> None:
    result = run("build", str(starter(tmp_path)), "--format", "step,iges", status=2)
    assert result.stderr.startswith("Error: format = 'iges': must be one of 'step', 'stl', ")
    assert not Path("output").exists()


@pytest.mark.parametrize(
    ("kind", "options", "message"),
    [
        ("spur", ["--bracket"], "bracket = True: needs a pair"),
        (VOLVO, ["--bracket", "--format", "stl"], "bracket = True: needs the format step"),
        (VOLVO, ["--circles"], "circles = True: needs the format dxf"),
        (VOLVO, ["--chord-error", "0"], "chord_error = 0 mm: must be a number above 0 mm"),
    ],
)
def test_build_refuses_options_that_do_not_fit(kind: str, options: list[str], message: str, tmp_path: Path) -> None:
    result = run("build", str(starter(tmp_path, kind)), *options, status=2)
    assert result.stderr.startswith(f"Error: {message}") and result.stderr.count("\n") == 1
    assert not Path("output").exists()


def test_build_finds_an_unwritable_output_before_any_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder below a regular file: that fails for root as well."""
    import gearcad.designs.design

    def work(self: object) -> None:
        raise AssertionError("worked before it looked")

    monkeypatch.setattr(gearcad.designs.design.Design, "to_dict", work)
    spec = starter(tmp_path)
    Path("blocked").write_text("a file")
    for output in ("blocked", "blocked/deep/er"):
        result = run("build", str(spec), "-o", output, status=2)
        assert result.stderr.startswith(f"Error: output = '{output}': cannot be written (")
        assert result.stderr.endswith("give a folder you may write to\n")
    assert sorted(path.name for path in Path().rglob("*")) == ["blocked", spec.name]


# ---------------------------------------------------------------------- wrong input

WRONG = {
    "half a tooth": ([("teeth = 13", "teeth = 2.5")], "pinion.teeth = 2.5: must be a whole number from 3 to 2000"),
    "negative width": (
        [("= 18.3", "= -18.3")],
        "pinion.face_width = -18.3 mm: must be a number above 0 mm and at most 10000 mm",
    ),
    "helix 95": ([("= 28.0", "= 95")], "pair.helix_angle = 95 deg: must be a number at least -75 deg and at most 75 deg"),
    "centre distance too small": (
        [("centre_distance = 80.0", "centre_distance = 74"), ("profile_shift = 0.107", 'profile_shift = "auto"')],
        "pair.centre_distance = 74 mm: must be above 74.60",
    ),
    "teeth overlap": (
        [("centre_distance = 80.0", "centre_distance = 79")],
        "pair.centre_distance = 79 mm: must be at least 79.646",
    ),
    "tool tip too round": (
        [("tooth_thinning = 0.08", ""), ('tooth_allowance = "25"', "")],
        "pinion.rack.root_radius = 0.48: must be at most 0.4719 (full radius) for dedendum 1.25, pressure angle 20 deg",
    ),
    "pointed teeth": (
        [("centre_distance = 80.0", ""), ("profile_shift = 0.107", "profile_shift = 1.4\ntip_alteration = 0.3")],
        "pinion.tip_diameter = ",
    ),
    "bore in the root": ([("body.bore = 16.0", "body.bore = 31.2")], "pinion.body.bore = 31.2 mm: must be at most 30.5"),
    "misspelt key": ([("face_width = 18.3", "face_widht = 18.3")], "pinion.face_widht: unknown key; did you mean face_width?"),
    "missing key": ([("teeth = 44", "")], "wheel.teeth is missing: must be a whole number from 3 to 2000"),
    "unknown rack": ([("rack.root_radius = 0.48", 'rack = "ISO53_E"')], "pinion.rack = 'ISO53_E': must be one of 'ISO53_A', "),
    "bad name": ([('"volvo-13-44"', '"../elsewhere"')], "pair.name = '../elsewhere': must be a plain file name"),
}


@pytest.mark.parametrize("command", ["data", "build"])
@pytest.mark.parametrize("mistake", WRONG)
def test_wrong_input_is_one_line_and_leaves_nothing(mistake: str, command: str, tmp_path: Path) -> None:
    changes, message = WRONG[mistake]
    spec = starter(tmp_path, VOLVO, *changes)
    result = run(command, str(spec), status=2)
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1
    assert result.stderr.startswith(f"Error: {spec} line ")
    assert message in result.stderr
    assert list(Path().rglob("*")) == [Path(spec.name)]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["build", "x.toml", "--chord-error", "a"], "Invalid value for '--chord-error': 'a' is not a valid float"),
        (["bild", "x.toml"], "No such command 'bild'"),
        (["data"], "Missing argument 'SPEC'"),
    ],
)
def test_wrong_usage_is_one_line(arguments: list[str], message: str) -> None:
    result = run(*arguments, status=2)
    assert result.stderr.startswith(f"Error: {message}") and result.stderr.count("\n") == 1


def test_pointed_teeth_say_where_the_point_is(tmp_path: Path) -> None:
    changes, _ = WRONG["pointed teeth"]
    message = run("data", str(starter(tmp_path, VOLVO, *changes)), status=2).stderr
    assert "mm (derived): must be at most " in message and "pointed" in message


@pytest.mark.parametrize("command", ["data", "build"])
def test_missing_file_is_one_line(command: str) -> None:
    result = run(command, "nowhere.toml", status=2)
    assert result.stderr.startswith("Error: nowhere.toml: cannot be read (No such file or directory)")
    assert result.stderr.count("\n") == 1


def test_fault_of_ours_is_one_line_with_status_1_and_a_traceback_only_on_demand(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import gearcad.designs.reader

    def fail(path: Path) -> None:
        raise ZeroDivisionError("two\nlines")

    monkeypatch.setattr(gearcad.designs.reader, "read_spec", fail)
    result = run("data", "x.toml", status=1)
    assert result.stderr.startswith("Error: unexpected ZeroDivisionError: two lines (")
    assert "--debug" in result.stderr and result.stderr.count("\n") == 1
    for arguments in (["--debug", "data", "x.toml"], ["data", "x.toml", "--debug"]):
        assert isinstance(invoke(*arguments).exception, ZeroDivisionError)


# ---------------------------------------------------------------------- as a process


def process(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "gearcad", *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        timeout=60,
    )


def test_sheet_has_no_escapes_when_piped_and_cuts_no_number(tmp_path: Path) -> None:
    spec = str(starter(tmp_path))
    narrow, wide = (process("data", spec, COLUMNS=width, NO_COLOR="", TERM="xterm").stdout for width in ("80", "120"))
    for sheet in (narrow, wide):
        assert "\x1b" not in sheet
        assert "127.6565" in sheet and "1.3631" in sheet
        assert all(line == line.rstrip() for line in sheet.splitlines())
    table = narrow[: narrow.index("\nWarnings")].splitlines()
    assert max(map(len, table)) <= 80
    assert "ISO 21771:2007" in wide and "Annex A" in wide


def test_old_terminal_gets_the_numbers_all_the_same(tmp_path: Path) -> None:
    done = process("data", str(starter(tmp_path)), PYTHONIOENCODING="ascii")
    assert done.returncode == 0 and "127.6565" in done.stdout


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full (Linux)")
def test_full_disk_behind_stdout_is_one_line(tmp_path: Path) -> None:
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "gearcad", "data", str(starter(tmp_path)), "--json"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (1, "Error: No space left on device\n")


def test_wrong_input_as_a_process(tmp_path: Path) -> None:
    done = process("data", str(starter(tmp_path, VOLVO, ("teeth = 13", "teeth = 2.5"))))
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)


def test_version_and_help() -> None:
    assert process("--version").stdout == f"gearcad, version {gearcad.__version__}\n"
    help_text = process("--help").stdout
    assert help_text.index("  new ") < help_text.index("  data ") < help_text.index("  build ")
    assert "gearcad new pair" in help_text


@pytest.mark.parametrize("home", ["/dev/null", pytest.param("locked", marks=pytest.mark.long)])
def test_no_home_folder_is_no_matter(home: str, tmp_path: Path) -> None:
    """Libraries that keep caches there, matplotlib and ezdxf, do without, and say nothing."""
    starter(tmp_path, "spur")
    (tmp_path / "locked" / ".cache" / "ezdxf" / "font_manager_cache.json").mkdir(parents=True)
    (tmp_path / "locked" / ".config").write_text("")
    Path("results.csv").write_text("name,status,gear.teeth,gear.tip_diameter\na,ok,20,44\nb,ok,21,46\n")
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("XDG_", "MPL"))}
    for command in ("build spur.toml --format dxf --quiet", "plot results.csv --x gear.teeth --y gear.tip_diameter"):
        whole = [sys.executable, "-m", "gearcad", *command.split()]
        done = subprocess.run(whole, env=environment | {"HOME": home}, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")


OLD_LOCALE = {"PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "LC_ALL": "C"}


def test_name_that_the_locale_cannot_write_is_one_line(tmp_path: Path) -> None:
    starter(tmp_path, "spur", ('name = "spur"', 'name = "rad-ä"'))
    whole = [sys.executable, "-m", "gearcad", "build", "spur.toml", "--format", "csv", "--quiet"]
    done = subprocess.run(whole, env=os.environ | OLD_LOCALE, capture_output=True, encoding="utf-8")
    reason = "cannot be written (the locale has no letter '\\xe4'); give another name, or set LC_ALL=C.UTF-8"
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"Error: output = 'output/rad-ä': {reason}\n")
    assert not Path("output").exists()
    again = subprocess.run([*whole, "-o", "out"], env=os.environ | OLD_LOCALE, capture_output=True, encoding="utf-8")
    assert (again.returncode, again.stderr) == (0, "")
    assert read_json("out/data.json")["name"] == "rad-ä"


def test_control_characters_never_reach_the_terminal(tmp_path: Path) -> None:
    """In the name of a file, of a key, or of an option."""
    name = "evil\x1b[2Jname.toml"
    Path(name).write_text('[gear]\n"\\u001b[2J" = 1\n')
    for arguments in (
        ["data", name],
        ["batch", name],
        ["data", "spur", "--\x1b[2J"],
        ["plot", name, "--x", "\x1b", "--y", "b"],
    ):
        result = run(*arguments, status=2)
        assert result.stderr.startswith("Error: ") and result.stderr.rstrip("\n").isprintable()


@pytest.mark.parametrize("closed", ["stdout", "stderr", "stdin"])
def test_closed_standard_streams_are_no_fault(closed: str, tmp_path: Path) -> None:
    """As `>&-` does: nothing is shown there, and files do not get what was meant for the screen."""
    (tmp_path / "it.toml").write_text("[gear]\nteeth = 20\nnormal_module = 2\nface_width = 5\n")
    number = ("stdin", "stdout", "stderr").index(closed)
    closes = f"import os, sys; os.close({number}); os.execv(sys.executable, sys.argv[1:])"
    done = subprocess.run(
        [sys.executable, "-c", closes, sys.executable, *"-m gearcad build it.toml -o out --format csv".split()],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert (done.returncode, "unexpected" in done.stderr) == (0, False), done.stderr
    assert sorted(each.name for each in (tmp_path / "out").iterdir()) == ["data.json", "gear.csv"]


def test_missing_package_is_named_with_what_installs_it(tmp_path: Path) -> None:
    """In a process of its own: here other tests may have imported it."""
    without = "import sys; sys.modules['ezdxf'] = None; from gearcad.cli import main; main()"
    (tmp_path / "it.toml").write_text("[gear]\nteeth = 20\nnormal_module = 2\nface_width = 5\n")
    command = [sys.executable, "-c", without, "build", "it.toml", "-o", "out", "--format", "dxf"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "Error: the package ezdxf is not installed" in done.stderr, done.stderr
    assert "pip install ezdxf" in done.stderr and not (tmp_path / "out").exists()


def test_identify_survives_fits_that_are_far_off(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One of the fits had a thinning beyond any float."""
    monkeypatch.chdir(tmp_path)
    readings = "--teeth 24 --over-pins 4.5:0.004 --tip-diameter 66.58 --span 3:19.77 --span 4:27.16 --centre-distance 89.5"
    done = invoke("identify", *readings.split(), *"--mate-teeth 47 --mate-tip-diameter 122.5".split())
    assert "unexpected" not in done.output
    done = invoke("identify", *readings.split(), *"--mate-teeth 47 --mate-tip-diameter 122.5 --helix-angle 0".split())
    assert "unexpected" not in done.output and done.exit_code in (0, 2), done.output


def test_time_where_a_text_is_expected_is_a_wrong_value(tmp_path: Path) -> None:
    spec = "[gear]\nteeth = 20\nnormal_module = 2\nface_width = 5\n[mesh]\nrefined_teeth = 12:00:00\n"
    (tmp_path / "it.toml").write_text(spec)
    done = invoke("mesh", str(tmp_path / "it.toml"))
    assert done.exit_code == 2 and "refined_teeth" in done.stderr and "unexpected" not in done.stderr
