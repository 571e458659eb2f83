"""Do a pinion and a ring overlap where they stand? Judged on polygons of their outlines, without any formula of meshing.

Points of one outline are carried into the frame of the other gear, where the angle to the nearest tooth and the polygon of
that tooth tell how far they are from its flank; then the other way round, since either gear's corner may be what touches.
All positions and teeth are looked at at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gearcad import Gear
from gearcad.geometry import ToothProfile

Floats = NDArray[np.float64]

CHORD_ERROR = 5e-5
"""Of the polygons, in transverse modules."""

TOUCH = 1e-3
"""Angle (rad) beyond the crescent between the tip circles at which teeth are still looked at."""


@dataclass(frozen=True)
class HalfTooth:
    """The polygon of half a tooth without its lands: radius (mm, rising) and half tooth angle (rad) of its corners."""

    radius: Floats
    angle: Floats

    @classmethod
    def of(cls, profile: ToothProfile, chord_error: float) -> HalfTooth:
        points = profile.points(chord_error)
        radius, angle = np.hypot(*points.T), np.arctan2(*points.T[::-1])
        ends = (profile.root_diameter / 2, profile.tip_diameter / 2)
        # Of a land only the corner where the flank begins or ends: it is as far from the middle of the land as can be.
        half = angle > 0
        flank = half & (np.abs(radius - ends[0]) > 1e-9 * radius) & (np.abs(radius - ends[1]) > 1e-9 * radius)
        root = half & (np.abs(radius - ends[0]) <= 1e-9 * radius)
        tip = half & (np.abs(radius - ends[1]) <= 1e-9 * radius)
        corners = [(ends[0], angle[root].min()), (ends[1], angle[tip].max())]
        radius = np.r_[radius[flank], [r for r, _ in corners]]
        angle = np.r_[angle[flank], [a for _, a in corners]]
        order = np.argsort(radius)
        return cls(radius[order], angle[order])

    def at(self, radius: Floats) -> Floats:
        """Half tooth angle (rad) of the polygon: on the chord between two corners, nearly."""
        result: Floats = np.interp(radius, self.radius, self.angle)
        return result


@dataclass(frozen=True)
class RingMesh:
    """A pinion and a ring at a distance of their axes (mm, a magnitude): the ring's axis at the origin, the pinion's on +x."""

    pinion: Gear
    ring: Gear
    distance: float
    chord_error: float = CHORD_ERROR

    @cached_property
    def _halves(self) -> tuple[HalfTooth, HalfTooth]:
        chord = self.chord_error * self.pinion.transverse_module
        return HalfTooth.of(self.pinion.profile, chord), HalfTooth.of(self.ring.profile, chord)

    @cached_property
    def _pitches(self) -> tuple[float, float]:
        return 2 * math.pi / self.pinion.tooth_count, 2 * math.pi / self.ring.tooth_count

    def clearance(self, positions: ArrayLike, turned: float = 0.0, back: ArrayLike = 0.0) -> Floats:
        """Least distance (mm, along circles) of the outlines in each pose; negative where they overlap.

        At a position of 0 or 1 (pitches) a tooth of the pinion stands on the line of centres, midway in a space of the ring.
        The pinion is then `turned` (rad) by itself, and moved `back` (mm) towards the ring's axis. One value for each position.
        """
        positions, back = np.broadcast_arrays(np.asarray(positions, float), np.asarray(back, float))
        pinion, ring = (positions.ravel() * pitch for pitch in self._pitches)
        return self.standing(pinion + turned, ring + self._pitches[1] / 2, back.ravel()).reshape(positions.shape)

    def standing(self, pinion: Floats, ring: Floats, back: Floats) -> Floats:
        """The same for gears turned by angles (rad) from where tooth 0 stands on +x."""
        distance = (self.distance - back)[:, None, None]
        pinion, ring = pinion[:, None, None], ring[:, None, None]
        return np.minimum(self._pinion_in_ring(pinion, ring, distance), self._ring_in_pinion(pinion, ring, distance))

    def _pinion_in_ring(self, pinion: Floats, ring: Floats, distance: Floats) -> Floats:
        own, mate = self._halves
        tip, root, reach = mate.radius[0], mate.radius[-1], own.radius[-1]
        cosine = (tip**2 - distance**2 - reach**2) / (2 * distance * reach)
        angle = pinion + self._turns(pinion, cosine, self._pitches[0], own.angle)
        radius = np.r_[own.radius, own.radius]
        across, along = distance + radius * np.cos(angle), radius * np.sin(angle)
        at = np.hypot(across, along)
        ahead = _from_tooth(np.arctan2(along, across) - ring, self._pitches[1])
        clear = np.where(at < tip, math.inf, (ahead - mate.at(at)) * at)
        return np.where(at > root, root - at, clear).min(axis=(1, 2))

    def _ring_in_pinion(self, pinion: Floats, ring: Floats, distance: Floats) -> Floats:
        mate, own = self._halves
        root, tip, reach = mate.radius[0], mate.radius[-1], own.radius[0]
        cosine = (reach**2 + distance**2 - tip**2) / (2 * distance * reach)
        angle = ring + self._turns(ring, cosine, self._pitches[1], own.angle)
        radius = np.r_[own.radius, own.radius]
        across, along = radius * np.cos(angle) - distance, radius * np.sin(angle)
        at = np.hypot(across, along)
        ahead = _from_tooth(np.arctan2(along, across) - pinion, self._pitches[0])
        clear = np.where(at > tip, math.inf, (ahead - mate.at(at)) * at)
        return np.where(at < root, at - root, clear).min(axis=(1, 2))

    @staticmethod
    def _turns(turned: Floats, cosine: Floats, pitch: float, half: Floats) -> Floats:
        """Angles (teeth, points) of both flanks of the teeth at no turn, which turned come to where the tip circles overlap.

        These cross at an angle with a `cosine`, from the line of centres about the gear's axis.
        """
        reach = math.acos(min(max(float(cosine.min()), -1.0), 1.0)) + half.max() + TOUCH
        first = np.floor((-turned.max() - reach) / pitch)
        last = np.ceil((-turned.min() + reach) / pitch)
        if last - first > 2 * math.pi / pitch:
            first, last = 0, round(2 * math.pi / pitch) - 1
        return (np.arange(first, last + 1) * pitch)[:, None] + np.r_[half, -half]


def _from_tooth(angle: Floats, pitch: float) -> Floats:
    """Angle (rad) to the middle of the nearest tooth."""
    result: Floats = np.abs(np.mod(angle + pitch / 2, pitch) - pitch / 2)
    return result
