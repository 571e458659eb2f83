"""What the README and docs/papers.md show works as shown."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from click import Context
from click.testing import CliRunner
from support.commands import run
from support.paper_page import VERDICTS, Claim, Section, counted, counts, given, sections

from gearcad.cli import main

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")


def _block(language: str, containing: str) -> str:
    blocks = re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)
    (found,) = [block for block in blocks if containing in block]
    return str(found)


def test_python_example_gives_the_numbers_it_names() -> None:
    names: dict[str, object] = {}
    code = _block("python", "pair_assembly")
    exec(compile(code, "README.md", "exec"), names)
    expression, shown = re.search(r"^(pair\.\w+) +# ([\d.]+)\.\.\.$", code, re.MULTILINE).groups()
    assert str(eval(expression, names)).startswith(shown)


def test_spec_example_is_the_shipped_pair(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("readme.toml").write_text(_block("toml", "[pinion]"), encoding="utf-8")
    result = run("data", "readme.toml", "--json")
    assert '"transverse_contact_ratio": 1.363079284' in result.output


def test_commands_exist() -> None:
    context = Context(main)
    for line in _block("sh", "gearcad new pair").splitlines():
        command = line.split("#")[0].split()
        assert command[0] == "gearcad"
        found = main.get_command(context, command[1])
        options = {name for parameter in found.params for name in parameter.opts}
        assert {word for word in command[2:] if word.startswith("--")} <= options


SECTIONS = {section.title: section for section in sections()}

QUICK = [title for title in SECTIONS if "tables 2 and 3" in title or "tables 1 and 3" in title]
"""Sections whose commands take no second each, without their reports."""

DOCS = Path(__file__).parents[2] / "docs"


def wrong(section: Section, folder: Path) -> list[str]:
    """Claims that do not hold."""
    found = [(claim, given(folder, claim)) for claim in section.claims if claim.places]
    return [f"{claim.what}: {values}, on the page {claim.ours}" for claim, values in found if not claim.holds(values)]


def test_the_page_says_of_every_number_where_it_comes_from() -> None:
    assert len(SECTIONS) > 20 and len(QUICK) == 2
    for section in SECTIONS.values():
        assert bool(section.commands) == bool(section.claims)
        assert all(claim.places or not claim.ours.strip("–") for claim in section.claims)
        script = "\n".join(section.commands)
        files = {place.partition(": ")[0] for claim in section.claims for place in claim.places}
        for name in files - {"12.json"}:
            folder, _, file = name.rpartition("/")
            made = f"-o {folder}" in script if folder else file in script or f"gearcad new {Path(file).stem}" in script
            assert made, f"{section.title}: {name}"


def test_every_verdict_is_one_of_three_and_has_its_reason() -> None:
    claims = [claim for section in SECTIONS.values() for claim in section.claims]
    assert [claim for claim in claims if not claim.sound] == []
    pictures = [line for section in SECTIONS.values() for line in section.pictures]
    assert pictures and all(line.verdict == "unreadable" for line in pictures)


def test_the_page_counts_the_numbers_of_each_document() -> None:
    found = counts()
    assert len(found) == 4
    every = {verdict: sum(count[verdict] for count in found.values()) for verdict in VERDICTS}
    assert counted() == found | {"all": every}


def test_a_number_that_is_off_is_found() -> None:
    (claim, *_) = next(SECTIONS[title] for title in QUICK if "Osi" in title).claims
    shown = float(claim.ours)
    assert claim.holds([shown]) and claim.holds([shown + 0.049]) and not claim.holds([shown + 0.06])
    assert not claim.holds([None]) and not claim.holds([])
    off = Claim("", "100", "98.9", "reproduced", "", "`a.json: b`")
    assert not off.sound and not off._replace(verdict="agrees").sound
    assert off._replace(verdict="differs", why="a reason").sound and not off._replace(verdict="differs").sound


@pytest.mark.parametrize("title", QUICK)
def test_quick_sections(title: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("gearcad.jobs.dynamics._write_report", lambda _study, _head, path: path.touch())
    monkeypatch.setattr("gearcad.dynamics.options._CHART", 20)  # what is asked of these is in no chart
    for command in SECTIONS[title].commands:
        if command.startswith("gearcad "):
            line, _, file = command.partition(" > ")
            result = CliRunner().invoke(main, shlex.split(line)[1:], prog_name="gearcad")
            assert result.exit_code == 0, f"{command}: {result.output}"
            if file:
                Path(file).write_text(result.stdout, encoding="utf-8")
        else:
            subprocess.run(command, shell=True, check=True)
    assert not wrong(SECTIONS[title], tmp_path)


@pytest.mark.long
@pytest.mark.parametrize("title", [title for title, section in SECTIONS.items() if section.commands])
def test_all_sections_in_a_shell(title: str, tmp_path: Path) -> None:
    """As a reader has them: in an empty folder, with all files."""
    (tmp_path / "bin").mkdir()
    for name, module in (("gearcad", " -m gearcad"), ("python", "")):
        shim = tmp_path / "bin" / name
        shim.write_text(f'#!/bin/sh\nexec "{sys.executable}"{module} "$@"\n')
        shim.chmod(0o755)
    folder = tmp_path / "empty"
    folder.mkdir()
    environment = os.environ | {"PATH": f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}", "DOCS": str(DOCS)}
    script = "\n".join(SECTIONS[title].commands)
    result = subprocess.run(["bash", "-e", "-c", script], cwd=folder, env=environment, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert not wrong(SECTIONS[title], folder)
