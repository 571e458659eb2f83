"""Files appear complete or not at all."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gearcad import ParameterError
from gearcad.output import json_text, staged_files


def everything(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def test_files_move_in_when_all_is_well_and_replace_their_namesakes(tmp_path: Path) -> None:
    target = tmp_path / "a" / "b"
    target.mkdir(parents=True)
    (target / "one").write_text("old")
    (target / "other").write_text("stays")
    with staged_files(target) as staging:
        (staging / "one").write_text("new")
        (staging / "two").write_text("new")
        assert (target / "one").read_text() == "old"
    assert everything(target) == ["one", "other", "two"]
    assert (target / "one").read_text() == "new"


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt])
def test_a_failure_changes_nothing_and_takes_its_folders_along(tmp_path: Path, error: type[BaseException]) -> None:
    (tmp_path / "a").mkdir()
    with pytest.raises(error), staged_files(tmp_path / "a" / "b" / "c") as staging:
        (staging / "half").write_text("written")
        raise error
    assert everything(tmp_path) == ["a"]


def test_a_failure_leaves_what_was_there(tmp_path: Path) -> None:
    (tmp_path / "one").write_text("old")
    with pytest.raises(RuntimeError), staged_files(tmp_path) as staging:
        (staging / "one").write_text("new")
        raise RuntimeError
    assert everything(tmp_path) == ["one"]
    assert (tmp_path / "one").read_text() == "old"


def test_a_folder_in_the_way_of_a_file_is_found_before_any_file_moves(tmp_path: Path) -> None:
    (tmp_path / "two").mkdir()
    with pytest.raises(ParameterError, match=r"cannot be written \(two is a folder there\)"), staged_files(tmp_path) as staging:
        (staging / "one").write_text("new")
        (staging / "two").write_text("new")
    assert everything(tmp_path) == ["two"]


def test_full_disk_is_a_plain_error(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"^output = '.*': cannot be written \(No space left on device\)"):
        with staged_files(tmp_path / "x"):
            raise OSError(28, os.strerror(28))
    assert everything(tmp_path) == []


def test_json_refuses_what_is_no_json() -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        json_text({"lead": float("inf")})
    assert json_text({"a": 1.0, "b": "µ"}) == '{\n  "a": 1.0,\n  "b": "\\u00b5"\n}\n'


@pytest.mark.parametrize("sent", [signal.SIGKILL, signal.SIGINT])
def test_build_that_is_stopped_leaves_no_half_written_file(sent: signal.Signals, tmp_path: Path) -> None:
    """SIGKILL cannot be caught: it may leave a hidden folder, never a file under its final name. Ctrl-C cleans up."""
    (tmp_path / "x.toml").write_text("[gear]\nteeth = 300\nnormal_module = 2\nface_width = 50\nhelix_angle = 20\n")
    command = [sys.executable, "-m", "gearcad", "build", "x.toml", "-o", "out", "--chord-error", "0.0005"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        deadline = time.monotonic() + 60
        while not list((tmp_path / "out").glob(".unfinished-*/gear.stl")) and time.monotonic() < deadline:
            time.sleep(0.002)
        child.send_signal(sent)
        output, errors = child.communicate(timeout=60)
    assert (child.returncode, output) == (-signal.SIGKILL if sent is signal.SIGKILL else 1, ""), errors
    if sent is signal.SIGINT:
        assert "Traceback" not in errors
        assert sorted(path.name for path in tmp_path.iterdir()) == ["x.toml"]
    else:
        assert [path.name for path in (tmp_path / "out").iterdir() if not path.name.startswith(".unfinished-")] == []
