"""The general arrangement of a planetary train: section, view along the axis, ratio and meshes, parts list."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from gearcad.drawing.frame import Furniture, SheetTemplate
from gearcad.drawing.options import DrawingOptions, PartDrawing
from gearcad.drawing.sheets.assembly import AssemblySheet
from gearcad.drawing.sheets.drawing import Sheet
from gearcad.drawing.sheets.items import train_items
from gearcad.drawing.sheets.train_rows import train_rows
from gearcad.drawing.subject import DrawnTrain
from gearcad.drawing.train_views import TrainPlan, pitch_radii, train_face, train_section
from gearcad.drawing.words import Words
from gearcad.notice import Notice

__all__ = ["draw_train"]

NAME = "assembly"
"""Of the sheet, and of its files."""

_Z_TO_THE_LEFT = -1
_EVEN = 1e-3
"""Degrees by which equal angles of planets may differ."""

_SAME_PITCH = 5e-4


def draw_train(drawn: DrawnTrain, options: DrawingOptions, parts: Mapping[str, PartDrawing] | None = None) -> Sheet:
    """The sheet of a train; `parts` is what the gears' own sheets have, by the names of members, rims and gears of stages.

    Raises ParameterError where sheet or scale asked for have no room for it.
    """
    template = SheetTemplate.of(options.template)
    words, plan = template.words(options.language), TrainPlan(drawn.train)
    lines = train_items(drawn, plan, options, parts or {}, words)
    items = {line.key: line.item for line in lines}
    rows = train_rows(plan, items, words)
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["assembly.train_data"],
        notes=tuple(_remarks(plan, items, words)),
        parts=lines,
    )
    sheet = AssemblySheet(
        furniture=furniture,
        rows=rows,
        views=lambda draughting: (train_section(plan, items, draughting, _Z_TO_THE_LEFT), train_face(plan, draughting)),
        title=drawn.name,
        document_type=words["frame.document_arrangement"],
        extent=plan.largest,
    )
    return sheet.drawn(NAME, tuple(_notices(plan)))


def _remarks(plan: TrainPlan, items: Mapping[str, int], words: Words) -> Iterator[str]:
    """What one must know of the views."""
    if plan.bent:
        yield words["assembly.note_section"]
    if plan.carrier is None:
        yield words["assembly.note_no_carrier"]
    else:
        yield words["assembly.note_plain_carrier"]
        yield words["assembly.note_face"]
    if plan.train.stages:
        yield words["assembly.note_stages"]
    if plan.left_out:
        yield words["assembly.note_left_out"].format(names=", ".join(plan.left_out))
    equal = 360 / plan.train.planets
    if any(abs(turn - number * equal) > _EVEN for number, turn in enumerate(sorted(plan.turns))):
        angles = ", ".join(f"{words.shortest(turn, 4)}°" for turn in plan.turns)
        yield words["assembly.note_angles"].format(angles=angles)
    if working := [_pitch(key, plan, items, words) for key in items if _differs(key, plan)]:
        yield words["assembly.note_pitch"].format(diameters="; ".join(working))
    for key, body in plan.layout.bodies.items():
        if body.gear.internal and body.gear.body.rim_diameter is None:
            yield words["assembly.note_rim"].format(item=items[key])


def _differs(key: str, plan: TrainPlan) -> bool:
    """Whether a gear has a pitch circle that is not its reference circle."""
    body = plan.layout.bodies.get(key)
    if body is None:
        return False
    reference = abs(body.gear.reference_diameter) / 2
    return any(abs(radius - reference) > _SAME_PITCH / 2 for radius in pitch_radii(plan.train, key))


def _pitch(key: str, plan: TrainPlan, items: Mapping[str, int], words: Words) -> str:
    """Item and working pitch diameters of a gear."""
    return f"{items[key]}: " + " / ".join(f"⌀{words.number(2 * radius, 3)}" for radius in pitch_radii(plan.train, key))


def _notices(plan: TrainPlan) -> Iterator[Notice]:
    yield Notice(
        "no-limits", "the sheet has it without limits: trains have none here, say them in notes", where="centre distance"
    )
    if plan.room:
        yield Notice("no-room", f"bodies are drawn over each other: {plan.room}")
    for name in plan.left_out:
        yield Notice("stage-not-shown", "has no room in the plane of the section", where=name)
    for key, body in plan.layout.bodies.items():
        if body.gear.internal and body.gear.body.rim_diameter is None:
            yield Notice("rim-assumed", "the outside that is drawn is assumed: body.rim_diameter is not given", where=key)
