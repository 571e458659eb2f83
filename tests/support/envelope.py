"""What a shaper cutter leaves of a gear, by brute force: how far its outline reaches on each circle, over all rotations.

A point of the outline comes to a circle about the gear's axis at one rotation of the cutter, and then lies at some angle in the
gear. The greatest such angle is where the space ends. Neither the normal of the outline nor the pitch point is used.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from gearcad import Gear
from gearcad.core.records import Floats


def _involute(angle: float) -> float:
    return math.tan(angle) - angle


@dataclass(frozen=True)
class Cutter:
    """Half a tooth of a pinion-type cutter in the transverse section (mm, rad), and how it is set to its gear."""

    teeth: int
    tip_radius: float
    base_radius: float
    base_half_angle: float
    radius: float
    stretch: float
    centre_distance: float

    @classmethod
    def of(cls, gear: Gear, radius: float) -> Cutter:
        """That of a gear, its corner of `radius` normal modules; a ring without one is cut by its own counterpart, at 0 mm."""
        m, z = gear.normal_module, abs(gear.teeth)
        normal, helix = math.radians(gear.rack.pressure_angle), math.radians(gear.helix_angle)
        angle = math.atan(math.tan(normal) / math.cos(helix))
        sign = -1 if gear.internal else 1
        teeth = gear.cutter.teeth or z
        shift = gear.cutter.profile_shift if gear.cutter.teeth else -gear.profile_shift
        distance = 0.0
        if gear.cutter.teeth:
            wanted = _involute(angle) + 2 * math.tan(normal) * (gear.profile_shift + shift) / (gear.teeth + teeth)
            working = brentq(lambda a: _involute(a) - wanted, 1e-6, 1.5, xtol=1e-15)
            distance = (z + sign * teeth) * m / math.cos(helix) / 2 * math.cos(angle) / math.cos(working)
        thickness = math.pi / 2 + 2 * shift * math.tan(normal) + gear.tooth_thinning / m
        return cls(
            teeth=teeth,
            tip_radius=abs(abs(gear.root_diameter) / 2 - distance),
            base_radius=teeth * m / math.cos(helix) / 2 * math.cos(angle),
            base_half_angle=thickness / teeth + _involute(angle),
            radius=radius * m,
            stretch=1 / math.cos(helix),
            centre_distance=distance,
        )

    def _corner(self, theta: Floats) -> Floats:
        """The corner about its middle on the radial line, as complex numbers."""
        return self.tip_radius - self.radius + self.radius * np.cos(theta) + 1j * self.radius * self.stretch * np.sin(theta)

    def _flank(self, length: Floats) -> Floats:
        roll = length / self.base_radius
        return self.base_radius * np.hypot(1, roll) * np.exp(1j * (self.base_half_angle - roll + np.arctan(roll)))

    @property
    def join(self) -> tuple[float, float, float]:
        """theta and length of roll where corner and involute touch with one tangent, and the polar angle of the middle."""

        def apart(theta: float) -> float:
            # The angle between the corner and the radius, less that of the involute on the same circle.
            at = complex(self._corner(np.array(theta)))
            ahead = (-math.sin(theta) + 1j * self.stretch * math.cos(theta)) / at
            length = math.sqrt(max(abs(at) ** 2 - self.base_radius**2, 0.0))
            return math.atan2(ahead.imag, -ahead.real) - math.atan2(length, self.base_radius)

        theta = float(brentq(apart, 0.0, math.pi / 2, xtol=1e-15))
        at = complex(self._corner(np.array(theta)))
        length = math.sqrt(abs(at) ** 2 - self.base_radius**2)
        flank = complex(self._flank(np.array(length)))
        return theta, length, float(np.angle(flank) - np.angle(at))

    def outline(self, piece: int, share: Floats) -> Floats:
        """The corner from the tip on (0), or the involute from the corner to the base circle (1), as complex numbers."""
        theta, length, middle = self.join
        if piece == 0:
            return self._corner(theta * share) * np.exp(1j * middle)
        return self._flank(length * (1 - share))


def half_space_angle(gear: Gear, cutter: Cutter, radius: float) -> float:
    """Half the tooth space (rad) of a gear on a circle (mm), cut by a cutter."""
    if not cutter.centre_distance:
        return _at(cutter, radius)
    return max(_farthest(gear, cutter, radius, piece) for piece in (0, 1))


def _at(cutter: Cutter, radius: float) -> float:
    """The outline's own angle on a circle."""
    piece = 0 if radius >= float(np.abs(cutter.outline(0, np.array(1.0)))) else 1

    def beyond(share: float) -> float:
        return float(np.abs(cutter.outline(piece, np.array(share)))) - radius

    share = 1.0 if beyond(1.0) >= 0 else 0.0 if beyond(0.0) <= 0 else brentq(beyond, 0.0, 1.0, xtol=1e-16)
    return float(np.angle(cutter.outline(piece, np.array(share))))


def _farthest(gear: Gear, cutter: Cutter, radius: float, piece: int) -> float:
    """The greatest angle on a circle that points of one piece of the outline reach."""
    side = 1 if gear.internal else -1
    low, high = 0.0, 1.0
    best = -math.inf
    for _ in range(7):
        share = np.linspace(low, high, 401)
        point = cutter.outline(piece, share)
        away = np.abs(point)
        cosine = side * (radius**2 - cutter.centre_distance**2 - away**2) / (2 * cutter.centre_distance * away)
        bearing = np.arccos(np.where(np.abs(cosine) <= 1, cosine, np.nan))
        found = np.full(share.shape, -np.inf)
        for sign in (-1, 1):
            x, y = away * np.cos(bearing), sign * away * np.sin(bearing)
            turn = sign * bearing - np.angle(point)
            reached = np.arctan2(y, cutter.centre_distance + side * x) - turn * cutter.teeth / gear.tooth_count
            found = np.fmax(found, reached)
        at = int(np.argmax(found))
        best = max(best, float(found[at]))
        low, high = share[max(at - 1, 0)], share[min(at + 1, 400)]
    return best
