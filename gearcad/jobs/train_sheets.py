"""Sheets of a train of pairs: those of each pair in a folder of its mesh, and one of the arrangement of all gears."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Progress
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.designs.train_designs import TrainDesign
from gearcad.designs.train_meshes import has_pairs
from gearcad.drawing.gear_sheet import Drawing
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.train_arrangement import DrawnArrangement, draw_arrangement
from gearcad.jobs.draw import Draw, overridden
from gearcad.jobs.job import Job, Result, Writer
from gearcad.jobs.train import MeshResults, OverMeshes
from gearcad.jobs.train_bodies import gear_train_plan, line_names, suited_to_train


@dataclass(frozen=True)
class TrainDrawn:
    """The sheet of the arrangement of a train, and the sheets of the pairs of its meshes."""

    arrangement: Drawing
    meshes: MeshResults

    @property
    def sheets(self) -> tuple[Any, ...]:
        """All sheets: the arrangement, then those of the pairs."""
        return (*self.arrangement.sheets, *(sheet for each in self.meshes.meshes for sheet in each.result.sheets))

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of all sheets."""
        return (*self.arrangement.notices, *self.meshes.notices)


@dataclass(frozen=True, kw_only=True)
class DrawTrain(Job[TrainDesign, TrainDrawn]):
    """The sheets of a train of pairs: the arrangement, and in a folder a mesh those of the pairs. Raises ParameterError."""

    verb = "draw"
    accepts = (DesignKind.TRAIN,)
    why = "other designs have no meshes of a train"

    job: Draw

    def run(self, design: Design, progress: Progress | None = None) -> TrainDrawn:
        design = self.accepted(design, progress)
        plan = gear_train_plan(design)
        ratios = design.train.speed_ratios
        first, last = design.train.meshes[0].pinion, design.train.meshes[-1].wheel
        axes = {line for mesh in plan.meshes for line in mesh.lines}
        drawn = DrawnArrangement(
            plan=plan,
            lines={line: name for line, name in line_names(design).items() if line in axes},
            first=first,
            last=last,
            ratio=ratios[first] / ratios[last],
        )
        given = {name: value for name, value in self.job.given.items() if name not in ("sheet", "scale")}
        sheets = () if self.job.what == "tool" else (draw_arrangement(drawn, overridden(DrawingOptions(), given)),)
        return TrainDrawn(Drawing(name=design.name, sheets=sheets), OverMeshes(job=self.job).run(design, progress))

    def document(self, result: TrainDrawn) -> JsonObject:
        """Return the content of draw.json: the arrangement as a sheet, and the sheets of each mesh under its name."""
        meshes = {
            each.mesh.name: {"folder": each.mesh.folder, "sheets": each.document["sheets"]} for each in result.meshes.meshes
        }
        return {**self.job.document(result.arrangement), "design": DesignKind.TRAIN.value, "meshes": meshes}

    def notices(self, result: TrainDrawn) -> Sequence[Notice]:
        return result.notices

    def files(self, result: TrainDrawn) -> dict[str, Writer]:
        """Return the writers of the arrangement, of the document, and of the sheets of each pair in its folder."""
        found = self.job.files(result.arrangement) if result.arrangement.sheets else {}
        found[f"{self.verb}.json"] = lambda path: self.write_document(result, path)
        for each in result.meshes.meshes:
            job = self.job.headed(each.mesh.design)
            found |= {f"{each.mesh.folder}/{name}": write for name, write in job.files(each.result).items()}
        return found

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        return self.job.parts

    def part_of(self, file: str) -> str:
        return self.job.part_of(file)


def job_for(job: Job[Any, Result], design: Design) -> Job[Any, Result]:
    """Return the job for a design: of a train of pairs the one that does the same with it and with each of its meshes."""
    if design.kind is DesignKind.TRAIN and has_pairs(cast("TrainDesign", design)):
        if isinstance(job, Draw):
            return cast("Job[Any, Result]", DrawTrain(job=job))
        if job.verb == "verify":
            from gearcad.jobs.train_verification import VerifyTrain  # with all that judges

            return cast("Job[Any, Result]", VerifyTrain(job=cast("Any", job)))
    return suited_to_train(job, design)
