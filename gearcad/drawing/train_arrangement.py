"""Arrangement sheet of a train of pairs: its axes with centre distances, names of shafts and meshes, and a table of ratios."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial

from gearcad.core.records import Notice
from gearcad.drawing.assembly_sheets import AssemblySheet, Item, distance_row
from gearcad.drawing.dimensions import leader
from gearcad.drawing.drawing_symbols import centre_cross, centre_line
from gearcad.drawing.gear_data_rows import GearDataRow
from gearcad.drawing.gear_sheet import DrawingSheet
from gearcad.drawing.layout import Candidates, View
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.shapes import Box, Figure, Pen, Point
from gearcad.drawing.sheet_frame import Furniture
from gearcad.drawing.sheet_template import SheetTemplate
from gearcad.drawing.views.assembly_figures import BEYOND_AXIS, FrontView, overall_height, overall_width
from gearcad.drawing.words import Draughting, SheetWords
from gearcad.solids.gear_train_plan import GearTrainPlan, StandingGear, TrainMeshPlan

NAME = "arrangement"
"""Name of the sheet, and of its files."""


@dataclass(frozen=True, kw_only=True)
class DrawnArrangement:
    """A train of pairs in mesh, the names of what turns on each line of shafts, and its ratio.

    `ratio` is the speed of `first` over that of `last`, by their names; negative where they turn in opposite senses.
    """

    plan: GearTrainPlan
    lines: Mapping[int, str] = field(default_factory=dict)
    first: str = ""
    last: str = ""
    ratio: float = 1.0


def draw_arrangement(drawn: DrawnArrangement, options: DrawingOptions) -> DrawingSheet:
    """Return the sheet of a train, seen along its axes from +z. Raises ParameterError where sheet or scale have no room."""
    template = SheetTemplate.of(options.template)
    words, plan = template.words(options.language), drawn.plan
    rows = tuple(_rows(drawn, words))
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["assembly.train_data"],
        notes=(words["arrangement.note"], *([words["arrangement.note_assumed"]] if _assumed(plan) else [])),
        parts=tuple(_items(plan)),
    )
    fronts = [_front(gear, plan) for gear in plan.gears]
    whole = Box.of_all(Box(*front.centre, *front.centre).grown(front.reach) for front in fronts)
    sheet = AssemblySheet(
        furniture=furniture,
        rows=rows,
        views=lambda draughting: (_face(drawn, fronts, whole, draughting),),
        title=plan.name,
        document_type=words["frame.document_arrangement"],
        extent=max(whole.width, whole.height),
    )
    return sheet.drawn(NAME, (_no_limits(), *plan.notices))


def _no_limits() -> Notice:
    """Return the notice of centre distances without limits."""
    return Notice(
        "no-limits", "centre distances are without limits, but where a pair has centre_distance_tolerance: give others in notes"
    )


def _assumed(plan: GearTrainPlan) -> bool:
    return any(notice.code == "assumed-places" for notice in plan.notices)


def _items(plan: GearTrainPlan) -> Iterator[Item]:
    """Yield the lines of the parts list: gears, then shafts."""
    for number, name in enumerate([*(each.name for each in plan.gears), *(each.name for each in plan.standing_shafts)], 1):
        yield Item(key=name, item=number, quantity=1, title=name)


def _rows(drawn: DrawnArrangement, words: SheetWords) -> Iterator[GearDataRow]:
    """Yield the rows of the table: the ratio of the train, then distance, angle, teeth and ratio of each mesh."""
    label = words["assembly.ratio"].format(input=drawn.first, output=drawn.last)
    yield GearDataRow(
        key="ratio", words=label, symbol="i", text=words.number(drawn.ratio, 4), numbers={"train.ratio": drawn.ratio}
    )
    for mesh in drawn.plan.meshes:
        pair, where = mesh.pair, f"meshes.{mesh.name}"
        row = distance_row(pair, words)
        numbers = {f"{where}.{name}": value for name, value in row.numbers.items()}
        yield GearDataRow(
            key="distance", words=f"{mesh.name}: {words.within_text(row.words)}", symbol="a", text=row.text, numbers=numbers
        )
        angle = {f"mesh.{mesh.name}.mesh_angle": mesh.angle}
        text = f"{words.shortest(mesh.angle, 4)}°"
        yield GearDataRow(key="angle", words=words["arrangement.angle"].format(mesh=mesh.name), text=text, numbers=angle)
        module = pair.pinion.normal_module
        teeth = f"{words.shortest(module, 6)}; {words.number(pair.pinion.teeth, 0)} / {words.number(pair.wheel.teeth, 0)}"
        counts = {f"{where}.{role.value}.teeth": float(gear.teeth) for role, gear in pair.gears.items()}
        numbers = {f"{where}.pinion.normal_module": module, **counts}
        label = words["arrangement.teeth"].format(mesh=mesh.name)
        yield GearDataRow(key="teeth", words=label, symbol="m_n; z", text=teeth, numbers=numbers)
        numbers = {f"{where}.pair.gear_ratio": pair.gear_ratio}
        label = words["arrangement.ratio"].format(mesh=mesh.name)
        yield GearDataRow(key="gear_ratio", words=label, symbol="u", text=words.number(pair.gear_ratio, 4), numbers=numbers)


# ---------------------------------------------------------------------- the view


def _front(gear: StandingGear, plan: GearTrainPlan) -> FrontView:
    """Return the view of a gear: tip and pitch circles, dashed behind a larger gear on the same axis that is nearer."""
    radii = {
        round(abs(mesh.pair.working_pitch_diameters.pick(key.role)) / 2, 9): None
        for key, body in plan.bodies.items()
        if body == gear.key
        for mesh in [plan.mesh(key.mesh)]
    }
    behind = any(
        other.line == gear.line and other.z > gear.z and abs(other.gear.tip_diameter) > abs(gear.gear.tip_diameter)
        for other in plan.gears
    )
    return FrontView(gear.gear, (gear.x, gear.y), tuple(radii), Pen.HIDDEN if behind else Pen.OUTLINE, bare=True)


def _face(drawn: DrawnArrangement, fronts: list[FrontView], whole: Box, draughting: Draughting) -> View:
    """Return the view along the axes, with the names of shafts at their axes, those of meshes at their pitch points."""
    scale, plan = draughting.scale, drawn.plan
    figure = Figure.of(*(front.figure(scale) for front in fronts), *_centre_lines(plan, fronts, scale))
    box = Box(*(scale * side for side in whole))
    marks: list[Candidates] = []
    for line, name in drawn.lines.items():
        x, y = plan.axes[line]
        marks.append(partial(leader, (scale * x, scale * y), name, draughting))
    for mesh in plan.meshes:
        text = f"{mesh.name}: a = {draughting.words.number(abs(mesh.pair.centre_distance), 3)}"
        marks.append(partial(leader, _paper(_pitch_point(plan, mesh), scale), text, draughting))
    marks += [partial(overall_height, box, whole.height, draughting), partial(overall_width, box, whole.width, draughting)]
    return View("face", figure, tuple(marks))


def _centre_lines(plan: GearTrainPlan, fronts: list[FrontView], scale: float) -> Iterator[Figure]:
    for x, y in plan.axes.values():
        reach = max(front.reach for front in fronts if math.dist(front.centre, (x, y)) < 1e-6)
        yield centre_cross((scale * x, scale * y), scale * reach + BEYOND_AXIS)
    for mesh in plan.meshes:
        ends = [_paper(plan.axes[line], scale) for line in mesh.lines]
        if min(abs(ends[0][0] - ends[1][0]), abs(ends[0][1] - ends[1][1])) > 1e-6:  # else it is on the cross
            yield centre_line(*ends)


def _pitch_point(plan: GearTrainPlan, mesh: TrainMeshPlan) -> Point:
    (x, y), radius = plan.axes[mesh.lines.pinion], mesh.pair.working_pitch_diameters.pinion / 2
    angle = math.radians(mesh.angle + (180.0 if mesh.pair.internal else 0.0))
    return x + radius * math.cos(angle), y + radius * math.sin(angle)


def _paper(point: Point, scale: float) -> Point:
    return scale * point[0], scale * point[1]
