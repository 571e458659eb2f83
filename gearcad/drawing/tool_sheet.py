"""The sheet of the tool that cuts a gear or a rack, and of the wheel that finishes it: profile, dimensions, data."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gearcad.drawing.assembly_sheets import AssemblySheet
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.gear_data_rows import GearDataRow, tool_text
from gearcad.drawing.gear_sheet import DrawingSheet
from gearcad.drawing.layout import View
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.sheet_frame import Furniture
from gearcad.drawing.sheet_template import SheetTemplate
from gearcad.drawing.views.tool_views import StraightTool, cutter_view, form_wheel_view, straight_view
from gearcad.drawing.words import Draughting, SheetWords, kind_of, titled
from gearcad.geometry import Gear, Rack
from gearcad.geometry.gear_tools import corner_radius, shaped, tool_pressure_angle, wheel_tip_radius

SUFFIX = "tool"
"""Last part of the names of sheets and files of tools."""


def draw_tool(drawn: DrawnGear, options: DrawingOptions) -> DrawingSheet:
    """Return the sheet of the tool of a gear or a rack, with the options of [drawing].

    Raises ParameterError where sheet or scale asked for have no room for it.
    """
    template = SheetTemplate.of(options.template)
    words = template.words(options.language)
    part, rows = drawn.gear, tuple(tool_rows(drawn.gear, words))
    furniture = Furniture(
        options=options,
        template=template,
        words=words,
        rows=rows,
        table_title=words["tool.data"],
        notes=(words["tool.finished"],) if part.stock and not (isinstance(part, Gear) and shaped(part)) else (),
    )
    named = titled(words, kind_of(drawn.role, part), "gear" if part.name == drawn.role else part.name)
    sheet = AssemblySheet(
        furniture=furniture,
        rows=rows,
        views=lambda draughting: tuple(_views(part, draughting)),
        title=words["tool.title"].format(part=words.within_text(named)),
        document_type=words["tool.document"],
        extent=math.pi * part.normal_module,
    )
    return sheet.drawn(f"{drawn.role}-{SUFFIX}")


def _views(part: Gear | Rack, draughting: Draughting) -> Iterator[View]:
    """Yield the view of the tool, then that of the wheel that ends above the root."""
    words = draughting.words
    if isinstance(part, Gear) and shaped(part):
        yield cutter_view(part, draughting, words["tool.cutter_section"])
    else:
        caption = "space_section" if isinstance(part, Rack) else "normal_section"
        yield straight_view(StraightTool.of(part), draughting, words[f"tool.{caption}"])
    wheel = StraightTool.finishing(part)
    if wheel is not None:
        yield straight_view(wheel, draughting, words["tool.wheel_section"], wheel=True)
    elif isinstance(part, Gear) and (form := form_wheel_view(part, draughting, words["tool.form_section"])) is not None:
        yield form


def tool_rows(part: Gear | Rack, words: SheetWords) -> Iterator[GearDataRow]:
    """Yield the rows of the data of a tool: of a hob or rack, or of a shaper cutter, then of the finishing."""

    def row(key: str, symbol: str, *values: float, units: tuple[str, ...] = ("", ""), extra: str = "") -> GearDataRow:
        texts = [words.shortest(value, 4) + unit for value, unit in zip(values, units, strict=False)]
        numbers = {f"tool.{key}" + (f".{number}" if number else ""): value for number, value in enumerate(values)}
        return GearDataRow(key=key, words=words[f"tool.{key}"], symbol=symbol, text=" / ".join(texts) + extra, numbers=numbers)

    pre, m = part.premachining, part.normal_module
    if named := tool_text(part):
        yield GearDataRow(key="tool", words=words["data.tool"], symbol="", text=named)
    if isinstance(part, Gear) and shaped(part):
        yield row("module", "m_0", m)
        yield row("pressure_angle", "α_0", part.rack.pressure_angle, units=("°",))
        if (teeth := part.root_cutter.teeth) is not None and part.cutter_tip_diameter is not None:
            yield row("teeth", "z_0", float(teeth))
            yield row("profile_shift", "x_0", part.root_cutter.profile_shift)
            yield row("tip_diameter", "d_a0", part.cutter_tip_diameter)
        yield row("tip_radius", "ρ_a0", corner_radius(part) * m)
    else:
        tool = StraightTool.of(part)
        angle = part.rack.pressure_angle if isinstance(part, Rack) else tool_pressure_angle(part)
        yield row("module", "m_0", tool.pitch / math.pi)
        yield row("pressure_angle", "α_n0", angle, units=("°",))
        yield row("pitch", "p_n0", tool.pitch)
        yield row("thickness", "s_n0", 2 * tool.half)
        yield row("addendum", "h_aP0", tool.addendum)
        yield row("tip_radius", "ρ_aP0", tool.radius)
    if pre.protuberance_angle is not None:
        yield row("protuberance", "p_rP0", pre.protuberance, pre.protuberance_angle, units=("", "°"))
    if part.stock:
        within = f" ± {words.shortest(pre.stock_tolerance, 4)}" if pre.stock_tolerance else ""
        yield row("stock", "q", part.stock, extra=within)
    if pre.topping is not None:
        yield row("topping", "h_fP0", pre.topping)
    ramp = pre.semi_topping
    if ramp.height is not None and ramp.angle is not None:
        yield row("semi_topping", "h_K0", ramp.height, ramp.angle, units=("", "°"))
    end = part.finishing.end_depth if isinstance(part, Rack) else part.finishing.end_diameter
    if end is not None:
        radius = part.wheel_tip_radius if isinstance(part, Rack) else wheel_tip_radius(part)
        yield row("flank_end", "h_FfG" if isinstance(part, Rack) else "d_FfG", end)
        yield row("wheel_tip_radius", "ρ_g", radius)
