"""Drawings of a verification: their sheets made as DXF files, and what each of them must show."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

from gearcad.core.errors import GearcadError
from gearcad.designs import ToothedDesign
from gearcad.drawing.drawing_subjects import DrawnGear, DrawnPair, DrawnTrain
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.shaft_sheet import DrawnShaft, shaft_title
from gearcad.drawing.sheet_template import SheetTemplate
from gearcad.drawing.words import SheetWords, kind_of, titled
from gearcad.geometry import Gear, Rack
from gearcad.geometry.bore_teeth import free_bore
from gearcad.jobs.draw import ASSEMBLY, Draw, SheetFormat, drawn_assembly, drawn_gears, drawn_shafts
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.drawing_figures import TableFigure, gear_figures, material_words, pair_figures, train_figures
from gearcad.verification.drawing_sheets import ExpectedSheet, judge_sheet
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.spline_figures import spline_figures

_PER_CUBIC_MILLIMETRE = 1e-9
"""Factor from kg/m³ to kg/mm³."""


def make_sheets(design: ToothedDesign, folder: Path) -> str:
    """Write the sheets of a design as DXF files to a folder, and return the reason where they cannot be drawn."""
    job = Draw(formats=(SheetFormat.DXF,))
    try:
        result = job.run(design)
    except GearcadError as error:
        return f"no drawing can be made: {error}"
    for name, write in job.files(result).items():
        if name.endswith(SheetFormat.DXF.value):
            write(folder / name)
    return ""


def judge_sheets(
    design: ToothedDesign, folder: Path, exact: Mapping[str, ExactPart], data: dict[str, Any], reason: str = ""
) -> Iterator[Claim]:
    """Judge the sheets of a design in a folder; `exact` are its parts by their keys, `data` the content of data.json.

    `reason` says why there are none. A folder without any sheet is not judged; a single missing sheet has failed.
    """
    if reason:
        yield Judge(ClaimSubject.DRAWING, VerificationLevel.FILES, design.name, "ezdxf").not_judged("drawings", reason)
        return
    gears, assembly = drawn_gears(design), drawn_assembly(design)
    shafts = {each.name: each for each in drawn_shafts(design)}
    names = [*([] if assembly is None else [ASSEMBLY]), *(gear.role for gear in gears), *shafts]
    paths = {name: folder / ("drawing.dxf" if len(names) == 1 else f"drawing-{name}.dxf") for name in names}
    if not any(path.is_file() for path in paths.values()):
        judge = Judge(ClaimSubject.DRAWING, VerificationLevel.FILES, design.name, "ezdxf")
        yield judge.not_judged("drawings", f"no file {next(iter(paths.values())).name} in the folder")
        return
    for name, path in paths.items():
        if not path.is_file():
            judge = Judge(ClaimSubject.DRAWING, VerificationLevel.FILES, path.name, "file system")
            yield judge.holds("is there", False, place=f"no file {path.name}")
            continue
        try:
            if name in shafts:
                expected = _of_shaft(design, shafts[name])
            else:
                expected = _expected(design, name, gears, assembly, exact, data)
            yield from judge_sheet(path, expected)
        except Exception as error:  # what a broken file does to a reader is not known beforehand
            said = f"{type(error).__name__}: {error}"
            yield Judge(ClaimSubject.DRAWING, VerificationLevel.FILES, path.name, "gearcad").holds(
                "can be judged", False, place=said
            )


def _expected(
    design: ToothedDesign,
    name: str,
    gears: tuple[DrawnGear, ...],
    assembly: DrawnPair | DrawnTrain | None,
    exact: Mapping[str, ExactPart],
    data: dict[str, Any],
) -> ExpectedSheet:
    """What the sheet of a name must show."""
    options = design.drawing or DrawingOptions()
    words = SheetTemplate.of(options.template).words(options.language)
    drawn = next((gear for gear in gears if gear.role == name), None)
    if assembly is not None and drawn is None:
        return _of_assembly(assembly, options, words, exact, data)
    assert drawn is not None  # of which the names are
    own = options.of_part(design.drawings.get(name), alone=assembly is None and len(gears) == 1)
    words = SheetTemplate.of(own.template).words(own.language)
    part = drawn.gear
    splined = drawn.spline is not None
    return ExpectedSheet(
        heading=words["splines.title" if splined else "data.title"],
        rows=spline_figures(drawn, data, words, own) if splined else gear_figures(drawn, data[name], words, own),
        title=own.title or titled(words, kind_of(name, part), "gear" if part.name == name else part.name),
        sizes=dict(_sizes_of_spline(data[name]) if splined else _sizes(part, data[name])),
        texts={key.replace("_", " "): text for key, text in material_words(drawn, words, own).items()},
        decimal_mark=own.language.decimal_mark,
        mass=_mass(drawn, exact),
    )


def _of_assembly(
    assembly: DrawnPair | DrawnTrain,
    options: DrawingOptions,
    words: SheetWords,
    exact: Mapping[str, ExactPart],
    data: dict[str, Any],
) -> ExpectedSheet:
    """What the sheet of a pair or a train must show."""
    mass: float | None = None
    if isinstance(assembly, DrawnPair):
        heading, rows = words["assembly.data"], pair_figures(data, assembly.parts, words)
        masses = [each for part in assembly.parts if (each := _mass(part, exact)) is not None]
        mass = sum(masses) + _mass_of_shafts(assembly) if len(masses) == len(assembly.parts) else None
        pair = data["pair"]
        sizes = {} if "mounting_distance" in pair else {"centre distance": abs(pair["centre_distance"])}
    else:
        heading, rows = words["assembly.train_data"], train_figures(data, assembly.train, words)
        sizes = {"centre distance": abs(data["planetary"]["centre_distance"])}
    title = options.title or assembly.name
    return ExpectedSheet(
        heading=heading, rows=rows, title=title, sizes=sizes, decimal_mark=options.language.decimal_mark, mass=mass
    )


def _mass_of_shafts(assembly: DrawnPair) -> float:
    """Mass (kg) of the shafts of a pair, without what is within a gear that is one piece with its shaft."""
    found = 0.0
    for each in assembly.shafts:
        within = (each.low - each.z, each.high - each.z) if each.one_piece else (0.0, 0.0)
        for part, (start, end) in zip(each.shaft.segments, pairwise(each.shaft.ends), strict=True):
            inside = max(min(end, within[1]) - max(start, within[0]), 0.0)
            found += part.density * part.area * (end - start - inside) * _PER_CUBIC_MILLIMETRE
    return found


def _of_shaft(design: ToothedDesign, drawn: DrawnShaft) -> ExpectedSheet:
    """Return the content that the sheet of a shaft must have."""
    options = (design.drawing or DrawingOptions()).of_part(design.drawings.get(drawn.name), alone=drawn.seated is None)
    words = SheetTemplate.of(options.template).words(options.language)
    shaft, toothed = drawn.given, drawn.toothed is not None
    figures = {"length": shaft.length, "coupling": shaft.coupling}
    if drawn.seated is not None:
        figures["mesh_position"] = drawn.seated.position
    rows = [TableFigure(words=words[f"of_shafts.{key}"], values=((value, 0),)) for key, value in figures.items()]
    for number, bearing in enumerate(shaft.bearings, 1):
        label = f"{words['of_shafts.bearing_position']} {bearing.name or number}"
        rows.append(TableFigure(words=label, values=((bearing.position, 0),)))
    within = (
        None if drawn.seated is None or not toothed else (drawn.seated.low - drawn.seated.z, drawn.seated.high - drawn.seated.z)
    )
    sizes = {"length": shaft.length}
    for number, (each, ends) in enumerate(zip(drawn.plan.shaft.segments, pairwise(drawn.plan.shaft.ends), strict=True)):
        if within is None or not (within[0] - _END < ends[0] and ends[1] < within[1] + _END):
            sizes[f"diameter of segment {number + 1}"] = each.outer_diameter
            if each.inner_diameter and not toothed:
                sizes[f"bore of segment {number + 1}"] = each.inner_diameter
    return ExpectedSheet(
        heading=words["of_shafts.data"],
        rows=rows,
        title=options.title or shaft_title(drawn.seated, words),
        sizes=sizes,
        decimal_mark=options.language.decimal_mark,
        mass=None
        if toothed
        else math.fsum(each.density * each.area * each.length for each in drawn.plan.shaft.segments) * _PER_CUBIC_MILLIMETRE,
    )


_END = 1e-6
"""Distance (mm) up to which ends of segments are those of a gear."""


def _mass(drawn: DrawnGear, exact: Mapping[str, ExactPart]) -> float | None:
    """Mass (kg) by the exact volume; None without a material, and for a ring without a rim diameter."""
    part = drawn.gear
    if drawn.material is None or (isinstance(part, Gear) and part.internal and part.body.rim_diameter is None):
        return None
    return exact[drawn.role].moments.volume * drawn.material.density * _PER_CUBIC_MILLIMETRE


def _sizes_of_spline(data: dict[str, Any]) -> Iterator[tuple[str, float]]:
    """Sizes (mm) of a splined part that its views must show, by their names."""
    yield from (("face width", data["length"]), ("tip diameter", data["tip_diameter"]))
    for name in ("bore", "outer_diameter"):
        if data.get(name):
            yield name.replace("_", " "), data[name]


def _sizes(part: Gear | Rack, data: dict[str, Any]) -> Iterator[tuple[str, float]]:
    """Sizes (mm) of a part that its views must show, by their names."""
    yield "face width", data["face_width"]
    if isinstance(part, Rack):
        yield from (("length", data["length"]), ("height", data["total_height"]), ("reference height", data["height"]))
        return
    yield "tip diameter", abs(data["tip_diameter"])
    body = data["body"]
    for name in ("bore", "hub_diameter", "rim_diameter", "bolt_circle", "keyway_width"):
        if body[name]:
            yield name.replace("_", " "), body[name]
    if body.get("bore_spline"):
        yield "tip diameter of the splined bore", free_bore(part)
    if body["bolt_holes"]:
        yield "bolt diameter", body["bolt_diameter"]
    if data["double_helix"]["gap_width"]:
        yield "gap width", data["double_helix"]["gap_width"]
