"""Figures that the table of a splined shaft or hub must show, from the document of `data`, row by row."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.words import SheetWords
from gearcad.verification.drawing_figures import LENGTH, TableFigure, material_words

_SHORTEST = 6
"""Decimals of inputs, which have no zeros at the end."""

_SMALL_MODULE = 0.3
"""Module (mm) below which lengths have one more decimal."""

_GAUGES = {
    "shaft": ("tooth_thickness", "s", "over_pins", "M_1", "span_teeth", "form_diameter_max"),
    "hub": ("space_width", "e", "between_pins", "M_2", "span_spaces", "form_diameter_min"),
}
"""Names of size, gauge and span, the symbols of size and gauge, and the limit of the form circle."""


def spline_figures(
    drawn: DrawnGear, document: Mapping[str, Any], words: SheetWords, options: DrawingOptions
) -> list[TableFigure]:
    """Return the rows of the table of a splined part; `document` is the content of data.json."""
    rows = _Rows(document[drawn.role], words)
    found = [*rows.teeth(document, drawn.role), *rows.sizes(drawn.role)]
    for key, text in material_words(drawn, words, options).items():
        found.append(TableFigure(words=words[f"data.{key}"], text=text, required=False))
    return found


class _Rows:
    """Rows of one part, from its part of data.json, in the words of a sheet."""

    def __init__(self, data: Mapping[str, Any], words: SheetWords) -> None:
        self.data, self.words = data, words
        self.decimals = LENGTH + (data["module"] < _SMALL_MODULE)

    def row(self, key: str, symbol: str, *values: float | None, decimals: int | None = None, **within: object) -> TableFigure:
        """Return the row of values, or of a dash where one of them is null."""
        label = self.words[f"splines.{key}"].format(**within)
        places = self.decimals if decimals is None else decimals
        known = [(value, places) for value in values if value is not None]
        absent = len(known) < len(values) or not values
        return TableFigure(words=label, symbol=symbol, values=() if absent else known, absent=absent)

    def text(self, key: str, text: str) -> TableFigure:
        return TableFigure(words=self.words[f"splines.{key}"], text=text, absent=not text)

    def teeth(self, document: Mapping[str, Any], role: str) -> Iterator[TableFigure]:
        """Yield the rows of designation, mate, teeth, root, and profile shift."""
        data = self.data
        mate = document.get("hub" if role == "shaft" else "shaft", {})
        yield self.text("designation", data["designation"])
        yield self.text("mate", mate.get("designation", ""))
        yield self.row("teeth", "z", data["teeth"], decimals=0)
        yield self.row("module", "m", data["module"], decimals=_SHORTEST)
        yield self.row("pressure_angle", "α", data["pressure_angle"], decimals=_SHORTEST)
        yield self.text("root", self.words[f"splines.{data['root']}"])
        yield self.row("profile_shift", "x·m", data["profile_shift"] * data["module"])
        if document["joint"]["standard"] == "DIN 5480":
            yield self.row("nominal_diameter", "d_B", document["joint"]["nominal_diameter"], decimals=_SHORTEST)

    def sizes(self, role: str) -> Iterator[TableFigure]:
        """Yield the rows of diameters, fit, sizes and gauges."""
        data = self.data
        size, letter, pins, over, span, form = _GAUGES[role]
        for key, symbol in (("reference", "d"), ("base", "d_b"), ("tip", "d_a"), ("root", "d_f")):
            yield self.row(f"{key}_diameter", symbol, data[f"{key}_diameter"])
        yield self.row("circle_limits", "")
        yield self.row(form, "d_Ff", data[form])
        yield self.row("root_radius", "ρ_f", data["root_radius"], decimals=_SHORTEST)
        yield self.text("fit", data["fit"] or "")
        yield self.row("deviation", f"A_{letter}", data["deviation"], decimals=_SHORTEST)
        for key, symbol in (("tolerance_actual", "T_act"), ("tolerance_effective", "T_eff")):
            yield self.row(key, symbol, data[key], decimals=_SHORTEST)
        yield self.row(size, letter, data[size])
        yield self.row(f"{size}_effective", f"{letter}_v", data[f"{size}_effective_max"], data[f"{size}_effective_min"])
        yield self.row(f"{size}_actual", letter, data[f"{size}_actual_max"], data[f"{size}_actual_min"])
        go, no_go = ("max", "min") if role == "shaft" else ("min", "max")
        yield self.row("go_gauge", f"{letter}_v", data[f"{size}_effective_{go}"])
        yield self.row("no_go_gauge", letter, data[f"{size}_actual_{no_go}"])
        yield self.row("pin_diameter", "D_M", data["pin_diameter"], decimals=_SHORTEST)
        yield self.row(pins, over, data[f"{pins}_max"], data[f"{pins}_min"])
        yield self.row(f"{pins}_basic", over, data[pins])
        if (k := data["span_teeth"]) is not None and data["span_measurement"] is not None:
            yield self.row(span, "W_k", data["span_measurement_max"], data["span_measurement_min"], k=k)
            yield self.row(f"{span}_basic", "W_k", data["span_measurement"], k=k)
