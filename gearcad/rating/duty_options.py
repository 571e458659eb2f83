"""What of the [rating] table says how long gears run under which loads, and with which safety."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

from gearcad.errors import ParameterError, format_number, is_finite_number
from gearcad.ranges import Range
from gearcad.rating.both import Both, take_both
from gearcad.schema import AssumedNumber, Words

__all__ = ["DutyOptions", "LoadBin"]

_SAFETY = Range("", 0.1, 100.0)
_MOST_BINS = 1000
_WHOLE = 1e-6
"""By how much the shares of life may miss 1: what rounding of their digits leaves."""

_PERMITTED = (
    "must be a list of [share of life, share of torque], or [share of life, share of torque, share of speed];"
    ' in a cell "0.1:1.25 0.9:0.8"'
)


class LoadBin(NamedTuple):
    """A share of the life under shares of torque and speed of the [load]."""

    life: float
    torque: float
    speed: float = 1.0


@dataclass(frozen=True, kw_only=True)
class DutyOptions:
    """Life, load spectrum and safeties. What may differ per gear is a number for both, or a list [pinion, wheel]."""

    life: Annotated[float | None, Range("h", 1e-6, 1e8), Words("life in operation", "L_h")] = None
    load_cycles: Annotated[Both | None, Range("", 1.0, 1e15), Words("load cycles of a flank", "N_L")] = None
    contacts_per_turn: Annotated[Both, Range("", 1e-3, 1000.0), Words("contacts of a flank per turn")] = AssumedNumber(1.0)
    spectrum: Annotated[
        tuple[tuple[float, ...], ...] | None,
        Words("load spectrum", "", "ISO 6336-6"),
    ] = None
    mean_stress_factor: Annotated[Both, Range("", 0.1, 2.0), Words("mean stress influence factor", "Y_M", "ISO 6336-3")] = (
        AssumedNumber(1.0)
    )
    pitting_permitted: Annotated[bool, Words("whether some pitting is permitted", "", "ISO 6336-2")] = False
    long_life_factor: Annotated[
        float, Range("", 0.85, 1.0), Words("life factor at 10^10 load cycles", "Z_NT", "ISO 6336-2, -3")
    ] = AssumedNumber(0.85)
    required_safety_flank: Annotated[float, _SAFETY, Words("required safety of the flank", "S_Hmin", "ISO 6336-2")] = (
        AssumedNumber(1.0)
    )
    required_safety_root: Annotated[float, _SAFETY, Words("required safety of the root", "S_Fmin", "ISO 6336-3")] = (
        AssumedNumber(1.4)
    )
    required_safety_scuffing: Annotated[float | None, _SAFETY, Words("required safety against scuffing", "S_Smin")] = None

    @property
    def bins(self) -> tuple[LoadBin, ...]:
        """The load spectrum; none without one."""
        return tuple(LoadBin(*each) for each in self.spectrum or ())

    def _check_duty(self) -> None:
        """Lists of both gears, and the spectrum. Raises ParameterError."""
        take_both(self, "load_cycles", "contacts_per_turn", "mean_stress_factor")
        if self.load_cycles is not None and self.life is not None:
            both = self.load_cycles
            given = list(both) if isinstance(both, tuple) else both
            raise ParameterError("load_cycles", given, f"must be left out beside life = {format_number(self.life)} h, or life")
        if self.spectrum is not None:
            object.__setattr__(self, "spectrum", _spectrum(self.spectrum))


def _spectrum(given: Any) -> tuple[tuple[float, ...], ...]:
    """A spectrum from lists of numbers or from the text of a cell. Raises ParameterError."""
    if isinstance(given, str):
        found = [_numbers(item) for item in given.split()]
    elif isinstance(given, list | tuple):
        found = [tuple(each) if isinstance(each, list | tuple) else () for each in given]
    else:
        raise ParameterError("spectrum", given, _PERMITTED)
    if not 1 <= len(found) <= _MOST_BINS:
        raise ParameterError("spectrum", given, f"must have from 1 to {_MOST_BINS} parts")
    bins = tuple(_bin(each, given) for each in found)
    if abs((total := math.fsum(each[0] for each in bins)) - 1) > _WHOLE:
        raise ParameterError("spectrum", given, f"must have shares of life that add up to 1, here {format_number(total)}")
    if not any(each[1] for each in bins):
        raise ParameterError("spectrum", given, "must have a share of torque above 0")
    return bins


def _numbers(item: str) -> tuple[float, ...]:
    """The numbers of 0.1:1.25; none if that is not what it is. A comma is a decimal sign here, whatever the table has."""
    parts = re.split(":", item.replace(",", "."))
    try:
        return tuple(map(float, parts))
    except ValueError:
        return ()


def _bin(numbers: tuple[Any, ...], given: Any) -> tuple[float, ...]:
    """A share of the life, above 0, and shares of torque, 0 or more, and of speed, above 0. Raises ParameterError."""
    if len(numbers) not in (2, 3) or not all(map(is_finite_number, numbers)):
        raise ParameterError("spectrum", given, _PERMITTED)
    life, torque, speed = (*numbers, 1.0)[:3]
    if not (0 < life <= 1 and 0 <= torque <= 100 and 0 < speed <= 100):
        permitted = "must have shares of life above 0 up to 1, of torque from 0 to 100, of speed above 0 up to 100"
        raise ParameterError("spectrum", list(numbers), permitted)
    return tuple(map(float, numbers))
