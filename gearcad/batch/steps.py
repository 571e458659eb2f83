"""What a row can be asked for, in parts that are made, kept and made again each on its own."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from gearcad.check.document import check_document
from gearcad.designs import Design
from gearcad.errors import ParameterError, require_number
from gearcad.jobs.build import DEFAULT_FORMATS, Format, build
from gearcad.jobs.check import assess
from gearcad.output import json_text

__all__ = ["DATA", "Step", "Wanted", "make_parts"]

DATA, CHECK = "data", "check"
"""The parts that are `data.json` and `check.json`; the other parts are the formats, under their suffixes."""

_FACETED = (Format.STL, Format.THREE_MF, Format.GLB)


class Step(Enum):
    """What `--do` offers."""

    DATA = "data"
    BUILD = "build"
    CHECK = "check"


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """What is made of every row; formats, chord error (mm), bracket and circles are those of `build`. Raises ParameterError."""

    steps: tuple[Step, ...] = (Step.BUILD,)
    formats: tuple[Format, ...] = DEFAULT_FORMATS
    chord_error: float = 0.005
    bracket: bool = False
    circles: bool = False

    def __post_init__(self) -> None:
        if not self.steps:
            raise ParameterError("do", "", f"must be one or more of {', '.join(step.value for step in Step)}")
        if not self.formats:
            raise ParameterError("format", "", f"must be one or more of {', '.join(kind.value for kind in Format)}")
        require_number("chord_error", self.chord_error, "mm", above=0)

    @property
    def stages(self) -> tuple[dict[str, dict[str, Any]], ...]:
        """Parts of a row and the options they depend on, by stage: one that fails leaves the stages before it.

        Data is always a part: the table of results needs it.
        """
        parts: dict[str, dict[str, Any]] = {DATA: {}}
        for kind in self.formats if Step.BUILD in self.steps else ():
            parts[kind.value] = {"chord_error": self.chord_error} if kind in _FACETED else {}
        if Format.STEP.value in parts:
            parts[Format.STEP.value] = {"bracket": self.bracket}
        if Format.DXF.value in parts:
            parts[Format.DXF.value] = {"circles": self.circles}
        return (parts, {CHECK: {}}) if Step.CHECK in self.steps else (parts,)


def make_parts(design: Design, parts: Iterable[str], wanted: Wanted, folder: Path) -> None:
    """Make the named parts of one stage in an empty folder."""
    if CHECK in parts:
        (folder / "check.json").write_text(json_text(check_document(assess(design))), encoding="utf-8")
        return
    formats = [Format(part) for part in parts if part != DATA]
    if formats:
        bracket = wanted.bracket and Format.STEP in formats and design.pair is not None
        circles = wanted.circles and Format.DXF in formats
        build(design, folder, formats, bracket=bracket, chord_error=wanted.chord_error, circles=circles)
    elif DATA in parts:
        (folder / "data.json").write_text(json_text(design.to_dict()), encoding="utf-8")


def part_of(file: str) -> str:
    """The part to which a file belongs."""
    return {"data.json": DATA, "check.json": CHECK}.get(file, file.rpartition(".")[2])
