"""Assembly sheets of gear pairs and planetary trains: views, mesh data and parts list."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property

from gearcad.core.records import Notice
from gearcad.drawing.drawing_subjects import DrawnGear, DrawnPair, DrawnTrain, material_text
from gearcad.drawing.gear_data_rows import GearDataRow
from gearcad.drawing.gear_sheet import DrawingSheet, mass_of_pair
from gearcad.drawing.layout import Arrangement, Fixed, View, Views, arranged
from gearcad.drawing.options import DrawingOptions, PartDrawing, SheetSize
from gearcad.drawing.requirements import accuracy_grade_of
from gearcad.drawing.sheet_frame import Furnished, Furniture, title_values
from gearcad.drawing.sheet_tables import PartLine
from gearcad.drawing.sheet_template import SheetTemplate
from gearcad.drawing.views.pair_views import PairPlaces, pair_face, pair_section
from gearcad.drawing.views.train_views import PosedTrain, pitch_radii, train_face, train_section
from gearcad.drawing.words import Draughting, SheetWords, titled
from gearcad.geometry import Gear, GearPair, Rack, RackPair
from gearcad.planetary import PlanetaryTrain
from gearcad.solids.train_plan import stage_keys

_LEGIBLE = 80.0
"""Least overall size (mm of paper) of an assembly; a smaller one is drawn on larger paper if that makes it larger."""


@dataclass(frozen=True, kw_only=True)
class AssemblySheet:
    """The content of an assembly sheet: furniture, rows, and views at any scale. `extent` (mm) is the largest overall size.

    `mass` (kg) is the mass of all parts; None where it is not known.
    """

    furniture: Furniture
    rows: Sequence[GearDataRow]
    views: Callable[[Draughting], tuple[View, ...]]
    title: str
    document_type: str
    extent: float
    mass: float | None = None

    def drawn(self, name: str, notices: Sequence[Notice] = ()) -> DrawingSheet:
        """Return the sheet on the paper and at the scale that the options ask for, else at those the layout finds.

        If the options ask for neither and the assembly would be small, larger paper is taken. Raises ParameterError where the
        paper or scale asked for has no room.
        """
        options, found = self.furniture.options, self._found
        shown = {key: value for row in self.rows for key, value in row.numbers.items()}
        if self.mass is not None:
            shown["mass"] = self.mass
        return DrawingSheet(
            name=name,
            title=options.title or self.title,
            number=options.number,
            size=found.size,
            scale=found.factor,
            language=options.language,
            figure=found.figure,
            shown=shown,
            notices=(*notices, *self._furnished(found.sheet, found.scale).notices),
        )

    @cached_property
    def _found(self) -> Arrangement:
        options = self.furniture.options
        found = self._on(options.sheet)
        if options.sheet is SheetSize.AUTO and options.scale == "auto" and self.extent * found.factor < _LEGIBLE:
            larger = (each for each in SheetSize if each is not SheetSize.AUTO and each.size[0] > found.size[0])
            found = next((other for each in larger if (other := self._on(each)).factor > found.factor), found)
        return found

    def _on(self, sheet: SheetSize) -> Arrangement:
        options, words = self.furniture.options, self.furniture.words
        return arranged(
            lambda scale: Views((self.views(Draughting(words, scale)),)),
            self._fixed,
            sheet=sheet,
            scale=options.scale,
            projection=options.projection,
        )

    def _fixed(self, size: SheetSize, scale: str) -> Fixed:
        found = self._furnished(size, scale)
        return Fixed(found.figure, found.free, found.taken)

    @cached_property
    def _furnished(self) -> Callable[[SheetSize, str], Furnished]:
        """The rest of a sheet by its size and scale, each made once."""
        return cache(self._furnish)

    def _furnish(self, size: SheetSize, scale: str) -> Furnished:
        options, words = self.furniture.options, self.furniture.words
        values = title_values(
            options,
            words,
            title=self.title,
            document_type=self.document_type,
            size=size,
            scale=scale,
            mass=self.mass,
        )
        return self.furniture.on(size, values)


@dataclass(frozen=True, kw_only=True)
class Item(PartLine):
    """A line of the parts list; `key` is the role of the part."""

    key: str


def pair_items(
    drawn: DrawnPair, options: DrawingOptions, parts: Mapping[str, PartDrawing], words: SheetWords
) -> tuple[Item, ...]:
    """Return the parts list lines of a pair: the pinion, then its mate."""
    return tuple(
        _item(number, 1, part.role, part, "pinion" if number == 1 else _kind(part.gear), options, parts, words)
        for number, part in enumerate(drawn.parts, 1)
    )


def train_items(
    drawn: DrawnTrain, plan: PosedTrain, options: DrawingOptions, parts: Mapping[str, PartDrawing], words: SheetWords
) -> tuple[Item, ...]:
    """Return the parts list lines of a train: its gears in their order, planets with their number, and the carrier if it is
    drawn.
    """
    known = {part.role: part for part in drawn.parts}
    found = []
    for number, (key, kind) in enumerate(_kinds(plan), 1):
        quantity = plan.train.planets if kind == "planet" else 1
        part = known.get(key) or DrawnGear(role=key, gear=plan.layout.bodies[key].gear)
        found.append(_item(number, quantity, key, part, kind, options, parts, words))
    if plan.carrier is not None:
        name = plan.train.carrier.name
        title = titled(words, "carrier", name)
        found.append(Item(key=name, item=len(found) + 1, quantity=1, title=title))
    return tuple(found)


def member_title(train: PlanetaryTrain, name: str, words: SheetWords) -> str:
    """Return the title of a member: a central gear or the carrier."""
    internal = {central.name: central.gear.internal for central in train.centrals}
    kind = "carrier" if name not in internal else "ring" if internal[name] else "sun"
    return titled(words, kind, name)


def _kinds(plan: PosedTrain) -> Iterator[tuple[str, str]]:
    """Yield the key of each gear with the word for its kind."""
    train = plan.train
    for central in train.centrals:
        yield central.name, "ring" if central.gear.internal else "sun"
    yield from ((rim.name, "planet") for rim in train.rims)
    for number, gear in enumerate(plan.layout.stages):
        yield gear.body.key, _kind(gear.body.gear) if number % 2 else "pinion"


def _kind(gear: Gear | Rack) -> str:
    if isinstance(gear, Rack):
        return "rack"
    return "ring" if gear.internal else "wheel"


def _item(
    number: int,
    quantity: int,
    key: str,
    part: DrawnGear,
    kind: str,
    options: DrawingOptions,
    parts: Mapping[str, PartDrawing],
    words: SheetWords,
) -> Item:
    own = options.of_part(parts.get(key), alone=False)
    return Item(
        key=key,
        item=number,
        quantity=quantity,
        number=own.number,
        title=own.title or titled(words, kind, part.gear.name, key),
        material=material_text(part, own, words),
    )


def pair_rows(drawn: DrawnPair, words: SheetWords) -> tuple[GearDataRow, ...]:
    """Return the rows of a pair's data table in order: axes, teeth, backlash, accuracy."""
    return tuple(_pair_rows(drawn, words))


def _pair_rows(drawn: DrawnPair, words: SheetWords) -> Iterator[GearDataRow]:
    pair = drawn.pair
    first = drawn.parts[0].gear
    yield distance_row(pair, words)
    if isinstance(pair, GearPair) and pair.axial_offset:
        yield _data_row(
            "axial_offset", words, "", words.shortest(pair.axial_offset, 3), {"pair.axial_offset": pair.axial_offset}, item="2"
        )
    numbers = {"pinion.normal_module": first.normal_module}
    yield _data_row("normal_module", words, "m_n", words.shortest(first.normal_module, 6), numbers)
    yield _teeth(drawn, words)
    if isinstance(pair, GearPair):
        ratio = pair.gear_ratio
        yield _data_row("gear_ratio", words, "u", words.number(ratio, 4), {"pair.gear_ratio": ratio})
    else:
        travel = pair.travel_per_revolution
        length = pair.rack.length
        yield _data_row("rack_length", words, "L", words.shortest(length, 3), {f"{drawn.parts[1].role}.length": length})
        yield _data_row("travel", words, "", words.number(travel, 3), {"pair.travel_per_revolution": travel})
    if first.helix_angle:
        yield _helix(first, pair, words)
    for name, symbol in (("circumferential_backlash", "j_wt"), ("normal_backlash", "j_bn")):
        yield backlash_row(name, symbol, pair, words)
    for number, part in enumerate(drawn.parts, 1):
        if isinstance(part.gear, Rack):
            yield _data_row("accuracy", words, "", f"— ({words['data.not_of_racks']})", {}, item=str(number))
            continue
        grade = accuracy_grade_of(part)
        assumed = f" ({words['assembly.assumed']})" if part.grade is None else ""
        text = f"{grade}  {part.accuracy.value}{assumed}"
        yield _data_row("accuracy", words, "", text, {f"{part.role}.tolerances.grade": grade}, item=str(number))


def distance_row(pair: GearPair | RackPair, words: SheetWords) -> GearDataRow:
    """Return the row of the centre distance with its allowance, or of a pinion's mounting distance from a rack's reference
    line (mm).
    """
    if isinstance(pair, RackPair):
        value = pair.mounting_distance
        return _data_row("mounting_distance", words, "H", words.number(value, 3), {"pair.mounting_distance": value})
    text, numbers = words.number(abs(pair.centre_distance), 3), {"pair.centre_distance": pair.centre_distance}
    if pair.centre_distance_tolerance is not None:
        text += f" ±{words.shortest(pair.centre_distance_allowance / 1000, 4)}"
        numbers["pair.backlash_limits.centre_distance_allowance"] = pair.centre_distance_allowance
    return _data_row("centre_distance", words, "a", text, numbers)


def backlash_row(name: str, symbol: str, pair: GearPair | RackPair, words: SheetWords) -> GearDataRow:
    """Return the row of a backlash (mm) by its name ("normal_backlash"): limits if tolerances are known, else the nominal
    value.
    """
    limits = pair.backlash_limits if isinstance(pair, GearPair) else None
    if limits is None:
        value = getattr(pair, name)
        return _data_row(name, words, symbol, words.number(value, 3), {f"pair.{name}": value})
    kind = name.removesuffix("_backlash")
    found = {f"pair.backlash_limits.{kind}_{end}": getattr(limits, f"{kind}_{end}") for end in ("greatest", "least")}
    greatest, least = (words.number(value, 3) for value in found.values())
    return GearDataRow(key=name, words=words[f"assembly.{name}"], symbol=symbol, limits=(greatest, least), numbers=found)


def _teeth(drawn: DrawnPair, words: SheetWords) -> GearDataRow:
    """Return the row with the numbers of teeth of both parts; a ring's number is negative, as in its own table."""
    counts = {f"{part.role}.teeth": float(part.gear.teeth or 0) for part in drawn.parts}
    text = " / ".join(words.number(count, 0) for count in counts.values())
    return _data_row("teeth", words, "z_1 / z_2", text, counts, first="1", second="2")


def _helix(gear: Gear | Rack, pair: GearPair | RackPair, words: SheetWords) -> GearDataRow:
    """Return the row of the pinion's helix angle (degrees) and hand; a double helical pinion has both hands."""
    angle = gear.helix_angle
    hand = "right" if angle > 0 else "left"
    if isinstance(pair, GearPair) and pair.double_helical:
        hand = "double_helical"
    text = f"{words.number(abs(angle), 4)}° {words[f'assembly.{hand}']}"
    return _data_row("helix_angle", words, "β", text, {"pinion.helix_angle": angle}, item="1")


def _data_row(key: str, words: SheetWords, symbol: str, text: str, numbers: Mapping[str, float], **named: str) -> GearDataRow:
    label = words[f"assembly.{key}"].format(**named)
    return GearDataRow(key=key, words=label, symbol=symbol, text=text, numbers=numbers)


NAME = "assembly"
"""Name of the sheet, and of its files."""

_Z_TO_THE_LEFT = -1
"""Direction of z in the section: to the left, so that the end shown in the other view is at its left."""

_SAME_PITCH = 5e-4
"""Difference of diameters (mm) that three decimals do not show."""


def draw_pair(drawn: DrawnPair, options: DrawingOptions, parts: Mapping[str, PartDrawing] | None = None) -> DrawingSheet:
    """Return the sheet of a pair; `parts` are the options of the parts' own sheets, by their roles ("pinion", "wheel",
    "rack").

    Raises ParameterError where sheet or scale asked for have no room for it.
    """
    template = SheetTemplate.of(options.template)
    words = template.words(options.language)
    pair = drawn.pair
    rows, places = pair_rows(drawn, words), PairPlaces.of(pair)
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["assembly.data"],
        notes=tuple(pair_remarks(drawn, words)),
        parts=pair_items(drawn, options, parts or {}, words),
    )
    sheet = AssemblySheet(
        furniture=furniture,
        rows=rows,
        views=lambda draughting: (pair_section(pair, draughting, _Z_TO_THE_LEFT), pair_face(pair, draughting)),
        title=drawn.name,
        document_type=words["frame.document_assembly"],
        extent=max(places.front.width, places.front.height, places.extent.width),
        mass=mass_of_pair(drawn),
    )
    return sheet.drawn(NAME, tuple(pair_notices(pair)))


def pair_remarks(drawn: DrawnPair, words: SheetWords) -> Iterator[str]:
    """Yield notes on the views: pitch circles that differ from the reference circles, and an outside diameter that is
    assumed.
    """
    pair = drawn.pair
    if isinstance(pair, RackPair):
        if abs(pair.pitch_line_height) > _SAME_PITCH:
            height = words.number(pair.pitch_line_height, 3, signed=True)
            yield words["assembly.note_pitch_line"].format(height=height)
        return
    working = pair.working_pitch_diameters
    if abs(working.pinion - pair.pinion.reference_diameter) > _SAME_PITCH:
        sizes = (f"{item}: ⌀{words.number(abs(diameter), 3)}" for item, diameter in enumerate(working, 1))
        yield words["assembly.note_pitch"].format(diameters="; ".join(sizes))
    if pair.internal and pair.wheel.body.rim_diameter is None:
        yield words["assembly.note_rim"].format(item=2)


def pair_notices(pair: GearPair | RackPair) -> Iterator[Notice]:
    """Yield notices of the sheet of a pair: distances without limits, and an outside diameter that is assumed."""
    if isinstance(pair, RackPair):
        yield Notice(
            "no-limits",
            "the sheet shows it without limits, because racks have none here: give them in notes",
            where="mounting distance",
        )
    if isinstance(pair, GearPair) and pair.centre_distance_tolerance is None:
        text = 'the sheet has it without limits: none are given (centre_distance_tolerance in [pair], such as "js7")'
        yield Notice("no-limits", text, where="centre distance")
    if isinstance(pair, GearPair) and pair.internal and pair.wheel.body.rim_diameter is None:
        yield Notice("rim-assumed", "the outside that is drawn is assumed: body.rim_diameter is not given", where="wheel")


def train_rows(plan: PosedTrain, items: Mapping[str, int], words: SheetWords) -> tuple[GearDataRow, ...]:
    """Return the rows of a train's data table in order: train, meshes, stages. `items` are item numbers by the keys of
    gears.
    """
    return tuple(_train_rows(plan.train, items, words))


def _train_rows(train: PlanetaryTrain, items: Mapping[str, int], words: SheetWords) -> Iterator[GearDataRow]:
    titles = {name: member_title(train, name, words) for name in (train.input, train.output)}
    if train.ratio is not None:
        numbers = {"planetary.ratio": train.ratio}
        input_end, output_end = map(words.within_text, titles.values())
        yield _data_row("ratio", words, "i", words.number(train.ratio, 4), numbers, input=input_end, output=output_end)
    else:
        yield _data_row("input_output", words, "", " / ".join(titles.values()), {})
    fixed = words["assembly.no_fixed"] if train.fixed is None else member_title(train, train.fixed, words)
    yield _data_row("fixed", words, "", fixed, {})
    yield _data_row("planets", words, "N", str(train.planets), {"planetary.planets": float(train.planets)})
    distance = float(train.centre_distance)
    yield _data_row("centre_distance", words, "a", words.number(distance, 3), {"planetary.centre_distance": distance})
    for mesh in train.meshes:
        gears = {mesh.central.name: mesh.central.gear, mesh.rim.name: mesh.rim.gear}
        yield from _mesh(gears, mesh.pair, f"planetary.meshes.{mesh.name}", items, words)
    for stage, keys in zip(train.stages, stage_keys(train), strict=True):
        gears, of_stage = dict(zip(keys, stage.pair.gears, strict=True)), f"planetary.stages.{stage.name}"
        row = distance_row(stage.pair, words)
        label = words["assembly.stage_distance"].format(**_pair_of(gears, items))
        numbers = {name.replace("pair", of_stage, 1): value for name, value in row.numbers.items()}
        yield GearDataRow(key="stage_distance", words=label, symbol=row.symbol, text=row.text, numbers=numbers)
        yield from _mesh(gears, stage.pair, of_stage, items, words)


def _mesh(
    gears: Mapping[str, Gear], pair: GearPair, where: str, items: Mapping[str, int], words: SheetWords
) -> Iterator[GearDataRow]:
    """Yield the rows of two gears in mesh: module, teeth and backlash. `where` is the path of the pair in documents."""
    first, _ = gears
    numbers = {f"{first}.normal_module": pair.pinion.normal_module}
    numbers |= {f"{name}.teeth": float(gear.teeth) for name, gear in gears.items()}
    teeth = " / ".join(words.number(gear.teeth, 0) for gear in gears.values())
    module = words.shortest(pair.pinion.normal_module, 6)
    yield _data_row("mesh", words, "m_n; z", f"{module}; {teeth}", numbers, **_pair_of(gears, items))
    row = backlash_row("normal_backlash", "j_bn", pair, words)
    found = {name.replace("pair", where, 1): value for name, value in row.numbers.items()}
    label = words["assembly.mesh_backlash"].format(**_pair_of(gears, items))
    yield GearDataRow(key="mesh_backlash", words=label, symbol="j_bn", text=row.text, limits=row.limits, numbers=found)


def _pair_of(gears: Mapping[str, Gear], items: Mapping[str, int]) -> dict[str, str]:
    """Return the item numbers of two gears under the names that the words have in braces."""
    first, second = (str(items[key]) for key in gears)
    return {"first": first, "second": second}


_EVEN = 1e-3
"""Difference (degrees) up to which planets are equally spaced."""


def draw_train(drawn: DrawnTrain, options: DrawingOptions, parts: Mapping[str, PartDrawing] | None = None) -> DrawingSheet:
    """Return the sheet of a train; `parts` are the options of the gears' own sheets, by the names of members, rims and stage
    gears.

    Raises ParameterError where sheet or scale asked for have no room for it.
    """
    template = SheetTemplate.of(options.template)
    words, plan = template.words(options.language), PosedTrain(drawn.train)
    lines = train_items(drawn, plan, options, parts or {}, words)
    items = {line.key: line.item for line in lines}
    rows = train_rows(plan, items, words)
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["assembly.train_data"],
        notes=tuple(_train_remarks(plan, items, words)),
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
    return sheet.drawn(NAME, tuple(_train_notices(plan)))


def _train_remarks(plan: PosedTrain, items: Mapping[str, int], words: SheetWords) -> Iterator[str]:
    """Yield notes on the views: their section, the carrier, stages, planet angles, pitch circles and assumed outside
    diameters.
    """
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


def _differs(key: str, plan: PosedTrain) -> bool:
    """Return whether a gear has a pitch circle that differs from its reference circle."""
    body = plan.layout.bodies.get(key)
    if body is None:
        return False
    reference = abs(body.gear.reference_diameter) / 2
    return any(abs(radius - reference) > _SAME_PITCH / 2 for radius in pitch_radii(plan.train, key))


def _pitch(key: str, plan: PosedTrain, items: Mapping[str, int], words: SheetWords) -> str:
    """Return the item number and working pitch diameters (mm) of a gear as a text."""
    return f"{items[key]}: " + " / ".join(f"⌀{words.number(2 * radius, 3)}" for radius in pitch_radii(plan.train, key))


def _train_notices(plan: PosedTrain) -> Iterator[Notice]:
    yield Notice(
        "no-limits",
        "the sheet shows it without limits, because trains have none here: give them in notes",
        where="centre distance",
    )
    if plan.room:
        yield Notice("no-room", f"bodies are drawn over each other: {plan.room}")
    for name in plan.left_out:
        yield Notice("stage-not-shown", "has no room in the plane of the section", where=name)
    for key, body in plan.layout.bodies.items():
        if body.gear.internal and body.gear.body.rim_diameter is None:
            yield Notice("rim-assumed", "the outside that is drawn is assumed: body.rim_diameter is not given", where=key)
