"""Which flanks can touch at a position of the mesh, and the gap between them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gearcad.fea.contact import Cells, ContactPair
from gearcad.geometry import Gear, GearPair

__all__ = ["MeshLine", "TipRelief", "contact_pairs", "mesh_line"]

Floats = NDArray[np.float64]

_LEAST_LENGTH = 0.01
"""Least roll length (mm per mm of normal module) at which a flank still has a curvature to speak of."""


_FEWEST = 6
"""Cells of a pair of flanks, however narrow its window."""


@dataclass(frozen=True)
class TipRelief:
    """Linear tip relief: `amount` (um) at the tip, nothing `length` (mm along the line of action) below it."""

    amount: float = 0.0
    length: float = 0.0


@dataclass(frozen=True)
class _Flank:
    """Ends of the involute of a gear as roll lengths (mm), its base radius, and its relief."""

    base_radius: float
    first: float
    last: float
    relief: TipRelief

    @property
    def last_even(self) -> float:
        """Roll length (mm) where the relief begins."""
        return self.last - self.relief.length if self.relief.amount else self.last

    def relieved(self, lengths: Floats) -> Floats:
        """How far the flank is taken back at roll lengths (mm)."""
        if not self.relief.amount:
            return np.zeros_like(lengths)
        depth: Floats = self.relief.amount / 1000 * np.maximum(lengths - self.last_even, 0) / self.relief.length
        return depth

    def along_tangent(self, contact: float, length: float) -> float:
        """Where the flank's point at roll length `length` lies along the common tangent, if it touches at `contact` (mm)."""
        turn = (length - contact) / self.base_radius
        return self.base_radius * math.cos(turn) + length * math.sin(turn) - self.base_radius

    def facing(self, contact: float, place: Floats) -> tuple[Floats, Floats]:
        """Roll lengths at places along the tangent (towards the tip), and how far the flank lies behind the tangent (mm)."""
        base = self.base_radius
        turn = (np.sqrt(np.maximum(contact**2 + 2 * base * place, 1e-12)) - contact) / base
        for _ in range(6):
            length = contact + base * turn
            turn = turn - (base * np.cos(turn) + length * np.sin(turn) - base - place) / (length * np.cos(turn))
        length = contact + base * turn
        return length, contact - (length * np.cos(turn) - base * np.sin(turn))


def _flank(gear: Gear, relief: TipRelief) -> _Flank:
    base = gear.base_diameter

    def length(diameter: float) -> float:
        return math.sqrt(max((diameter - base) * (diameter + base), 0.0)) / 2

    return _Flank(base / 2, length(gear.form_diameter), length(gear.tip_form_diameter), relief)


@dataclass(frozen=True)
class MeshLine:
    """The line of action of a pair: its length T1T2 and the base pitch (mm), and both flanks."""

    whole: float
    pitch: float
    pinion: _Flank
    wheel: _Flank
    module: float


def mesh_line(pair: GearPair, reliefs: tuple[TipRelief, TipRelief] = (TipRelief(), TipRelief())) -> MeshLine:
    """The line of action of a pair in the transverse section, its flanks relieved."""
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    pinion, wheel = _flank(pair.pinion, reliefs[0]), _flank(pair.wheel, reliefs[1])
    return MeshLine(whole, pair.pinion.transverse_base_pitch, pinion, wheel, pair.pinion.normal_module)


def contact_pairs(
    line: MeshLine,
    pinion_length: float,
    span: Callable[[int, float], float],
    cells: int,
    farthest_gap: float,
    least_width: float = 0.0,
) -> tuple[ContactPair, ...]:
    """Pairs of flanks when the middle pair touches at `pinion_length` (mm from T1).

    Each has `cells` within `span(tooth, reduced radius)` (mm) on both sides of its contact, or fewer that are not narrower
    than `least_width` (mm). Beyond the path of contact the corner of a tip can touch while teeth bend: such pairs count up
    to `farthest_gap` (mm).
    """
    reach = math.ceil((line.pinion.last + line.wheel.last) / line.pitch)
    found = (
        _contact_pair(line, tooth, pinion_length + tooth * line.pitch, span, cells, farthest_gap, least_width)
        for tooth in range(-reach, reach + 1)
    )
    return tuple(pair for pair in found if pair is not None)


def _contact_pair(
    line: MeshLine,
    tooth: int,
    pinion_length: float,
    span: Callable[[int, float], float],
    cells: int,
    farthest_gap: float,
    least_width: float,
) -> ContactPair | None:
    wheel_length = line.whole - pinion_length
    least = _LEAST_LENGTH * line.module
    if pinion_length <= least or wheel_length <= least:
        return None
    one, other = line.pinion, line.wheel
    high = min(one.along_tangent(pinion_length, one.last), -other.along_tangent(wheel_length, other.first))
    low = max(one.along_tangent(pinion_length, one.first), -other.along_tangent(wheel_length, other.last))
    nearest = min(max(0.0, low), high)
    radius = pinion_length * wheel_length / line.whole
    if low >= high or nearest**2 / 2 / radius > farthest_gap:
        return None
    reach = span(tooth, radius)
    first, last = max(low, nearest - reach), min(high, nearest + reach)
    finest = max(2 * reach / cells, least_width)
    count = max(round((last - first) / finest), _FEWEST)
    width = (last - first) / count
    place = np.linspace(first + width / 2, last - width / 2, count)
    lengths, behind = one.facing(pinion_length, place)
    wheel_lengths, wheel_behind = other.facing(wheel_length, -place)
    # The mean gap over a cell is that of its middle and what the curvature adds.
    gap = behind + wheel_behind + width**2 / 24 / radius + one.relieved(lengths) + other.relieved(wheel_lengths)
    return ContactPair(tooth, pinion_length, wheel_length, Cells(place, width, lengths, wheel_lengths, gap))
