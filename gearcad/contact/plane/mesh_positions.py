"""Which flanks can touch at a position of the mesh, and the gap between them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.contact import Cells, ContactPair
from gearcad.geometry import FlankForm, GearPair

__all__ = ["MeshLine", "contact_pairs", "mesh_line", "rigid_approach"]


_LEAST_LENGTH = 0.01
"""Least roll length (mm per mm of normal module) at which a flank still has a curvature to speak of."""

_FEWEST = 6
"""Cells of a pair of flanks, however narrow its window."""

_SAMPLES = 1201
"""Places on a pair of flanks among which the nearest is sought: 5 um apart on teeth of module 2, 0.001 um of the gap."""

_BEND = 0.01
"""Distance (mm per mm of normal module) over which the curvature of a gap is taken."""


@dataclass(frozen=True)
class _Flank:
    """A flank in the transverse section at the height `height` (mm) of its gear; places on it are roll lengths (mm)."""

    form: FlankForm
    height: float

    @property
    def base_radius(self) -> float:
        """Radius of the base circle (mm)."""
        return self.form.base_radius

    @property
    def first(self) -> float:
        """Where the involute begins."""
        return self.form.first

    @property
    def last(self) -> float:
        """Where the involute ends."""
        return self.form.last

    @property
    def even(self) -> tuple[float, float]:
        """Where the root relief ends and the tip relief begins."""
        of = self.form.modification
        return (
            self.first + of.root_relief_length if of.root_relief else self.first,
            self.last - of.tip_relief_length if of.tip_relief else self.last,
        )

    def depth(self, lengths: Floats) -> Floats:
        """How far (mm) along the line of action the flank lies behind the points of the involute at roll lengths.

        What is there now has moved along the flank with its turn: it comes from as much nearer to the root as it lies behind.
        """
        return self.form.depth(lengths - self.form.depth(lengths, self.height), self.height)

    def along_tangent(self, contact: Any, length: float) -> Any:
        """Where the flank's point at roll length `length` lies along the common tangent, if it touches at `contact` (mm).

        Scalar or array, as `contact` is.
        """
        turn = (length - contact) / self.base_radius
        return self.base_radius * np.cos(turn) + length * np.sin(turn) - self.base_radius

    def facing(self, contact: float | Floats, place: Floats) -> tuple[Floats, Floats]:
        """Roll lengths at places along the tangent (towards the tip), and how far the flank lies behind the tangent (mm)."""
        base = self.base_radius
        turn = (np.sqrt(np.maximum(contact**2 + 2 * base * place, 1e-12)) - contact) / base
        for _ in range(6):
            length = contact + base * turn
            turn = turn - (base * np.cos(turn) + length * np.sin(turn) - base - place) / (length * np.cos(turn))
        length = contact + base * turn
        return length, contact - (length * np.cos(turn) - base * np.sin(turn))


@dataclass(frozen=True)
class MeshLine:
    """The line of action of a pair: its length T1T2 and the base pitch (mm), and both flanks.

    `proud` (mm) is how much further than the others the flanks of the middle pair stand out.
    """

    whole: float
    pitch: float
    pinion: _Flank
    wheel: _Flank
    module: float
    proud: float = 0.0

    @property
    def exact(self) -> bool:
        """True if all flanks are exact involutes in their places."""
        return not (self.proud or self.pinion.form.modification.present or self.wheel.form.modification.present)

    def taken_back(self, tooth: int, pinion_lengths: Floats, wheel_lengths: Floats) -> Floats:
        """What modifications and pitch errors add to the gap (mm) between the flanks of a pair of teeth."""
        depth = self.pinion.depth(pinion_lengths) + self.wheel.depth(wheel_lengths)
        return depth - self.proud if tooth == 0 else depth


def mesh_line(pair: GearPair, pitch_error: float = 0.0) -> MeshLine:
    """The line of action of a pair in the transverse section through the middle of its common face width.

    `pitch_error` (um) is how far the flanks of the middle pair of teeth stand proud, both together.
    """
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    middle = pair.common_width.offset
    pinion = _Flank(pair.pinion.flank_form, pair.pinion.face_width / 2 + middle)
    wheel = _Flank(pair.wheel.flank_form, pair.wheel.face_width / 2 + middle - pair.axial_offset)
    return MeshLine(whole, pair.pinion.transverse_base_pitch, pinion, wheel, pair.pinion.normal_module, pitch_error / 1000)


def rigid_approach(line: MeshLine, pinion_length: float, *, single: bool = False) -> float:
    """How far (mm) rigid gears approach along the line of action, from where exact involutes touch, until the first pair does.

    The middle pair touches at `pinion_length` (mm from T1); `single` lets no other pair touch. The transmission error of an
    unloaded pair; negative where teeth stand proud.
    """
    if line.exact:
        return 0.0
    teeth = (0,) if single else _teeth(line)
    found = (_nearest(line, tooth, pinion_length + tooth * line.pitch) for tooth in teeth)
    return min((gap for gap, _ in filter(None, found)), default=0.0)


def _teeth(line: MeshLine) -> range:
    """Every pair of teeth whose flanks can face each other."""
    reach = math.ceil((line.pinion.last + line.wheel.last) / line.pitch)
    return range(-reach, reach + 1)


def _overlap(line: MeshLine, pinion_length: float) -> tuple[float, float]:
    """Between which places along the tangent (mm) two flanks face each other; nothing is left if the first is not below."""
    wheel_length, least = line.whole - pinion_length, _LEAST_LENGTH * line.module
    if min(pinion_length, wheel_length) <= least:
        return 0.0, 0.0
    one, other = line.pinion, line.wheel
    return (
        max(one.along_tangent(pinion_length, one.first), -other.along_tangent(wheel_length, other.last)),
        min(one.along_tangent(pinion_length, one.last), -other.along_tangent(wheel_length, other.first)),
    )


@lru_cache(1024)
def _nearest(line: MeshLine, tooth: int, pinion_length: float) -> tuple[float, float] | None:
    """The least gap (mm) between the flanks of a pair of teeth, and its place along the tangent; None if they do not face.

    Known for the last positions: every torque and every step of its solution asks for it again.
    """
    low, high = _overlap(line, pinion_length)
    if low >= high:
        return None
    if line.exact:
        place = min(max(0.0, low), high)
        return place**2 * line.whole / 2 / pinion_length / (line.whole - pinion_length), place
    places = np.linspace(low, high, _SAMPLES)
    gap = _gap(line, tooth, pinion_length, places)[2]
    # The top of a parabola between the samples: else contact would jump from one to the next as gears roll.
    least = min(max(int(gap.argmin()), 1), _SAMPLES - 2)
    before, at, after = gap[least - 1 : least + 2]
    bend = before - 2 * at + after
    aside = float(np.clip((before - after) / (2 * bend), -1, 1)) if bend > 0 else 0.0
    return float(at - (before - after) * aside / 2 + bend * aside**2 / 2), float(
        places[least] + aside * (places[1] - places[0])
    )


def _gap(line: MeshLine, tooth: int, pinion_length: float, place: Floats) -> tuple[Floats, Floats, Floats]:
    """Roll lengths of both flanks that face each other at places along the tangent, and the gap between them (mm)."""
    lengths, behind = line.pinion.facing(pinion_length, place)
    wheel_lengths, wheel_behind = line.wheel.facing(line.whole - pinion_length, -place)
    return lengths, wheel_lengths, behind + wheel_behind + line.taken_back(tooth, lengths, wheel_lengths)


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
    to `farthest_gap` (mm) from where exact involutes would touch.
    """
    found = (
        _contact_pair(line, tooth, pinion_length + tooth * line.pitch, span, cells, farthest_gap, least_width)
        for tooth in _teeth(line)
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
    found = _nearest(line, tooth, pinion_length)
    if found is None or found[0] > farthest_gap:
        return None
    (low, high), nearest = _overlap(line, pinion_length), found[1]
    wheel_length = line.whole - pinion_length
    radius = pinion_length * wheel_length / line.whole
    reach = span(tooth, radius)
    first, last = max(low, nearest - reach), min(high, nearest + reach)
    finest = max(2 * reach / cells, least_width)
    count = max(round((last - first) / finest), _FEWEST)
    width = (last - first) / count
    place = np.linspace(first + width / 2, last - width / 2, count)
    lengths, wheel_lengths, gap = _gap(line, tooth, pinion_length, place)
    # The mean gap over a cell is that of its middle and what the curvature adds.
    gap = gap + width**2 / 24 / radius
    added = 0.0 if line.exact else _curvature(line, tooth, pinion_length, nearest) - 1 / radius
    return ContactPair(tooth, pinion_length, wheel_length, Cells(place, width, lengths, wheel_lengths, gap), added)


def _curvature(line: MeshLine, tooth: int, pinion_length: float, place: float) -> float:
    """Relative curvature (1/mm) of two flanks at a place along the tangent: second difference of their gap."""
    step = _BEND * line.module
    before, at, after = _gap(line, tooth, pinion_length, place + step * np.array([-1.0, 0.0, 1.0]))[2]
    return float(before - 2 * at + after) / step**2
