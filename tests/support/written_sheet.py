"""A sheet as another program finds it in its DXF: what overlaps on it, what leaves it, what is written there.

Nothing of the project is used: lengths of texts are matplotlib's, places of entities those of the file.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import combinations, pairwise
from pathlib import Path
from typing import Any

import ezdxf
import matplotlib
import numpy as np
from ezdxf.disassemble import recursive_decompose
from ezdxf.path import from_hatch, make_path
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import TextPath, text_to_path
from numpy.typing import NDArray

from gearcad.core.records import Floats

TOUCH = 0.02
"""mm by which a text may reach into what is beside it: the rounding of a font's outlines."""

SAG = 0.02
"""mm between an arc and the chords that stand for it."""

MARGIN_LAYERS = {"FRAME", "GRID", "TABLE"}
"""Those of the marks and the grid between frame and paper's edge (ISO 5457)."""

CAPITALS = 1493 / 2048
"""Height of capitals of DejaVu Sans over its size, from the font's OS/2 table."""


@dataclass(frozen=True)
class WrittenText:
    """A text with the corners (4, 2) of its ink, counter-clockwise."""

    words: str
    layer: str
    corners: Floats

    def within(self, points: Floats) -> Floats:
        """Points (..., 2) as seen from the ink: its corners are those of the square from 0 to 1."""
        origin, along, up = self.corners[0], self.corners[1] - self.corners[0], self.corners[3] - self.corners[0]
        away = points - origin
        return np.stack([away @ along / (along @ along), away @ up / (up @ up)], axis=-1)

    @property
    def size(self) -> Floats:
        return np.array([np.linalg.norm(self.corners[1] - self.corners[0]), np.linalg.norm(self.corners[3] - self.corners[0])])

    def met_by(self, segments: Floats, grown: Floats | float = 0.0) -> NDArray[np.bool_]:
        """Which segments (n, 2, 2) have a point in the ink, grown by so many mm (n)."""
        ends = self.within(segments)
        start, way = ends[:, 0], ends[:, 1] - ends[:, 0]
        room = np.broadcast_to(np.asarray(grown), len(segments))[:, None] / self.size
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = (-room - start) / way, (1 + room - start) / way
        inside = (start > -room) & (start < 1 + room)
        low = np.where(way == 0, np.where(inside, -np.inf, np.inf), np.minimum(one, other)).max(axis=1)
        high = np.where(way == 0, np.where(inside, np.inf, -np.inf), np.maximum(one, other)).min(axis=1)
        return np.maximum(low, 0) < np.minimum(high, 1)

    def meets(self, other: WrittenText) -> bool:
        """Whether their inks have an area in common, more than a touch: no axis of either parts them."""
        for box in (self, other):
            for axis in (box.corners[1] - box.corners[0], box.corners[3] - box.corners[0]):
                unit = axis / np.linalg.norm(axis)
                ours, theirs = self.corners @ unit, other.corners @ unit
                if min(ours.max(), theirs.max()) - max(ours.min(), theirs.min()) <= TOUCH:
                    return False
        return True


@dataclass(frozen=True)
class WrittenSheet:
    """`size` (mm) of the paper, texts, segments (n, 2, 2) with the layers and widths (mm) of their lines, hatched areas."""

    size: tuple[float, float]
    texts: list[WrittenText]
    segments: Floats
    layers: list[str]
    widths: Floats
    hatched: list[list[Floats]]
    audit: list[str]
    dimensions: list[tuple[float, str, str]]
    """What each measures (mm of the part), its text as programs draw it anew, and what is written now."""

    centre_lines: Floats
    """Ends (n, 2, 2) of straight lines of dashes and dots."""

    @property
    def words(self) -> list[str]:
        return [text.words for text in self.texts]

    @property
    def frame(self) -> tuple[float, float, float, float]:
        """Left, bottom, right, top: the outermost lines of the layer, but the paper's edge and centring marks."""
        lines = self.segments[[layer == "FRAME" for layer in self.layers]]
        sides = []
        for axis, extent in enumerate(self.size):
            across = lines[np.ptp(lines[:, :, axis], axis=1) < 1e-6][:, 0, axis]
            inner = across[(across > 0.1) & (across < extent - 0.1) & (np.abs(across - extent / 2) > 0.1)]
            sides.append((float(inner.min()), float(inner.max())))
        (left, right), (bottom, top) = sides
        return left, bottom, right, top

    @property
    def faults(self) -> list[str]:
        """Everything that is wrong with it, a line each; none if it is as it should be."""
        return [*self.audit, *self._clashes(), *self._outside(), *self._misread(), *self._centres()]

    def _clashes(self) -> Iterator[str]:
        for one, other in self._neighbours():
            if one.meets(other):
                yield f"{one.words!r} meets {other.words!r} at {_place(one)}"
        for text in self.texts:
            for layer in self._layers_of(text.met_by(self.segments, self.widths / 2 - TOUCH)):
                yield f"{text.words!r} meets a line of {layer} at {_place(text)}"
            probes = np.array([*text.corners, text.corners.mean(axis=0)])
            if any(_inside(edges, probes).any() for edges in self.hatched):
                yield f"{text.words!r} is on a hatched area at {_place(text)}"

    def _neighbours(self) -> Iterator[tuple[WrittenText, WrittenText]]:
        """Texts whose upright boxes meet."""
        if not self.texts:
            return
        corners = np.array([text.corners for text in self.texts])
        low, high = corners.min(axis=1), corners.max(axis=1)
        meet = ((low[:, None] < high) & (low < high[:, None])).all(axis=2)
        for one, other in np.argwhere(np.triu(meet, 1)):
            yield self.texts[one], self.texts[other]

    def _layers_of(self, which: NDArray[np.bool_]) -> list[str]:
        return sorted({self.layers[k] for k in np.flatnonzero(which)})

    def _outside(self) -> Iterator[str]:
        left, bottom, right, top = self.frame
        for text in self.texts:
            low, high = text.corners.min(axis=0), text.corners.max(axis=0)
            is_of_grid = len(text.words) <= 2 and ((high < (left, bottom)).any() or (low > (right, top)).any())
            if (low < 0).any() or (high > self.size).any():
                yield f"{text.words!r} leaves the paper at {_place(text)}"
            elif not is_of_grid and ((low < (left, bottom)).any() or (high > (right, top)).any()):
                yield f"{text.words!r} leaves the frame at {_place(text)}"
        for layer in self._layers_of(self._past(0.0, 0.0, *self.size)):
            yield f"a line of {layer} leaves the paper"
        for layer in self._layers_of(self._past(*self.frame)):
            if layer not in MARGIN_LAYERS:
                yield f"a line of {layer} leaves the frame"

    def _misread(self) -> Iterator[str]:
        """Dimensions that would say something else if a program drew them anew: "<>" stands for what is measured."""
        for measured, text, written in self.dimensions:
            number = re.search(r"\d+(?:[.,](\d+))?", written)
            if "<>" not in text or number is None:
                continue
            half = 0.5 * 10.0 ** -len(number[1] or "")
            if abs(float(number[0].replace(",", ".")) - measured) > half + 1e-6:
                yield f"{written!r} measures {measured:.4f} mm"

    def _centres(self) -> Iterator[str]:
        """Centre lines that cross where neither begins: a gap or a dot may be there; and those that lie on each other."""
        for (start, end), (other, far) in combinations(self.centre_lines, 2):
            way, across, between = end - start, far - other, other - start
            lengths = np.hypot(*way), np.hypot(*across)
            sine = way[0] * across[1] - way[1] * across[0]
            if abs(sine) > 1e-6 * lengths[0] * lengths[1]:
                at = (between[0] * across[1] - between[1] * across[0]) / sine
                other_at = (between[0] * way[1] - between[1] * way[0]) / sine
                if all(TOUCH < part * length < length - TOUCH for part, length in zip((at, other_at), lengths, strict=True)):
                    yield "centre lines cross without dashes at {:.0f}, {:.0f}".format(*(start + at * way))
            elif abs(way[0] * between[1] - way[1] * between[0]) < TOUCH * lengths[0]:
                low, high = sorted((between @ way / lengths[0], (far - start) @ way / lengths[0]))
                if min(high, lengths[0]) - max(low, 0.0) > TOUCH:
                    yield "a centre line is drawn twice at {:.0f}, {:.0f}".format(*start)

    def _past(self, left: float, bottom: float, right: float, top: float) -> NDArray[np.bool_]:
        """Which segments leave a rectangle."""
        low, high = self.segments.min(axis=1), self.segments.max(axis=1)
        return (low < np.array([left, bottom]) - 1e-6).any(axis=1) | (high > np.array([right, top]) + 1e-6).any(axis=1)


def read_sheet(path: Path | str) -> WrittenSheet:
    """The sheet in a DXF."""
    document = ezdxf.readfile(path)
    auditor = document.audit()
    audit = [f"audit: {each.message}" for each in (*auditor.errors, *auditor.fixes)]
    space = document.modelspace()
    widths = {layer.dxf.name: layer.dxf.lineweight / 100 for layer in document.layers}
    texts, rows, layers, hatched = [], [], [], []
    for entity in recursive_decompose(space):
        layer = entity.dxf.layer
        if entity.dxftype() == "TEXT":
            if entity.plain_text().strip():
                texts.append(_text(entity, document))
        elif entity.dxftype() == "HATCH":
            hatched.append([_points(path) for path in from_hatch(entity)])
        else:
            row = _corners(entity) if entity.dxftype() == "SOLID" else _points(make_path(entity))
            rows += list(pairwise(row))
            layers += [layer] * (len(row) - 1)
    size = document.header["$LIMMAX"]
    dimensions = [
        (
            each.dxf.actual_measurement,
            each.dxf.text,
            " ".join(text.plain_text() for text in each.get_geometry_block().query("TEXT")),
        )
        for each in space.query("DIMENSION")
    ]
    return WrittenSheet(
        (size[0], size[1]),
        texts,
        np.array(rows),
        layers,
        np.array([widths[layer] for layer in layers]),
        hatched,
        audit,
        dimensions,
        np.array([[each.dxf.start.vec2, each.dxf.end.vec2] for each in space.query("LINE[layer=='CENTRE']")]).reshape(-1, 2, 2),
    )


def _points(path: Any) -> Floats:
    return np.array([(point.x, point.y) for point in path.flattening(SAG)])


def _corners(solid: Any) -> Floats:
    row = solid.vertices(close=True)
    return np.array([(point.x, point.y) for point in row])


def _text(entity: Any, document: Any) -> WrittenText:
    """Where its ink is."""
    dxf, words = entity.dxf, ezdxf.decode_dxf_unicode(entity.plain_text())
    alignment, place, _ = entity.get_placement()
    ink, advance = _ink(words, document.styles.get(dxf.style).dxf.font)
    low, high = ink[:2] * dxf.height, ink[2:] * dxf.height
    name = alignment.name
    along = -advance * dxf.height * dxf.width * (0.0 if name.endswith("LEFT") else 1.0 if name.endswith("RIGHT") else 0.5)
    up = -0.5 * dxf.height if name.startswith("MIDDLE") else 0.0
    left, right = along + low[0] * dxf.width, along + high[0] * dxf.width
    square = np.array([(left, up + low[1]), (right, up + low[1]), (right, up + high[1]), (left, up + high[1])])
    turn = np.radians(dxf.rotation)
    matrix = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return WrittenText(words, dxf.layer, square @ matrix + (place.x, place.y))


@cache
def _ink(words: str, font: str) -> tuple[Floats, float]:
    """Left, bottom, right, top of the ink and the advance, over the height of capitals."""
    file = Path(matplotlib.get_data_path(), "fonts", "ttf", font)
    properties = FontProperties(fname=str(file))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of letters that the font lacks, a box is there
        box = TextPath((0, 0), words, size=1 / CAPITALS, prop=properties, usetex=False).get_extents()
        width, _, _ = text_to_path.get_text_width_height_descent(words, properties, False)
    return np.array([box.x0, box.y0, box.x1, box.y1]), width / properties.get_size_in_points() / CAPITALS


def _inside(edges: list[Floats], points: Floats) -> NDArray[np.bool_]:
    """Which points are within an odd number of edges."""
    found = np.zeros(len(points), dtype=bool)
    for edge in edges:
        for (x0, y0), (x1, y1) in pairwise(np.vstack([edge, edge[:1]])):
            spans = (y0 > points[:, 1]) != (y1 > points[:, 1])
            if y0 != y1:
                found ^= spans & (points[:, 0] < x0 + (points[:, 1] - y0) * (x1 - x0) / (y1 - y0))
    return found


def _place(text: WrittenText) -> str:
    x, y = text.corners.mean(axis=0)
    return f"{x:.0f}, {y:.0f}"
