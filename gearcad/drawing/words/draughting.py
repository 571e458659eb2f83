"""Draughting: how a part is put on paper - at what scale, in which words."""

from __future__ import annotations

from dataclasses import dataclass

from gearcad.drawing.words.words import Words

__all__ = ["Draughting"]


@dataclass(frozen=True)
class Draughting:
    """`scale` is mm of paper for a mm of the part: 0.5 for 1:2."""

    words: Words
    scale: float = 1.0

    def paper(self, length: float) -> float:
        """Length on paper (mm) of a length of the part (mm)."""
        return length * self.scale
