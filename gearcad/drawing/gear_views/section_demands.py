"""What is demanded of the surfaces of an external gear's half section: run-outs, roughness. Each has places, best first."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from gearcad.drawing.gear_views.meridian import strips
from gearcad.drawing.gear_views.silhouette import Silhouette
from gearcad.drawing.marks import Characteristic, Side, frame_leader, roughness, roughness_symbol, tolerance_frame
from gearcad.drawing.requirements import Requirements
from gearcad.drawing.shapes import Figure, Line, Pen, Point, Text
from gearcad.drawing.words import Draughting

__all__ = ["SectionDemands"]

_ALONG_TIP = (0.5, 0.3, 0.7, 0.15, 0.85)
_ALONG_FACE = (0.75, 0.9, 0.25, 0.5)
"""Where along an edge a leader may end, over its length."""

_STANDING = 18.0
"""Length of a face at the left on which a symbol has room to stand (mm of paper); else it is led to that at the right."""

_EXTENSIONS = (3.0, 12.0, 20.0, 28.0)
"""How far from the outline a symbol may stand on the reference line."""


@dataclass(frozen=True)
class SectionDemands:
    """Those of a gear."""

    outline: Silhouette
    requirements: Requirements
    draughting: Draughting

    @property
    def sources(self) -> tuple[Callable[[], Iterable[Figure]], ...]:
        """All of them."""
        return self.face_runout, self.flank_roughness, self.tip_runout, self.face_roughness

    def tip_runout(self) -> Iterator[Figure]:
        """To the datum axis A."""
        low, high = strips(self.outline.gear)[-1]
        for side in (Side.ABOVE, Side.BELOW):
            for part in _ALONG_TIP:
                tip = self.outline.along.point(low + part * (high - low), side.outwards * self.outline.tip)
                yield from self._frame(self.requirements.tip_runout, tip, side, self.outline.top * side.outwards)

    def face_runout(self) -> Iterator[Figure]:
        """Of both outermost faces, to the datum axis A."""
        outline, deviation = self.outline, self.requirements.face_runout
        faces = ((Side.RIGHT, outline.ends[1], outline.right), (Side.LEFT, outline.ends[0], outline.left))
        for side, height, clear in faces:
            (x, low), (_, high) = outline.end_face(height)
            for upwards in (1, -1):
                for part in _ALONG_FACE:
                    yield from self._frame(deviation, (x, upwards * (low + part * (high - low))), side, clear, "2×")

    def _frame(self, deviation: float | None, tip: Point, side: Side, clear: float, count: str = "") -> Iterable[Figure]:
        if deviation is None:
            return ()
        value = self.draughting.words.shortest(deviation / 1000, 4)
        frame = tolerance_frame(Characteristic.CIRCULAR_RUNOUT, value, "A")
        if count:
            frame += Figure((Text(count, (0.5, frame.box.top + 1.0)),))
        return frame_leader(tip, side, frame, clear=clear)

    def flank_roughness(self) -> Iterator[Figure]:
        """On the reference line, made longer for it (ISO 1302)."""
        flanks = self.requirements.flanks
        symbol = roughness_symbol(flanks.text(self.draughting.words.shortest(flanks.value)))
        pitch = self.outline.along.scale * self.outline.gear.reference_diameter / 2
        left, right = (self.outline.along.across(height) for height in self.outline.tooth_ends)
        for up in (pitch, -pitch):
            for air in _EXTENSIONS:
                at_right = symbol.moved(self.outline.right + air - symbol.box.left, up)
                at_left = symbol.moved(self.outline.left - air - symbol.box.right, up)
                yield Figure.of(Line((right, up), (at_right.box.right, up), Pen.DIMENSION), at_right)
                yield Figure.of(Line((at_left.box.left, up), (left, up), Pen.DIMENSION), at_left)

    def face_roughness(self) -> Iterator[Figure]:
        """Of both outermost faces, where it is not that of the rest."""
        if self.requirements.face_roughness == self.requirements.rest_roughness:
            return
        value = f"Ra {self.draughting.words.shortest(self.requirements.face_roughness)}"
        faces = [(side, *self.outline.end_face(z)) for z, side in zip(self.outline.ends, (Side.LEFT, Side.RIGHT), strict=True)]
        (_, (_, low), (_, high)), _ = faces
        for side, (x, inner), (_, outer) in faces if high - low >= _STANDING else reversed(faces):
            for upwards in (1, -1):
                ends = (x, upwards * inner), (x, upwards * outer)
                yield from roughness(*ends, side, value, self.draughting, count="2×")
