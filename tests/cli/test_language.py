"""`gearcad --language`: German messages on the screen; documents, files and drawings are those of English."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.core.runtime import templates

ENGLISH = re.compile(r"\b(the|of|and|is|must|with|which|from|not|for)\b")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with two starters, in which commands run."""
    for name in ("reducer-21-43.toml", "spur.toml"):
        shutil.copy(templates() / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1")
    return tmp_path


def _run(*words: str) -> Result:
    return CliRunner().invoke(main, words)


def test_data_is_german(folder: Path) -> None:
    shown = _run("--language", "de", "data", "reducer-21-43.toml").stdout
    assert "reducer-21-43: geradverzahntes Radpaar, z = 21 / 43" in shown
    assert re.search(r"^  Normalmodul +m_n +mm +3,0000 +3,0000$", shown, re.MULTILINE)
    assert not ENGLISH.search(shown)


def test_columns_keep_their_places(folder: Path) -> None:
    """Numbers of German lines end where those of English lines do."""
    line = re.compile(r"^  \S.*mm +3[.,]0000 +3[.,]0000$", re.MULTILINE)
    english, german = (line.search(_run(*words, "data", "reducer-21-43.toml").stdout) for words in ((), ("--language", "de")))
    assert english is not None and german is not None
    assert len(english[0]) == len(german[0])


def test_rating_is_german(folder: Path) -> None:
    shown = _run("--language", "de", "rate", "reducer-21-43.toml").output
    assert "Tragfähigkeit nachgewiesen" in shown
    assert not ENGLISH.search(shown)


@pytest.mark.parametrize("command", ["data", "rate"])
def test_documents_are_the_same(folder: Path, command: str) -> None:
    german = _run("--language", "de", command, "reducer-21-43.toml", "--json")
    assert german.stdout_bytes == _run(command, "reducer-21-43.toml", "--json").stdout_bytes
    assert german.exit_code == 0


def test_drawings_are_the_same(folder: Path) -> None:
    drawn = {}
    for language in ("en", "de"):
        assert _run("--language", language, "draw", "spur.toml", "--format", "svg", "-o", language).exit_code == 0
        drawn[language] = {file.name: file.read_bytes() for file in Path(language).iterdir()}
    assert drawn["en"] == drawn["de"]
    assert drawn["en"]


def test_faults_are_german(folder: Path) -> None:
    spec = folder / "faulty.toml"
    spec.write_text((folder / "spur.toml").read_text(encoding="utf-8").replace("teeth = ", "teeth = -", 1), encoding="utf-8")
    failed = _run("--language", "de", "data", "faulty.toml")
    assert failed.exit_code == 2
    assert failed.stderr.startswith("Fehler: faulty.toml Zeile ")
    assert not ENGLISH.search(failed.stderr)


def test_no_such_language_is_one_line(folder: Path) -> None:
    failed = _run("--language", "fr", "data", "spur.toml")
    assert failed.exit_code == 2
    assert failed.stderr == 'Error: language = \'fr\': must be "en" or "de"\n'


def test_english_does_not_read_the_catalogue(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(_language: str) -> None:
        raise AssertionError("the catalogue is not needed")

    monkeypatch.setattr("gearcad.core.messages.messages_of", refused)
    assert _run("data", "spur.toml").exit_code == 0
