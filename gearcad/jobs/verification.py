"""Job `verify`: makes the files of a design, and lets each claim about them be judged by something that did not make it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Unpack, cast

from gearcad.core.errors import GeometryError, as_choice
from gearcad.core.output import source_date
from gearcad.core.records import Notice
from gearcad.core.runtime import Agenda, Progress, one_thread
from gearcad.designs.design import Design
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.designs.keys import DesignKind
from gearcad.drawing.options import DrawingOptions
from gearcad.geometry import Gear, GearPair, Rack, RackPair, SplineJoint
from gearcad.jobs import job_for
from gearcad.jobs.build import AssemblyProduct, Build, PartProduct, products_of
from gearcad.jobs.job import Data, Job, Subject, Writer, as_design
from gearcad.jobs.strength import Check, Rate
from gearcad.jobs.verification_sheets import judge_sheets, make_sheets
from gearcad.jobs.verification_solvers import MESH_FORMATS, judge_by_calculix, judge_meshes
from gearcad.report.document import heading
from gearcad.report.verification import verification_html
from gearcad.report.verification_pdf import write_verification_pdf
from gearcad.solids import FileOptions, Format
from gearcad.solids.files.products import GearProduct, MadeProduct, PairProduct
from gearcad.verification.as_made_files import judge_made
from gearcad.verification.assemblies import PlacedMesh, judge_joint
from gearcad.verification.calculix import calculix_version
from gearcad.verification.claims import Claim, Judge, VerificationLevel, VerificationOptions, timed
from gearcad.verification.claims import ClaimSubject as About
from gearcad.verification.drawings import judge_section, judge_sections
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.facets import SUBJECTS, JudgedFacets, judge_facets
from gearcad.verification.geometry import judge_gear, judge_pair, judge_rack
from gearcad.verification.result import Verification
from gearcad.verification.step import judge_step
from gearcad.verification.step_entities import JudgedSolids
from gearcad.verification.strength import judge_check, judge_rating
from gearcad.verification.turned_parts import ExactShaft
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.designs import Inputs, PairDesign, PlanetaryDesign, RackPairDesign, SplineDesign
    from gearcad.load import Load
    from gearcad.planetary import TrainLoad
    from gearcad.solids.files.shaft_products import ShaftProduct

FORMATS = (Format.STEP, Format.STL, Format.THREE_MF, Format.GLB, Format.DXF)
"""Formats that are made and judged."""


@dataclass(frozen=True, kw_only=True)
class Verify(Job[ToothedDesign, Verification]):
    """Verification of a design at a level; without one at that of the design's [verify].

    With `folder` the files there are judged, else those that are made now.

    With `keep` the files that were made and judged are written beside the evidence.
    """

    verb = "verify"
    accepts = (DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK, DesignKind.RACK_PAIR, DesignKind.PLANETARY, DesignKind.SPLINE)
    why = "there are no teeth"

    level: VerificationLevel | None = None
    folder: str = ""
    keep: bool = True

    def __post_init__(self) -> None:
        if self.level is not None:
            object.__setattr__(self, "level", as_choice("level", self.level, VerificationLevel))

    def level_of(self, design: ToothedDesign) -> VerificationLevel:
        """Return the level of this job, else that of the design's [verify]."""
        own = design.verify or VerificationOptions()
        return VerificationLevel(own.level) if self.level is None else self.level

    @one_thread()
    def run(self, design: Design, progress: Progress | None = None) -> Verification:
        """Return the verification of a design."""
        design = self.accepted(design, progress)
        for name, gear in design.gears.items():
            if gear.body.step is not None:
                permitted = "must be left out for gearcad verify: nothing here knows how the blank should be"
                raise GeometryError(f"{name}.body.step", Path(gear.body.step).name, permitted)
        with TemporaryDirectory(prefix="gearcad-verify-") as made:
            folder = Path(self.folder or made)
            if not self.folder:
                build = Build(formats=FORMATS)
                build.write(build.run(design), folder)
            claims = list(self._claims(design, folder, progress))
            kinds = {kind.value for kind in FORMATS} | (set() if self.folder else set(MESH_FORMATS))
            names = sorted(path.name for path in folder.iterdir() if path.suffix[1:] in kinds)
            contents = {name: (folder / name).read_bytes() for name in names}
        return Verification(
            name=design.name,
            level=self.level_of(design),
            claims=tuple(claims),
            contents=contents,
            spec=Data().document(design),
            judges=versions_of(claims),
            strength=strength_of(claims),
            notices=design.notices,
            heading=heading(design.drawing or DrawingOptions()),
            pictured=_pictured(design),
        )

    def _claims(self, design: ToothedDesign, folder: Path, progress: Progress | None) -> Iterator[Claim]:
        """All claims of the level with their times; without these where a date is given: equal input gives equal bytes."""
        stages = list(self._stages(design, folder))
        agenda = Agenda(progress, {stage.name: stage.effort for stage in stages})
        for stage in stages:
            agenda(stage.name)
            claims = stage.claims()
            yield from claims if source_date() is not None else timed(claims)

    def _stages(self, design: ToothedDesign, folder: Path) -> Iterator[_Stage]:
        """What is judged, one after the other, and about how long each takes beside the others."""
        parts, assembly = products_of(design, FileOptions())
        exact = {product.name: ExactPart(_part(product)) for product in parts.values()}
        bodies = assembly.bodies if isinstance(assembly, PairProduct) else {}
        rings = assembly.rings if isinstance(assembly, PairProduct) else {}
        exact |= {body.name: ExactShaft(body.plan.shaft) for body in (*bodies.values(), *rings.values())}
        yield from _of_files(design, folder, parts, assembly, exact)
        yield from _of_made(parts, folder, made=not self.folder)
        of_parts = {name: exact[product.name] for name, product in parts.items()}
        yield _Stage("drawings", 1.0, partial(_of_sheets, design, folder, of_parts, drawn=not self.folder))
        level = self.level_of(design)
        sections = _SECTIONS if level.includes(VerificationLevel.FULL) else 1
        for name, product in parts.items():
            yield _Stage(f"geometry of {name}", 0.3, partial(_of_geometry, _part(product), name, sections))
        for mesh in _meshes(design, parts):
            where = f"{mesh.pinion} and {mesh.mate}"
            yield _Stage(f"geometry of {where}", 0.2, partial(_of_pair, mesh.pair, where))
        if level.includes(VerificationLevel.STRENGTH):
            yield _Stage("contact and strength", 20.0, partial(_of_strength, design))
        if level.includes(VerificationLevel.FULL):
            yield _Stage("meshes", 10.0, partial(judge_meshes, design, folder, of_parts, made=not self.folder))
            yield _Stage("CalculiX", 60.0, partial(judge_by_calculix, design))

    def document(self, result: Verification) -> dict[str, Any]:
        """Return the content of verify.json."""
        return {"kind": self.verb, "name": result.name, "gearcad": __version__, **result.to_dict()}

    def notices(self, result: Verification) -> Sequence[Notice]:
        return result.notices

    def conclusion(self, name: str, result: Verification) -> str:
        judged = len(result.claims) - len(result.not_judged)
        if result.failed:
            return f"{name}: {len(result.failed)} of {judged} claims failed"
        return f"{name}: all {judged} claims passed" if judged else f"{name}: nothing was judged"

    def part_of(self, file: str) -> str:
        return self.verb if file in _EVIDENCE else ""

    def for_row(self, _design: Design, _parts: Collection[str]) -> Verify:
        return replace(self, keep=False)

    def figures(self, document: dict[str, Any]) -> dict[str, Any]:
        """Return verdicts, counts, and every deviation and safety for one line of a table."""
        found: dict[str, Any] = {name: document[name] for name in ("passed", "strength")}
        found |= {f"claims_{name.replace(' ', '_')}": count for name, count in document["counts"].items()}
        for claim in document["claims"]:
            value = claim["computed"] if claim["claim"] == About.STRENGTH.value else claim["deviation"]
            if isinstance(value, float | int):
                found[f"{claim['claim']}: {claim['where']}: {claim['quantity']}"] = value
        return {**found, "warnings": document["warnings"]}

    def files(self, result: Verification) -> dict[str, Writer]:
        """The judged files, unless they were there before, and the evidence: page, PDF and document."""
        found: dict[str, Writer] = {}
        if self.keep and not self.folder:
            found |= {name: partial(_write_bytes, content) for name, content in result.contents.items()}
        writers = (partial(_write_page, self.document(result), result), partial(_write_pdf, self.document(result), result))
        return {**found, **dict(zip(_EVIDENCE, (*writers, partial(self.write_document, result)), strict=True))}


_EVIDENCE = ("verify.html", "verify.pdf", "verify.json")
"""Files of a verification beside those that were judged."""


def _write_page(document: dict[str, Any], result: Verification, path: Path) -> None:
    path.write_text(verification_html(document, result.heading, result.pictured), encoding="utf-8", newline="\n")


def _write_pdf(document: dict[str, Any], result: Verification, path: Path) -> None:
    write_verification_pdf(document, result.heading, path)


def _pictured(design: ToothedDesign) -> Gear | GearPair | None:
    """The gear or pair of a design, for a picture."""
    if design.kind is DesignKind.PAIR:
        return cast("PairDesign", design).pair
    return next(iter(design.gears.values())) if design.kind is DesignKind.GEAR else None


def _write_bytes(content: bytes, path: Path) -> None:
    path.write_bytes(content)


@dataclass(frozen=True)
class _Stage:
    """One thing that is judged: its name, about how long that takes beside the others, and what makes its claims."""

    name: str
    effort: float
    claims: Callable[[], Iterator[Claim]]


_SECTIONS = 5
"""Sections at which level full sweeps the tool."""

_EFFORTS = {Format.STEP: 2.0, Format.DXF: 0.2}
"""About how long a file of a format takes beside the others; 1 if it is not here."""


def _of_files(
    design: ToothedDesign,
    folder: Path,
    parts: Mapping[str, PartProduct],
    assembly: AssemblyProduct | None,
    exact: Mapping[str, ExactPart],
) -> Iterator[_Stage]:
    """What is judged of level files: every file."""
    options, judged = FileOptions(), _Judged()
    for kind in FORMATS:
        effort = _EFFORTS.get(kind, 1.0)
        bodies = assembly.bodies if isinstance(assembly, PairProduct) and kind.entry.write_body is not None else {}
        for name, product in {**parts, **bodies}.items():
            claims = partial(_of_part, kind=kind, product=product, exact=exact, options=options, judged=judged)
            path = folder / f"{name}.{kind.value}"
            yield _Stage(path.name, effort, partial(_of_file, path, kind, claims))
        if assembly is not None and _assembled(design, kind):
            path = folder / f"assembly.{kind.value}"
            claims = partial(
                _of_assembly,
                kind=kind,
                design=design,
                parts=parts,
                assembly=assembly,
                exact=exact,
                options=options,
                judged=judged,
            )
            yield _Stage(path.name, 2 * effort, partial(_of_file, path, kind, claims))


def _of_made(parts: Mapping[str, PartProduct], folder: Path, *, made: bool) -> Iterator[_Stage]:
    """What is judged of gears as they are made, whose files are to be `made` or are there: solids, and paths that cut."""
    for name, product in parts.items():
        if not isinstance(product, GearProduct) or not product.gear.making.present or product.gear.modification.present:
            continue
        kind = Format.DXF if product.gear.making.cuts else Format.STEP
        path = folder / f"{name}-as-made.{kind.value}"
        if product.gear.internal and product.gear.body.rim_diameter is None and kind is Format.STEP:
            continue
        if made:
            kind.entry.write(MadeProduct.of(product), path)
        if path.is_file():
            yield _Stage(path.name, 1.0, partial(_of_file, path, kind, partial(judge_made, gear=product.gear)))


def _of_sheets(design: ToothedDesign, folder: Path, parts: Mapping[str, ExactPart], *, drawn: bool) -> Iterator[Claim]:
    """The claims about drawings, which are to be `drawn` or are there."""
    reason = make_sheets(design, folder) if drawn else ""
    yield from judge_sheets(design, folder, parts, Data().document(design), reason)


def _of_geometry(part: Gear | Rack, name: str, sections: int) -> Iterator[Claim]:
    yield from judge_rack(part, name) if isinstance(part, Rack) else judge_gear(part, name, sections)


def _of_pair(pair: GearPair | RackPair | SplineJoint, where: str) -> Iterator[Claim]:
    yield from judge_joint(pair, where) if isinstance(pair, SplineJoint) else judge_pair(pair, where)


def _assembled(design: ToothedDesign, kind: Format) -> bool:
    """Whether a format has a file of the parts in mesh."""
    of_kind = kind.entry.write_train if design.kind is DesignKind.PLANETARY else kind.entry.write_pair
    return of_kind is not None


def _of_file(path: Path, kind: Format, claims: Callable[[Path], Iterator[Claim]]) -> Iterator[Claim]:
    """Yield claims about a file, or the claim that it exists."""
    if not path.is_file():
        yield Judge(_subject(kind), VerificationLevel.FILES, path.name, "file system").holds(
            "is there", False, place=f"no file {path.name}"
        )
        return
    try:
        yield from claims(path)
    except Exception as error:  # what a broken file does to a reader or a measurement is not known beforehand
        said = f"{type(error).__name__}: {error}"
        yield Judge(_subject(kind), VerificationLevel.FILES, path.name, "gearcad").holds("can be judged", False, place=said)


def _subject(kind: Format) -> About:
    return {Format.STEP: About.STEP, Format.DXF: About.DXF}.get(kind) or SUBJECTS[kind.value]


def _part(product: PartProduct) -> Gear | Rack:
    return getattr(product, "gear", None) or product.rack  # type: ignore[union-attr]


@dataclass(frozen=True)
class _Judged:
    """Solids and facets that were judged in files before: an assembly has those of its parts."""

    solids: JudgedSolids = field(default_factory=JudgedSolids)
    facets: JudgedFacets = field(default_factory=JudgedFacets)


def _of_part(
    path: Path,
    kind: Format,
    product: PartProduct | ShaftProduct,
    exact: Mapping[str, ExactPart],
    options: FileOptions,
    judged: _Judged,
) -> Iterator[Claim]:
    if kind is Format.STEP:
        yield from judge_step(path, product.solid(), exact, judged=judged.solids)
    elif kind is Format.DXF:
        yield from judge_section(path, exact[product.name])
    else:
        own, named = {product.name: exact[product.name]}, kind is not Format.STL
        looks: dict[str, Any] = {"product": product.solid(), "colour": product.colour} if named else {}
        yield from judge_facets(path, own, options.chord_error, names=named, judged=judged.facets, **looks)


def _of_assembly(
    path: Path,
    kind: Format,
    design: ToothedDesign,
    parts: Mapping[str, PartProduct],
    assembly: AssemblyProduct,
    exact: Mapping[str, ExactPart],
    options: FileOptions,
    judged: _Judged,
) -> Iterator[Claim]:
    meshes = _meshes(design, parts)
    if kind is Format.STEP:
        yield from judge_step(path, assembly.solid(), exact, meshes, judged.solids)
    elif kind is Format.DXF:
        yield from judge_sections(path, _counts(design, parts))
    else:
        yield from judge_facets(path, exact, options.chord_error, meshes, judged=judged.facets, product=assembly.solid())


def _counts(design: ToothedDesign, parts: Mapping[str, PartProduct]) -> dict[str, int]:
    """Return the number of contours of the parts of a planetary train, by their keys: a bore that is not round is one more."""
    from gearcad.solids.train_plan import TrainLayout

    train = cast("PlanetaryDesign", design).train
    found = dict.fromkeys(parts, 0)
    for standing in TrainLayout(train, train.pose()).standing:
        body = standing.body.gear.body
        found[standing.body.key] += 2 if body.keyway_width or body.bore_spline else 1
    return found


def _meshes(design: ToothedDesign, parts: Mapping[str, PartProduct]) -> list[PlacedMesh]:
    """The meshes of a design, by the names of the parts as products."""
    if design.kind is DesignKind.PLANETARY:
        train = cast("PlanetaryDesign", design).train
        pairs = [mesh.pair for mesh in train.meshes] + [stage.pair for stage in train.stages]
        return [PlacedMesh(pair, parts[pair.pinion.name].name, parts[pair.wheel.name].name) for pair in pairs]
    if design.kind is DesignKind.PAIR:
        return [PlacedMesh(cast("PairDesign", design).pair, parts["pinion"].name, parts["wheel"].name)]
    if design.kind is DesignKind.RACK_PAIR:
        return [PlacedMesh(cast("RackPairDesign", design).pair, parts["pinion"].name, parts["rack"].name)]
    if design.kind is DesignKind.SPLINE and len(parts) > 1:
        return [PlacedMesh(cast("SplineDesign", design).spline, parts["shaft"].name, parts["hub"].name)]
    return []


def _of_strength(design: ToothedDesign) -> Iterator[Claim]:
    """The claims of the structural check and of the rating, where the design is a pair or a train with a load."""
    judge = Judge(About.CONTACT, VerificationLevel.STRENGTH, design.name, "finite elements")
    strength = Judge(About.STRENGTH, VerificationLevel.STRENGTH, design.name, "rating")
    if design.kind is DesignKind.SPLINE:
        why = "the contact of a spline is found by `gearcad check`, and nothing here judges it"
        yield judge.not_judged("contact, root stress, stiffness", why)
    elif design.kind not in Check.accepts:
        yield judge.not_judged("contact, root stress, stiffness", f"the structural check takes no {design.kind.words}")
    elif getattr(design, "load", None) is None:
        yield judge.not_judged("contact, root stress, stiffness", "the design has no load")
    else:
        yield from judge_check(Check(report=False).run(design), design.name)
    if design.kind not in Rate.accepts:
        yield strength.not_judged("safeties", f"the rating takes no {design.kind.words}")
    elif getattr(design, "load", None) is None:
        yield strength.not_judged("safeties", "the design has no load")
    else:
        yield from judge_rating(Rate(report=False).run(design), design.name)


def strength_of(claims: Sequence[Claim]) -> bool | None:
    """The verdict on strength: of the rating's claims, None where not all were judged and none failed."""
    verdicts = [claim.passed for claim in claims if claim.subject is About.STRENGTH]
    if False in verdicts:
        return False
    return True if verdicts and None not in verdicts else None


_JUDGES = {"Open CASCADE": "cadquery-ocp", "trimesh": "trimesh", "ezdxf": "ezdxf", "meshio": "meshio", "gmsh": "gmsh"}
"""Programs that judge, and the distributions that they come from."""


def versions_of(claims: Sequence[Claim]) -> dict[str, str]:
    """Versions of the programs that judge, by their names; of CalculiX if it has judged one of the claims."""
    found = {}
    for name, distribution in _JUDGES.items():
        try:
            found[name] = version(distribution)
        except PackageNotFoundError:
            continue
    if any(claim.subject is About.CALCULIX and claim.passed is not None for claim in claims):
        found["CalculiX"] = calculix_version()
    return found


def verify(
    subject: Subject,
    load: Load | TrainLoad | None = None,
    *,
    level: VerificationLevel | str | None = None,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> Verification:
    """Verify a design: every claim about its files and its figures is judged by something that did not make it.

    Level "files" judges STEP, STL, 3MF, GLB and DXF files, and the geometry; "strength" also contact, root stress and strength,
    "full" also meshes and CalculiX. Without a level it is that of the design's [verify], or of the VerificationOptions given as
    `verify`. What nothing judged is named with its reason, and never counts as passed.

    >>> from gearcad import Gear
    >>> verify(Gear(teeth=20, normal_module=2, face_width=20)).passed
    True

    Raises ParameterError and GeometryError for wrong input.
    """
    chosen = as_choice("level", level, VerificationLevel) if isinstance(level, str) else level
    design = as_design(subject, load, **inputs)
    return job_for(Verify(level=chosen), design).run(design, progress)
