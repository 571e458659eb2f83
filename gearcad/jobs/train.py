"""Jobs of pairs over the meshes of a train: a folder a mesh, and one document of the train with the verdict of the worst."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, ClassVar, Self, cast

from gearcad.core.errors import InputError
from gearcad.core.records import NOT_ASKED_WORDS, JsonObject, Notice, Verdict, texts
from gearcad.core.runtime import Expected, Progress
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.designs.train_designs import TrainDesign
from gearcad.designs.train_meshes import NO_PAIR, TrainMesh, has_pairs, train_meshes
from gearcad.jobs.job import Job, Result, Writer, with_summary
from gearcad.version import __version__

PER_MESH = ("rate", "check", "stiffness", "mesh")
"""Verbs that do with each mesh of a train what they do with a pair."""

_WORST_FIRST = (Verdict.FAILED, Verdict.NOT_JUDGED, Verdict.NOT_ASKED, Verdict.PASSED)
_LEAST = ("S_H_min", "S_F_min")
"""Figures of meshes whose least value is a figure of the train."""


@dataclass(frozen=True)
class TrainMeshResult:
    """The result of a job for one mesh of a train, and its document."""

    mesh: TrainMesh
    result: Any
    document: JsonObject
    figures: JsonObject

    @property
    def strength(self) -> Verdict | None:
        """Verdict on strength; None where the job judges none."""
        told = self.document["strength"]
        return None if told is None else Verdict(told)

    @property
    def passed(self) -> bool | None:
        """Whether the mesh passed; None where it was not judged, or not asked for."""
        found: bool | None = self.document["passed"]
        return found

    @property
    def not_judged(self) -> Iterator[str]:
        """Yield what was not judged, with the reason where the document has it."""
        told = self.document["not_judged"]
        yield from (f"{what}: {why}" for what, why in told.items()) if isinstance(told, Mapping) else map(str, told)


@dataclass(frozen=True)
class MeshResults:
    """Results of a job for the meshes of a train, and the names of meshes without a pair. The worst mesh decides."""

    verb: str
    name: str
    meshes: tuple[TrainMeshResult, ...]
    without: tuple[str, ...]
    notices: tuple[Notice, ...]

    @property
    def passed(self) -> bool | None:
        """False where a mesh failed, None where one was not judged, or not asked for; else True."""
        told = [each.passed for each in self.meshes] + [None for _ in self.without]
        return False if False in told else None if None in told else True

    @property
    def strength(self) -> Verdict | None:
        """Verdict on strength of the worst mesh; None where the job judges none."""
        told = [each.strength for each in self.meshes if each.strength is not None]
        if Verdict.PASSED in told and self.without:
            told.append(Verdict.NOT_JUDGED)
        return min(told, key=_WORST_FIRST.index, default=None)

    @cached_property
    def worst(self) -> TrainMeshResult:
        """The mesh whose verdict is the worst; of equal ones that with the least safety, else the first."""
        return min(self.meshes, key=_badness)

    @property
    def falls_short(self) -> bool:
        """Whether a command ends with exit status 1."""
        if self.strength is not None and self.strength.falls_short:
            return True
        return self.passed is False

    @property
    def not_judged(self) -> dict[str, str]:
        """Meshes and their parts that were not judged, and the reasons."""
        found = dict.fromkeys(self.without, NO_PAIR)
        for each in self.meshes:
            told = each.document["not_judged"]
            pairs = told.items() if isinstance(told, Mapping) else ((text, "") for text in map(str, told))
            found |= {f"{each.mesh.name}, {what}": why for what, why in pairs}
        return found

    @property
    def verdict(self) -> str:
        """The verdict in one line."""
        failed = [each.mesh.name for each in self.meshes if each.passed is False or each.strength is Verdict.FAILED]
        if failed:
            return f"NOT passed: {', '.join(failed)}"
        if self.strength is Verdict.NOT_ASKED:
            return f"strength {NOT_ASKED_WORDS}"
        if self.strength is Verdict.NOT_JUDGED:
            unjudged = [each.mesh.name for each in self.meshes if each.strength is Verdict.NOT_JUDGED]
            return f"strength not judged: {', '.join((*unjudged, *self.without))}"
        return "passed" if self.passed else ""

    @property
    def conclusion(self) -> str:
        """The verdict with the name of the train; "" where nothing is judged."""
        return f"{self.name}: {self.verdict}" if self.verdict else ""

    def to_dict(self) -> JsonObject:
        """Return the document of the train without kind and name: meshes with their loads, verdicts and figures."""
        meshes = {
            each.mesh.name: {
                "folder": each.mesh.folder,
                "pair": each.mesh.design.name,
                "load": each.mesh.load,
                "passed": each.passed,
                "strength": None if each.strength is None else each.strength.value,
                "not_judged": list(each.not_judged),
                "figures": each.figures,
            }
            for each in self.meshes
        }
        return {
            "design": DesignKind.TRAIN.value,
            "meshes": meshes | {name: {"not_judged": [NO_PAIR]} for name in self.without},
            "worst": self.worst.mesh.name,
            "passed": self.passed,
            "strength": None if self.strength is None else self.strength.value,
            "not_judged": self.not_judged,
            "notices": [notice.to_dict() for notice in self.notices],
            "warnings": list(texts(self.notices)),
        }


def _badness(each: TrainMeshResult) -> tuple[int, int, float]:
    """Return the order of a mesh, the worst first."""
    strength = len(_WORST_FIRST) if each.strength is None else _WORST_FIRST.index(each.strength)
    safeties = [each.figures[name] for name in _LEAST if isinstance(each.figures.get(name), float)]
    return (False, None, True).index(each.passed), strength, min(safeties, default=0.0)


@dataclass(frozen=True, kw_only=True)
class OverMeshes(Job[TrainDesign, MeshResults]):
    """A job of pairs, done with each mesh of a train under the load that the train gives it, with a folder for each mesh."""

    accepts: ClassVar[tuple[DesignKind, ...]] = (DesignKind.TRAIN,)
    why: ClassVar[str] = "other designs have no meshes of a train"

    job: Job[Any, Any]

    def __post_init__(self) -> None:
        for name in ("verb", "writes_long"):
            object.__setattr__(self, name, getattr(self.job, name))

    def run(self, design: Design, progress: Progress | None = None) -> MeshResults:
        design = self.accepted(design, progress)
        found = train_meshes(design)
        results = []
        for number, mesh in enumerate(found.meshes):
            own = None if progress is None else partial(_tell, progress, mesh.name, number, len(found.meshes))
            results.append(self._result(mesh, own))
        notices = tuple(notice.within(each.mesh.name) for each in results for notice in self.job.notices(each.result))
        return MeshResults(self.job.verb, design.name, tuple(results), found.without, notices)

    def _result(self, mesh: TrainMesh, progress: Progress | None) -> TrainMeshResult:
        """Return the result for one mesh; the message of an error begins with its name."""
        try:
            result = self.job.run(mesh.design, progress)
        except InputError as error:
            raise error.within(mesh.name) from error
        document = self.job.complete_document(result)
        figures = {key: value for key, value in self.job.figures(document).items() if key not in _NO_FIGURES}
        return TrainMeshResult(mesh, result, document, figures)

    def expected(self, design: Design) -> Expected | None:
        """Return the sum of what the meshes take."""
        found = [self.job.expected(mesh.design) for mesh in train_meshes(self.accepted(design)).meshes]
        known = [each for each in found if each is not None]
        if not known or len(known) < len(found):
            return None
        return Expected(sum(each.seconds for each in known), max(each.memory for each in known))

    def document(self, result: MeshResults) -> JsonObject:
        """Return the document of the train."""
        return {"kind": self.job.verb, "name": result.name, "gearcad": __version__, **result.to_dict()}

    def complete_document(self, result: MeshResults) -> JsonObject:
        return with_summary(self.document(result))

    def notices(self, result: MeshResults) -> Sequence[Notice]:
        return result.notices

    def conclusion(self, _name: str, result: MeshResults) -> str:
        return result.conclusion

    def files(self, result: MeshResults) -> dict[str, Writer]:
        """Return the document of the train, and the files of each mesh in its folder."""
        found: dict[str, Writer] = {f"{self.job.verb}.json": partial(self.write_document, result)}
        for each in result.meshes:
            job = self.job.headed(each.mesh.design)
            found |= {f"{each.mesh.folder}/{name}": write for name, write in job.files(each.result).items()}
        return found

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        return self.job.parts

    def part_of(self, file: str) -> str:
        return self.job.part_of(file)

    def for_row(self, design: Design, parts: Any) -> Self:
        return replace(self, job=self.job.for_row(design, parts))

    def figures(self, document: JsonObject) -> JsonObject:
        return train_figures(document)


_NO_FIGURES = ("passed", "strength", "warnings")
"""Keys that stand beside the figures of a mesh."""


def _tell(progress: Progress, mesh: str, before: int, count: int, step: str, done: float, whole: float) -> None:
    """Tell how far one of several meshes is."""
    progress(f"{mesh}: {step}", before + done / whole, count)


def train_figures(document: JsonObject) -> JsonObject:
    """Return the figures of a train's document for one line of a table: those of each mesh, and the verdict of the worst."""
    meshes: dict[str, JsonObject] = {name: each for name, each in document["meshes"].items() if "figures" in each}
    every = [each["figures"] for each in meshes.values()]
    least = {name: [each.get(name) for each in every] for name in _LEAST if any(name in each for each in every)}
    return {
        **{name: {"passed": of["passed"], "strength": of["strength"], **of["figures"]} for name, of in meshes.items()},
        **{name: min(values) if None not in values else None for name, values in least.items()},
        **{name: document[name] for name in ("worst", "passed", "strength", "warnings")},
    }


def figures_of(job: Job[Any, Any], document: JsonObject) -> JsonObject:
    """Return the figures of a job's document, which may be that of a train."""
    return train_figures(document) if document.get("design") == DesignKind.TRAIN.value else job.figures(document)


def suited(job: Job[Any, Result], design: Design) -> Job[Any, Result]:
    """Return the job for a design: of a train with pairs the one that does the same with each of its meshes.

    The result is then MeshResults, which has the verdicts of any other.
    """
    if job.verb in PER_MESH and design.kind is DesignKind.TRAIN and has_pairs(cast("TrainDesign", design)):
        return cast("Job[Any, Result]", OverMeshes(job=job))
    return job
