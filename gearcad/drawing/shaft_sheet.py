"""Sheets of shafts: the assembly of a pair on its shafts and bearings, and each shaft with its lengths and diameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from gearcad.core.records import Notice, Role
from gearcad.drawing.assembly_sheets import NAME, AssemblySheet, Item, pair_items, pair_notices, pair_remarks, pair_rows
from gearcad.drawing.drawing_subjects import DrawnPair
from gearcad.drawing.gear_data_rows import GearDataRow
from gearcad.drawing.gear_sheet import DrawingSheet, mass_of_pair
from gearcad.drawing.options import DrawingOptions, PartDrawing
from gearcad.drawing.sheet_frame import Furniture
from gearcad.drawing.sheet_template import SheetTemplate
from gearcad.drawing.views.assembly_figures import Sectioned, cut_gear, pitch_lines
from gearcad.drawing.views.shaft_views import shaft_view
from gearcad.drawing.views.shafted_pair_views import shafted_section
from gearcad.drawing.words import SheetWords
from gearcad.geometry import GearPair
from gearcad.shafts.beam import ShaftBearing, SteppedShaft
from gearcad.solids.shaft_plan import SeatedShaft, TurnedPlan


@dataclass(frozen=True, kw_only=True)
class DrawnShaft:
    """A shaft to be drawn, by the name of its sheet; `seated` where it carries a gear of a pair."""

    name: str
    plan: TurnedPlan
    seated: SeatedShaft | None = None
    title: str = ""
    """Name of a shaft by itself."""

    @classmethod
    def of(cls, seated: SeatedShaft) -> DrawnShaft:
        """Return a shaft of a pair, as it is made."""
        return cls(name=seated.file, plan=seated.plan, seated=seated)

    @property
    def given(self) -> SteppedShaft:
        """The shaft with its bearings, as its spec has it."""
        return self.plan.shaft if self.seated is None else self.seated.given

    @property
    def toothed(self) -> Sectioned | None:
        """Section of the gear that is one piece with it, z from the shaft's left end."""
        if self.seated is None or not self.seated.one_piece:
            return None
        gear, start = self.seated.gear, self.seated.low + self.seated.gear.body.hub_ends[0] - self.seated.z
        lines = pitch_lines(start, start + gear.face_width, 0.0, gear.reference_diameter / 2)
        return Sectioned(cut_gear(gear, start), None, lines)

    @property
    def mass(self) -> float:
        """Mass (kg), without a gear that is one piece with it."""
        return self.plan.mass if self.seated is None else self.seated.own_mass


def draw_shaft(drawn: DrawnShaft, options: DrawingOptions, own: PartDrawing | None = None) -> DrawingSheet:
    """Return the sheet of a shaft; `own` are the options of its own sheet.

    Raises ParameterError where sheet or scale asked for have no room for it.
    """
    options = options.of_part(own, alone=drawn.seated is None)
    template = SheetTemplate.of(options.template)
    words = template.words(options.language)
    rows, toothed = tuple(shaft_rows(drawn, words)), drawn.toothed
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["of_shafts.data"],
        notes=() if toothed is None else (words["of_shafts.note_one_piece"],),
    )
    sheet = AssemblySheet(
        furniture=furniture,
        rows=rows,
        views=lambda draughting: (shaft_view(drawn.plan, draughting, toothed),),
        title=f"{shaft_title(drawn.seated, words)} {drawn.title}".rstrip(),
        document_type=words["frame.document_part"],
        extent=drawn.plan.shaft.length,
        mass=None if drawn.toothed else drawn.mass,
    )
    notice = Notice("no-limits", "diameters and lengths are without limits: give those of seats in notes")
    return sheet.drawn(drawn.name, (notice,))


def shaft_title(seated: SeatedShaft | None, words: SheetWords) -> str:
    """Return the title of a shaft: by itself, that of pinion or wheel, or of one with its own teeth."""
    if seated is None:
        return words["of_shafts.shaft"]
    return words[f"of_shafts.{'toothed' if seated.one_piece and seated.role is Role.PINION else seated.role.value}_shaft"]


def shaft_rows(drawn: DrawnShaft, words: SheetWords) -> Iterator[GearDataRow]:
    """Yield the rows of a shaft's data: positions from the left end of the face's middle, the coupling and the bearings."""

    def row(key: str, value: float, *, name: str = "", number: int | None = None) -> GearDataRow:
        path = f"shaft.{key}" if number is None else f"shaft.bearing[{number}].position"
        label = words[f"of_shafts.{key}"] + (f" {name}" if name else "")
        return GearDataRow(key=key, words=label, text=words.shortest(value, 3), numbers={path: value})

    yield row("length", drawn.given.length)
    if drawn.seated is not None:
        yield row("mesh_position", drawn.seated.position)
    yield row("coupling", drawn.given.coupling)
    for number, bearing in enumerate(drawn.given.bearings):
        yield row("bearing_position", bearing.position, name=bearing.name or str(number + 1), number=number)


def bearing_title(bearing: ShaftBearing, words: SheetWords) -> str:
    """Return the title of a bearing: its kind and its name."""
    kind = "bearing" if bearing.kind is None else bearing.kind.replace(" ", "_")
    return f"{words[f'of_shafts.{kind}']} {bearing.name}".rstrip()


def _ring_text(bearing: ShaftBearing, words: SheetWords) -> str:
    """Return bore, outside diameter and width of a bearing, "" where they are not given."""
    return " × ".join(words.shortest(size, 3) for size in bearing.ring or ())


def shafted_items(
    drawn: DrawnPair, options: DrawingOptions, parts: Mapping[str, PartDrawing], words: SheetWords
) -> tuple[list[Item], dict[str, int]]:
    """Return the lines of the parts list: gears, shafts, bearings; and the item numbers of all, by what stands in the views.

    Bearings of one title are one line.
    """
    lines = list(pair_items(drawn, options, parts, words))
    numbers = {line.key: line.item for line in lines}
    for each in drawn.shafts:
        own = options.of_part(parts.get(each.file), alone=False)
        title = own.title or shaft_title(each, words)
        remarks = words["of_shafts.with_item"].format(item=numbers[each.role.value]) if each.one_piece else ""
        lines.append(Item(key=each.file, item=len(lines) + 1, number=own.number, title=title, remarks=remarks))
        numbers[each.file] = len(lines)
    for each in drawn.shafts:
        for number, bearing in enumerate(each.given.bearings):
            title, remarks = bearing_title(bearing, words), _ring_text(bearing, words)
            key = f"bearing {title} {remarks}"
            at = next((index for index, line in enumerate(lines) if line.key == key), None)
            if at is None:
                lines.append(Item(key=key, item=len(lines) + 1, title=title, remarks=remarks))
                at = len(lines) - 1
            else:
                lines[at] = replace(lines[at], quantity=lines[at].quantity + 1)
            numbers[f"{each.file}.{number}"] = lines[at].item
    return lines, numbers


def draw_shafted_pair(
    drawn: DrawnPair, options: DrawingOptions, parts: Mapping[str, PartDrawing] | None = None
) -> DrawingSheet:
    """Return the sheet of a pair on its shafts and bearings; `parts` are the options of the sheets of gears and shafts.

    Raises ParameterError where sheet or scale asked for have no room for it.
    """
    pair, shafts = drawn.pair, drawn.shafts
    assert isinstance(pair, GearPair)
    template = SheetTemplate.of(options.template)
    words = template.words(options.language)
    lines, numbers = shafted_items(drawn, options, parts or {}, words)
    rows = pair_rows(drawn, words)
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["assembly.data"],
        notes=(*pair_remarks(drawn, words), *_remarks(shafts, words)),
        parts=lines,
    )
    gears = mass_of_pair(drawn)
    sheet = AssemblySheet(
        furniture=furniture,
        rows=rows,
        views=lambda draughting: (shafted_section(pair, shafts, numbers, draughting),),
        title=drawn.name,
        document_type=words["frame.document_assembly"],
        extent=max(each.given.length for each in shafts),
        mass=None if gears is None else gears + sum(each.own_mass for each in shafts),
    )
    return sheet.drawn(NAME, (*pair_notices(pair), *_notices(shafts)))


def _remarks(shafts: tuple[SeatedShaft, ...], words: SheetWords) -> Iterator[str]:
    sized = all(bearing.ring is not None for each in shafts for bearing in each.given.bearings)
    yield words["of_shafts.note_sized_bearings" if sized else "of_shafts.note_bearings"]
    if len(shafts) < len(Role):
        missing = next(role for role in Role if role not in {each.role for each in shafts})
        yield words["of_shafts.note_no_shaft"].format(item=list(Role).index(missing) + 1)


def _notices(shafts: tuple[SeatedShaft, ...]) -> Iterator[Notice]:
    for each in shafts:
        yield from each.notices
