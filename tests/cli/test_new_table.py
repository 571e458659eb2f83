"""Design tables as a user starts one: `gearcad new pairs`, `gearcad new gears`."""

from pathlib import Path

import pytest
from support.commands import run
from support.specs import TEMPLATES

from gearcad.designs import open_table
from gearcad.designs.reader import starters
from gearcad.drawing.sheet_template import SheetTemplate

pytestmark = pytest.mark.usefixtures("here")


@pytest.mark.parametrize("kind", ["pairs", "gears", "planetary-sets"])
def test_new_writes_a_table_and_names_the_next_command(kind: str) -> None:
    result = run("new", kind)
    assert (result.stdout, result.stderr) == (f"{kind}.csv\n", f"Next: gearcad batch {kind}.csv\n")
    assert [path.name for path in Path().iterdir()] == [f"{kind}.csv"]
    assert Path(f"{kind}.csv").read_bytes() == (TEMPLATES / f"{kind}.csv").read_bytes()
    assert all(not row.all_faults() for row in open_table(f"{kind}.csv").rows())


def test_new_writes_a_table_under_another_name_or_prints_it() -> None:
    result = run("new", "gears", "-o", "mine.txt")
    assert (result.stdout, result.stderr) == ("mine.txt\n", "Next: gearcad batch mine.txt\n")
    printed = run("new", "gears", "-o", "-")
    assert (printed.stdout, printed.stderr) == (Path("mine.txt").read_text(), "")


@pytest.mark.parametrize(("kind", "file"), [("pair", "volvo-13-44.toml"), ("gear", "spur.toml"), ("ring", "ring-22-70.toml")])
def test_one_pair_or_gear_is_a_spec_still(kind: str, file: str) -> None:
    assert run("new", kind).stdout == f"{file}\n"


def test_new_lists_tables_beside_specs() -> None:
    lines = run("new").stdout.splitlines()
    assert [line.split()[0] for line in lines] == [
        "alm-18-161",
        "case-depth",
        "ci-github",
        "ci-gitlab",
        "double-23-81",
        "drawing_title",
        "fzg-c",
        "gears",
        "ground-25-41",
        "measured",
        "pairs",
        "planetary-24-21-66",
        "planetary-alm",
        "planetary-alm-in-phase",
        "planetary-differential",
        "planetary-sets",
        "plastic-51-52",
        "printed-planetary",
        "rack",
        "ravigneaux",
        "reducer-21-43",
        "ring-22-70",
        "rings",
        "simpson",
        "spline",
        "spur",
        "train-1-stage",
        "train-2-stage",
        "train-pairs",
        "two-stage",
        "uhlir-19-23",
        "uhlir-19-23-simple",
        "volvo-13-44",
        "wire-cut",
    ]
    assert [line for line in lines if line.startswith(("gears", "pairs"))] == [
        "gears                   A design table of single gears: each row below the heading is one gear",
        "pairs                   A design table of gear pairs: each row below the heading is one pair",
    ]
    assert list(starters()) == [line.split()[0] for line in lines]


def test_new_ci_writes_the_files_of_both_servers_or_of_one() -> None:
    result = run("new", "ci")
    assert result.stdout == "ci-github.yml\nci-gitlab.yml\n"
    assert result.stderr.startswith("Next: put that of your server where its first lines say")
    both = [Path(name).read_text() for name in ("ci-github.yml", "ci-gitlab.yml")]
    assert [text.splitlines()[0].split(":")[0] for text in both] == ["# GitHub", "# GitLab"]
    assert run("new", "ci", "-o", "-").stdout == "".join(both)
    for name, text in zip(("ci-github", "ci-gitlab"), both, strict=True):
        assert run("new", name, "-o", "-").stdout == text


def test_new_ci_has_no_one_file_to_name_and_replaces_none() -> None:
    named = run("new", "ci", "-o", "ci.yml", status=2)
    message = "output = 'ci.yml': must be left out: ci is 2 files; one of them: gearcad new ci-github or gearcad new ci-gitlab"
    assert (named.exit_code, named.stderr) == (2, f"Error: {message}\n")
    Path("ci-gitlab.yml").write_text("mine")
    run("new", "ci", status=2)
    assert not Path("ci-github.yml").exists()
    assert Path("ci-gitlab.yml").read_text() == "mine"


def test_new_writes_the_template_of_drawings_for_a_company_to_change() -> None:
    result = run("new", "drawing", "-o", "company.toml")
    assert result.stderr == 'Next: keep what you change, and name it in a spec: [drawing] template = "company.toml"\n'
    assert SheetTemplate.of("company.toml") == SheetTemplate.of(None)


def test_new_does_not_overwrite_a_table() -> None:
    Path("pairs.csv").write_text("precious")
    assert run("new", "pairs", status=2).stderr == (
        "Error: output = 'pairs.csv': exists; give another name, or --force to replace it\n"
    )
    assert Path("pairs.csv").read_text() == "precious"
