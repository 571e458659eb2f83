"""How accurate flanks are: their grade, and what ISO 1328-1 then permits them to be off by."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.drawing.quality import grade_of
from gearcad.drawing.subject import DrawnGear
from gearcad.errors import ParameterError
from gearcad.geometry import Gear
from gearcad.notice import Notice
from gearcad.ranges import Range
from gearcad.rating.tolerances import Accuracy, gear_tolerances
from gearcad.rating.tolerances.editions import covered

__all__ = ["grade_row", "tolerance_notices", "tolerance_rows"]

_TOLERANCES = {
    Accuracy.ISO_1995: {
        "single_pitch": ("f_pt", "f_pt"),
        "cumulative_pitch": ("F_p", "F_p"),
        "profile_total": ("F_alpha", "F_α"),
        "helix_total": ("F_beta", "F_β"),
        "runout": ("F_r", "F_r"),
    },
    Accuracy.ISO_2013: {
        "single_pitch": ("f_pT", "f_pT"),
        "cumulative_pitch": ("F_pT", "F_pT"),
        "profile_total": ("F_alphaT", "F_αT"),
        "helix_total": ("F_betaT", "F_βT"),
        "runout": ("F_rT", "F_rT"),
    },
}
"""Those of the table: their keys in documents, and their symbols."""


def grade_row(drawn: DrawnGear, write: RowWriter) -> Row:
    """Grade, standard and year; one that nobody gave is said to be assumed."""
    grade = grade_of(drawn)
    assumed = f" ({write.word('assumed')})" if drawn.grade is None else ""
    return write.text("accuracy", f"{grade}{assumed}", "", {"tolerances.grade": grade}, standard=drawn.accuracy.value)


def tolerance_rows(drawn: DrawnGear, write: RowWriter) -> Iterator[Row]:
    """Of pitch, profile, helix and run-out; beyond the standard the limit that a size is past stands there."""
    if not isinstance(drawn.gear, Gear):
        yield write.text("tolerances", f"— ({write.word('not_of_racks')})", standard=drawn.accuracy.value)
        return
    found = gear_tolerances(drawn.gear, grade_of(drawn), drawn.accuracy)
    for name, (key, symbol) in _TOLERANCES[drawn.accuracy].items():
        try:
            value = getattr(found, name)
        except ParameterError as error:
            yield write.text(name, f"— ({_why(error, drawn.accuracy, write)})", symbol)
        else:
            yield write.text(name, f"{write.words.shortest(value, 1)} µm", symbol, {f"tolerances.{key}": value})


def tolerance_notices(drawn: DrawnGear) -> Iterator[Notice]:
    """What is assumed, and what has no tolerance."""
    if not isinstance(drawn.gear, Gear):
        said = f"{drawn.accuracy.value} is not for racks: the sheet has no tolerances of pitch, say them in notes"
        text = f"tolerances: {said}; roughness, flatness and parallelism are what goes with grade {grade_of(drawn)}"
        yield Notice("rack-tolerances", text)
        return
    if drawn.grade is None:
        said = f"no grade is given; tolerances, run-out and roughness are those of grade {grade_of(drawn)}"
        yield Notice("grade-assumed", f"accuracy: {said} of {drawn.accuracy.value}")
    for reason in gear_tolerances(drawn.gear, grade_of(drawn), drawn.accuracy).to_dict()["not_covered"]:
        yield Notice("not-covered", f"tolerances: {drawn.accuracy.value} does not cover all: {reason}")


def _why(error: ParameterError, accuracy: Accuracy, write: RowWriter) -> str:
    """The limit that a size is past: "face width below 4 mm"."""
    permitted, size = covered(accuracy)[error.parameter], abs(error.value)
    below = permitted.least is not None and size < permitted.least
    unit = permitted.unit if isinstance(permitted, Range) else ""
    limit = permitted.least if below else permitted.most
    assert limit is not None  # it is past one of them
    text = f"{write.words.shortest(limit)} {unit}".replace(" deg", "°").rstrip()
    size_words = write.words.within_text(write.word(error.parameter))
    return write.word("below_limit" if below else "above_limit").format(size=size_words, limit=text)
