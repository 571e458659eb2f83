"""The sheet of a design of any kind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, cast

from gearcad.core.errors import format_number
from gearcad.core.quantities import symbols_of
from gearcad.core.records import is_assumed, is_usual
from gearcad.core.symbols import Symbol
from gearcad.designs.design import Design
from gearcad.designs.keys import BESIDE, FIELDS, DesignKind, Fields
from gearcad.geometry import Rack
from gearcad.material import Material
from gearcad.sheet.blocks import (
    ABSENT,
    Row,
    Section,
    Sheet,
    block,
    flattened,
    gear_section,
    pair_section,
    rack_section,
    shaft_sections,
    spline_sections,
)

if TYPE_CHECKING:
    from gearcad.designs.train_designs import TrainDesign

__all__ = ["sheet_of"]

_OF_EVERY_RATING = ("standard", "accuracy", "accuracy_grade")


def sheet_of(design: Design) -> Sheet:
    """Return a column for each gear, then the pair, material, load, mounting and rating, then the notices."""
    document = design.to_dict()
    if design.kind is DesignKind.TRAIN:
        from gearcad.designs.train_meshes import mesh_documents
        from gearcad.sheet.trains import mesh_sections, train_sections

        title = f"train, {len(document['inertia'])} inertias"
        sections = (*train_sections(document), *mesh_sections(mesh_documents(cast("TrainDesign", design))))
        return Sheet(design.name, title, "lengths in mm", "", sections, design.notices)
    if design.kind is DesignKind.GEARBOX:
        from gearcad.sheet.trains import gearbox_sections

        number, sections = len(document["planetary"]["sets"]), gearbox_sections(document["planetary"])
        if design.gears:
            pairs = {name: flattened(document[name]) for name in design.described if name not in design.gears}
            sections = (*sections, gear_section(design.gears, document, {}), pair_section(pairs))
        title = "gearbox of 1 planetary set" if number == 1 else f"gearbox of {number} planetary sets"
        clauses = "clauses of ISO 21771:2007" if design.gears else ""
        return Sheet(design.name, title, "lengths in mm, angles in degrees", clauses, sections, design.notices)
    sections = tuple(section for section in _sections(design, document) if section.blocks)
    units = "lengths in mm, angles in degrees"
    clauses = "" if design.kind in (DesignKind.SPLINE, DesignKind.SHAFT) else "clauses of ISO 21771:2007"
    return Sheet(design.name, _title(design, document), units, clauses, sections, design.notices)


def _sections(design: Design, document: Mapping[str, Any]) -> Iterator[Section]:
    pair = flattened(document.get("pair", {})) | document.get("drive", {})
    if design.kind is DesignKind.SPLINE:
        yield from spline_sections(document, design.gears)
    elif design.gears:
        yield gear_section(design.gears, document, pair)
    if isinstance(rack := design.described.get("rack"), Rack):
        yield rack_section(rack)
    yield pair_section({"": pair} if pair else {})
    fields: Fields = FIELDS
    if design.kind is DesignKind.PLANETARY:
        from gearcad.designs.train_keys import PLANETARY as fields
        from gearcad.sheet.trains import planetary_sections

        yield from planetary_sections(document["planetary"])
    if design.kind is DesignKind.SHAFT:
        yield from shaft_sections({"shaft": document["shaft"]})
    elif shafts := document.get("shafts"):
        yield from shaft_sections(shafts)
    yield _material_section(document)
    for table in ("load", "mounting", "rating"):
        given = _shown_of(table, document.get(table, {}))
        if table == "rating" and design.gears and all(gear.accuracy_grade is not None for gear in design.gears.values()):
            given.pop("accuracy_grade", None)  # the gears have their own
        rows = [_row(f"{table}.{key}", fields[table][key].symbol, [value]) for key, value in given.items()]
        yield Section((), block(table.capitalize(), rows))


def _material_section(document: Mapping[str, Any]) -> Section:
    """Return the material of all gears, or a column for each."""
    every = document.get("materials", {})
    if not every and "material" in document:
        every = {"": document["material"]}
    rows = [
        _row(f"material.{key}", symbol, [of.get(key) for of in every.values()])
        for key, symbol in symbols_of(Material).items()
        if any(of.get(key) is not None for of in every.values())
    ]
    return Section(tuple(every) if len(every) > 1 else (), block("Material", rows))


def _row(key: str, symbol: Symbol, values: list[Any]) -> Row:
    return Row(key, symbol, tuple(values), tuple(ABSENT if value is None else _input_text(value) for value in values))


def _shown_of(table: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of a table that the sheet shows.

    Values of None are left out, zeros of the mounting too, and values of the rating that are as usual.
    """
    there = {key: value for key, value in values.items() if value is not None and not (table == "mounting" and value == 0)}
    if table != "rating" or not there:
        return there
    usual = asdict(BESIDE["rating"]())
    return {key: value for key, value in there.items() if key in _OF_EVERY_RATING or not is_usual(value, usual[key])}


def _title(design: Design, document: Mapping[str, Any]) -> str:
    if isinstance(rack := design.described.get("rack"), Rack):
        teeth = " / ".join(map(str, [*(gear.teeth for gear in design.gears.values()), rack.teeth]))
        return f"{'helical' if rack.helix_angle else 'spur'} {'pinion and ' if design.gears else ''}rack, z = {teeth}"
    if design.kind is DesignKind.SPLINE:
        joint = document["joint"]
        what = " and ".join(design.gears)
        return f"splined {what}, {joint['standard']}, z = {joint['teeth']}, m = {format_number(joint['module'])} mm"
    if design.kind is DesignKind.SHAFT:
        shaft = document["shaft"]
        return f"shaft, {len(shaft['segments'])} segments, {len(shaft['bearings'])} bearings"
    teeth = " / ".join(str(gear.teeth) for gear in design.gears.values())
    if design.kind is DesignKind.PLANETARY:
        return f"planetary train of type {document['planetary']['set_type']}, z = {teeth}"
    double = any(gear.double_helix.present for gear in design.gears.values())
    helical = any(gear.helix_angle for gear in design.gears.values())
    teeth_are = "double helical" if double else "helical" if helical else "spur"
    internal = any(gear.internal for gear in design.gears.values())
    return f"{'internal ' if internal else ''}{teeth_are} {design.kind.value}, z = {teeth}"


def _input_text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        if isinstance(value[0], tuple):
            from gearcad.designs.cells import nested_text

            return nested_text(value)
        return " ... ".join(map(format_number, value))
    text = value if isinstance(value, str) else format_number(value)
    return f"{text} (assumed)" if is_assumed(value) else text
