"""Draw: sheets for the workshop - one of each gear, one of what they make - as DXF, SVG and PDF."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from enum import Enum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, Unpack

from gearcad.designs import DesignKind, Inputs, ToothedDesign
from gearcad.drawing.files import sheet_document, unshown, write_dxf, write_pdf, write_svg
from gearcad.drawing.options import SCALES, DrawingOptions, PartDrawing, SheetSize
from gearcad.drawing.sheets import Drawing, Sheet, draw_gear, draw_pair, draw_train
from gearcad.drawing.subject import DrawnPair, DrawnTrain
from gearcad.errors import InputError, ParameterError, as_choice
from gearcad.jobs.drawn import drawn_assembly, drawn_gears
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.subject import Subject, as_design
from gearcad.load import Load
from gearcad.notice import Notice
from gearcad.planetary import TrainLoad
from gearcad.progress import Progress
from gearcad.version import __version__

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document

__all__ = ["Draw", "SheetFormat", "draw", "paper_of", "scale_of"]

Drawn = TypeVar("Drawn", DrawingOptions, PartDrawing)

ASSEMBLY = "assembly"

_STEM = "drawing"
"""With what the names of files begin."""


class SheetFormat(Enum):
    """What sheets are written as; the value is the end of the names of files."""

    DXF = "dxf"
    SVG = "svg"
    PDF = "pdf"


_ALL = tuple(SheetFormat)
_OF_ONE = {SheetFormat.DXF: write_dxf, SheetFormat.SVG: write_svg}


@dataclass(frozen=True, kw_only=True)
class Draw(Job[ToothedDesign, Drawing]):
    """The sheets of a design, in the `formats`; what is `given` of its options by their names wins over those in [drawing].

    The files of a single gear are `drawing.pdf` and so on; of a design with more gears `drawing-pinion.pdf` and its like, and
    `drawing.pdf` has all sheets as pages. Raises ParameterError.
    """

    verb = "draw"
    accepts = (DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK, DesignKind.RACK_PAIR, DesignKind.PLANETARY)
    why = "there are no teeth"
    solves = False

    formats: tuple[SheetFormat, ...] = _ALL
    given: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "formats", _formats(self.formats))
        overridden(DrawingOptions(), self.given)

    def _run(self, design: ToothedDesign, _progress: Progress | None) -> Drawing:
        sheets = tuple(self._sheets(design))
        if SheetFormat.PDF in self.formats:
            sheets = tuple(replace(sheet, notices=(*sheet.notices, *unshown(sheet.figure))) for sheet in sheets)
        return Drawing(name=design.name, sheets=sheets)

    def _sheets(self, design: ToothedDesign) -> Iterator[Sheet]:
        """That of the assembly, then those of the gears."""
        gears, assembly = drawn_gears(design), drawn_assembly(design)
        options = overridden(design.drawing or DrawingOptions(), self.given)
        own = {name: overridden(part, self.given) for name, part in design.drawings.items()}
        names = [*([] if assembly is None else [ASSEMBLY]), *(gear.role for gear in gears)]
        if len(set(names)) < len(names):
            raise ParameterError("name", ASSEMBLY, "must be another word: the sheet of all gears has this name")
        if assembly is not None:
            with _blaming(ASSEMBLY):
                yield _assembled(assembly, options, own)
        for gear in gears:
            with _blaming("" if assembly is None else gear.role):
                yield draw_gear(gear, options, own.get(gear.role), alone=assembly is None)

    def document(self, result: Drawing) -> dict[str, Any]:
        """What draw.json holds: of each sheet its files, and the exact values of the numbers on it."""
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

    def figures(self, document: dict[str, Any]) -> dict[str, Any]:
        """How many sheets there are, and what to know of them."""
        notices = (Notice(**each) for each in document["notices"])
        return {"sheets": len(document["sheets"]), "warnings": [str(each) for each in notices]}

    def _pages(self, result: Drawing) -> dict[str, tuple[Sheet, ...]]:
        """Names of files, and the sheets in each."""
        alone = len(result.sheets) == 1
        found = {
            f"{_STEM if alone else f'{_STEM}-{sheet.name}'}.{kind.value}": (sheet,)
            for sheet in result.sheets
            for kind in self.formats
        }
        return found | ({f"{_STEM}.pdf": result.sheets} if SheetFormat.PDF in self.formats else {})

    def files(self, result: Drawing) -> dict[str, Writer]:
        """Those of each sheet, all of them as one PDF, then the document."""
        made: dict[str, Document] = {}
        found = {name: partial(_write, pages, made) for name, pages in self._pages(result).items()}
        return {**found, f"{self.verb}.json": partial(self.write_document, result)}

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """All files together."""
        return {self.verb: {"formats": [kind.value for kind in self.formats], **self.given}}

    def part_of(self, file: str) -> str:
        """Every file is of the drawing."""
        return self.verb


def overridden(options: Drawn, given: Mapping[str, Any]) -> Drawn:
    """Options with what is given in their place. Raises ParameterError for what no drawing has."""
    if unknown := set(given) - {each.name for each in fields(DrawingOptions)}:
        raise ParameterError(min(unknown), given[min(unknown)], "is nothing that drawings have")
    known = {each.name for each in fields(options)}
    return replace(options, **{name: value for name, value in given.items() if name in known})


def _assembled(assembly: DrawnPair | DrawnTrain, options: DrawingOptions, own: Mapping[str, PartDrawing]) -> Sheet:
    sheet = draw_pair(assembly, options, own) if isinstance(assembly, DrawnPair) else draw_train(assembly, options, own)
    return replace(sheet, number=options.number)


@contextmanager
def _blaming(name: str) -> Iterator[None]:
    """Of which sheet an error is. Raises InputError."""
    try:
        yield
    except InputError as error:
        raise (error.within(name) if name else error) from None


def _formats(given: object) -> tuple[SheetFormat, ...]:
    """Formats by themselves or by their names, each once. Raises ParameterError."""
    if isinstance(given, str) or not isinstance(given, Iterable) or not (found := list(given)):
        raise ParameterError("formats", given, 'must be a list of formats, such as ["dxf", "pdf"]')
    return tuple(dict.fromkeys(as_choice("format", each, SheetFormat) for each in found))


def _write(pages: tuple[Sheet, ...], made: dict[str, Document], path: Path) -> None:
    """Write a file with these sheets, in the format of its name; documents are `made` once for all files."""
    for sheet in pages:
        if sheet.name not in made:
            made[sheet.name] = sheet_document(sheet.figure, sheet.size, sheet.scale, title=sheet.title, language=sheet.language)
    kind, documents = SheetFormat(path.suffix.removeprefix(".")), [made[sheet.name] for sheet in pages]
    if kind is SheetFormat.PDF:
        write_pdf(documents, path)
    else:
        _OF_ONE[kind](documents[0], path)


def paper_of(sheet: Sheet) -> str:
    """ "A3", or what its sides are."""
    sizes = {kind.size: kind.value for kind in SheetSize if kind is not SheetSize.AUTO}
    return sizes.get(sheet.size, "{:g} x {:g}".format(*sheet.size))


def scale_of(sheet: Sheet) -> str:
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
    return job.run(as_design(subject, load, **inputs), progress)
