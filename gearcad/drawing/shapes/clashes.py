"""Occupied: what is on a sheet already, and whether something else would clash with it. Lengths in mm of paper."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from gearcad.arrays import Bools, Floats
from gearcad.drawing.shapes.box import Box
from gearcad.drawing.shapes.dimension import Dimension, Measured
from gearcad.drawing.shapes.figure import Figure
from gearcad.drawing.shapes.pens import Pen
from gearcad.drawing.shapes.shapes import Hatching, Line, Polyline, Segment, Shape

__all__ = ["Occupied"]

_AIR = 0.6
"""Least distance of a text from other texts and lines."""

_LANE = 6.0
"""Least distance of dimension lines that run beside each other."""

_BESIDE = 1.5
"""Least distance of a dimension line from other lines that run beside it."""

_LEVEL = 0.15
"""Slope up to which a line runs beside a dimension line: the top of a circle too."""

_ALONG = 1.0
"""So much may lines run beside each other, for they end in rounded numbers."""

_DOUBLE, _SAME = 1.0, 1e-6
"""Lines of marks that are nearer look like one that is drawn twice, but for those that lie upon each other."""


class Occupied:
    """What stands: no text may meet another, a line or hatching; lines may cross lines, but not symbols.

    Dimension lines keep away from each other and from lines that run beside them.
    """

    def __init__(self, *figures: Figure, taken: Iterable[Box] = (), within: Box | None = None) -> None:
        """`taken` are areas where nothing may be, `within` the one that nothing may leave."""
        self._texts, self._symbols = _no_rows(), _no_rows()
        self._segments, self._marks = _no_rows(), _no_rows()
        self._spans: dict[Measured, Floats] = {each: _no_rows(3) for each in (Measured.HORIZONTAL, Measured.VERTICAL)}
        self._hatched: list[Floats] = []
        self._taken, self._within = list(taken), within
        for figure in figures:
            self.add(figure)

    def add(self, figure: Figure) -> None:
        """What stands from now on."""
        self._texts = np.concatenate([self._texts, _text_boxes(figure)])
        self._symbols = np.concatenate([self._symbols, _symbol_boxes(figure)])
        self._segments = np.concatenate([self._segments, _as_rows(figure.segments)])
        self._marks = np.concatenate([self._marks, _mark_lines(figure)])
        for measured, spans in self._spans.items():
            self._spans[measured] = np.concatenate([spans, _spans(figure, measured)])
        self._hatched += [_edges(shape) for shape in figure.shapes if isinstance(shape, Hatching)]

    def clashes(self, figure: Figure) -> bool:
        """Whether a figure would meet what stands, or leave what it must stay within."""
        box = figure.box
        if self._within is not None and not self._within.holds(box):
            return True
        if any(box.meets(each) for each in self._taken):
            return True
        texts, rows = _grown(_text_boxes(figure), _AIR), _as_rows(figure.segments)
        symbols = _symbol_boxes(figure)
        return bool(
            _meet(texts, self._texts).any()
            or _meet(_grown(symbols, _AIR), self._symbols).any()
            or _meet(texts, self._symbols).any()
            or _meet(symbols, self._texts).any()
            or _crossed(texts, self._segments).any()
            or _crossed(_grown(self._texts, _AIR), rows).any()
            or _crossed(_grown(symbols, -0.05), self._segments).any()
            or _crossed(_grown(self._symbols, -0.05), rows).any()
            or any(_hatched(texts, edges).any() for edges in self._hatched)
            or any(self._too_near(figure, measured) for measured in self._spans)
        )

    def crossings(self, figure: Figure) -> int:
        """How many lines of dimensions, leaders and symbols it would cross with its own, or double.

        That is permitted, but better avoided.
        """
        lines = _mark_lines(figure)
        return int(_intersecting(lines, self._marks).sum() + _doubled(lines, self._marks).sum())

    def _too_near(self, figure: Figure, measured: Measured) -> bool:
        """Whether a dimension line would run beside another, or beside any other line."""
        spans = _spans(figure, measured)
        lines = self._segments if measured is Measured.HORIZONTAL else self._segments[:, [1, 0, 3, 2]]
        level = lines[np.abs(lines[:, 1] - lines[:, 3]) <= _LEVEL * np.abs(lines[:, 0] - lines[:, 2])]
        heights = (level[:, 1] + level[:, 3]) / 2
        others = np.stack([np.minimum(level[:, 0], level[:, 2]), np.maximum(level[:, 0], level[:, 2]), heights], axis=1)
        return bool(_beside(spans, self._spans[measured], _LANE).any() or _beside(spans, others, _BESIDE).any())


def _no_rows(width: int = 4) -> Floats:
    return np.empty((0, width))


def _text_boxes(figure: Figure) -> Floats:
    return np.array([text.box for text in figure.texts], dtype=float).reshape(-1, 4)


def _symbol_boxes(figure: Figure) -> Floats:
    """Frames and roughness symbols: nothing shall cross them either."""
    boxes = [shape.box for shape in figure.shapes if isinstance(shape, Polyline) and shape.pen is Pen.SYMBOL]
    return np.array(boxes, dtype=float).reshape(-1, 4)


def _as_rows(segments: list[Segment]) -> Floats:
    return np.array([(*start, *end) for start, end in segments], dtype=float).reshape(-1, 4)


def _edges(hatching: Hatching) -> Floats:
    return np.concatenate([_as_rows(Polyline(edge, closed=True).segments) for edge in hatching.edges])


def _parts(figure: Figure) -> Iterator[Shape]:
    for shape in figure.shapes:
        yield from shape.parts if isinstance(shape, Dimension) else (shape,)


def _mark_lines(figure: Figure) -> Floats:
    """Dimension, extension and leader lines."""
    lines = (part for part in _parts(figure) if isinstance(part, Line) and part.pen in (Pen.DIMENSION, Pen.SYMBOL))
    return _as_rows([(line.start, line.end) for line in lines])


def _spans(figure: Figure, measured: Measured) -> Floats:
    """Dimension lines of one direction, as (from, to, height); of vertical ones y is along, x the height."""
    found = []
    for shape in figure.shapes:
        if isinstance(shape, Dimension) and shape.measured is measured:
            turn = 1 if measured is Measured.HORIZONTAL else -1
            for part in shape.parts:
                if isinstance(part, Line):
                    (low, height), (high, other) = part.start[::turn], part.end[::turn]
                    if abs(height - other) < 1e-9:
                        found.append((min(low, high), max(low, high), height))
    return np.array(found, dtype=float).reshape(-1, 3)


def _grown(boxes: Floats, by: float) -> Floats:
    grown: Floats = boxes + np.array([-by, -by, by, by])
    return grown


def _meet(ones: Floats, others: Floats) -> Bools:
    """Which boxes have an area in common with which, shape (ones, others)."""
    one, other = ones[:, None, :], others[None, :, :]
    met: Bools = np.all((one[..., :2] < other[..., 2:]) & (other[..., :2] < one[..., 2:]), axis=-1)
    return met


def _beside(spans: Floats, others: Floats, distance: float) -> Bools:
    """Which spans run beside which others, nearer than a distance."""
    one, other = spans[:, None, :], others[None, :, :]
    shared = np.minimum(one[..., 1], other[..., 1]) - np.maximum(one[..., 0], other[..., 0])
    return (shared > _ALONG) & (np.abs(one[..., 2] - other[..., 2]) < distance)


def _doubled(ones: Floats, others: Floats) -> Bools:
    """Which level or upright segments run so near beside which others that they look like one line drawn twice."""
    found = np.zeros((len(ones), len(others)), dtype=bool)
    for turn in ([0, 1, 2, 3], [1, 0, 3, 2]):
        one, other = _level_spans(ones[:, turn]), _level_spans(others[:, turn])
        apart = np.abs(one[:, None, 2] - other[None, :, 2])
        found |= _beside(one, other, _DOUBLE) & (apart > _SAME)
    return found


def _level_spans(segments: Floats) -> Floats:
    """Segments as (from, to, height); those that are not level have no height."""
    height = np.where(np.abs(segments[:, 1] - segments[:, 3]) < _SAME, segments[:, 1], np.nan)
    return np.stack([np.minimum(segments[:, 0], segments[:, 2]), np.maximum(segments[:, 0], segments[:, 2]), height], axis=1)


def _crossed(boxes: Floats, segments: Floats) -> Bools:
    """Which segments have points within which boxes, shape (boxes, segments) (Liang and Barsky)."""
    low, high = boxes[:, None, :2], boxes[:, None, 2:]
    start, way = segments[None, :, :2], segments[None, :, 2:] - segments[None, :, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (low - start) / way, (high - start) / way
    still = way == 0
    outside = (still & ((start <= low) | (start >= high))).any(axis=-1)
    enter = np.where(still, -np.inf, np.minimum(near, far)).max(axis=-1)
    leave = np.where(still, np.inf, np.maximum(near, far)).min(axis=-1)
    crossed: Bools = ~outside & (np.maximum(enter, 0) < np.minimum(leave, 1))
    return crossed


def _hatched(boxes: Floats, edges: Floats) -> Bools:
    """Which boxes have their middle within hatching, or its edge across them."""
    x, y = ((boxes[:, None, side] + boxes[:, None, side + 2]) / 2 for side in (0, 1))
    (x1, y1, x2, y2) = edges.T[:, None, :]
    spanned = (y1 <= y) != (y2 <= y)
    with np.errstate(divide="ignore", invalid="ignore"):
        right = spanned & (x < x1 + (y - y1) * (x2 - x1) / (y2 - y1))
    within: Bools = (right.sum(axis=1) % 2 == 1) | _crossed(boxes, edges).any(axis=1)
    return within


def _intersecting(ones: Floats, others: Floats) -> Bools:
    """Which segments cross which, ends that only touch aside."""
    p, r = ones[:, None, :2], ones[:, None, 2:] - ones[:, None, :2]
    q, s = others[None, :, :2], others[None, :, 2:] - others[None, :, :2]
    cross = r[..., 0] * s[..., 1] - r[..., 1] * s[..., 0]
    apart = q - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (apart[..., 0] * s[..., 1] - apart[..., 1] * s[..., 0]) / cross
        u = (apart[..., 0] * r[..., 1] - apart[..., 1] * r[..., 0]) / cross
        inside: Bools = (t > 1e-6) & (t < 1 - 1e-6) & (u > 1e-6) & (u < 1 - 1e-6)
    return inside
