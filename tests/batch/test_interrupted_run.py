"""A run that is stopped by Ctrl-C tells how many rows are made and how many it leaves, on the screen and in its results."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from click.testing import CliRunner

from gearcad.batch import run as run_module
from gearcad.cli import main


def test_ctrl_c_tells_how_many_rows_are_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table, tell = tmp_path / "gears.csv", run_module._Run.tell
    rows = [f"gear{number},{20 + number},2,10" for number in range(5)]
    table.write_text("\n".join(["name,teeth,normal_module,face_width", *rows]) + "\n", encoding="utf-8")

    def pressed(run: run_module._Run, phase: str, failed: int, whole: int) -> None:
        tell(run, phase, failed, whole)
        if phase == "making" and run.done == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(run_module._Run, "tell", pressed)
    words = ["batch", str(table), "-o", str(tmp_path / "out"), "--do", "data", "-j", "1"]
    stopped = CliRunner().invoke(main, words)
    assert stopped.exit_code == 130
    assert stopped.stderr.splitlines()[-2:] == ["2 rows ok, 0 failed, 3 not run; the same command makes the rest", "Aborted!"]
    with (tmp_path / "out" / "results.csv").open(encoding="utf-8") as file:
        assert [row["status"] for row in csv.DictReader(file)].count("not run") == 3
