"""Commands as a user gives them, in this process; specs in the current folder, and documents that are read again."""

import json
from pathlib import Path
from typing import Any

from click.testing import CliRunner, Result

from gearcad.cli import main


def invoke(*arguments: object) -> Result:
    """The result of `gearcad ARGUMENTS`, whatever its exit status."""
    return CliRunner().invoke(main, [*map(str, arguments)], prog_name="gearcad")


def run(*arguments: object, status: int = 0) -> Result:
    """The result of `gearcad ARGUMENTS`, which must end with this exit status and without a traceback."""
    result = invoke(*arguments)
    assert result.exit_code == status, result.output
    assert "Traceback" not in result.output
    return result


def spec_file(text: str, name: str = "pair.toml") -> str:
    """The name of a file of the current folder, which holds this text of a spec from here on."""
    Path(name).write_text(text, encoding="utf-8")
    return name


def read_json(path: str | Path) -> Any:
    """The document of a file."""
    return json.loads(Path(path).read_text(encoding="utf-8"))
