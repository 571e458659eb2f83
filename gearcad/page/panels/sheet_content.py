"""Content of data sheet and rating: rows in the page's words, changes, and the fields of notices; found without NiceGUI."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from gearcad.core.errors import GearcadError, InputError, format_number
from gearcad.core.records import Notice
from gearcad.core.symbols import parts_of
from gearcad.core.units import ShownUnit, UnitSystem, shown_unit
from gearcad.designs.design import Design
from gearcad.designs.keys import DesignKind
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.train_designs import TrainDesign
from gearcad.designs.train_meshes import has_pairs
from gearcad.page.fields import field_keys, members_of
from gearcad.page.panels import Panel
from gearcad.page.words import PageWords
from gearcad.sheet import Row, Section
from gearcad.sheet.trains import FACTORS, strength_sections, train_strength_sections

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.planetary_strength import TrainStrength
    from gearcad.rating.strength import StrengthRating


_TEETH = ("spur", "helical", "double helical")

_KINDS = (
    *(f"{before}{teeth} {kind}" for kind in ("gear", "pair") for before in ("", "internal ") for teeth in _TEETH),
    *(f"{teeth} {kind}" for kind in ("rack", "pinion and rack") for teeth in _TEETH[:2]),
    *("planetary train of type", "train", "inertias", "splined shaft and hub", "splined shaft", "splined hub"),
)
"""Words of which titles of designs are made."""

_VALUES = ("yes", "no", "infinite", "spur only")
"""Values that are words; what specs say, as they say it."""

_QUANTITIES = ("single contact factor", "tip clearance", "teeth")
"""Quantities of a gear that is called as somebody likes."""

_WORDS = re.compile(r"[a-z][a-z ]+[a-z]")
_OF_A_GEAR = re.compile(rf"({'|'.join(_QUANTITIES)}) of the (.+)")


def title_in(words: PageWords, title: str) -> str:
    """Return the title of a design in the language and the units of the page, such as "helical pair, z = 13 / 44"."""
    told = _WORDS.sub(lambda found: words[found[0]] if found[0] in _KINDS else found[0], title)
    return " ".join(map(words.number, told.split(" ")))


_ASSUMED = " (assumed)"


def value_in(words: PageWords, text: str) -> str:
    """A value as shown."""
    if text.endswith(_ASSUMED):
        return f"{value_in(words, text.removesuffix(_ASSUMED))} ({words['assumed']})"
    return words[text] if text in _VALUES else words.number(text)


_SPLINED = {"shaft": "Splined shaft", "hub": "Splined hub"}
"""Words for the parts of a spline; a shaft of a train is called by its name."""


def called(words: PageWords, name: str) -> str:
    """Return the name of gears, or of gears in mesh, in the language of the page if it is the name of spec tables."""
    if name in _SPLINED:
        return words.table.get(_SPLINED[name], name)
    parts = [words.table.get(part.replace("_", " ").capitalize()) for part in name.split("-")]
    return "-".join(part for part in parts if part) if all(parts) else name


def quantity_in(words: PageWords, english: str) -> str:
    """The words of a quantity."""
    if english not in words.table and (found := _OF_A_GEAR.fullmatch(english)) and found[1] in words.table:
        return f"{words[found[1]]} ({called(words, found[2])})"
    return words[english]


def clause_in(words: PageWords, source: str) -> str:
    """Return the source of a quantity in the language of the page: a clause alone is one of ISO 21771."""
    return f"ISO 21771, {words['clause']} {source}" if source[:1].isdigit() else source.replace("Annex", "ISO 21771, Annex")


_OTHER_TITLES = {"Mesh": "Gear mesh"}
"""Titles that the page uses for another purpose."""


class SheetCell(NamedTuple):
    """A value with all its digits, and as shown."""

    value: Any
    text: str


Cells = Mapping[tuple[str, str], SheetCell]
"""Cells of a sheet, by the keys of rows and the names of columns; a single column is ""."""


def cells_of(sections: Iterable[Section]) -> Cells:
    """Return all cells of a sheet."""
    return {place: cell for section in sections for row in _rows(section) for place, cell in _places(row, section)}


def changed_cells(cells: Cells, former: Cells) -> dict[tuple[str, str], str]:
    """Return the former text of each cell that is shown differently now. New cells do not count as changed."""
    return {place: former[place].text for place, cell in cells.items() if place in former and former[place].text != cell.text}


def shown_sections(
    sections: Iterable[Section],
    words: PageWords,
    *,
    folded: Collection[str] = (),
    changed: Mapping[tuple[str, str], str] | None = None,
    kept: Cells | None = None,
) -> list[dict[str, Any]]:
    """Return the sections as the browser needs them for tables.

    Blocks whose English titles are `folded` are shut until the user opens them.
    """
    before, beside = changed or {}, kept or {}
    return [
        {
            "columns": [called(words, name) for name in section.columns],
            "blocks": [
                {
                    "id": " ".join(filter(None, (section.name, *section.columns, block.title))),
                    "title": ": ".join(filter(None, (called(words, section.name), title_of(block.title, words)))),
                    "folded": block.title in folded,
                    "rows": [_row(row, section, words, before, beside) for row in block.rows],
                }
                for block in section.blocks
            ],
        }
        for section in sections
    ]


def title_of(title: str, words: PageWords) -> str:
    """Return the title of a block in the language of the page: its subject, or the gear that it describes."""
    known = words[_OTHER_TITLES.get(title, title)]
    return called(words, title) if known == title else known


def _rows(section: Section) -> Iterator[Row]:
    for block in section.blocks:
        yield from block.rows


def _places(row: Row, section: Section) -> Iterator[tuple[tuple[str, str], SheetCell]]:
    columns = section.columns if len(row.values) > 1 else ("",)
    for column, value, text in zip(columns, row.values, row.texts, strict=True):
        yield (row.key, column), SheetCell(value, text)


def _row(row: Row, section: Section, words: PageWords, changed: Mapping[tuple[str, str], str], kept: Cells) -> dict[str, Any]:
    name = words.divided(quantity_in(words, row.symbol.words))
    return {
        "key": row.key,
        "words": name,
        "symbol": row.symbol.symbol,
        "parts": [parts_of(name), row.symbol.parts],
        "unit": words.unit_name(row.symbol.unit),
        "source": words.message(clause_in(words, row.symbol.source)),
        "cells": [
            {
                "text": value_in(words, cell.text),
                "former": value_in(words, changed.get(place, "")),
                **_kept_text(cell, kept.get(place), words),
            }
            for place, cell in _places(row, section)
        ],
    }


def _kept_text(cell: SheetCell, kept: SheetCell | None, words: PageWords) -> dict[str, str]:
    """Return the text of the kept design's cell, if it is different, and the difference from it; otherwise an empty mapping."""
    if kept is None or kept.text == cell.text:
        return {}
    return {"kept": value_in(words, kept.text), "difference": words.number(_difference(cell, kept))}


def _difference(cell: SheetCell, kept: SheetCell) -> str:
    """Return the difference of two cells with as many decimals as are shown; "" unless both are finite numbers."""
    if not all(map(_is_number, (cell.value, kept.value))) or not all(math.isfinite(each.value) for each in (cell, kept)):
        return ""
    decimals = max(len(each.text.partition(".")[2]) for each in (cell, kept))
    difference = cell.value - kept.value
    return f"{difference:+.3e}" if any("e" in each.text for each in (cell, kept)) else f"{difference:+.{decimals}f}"


_ABOUT = {
    "undercut": "profile_shift rack.addendum",
    "thin-tip": "profile_shift tip_alteration",
    "full-radius": "rack.root_radius",
    "form-root": "cutter.teeth",
    "span-off-involute": "profile_shift tip_alteration",
    "balls-off-involute": "profile_shift",
    "narrow-for-span": "face_width",
    "narrow-for-pins": "face_width",
    "web-not-modelled": "body.web_thickness",
    "own-blank": "body.step",
    "cutter-trims-tips": "cutter.teeth tip_alteration",
    "cutter-trims-on-infeed": "cutter.teeth",
    "rounded-shifts": "centre_distance tooth_thinning",
    "backlash-may-vanish": "tooth_thinning tooth_allowance centre_distance_tolerance",
    "low-contact-ratio": "centre_distance helix_angle",
    "fillet-interference": "tip_alteration rack.root_radius rack.addendum",
    "undercut-contact": "profile_shift",
    "radial-assembly": "teeth",
    "no-pin": "pin_diameter",
    "low-pin": "pin_diameter",
    "no-hunting-tooth": "teeth",
    "wide-backlash": "tooth_thinning",
    "stage-in-the-way": "axial_position",
    "unbalanced": "planets",
}
"""Keys that a notice is about, by its code, the most important first."""

_MOST = 2
"""Fields that are named with a notice: more would hide it."""


def keys_of(design: Design) -> frozenset[str]:
    """Return the keys of all fields that the specs of this kind of design have."""
    return field_keys(design.kind, members_of(design))


def shown_notices(notices: Collection[Notice], keys: Collection[str]) -> tuple[dict[str, Any], ...]:
    """Each notice once, with those of the `keys` of a spec's fields that it is about."""
    found: dict[str, Any] = {}
    for notice in notices:
        found.setdefault(str(notice), {"code": notice.code, "text": str(notice), "keys": _keys(notice, keys)})
    return tuple(found.values())


def _keys(notice: Notice, keys: Collection[str]) -> list[str]:
    """Return the keys that a notice is about: those of the table that it names, otherwise those of the parts in mesh."""
    fields = _ABOUT.get(notice.code, "").split()
    for tables in (re.split(": |-", notice.where), ("pair", "pinion", "wheel", "planetary")):
        about = dict.fromkeys(f"{table}.{field}" for field in fields for table in tables)
        if found := [key for key in about if key in keys]:
            return found[:_MOST]
    return []


class Figures(NamedTuple):
    """Sections and all that stands in them, with labelled lines before them, and notices as `shown_notices` gives them.

    `name` is that of the design, if `what` it is is told. Lines without a label are words of the page or names of standards.
    `pins` are the keys of rows that stand on top at first, `folded` the titles of blocks that are shut at first. `title` is a
    verdict, and `verdict` the class by which it is coloured.
    """

    sections: tuple[Section, ...]
    cells: Cells
    lines: tuple[tuple[str, str], ...] = ()
    notices: tuple[dict[str, Any], ...] = ()
    pins: Collection[str] = ()
    folded: Collection[str] = ()
    title: str = ""
    verdict: str = ""
    name: str = ""
    what: str = ""


def figures(sections: tuple[Section, ...], **others: Any) -> Figures:
    """Return the figures of sections."""
    return Figures(sections, cells_of(sections), **others)


def figures_in(found: Figures, system: UnitSystem) -> Figures:
    """Return figures in other units than those of documents."""
    if system is UnitSystem.METRIC:
        return found
    sections = sections_in(found.sections, system)
    return found._replace(sections=sections, cells=cells_of(sections))


def sections_in(sections: Iterable[Section], system: UnitSystem) -> tuple[Section, ...]:
    """Return sections in other units than those of documents."""
    return tuple(_section_in(section, system) for section in sections)


def _section_in(section: Section, system: UnitSystem) -> Section:
    blocks = tuple(each._replace(rows=tuple(_row_in(row, system) for row in each.rows)) for each in section.blocks)
    return section._replace(blocks=blocks)


def _row_in(row: Row, system: UnitSystem) -> Row:
    """Return a row in other units; texts keep their words."""
    unit = shown_unit(system, row.symbol.unit, row.key)
    if unit is None:
        return row
    values = tuple(unit.of(each) if _is_number(each) else each for each in row.values)
    return row._replace(
        symbol=row.symbol._replace(unit=unit.name),
        values=values,
        texts=tuple(_text_in(text, unit) for text in row.texts),
    )


_PLAIN_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_BRACKET = " ("
"""What stands behind it is a word, or the designation of a splined bore."""

_FIXED_DECIMALS = 4
"""Decimals of numbers of a data sheet, which are all in line; other numbers have as many significant digits."""


def _text_in(text: str, unit: ShownUnit) -> str:
    """Return the text of numbers in another unit: in line where they were, and no finer than they were."""
    text, bracket, designation = text.partition(_BRACKET)  # of a splined bore
    finer = max(round(math.log10(unit.size)), -_FIXED_DECIMALS)

    def other(found: re.Match[str]) -> str:
        number, (_, _, decimals) = unit.of(float(found[0])), found[0].partition(".")
        if len(decimals) == _FIXED_DECIMALS and decimals.isdecimal():
            return f"{round(number, _FIXED_DECIMALS + finer) + 0.0:.{_FIXED_DECIMALS + finer}f}"
        return format_number(float(f"{number:.{_FIXED_DECIMALS}g}"))

    return _PLAIN_NUMBER.sub(other, text) + bracket + designation


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


class FiguresPanel(Panel[Figures]):
    """Tables of figures: those that the last step changed beside what they were; below them those of a kept design."""

    compares = True

    def __init__(self, label: str, store: str, words: PageWords) -> None:
        from gearcad.page.components.elements import SheetView  # only here: who finds figures elsewhere needs no NiceGUI

        self._words = words
        own = {
            "search": words["find a quantity"],
            "pins": words["First figures"],
            "notices": words["Warnings"],
            "changed": words["values changed"],
            "kept": words["kept"],
            "difference": words["difference"],
            "assumed": words["assumed"],
            "verify": words["unconfirmed"],
            "pin": words["Enter or double click: on top"],
            "unpin": words["Enter or double click: not on top"],
            "waiting": words["being computed"],
        }
        self._view = SheetView(label, store, own)
        self._former: Cells = {}
        self._changed: dict[tuple[str, str], str] = {}
        self._kept: Figures | None = None

    def show(self, found: Figures) -> None:
        found = figures_in(found, self._words.units)
        if found.cells != self._former:
            self._changed = changed_cells(found.cells, self._former)
            self._former = found.cells
        self._view.show(shown_figures(found, self._words, self._changed, self._kept))

    def clear(self) -> None:
        self._former, self._changed = {}, {}
        self._view.show(shown_figures(Figures((), {}), self._words))

    def keep(self, found: Figures | None) -> None:
        self._kept = None if found is None else figures_in(found, self._words.units)

    def wait(self) -> None:
        self._view.wait()


def shown_figures(
    found: Figures, words: PageWords, changed: dict[tuple[str, str], str] | None = None, kept: Figures | None = None
) -> dict[str, Any]:
    """Return the figures as the browser needs them."""
    beside = None if kept is None else kept.cells
    title, reason = _headline(found.title, words)
    told = [{"label": "", "text": f"{found.name}: {title_in(words, found.what)}"}] if found.what else []
    return {
        "title": title,
        "reason": words.message(reason),
        "verdict": found.verdict,
        "lines": told
        + [{"label": label, "text": words.message(text) if label else words[text]} for label, text in found.lines],
        "beside": "" if kept is None else _headline(kept.title, words)[0],
        "changes": len(changed or {}),
        "notices": [each | {"text": words.message(each["text"])} for each in found.notices],
        "pins": list(found.pins),
        "sections": shown_sections(found.sections, words, folded=found.folded, changed=changed, kept=beside),
    }


def _headline(verdict: str, words: PageWords) -> tuple[str, str]:
    """Return a verdict in two parts: its head in the language of the page, and its reason."""
    heads = {
        "strength passed": words["strength passed"],
        "strength NOT passed": words["strength NOT passed"],
        "strength not judged": words["strength not judged"],
        "strength not asked for": words["strength not asked for"],
    }
    head = next((each for each in heads if verdict.startswith(each)), "")
    return heads.get(head, ""), verdict.removeprefix(head).removeprefix(": ")


_PINNED = (
    "safety.flank safety.root safety.scuffing.integral safety.scuffing.flash"
    " permissible_torque.flank permissible_torque.root life.flank life.root"
)
"""Keys of rows pinned at the top: those that the user looks at first."""

_PINS = [f"strength.{key}" for key in _PINNED.split()]

_ON_REQUEST = (
    'face_load_factor = "fe": K_Hbeta is that of the load distribution of solid bodies, which takes its time: run "rate" for it'
)

_NO_RATING = "This kind of design has no rating."

_VERDICTS = {True: "passed", False: "failed", None: ""}


class StrengthPanel(FiguresPanel):
    """Panel with the result of `gearcad rate` for a design."""

    def __init__(self, words: PageWords) -> None:
        super().__init__(words["rating"], "gearcad-strength", words)

    def aside(self, design: Design) -> Callable[[Design], Figures] | None:
        """Return the rating as a function for another process if it takes long: load shares of planets need finite elements."""
        return strength_figures if _takes_long(design) else None

    def find(self, design: Design) -> Figures:
        return strength_figures(design)


def warm_up(design: Design) -> None:
    """Import what ratings need, and rate a design once if that is quick, so that no user waits for it later."""
    import gearcad.jobs.strength  # noqa: F401

    if not _takes_long(design):
        strength_figures(design)


def _takes_long(design: Design) -> bool:
    return design.kind is DesignKind.PLANETARY


def strength_figures(design: Design) -> Figures:
    """Return the figures of the rating of a design. Without a rating, a line gives the reason or the missing input."""
    from gearcad.jobs.strength import KEYS, Rate

    if isinstance(design, TrainDesign) and has_pairs(design):
        return _rated_train(design)
    if design.kind not in Rate.accepts:
        return Figures((), {}, lines=(("", _NO_RATING),))
    options = getattr(design, "rating", None)
    if options is not None and options.face_load_factor == "fe":
        return _without(_ON_REQUEST, ["rating.face_load_factor"])
    try:
        return _rated(_rating(design), design)
    except GearcadError as error:
        key = KEYS.get(error.parameter, error.parameter) if isinstance(error, InputError) else ""
        return _without(str(error), [key] if key in keys_of(design) else [])


def _rating(design: Design) -> StrengthRating | TrainStrength:
    """Return the rating of a design. The rating of a train is read from its study, which also gives the load shares."""
    from gearcad.jobs.strength import Rate, strength_in_study

    if isinstance(design, PlanetaryDesign):
        from gearcad.page.panels.drawn_data import train_study

        return strength_in_study(design, train_study(design))
    return Rate(report=False).run(design)


def _rated(found: StrengthRating | TrainStrength, design: Design) -> Figures:
    """Return the figures of a rating; for a train, of all its meshes."""
    from gearcad.dynamics.planetary.planetary_strength import TrainStrength

    train = isinstance(found, TrainStrength)
    standards = f"{found.options.standard.value}, {found.options.accuracy.value}"
    told = {"": (standards,), "assumed": found.assumed, "verify": found.verify}
    return figures(
        train_strength_sections(found) if isinstance(found, TrainStrength) else strength_sections(found),
        lines=tuple((label, "; ".join(each)) for label, each in told.items() if each),
        notices=shown_notices(found.notices, keys_of(design)),
        pins=() if train else _PINS,
        folded=FACTORS if train else ("Safety", *FACTORS),
        title=found.verdict,
        verdict=_VERDICTS[found.passed],
    )


def _rated_train(design: TrainDesign) -> Figures:
    """Return the figures of the ratings of all meshes of a train of pairs, each under the train's load; the worst decides."""
    from gearcad.jobs.strength import Rate
    from gearcad.jobs.train import OverMeshes

    try:
        found = OverMeshes(job=Rate(report=False)).run(design)
    except GearcadError as error:
        return _without(str(error), [])
    ratings: dict[str, StrengthRating] = {each.mesh.name: each.result for each in found.meshes}
    lines = dict.fromkeys(f"{each.options.standard.value}, {each.options.accuracy.value}" for each in ratings.values())
    verdict = found.verdict if found.verdict.startswith("strength") else f"strength {found.verdict}"
    return figures(
        tuple(section for name, rating in ratings.items() for section in strength_sections(rating, name)),
        lines=tuple(("", line) for line in lines),
        notices=shown_notices(found.notices, keys_of(design)),
        folded=FACTORS,
        title=verdict,
        verdict="failed" if found.falls_short else _VERDICTS[found.passed],
    )


def _without(line: str, keys: list[str]) -> Figures:
    return Figures((), {}, notices=({"text": line, "keys": keys},))
