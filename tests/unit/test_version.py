"""The version is that of the tag: what stands in for it where there is none stands in two files."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import gearcad

ROOT = Path(__file__).parents[2]
FALLBACK = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["version"]["fallback-version"]


def test_a_checkout_that_was_never_installed_has_the_version_of_a_build_without_a_tag(tmp_path: Path) -> None:
    (tmp_path / "gearcad").mkdir()
    (tmp_path / "gearcad" / "__init__.py").touch()
    (tmp_path / "gearcad" / "version.py").write_bytes((ROOT / "gearcad" / "version.py").read_bytes())
    shown = [sys.executable, "-c", "from gearcad.version import __version__; print(__version__)"]
    done = subprocess.run(shown, cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == FALLBACK


def test_the_version_is_that_which_was_written() -> None:
    written = ROOT / "gearcad" / "_version.py"
    names: dict[str, str] = {}
    exec(written.read_text() if written.exists() else f'__version__ = "{FALLBACK}"', names)
    assert gearcad.__version__ == names["__version__"]


def test_a_release_stands_in_the_changelog_and_is_what_is_cited() -> None:
    """A version without "dev" is that of a tag; before the first release the one to come is cited."""
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    released = re.findall(r"^## \[(\d+\.\d+\.\d+)\] - \d{4}-\d\d-\d\d$", changes, re.MULTILINE)
    (cited,) = re.findall(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)
    assert cited == (released[0] if released else FALLBACK.partition(".dev")[0])
    assert "dev" in gearcad.__version__ or released[:1] == [gearcad.__version__]
