"""What a row can be asked for, in parts that are made, kept and made again each on its own."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import Path
from typing import Any

from gearcad.check.document import check_document
from gearcad.designs import Design
from gearcad.errors import ParameterError
from gearcad.jobs.build import DEFAULT_FORMATS, build
from gearcad.jobs.check import assess
from gearcad.output import json_text
from gearcad.solids import FileOptions, Format

__all__ = ["DATA", "Step", "Wanted", "make_parts"]

DATA, CHECK = "data", "check"
"""The parts that are `data.json` and `check.json`; the other parts are the formats, under their suffixes."""


class Step(Enum):
    """What `--do` offers."""

    DATA = "data"
    BUILD = "build"
    CHECK = "check"


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """What is made of every row; formats and options are those of `build`. Raises ParameterError."""

    steps: tuple[Step, ...] = (Step.BUILD,)
    formats: tuple[Format, ...] = DEFAULT_FORMATS
    options: FileOptions = field(default_factory=FileOptions)

    def __post_init__(self) -> None:
        if not self.steps:
            raise ParameterError("do", "", f"must be one or more of {', '.join(step.value for step in Step)}")
        if not self.formats:
            raise ParameterError("format", "", f"must be one or more of {', '.join(kind.value for kind in Format)}")

    @property
    def stages(self) -> tuple[dict[str, dict[str, Any]], ...]:
        """Parts of a row and the options they depend on, by stage: one that fails leaves the stages before it.

        Data is always a part: the table of results needs it.
        """
        parts: dict[str, dict[str, Any]] = {DATA: {}}
        for kind in self.formats if Step.BUILD in self.steps else ():
            parts[kind.value] = kind.minded(self.options)
        return (parts, {CHECK: {}}) if Step.CHECK in self.steps else (parts,)


def make_parts(design: Design, parts: Iterable[str], wanted: Wanted, folder: Path) -> None:
    """Make the named parts of one stage in an empty folder."""
    if CHECK in parts:
        (folder / "check.json").write_text(json_text(check_document(assess(design))), encoding="utf-8")
        return
    formats = [Format(part) for part in parts if part != DATA]
    if formats:
        minded = {name: value for kind in formats for name, value in kind.minded(wanted.options).items()}
        options = FileOptions(**minded)
        build(design, folder, formats, options if len(design.gears) > 1 else replace(options, bracket=False))
    elif DATA in parts:
        (folder / "data.json").write_text(json_text(design.to_dict()), encoding="utf-8")


def part_of(file: str) -> str:
    """The part to which a file belongs."""
    return {"data.json": DATA, "check.json": CHECK}.get(file, file.rpartition(".")[2])
