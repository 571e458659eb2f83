"""The sheet of a mould: a gear as its cavity is made, with the sizes of cavity and part, shrinkage and gauges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.gear_data_rows import GearDataRow, RowWriter, teeth_rows
from gearcad.drawing.gear_sheet import DrawingSheet, draw_gear
from gearcad.drawing.options import DrawingOptions, PartDrawing
from gearcad.drawing.sheet_template import SheetTemplate
from gearcad.drawing.words import kind_of, titled
from gearcad.geometry import Gear
from gearcad.geometry.gear import AsMadeGear

MOULD = "mould"

_SIZES = {
    "reference_diameter": "d",
    "tip_diameter": "d_a",
    "root_diameter": "d_f",
    "form_diameter": "d_Ff",
    "normal_tooth_thickness": "s_n",
    "face_width": "b",
}
"""Sizes of which the table has both, as made and nominal, and their symbols."""


def is_moulded(drawn: DrawnGear) -> bool:
    """Return whether a part is a gear that is moulded."""
    return isinstance(drawn.gear, Gear) and drawn.gear.making.process == "mould"


def draw_mould(
    drawn: DrawnGear, options: DrawingOptions, part: PartDrawing | None = None, *, alone: bool = True
) -> DrawingSheet:
    """Return the sheet of the cavity of a gear, called as the gear and `-mould`: its views and table are as made.

    Its sizes have general tolerances: fits and flank tolerances are those of the part. Raises what `draw_gear` does.
    """
    own, gear = options.of_part(part, alone=alone), drawn.gear
    assert isinstance(gear, Gear)
    words = SheetTemplate.of(own.template).words(own.language)
    name = own.title or titled(words, kind_of(drawn.role, gear), "gear" if gear.name == drawn.role else gear.name)
    plain: dict[str, Any] = {f"{size}_tolerance": "" for size in ("bore", "tip", "face_width", "keyway", "rim")}
    of_mould = replace(own, **plain, title=f"{words['mould.title']}: {name}", number="", material="", heat_treatment="")
    made = replace(drawn, role=f"{drawn.role}-{MOULD}", gear=gear.as_made, material=None, mates=())
    rows = tuple(mould_rows(replace(drawn, mates=()), RowWriter(words)))
    return draw_gear(made, of_mould, rows=rows)


def mould_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[GearDataRow]:
    """Yield the rows of a cavity: teeth of the part, shrinkage, then each size as made with the nominal one behind it."""
    part = drawn.gear
    assert isinstance(part, Gear)
    made, making, words = part.as_made, part.making, write.words
    assert isinstance(made, AsMadeGear)
    yield from teeth_rows(drawn, write)
    if part.helix_angle:
        angle = f"{words.number(abs(made.helix_angle), 4)}°"
        yield write.text("mould_helix_angle", angle, "β")
    shrinkage = [100 * (1 - 1 / scale) for scale in (making.radial_scale, making.tangential_scale, making.axial_scale)]
    text = " / ".join(words.shortest(each, 4) for each in shrinkage)
    yield write.text("mould_shrinkage", f"{text} %", "s", {"making.shrinkage_radial": making.shrinkage_radial})
    yield write.plain("mould_offset", making.offset, "e", " mm", "making.offset")
    for key, symbol in _SIZES.items():
        size, nominal = abs(getattr(made, key)), abs(getattr(part, key))
        yield _both(write, f"mould_{key}", symbol, (size, nominal), key)
    document = part.to_dict()["making"]
    sizes, before, cavity = document["as_made"], document["nominal"], document["cavity"]
    if sizes["span_measurement"] is not None:
        row = _both(write, "mould_span", "W_k", (sizes["span_measurement"], before["span_measurement"]), "span_measurement")
        yield replace(row, words=row.words.format(k=part.span_teeth))
    over = "between_balls" if part.internal else "over_balls"
    if sizes[over] is not None:
        row = _both(write, f"mould_{over}", "M_dK", (sizes[over], before[over]), over)
        yield replace(row, words=row.words.format(ball=words.shortest(sizes["ball_diameter"], 4)))
    gauge = "over_balls" if part.internal else "between_balls"
    if cavity[gauge] is not None:
        ball = words.shortest(cavity["ball_diameter"], 4)
        number = {f"making.cavity.{gauge}": cavity[gauge], "making.cavity.ball_diameter": cavity["ball_diameter"]}
        yield write.text(f"cavity_{gauge}", words.number(cavity[gauge], write.decimals), "M_dK", number, ball=ball)


def _both(write: RowWriter, key: str, symbol: str, sizes: tuple[float, float], name: str) -> GearDataRow:
    """Return the row of a size (mm) as made, the nominal one in brackets behind it."""
    made, nominal = (write.words.number(each, write.decimals) for each in sizes)
    text = f"{made} ({nominal})"
    return GearDataRow(key=key, words=write.word(key), symbol=symbol, text=text, numbers={f"making.as_made.{name}": sizes[0]})
