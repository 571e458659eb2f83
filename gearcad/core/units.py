"""Units in which numbers are shown and typed: those of the documents, or inches, pounds and what is made of them.

All that is stored is in the units of the documents. This is the only table of other units: each has a name, and its size, an
exact fraction, in a unit of the documents.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from enum import StrEnum
from fractions import Fraction
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple

__all__ = ["MM_PER_INCH", "ShownUnit", "UnitSystem", "inch_units", "measures_in", "module_of_pitch", "shown_unit"]

MM_PER_INCH = 25.4
"""Millimetres of an inch, exact (ISO 80000-3)."""

_INCH = Fraction("25.4")
"""mm, exact (ISO 80000-3)."""

_POUND, _POUND_FORCE = Fraction("0.45359237"), Fraction("4.4482216152605")
"""kg and N, exact (ISO 80000-4, Annex)."""

_MILLI = Fraction(1, 1000)

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?")

_DIGITS, _SHORT_DIGITS = 12, 7
"""Significant digits of numbers that somebody may have typed, and of all others."""


def module_of_pitch(pitch: float) -> float:
    """m_n = 25.4 mm/P_nd (mm)."""
    return MM_PER_INCH / pitch


class UnitSystem(StrEnum):
    """Units of what is shown and typed, by the unit of length."""

    METRIC = "mm"
    INCH = "in"


class ShownUnit(NamedTuple):
    """A unit by its name, and its size in the unit of the documents."""

    name: str
    size: Fraction

    @property
    def more_digits(self) -> int:
        """Decimals that a number in this unit has beside one of the documents, so that both are about as fine."""
        return round(math.log10(self.size))

    def text(self, stored: float, decimals: int) -> str:
        """Return a number of the documents in this unit; `decimals` are those of the documents."""
        return f"{self.of(stored):.{max(decimals + self.more_digits, 0)}f}"

    def of(self, stored: float) -> float:
        """Return a number of the documents in this unit."""
        return float(Fraction(stored) / self.size) if self.size != 1 and math.isfinite(stored) else stored

    def shown(self, stored: str) -> str:
        """Return the text of a number, or of several, of the documents in this unit; other texts as they are.

        What was typed in this unit has its digits again; all other numbers have seven digits.
        """
        numbers = stored.split(" ")
        if not all(map(_NUMBER.fullmatch, numbers)):
            return stored
        return " ".join(_shown(each, self.size) for each in numbers)

    def stored(self, shown: str, former: tuple[str, ...] = ()) -> str:
        """Return what was typed in this unit as text in the unit of the documents; what is no number as it is.

        What `former` texts of the documents are shown as means these, with all their digits.
        """
        plain = shown.strip().replace("−", "-").replace(",", ".")
        same = next((each for each in former if each and self.shown(each) == plain), None)
        if same is not None:
            return same
        numbers = plain.split()
        if not numbers or not all(map(_NUMBER.fullmatch, numbers)):
            return shown
        return " ".join(_plain(float(Fraction(each) * self.size)) for each in numbers)


@lru_cache(maxsize=4096)
def _shown(stored: str, size: Fraction) -> str:
    exact = Fraction(stored) / size
    text = f"{float(exact):.{_DIGITS}g}"
    if float(Fraction(text) * size) != float(stored):
        text = f"{float(exact):.{_SHORT_DIGITS}g}"
    return _plain(float(text))


def _plain(number: float) -> str:
    return repr(number + 0.0).removesuffix(".0")


_INCHES = MappingProxyType(
    {
        unit: ShownUnit(name, size)
        for unit, name, size in (
            ("mm", "in", _INCH),
            ("µm", "µin", _INCH * _MILLI),
            ("N", "lbf", _POUND_FORCE),
            ("N·m", "lbf·in", _POUND_FORCE * _INCH * _MILLI),
            ("MPa", "ksi", 1000 * _POUND_FORCE / _INCH**2),
            ("N/mm", "lbf/in", _POUND_FORCE / _INCH),
            ("N/µm", "lbf/µin", _POUND_FORCE / (_INCH * _MILLI)),
            ("N/(mm·µm)", "lbf/(in·µin)", _POUND_FORCE / (_INCH**2 * _MILLI)),
            ("mm·µm/N", "in·µin/lbf", _INCH**2 * _MILLI / _POUND_FORCE),
            ("m/s", "ft/s", 12 * _INCH * _MILLI),
            ("kg", "lb", _POUND),
            ("kg/mm", "lb/in", _POUND / _INCH),
            ("kg/m³", "lb/in³", _POUND / (_INCH * _MILLI) ** 3),
            ("kg·m²", "lb·in²", _POUND * (_INCH * _MILLI) ** 2),
            ("N·m/rad", "lbf·in/rad", _POUND_FORCE * _INCH * _MILLI),
            ("N·s/m", "lbf·s/in", _POUND_FORCE / (_INCH * _MILLI)),
            ("N·m·s/rad", "lbf·in·s/rad", _POUND_FORCE * _INCH * _MILLI),
        )
    }
)
"""Units in place of those of the documents. Temperatures, viscosities (mm²/s is cSt) and modules, which are mm, stay."""

_MODULES = ("normal_module", "transverse_module")
"""Quantities in mm whose counterpart is a pitch of its own, P_nd = 25.4 mm/m_n."""


def shown_unit(system: UnitSystem, unit: str, key: str = "") -> ShownUnit | None:
    """Return the unit in which a quantity is shown that documents have in `unit`; None where that is the same.

    `key` is the quantity's own, such as "gear.transverse_module".
    """
    if system is UnitSystem.METRIC or key.rpartition(".")[2] in _MODULES:
        return None
    return _INCHES.get(unit)


def inch_units() -> Mapping[str, ShownUnit]:
    """Return the units that stand in place of those of the documents, by the latter, where inches are shown."""
    return _INCHES


_FEWEST_DIGITS = 4
"""Least number of significant digits of a number that a message has in inches; it has at least one more than in mm."""

_OF_TEXT = r"[-+±−]?\d+(?:[.,]\d+)?(?:e[-+]?\d+)?"
_JOINTS, _BOUNDS = ("to", "and", "or", "bis", "und", "oder", "…", "/"), ("at most", "below", "höchstens", "unter")
_BETWEEN = rf" (?:{'|'.join(_JOINTS)})(?: (?:{'|'.join(_BOUNDS)}))? "
_UNITS_OF_TEXT = "|".join(map(re.escape, sorted(_INCHES, key=len, reverse=True)))
_MEASURE = re.compile(
    rf"(?P<quoted>(?<!\w)'[^']*'(?!\w)|\"[^\"]*\"|`[^`]*`)"
    rf"|(?<![\w.,/:-])(?P<numbers>{_OF_TEXT}(?:{_BETWEEN}{_OF_TEXT})*) (?P<unit>{_UNITS_OF_TEXT})(?![\w/·²³])"
)
"""A text in quotation marks, or numbers of one unit in a message: `12.5 mm`, `0.1 to 4 mm`, `above 3 and at most 5 mm`."""

_OF_MODULE = re.compile(r"(?:_module|[Mm]odul[se]?)(?: of| von| =)? $")
_OF_MODULE_KEY = re.compile(r"(?:_module|\bmodule) = [^;]*$")
"""Texts before a number that is a module, and before one that is permitted for a module: modules stay in mm."""


def measures_in(system: UnitSystem, text: str, *, comma: bool = False) -> str:
    """Return a message whose numbers with a unit are in the units of a system; modules stay in mm.

    `comma`: numbers that are converted have a decimal comma.
    """

    def shown_measure(found: re.Match[str]) -> str:
        before = text[: found.start()]
        if found["quoted"] or _OF_MODULE.search(before) or _OF_MODULE_KEY.search(before):
            return found[0]
        unit = _INCHES[found["unit"]]
        told = re.sub(_OF_TEXT, lambda number: _measure_text(number[0], unit), found["numbers"])
        return f"{told.replace('.', ',') if comma else told} {unit.name}"

    return text if system is UnitSystem.METRIC else _MEASURE.sub(shown_measure, text)


def _measure_text(text: str, unit: ShownUnit) -> str:
    """Return a number of a message in another unit, with the sign that it has."""
    plain = text.lstrip("±").replace("−", "-").replace(",", ".")
    exact, own = unit.shown(plain), len(re.sub(r"e.*|[^0-9]", "", plain).lstrip("0"))
    digits = max(own + 1, _FEWEST_DIGITS)
    rounded = _plain(float(f"{unit.of(float(plain)):.{digits}g}"))
    found = ("±" if text.startswith("±") else "") + min(exact, rounded, key=len)
    return found.replace("-", "−") if text.startswith("−") else found
