"""What the README shows works as shown."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click import Context
from click.testing import CliRunner

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
    result = CliRunner().invoke(main, ["data", "readme.toml", "--json"])
    assert result.exit_code == 0, result.output
    assert '"transverse_contact_ratio": 1.363079284' in result.output


def test_commands_exist() -> None:
    context = Context(main)
    for line in _block("sh", "gearcad new pair").splitlines():
        command = line.split("#")[0].split()
        assert command[0] == "gearcad"
        found = main.get_command(context, command[1])
        options = {name for parameter in found.params for name in parameter.opts}
        assert {word for word in command[2:] if word.startswith("--")} <= options
