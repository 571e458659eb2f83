"""Job: an action on a design. Its options are fields, it returns a result, and it writes the result as files; job `data`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from enum import Enum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeAlias, TypeVar, Unpack, cast

from gearcad.core.errors import ParameterError, as_path
from gearcad.core.output import json_text, staged_files
from gearcad.core.records import JsonObject, Notice, PerGear, texts
from gearcad.core.runtime import Agenda, Expected, Progress, installed
from gearcad.designs.design import Design
from gearcad.designs.keys import RIGID_SHAFTS, DesignKind
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.material import Material

if TYPE_CHECKING:
    from gearcad.designs import Design, Inputs
    from gearcad.dynamics.trains.train import Train
    from gearcad.geometry.spline import SplineJoint
    from gearcad.load import Load
    from gearcad.planetary import PlanetaryTrain, TrainLoad


Accepted = TypeVar("Accepted", bound=Design)
Result = TypeVar("Result")

Writer = Callable[[Path], object]
"""Writes one file at the path it is given."""


def write_inside(folder: Path, name: str, write: Writer) -> None:
    """Write a file of a folder; its name may have that of a folder in it before a /, which is made."""
    (folder / name).parent.mkdir(exist_ok=True)
    write(folder / name)


def with_summary(document: Mapping[str, Any], warnings: Iterable[str] = ()) -> JsonObject:
    """Return a document with `passed`, `strength`, `not_judged` and `warnings` at its top, whatever command it is of.

    Keys that it has are kept. The others are null where nothing is judged, [] where nothing is unjudged; the warnings are those
    that are given.
    """
    absent = {"passed": None, "strength": None, "not_judged": [], "warnings": list(warnings)}
    return {**document, **{key: value for key, value in absent.items() if key not in document}}


@dataclass(frozen=True, kw_only=True)
class Job(ABC, Generic[Accepted, Result]):
    """One verb with its options. Commands, tables and Python use jobs, and nothing below them."""

    verb: ClassVar[str]
    """Name of the job: that of its module, of its command, of its document and of its function in `gearcad`."""

    accepts: ClassVar[tuple[DesignKind, ...]]
    """The kinds of designs that it takes."""

    why: ClassVar[str]
    """End of the message that says why the job takes no other kind of design."""

    writes_long: ClassVar[bool] = False
    """Whether the files are so large that a user wants to see which of them is being written."""

    sometimes: ClassVar[tuple[str, ...]] = ()
    """Files that not every result has: one that is there of a former result goes, for it would belong to another."""

    with_shafts: ClassVar[bool] = False
    """Whether it takes the shafts of a pair's gears into account."""

    @abstractmethod
    def run(self, design: Design, progress: Progress | None = None) -> Result:
        """Return the result for a design. Raises ParameterError for a kind that it does not take, and what its solvers raise.

        It begins with `accepted`. One that solves systems runs in `one_thread`: they are small, or solved side by side, and
        more threads cost more than they bring.
        """

    def expected(self, design: Design) -> Expected | None:
        """Return the expected effort of `run`, or None if it is unknown.

        Raises the errors of `run` for input that cannot be treated.
        """
        self.accepted(design)
        return None

    def accepted(self, design: Design, progress: Progress | None = None) -> Accepted:
        """Return the design. Raises ParameterError for a kind that this job does not take, and for a wrong `progress`."""
        _require_progress(progress)
        design.require_kind(*self.accepts, why=self.why)
        return cast("Accepted", design)

    @abstractmethod
    def document(self, result: Result) -> JsonObject:
        """Return the content of VERB.json, without the keys of `with_summary` that this job has no values for."""

    def complete_document(self, result: Result) -> JsonObject:
        """Return the document with the keys that every document has; see `with_summary`."""
        return with_summary(self.document(result), texts(self.notices(result)))

    def notices(self, _result: Result) -> Sequence[Notice]:
        """Return the notices that the user should know before trusting a result."""
        return ()

    def design_notices(self, design: Design) -> Sequence[Notice]:
        """Return the notices of a design, without that on shafts where this job takes them into account."""
        return [each for each in design.notices if not (self.with_shafts and each.code == RIGID_SHAFTS)]

    def conclusion(self, _name: str, _result: Result) -> str:
        """Return one line that sums up the result for a design of this name; "" if nothing is judged."""
        return ""

    def files(self, result: Result) -> dict[str, Writer]:
        """Return the names of a result's files, in the order in which they are made, with the function that writes each."""
        return {f"{self.verb}.json": partial(self.write_document, result)}

    def write_document(self, result: Result, path: Path) -> None:
        """Write what VERB.json holds."""
        path.write_text(json_text(self.complete_document(result)), encoding="utf-8", newline="\n")

    def write(self, result: Result, folder: Path | str, progress: Progress | None = None) -> list[Path]:
        """Write all files of a result into `folder`, or none, and return their paths. Raises OutputError."""
        _require_progress(progress)
        folder, files = as_path("output", folder), self.files(result)
        agenda = Agenda(progress, dict.fromkeys(files, 1.0))
        with staged_files(folder, sometimes=self.sometimes) as staging:
            for name, write in files.items():
                agenda(name)
                write_inside(staging, name, write)
        return [folder / name for name in files]

    def headed(self, _design: Design) -> Self:
        """Return the job whose report has the heading that the design's [drawing] gives."""
        return self

    def without_missing(self) -> tuple[Self, str]:
        """Return the job without what a package that is not installed would have to make, and the name of that package."""
        return self, ""

    # ------------------------------------------------------------------ rows of a table

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """Parts that a row keeps, each with the options on which it depends, as JSON values.

        Each part is made again on its own.
        """
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return {self.verb: {each.name: _plain(values[each.name]) for each in fields(self) if values[each.name] != each.default}}

    def part_of(self, file: str) -> str:
        """Return the part to which a file belongs; "" if a row does not keep it."""
        return self.verb if file == f"{self.verb}.json" else ""

    def for_row(self, _design: Design, _parts: Collection[str]) -> Job[Any, Any]:
        """Return the job that makes these parts of a row, without options that the row does not use."""
        return self

    def figures(self, _document: JsonObject) -> JsonObject:
        """Return the figures of a document for a table of results; their columns begin with the verb."""
        return {}


@dataclass(frozen=True, kw_only=True)
class ReportedJob(Job[Accepted, Result]):
    """A job with a report, an HTML page of its result, which is left out without `report`."""

    report: bool = True
    head: Mapping[str, str] = field(default_factory=dict, compare=False)
    """Company, project, author and the like above the report's title, by their words: those of the design that it is of."""

    def headed(self, design: Design) -> Self:
        from gearcad.report.document import heading

        return replace(self, head=heading(getattr(design, "drawing", None))) if self.report else self

    def without_missing(self) -> tuple[Self, str]:
        """Return the job without its report where a package that it needs is not installed, and that package, "" if none."""
        missing = next((each for each in ("jinja2", "matplotlib") if self.report and not installed(each)), "")
        return (replace(self, report=False), missing) if missing else (self, "")

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """The document, and the report as a part of its own: rows that lack one are made again where reports are asked for."""
        ((verb, options),) = super().parts.items()
        options = {name: value for name, value in options.items() if name not in ("report", "head")}
        return {verb: options, **({self._report_part: options} if self.report else {})}

    def part_of(self, file: str) -> str:
        return self._report_part if self.report and file.endswith(".html") else super().part_of(file)

    @property
    def _report_part(self) -> str:
        return f"{self.verb} report"


def _require_progress(progress: object) -> None:
    if progress is not None and not callable(progress):
        raise ParameterError("progress", progress, "must be a function of three arguments: step, done and whole")


def _plain(value: Any) -> Any:
    """Return a value as JSON would give it back: tuples as lists, enum members as their values."""
    return list(value) if isinstance(value, tuple) else value.value if isinstance(value, Enum) else value


Subject: TypeAlias = "Design | GearPair | Gear | RackPair | Rack | PlanetaryTrain | SplineJoint"
"""Objects that Python may give to a job."""


def as_design(subject: Subject, load: Load | TrainLoad | None = None, **inputs: Unpack[Inputs]) -> Design:
    """Return the design of any permitted argument, with `inputs` in place of its own. Raises ParameterError.

    All kinds of designs are imported here: a command reads its own from a spec.
    """
    from gearcad.designs import Design, GearDesign, PairDesign, PlanetaryDesign, RackDesign, RackPairDesign, SplineDesign
    from gearcad.designs.keys import BESIDE
    from gearcad.designs.shaft_spec import PairShafts
    from gearcad.geometry import SplineJoint
    from gearcad.planetary import PlanetaryTrain, TrainLoad
    from gearcad.shafts import ShaftOptions

    if isinstance(subject, Gear):
        subject = GearDesign(name=subject.name, gear=subject)
    elif isinstance(subject, GearPair):
        subject = PairDesign(name=subject.name, pair=subject)
    elif isinstance(subject, Rack):
        subject = RackDesign(name=subject.name, rack=subject)
    elif isinstance(subject, RackPair):
        subject = RackPairDesign(name=subject.name, pair=subject)
    elif isinstance(subject, PlanetaryTrain):
        subject = PlanetaryDesign(name=subject.name, train=subject)
    elif isinstance(subject, SplineJoint):
        subject = SplineDesign(name=subject.name, spline=subject)
    if not isinstance(subject, Design):
        objects = "a GearPair, a Gear, a RackPair, a Rack, a PlanetaryTrain, a SplineJoint"
        raise ParameterError("subject", subject, f"must be {objects}, or a design such as gearcad.read gives")
    shafts = {"shafts": PairShafts if isinstance(subject, PairDesign) else ShaftOptions}
    kinds = {**BESIDE, **shafts, **({"load": TrainLoad} if isinstance(subject, PlanetaryDesign) else {})}
    given: dict[str, Any] = {**inputs, "load": load} if load is not None else {**inputs}
    for name, value in given.items():
        if not hasattr(subject, name):
            known = ", ".join(each for each in BESIDE if hasattr(subject, each))
            raise ParameterError(name, value, f"is not an input of a {subject.kind.words}; permitted: {known}")
        if name == "material" and isinstance(subject, PairDesign | RackPairDesign) and isinstance(value, PerGear):
            value.map(_require_material)
        elif name == "material" and isinstance(subject, PlanetaryDesign) and isinstance(value, Mapping):
            list(map(_require_material, value.values()))
        elif value is not None and not isinstance(value, kinds[name]):
            raise ParameterError(name, value, f"must be a {kinds[name].__name__}")
    return replace(subject, **given)


def _require_material(value: Any) -> None:
    if not isinstance(value, Material):
        raise ParameterError("material", value, "must be a Material")


@dataclass(frozen=True, kw_only=True)
class Data(Job[Design, Design]):
    """The data sheet. Its result is the design itself, whose gears, pair or train know their derived properties."""

    verb = "data"
    accepts = tuple(DesignKind)
    why = "every kind has derived quantities"

    def run(self, design: Design, progress: Progress | None = None) -> Design:
        return self.accepted(design, progress)

    def document(self, result: Design) -> JsonObject:
        """Return the content of data.json: inputs and derived properties under their field names (mm, degrees).

        Of a train "meshes" has that of the pair of each mesh, under the load that the train gives it.
        """
        return result.to_dict() | pair_documents(result)

    def notices(self, result: Design) -> Sequence[Notice]:
        return result.notices


def pair_documents(design: Design) -> JsonObject:
    """Return the documents of the pairs of a train's meshes as "meshes"; nothing for other designs and without pairs."""
    if design.kind is not DesignKind.TRAIN:
        return {}
    from gearcad.designs.train_designs import TrainDesign
    from gearcad.designs.train_meshes import mesh_documents

    assert isinstance(design, TrainDesign)
    found = mesh_documents(design)
    return {"meshes": found} if found else {}


def data(subject: Subject | Train, load: Load | None = None, **inputs: Unpack[Inputs]) -> JsonObject:
    """Return every derived quantity of a gear, a rack, a pair or a train with its inputs, nested as data.json has it: mm,
    degrees.

    >>> from gearcad import Gear
    >>> data(Gear(teeth=20, normal_module=2, face_width=20))["gear"]["reference_diameter"]
    40.0
    """
    from gearcad.designs import TrainDesign
    from gearcad.dynamics.trains.train import Train

    job, design = Data(), TrainDesign(name=subject.name, train=subject) if isinstance(subject, Train) else subject
    return job.complete_document(job.run(as_design(design, load, **inputs)))
