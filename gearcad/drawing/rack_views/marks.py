"""What stands beside the views of a rack: sizes, and roughness. Each has places, best first."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

from gearcad.drawing.marks import (
    Characteristic,
    Side,
    frame_leader,
    linear_dimension,
    roughness,
    roughness_symbol,
    section_arrows,
    tolerance_frame,
)
from gearcad.drawing.rack_views.figures import SECTION, tooth_middles
from gearcad.drawing.rack_views.span import Span
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Figure, Line, Pen, Point
from gearcad.drawing.words import Draughting, Size

__all__ = ["EndMarks", "FrontMarks"]

_EXTENSIONS = (4.0, 12.0, 20.0, 28.0)
"""How far from the outline a symbol may stand on the reference line (mm of paper)."""

_PAST = 2.0
"""How far such a line goes past it."""

_CUT_OFF = (2.0, 10.0, 18.0, 27.0, 37.0, 50.0, 65.0, 80.0)
"""How far from the outline the ends of the cutting line may be (mm of paper)."""

_ALONG_BACK = (0.1, 0.25, 0.4, 0.55, 0.7, 0.05)
_ALONG_TIP = (0.75, 0.9, 0.25, 0.1)
"""Where along an edge a leader may end, over its length."""

_CUT_AT = (0.6, 0.75, 0.45, 0.9, 0.3, 0.97)
"""Where along a part that is shown it may be, over its length."""

_PLACE_DECIMALS = 2
"""Of the place of the first tooth, for which general tolerances hold."""

_Sources = tuple[Callable[[], Iterable[Figure]], ...]


@dataclass(frozen=True)
class FrontMarks:
    """Those of the front view."""

    span: Span
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> _Sources:
        """All of them, those nearest to the outline first."""
        return self.first_tooth, self.pitch, self.back, self.cutting_line, self.length

    def length(self) -> Iterator[Figure]:
        """All of it, however much is shown: a program that draws it anew measures at a scale of its own."""
        size, back = self.requirements.length, -self.span.scale * self.span.rack.height
        if size is not None:
            left, right = (-self.span.right, back), (self.span.right, back)
            draughting = replace(self.draughting, scale=2 * self.span.right / self.span.rack.length)
            yield from linear_dimension(left, right, Side.BELOW, size, draughting, clear=back)

    def pitch(self) -> Iterable[Figure]:
        """Between the first two teeth, in brackets: it follows from module and helix angle."""
        middles = tooth_middles(self.span)
        size = Size(value=self.span.rack.transverse_pitch, reference=True)
        return self._above(middles[0], middles[1], size) if len(middles) > 1 else ()

    def first_tooth(self) -> Iterable[Figure]:
        """From the end to the middle of the first tooth."""
        middles = tooth_middles(self.span)
        size = Size(value=self.span.first_middle, decimals=_PLACE_DECIMALS)
        return self._above(-self.span.right, middles[0], size) if middles else ()

    def back(self) -> Iterator[Figure]:
        """How flat it is; it is datum A."""
        if (deviation := self.requirements.back_flatness) is None:
            return
        frame = tolerance_frame(Characteristic.FLATNESS, self.draughting.words.shortest(deviation / 1000, 4))
        back = -self.span.scale * self.span.rack.height
        for low, high in self.span.parts:
            left, right = self.span.across(low), self.span.across(high)
            for part in _ALONG_BACK:
                yield from frame_leader((left + part * (right - left), back), Side.BELOW, frame, datum_letter="A")

    def cutting_line(self) -> Iterator[Figure]:
        """Of the end section, somewhere along the rack, as near to it as other marks let it be; the length stands below it."""
        tip, back = self.span.scale * self.span.rack.tip_height, -self.span.scale * self.span.rack.height
        ends = [(self.span.across(low), self.span.across(high)) for low, high in reversed(self.span.parts)]
        for off in _CUT_OFF:
            for left, right in ends:
                for part in _CUT_AT:
                    x = left + part * (right - left)
                    yield section_arrows((x, tip + off), (x, back - off), Side.RIGHT, SECTION)

    def _above(self, left: float, right: float, size: Size) -> Iterator[Figure]:
        tip = self.span.scale * self.span.rack.tip_height
        yield from linear_dimension((left, tip), (right, tip), Side.ABOVE, size, self.draughting, clear=tip)


@dataclass(frozen=True)
class EndMarks:
    """Those of the end section."""

    requirements: Requirements
    draughting: Draughting
    half: float
    """Half the face width; this and the next on paper."""

    tip: float
    back: float
    """Heights of tips and back."""

    @property
    def sources(self) -> _Sources:
        """All of them, those nearest to the outline first."""
        sizes = self.face_width, self.reference_height, self.height
        return *sizes, self.parallelism, self.flank_roughness, self.back_roughness

    def face_width(self) -> Iterator[Figure]:
        left, right = (-self.half, self.back), (self.half, self.back)
        yield from linear_dimension(left, right, Side.BELOW, self.requirements.face_width, self.draughting, clear=self.back)

    def reference_height(self) -> Iterable[Figure]:
        """From the back to the reference line."""
        return self._upright(0.0, self.requirements.reference_height)

    def height(self) -> Iterable[Figure]:
        """From the back to the tips."""
        return self._upright(self.tip, self.requirements.height)

    def _upright(self, top: float, size: Size | None) -> Iterator[Figure]:
        if size is None:
            return
        for side in (Side.RIGHT, Side.LEFT):
            out = side.outwards * self.half
            yield from linear_dimension((out, self.back), (out, top), side, size, self.draughting, clear=out)

    def parallelism(self) -> Iterator[Figure]:
        """Of the tips to the back, which is datum A; where there is no room on their line made longer."""
        if (deviation := self.requirements.back_parallelism) is None:
            return
        frame = tolerance_frame(Characteristic.PARALLELISM, self.draughting.words.shortest(deviation / 1000, 4), "A")
        for part in _ALONG_TIP:
            yield from frame_leader(((2 * part - 1) * self.half, self.tip), Side.ABOVE, frame)
        for out in _EXTENSIONS:
            for along in (Side.RIGHT, Side.LEFT):
                start, end = along.outwards * self.half, along.outwards * (self.half + out)
                line = Line((start, self.tip), (end + along.outwards * _PAST, self.tip), Pen.DIMENSION)
                for side in (Side.ABOVE, Side.BELOW):
                    yield from (Figure.of(line) + each for each in frame_leader((end, self.tip), side, frame))

    def flank_roughness(self) -> Iterator[Figure]:
        """On the reference line, made longer for it (ISO 1302)."""
        flanks = self.requirements.flanks
        symbol = roughness_symbol(flanks.text(self.draughting.words.shortest(flanks.value)))
        box = symbol.box
        for out in _EXTENSIONS:
            for start, left in ((-self.half, -self.half - out - box.width), (self.half, self.half + out)):
                end = left if start < 0 else left + box.width
                yield Figure.of(Line((start, 0.0), (end, 0.0), Pen.DIMENSION), symbol.moved(left - box.left, 0.0))

    def back_roughness(self) -> Iterator[Figure]:
        """Of the back, on which it stands, where it is not that of the rest."""
        value = self.requirements.face_roughness
        if value != self.requirements.rest_roughness:
            ends: tuple[Point, Point] = ((-self.half, self.back), (self.half, self.back))
            yield from roughness(*ends, Side.BELOW, f"Ra {self.draughting.words.shortest(value)}", self.draughting)
