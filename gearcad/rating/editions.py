"""Edition: which standard a rating follows, where the standards differ."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["Edition"]


class Edition(StrEnum):
    """The standards that a rating can follow. They differ in Z_beta, Y_B and Y_DT; everything else is the same.

    The later ISO 6336:2019 (tip relief in Z_B, f_eps and another Y_beta in the root stress) is not covered.
    """

    ISO_2006 = "ISO 6336:2006"
    """ISO 6336-1, -2, -3:2006 with their corrigenda of 2008 (Z_beta = 1/sqrt(cos beta))."""

    DIN_1987 = "DIN 3990:1987"
    """DIN 3990-1, -2, -3:1987 (Z_beta = sqrt(cos beta); no rim thickness or deep tooth factor)."""

    def part(self, number: int) -> str:
        """One of its parts, such as ISO 6336-3."""
        return f"{self.partition(':')[0]}-{number}"

    def dated_part(self, number: int) -> str:
        """The same with its year, such as ISO 6336-3:2006."""
        return f"{self.part(number)}:{self.partition(':')[2]}"
