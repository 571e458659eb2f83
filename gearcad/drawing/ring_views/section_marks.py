"""What stands beside the section of a ring: sizes, the datum on its rim, run-outs, roughness. Each has places, best first."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from gearcad.drawing.marks import (
    Characteristic,
    Side,
    frame_leader,
    leader,
    linear_dimension,
    roughness,
    roughness_symbol,
    tolerance_frame,
)
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.ring_views.meridian import Meridian
from gearcad.drawing.shapes import Figure, Line, Pen, Point, Text
from gearcad.drawing.words import Draughting, Size

__all__ = ["SectionMarks"]

_ALONG = (0.5, 0.3, 0.7, 0.15, 0.85)
"""Where along an edge a leader may end, over its length."""

_EXTENSIONS = (5.0, 12.0, 20.0, 28.0, 38.0)
"""How far from the outline a mark may stand on a line that goes on (mm of paper)."""


@dataclass(frozen=True)
class SectionMarks:
    """Those of a ring."""

    ring: Meridian
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """All of them, those nearest to the outline first."""
        sizes = self.face_width, self.tip, self.rim, self.end_chamfer
        demands = self.face_runout, self.cylindricity, self.flank_roughness, self.tip_runout
        return *sizes, *demands, self.rim_roughness, self.face_roughness, self.open_rim

    @property
    def _right(self) -> float:
        """Of the outline; the left is as far."""
        return self.ring.scale * self.ring.gear.face_width / 2

    @property
    def _top(self) -> float:
        return self.ring.scale * self.ring.rim

    # ------------------------------------------------------------------ sizes

    def face_width(self) -> Iterator[Figure]:
        for side in (Side.BELOW, Side.ABOVE):
            out = side.outwards * self._top
            left, right = (-self._right, out), (self._right, out)
            yield from linear_dimension(left, right, side, self.requirements.face_width, self.draughting, clear=out)

    def tip(self) -> Iterable[Figure]:
        chamfer = self.ring.scale * self.ring.gear.body.end_chamfer
        return self._diameter(self.ring.tip, self._right - chamfer, self.requirements.tip)

    def rim(self) -> Iterable[Figure]:
        """With datum A, which is its axis."""
        return self._diameter(self.ring.rim, self._right, self.requirements.rim, datum_letter="A")

    def _diameter(self, radius: float, out: float, size: Size | None, datum_letter: str = "") -> Iterator[Figure]:
        """One whose edges (mm of the part) are so far (mm of paper) from mid face width."""
        if size is None:
            return
        up = self.ring.scale * radius
        for side in (Side.LEFT, Side.RIGHT):
            low, high = (side.outwards * out, -up), (side.outwards * out, up)
            clear = side.outwards * self._right
            yield from linear_dimension(low, high, side, size, self.draughting, clear=clear, datum_letter=datum_letter)

    def end_chamfer(self) -> Iterator[Figure]:
        """A leader to one of the chamfers, from the opening."""
        size = self.requirements.end_chamfer
        if size is None:
            return
        radius, back = (self.ring.tip + self.ring.corner) / 2, self.ring.gear.body.end_chamfer / 2
        for up in (1, -1):
            for across in (1, -1):
                at = across * (self._right - self.ring.scale * back), up * self.ring.scale * radius
                ways = (-30.0, -45.0, -60.0, -15.0) if up > 0 else (30.0, 45.0, 60.0, 15.0)
                yield from leader(at, size, self.draughting, ways if across > 0 else tuple(180.0 - way for way in ways))

    def open_rim(self) -> Iterator[Figure]:
        """That nobody said where the ring ends."""
        if self.ring.is_open:
            words = self.draughting.words["rings.open_rim"]
            for up in (1, -1):
                yield from leader((self._right / 2, up * self._top), words, self.draughting, (up * 45.0, up * 30.0, up * 135.0))

    # ------------------------------------------------------------------ demands

    def cylindricity(self) -> Iterator[Figure]:
        """Of the rim, which is the datum."""
        for tip, side in self._on_rim():
            yield from self._frame(Characteristic.CYLINDRICITY, self.requirements.cylindricity, tip, side)

    def tip_runout(self) -> Iterator[Figure]:
        """Of the tip cylinder, where its line goes on beyond the outline; from the opening."""
        tip = self.ring.scale * self.ring.tip
        for out in _EXTENSIONS:
            for along in (Side.RIGHT, Side.LEFT):
                for up, side in ((tip, Side.BELOW), (-tip, Side.ABOVE)):
                    start, end = along.outwards * self._right, along.outwards * (self._right + out)
                    line = Line((start, up), (end + along.outwards * 2.0, up), Pen.DIMENSION)
                    yield from (
                        Figure.of(line) + frame
                        for frame in self._frame(
                            Characteristic.CIRCULAR_RUNOUT, self.requirements.tip_runout, (end, up), side, "A"
                        )
                    )

    def face_runout(self) -> Iterator[Figure]:
        """Of both end faces."""
        low, high = self.ring.scale * max(self.ring.root, self.ring.corner), self._top
        for side in (Side.RIGHT, Side.LEFT):
            for up in (1, -1):
                for part in _ALONG:
                    at = side.outwards * self._right, up * (low + part * (high - low))
                    yield from self._frame(
                        Characteristic.CIRCULAR_RUNOUT, self.requirements.face_runout, at, side, "A", count="2×"
                    )

    def _frame(
        self, kind: Characteristic, deviation: float | None, tip: Point, side: Side, datums: str = "", count: str = ""
    ) -> Iterator[Figure]:
        if deviation is None:
            return
        frame = tolerance_frame(kind, self.draughting.words.shortest(deviation / 1000, 4), datums)
        if count:
            frame += Figure((Text(count, (0.5, frame.box.top + 1.0)),))
        yield from frame_leader(tip, side, frame)

    def _on_rim(self) -> Iterator[tuple[Point, Side]]:
        for side in (Side.ABOVE, Side.BELOW):
            for part in _ALONG:
                yield ((2 * part - 1) * self._right, side.outwards * self._top), side

    def flank_roughness(self) -> Iterator[Figure]:
        """On the reference line, made longer for it (ISO 1302)."""
        flanks = self.requirements.flanks
        symbol = roughness_symbol(flanks.text(self.draughting.words.shortest(flanks.value)))
        pitch, box = self.ring.scale * self.ring.reference, symbol.box
        for up in (-pitch, pitch):
            for out in _EXTENSIONS:
                for start, left in ((self._right, self._right + out), (-self._right, -self._right - out - box.width)):
                    end = left + box.width if start > 0 else left
                    yield Figure.of(Line((start, up), (end, up), Pen.DIMENSION), symbol.moved(left - box.left, up))

    def rim_roughness(self) -> Iterator[Figure]:
        """Of the rim, where it is a datum and not as the rest."""
        if self.requirements.rim is None:
            return
        for side in (Side.ABOVE, Side.BELOW):
            up = side.outwards * self._top
            yield from self._roughness(self.requirements.bore_roughness, (-self._right, up), (self._right, up), side)

    def face_roughness(self) -> Iterator[Figure]:
        """Of both end faces."""
        low, high = self.ring.scale * max(self.ring.root, self.ring.corner), self._top
        for side in (Side.LEFT, Side.RIGHT):
            for up in (1, -1):
                out = side.outwards * self._right
                yield from self._roughness(self.requirements.face_roughness, (out, up * low), (out, up * high), side, "2×")

    def _roughness(self, value: float, start: Point, end: Point, side: Side, count: str = "") -> Iterator[Figure]:
        if value != self.requirements.rest_roughness:
            text = f"Ra {self.draughting.words.shortest(value)}"
            yield from roughness(start, end, side, text, self.draughting, count=count)
