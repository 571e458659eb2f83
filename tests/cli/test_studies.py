"""A parameter study as a user makes one: study, batch, plot; and what is said on the way."""

import csv
from pathlib import Path

import pytest
from click.testing import CliRunner
from support.commands import run

from gearcad.cli import main

VOLVO = "volvo-13-44"
SPEC = f"{VOLVO}.toml"

RATIO = 1e-9
"""Absolute, for contact ratios of about 1: what the references promise."""


def refusal(*arguments: str) -> str:
    """The one line that refuses the command, which writes nothing."""
    before = sorted(Path().rglob("*"))
    result = run(*arguments, status=2)
    assert (result.stdout, result.stderr.count("\n")) == ("", 1)
    assert sorted(Path().rglob("*")) == before
    return result.stderr.removeprefix("Error: ").rstrip("\n")


@pytest.fixture(autouse=True)
def _in_a_folder_with_a_spec(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run("new", "volvo")


# ---------------------------------------------------------------------- three commands


def test_a_study_is_three_commands() -> None:
    """The reference pair (Chalmers/Volvo thesis) is one of the rows, with its contact ratio, verified to all digits."""
    made = run("study", SPEC, "--vary", "centre_distance=79,80,81", "--vary", "pinion.profile_shift=0,0.107", "-o", "study.csv")
    first, then = made.stderr.splitlines()
    assert made.stdout == "study.csv\n"
    assert first.startswith(
        "2 of 6 rows make no gear. The first: study.csv row 7 column D (volvo-13-44-1): pair.centre_distance = 79 mm"
    )
    assert then == "Next: gearcad batch study.csv --keep-going    # builds the others"
    run("batch", "study.csv", "--do", "data", "--keep-going", "-j", "1", status=1)
    with Path("output/study/results.csv").open(newline="", encoding="utf-8") as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    assert float(rows[f"{VOLVO}-4"]["pair.transverse_contact_ratio"]) == pytest.approx(1.363079284108014, abs=RATIO)
    arguments = ("--x", "pinion.profile_shift", "--y", "transverse_contact_ratio", "--colour", "centre_distance")
    drawn = run("plot", "output/study/results.csv", *arguments)
    picture = Path("output/study/results-pair.transverse_contact_ratio-pinion.profile_shift.png")
    assert (drawn.stdout, drawn.stderr) == (f"{picture}\n", "2 rows are left out: not ok, or without one of these values\n")
    assert picture.read_bytes().startswith(b"\x89PNG")


# ---------------------------------------------------------------------- study


def test_study_writes_a_table_named_after_the_design_and_names_the_next_command() -> None:
    result = run("study", SPEC, "--vary", "pinion.profile_shift=0:0.1:3")
    assert (result.stdout, result.stderr) == (f"{VOLVO}-study.csv\n", f"Next: gearcad batch {VOLVO}-study.csv\n")
    assert sorted(path.name for path in Path().iterdir()) == [f"{VOLVO}-study.csv", SPEC]


def test_study_refuses_to_overwrite_unless_forced() -> None:
    Path("mine.csv").write_text("precious")
    arguments = ("study", SPEC, "--vary", "helix_angle=28", "-o", "mine.csv")
    assert refusal(*arguments) == "output = 'mine.csv': exists; give another name, or --force to replace it"
    assert Path("mine.csv").read_text() == "precious"
    run(*arguments, "--force")
    assert Path("mine.csv").read_text().startswith("# A study of volvo-13-44")


def test_study_says_if_no_row_makes_a_gear() -> None:
    result = run("study", SPEC, "--vary", "centre_distance=70,71")
    assert result.stderr.startswith("2 of 2 rows make no gear. The first: ") and result.stderr.count("\n") == 1


def test_study_does_not_try_the_rows_of_a_large_table(monkeypatch: pytest.MonkeyPatch) -> None:
    import gearcad.batch.study

    def work(path: Path) -> None:
        raise AssertionError("tried them")

    monkeypatch.setattr(gearcad.batch.study, "check_table", work)
    result = run("study", SPEC, "--vary", "centre_distance=70:71:2001", "-o", "large.csv")
    assert result.stderr == "Next: gearcad batch large.csv\n"
    with pytest.raises(AssertionError, match="tried them"):
        CliRunner().invoke(main, ["--debug", "study", SPEC, "--vary", "centre_distance=70:71:2000"], catch_exceptions=False)


@pytest.mark.parametrize(("method", "words"), [("lhs", "a Latin hypercube"), ("SOBOL", "a scrambled Sobol sequence")])
def test_study_draws_a_sample(method: str, words: str) -> None:
    result = run("study", SPEC, "--vary", "pinion.profile_shift=0:0.2", "--sample", method, "--n", "16", "-o", "a.csv")
    assert result.stderr == "Next: gearcad batch a.csv\n"
    lines = Path("a.csv").read_text().splitlines()
    assert lines[1] == f"# Drawn as {words} (seed 0) from:"
    assert len([line for line in lines if line.startswith(VOLVO)]) == 16
    run("study", SPEC, "--vary", "pinion.profile_shift=0:0.2", "--sample", method, "--n", "16", "--seed", "0", "-o", "b.csv")
    assert Path("b.csv").read_text() == Path("a.csv").read_text().replace("a.csv", "b.csv")


def test_study_advises_on_the_size_of_a_sobol_sample() -> None:
    result = run("study", SPEC, "--vary", "pinion.profile_shift=0:0.2", "--sample", "sobol", "--n", "10", "-o", "a.csv")
    note, then = result.stderr.splitlines()
    assert note == "Note: Sobol points are spread most evenly if --n is a power of 2, such as 128 or 256"
    assert then == "Next: gearcad batch a.csv"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "vary = '': must be given, such as helix_angle=10,20,28 or pinion.profile_shift=-0.2:0.6:9"),
        (["--n", "3"], "n = 3: needs --sample lhs or --sample sobol; else every combination is a row"),
        (["--seed", "0"], "seed = 0: needs --sample lhs or --sample sobol; else every combination is a row"),
        (["--sample", "lhs"], "sample = 'lhs': needs --n, how many rows to draw"),
        (["--sample", "grid", "--n", "3"], "sample = 'grid': must be one of 'lhs', 'sobol'"),
        (["--sample", "sobol", "--n", "0"], "n = 0: must be a whole number from 1 to 1000000"),
        (["--vary", "teeth=20"], "vary = 'teeth=20': unknown column; did you mean pinion.teeth or wheel.teeth?"),
        (["--vary", "helix_angle=28", "-o", "a.xlsx"], "output = 'a.xlsx': must end in .csv"),
        (["--vary", "helix_angle=28", "-o", "."], "output = '.': is a folder; give the name of a file"),
    ],
)
def test_study_refuses_what_does_not_fit_in_one_line(options: list[str], message: str) -> None:
    assert refusal("study", SPEC, *options) == message


def test_study_of_a_missing_spec_or_to_an_impossible_place_is_one_line() -> None:
    assert refusal("study", "nowhere.toml", "--vary", "helix_angle=28").startswith("nowhere.toml: cannot be read (")
    assert refusal("study", SPEC, "--vary", "helix_angle=28", "-o", f"{SPEC}/a.csv").startswith(f"output = '{SPEC}': cannot be")


# ---------------------------------------------------------------------- plot

RESULTS = """\
name,status,pair.helix_angle,pinion.profile_shift,wheel.profile_shift
a,ok,26.0,0.0,1.0
b,ok,26.0,1.0,2.0
c,ok,28.0,0.0,3.0
d,ok,28.0,1.0,4.0
"""


@pytest.fixture
def results() -> str:
    Path("results.csv").write_text(RESULTS)
    return "results.csv"


@pytest.mark.parametrize("spelling", ["--colour", "--color"])
@pytest.mark.parametrize("suffix", ["svg", "pdf"])
def test_plot_writes_where_and_what_it_is_told(spelling: str, suffix: str, results: str) -> None:
    name = f"deep/er/picture.{suffix}"
    arguments = ("--x", "pinion.profile_shift", "--y", "helix_angle", spelling, "wheel.profile_shift", "-o", name)
    assert run("plot", results, *arguments).output == f"{name}\n"
    assert [path.name for path in Path("deep/er").iterdir()] == [f"picture.{suffix}"]


def test_plot_draws_contours_anew_each_time(results: str) -> None:
    arguments = ("plot", results, "--x", "pinion.profile_shift", "--y", "helix_angle", "--contour", "wheel.profile_shift")
    picture = Path("results-pair.helix_angle-pinion.profile_shift.png")
    assert run(*arguments).output == f"{picture}\n"
    before = picture.read_bytes()
    Path(results).write_text(RESULTS.replace("4.0", "5.0"))
    run(*arguments)
    assert picture.read_bytes() != before


def test_plot_reads_a_decimal_comma(results: str) -> None:
    arguments = ("--x", "pinion.profile_shift", "--y", "helix_angle", "--colour", "name")
    run("plot", results, *arguments, "-o", "point.svg")
    Path(results).write_text(RESULTS.replace(",", ";").replace(".0", ",0"), encoding="utf-8-sig")
    run("plot", results, *arguments, "-o", "comma.svg")
    assert Path("comma.svg").read_bytes() == Path("point.svg").read_bytes()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--x", "helix_angle"], "Missing option '--y'."),
        (
            ["--x", "helix_angle", "--y", "profile_shift"],
            "y = 'profile_shift': could be pinion.profile_shift or wheel.profile_shift; write the one in full",
        ),
        (
            ["--x", "helix_angle", "--y", "pair.helix_angel"],
            "y = 'pair.helix_angel': no such column; did you mean pair.helix_angle?",
        ),
        (
            ["--x", "helix_angle", "--y", "name"],
            "results.csv row 2: name = 'a': must be a number to be drawn; take another column",
        ),
        (["--x", "helix_angle", "--y", "helix_angle", "-o", "a.jpg"], "output = 'a.jpg': must end in .png or .svg or .pdf"),
        (
            ["--x", "helix_angle", "--y", "helix_angle", "--contour", "wheel.profile_shift"],
            "contour = 'wheel.profile_shift': has two values at pair.helix_angle = 26, pair.helix_angle = 26: "
            "the rows differ in more; take colour instead",
        ),
    ],
)
def test_plot_refuses_what_it_cannot_draw_in_one_line(options: list[str], message: str, results: str) -> None:
    assert refusal("plot", results, *options) == message


@pytest.mark.parametrize("file", ["nowhere.csv", ".", SPEC])
def test_plot_of_another_file_is_one_line(file: str) -> None:
    message = refusal("plot", file, "--x", "helix_angle", "--y", "helix_angle")
    assert message.startswith(f"{file}: ") and message.endswith("; give the results.csv of `gearcad batch`")
