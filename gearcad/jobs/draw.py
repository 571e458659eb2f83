"""Jobs `draw` and `picture`: sheets for the workshop, and images of a design."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from enum import Enum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, Unpack, cast

from gearcad.core.dxf import write_document as write_dxf
from gearcad.core.errors import (
    GeometryError,
    InputError,
    ParameterError,
    as_choice,
    as_path,
    require_one_of,
    require_switch,
    require_whole,
)
from gearcad.core.output import staged_files
from gearcad.core.records import JsonObject, Notice, is_assumed
from gearcad.core.runtime import Progress
from gearcad.designs import (
    Design,
    DesignKind,
    GearDesign,
    Inputs,
    PairDesign,
    PlanetaryDesign,
    RackDesign,
    RackPairDesign,
    SplineDesign,
    ToothedDesign,
    TrainDesign,
)
from gearcad.designs.train_meshes import has_pairs
from gearcad.drawing.assembly_sheets import draw_pair, draw_train
from gearcad.drawing.drawing_subjects import DrawnGear, DrawnPair, DrawnTrain, Mate
from gearcad.drawing.dxf_export import sheet_document
from gearcad.drawing.gear_sheet import Drawing, DrawingSheet, draw_gear
from gearcad.drawing.mould_sheet import MOULD, draw_mould, is_moulded
from gearcad.drawing.options import SCALES, DrawingOptions, PartDrawing, SheetSize
from gearcad.drawing.page_export import unshown, write_pdf, write_svg
from gearcad.drawing.shaft_sheet import DrawnShaft, draw_shaft, draw_shafted_pair
from gearcad.drawing.tool_sheet import draw_tool
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.jobs import job_for
from gearcad.jobs.build import products_of, require_bodies, seated_shafts, shaft_alone
from gearcad.jobs.job import Job, Subject, Writer, as_design
from gearcad.jobs.train_bodies import gear_train_plan
from gearcad.load import Load
from gearcad.material import Material
from gearcad.planetary import TrainLoad
from gearcad.planetary.members import material_of
from gearcad.rating.options import RatingOptions
from gearcad.solids import FileOptions
from gearcad.solids.files.cutaway import Cutaway, SceneView
from gearcad.solids.files.gear_train_products import GearTrainProduct
from gearcad.solids.files.shot import Shot, loop_of
from gearcad.solids.files.studio import Animation
from gearcad.solids.shaft_plan import TurnedPlan
from gearcad.version import __version__

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

    from gearcad.designs import ShaftDesign
    from gearcad.solids.files.shot import Product


def drawn_gears(design: ToothedDesign) -> tuple[DrawnGear, ...]:
    """Return each gear or rack of a design, with those it engages with; of those of a train that are alike in all the first."""
    if isinstance(design, RackDesign):
        return (DrawnGear(role="rack", gear=design.rack, material=design.material),)
    if isinstance(design, GearDesign):
        return (_drawn_gear(design, "gear", design.gear, design.material),)
    if isinstance(design, RackPairDesign):
        return _of_pair(design, ("pinion", "rack"), design.pair)
    if isinstance(design, PairDesign):
        return _of_pair(design, ("pinion", "wheel"), design.pair)
    if isinstance(design, PlanetaryDesign):
        return tuple(_of_train(design))
    if isinstance(design, SplineDesign):
        parts = design.spline.parts.items()
        return tuple(DrawnGear(role=name, gear=part.gear, material=design.material, spline=part) for name, part in parts)
    raise NotImplementedError(type(design))


def drawn_assembly(design: ToothedDesign) -> DrawnPair | DrawnTrain | None:
    """Return the pair or train that the gears of a design make, or None for a single gear or rack."""
    if isinstance(design, PairDesign | RackPairDesign):
        first, second = drawn_gears(design)
        return DrawnPair(name=design.name, pair=design.pair, parts=(first, second), shafts=seated_shafts(design))
    if isinstance(design, PlanetaryDesign):
        return DrawnTrain(name=design.name, train=design.train, parts=tuple(_gears_of_train(design)))
    return None


def drawn_shafts(design: ToothedDesign) -> tuple[DrawnShaft, ...]:
    """Return the shafts of a pair, each to be drawn by itself."""
    return tuple(DrawnShaft.of(each) for each in seated_shafts(design))


def _of_pair(
    design: PairDesign | RackPairDesign, roles: tuple[str, str], pair: GearPair | RackPair
) -> tuple[DrawnGear, DrawnGear]:
    gears: tuple[Gear, Gear | Rack] = (pair.pinion, pair.wheel if isinstance(pair, GearPair) else pair.rack)
    materials = (None, None) if design.material is None else design.materials
    first, second = (
        _drawn_gear(design, role, gear, material, (_mate(design, other, mate, pair),))
        for role, gear, material, other, mate in zip(roles, gears, materials, roles[::-1], gears[::-1], strict=True)
    )
    return first, second


def _of_train(design: PlanetaryDesign) -> Iterator[DrawnGear]:
    """Yield the gears of a train that differ in more than their name and mates."""
    seen: list[tuple[object, ...]] = []
    for drawn in _gears_of_train(design):
        what = (replace(drawn.gear, name="any"), drawn.material, drawn.grade, design.drawings.get(drawn.role))
        if what not in seen:
            seen.append(what)
            yield drawn


def _gears_of_train(design: PlanetaryDesign) -> Iterator[DrawnGear]:
    """Yield all of them, by the names of members, rims, and gears of stages."""
    mates: dict[str, tuple[Mate, ...]] = {}
    meshes = [(mesh.pair, (mesh.central.name, mesh.rim.name)) for mesh in design.train.meshes]
    meshes += [(stage.pair, (stage.pair.pinion.name, stage.pair.wheel.name)) for stage in design.train.stages]
    gears = design.train.gears
    for pair, (first, second) in meshes:
        for name, other in ((first, second), (second, first)):
            mates[name] = (*mates.get(name, ()), _mate(design, other, gears[other], pair))
    for name, gear in gears.items():
        material = None if design.material is None else material_of(design.material, name)
        yield _drawn_gear(design, name, gear, material, mates[name])


def _mate(design: ToothedDesign, name: str, gear: Gear | Rack, pair: GearPair | RackPair) -> Mate:
    own = design.drawings.get(name)
    return Mate(name=name, number=own.number or "" if own is not None else "", gear=gear, pair=pair)


def _drawn_gear(
    design: ToothedDesign, role: str, gear: Gear | Rack, material: Material | None, mates: tuple[Mate, ...] = ()
) -> DrawnGear:
    """Return a gear or rack to draw, with its accuracy grade: its own, otherwise the one given for its rating."""
    rating: RatingOptions | None = getattr(design, "rating", None)
    grade = gear.accuracy_grade if isinstance(gear, Gear) else None
    if grade is None and rating is not None and not is_assumed(rating.accuracy_grade):
        grade = rating.accuracy_grade
    accuracy = (rating or RatingOptions()).accuracy
    return DrawnGear(role=role, gear=gear, material=material, accuracy=accuracy, grade=grade, mates=mates)


Drawn = TypeVar("Drawn", DrawingOptions, PartDrawing)

ASSEMBLY = "assembly"

_STEM = "drawing"
"""First part of the file names of drawings."""


class SheetFormat(Enum):
    """File format of sheets; the value is the suffix of file names."""

    DXF = "dxf"
    SVG = "svg"
    PDF = "pdf"


_ALL = tuple(SheetFormat)
_OF_ONE = {SheetFormat.DXF: write_dxf, SheetFormat.SVG: write_svg}


@dataclass(frozen=True, kw_only=True)
class Draw(Job[ToothedDesign, Drawing]):
    """The sheets of a design, in the `formats`; what is `given` of its options by their names wins over those in [drawing].

    The files of a single gear are `drawing.pdf` and so on; of a design with more gears `drawing-pinion.pdf` and its like, and
    `drawing.pdf` has all sheets as pages. A gear that is moulded has a second sheet, `drawing-gear-mould.pdf` and so on, of its
    cavity. `what` is "parts", or "tool" for the tools of gears and racks: `drawing-pinion-tool.pdf`. Raises ParameterError.
    """

    verb = "draw"
    accepts = (
        *(DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK, DesignKind.RACK_PAIR, DesignKind.PLANETARY, DesignKind.SPLINE),
        DesignKind.SHAFT,
    )
    why = "there are no teeth"
    with_shafts = True

    formats: tuple[SheetFormat, ...] = _ALL
    given: Mapping[str, Any] = field(default_factory=dict)
    what: str = "parts"

    def __post_init__(self) -> None:
        object.__setattr__(self, "formats", _formats(self.formats))
        require_one_of("what", self.what, ("parts", "tool"))
        overridden(DrawingOptions(), self.given)

    def run(self, design: Design, progress: Progress | None = None) -> Drawing:
        design = self.accepted(design, progress)
        sheets = tuple(self._sheets(design))
        if SheetFormat.PDF in self.formats:
            sheets = tuple(replace(sheet, notices=(*sheet.notices, *unshown(sheet.figure))) for sheet in sheets)
        return Drawing(name=design.name, sheets=sheets)

    def _sheets(self, design: ToothedDesign) -> Iterator[DrawingSheet]:
        """Yield the sheet of the assembly, then those of the gears and of shafts. Raises InputError."""
        if design.kind is DesignKind.SHAFT:
            yield self._of_shaft(cast("ShaftDesign", design))
            return
        gears, assembly = drawn_gears(design), drawn_assembly(design)
        options = overridden(design.drawing or DrawingOptions(), self.given)
        if self.what == "tool":
            for gear in gears:
                yield draw_tool(gear, options)
            return
        own = {name: overridden(part, self.given) for name, part in design.drawings.items()}
        shafts = drawn_shafts(design)
        names = [*([] if assembly is None else [ASSEMBLY]), *(gear.role for gear in gears), *(each.name for each in shafts)]
        if len(set(names)) < len(names):
            raise ParameterError("name", ASSEMBLY, "must be another word: the sheet of all gears has this name")
        if assembly is not None:
            with _blaming(ASSEMBLY):
                yield _assembled(assembly, options, own)
        for gear in gears:
            alone = len(names) == 1
            with _blaming("" if alone else gear.role):
                yield draw_gear(gear, options, own.get(gear.role), alone=alone)
                if is_moulded(gear):
                    yield draw_mould(gear, options, own.get(gear.role), alone=alone)
        for shaft in shafts:
            with _blaming(shaft.name):
                yield draw_shaft(shaft, options, own.get(shaft.name))

    def _of_shaft(self, design: ShaftDesign) -> DrawingSheet:
        """Return the sheet of a shaft by itself. Raises InputError."""
        if self.what != "parts":
            raise GeometryError("what", self.what, "needs teeth that are cut: a shaft by itself has none")
        drawn = DrawnShaft(name="shaft", plan=TurnedPlan(design.shaft), title=design.name)
        return draw_shaft(drawn, overridden(design.drawing or DrawingOptions(), self.given))

    def document(self, result: Drawing) -> JsonObject:
        """Return the content of draw.json: the files of each sheet, and the unrounded values of the numbers on it."""
        sheets = [
            {
                "name": sheet.name,
                "title": sheet.title,
                "number": sheet.number,
                "size": paper_of(sheet),
                "scale": scale_of(sheet),
                "files": [name for name, pages in self._pages(result).items() if any(page is sheet for page in pages)],
                "numbers": dict(sheet.shown),
            }
            for sheet in result.sheets
        ]
        head = {"kind": self.verb, "name": result.name, "gearcad": __version__}
        return {**head, "sheets": sheets, "notices": [notice.to_dict() for notice in result.notices]}

    def notices(self, result: Drawing) -> Sequence[Notice]:
        return result.notices

    def figures(self, document: JsonObject) -> JsonObject:
        """Return the number of sheets, and the notices about them as warnings."""
        notices = (Notice(**each) for each in document["notices"])
        return {"sheets": len(document["sheets"]), "warnings": [str(each) for each in notices]}

    def _pages(self, result: Drawing) -> dict[str, tuple[DrawingSheet, ...]]:
        """Return the names of files, and the sheets in each."""
        moulds = [sheet for sheet in result.sheets if sheet.name.endswith(f"-{MOULD}")]
        alone = len(result.sheets) - len(moulds) == 1 and self.what == "parts"
        found = {
            f"{_STEM if alone and sheet not in moulds else f'{_STEM}-{sheet.name}'}.{kind.value}": (sheet,)
            for sheet in result.sheets
            for kind in self.formats
        }
        return found | ({f"{_STEM}.pdf": result.sheets} if SheetFormat.PDF in self.formats else {})

    def files(self, result: Drawing) -> dict[str, Writer]:
        """Return the writers of all files: each sheet, then all sheets as one PDF, then the document."""
        made: dict[str, Document] = {}
        found = {name: partial(_write, pages, made) for name, pages in self._pages(result).items()}
        return {**found, f"{self.verb}.json": partial(self.write_document, result)}

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """All files together."""
        what = {} if self.what == "parts" else {"what": self.what}
        return {self.verb: {"formats": [kind.value for kind in self.formats], **what, **self.given}}

    def part_of(self, file: str) -> str:
        """Every file is of the drawing."""
        return self.verb


def overridden(options: Drawn, given: Mapping[str, Any]) -> Drawn:
    """Return the options with the given values in place. Raises ParameterError for keys that no drawing has."""
    if unknown := set(given) - {each.name for each in fields(DrawingOptions)}:
        raise ParameterError(min(unknown), given[min(unknown)], "is not an option of drawings")
    known = {each.name for each in fields(options)}
    return replace(options, **{name: value for name, value in given.items() if name in known})


def _assembled(assembly: DrawnPair | DrawnTrain, options: DrawingOptions, own: Mapping[str, PartDrawing]) -> DrawingSheet:
    if isinstance(assembly, DrawnPair):
        sheet = (draw_shafted_pair if assembly.shafts else draw_pair)(assembly, options, own)
    else:
        sheet = draw_train(assembly, options, own)
    return replace(sheet, number=options.number)


@contextmanager
def _blaming(name: str) -> Iterator[None]:
    """Add the name of a sheet to an InputError raised in this context."""
    try:
        yield
    except InputError as error:
        raise (error.within(name) if name else error) from None


def _formats(given: object) -> tuple[SheetFormat, ...]:
    """Formats by themselves or by their names, each once. Raises ParameterError."""
    if isinstance(given, str) or not isinstance(given, Iterable) or not (found := list(given)):
        raise ParameterError("formats", given, 'must be a list of formats, such as ["dxf", "pdf"]')
    return tuple(dict.fromkeys(as_choice("format", each, SheetFormat) for each in found))


def _write(pages: tuple[DrawingSheet, ...], made: dict[str, Document], path: Path) -> None:
    """Write a file with these sheets, in the format of its name; documents are `made` once for all files."""
    for sheet in pages:
        if sheet.name not in made:
            made[sheet.name] = sheet_document(sheet.figure, sheet.size, sheet.scale, title=sheet.title, language=sheet.language)
    kind, documents = SheetFormat(path.suffix.removeprefix(".")), [made[sheet.name] for sheet in pages]
    if kind is SheetFormat.PDF:
        write_pdf(documents, path)
    else:
        _OF_ONE[kind](documents[0], path)


def paper_of(sheet: DrawingSheet) -> str:
    """ "A3", or what its sides are."""
    sizes = {kind.size: kind.value for kind in SheetSize if kind is not SheetSize.AUTO}
    return sizes.get(sheet.size, "{:g} x {:g}".format(*sheet.size))


def scale_of(sheet: DrawingSheet) -> str:
    return next((name for name, factor in SCALES.items() if factor == sheet.scale), f"{sheet.scale:g}:1")


def draw(
    subject: Subject,
    load: Load | TrainLoad | None = None,
    *,
    sheet: str | None = None,
    scale: str | None = None,
    language: str | None = None,
    projection: str | None = None,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> Drawing:
    """Draw gears, racks, pairs and trains: a sheet of each gear that differs, and one of what they make together.

    `sheet` is "A4" to "A0", or "auto" for the smallest that has room; `scale` one of ISO 5455 such as "1:2", or "auto";
    `language` "en", "de" or "sv"; `projection` "first" or "third". What is None is as in `drawing` (DrawingOptions). Files are
    written by `gearcad.jobs.draw.Draw().write(result, folder)`.

    >>> from gearcad import Gear
    >>> drawing = draw(Gear(teeth=20, normal_module=2, face_width=20), sheet="A3")
    >>> [(sheet.name, sheet.size, sheet.scale) for sheet in drawing.sheets]
    [('gear', (420.0, 297.0), 2.0)]

    Raises ParameterError, also where a sheet or scale that is asked for has no room.
    """
    asked = {"sheet": sheet, "scale": scale, "language": language, "projection": projection}
    job = Draw(given={name: value for name, value in asked.items() if value is not None})
    design = as_design(subject, load, **inputs)
    return job_for(job, design).run(design, progress)


STILL_SIZE, TURNING_SIZE = (1600, 1200), (800, 600)
"""Width and height in pixels where none are given."""

_LEAST, _MOST = 16, 8000
"""Least and largest width and height (pixels) of a picture."""

_MOST_PIXELS, _MOST_IN_ALL = 16_000_000, 250_000_000
"""Greatest number of pixels of a picture (some 60 bytes each), and of all frames, which are held until the file is written."""

_FINE = 0.001
"""Largest error of the facets in normal modules: less than a pixel where a mesh fills the picture."""


class Background(Enum):
    """Background of a picture."""

    WHITE = "white"
    TRANSPARENT = "transparent"


@dataclass(frozen=True)
class PictureShot:
    """A design, and the shot that is taken of it."""

    design: ToothedDesign | TrainDesign
    shot: Shot


@dataclass(frozen=True, kw_only=True)
class Picture(Job[ToothedDesign, PictureShot]):
    """`picture.png` of a design, or `picture.gif` and so on of one that turns, and picture.json, which says what is on it.

    Raises ParameterError for a size that no picture can have.
    """

    verb = "picture"
    accepts = (
        *(DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK, DesignKind.RACK_PAIR, DesignKind.PLANETARY),
        DesignKind.SHAFT,
    )
    why = "there are no teeth"
    with_shafts = True
    writes_long = True

    view: SceneView = SceneView.CORNER
    size: tuple[int, int] | None = None
    cutaway: Cutaway | None = None
    explode: bool = False
    turning: Animation | None = None
    background: Background = Background.WHITE

    def __post_init__(self) -> None:
        require_switch("explode", self.explode)
        if self.size is not None:
            if not isinstance(self.size, tuple | list) or len(self.size) != 2:
                raise ParameterError("size", self.size, "must be width and height in pixels, such as (800, 600)")
            for name, value in zip(("width", "height"), self.size, strict=True):
                require_whole(f"size.{name}", value, at_least=_LEAST, at_most=_MOST)
            self._require_memory(1)

    def run(self, design: Design, progress: Progress | None = None) -> PictureShot:
        if isinstance(design, TrainDesign) and has_pairs(design):
            return self._of_train(design)
        design = self.accepted(design, progress)
        self._require_parts(design)
        options = FileOptions(
            chord_error=_FINE * _module_of(design), exploded=self.explode and isinstance(design, PlanetaryDesign)
        )
        require_bodies(design, options)
        product = _pictured(design, options)
        loop = loop_of(product, self.view) if self.turning else None
        self._require_memory(loop.frames if loop else 1)
        shot = Shot(
            product=product,
            view=self.view,
            size=self.pixels,
            cutaway=self.cutaway,
            exploded=self.explode,
            transparent=self.background is Background.TRANSPARENT,
            loop=loop,
        )
        return PictureShot(design, shot)

    def _of_train(self, design: TrainDesign) -> PictureShot:
        """Return the shot of a train of pairs, still. Raises GeometryError for one that is to turn or to be moved apart."""
        for name, asked in (("explode", self.explode), ("turning", self.turning is not None)):
            if asked:
                raise GeometryError(name, True, "needs a gear, a pair or a planetary train: a train of pairs is shown in mesh")
        plan = gear_train_plan(design)
        module = min(each.gear.normal_module for each in plan.gears)
        product = GearTrainProduct(plan, FileOptions(chord_error=_FINE * module))
        shot = Shot(
            product=product,
            view=self.view,
            size=self.pixels,
            cutaway=self.cutaway,
            transparent=self.background is Background.TRANSPARENT,
        )
        return PictureShot(design, shot)

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height."""
        return self.size or (TURNING_SIZE if self.turning else STILL_SIZE)

    @property
    def file(self) -> str:
        """The name of the image."""
        return f"picture.{self.turning.value if self.turning else 'png'}"

    def _require_parts(self, design: ToothedDesign) -> None:
        """Raise GeometryError for what a single part cannot show."""
        if getattr(design, "assembly", None) is not None or isinstance(design, PlanetaryDesign):
            return
        if self.explode:
            raise GeometryError("explode", True, "needs a pair or a train: there is only one part")
        if self.view is SceneView.MESH:
            raise GeometryError("view", self.view, "needs a pair or a train: one part has no mesh")

    def _require_memory(self, frames: int) -> None:
        width, height = self.pixels
        most, words = (_MOST_IN_ALL, f" in all {frames} frames") if frames > 1 else (_MOST_PIXELS, "")
        if width * height * frames > most:
            raise ParameterError("size", f"{width}x{height}", f"must be at most {most / 1e6:.0f} million pixels{words}")

    def document(self, result: PictureShot) -> JsonObject:
        """Return the content of picture.json."""
        loop = result.shot.loop
        turning = loop and {
            "frames": loop.frames,
            "seconds": loop.seconds,
            "pitches": float(loop.pitches),
            "closes": loop.closes,
            "turns": loop.turns,
        }
        return {
            "kind": self.verb,
            "name": result.design.name,
            "gearcad": __version__,
            "file": self.file,
            "view": self.view.value,
            "size": list(self.pixels),
            "background": self.background.value,
            "cutaway": self.cutaway and self.cutaway.value,
            "exploded": self.explode,
            "turning": turning,
            "notices": [notice.to_dict() for notice in self.notices(result)],
        }

    def notices(self, result: PictureShot) -> Sequence[Notice]:
        found = result.shot.loop.notices if result.shot.loop else ()
        return (*found, *result.shot.product.plan.notices) if isinstance(result.shot.product, GearTrainProduct) else found

    def files(self, result: PictureShot) -> dict[str, Writer]:
        """Return the image and the document."""
        return {self.file: self.writer(result), "picture.json": partial(self.write_document, result)}

    def writer(self, result: PictureShot) -> Writer:
        """Return the writer of the image."""
        return partial(result.shot.write_animation, self.turning) if self.turning else result.shot.write_png

    def write_image(self, result: PictureShot, path: Path) -> None:
        """Write the image alone. Raises ParameterError for a suffix of another format, OutputError."""
        suffixes = {".png", ".apng"} if self.turning is Animation.APNG else {Path(self.file).suffix}
        if path.suffix.lower() not in suffixes:
            raise ParameterError("output", str(path), f"must end in {' or '.join(sorted(suffixes))}")
        with staged_files(path.parent) as staging:
            self.writer(result)(staging / path.name)

    def part_of(self, file: str) -> str:
        """Image and document."""
        return self.verb if file in (self.file, "picture.json") else ""


def _pictured(design: ToothedDesign, options: FileOptions) -> Product:
    """Return what a picture shows: what parts make together, or the only part."""
    if design.kind is DesignKind.SHAFT:
        return shaft_alone(design, options)
    parts, assembly = products_of(design, options)
    return cast("Product", assembly or next(iter(parts.values())))  # a spline is not accepted


_SHAFT_MODULE = 0.1
"""Share of the largest diameter of a shaft by itself that stands for a module."""


def _module_of(design: ToothedDesign) -> float:
    """Return the least normal module (mm) of a design, of a shaft by itself what stands for it."""
    if design.kind is DesignKind.SHAFT:
        return _SHAFT_MODULE * TurnedPlan(cast("ShaftDesign", design).shaft).largest
    return min(float(each.normal_module) for each in _toothed(design))


def _toothed(design: ToothedDesign) -> list[Any]:
    """Return the gears and racks of a design."""
    racks = [design.rack] if isinstance(design, RackDesign) else []
    return [*design.gears.values(), *racks]


def picture(
    subject: Subject,
    file: Path | str,
    *,
    view: SceneView | str = SceneView.CORNER,
    size: tuple[int, int] | None = None,
    cutaway: Cutaway | str | None = None,
    explode: bool = False,
    turning: Animation | str | None = None,
    background: Background | str = Background.WHITE,
) -> Path:
    """Write a picture of a gear, rack, pair or train as PNG, or turning as "gif", "apng" or "webp", and return its path.

    `view` is "corner", "front" (along the axes), "side" (from the right), "top" or "mesh" (close by, where teeth mesh).
    `size` is width and height in pixels. `cutaway` takes off a "quarter" or "half" of each part, `explode` moves parts apart.
    A picture that turns is a loop of whole tooth pitches, after which all looks as at first. `background`: "white" or
    "transparent". Raises ParameterError, GeometryError, OutputError where there is no OpenGL.
    """
    job = Picture(
        view=as_choice("view", view, SceneView),
        size=size,
        cutaway=None if cutaway is None else as_choice("cutaway", cutaway, Cutaway),
        explode=explode,
        turning=None if turning is None else as_choice("turning", turning, Animation),
        background=as_choice("background", background, Background),
    )
    path = as_path("file", file)
    job.write_image(job.run(as_design(subject)), path)
    return path
