"""Edition: which standard a rating follows, where the standards differ."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["Edition"]


class Edition(StrEnum):
    """The standards that a rating can follow. They differ in what is said of them; everything else is the same."""

    ISO_2006 = "ISO 6336:2006"
    """ISO 6336-1, -2, -3:2006 with their corrigenda of 2008 (Z_beta = 1/sqrt(cos beta))."""

    ISO_2019 = "ISO 6336:2019"
    """ISO 6336-2, -3:2019 as far as they are known, to be verified: Y_beta/cos^3 beta, f_eps in Y_F, f_ZCa in Z_B and Z_D."""

    DIN_1987 = "DIN 3990:1987"
    """DIN 3990-1, -2, -3:1987 (Z_beta = sqrt(cos beta), Z_X of large modules; no rim thickness or deep tooth factor)."""

    def part(self, number: int) -> str:
        """One of its parts, such as ISO 6336-3."""
        return f"{self.partition(':')[0]}-{number}"

    def dated_part(self, number: int) -> str:
        """The same with its year, such as ISO 6336-3:2006."""
        return f"{self.part(number)}:{self.partition(':')[2]}"
