"""Edition: which standard a rating follows, where the standards differ."""

from __future__ import annotations

from enum import Enum

__all__ = ["Edition"]


class Edition(Enum):
    """The standards that a rating can follow. They differ in Z_beta, Y_B and Y_DT; everything else is the same.

    The later ISO 6336:2019 (tip relief in Z_B, f_eps and another Y_beta in the root stress) is not covered.
    """

    ISO_2006 = "ISO 6336:2006"
    """ISO 6336-1, -2, -3:2006 with their corrigenda of 2008 (Z_beta = 1/sqrt(cos beta))."""

    DIN_1987 = "DIN 3990:1987"
    """DIN 3990-1, -2, -3:1987 (Z_beta = sqrt(cos beta); no rim thickness or deep tooth factor)."""
