"""Texts that fit the room they have: closer letters, smaller ones, several lines, and only then an ellipsis. Lengths in mm."""

from __future__ import annotations

import unicodedata
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate

from gearcad.drawing.frame.sizes import LEAST
from gearcad.drawing.shapes import Anchor, Figure, Pen, Point, Text, text_width
from gearcad.drawing.shapes.font import STRETCH
from gearcad.notice import Notice

__all__ = ["CLOSEST", "Fitted", "fit", "shortened_notice"]

CLOSEST = 0.65
"""Width of the closest letters over that of the font."""

_HEIGHTS = (14.0, 10.0, 7.0, 5.0, 3.5, 2.5, LEAST)
"""Those of ISO 3098-1, and the smallest."""

_PITCH = 1.6
"""Of lines, over the height of letters."""

_ELLIPSIS = "…"


@dataclass(frozen=True)
class Fitted:
    """Lines of one height and width of letters; `kept` are the characters that are left where it was shortened."""

    lines: tuple[str, ...]
    height: float
    stretch: float = STRETCH
    kept: int | None = None

    @property
    def pitch(self) -> float:
        """From line to line."""
        return _PITCH * self.height

    @property
    def depth(self) -> float:
        """From the top of the first line's capitals to the line of the last."""
        return self.height + self.pitch * (len(self.lines) - 1)

    def at(self, place: Point, anchor: Anchor = Anchor.LEFT, pen: Pen = Pen.TEXT) -> Figure:
        """The texts, the last line at a place."""
        up = [self.pitch * (len(self.lines) - 1 - number) for number in range(len(self.lines))]
        texts = zip(self.lines, up, strict=True)
        return Figure(
            tuple(
                Text(line, (place[0], place[1] + above), self.height, anchor, pen=pen, stretch=self.stretch)
                for line, above in texts
                if line
            )
        )


def fit(text: str, room: float, height: float, *, depth: float = 0.0, least: float = LEAST, closest: float = CLOSEST) -> Fitted:
    """A text in a room that is so wide, and so high (`depth`, else one line); letters no smaller than `least`, nor closer
    than `closest`.

    The largest letters of those that serve; of equal ones the fewest lines, and letters closer rather than more lines.
    """
    measured = _Measured.of(text)
    heights = [height, *(each for each in _HEIGHTS if least < each < height), *([least] if least < height else [])]
    for each in heights:
        for count in range(1, _most_lines(each, depth) + 1):
            for stretch in _stretches(measured, room, each, count, closest):
                lines = measured.wrapped(room / (each * stretch))
                if len(lines) <= count:
                    return Fitted(lines, each, stretch)
    smallest = heights[-1]
    count = _most_lines(smallest, depth)
    lines = measured.wrapped(room / (smallest * closest), count)
    if room < text_width(_ELLIPSIS, smallest, closest):
        return Fitted(("",), smallest, closest, 0)
    return Fitted(lines, smallest, closest, sum(map(len, lines)) - 1)


def shortened_notice(key: str, text: str, fitted: Fitted, owner: str) -> tuple[Notice, ...]:
    """That a text was shortened; nothing where it was not."""
    if fitted.kept is None:
        return ()
    return (Notice("drawing-shortened", f"{owner} has room for {fitted.kept} of its {len(text)} characters", where=key),)


def _most_lines(height: float, depth: float) -> int:
    return max(1, int((depth - height) / (_PITCH * height) + 1 + 1e-9))


def _stretches(measured: _Measured, room: float, height: float, lines: int, closest: float) -> Iterator[float]:
    """Widths of letters to try, the widest first."""
    yield STRETCH
    whole = measured.width * height
    if lines == 1 and whole:
        needed = room / whole * (1 - 1e-9)
        if closest <= needed < STRETCH:
            yield needed
    elif lines > 1:
        yield closest


@dataclass(frozen=True)
class _Measured:
    """A text with the places of its letters, in lengths over height and width of letters."""

    text: str
    places: Sequence[float]

    @classmethod
    def of(cls, text: str) -> _Measured:
        return cls(text, [0.0, *accumulate(text_width(letter, 1.0, 1.0) for letter in text)])

    @property
    def width(self) -> float:
        return self.places[-1]

    def wrapped(self, room: float, most: int | None = None) -> tuple[str, ...]:
        """Lines that are no wider than `room`, broken at spaces where there are some; of at most so many the last has an
        ellipsis."""
        lines: list[str] = []
        start = 0
        while start < len(self.text) or not lines:
            if most is not None and len(lines) == most - 1 and self._reach(start, room) < len(self.text):
                end = self._reach(start, room - text_width(_ELLIPSIS, 1.0, 1.0))
                return (*lines, self.text[start:end].rstrip() + _ELLIPSIS)
            end, start_of_next = self._line(start, room)
            lines.append(self.text[start:end].rstrip())
            start = start_of_next
        return tuple(lines)

    def _reach(self, start: int, room: float) -> int:
        """The end of what of the text from `start` on has room; not before a mark that belongs to the letter before it."""
        end = bisect_right(self.places, self.places[start] + room + 1e-9) - 1
        while start < end < len(self.text) and _belongs(self.text[end]):
            end -= 1
        return max(end, start)

    def _line(self, start: int, room: float) -> tuple[int, int]:
        """The end of a line, and the start of the next."""
        end = max(self._reach(start, room), start + 1)
        if end >= len(self.text) or self.text[end] == " ":
            return end, end + 1
        space = self.text.rfind(" ", start, end)
        return (space, space + 1) if space > start else (end, end)


def _belongs(letter: str) -> bool:
    """Whether a letter stands on, or joins, the one before it."""
    return unicodedata.combining(letter) > 0 or unicodedata.category(letter) in ("Mn", "Me", "Cf") or letter in "\ufe0f\u200d"
