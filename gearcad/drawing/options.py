"""The [drawing] table, and that of each gear: title block, sheet, and what dimensions are toleranced with."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from datetime import UTC, date, datetime
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any, cast

from gearcad.core.errors import InputError, ParameterError
from gearcad.core.output import source_date
from gearcad.core.quantities import Range, Words, require_fields, schema_of
from gearcad.core.records import concise
from gearcad.drawing.words import Language
from gearcad.geometry.fits import limit_deviations, require_hole, require_shaft

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = ["SCALES", "DrawingOptions", "PartDrawing", "Projection", "Revision", "SheetSize", "one_line"]

SCALES = {
    **{f"{n}:1": float(n) for n in (1000, 500, 200, 100, 50, 20, 10, 5, 2)},
    "1:1": 1.0,
    **{f"1:{n}": 1 / n for n in (2, 5, 10, 20, 50, 100, 200, 500, 1000)},
}
"""Scales of ISO 5455, the largest first, and mm of paper for a mm of the part."""

_LONGEST = 2000
"""Largest number of characters of a text on a sheet."""

_HIDDEN = (
    "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\u200e\u200f\u061c"  # turn others round
    "\u00ad\u034f\u115f\u1160\u180e\u200b\u2060\u2061\u2062\u2063\u2064\u3164\ufeff\uffa0"  # have no width, or no ink
)
"""Invisible letters, not permitted: a sheet must read as it is stored. Joiners, which some scripts need, are permitted."""

_ANY_SIZE = 10.0
"""Size (mm) for which the classes of ISO 286 that are permitted have limits."""

_ISO_DATE = re.compile(r"\d{4}-\d\d-\d\d")


class SheetSize(StrEnum):
    """Sheets of ISO 5457; "auto" is the smallest on which a drawing has room."""

    AUTO = "auto"
    A4 = "A4"
    A3 = "A3"
    A2 = "A2"
    A1 = "A1"
    A0 = "A0"

    @property
    def size(self) -> tuple[float, float]:
        """Width and height (mm): A4 upright, all others lying. Raises KeyError for "auto"."""
        return _SIZES[self]


_SIZES = {
    SheetSize.A4: (210.0, 297.0),
    SheetSize.A3: (420.0, 297.0),
    SheetSize.A2: (594.0, 420.0),
    SheetSize.A1: (841.0, 594.0),
    SheetSize.A0: (1189.0, 841.0),
}


class Projection(StrEnum):
    """Arrangement of the views beside each other (ISO 5456-2)."""

    FIRST = "first"
    THIRD = "third"


@dataclass(frozen=True)
class Revision:
    """A line of the table of revisions."""

    index: str
    text: str
    date: str = ""
    name: str = ""


_RA = Range("µm", 0.005, 100.0)
_RUNOUT = Range("µm", 0.1, 1e4)

_NUMBER = Words("identification number", "", "ISO 7200")
_TITLE = Words("title; else the name", "", "ISO 7200")
_SUBTITLE = Words("supplementary title", "", "ISO 7200")
_REVISION = Words("index of the revision; else that of the last of revisions", "", "ISO 7200")
_REVISIONS = Words("revisions, each as index, text, date, name")
_SHEET = Words("size of the sheet", "", "ISO 5457")
_SCALE = Words("scale", "", "ISO 5455")
_MATERIAL = Words("material as the sheet names it; else the name of the material")
_HEAT = Words("heat treatment")
_CASE = Words("case hardening depth as the sheet says it", "CHD", "ISO 18203")
_NOTES = Words("notes on the sheet")
_BORE = Words("tolerance class of the bore, a hole", "", "ISO 286-2")
_TIP = Words("tolerance class of the tip diameter; of a ring the hole of this letter", "", "ISO 286-2")
_FACE = Words("tolerance class of the face width, a shaft", "", "ISO 286-2")
_KEYWAY = Words("tolerance class of the keyway's width, a hole", "", "ISO 286-2")
_RIM = Words("tolerance class of a ring's outer diameter, a shaft", "", "ISO 286-2")
_ROUGH = Words("roughness of what has none of its own", "Ra", "ISO 21920-1")
_BORE_ROUGH = Words("roughness of bore and faces; else by the accuracy grade", "Ra", "ISO 21920-1")
_TIP_RUNOUT = Words("run-out of the tip cylinder; else by the accuracy grade", "", "ISO 1101")
_SYMMETRY = Words("symmetry of the keyway; else by its tolerance class", "", "ISO 1101")
_POSITION = Words("position of bolt holes; else by their diameter", "", "ISO 1101")
_PARALLELISM = Words("parallelism of a rack's tips to its back; else by the accuracy grade", "", "ISO 1101")
_FACE_RUNOUT = Words("axial run-out of the faces; else by the accuracy grade", "", "ISO 1101")


@dataclass(frozen=True, kw_only=True)
class PartDrawing:
    """The drawing options of one gear's own sheet; None takes the value of [drawing].

    Raises ParameterError.
    """

    number: Annotated[str | None, _NUMBER] = None
    title: Annotated[str | None, _TITLE] = None
    supplementary_title: Annotated[str | None, _SUBTITLE] = None
    revision: Annotated[str | None, _REVISION] = None
    revisions: Annotated[tuple[tuple[str, ...], ...] | None, _REVISIONS] = None
    sheet: Annotated[SheetSize | None, _SHEET] = None
    scale: Annotated[str | None, _SCALE] = None
    material: Annotated[str | None, _MATERIAL] = None
    heat_treatment: Annotated[str | None, _HEAT] = None
    case_depth: Annotated[str | None, _CASE] = None
    notes: Annotated[tuple[str, ...] | None, _NOTES] = None
    bore_tolerance: Annotated[str | None, _BORE] = None
    tip_tolerance: Annotated[str | None, _TIP] = None
    face_width_tolerance: Annotated[str | None, _FACE] = None
    keyway_tolerance: Annotated[str | None, _KEYWAY] = None
    rim_tolerance: Annotated[str | None, _RIM] = None
    surface_roughness: Annotated[float | None, _RA, _ROUGH] = None
    bore_roughness: Annotated[float | None, _RA, _BORE_ROUGH] = None
    tip_runout: Annotated[float | None, _RUNOUT, _TIP_RUNOUT] = None
    face_runout: Annotated[float | None, _RUNOUT, _FACE_RUNOUT] = None
    keyway_symmetry: Annotated[float | None, _RUNOUT, _SYMMETRY] = None
    bolt_position: Annotated[float | None, _RUNOUT, _POSITION] = None
    back_parallelism: Annotated[float | None, _RUNOUT, _PARALLELISM] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        _check(self, PartDrawing)


@dataclass(frozen=True, kw_only=True)
class DrawingOptions:
    """The title block of a design's sheets, their layout, and the requirements common to all of its gears.

    A tolerance class "" leaves a size to the general tolerances. Texts are made one line, whatever white space they contain.
    The fields of one gear may be given in its PartDrawing. Raises ParameterError.
    """

    number: Annotated[str, _NUMBER] = ""
    title: Annotated[str, _TITLE] = ""
    supplementary_title: Annotated[str, _SUBTITLE] = ""
    owner: Annotated[str, Words("legal owner", "", "ISO 7200")] = ""
    department: Annotated[str, Words("responsible department", "", "ISO 7200")] = ""
    technical_reference: Annotated[str, Words("technical reference", "", "ISO 7200")] = ""
    creator: Annotated[str, Words("creator", "", "ISO 7200")] = ""
    approver: Annotated[str, Words("approval person", "", "ISO 7200")] = ""
    document_type: Annotated[str, Words("document type; else that of the sheet", "", "ISO 7200")] = ""
    status: Annotated[str, Words("document status", "", "ISO 7200")] = ""
    classification: Annotated[str, Words("classification, or key words", "", "ISO 7200")] = ""
    revision: Annotated[str, _REVISION] = ""
    date: Annotated[str | None, Words("date of issue; else that of the files", "", "ISO 8601")] = None
    revisions: Annotated[tuple[tuple[str, ...], ...], _REVISIONS] = ()
    language: Annotated[Language, Words("language of the sheets", "", "ISO 639")] = Language.ENGLISH
    sheet: Annotated[SheetSize, _SHEET] = SheetSize.AUTO
    scale: Annotated[str, _SCALE] = "auto"
    projection: Annotated[Projection, Words("projection", "", "ISO 5456-2")] = Projection.FIRST
    template: Annotated[str | None, Words("file that changes title block, frame and words")] = None
    general_tolerance: Annotated[str, Words("general tolerances", "", "ISO 2768-1, ISO 22081")] = "ISO 2768-1-m, ISO 22081"
    material: Annotated[str | None, _MATERIAL] = None
    heat_treatment: Annotated[str, _HEAT] = ""
    case_depth: Annotated[str, _CASE] = ""
    notes: Annotated[tuple[str, ...], _NOTES] = ()
    bore_tolerance: Annotated[str, _BORE] = "H7"
    tip_tolerance: Annotated[str, _TIP] = "h9"
    face_width_tolerance: Annotated[str, _FACE] = "h11"
    keyway_tolerance: Annotated[str, _KEYWAY] = "JS9"
    rim_tolerance: Annotated[str, _RIM] = "h7"
    surface_roughness: Annotated[float, _RA, _ROUGH] = 3.2
    bore_roughness: Annotated[float | None, _RA, _BORE_ROUGH] = None
    tip_runout: Annotated[float | None, _RUNOUT, _TIP_RUNOUT] = None
    face_runout: Annotated[float | None, _RUNOUT, _FACE_RUNOUT] = None
    keyway_symmetry: Annotated[float | None, _RUNOUT, _SYMMETRY] = None
    bolt_position: Annotated[float | None, _RUNOUT, _POSITION] = None
    back_parallelism: Annotated[float | None, _RUNOUT, _PARALLELISM] = None

    __repr__ = concise

    def __post_init__(self) -> None:
        _check(self, DrawingOptions)
        if self.date is not None:
            _require_date(self.date)

    def of_part(self, part: PartDrawing | None, *, alone: bool) -> DrawingOptions:
        """Return the options of the sheet of one gear: the gear's own values, else those of the design.

        Unless the gear is `alone`, the only one of its design, it does not take number, title and revisions from the design.
        These belong to the assembly.
        """
        own = {each.name: getattr(part, each.name) for each in fields(part)} if part is not None else {}
        given = {key: value for key, value in own.items() if value is not None}
        blank = {} if alone else {"number": "", "title": "", "supplementary_title": "", "revision": "", "revisions": ()}
        return replace(self, **cast("dict[str, Any]", blank | given))

    @property
    def issued(self) -> str:
        """The date of issue: as given, else that of SOURCE_DATE_EPOCH, else today (UTC). Raises ParameterError."""
        if self.date is not None:
            return self.date
        return (source_date() or datetime.now(UTC)).date().isoformat()

    @property
    def index(self) -> str:
        """The index of the revision: as given, else that of the last of `revisions`."""
        return self.revision or next((each.index for each in reversed(self.changes)), "")

    @property
    def changes(self) -> tuple[Revision, ...]:
        """The revisions, in their order."""
        return tuple(Revision(*each) for each in self.revisions)

    @property
    def factor(self) -> float | None:
        """mm of paper for a mm of the part; None where that is "auto"."""
        return SCALES.get(self.scale)


def _check(options: DrawingOptions | PartDrawing, kind: type[DataclassInstance]) -> None:
    """Turn texts into single lines, lists into tuples and words into members. Raises ParameterError."""
    for name, field in schema_of(kind).items():
        value = getattr(options, name)
        if value is None and field.optional:
            continue
        if name in _LISTS:
            object.__setattr__(options, name, _LISTS[name](name, value))
        elif str in field.members:
            object.__setattr__(options, name, one_line(name, value))
            if name.endswith("_tolerance") and name != "general_tolerance":
                _require_fit(name, getattr(options, name))
    require_fields(options)
    if options.scale not in (None, "auto", *SCALES):
        permitted = 'must be "auto" or a scale of ISO 5455: 1:1, 2:1, 5:1, 10:1 ..., 1:2, 1:5, 1:10 ... 1:1000'
        raise ParameterError("scale", options.scale, permitted)


def one_line(parameter: str, value: Any) -> str:
    """Return a text in one line. Raises ParameterError if the value is no text, is too long or has hidden or control
    characters.
    """
    if isinstance(value, date):  # as TOML has dates
        value = value.isoformat()
    if not isinstance(value, str):
        raise ParameterError(parameter, value, "must be a text, in quotation marks")
    if len(value) > _LONGEST:
        raise ParameterError(parameter, value, f"must be a text of at most {_LONGEST} characters, not {len(value)}")
    line = " ".join(value.split())
    bad = next((each for each in line if unicodedata.category(each) in ("Cc", "Cs") or each in _HIDDEN), None)
    if bad is not None:
        raise ParameterError(parameter, value, f"must be a text without hidden or control characters; U+{ord(bad):04X} is one")
    return line


def _texts(parameter: str, value: Any) -> tuple[str, ...]:
    """Return the texts of a list, or of one text with | or a new line between them. Raises ParameterError."""
    listed: Iterable[Any] = re.split(r"[|\n]", value) if isinstance(value, str) else value
    if not isinstance(listed, list | tuple):
        raise ParameterError(parameter, value, 'must be a list of texts, as in ["first", "second"]')
    return tuple(line for each in listed if (line := one_line(parameter, each)))


def _revisions(parameter: str, value: Any) -> tuple[tuple[str, ...], ...]:
    """Return the revisions of a list, or of one text with | between them and ; between their fields. Raises ParameterError."""
    listed = [each.split(";") for each in re.split(r"[|\n]", value) if each.strip()] if isinstance(value, str) else value
    permitted = 'must be a list of lists of index, text, date and name, as in [["A", "first issue", "2026-01-31", "MB"]]'
    if not isinstance(listed, list | tuple):
        raise ParameterError(parameter, value, permitted)
    found = []
    for each in listed:
        if not isinstance(each, list | tuple) or not 2 <= len(each) <= len(fields(Revision)):
            raise ParameterError(parameter, each, permitted)
        found.append(tuple(one_line(parameter, item) for item in each))
    return tuple(found)


_LISTS = {"notes": _texts, "revisions": _revisions}


_HOLES, _SHAFTS = ("bore_tolerance", "keyway_tolerance"), ("face_width_tolerance", "rim_tolerance")
"""Classes of sizes that are holes on every part, and shafts; tips are holes of rings alone."""


def _require_fit(parameter: str, value: str) -> None:
    """Raise ParameterError unless a text is blank or a supported tolerance class (ISO 286) of a hole or shaft, as required."""
    if not value:
        return
    try:
        limit_deviations(value, _ANY_SIZE)
    except InputError as error:
        raise ParameterError(parameter, value, f'{error.permitted}, or "" for general tolerances') from None
    if parameter in _HOLES:
        require_hole(parameter, value)
    elif parameter in _SHAFTS:
        require_shaft(parameter, value)


def _require_date(value: str) -> None:
    """Raise ParameterError unless a text is a date of ISO 8601."""
    try:
        if _ISO_DATE.fullmatch(value):
            date.fromisoformat(value)
            return
    except ValueError:
        pass
    raise ParameterError("date", value, "must be a date as year-month-day, such as 2026-01-31")
