"""The sheet of one gear: views, tooth detail, gear data, notes and title block (ISO 2203, ISO 1340, ISO 7200)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING

from gearcad.core.errors import ParameterError
from gearcad.core.records import Notice
from gearcad.drawing.drawing_subjects import DrawnGear, DrawnPair
from gearcad.drawing.drawing_symbols import general_roughness
from gearcad.drawing.dxf_export import sheet_document
from gearcad.drawing.gear_data_rows import GearDataRow, gear_notices, gear_rows
from gearcad.drawing.layout import Arrangement, Fixed, View, Views, arranged
from gearcad.drawing.options import DrawingOptions, PartDrawing, SheetSize
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Box, Figure
from gearcad.drawing.sheet_frame import Furnished, Furniture, title_values
from gearcad.drawing.sheet_template import SheetTemplate
from gearcad.drawing.spline_rows import spline_notices, spline_rows
from gearcad.drawing.views import gear_views, rack_views, ring_views
from gearcad.drawing.views.modification_diagrams import modification_figures
from gearcad.drawing.views.tooth_detail import detail_mark, detail_scale, tooth_figure
from gearcad.drawing.words import Draughting, Language, SheetWords, Size, kind_of, titled
from gearcad.geometry import Gear, Rack
from gearcad.solids import tessellate, tessellate_rack

if TYPE_CHECKING:
    from ezdxf.document import Drawing as Document


@dataclass(frozen=True, kw_only=True)
class DrawingSheet:
    """One sheet of a drawing: `name` is the name of its files ("pinion", "assembly"), `number` its identification number.

    `size` is width and height of the paper (mm); `scale` is mm of paper for a mm of the part. `shown` are the numbers on the
    sheet before rounding, by their keys in documents ("reference_diameter"). `notices` name what was shortened, assumed or
    left out.
    """

    name: str
    title: str
    number: str = ""
    size: tuple[float, float]
    scale: float
    language: Language
    figure: Figure = field(repr=False)
    shown: Mapping[str, float] = field(default_factory=dict, repr=False)
    notices: tuple[Notice, ...] = ()

    def document(self) -> Document:
        """Return the sheet as a DXF document, from which all its files are written."""
        return sheet_document(self.figure, self.size, self.scale, title=self.title, language=self.language)

    @property
    def paper(self) -> Box:
        """Box of the paper (mm), its lower left corner at the origin."""
        return Box(0.0, 0.0, *self.size)


@dataclass(frozen=True, kw_only=True)
class Drawing:
    """The sheets of a design, in order."""

    name: str
    sheets: tuple[DrawingSheet, ...]

    @property
    def notices(self) -> tuple[Notice, ...]:
        """Notices of all sheets, each with the name of its sheet."""
        return tuple(notice.within(sheet.name) for sheet in self.sheets for notice in sheet.notices)


_CHORD_ERROR = 0.001
"""Chord error of the solid in normal modules: volumes are then right within 0.02 %, and three digits of them are shown."""

_FINEST = 1e-6
"""Least chord error as a share of the largest size: finer triangles than mesh files can hold are refused."""

_PER_CUBIC_MILLIMETRE = 1e-9
"""Factor from kg/m³ to kg/mm³."""


def mass_of(drawn: DrawnGear) -> float | None:
    """Return the mass (kg) of a gear or a rack; None without a material, and for a ring without a rim diameter."""
    volume = _volume(drawn.gear)
    return None if drawn.material is None or volume is None else volume * drawn.material.density * _PER_CUBIC_MILLIMETRE


def _volume(part: Gear | Rack) -> float | None:
    """Return the volume (mm³) of a gear or a rack; None for a ring without a rim diameter."""
    error = _CHORD_ERROR * part.normal_module
    if isinstance(part, Rack):
        size = max(part.length, part.face_width, part.total_height)
        return tessellate_rack(part, max(error, _FINEST * size)).volume
    outside = part.body.rim_diameter if part.internal else part.tip_diameter
    return None if outside is None else tessellate(part, max(error, _FINEST * outside)).volume


def mass_of_pair(drawn: DrawnPair) -> float | None:
    """Return the mass (kg) of both parts of a pair; None where one of them is not known."""
    first, second = (mass_of(part) for part in drawn.parts)
    return None if first is None or second is None else first + second


def part_rows(
    drawn: DrawnGear, requirements: Requirements, draughting: Draughting, *, detailed: bool = True
) -> tuple[tuple[View, ...], ...]:
    """Return the views at a scale, in their rows in first angle projection. With `detailed` one of them marks the tooth that
    is drawn in detail.
    """
    given = drawn, requirements, draughting
    if isinstance(drawn.gear, Rack):
        plan = rack_views.plan_view(*given)
        front = rack_views.front_view(*given)
        front = _with_detail(front, drawn, draughting) if detailed else front
        return ((front, rack_views.end_section(*given)), *(() if plan is None else ((plan,),)))
    views = ring_views if drawn.gear.internal else gear_views
    face = views.face_view(*given)
    return ((views.section_view(*given), _with_detail(face, drawn, draughting) if detailed else face),)


def _with_detail(view: View, drawn: DrawnGear, draughting: Draughting) -> View:
    """Return a view with the mark of the detail's place."""
    return replace(view, annotations=(*view.annotations, lambda: detail_mark(drawn, view.figure, draughting.scale)))


def detail_blocks(drawn: DrawnGear, words: SheetWords) -> tuple[View, ...]:
    """Return the detail of a tooth, then the diagrams of its modifications; these views have scales of their own."""
    detail = tooth_figure(drawn, Draughting(words, detail_scale(drawn)))
    diagrams = modification_figures(drawn, Draughting(words))
    return View("detail", detail), *(View(f"diagram {number}", each) for number, each in enumerate(diagrams, 1))


_AIR = 4.0
"""Distance of the general roughness from the frame and the tables beside it (mm of paper)."""

_LEGIBLE = 40.0
"""Least size (mm of paper) of views with their centre lines, where leaving something out makes them larger."""

_USUAL_CHAMFER = 45.0
"""Angle (degrees) of chamfers that is the same from either side."""


def draw_gear(
    drawn: DrawnGear,
    options: DrawingOptions,
    part: PartDrawing | None = None,
    *,
    alone: bool = True,
    rows: tuple[GearDataRow, ...] | None = None,
) -> DrawingSheet:
    """Return the sheet of an external gear, a ring or a rack, with the options of [drawing] and of the gear's own table.

    `rows` replace those of the gear data, as of a mould, whose values are not assumed from the accuracy grade. `alone` means
    that it is the only gear of its design: it then takes number, title and revisions from [drawing]. Raises ParameterError for
    a sheet or a scale that has no room, and for a template that cannot be used.
    """
    content = _Content.of(drawn, options.of_part(part, alone=alone), rows)
    own = content.options
    found, notices = content.arranged()
    return DrawingSheet(
        name=drawn.role,
        title=content.title,
        number=own.number,
        size=found.size,
        scale=found.factor,
        language=own.language,
        figure=found.figure,
        shown=content.shown,
        notices=(
            *content.furnished(found.sheet, found.scale).notices,
            *notices,
            *(_row_notices(drawn, own) if rows is None else ()),
        ),
    )


def _rows(drawn: DrawnGear, words: SheetWords, options: DrawingOptions) -> tuple[GearDataRow, ...]:
    """Return the rows of the data table of a gear, a rack, or a splined part."""
    return gear_rows(drawn, words, options) if drawn.spline is None else spline_rows(drawn, drawn.spline, words, options)


def _row_notices(drawn: DrawnGear, options: DrawingOptions) -> tuple[Notice, ...]:
    """Return notices of assumed and missing values in the table."""
    return gear_notices(drawn, options) if drawn.spline is None else tuple(spline_notices(drawn, drawn.spline, options))


@dataclass(frozen=True, kw_only=True)
class _Content:
    """The content of a part's sheet, independent of its size and scale."""

    drawn: DrawnGear
    options: DrawingOptions
    template: SheetTemplate
    words: SheetWords
    requirements: Requirements
    rows: tuple[GearDataRow, ...]

    @classmethod
    def of(cls, drawn: DrawnGear, options: DrawingOptions, rows: tuple[GearDataRow, ...] | None = None) -> _Content:
        template = SheetTemplate.of(options.template)
        words = template.words(options.language)
        return cls(
            drawn=drawn,
            options=options,
            template=template,
            words=words,
            requirements=Requirements.of(drawn, options),
            rows=_rows(drawn, words, options) if rows is None else rows,
        )

    @property
    def title(self) -> str:
        """Title as given, else the word for such a part, with the name of the gear if it has one."""
        role, gear = self.drawn.role, self.drawn.gear
        return self.options.title or titled(self.words, kind_of(role, gear), "gear" if gear.name == role else gear.name)

    @property
    def shown(self) -> Mapping[str, float]:
        """Numbers of the table by their keys, sizes of the views by their names in the requirements, and the mass (kg)."""
        numbers = {key: value for row in self.rows for key, value in row.numbers.items()}
        sizes = {each.name: getattr(self.requirements, each.name) for each in fields(self.requirements)}
        numbers |= {f"sizes.{name}": size.value for name, size in sizes.items() if isinstance(size, Size)}
        return numbers if self._mass is None else numbers | {"mass": self._mass}

    @property
    def _sizes(self) -> str:
        """Teeth, module and helix angle as a text, for a sheet without a supplementary title."""
        gear, words = self.drawn.gear, self.words
        if self.drawn.spline is not None:
            return self.drawn.spline.designation
        assert gear.teeth is not None  # derived by now
        texts = [f"z = {words.number(gear.teeth, 0)}", f"mₙ = {words.shortest(gear.normal_module, 6)}"]
        return ", ".join([*texts, *([f"β = {words.shortest(abs(gear.helix_angle), 4)}°"] if gear.helix_angle else [])])

    def arranged(self) -> tuple[Arrangement, tuple[Notice, ...]]:
        """Return the arrangement of all views, and notices of what is left out or too small.

        On a sheet size that was asked for, the detail of a tooth may be left out. This is done if there is no room for all, or
        all would be too small to read. Raises ParameterError.
        """
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
        """Return the arrangement, or the error that says that there is no room."""
        own, views = self.options, partial(self.views, detailed=detailed)
        try:
            return arranged(views, self.fixed, sheet=own.sheet, scale=own.scale, projection=own.projection)
        except ParameterError as error:
            return error

    def _small(self, found: Arrangement) -> tuple[Notice, ...]:
        """Return a notice if the views are too small to be read well, else nothing."""
        text = f"at {found.scale} on {found.sheet.value} they are too small to be read well"
        return () if self._is_legible(found) else (Notice("drawing-small", text, where="views"),)

    def _is_better(self, bare: Arrangement, found: Arrangement | ParameterError) -> bool:
        return bare.factor > found.factor if isinstance(found, Arrangement) else self._is_legible(bare)

    def _is_legible(self, found: Arrangement | ParameterError) -> bool:
        """Return whether there are views that are large enough; at a scale that was asked for they always are."""
        if isinstance(found, ParameterError):
            return False
        boxes = [view.figure.box for row in self.views(found.factor).rows for view in row]
        return self.options.scale != "auto" or max(max(box.width, box.height) for box in boxes) >= _LEGIBLE

    def views(self, scale: float, *, detailed: bool = True) -> Views:
        """Return the views at a scale, and the details, which have scales of their own."""
        rows = part_rows(self.drawn, self.requirements, Draughting(self.words, scale), detailed=detailed)
        return Views(rows, self._blocks if detailed else self._blocks[1:])

    @cached_property
    def _mass(self) -> float | None:
        return mass_of(self.drawn)

    @cached_property
    def _blocks(self) -> tuple[View, ...]:
        return detail_blocks(self.drawn, self.words)

    def fixed(self, sheet: SheetSize, scale: str) -> Fixed:
        """Return all parts of the sheet other than the views, for the layout."""
        furnished = self.furnished(sheet, scale)
        rest = self._roughness(furnished)
        return Fixed(furnished.figure + rest, furnished.free, (*furnished.taken, rest.box))

    @cached_property
    def furnished(self) -> Callable[[SheetSize, str], Furnished]:
        """The sheet's border, title block, revisions, gear data and notes by its size and scale, each made once."""
        return cache(self._furnish)

    def _furnish(self, sheet: SheetSize, scale: str) -> Furnished:
        furniture = Furniture(
            options=self.options,
            template=self.template,
            words=self.words,
            rows=self.rows,
            table_title=self.words["data.title" if self.drawn.spline is None else "splines.title"],
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
        """Yield the notes on the part beside its views."""
        yield from self.requirements.tooth_notes(self.words)
        gear = self.drawn.gear
        if isinstance(gear, Gear) and gear.body.end_chamfer and gear.body.end_chamfer_angle != _USUAL_CHAMFER:
            yield self.words["views.note_chamfer_angle"]

    def _roughness(self, furnished: Furnished) -> Figure:
        """Return the general roughness above the title block: at its left or, if the notes are there, its right; else above
        the notes.
        """
        figure = general_roughness(f"Ra {self.words.shortest(self.requirements.rest_roughness)}")
        figure = figure.moved(-figure.box.left, -figure.box.bottom)
        stack, notes = furnished.taken[0], furnished.taken[-1]
        right = stack.right - figure.box.width - 2 * _AIR
        places = (stack.left + _AIR, stack.top), (right, stack.top), (notes.left + _AIR, notes.top)
        moved = [figure.moved(across, up + _AIR) for across, up in places]
        return next((each for each in moved if _is_clear(each.box, furnished.taken)), moved[-1])


def _is_clear(box: Box, taken: tuple[Box, ...]) -> bool:
    return not any(each.meets(box.grown(_AIR / 2)) for each in taken)
