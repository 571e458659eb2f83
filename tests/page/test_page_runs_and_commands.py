"""What a run of the page makes is what the command writes, byte by byte."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from gearcad.cli import main
from gearcad.designs.reader import starter_text
from gearcad.page.run_process import RUNS
from gearcad.page.runs import Runs, RunState

LONG = 900.0
"""Seconds that a run may take."""

COARSE = '\n[check]\npositions = 12\nrefinement = 0.25\nconvergence = "off"\n'

PAIR = starter_text("fzg-c")[1] + COARSE
RATED = starter_text("reducer")[1] + COARSE
BY_BODIES = RATED.replace("\n[rating]", '\n[rating]\nface_load_factor = "fe"', 1)

COMMANDS = {
    "check-2d": (PAIR, "check --model 2d"),
    "check-3d": (PAIR, "check --model 3d"),
    "rate": (RATED, "rate"),
    "rate-fe": (BY_BODIES, "rate"),
    "stiffness": (PAIR, "stiffness"),
    "dynamics": (PAIR, "dynamics"),
    "planetary": (starter_text("planetary-24-21-66")[1], "planetary"),
    "verify": (starter_text("fzg-c")[1], "verify"),
    **{each: (RATED, f"build --format {each}") for each in ("step", "stl", "3mf", "glb", "dxf", "csv")},
    **{f"drawing-{each}": (RATED, f"draw --format {each}") for each in ("pdf", "dxf", "svg")},
    "data": (RATED, "data --json"),
}
"""Of each run of the page the spec and the command that does the same."""

QUICK = ("data",)


@pytest.mark.parametrize("kind", [kind if kind in QUICK else pytest.param(kind, marks=pytest.mark.long) for kind in RUNS])
def test_a_run_makes_what_the_command_writes(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    text, command = COMMANDS[kind]
    verb, *options = command.split()
    spec, folder = tmp_path / "mine.toml", tmp_path / "out"
    spec.write_text(text, encoding="utf-8")
    if verb != "data":
        options += ["-o", str(folder)]
    told = CliRunner().invoke(main, [verb, str(spec), *options])
    assert told.exit_code in (0, 1), told.output
    written = (
        {path.name: path.read_bytes() for path in folder.iterdir()} if folder.exists() else {"data.json": told.stdout_bytes}
    )
    runs = Runs()
    try:
        run = runs.start(kind, RATED if kind == "rate-fe" else text, "mine", tmp_path, {})
        assert run.ended.wait(LONG)
        assert run.state is RunState.DONE, run.line
        assert written == {name: (run.folder / name).read_bytes() for name in run.files}
    finally:
        runs.close()
        runs.join(10)
