"""The sheet of one gear: its views, a tooth in detail, gear data, notes, title block (ISO 2203, ISO 1340, ISO 7200)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial

from gearcad.drawing.frame import Furnished, Furniture, SheetTemplate, title_values
from gearcad.drawing.gear_data import Row, gear_notices, gear_rows
from gearcad.drawing.layout import Arrangement, Fixed, View, Views, arranged
from gearcad.drawing.marks import general_roughness
from gearcad.drawing.mass import mass_of
from gearcad.drawing.options import DrawingOptions, PartDrawing, SheetSize
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Box, Figure
from gearcad.drawing.sheets.drawing import Sheet
from gearcad.drawing.sheets.part_views import detail_blocks, part_rows
from gearcad.drawing.subject import DrawnGear
from gearcad.drawing.titles import kind_of, titled
from gearcad.drawing.words import Draughting, Size, Words
from gearcad.errors import ParameterError
from gearcad.geometry import Gear
from gearcad.notice import Notice

__all__ = ["draw_gear"]

_AIR = 4.0
"""From the frame, or what stands beside it, to the roughness of the rest."""

_LEGIBLE = 40.0
"""Least size (mm of paper) of views with their centre lines, where leaving something out makes them larger."""

_USUAL_CHAMFER = 45.0
"""An angle of chamfers that may be taken from either side."""


def draw_gear(drawn: DrawnGear, options: DrawingOptions, part: PartDrawing | None = None, *, alone: bool = True) -> Sheet:
    """The sheet of an external gear, a ring or a rack, as [drawing] and the gear's own table have it.

    `alone` where it is the only gear of its design: number, title and revisions of [drawing] are then its own. Raises
    ParameterError for a sheet or a scale that has no room, and for a template that cannot be used.
    """
    content = _Content.of(drawn, options.of_part(part, alone=alone))
    own = content.options
    found, notices = content.arranged()
    return Sheet(
        name=drawn.role,
        title=content.title,
        number=own.number,
        size=found.size,
        scale=found.factor,
        language=own.language,
        figure=found.figure,
        shown=content.shown,
        notices=(*content.furnished(found.sheet, found.scale).notices, *notices, *gear_notices(drawn, own)),
    )


@dataclass(frozen=True, kw_only=True)
class _Content:
    """What the sheet of a part says, whatever its size and scale."""

    drawn: DrawnGear
    options: DrawingOptions
    template: SheetTemplate
    words: Words
    requirements: Requirements
    rows: tuple[Row, ...]

    @classmethod
    def of(cls, drawn: DrawnGear, options: DrawingOptions) -> _Content:
        template = SheetTemplate.of(options.template)
        words = template.words(options.language)
        return cls(
            drawn=drawn,
            options=options,
            template=template,
            words=words,
            requirements=Requirements.of(drawn, options),
            rows=gear_rows(drawn, words, options),
        )

    @property
    def title(self) -> str:
        """As it was given, else the word for such a part, with its name if it has one."""
        role, gear = self.drawn.role, self.drawn.gear
        return self.options.title or titled(self.words, kind_of(role, gear), "gear" if gear.name == role else gear.name)

    @property
    def shown(self) -> Mapping[str, float]:
        """Numbers of the table by their keys, sizes of the views by their names among the requirements, and the mass (kg)."""
        numbers = {key: value for row in self.rows for key, value in row.numbers.items()}
        sizes = {each.name: getattr(self.requirements, each.name) for each in fields(self.requirements)}
        numbers |= {f"sizes.{name}": size.value for name, size in sizes.items() if isinstance(size, Size)}
        return numbers if self._mass is None else numbers | {"mass": self._mass}

    @property
    def _sizes(self) -> str:
        """Teeth, module and helix angle, for where nobody gave a supplementary title."""
        gear, words = self.drawn.gear, self.words
        assert gear.teeth is not None  # derived by now
        texts = [f"z = {words.number(gear.teeth, 0)}", f"mₙ = {words.shortest(gear.normal_module, 6)}"]
        return ", ".join([*texts, *([f"β = {words.shortest(abs(gear.helix_angle), 4)}°"] if gear.helix_angle else [])])

    def arranged(self) -> tuple[Arrangement, tuple[Notice, ...]]:
        """All that stands on the sheet; on one that was asked for without the tooth in detail, if all of it has no room or
        would be too small to be read. Raises ParameterError."""
        found = self._tried()
        if self.options.sheet is not SheetSize.AUTO and not self._is_legible(found):
            bare = self._tried(detailed=False)
            if isinstance(bare, Arrangement) and self._is_better(bare, found):
                left_out = Notice("drawing-without-detail", f"no room on {bare.sheet.value}", where="tooth in detail")
                return bare, (left_out, *self._small(bare))
        if isinstance(found, ParameterError):
            raise found
        return found, () if self.options.sheet is SheetSize.AUTO else self._small(found)

    def _tried(self, *, detailed: bool = True) -> Arrangement | ParameterError:
        """What was found, or what says that there is no room."""
        own, views = self.options, partial(self.views, detailed=detailed)
        try:
            return arranged(views, self.fixed, sheet=own.sheet, scale=own.scale, projection=own.projection)
        except ParameterError as error:
            return error

    def _small(self, found: Arrangement) -> tuple[Notice, ...]:
        """That they are."""
        text = f"at {found.scale} on {found.sheet.value} they are too small to be read well"
        return () if self._is_legible(found) else (Notice("drawing-small", text, where="views"),)

    def _is_better(self, bare: Arrangement, found: Arrangement | ParameterError) -> bool:
        return bare.factor > found.factor if isinstance(found, Arrangement) else self._is_legible(bare)

    def _is_legible(self, found: Arrangement | ParameterError) -> bool:
        """Whether there are views, and large enough; at a scale that was asked for they are."""
        if isinstance(found, ParameterError):
            return False
        boxes = [view.figure.box for row in self.views(found.factor).rows for view in row]
        return self.options.scale != "auto" or max(max(box.width, box.height) for box in boxes) >= _LEGIBLE

    def views(self, scale: float, *, detailed: bool = True) -> Views:
        """The views at a scale, and the details, which have scales of their own."""
        rows = part_rows(self.drawn, self.requirements, Draughting(self.words, scale), detailed=detailed)
        return Views(rows, self._blocks if detailed else self._blocks[1:])

    @cached_property
    def _mass(self) -> float | None:
        return mass_of(self.drawn)

    @cached_property
    def _blocks(self) -> tuple[View, ...]:
        return detail_blocks(self.drawn, self.words)

    def fixed(self, sheet: SheetSize, scale: str) -> Fixed:
        """All else, as the layout takes it."""
        furnished = self.furnished(sheet, scale)
        rest = self._roughness(furnished)
        return Fixed(furnished.figure + rest, furnished.free, (*furnished.taken, rest.box))

    def furnished(self, sheet: SheetSize, scale: str) -> Furnished:
        """Border, title block, revisions, gear data, notes."""
        furniture = Furniture(
            options=self.options,
            template=self.template,
            words=self.words,
            rows=self.rows,
            table_title=self.words["data.title"],
            notes=tuple(self._notes()),
        )
        treatment = self.requirements.heat_treatment(self.words)  # with the depth of the case
        title = self.options.supplementary_title or self._sizes
        values = title_values(
            replace(self.options, heat_treatment=treatment, supplementary_title=title),
            self.words,
            title=self.title,
            document_type=self.words["frame.document_part"],
            size=sheet,
            scale=scale,
            material=self.requirements.material(self.words),
            mass=self._mass,
        )
        return furniture.on(sheet, values)

    def _notes(self) -> Iterator[str]:
        """What has to be said of the part beside its views."""
        yield from self.requirements.tooth_notes(self.words)
        gear = self.drawn.gear
        if isinstance(gear, Gear) and gear.body.end_chamfer and gear.body.end_chamfer_angle != _USUAL_CHAMFER:
            yield self.words["views.note_chamfer_angle"]

    def _roughness(self, furnished: Furnished) -> Figure:
        """That of all other surfaces, above the title block: at its left or, where the notes are there, its right; else above
        the notes."""
        figure = general_roughness(f"Ra {self.words.shortest(self.requirements.rest_roughness)}")
        figure = figure.moved(-figure.box.left, -figure.box.bottom)
        stack, notes = furnished.taken[0], furnished.taken[-1]
        right = stack.right - figure.box.width - 2 * _AIR
        places = (stack.left + _AIR, stack.top), (right, stack.top), (notes.left + _AIR, notes.top)
        moved = [figure.moved(across, up + _AIR) for across, up in places]
        return next((each for each in moved if _is_clear(each.box, furnished.taken)), moved[-1])


def _is_clear(box: Box, taken: tuple[Box, ...]) -> bool:
    return not any(each.meets(box.grown(_AIR / 2)) for each in taken)
