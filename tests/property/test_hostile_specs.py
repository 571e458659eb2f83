"""Whatever a spec holds, a command answers with a status, and with one line where it refuses: never with a fault of ours."""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path

from hypothesis import given, settings
from support.hostile import CHEAP, hostile_specs, run_politely

from gearcad.errors import SpecError
from gearcad.spec.starters import starter_text
from gearcad.spec.trains import read_train

FZG = tomllib.loads(starter_text("fzg-c")[1]) | {"check": CHEAP}
TRAIN = tomllib.loads(starter_text("train-1-stage")[1])


def spec_file(text: str) -> Path:
    path = Path(tempfile.mkdtemp()) / "x.toml"
    path.write_text(text, encoding="utf-8")
    return path


@settings(max_examples=150)
@given(text=hostile_specs(trains=False))
def test_data_of_a_hostile_spec(text: str) -> None:
    run_politely("data", str(spec_file(text)))


@settings(max_examples=150)
@given(text=hostile_specs(trains=True))
def test_reading_a_hostile_train(text: str) -> None:
    try:
        read_train(spec_file(text))
    except SpecError as error:
        assert str(error).isprintable()
