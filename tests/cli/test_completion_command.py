"""Completion in shells: bash asks as it would when Tab is pressed; the others get scripts that ask the same way."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.shell_completion import ShellComplete
from support.commands import invoke

from gearcad.cli import main
from gearcad.cli.basics import VARIABLE


def completed(*words: str) -> list[str]:
    *before, begun = words
    return [item.value for item in ShellComplete(main, {}, "gearcad", VARIABLE).get_completions(before, begun)]


def test_commands_options_starters_and_files_are_completed() -> None:
    assert completed("dr") == ["draw"]
    assert completed("check", "--qu") == ["--quiet"]
    assert completed("new", "planetary-alm") == ["planetary-alm", "planetary-alm-in-phase"]
    (spec,) = ShellComplete(main, {}, "gearcad", VARIABLE).get_completions(["check"], "vol")
    assert spec.type == "file"


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
def test_bash_completes_a_command(tmp_path: Path) -> None:
    script = invoke("completion", "bash").output
    command = tmp_path / "gearcad"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m gearcad "$@"\n')
    command.chmod(0o755)
    ask = "COMP_WORDS=(gearcad pla); COMP_CWORD=1; _gearcad_completion gearcad; echo ${COMPREPLY[@]}"
    environment = {**os.environ, "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(["bash", "-c", f"{script}\n{ask}"], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout.split() == ["planetary"]


@pytest.mark.parametrize(("shell", "asks"), [("zsh", "zsh_complete"), ("fish", "fish_complete")])
def test_other_shells_get_a_script_that_asks_as_they_do(shell: str, asks: str) -> None:
    done = invoke("completion", shell)
    assert done.exit_code == 0 and f"{VARIABLE}={asks}" in done.output
    assert invoke("completion", "tcsh").exit_code == 2
