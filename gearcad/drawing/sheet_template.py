"""Templates of sheet frames and title blocks: the shipped one, and a company's own over it. Lengths in mm of paper."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache
from pathlib import Path
from string import Formatter
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeVar

from gearcad.core.errors import ParameterError, SpecError, printable, shown, shown_path
from gearcad.core.output import file_bytes
from gearcad.core.quantities import Choice, Range, Whole, require_fields, schema_of
from gearcad.core.runtime import templates
from gearcad.drawing.options import one_line
from gearcad.drawing.shapes import Box
from gearcad.drawing.words import Language, SheetWords

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


_MM = Range("mm", 0.0, 1e3)
_EDGE = Range("mm", 0.0, 60.0)
_SOME = Range("mm", 5.0, 1e3)
_TEXT = Range("mm", 1.0, 20.0)
"""Permitted heights (mm) of letters."""

LEAST = 2.0
"""Height of the smallest letters that values are written with."""

VALUES = (
    "number",
    "title",
    "supplementary_title",
    "owner",
    "department",
    "technical_reference",
    "creator",
    "approver",
    "document_type",
    "status",
    "classification",
    "revision",
    "date",
    "language",
    "scale",
    "size",
    "sheet",
    "sheets",
    "general_tolerance",
    "material",
    "heat_treatment",
    "mass",
)
"""Names that the value of a cell may have in braces."""

CAPTION_TOP = 1.0
"""Distance from the top of a cell to its caption."""

_CAPTION_AIR = 0.7
"""Distance between the caption and the value of a cell."""

_AIR = 0.65
"""Least distance of a value from the bottom of its cell."""

_BELOW = 0.33
"""Reach of letters below their line, over their height."""

_IN_BRACES = re.compile(r"\{([^{}]*)\}")


@dataclass(frozen=True, kw_only=True)
class FrameSizes:
    """Sizes of the frame (mm): margins, and the strip with letters and numbers."""

    binding_margin: Annotated[float, _EDGE]
    margin: Annotated[float, _EDGE]
    grid_width: Annotated[float, _EDGE]
    grid_pitch: Annotated[float, Range("mm", 20.0, 200.0)]
    grid_text: Annotated[float, _TEXT]
    centring: Annotated[float, _EDGE]

    def __post_init__(self) -> None:
        require_fields(self)
        if self.grid_width > min(self.margin, self.binding_margin):
            raise ParameterError(
                "grid_width",
                self.grid_width,
                f"must be at most {min(self.margin, self.binding_margin):g}: the grid lies in both margins",
                "mm",
            )
        if self.grid_text > self.grid_width > 0:
            raise ParameterError("grid_text", self.grid_text, f"must be at most grid_width, {self.grid_width:g}", "mm")


@dataclass(frozen=True, kw_only=True)
class TitleSizes:
    """Sizes of the title block as a whole (mm)."""

    width: Annotated[float, _SOME]
    height: Annotated[float, _SOME]
    caption: Annotated[float, _TEXT]


@dataclass(frozen=True, kw_only=True)
class TitleCell:
    """A cell of the title block, placed by its lower left corner (mm); without `caption` it has the caption of its name."""

    left: Annotated[float, _MM]
    bottom: Annotated[float, _MM]
    width: Annotated[float, _SOME]
    height: Annotated[float, _SOME]
    caption: str | None = None
    value: str = ""
    text: Annotated[float, _TEXT] = 3.5
    symbol: Annotated[str, Choice(("", "projection"))] = ""

    @property
    def value_bottom(self) -> float:
        """Lowest height (mm) of the value's text line, below which letters still reach."""
        return self.bottom + _AIR + _BELOW * self.text

    def value_top(self, caption: float) -> float:
        """Return the greatest height (mm) of the value, below a caption of this text height (mm)."""
        return self.bottom + self.height - CAPTION_TOP - (0.0 if self.caption == "" else caption + _CAPTION_AIR)

    @property
    def box(self) -> Box:
        """Box of the cell in the title block (mm)."""
        return Box(self.left, self.bottom, self.left + self.width, self.bottom + self.height)

    def filled(self, values: Mapping[str, str]) -> str:
        """Return the value of the cell with the names in braces replaced by `values`."""
        return " ".join(_IN_BRACES.sub(lambda found: values.get(found[1], ""), self.value).split())

    @property
    def names(self) -> list[str]:
        """Names in braces in the value of the cell."""
        return _IN_BRACES.findall(self.value)


@dataclass(frozen=True, kw_only=True)
class DataTableSizes:
    """Sizes of the gear data table (mm): columns, rows and text."""

    words: Annotated[float, _SOME]
    symbol: Annotated[float, _SOME]
    value: Annotated[float, _SOME]
    heading: Annotated[float, _SOME]
    row: Annotated[float, _SOME]
    least_row: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]

    @property
    def columns(self) -> tuple[float, float, float]:
        return self.words, self.symbol, self.value

    @property
    def width(self) -> float:
        return sum(self.columns)

    def narrowed(self, width: float) -> DataTableSizes:
        """Return the sizes with columns that have this width (mm) together."""
        part = width / self.width
        return replace(self, words=part * self.words, symbol=part * self.symbol, value=part * self.value)


@dataclass(frozen=True, kw_only=True)
class PartsListSizes:
    """Sizes of the parts list (mm): columns, rows and text."""

    item: Annotated[float, _SOME]
    quantity: Annotated[float, _SOME]
    number: Annotated[float, _SOME]
    title: Annotated[float, _SOME]
    material: Annotated[float, _SOME]
    remarks: Annotated[float, _SOME]
    row: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]

    @property
    def columns(self) -> tuple[float, ...]:
        return self.item, self.quantity, self.number, self.title, self.material, self.remarks


@dataclass(frozen=True, kw_only=True)
class RevisionSizes:
    """Sizes of the table of revisions (mm): columns, rows and text; `most` is the greatest number of revisions."""

    index: Annotated[float, _SOME]
    text_width: Annotated[float, _SOME]
    date: Annotated[float, _SOME]
    name: Annotated[float, _SOME]
    row: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]
    most: Annotated[int, Whole(1, 100)]

    @property
    def columns(self) -> tuple[float, ...]:
        return self.index, self.text_width, self.date, self.name


@dataclass(frozen=True, kw_only=True)
class NoteSizes:
    """Sizes of the notes (mm): width, text, and distance of lines."""

    width: Annotated[float, _SOME]
    text: Annotated[float, _TEXT]
    pitch: Annotated[float, _TEXT]


_FILE = "drawing_title.toml"
_CELLS = "title.cells"

_AROUND = 2.0
"""Least difference (mm) between the height of a row and of its letters."""

Part = TypeVar("Part")

_PARTS: dict[str, type[Any]] = {
    "frame": FrameSizes,
    "title": TitleSizes,
    "data_table": DataTableSizes,
    "parts_list": PartsListSizes,
    "revisions": RevisionSizes,
    "notes": NoteSizes,
}


def _no_words() -> dict[str, dict[str, str]]:
    return {each.value: {} for each in Language}


@cache
def _shipped() -> dict[str, Any]:
    """Return the content of the shipped template, which is not to be changed."""
    return tomllib.loads((templates() / _FILE).read_text(encoding="utf-8"))


@dataclass(frozen=True, kw_only=True)
class SheetTemplate:
    """Sizes of a sheet's frame and tables, the cells of its title block by their names, and words that replace the shipped
    ones.
    """

    frame: FrameSizes
    title: TitleSizes
    cells: Mapping[str, TitleCell]
    data_table: DataTableSizes
    parts_list: PartsListSizes
    revisions: RevisionSizes
    notes: NoteSizes
    other_words: Mapping[str, Mapping[str, str]] = field(default_factory=_no_words, repr=False)

    @classmethod
    def of(cls, file: str | None) -> Self:
        """Return the shipped template, with its entries replaced by those of a file. Raises SpecError that names file and
        key.
        """
        shipped = _shipped()
        if file is None:
            return cls._made(shipped)
        own = _read(file)
        try:
            words = _words(own.pop("words", {}))
            return replace(cls._made(_merged(shipped, own)), other_words=words)
        except ParameterError as error:
            raise SpecError(f"{printable(file)}: {error}", error.parameter) from error

    @classmethod
    def _made(cls, content: Mapping[str, Any]) -> Self:
        made = {
            name: _part(kind, {key: value for key, value in content[name].items() if key != "cells"}, name)
            for name, kind in _PARTS.items()
        }
        return cls(cells=_cells(content["title"]["cells"], made["title"]), **made)

    def words(self, language: Language) -> SheetWords:
        """Return the words of a language, with the company's own words in their place."""
        words = SheetWords.of(language)
        return replace(words, labels={**words.labels, **self.other_words[language.value]})


# ---------------------------------------------------------------------- a company's own


def _read(file: str) -> dict[str, Any]:
    """Return the content of a company's template file. Raises SpecError."""
    try:
        return tomllib.loads(file_bytes(Path(file)).decode("utf-8-sig"))
    except OSError as error:
        raise SpecError(f"{shown_path(file)}: cannot be read ({error.strerror}); it is the template of [drawing]") from error
    except (ValueError, RecursionError) as error:  # what is no TOML, no UTF-8, or no name of a file
        reason = " ".join(str(error).split()) or "too deep"
        raise SpecError(f"{printable(file)}: is not valid TOML: {shown(reason)}") from error


def _merged(shipped: Mapping[str, Any], own: Mapping[str, Any], inside: str = "") -> dict[str, Any]:
    """Return the shipped content with the company's own in its place, table by table. Cells may be new, or false for none.
    Raises ParameterError.
    """
    merged, cells = dict(shipped), inside == _CELLS
    for key, value in own.items():
        where = f"{inside}.{key}" if inside else key
        if key not in shipped and not cells:
            raise ParameterError(
                where, value, f"unknown key; {_nearest(key, tuple(shipped) if inside else (*shipped, 'words'))}"
            )
        former = shipped.get(key, {})
        if not isinstance(former, Mapping):
            merged[key] = value
        elif isinstance(value, Mapping):
            merged[key] = {**former, **value} if cells else _merged(former, value, where)
        elif cells and value is False:
            merged.pop(key, None)
        else:
            raise ParameterError(where, value, "must be a table" + (", or false for none" if cells else ""))
    return merged


def _nearest(key: str, known: tuple[str, ...]) -> str:
    near = difflib.get_close_matches(key, known, n=1)
    return f"did you mean {near[0]}?" if near else f"permitted are {', '.join(known)}"


# ---------------------------------------------------------------------- what is permitted


def _part(kind: type[Part], content: Mapping[str, Any], where: str) -> Part:
    """Return a part of the template, of class `kind`. Raises ParameterError."""
    known = [each.name for each in fields(_dataclass(kind))]
    for key, value in content.items():
        if key not in known:
            raise ParameterError(f"{where}.{key}", value, f"unknown key; {_nearest(key, tuple(known))}")
    for key, each in schema_of(_dataclass(kind)).items():
        if each.required and key not in content:
            raise ParameterError(f"{where}.{key}", None, "must be given, in mm")
        if each.members[0] is str and key in content:
            one_line(f"{where}.{key}", content[key])
    try:
        made = kind(**content)
        require_fields(made)
    except ParameterError as error:
        raise ParameterError(f"{where}.{error.parameter}", error.value, error.permitted, error.unit) from None
    for row in ("row", "least_row", "heading"):
        if row in known and content[row] < content["text"] + _AROUND:
            raise ParameterError(f"{where}.{row}", content[row], f"must be {_AROUND:g} mm more than text at least", "mm")
    return made


def _dataclass(kind: type[Any]) -> type[DataclassInstance]:
    return kind


def _cells(content: Mapping[str, Any], title: TitleSizes) -> dict[str, TitleCell]:
    """Return the cells by name, within the title block, none over another, with known values only. Raises ParameterError."""
    cells: dict[str, TitleCell] = {}
    whole = Box(0.0, 0.0, title.width, title.height)
    for name, given in content.items():
        where = f"{_CELLS}.{name}"
        cell = _part(TitleCell, {"value": f"{{{name}}}" if name in VALUES else "", **given}, where)
        if unknown := next((each for each in cell.names if each not in VALUES), None):
            raise ParameterError(
                f"{where}.value", cell.value, f"unknown in braces: {shown(unknown)}; {_nearest(unknown, VALUES)}"
            )
        if cell.value and cell.value_top(title.caption) - cell.value_bottom < LEAST:
            raise ParameterError(f"{where}.height", cell.height, "must have room for the caption and the value", "mm")
        if not whole.holds(cell.box):
            permitted = f"must be inside the title block, {title.width:g} x {title.height:g} mm"
            raise ParameterError(where, tuple(cell.box), permitted)
        if over := next((other for other, each in cells.items() if each.box.meets(cell.box)), None):
            raise ParameterError(where, tuple(cell.box), f"must not lie over the cell {over}")
        cells[name] = cell
    return cells


def _words(content: Any) -> dict[str, dict[str, str]]:
    """Return the words that replace shipped ones, by language and key. Raises ParameterError."""
    known_words = _known_words()
    known = tuple(known_words)
    found = _no_words()
    for section, entries in _table(content, "words").items():
        for name, given in _table(entries, f"words.{section}").items():
            key, where = f"{section}.{name}", f"words.{section}.{name}"
            if key not in known:
                raise ParameterError(where, given, f"unknown word; did you mean {_nearest_word(key, known)}?")
            in_each = dict.fromkeys(found, given) if isinstance(given, str) else _table(given, where)
            for language, text in in_each.items():
                if language not in found or not isinstance(text, str):
                    raise ParameterError(where, given, f"must be a text, or texts for {', '.join(found)}")
                _require_names(where, text, known_words[key])
                found[language][key] = one_line(where, text)
    return found


def _nearest_word(key: str, known: tuple[str, ...]) -> str:
    return difflib.get_close_matches(key, known, n=1, cutoff=0.0)[0]


def _require_names(where: str, text: str, shipped: str) -> None:
    """Raise ParameterError for names in braces that the shipped words do not have."""
    try:
        names = {name for _, name, _, _ in Formatter().parse(text) if name is not None}
    except ValueError as error:
        raise ParameterError(where, text, f"has braces that do not match: {error}") from None
    permitted = {name for _, name, _, _ in Formatter().parse(shipped) if name is not None}
    if wrong := sorted(names - permitted):
        known = " ".join(f"{{{name}}}" for name in sorted(permitted))
        raise ParameterError(where, text, f"unknown in braces: {shown(wrong[0])}; permitted: {known or 'nothing'}")


def _table(content: Any, where: str) -> Mapping[str, Any]:
    if not isinstance(content, Mapping):
        raise ParameterError(where, content, "must be a table")
    return content


@cache
def _known_words() -> Mapping[str, str]:
    return SheetWords.of(Language.ENGLISH).labels
