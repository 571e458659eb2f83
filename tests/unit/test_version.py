"""The version is that of the tag: what stands in for it where there is none stands in two files."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import gearcad

ROOT = Path(__file__).parents[2]


def test_a_checkout_that_was_never_installed_has_the_version_of_a_build_without_a_tag(tmp_path: Path) -> None:
    (tmp_path / "gearcad").mkdir()
    (tmp_path / "gearcad" / "__init__.py").touch()
    (tmp_path / "gearcad" / "version.py").write_bytes((ROOT / "gearcad" / "version.py").read_bytes())
    shown = [sys.executable, "-c", "from gearcad.version import __version__; print(__version__)"]
    done = subprocess.run(shown, cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=True)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert done.stdout.strip() == project["tool"]["hatch"]["version"]["fallback-version"]


def test_the_version_is_that_which_was_written() -> None:
    written = ROOT / "gearcad" / "_version.py"
    names: dict[str, str] = {}
    exec(written.read_text() if written.exists() else '__version__ = "0.2.0.dev0"', names)
    assert gearcad.__version__ == names["__version__"]
