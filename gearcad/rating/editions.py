"""Editions of the standards, their own formulas, and rules that their tables share.

Their texts were not at hand: Y_beta is by one public transcription, f_eps and f_ZCa are as remembered.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import Any

import numpy as np

from gearcad.core.errors import ParameterError
from gearcad.core.records import Notice, PerGear
from gearcad.core.values import Values, bounded, chosen, number_or_array, power
from gearcad.geometry.modification import FlankModification


class Edition(StrEnum):
    """The standards that a rating can follow. They differ in what is said of them; everything else is the same."""

    ISO_2006 = "ISO 6336:2006"
    """ISO 6336-1, -2, -3:2006 with their corrigenda of 2008 (Z_beta = 1/sqrt(cos beta))."""

    ISO_2019 = "ISO 6336:2019"
    """ISO 6336-2, -3:2019 as far as they are known, to be verified: Y_beta/cos^3 beta, f_eps in Y_F, f_ZCa in Z_B and Z_D."""

    DIN_1987 = "DIN 3990:1987"
    """DIN 3990-1, -2, -3:1987 (Z_beta = sqrt(cos beta), Z_X of large modules; no rim thickness or deep tooth factor)."""

    def part(self, number: int) -> str:
        """Return the name of a part, such as ISO 6336-3."""
        return f"{self.partition(':')[0]}-{number}"

    def dated_part(self, number: int) -> str:
        """Return the name of a part with its year, such as ISO 6336-3:2006."""
        return f"{self.part(number)}:{self.partition(':')[2]}"


_FIFTH = 5
"""The grade that equations hold for."""


def graded(fifth: Values, grade: int) -> Values:
    """Return a tolerance of grade 5 in another, √2 times as much from each to the next.

    It is rounded as the standard has it: to whole µm above 10, to halves from 5 on, to tenths below.
    """
    exact = fifth * math.sqrt(2) ** (grade - _FIFTH)
    step = np.where(np.greater(exact, 10), 1.0, np.where(np.greater_equal(exact, 5), 0.5, 0.1))
    return number_or_array(exact, np.round(np.floor(exact / step + 0.5) * step, 1))


def mean_of_range(values: Values, limits: Sequence[float]) -> Values:
    """Return the geometric mean of the range that holds a value; a value beyond the last range is returned unchanged.

    The upper limit of a range belongs to it.
    """
    upper = np.searchsorted(limits[1:], values) + 1
    table = np.asarray(limits, dtype=float)
    middle = np.sqrt(table[upper - 1] * table[np.minimum(upper, len(table) - 1)])
    return number_or_array(values, np.where(np.less_equal(values, table[-1]), middle, values))


Both = float | tuple[float, float]


def both(value: Both) -> PerGear[float]:
    """Return the numbers of both gears."""
    return PerGear(*value) if isinstance(value, tuple) else PerGear(value, value)


def take_both(instance: Any, *fields: str) -> None:
    """Let lists among fields of a frozen object be pairs of floats. Raises ParameterError for one of another length."""
    for field in fields:
        value = getattr(instance, field)
        if not isinstance(value, list | tuple):
            continue
        if len(value) != len(PerGear._fields):
            raise ParameterError(field, list(value), "must be a number for both gears, or a list [pinion, wheel]")
        object.__setattr__(instance, field, tuple(map(float, value)))


RECALLED = ("Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT")
"""Symbols of what is to be verified in a rating by this edition."""

_UNMODIFIED = FlankModification()


def load_distribution_factor(virtual_contact_ratio: Values, overlap_ratio: Values) -> Values:
    """f_eps of Y_F: share of the load on one tooth, by eps_alphan and eps_beta.

    Without overlap 1, and 0.7 from eps_alphan = 2 on. With it sqrt(1 - eps_beta + eps_beta/eps_alphan), from eps_alphan = 2 on
    sqrt((1 - eps_beta)/2 + eps_beta/eps_alphan), and sqrt(1/eps_alphan) from eps_beta = 1 on.
    """
    alone = chosen(virtual_contact_ratio < 2, 1.0, 0.5)
    overlap = chosen(overlap_ratio < 1, overlap_ratio, 1.0)
    helical = power(alone * (1 - overlap) + overlap / virtual_contact_ratio, 0.5)
    return chosen(overlap_ratio > 0, helical, chosen(virtual_contact_ratio < 2, 1.0, 0.7))


def helix_angle_divisor(helix_angle: Values) -> Values:
    """cos^3 beta, by which Y_beta is divided (-3, (66)), |beta| at most 30 deg."""
    return number_or_array(helix_angle, np.cos(np.radians(bounded(helix_angle, -30, 30))) ** 3)


def modification_factor(helix_angle: Values, *, modified: bool) -> Values:
    """f_ZCa, by which Z_B and Z_D are multiplied (-2): 1 with an adequate profile modification, else 1.07, of spur gears 1.2.

    Whether it multiplies the stress or the load was not known: the stress is the greater.
    """
    return chosen(helix_angle == 0, 1.0 if modified else 1.2, 1.0 if modified else 1.07)


def relieved(pinion: FlankModification, wheel: FlankModification = _UNMODIFIED) -> bool:
    """Return whether profiles are relieved where contact begins and where it ends, which counts as adequate."""
    crowned = max(pinion.profile_crowning, wheel.profile_crowning) > 0
    return crowned or bool((pinion.tip_relief or wheel.root_relief) and (wheel.tip_relief or pinion.root_relief))


def edition_notices(edition: Edition, *, modified: bool) -> Iterator[Notice]:
    """Yield notices for the edition of 2019: its text was not at hand, and profiles that are not modified raise Z_B and Z_D."""
    if edition is not Edition.ISO_2019:
        return
    text = (
        "ISO 6336:2019: f_eps in Y_F, Y_beta/cos³β, Y_DT = 1 beside f_eps, and f_ZCa in Z_B and Z_D are not from its own text,"
        " which was not at hand: verify them before they decide"
    )
    yield Notice("edition-2019-to-verify", text)
    if not modified:
        text = "sigma_H: profiles are not taken back at both ends of the contact, so ISO 6336:2019 raises Z_B and Z_D by f_ZCa"
        yield Notice("profile-not-modified", text)
