"""How accurate flanks are: their grade, and what ISO 1328-1 then permits them to be off by."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.drawing.quality import grade_of
from gearcad.drawing.subject import DrawnGear
from gearcad.errors import ParameterError
from gearcad.geometry import Gear
from gearcad.rating.tolerances import Accuracy, gear_tolerances

__all__ = ["grade_row", "tolerance_rows"]

_TOLERANCES = {
    "single_pitch": ("f_pt", "f_pt"),
    "cumulative_pitch": ("F_p", "F_p"),
    "profile_total": ("F_alpha", "F_α"),
    "helix_total": ("F_beta", "F_β"),
    "runout": ("F_r", "F_r"),
}
"""Those of the table: their keys in documents, and their symbols."""

_SIZES = {"reference_diameter": "d", "normal_module": "m_n", "face_width": "b", "teeth": "z", "helix_angle": "β"}
"""Sizes that the standard limits."""


def grade_row(drawn: DrawnGear, write: RowWriter) -> Row:
    """Grade, standard and year; one that nobody gave is said to be assumed."""
    grade = grade_of(drawn)
    assumed = f" ({write.word('assumed')})" if drawn.grade is None else ""
    return write.text("accuracy", f"{grade}  {drawn.accuracy.value}{assumed}", "", {"tolerances.grade": grade})


def tolerance_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[Row]:
    """Of pitch, profile, helix and run-out; outside of the standard the size that is not covered stands there."""
    if not isinstance(drawn.gear, Gear):
        yield write.text("tolerances", f"— ({write.word('no_rack_tolerances')})")
        return
    found = gear_tolerances(drawn.gear, grade_of(drawn), drawn.accuracy)
    for name, (key, symbol) in _TOLERANCES.items():
        later = drawn.accuracy is Accuracy.ISO_2013
        key, symbol = ("f_p" if later and each.endswith("_pt") else each for each in (key, symbol))
        key, symbol = (f"{each}T" if later else each for each in (key, symbol))
        try:
            value = getattr(found, name)
        except ParameterError as error:
            yield write.text(name, f"— ({_why(error)})", symbol)
        else:
            yield write.text(name, f"{write.words.shortest(value, 1)} µm", symbol, {f"tolerances.{key}": value})


def _why(error: ParameterError) -> str:
    """The size that no equation covers."""
    symbol = _SIZES.get(error.parameter, error.parameter)
    return f"{symbol} = {error.value:.4g}"
