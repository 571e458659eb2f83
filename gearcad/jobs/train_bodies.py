"""Trains of pairs as bodies: `build` and `picture` of all gears and shafts in mesh, beside the files of each pair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

from gearcad.core.records import JsonObject, Notice
from gearcad.core.runtime import Progress
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.designs.train_designs import TrainDesign
from gearcad.designs.train_meshes import has_pairs, mesh_design, require_pairs
from gearcad.dynamics.trains.train import Train
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data, Job, Result, Writer
from gearcad.jobs.train import MeshResults, OverMeshes, suited
from gearcad.solids import Format
from gearcad.solids.files.gear_train_products import GearTrainProduct
from gearcad.solids.gear_train_plan import GearKey, GearTrainPlan, ShaftPlan, TrainMeshPlan
from gearcad.version import __version__

_ALL_PAIRS = "without it the gears have no places"
"""Reason why each mesh needs a pair."""


def gear_train_plan(design: TrainDesign) -> GearTrainPlan:
    """Return the places of all gears and shafts of a train of pairs. Raises ParameterError for a mesh without a pair.

    Gears that shafts join are on one line: they have one axis.
    """
    require_pairs(design, _ALL_PAIRS)
    lines = _lines(design.train)
    meshes = tuple(
        TrainMeshPlan(
            name=mesh.name,
            pair=mesh_design(mesh).pair,
            gears=mesh.gears,
            lines=mesh.gears.map(lambda inertia: lines[inertia]),
            angle=mesh.mesh_angle,
        )
        for mesh in design.train.meshes
    )
    shafts = tuple(
        ShaftPlan(
            name=shaft.name,
            line=lines.get(shaft.start, lines.get(shaft.end, -1)),
            shaft=shaft.layout.stepped(),
            positions={GearKey(gear.mesh, gear.role): gear.position for gear in shaft.layout.gears},
        )
        for shaft in design.train.shafts
        if shaft.layout is not None
    )
    return GearTrainPlan(design.name, meshes, shafts)


def _lines(train: Train) -> dict[str, int]:
    """Return the number of the line of shafts to which each inertia belongs."""
    found = {inertia.name: number for number, inertia in enumerate(train.inertias)}
    for shaft in train.shafts:
        if shaft.start in found and shaft.end in found and found[shaft.start] != found[shaft.end]:
            kept, gone = found[shaft.start], found[shaft.end]
            found = {name: kept if line == gone else line for name, line in found.items()}
    return found


def line_names(design: TrainDesign) -> dict[int, str]:
    """Return the names of what turns on each line of shafts: its shafts, else its inertias."""
    lines = _lines(design.train)
    found: dict[int, list[str]] = {}
    for shaft in design.train.shafts:
        line = lines.get(shaft.start, lines.get(shaft.end, -1))
        found.setdefault(line, []).append(shaft.name)
    for inertia, line in lines.items():
        if not found.get(line):
            found[line] = [inertia]
    return {line: ", ".join(names) for line, names in found.items()}


@dataclass(frozen=True)
class TrainBuilt:
    """Bodies of a train: its design, the product of all gears and shafts, and the files of each pair."""

    design: TrainDesign
    product: GearTrainProduct
    meshes: MeshResults

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of the pairs and of the arrangement."""
        return (*self.meshes.notices, *self.product.plan.notices)


@dataclass(frozen=True, kw_only=True)
class BuildTrain(Job[TrainDesign, TrainBuilt]):
    """The files of a train of pairs: those of each pair in a folder of its mesh, the shafts, and the assembly of all.

    Raises GeometryError for options of pairs or planetary trains alone.
    """

    verb = "build"
    accepts = (DesignKind.TRAIN,)
    why = "other designs have no meshes of a train"

    job: Build

    def run(self, design: Design, progress: Progress | None = None) -> TrainBuilt:
        design = self.accepted(design, progress)
        product = GearTrainProduct(gear_train_plan(design), self.job.options)
        product.plan.gears  # noqa: B018 - places that contradict each other are told now
        return TrainBuilt(design, product, OverMeshes(job=self.job).run(design, progress))

    def document(self, result: TrainBuilt) -> JsonObject:
        """Return kind, name and version, and the arrangement: axes, heights and rotations of all gears and shafts."""
        plan = result.product.plan.to_dict()
        return {"kind": "build", "name": result.design.name, "gearcad": __version__, "arrangement": plan}

    def notices(self, result: TrainBuilt) -> Sequence[Notice]:
        return result.notices

    def files(self, result: TrainBuilt) -> dict[str, Writer]:
        """Return the data, the files of each pair in its folder, the shafts of the train, and the assembly, quickest first."""
        found = Data().files(result.design)
        for each in result.meshes.meshes:
            found |= {f"{each.mesh.folder}/{name}": write for name, write in self.job.files(each.result).items()}
        for kind in reversed(Format):
            if kind not in self.job.formats or self.job.stage != "finished":
                continue
            if kind.entry.write_body is not None:
                for name, body in result.product.bodies.items():
                    found[f"shaft-{name}.{kind.value}"] = partial(kind.entry.write_body, body)
            if kind.entry.write_pair is not None:
                found[f"assembly.{kind.value}"] = partial(kind.entry.write_pair, result.product)
        return found

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        return self.job.parts

    def part_of(self, file: str) -> str:
        return self.job.part_of(file)


def suited_to_train(job: Job[Any, Result], design: Design) -> Job[Any, Result]:
    """Return the job for a design: of a train of pairs the one that does the same with it and with each of its meshes."""
    if isinstance(job, Build) and design.kind is DesignKind.TRAIN and has_pairs(cast("TrainDesign", design)):
        return cast("Job[Any, Result]", BuildTrain(job=job))
    return suited(job, design)
