"""Rings by formulas of the tests' own, and what a shaper cutter leaves of a gear, by brute force."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from gearcad import Gear
from gearcad.core.records import Floats

_NODES, _WEIGHTS = leggauss(80)


def _inv(angle: float) -> float:
    return math.tan(angle) - angle


@dataclass(frozen=True)
class RingSection:
    """The transverse section of a ring from its inputs alone. Lengths in mm, angles in radians."""

    gear: Gear

    @property
    def _angle(self) -> float:
        """alpha_t."""
        return math.atan(math.tan(math.radians(self.gear.rack.pressure_angle)) / self._c)

    @property
    def _c(self) -> float:
        return math.cos(math.radians(self.gear.helix_angle))

    @property
    def teeth(self) -> int:
        return -self.gear.teeth

    @property
    def reference(self) -> float:
        return self.teeth * self.gear.normal_module / self._c / 2

    @property
    def base(self) -> float:
        return self.reference * math.cos(self._angle)

    @property
    def tip(self) -> float:
        gear = self.gear
        return self.reference - gear.normal_module * (gear.rack.addendum + gear.profile_shift + gear.tip_alteration)

    @property
    def root(self) -> float:
        return self.reference + self.gear.normal_module * (self.gear.rack.dedendum - self.gear.profile_shift)

    @property
    def tip_form(self) -> float:
        return self.tip + self.gear.body.tip_chamfer

    @property
    def pitch(self) -> float:
        return 2 * math.pi / self.teeth

    def involute_angle(self, radius: Floats) -> Floats:
        """Half tooth angle on the involute."""
        gear, pressure = self.gear, np.arccos(self.base / np.asarray(radius))
        slope = math.tan(math.radians(gear.rack.pressure_angle))
        thickness = gear.normal_module * (math.pi / 2 + 2 * gear.profile_shift * slope) - gear.tooth_thinning
        middle = thickness / gear.normal_module / self.teeth - _inv(self._angle)
        result: Floats = middle + np.tan(pressure) - pressure
        return result

    # ------------------------------------------------------------------ the cutter

    @cached_property
    def _cutter(self) -> tuple[int, float]:
        """Teeth and profile shift; a ring without a cutter is its own counterpart."""
        own = self.gear.cutter.teeth is None
        return (self.teeth, -self.gear.profile_shift) if own else (self.gear.cutter.teeth, self.gear.cutter.profile_shift)

    @cached_property
    def _apart(self) -> float:
        """a_0 (mm)."""
        teeth, shift = self._cutter
        if teeth == self.teeth:
            return 0.0
        slope = math.tan(math.radians(self.gear.rack.pressure_angle))
        goal = _inv(self._angle) + 2 * slope * (self.gear.profile_shift + shift) / (teeth - self.teeth)
        working = brentq(lambda angle: _inv(angle) - goal, 1e-9, 1.5, xtol=1e-15, rtol=8.9e-16)
        return (self.teeth - teeth) * self.gear.normal_module / self._c * math.cos(self._angle) / 2 / math.cos(working)

    @cached_property
    def corner(self) -> float:
        """Radius of the corner in the normal section (mm): the cutter's, else the rack's or the smaller full one."""
        if self.gear.cutter.tip_radius is not None:
            return self.gear.cutter.tip_radius * self.gear.normal_module
        most = 0.6 if self.gear.rack.root_radius == "full" else float(self.gear.rack.root_radius)
        if self._touching(most * self.gear.normal_module)[1] >= 0:
            return most * self.gear.normal_module
        return float(brentq(lambda radius: self._touching(radius)[1], 0.0, most * self.gear.normal_module, xtol=1e-14))

    def _ellipse(self, theta: Floats, radius: float) -> NDArray[np.complex128]:
        """Points of a corner on the cutter, its middle on the real axis."""
        return self.root - self._apart - radius + radius * np.cos(theta) + 1j * radius / self._c * np.sin(theta)

    def _touching(self, radius: float) -> tuple[float, float]:
        """theta where a corner touches the cutter's flank from inside, and the polar angle of its middle then."""
        teeth, shift = self._cutter
        base = teeth * self.gear.normal_module / self._c * math.cos(self._angle) / 2
        slope = math.tan(math.radians(self.gear.rack.pressure_angle))
        thickness = math.pi / 2 + 2 * shift * slope + self.gear.tooth_thinning / self.gear.normal_module
        start = thickness / teeth + _inv(self._angle)
        if not radius:  # the edge turns from the tip circle's normal to that of the involute
            pressure = math.acos(base / (self.root - self._apart))
            return math.atan2(math.cos(pressure), self._c * math.sin(pressure)), start - _inv(pressure)

        def room(theta: float) -> float:
            point = complex(self._ellipse(np.array(theta), radius))
            pressure = math.acos(min(base / abs(point), 1.0))
            return start - _inv(pressure) - math.atan2(point.imag, point.real)

        grid = np.linspace(0, math.pi / 2, 400)
        grid = grid[np.abs(self._ellipse(grid, radius)) > base]
        least = grid[int(np.argmin([room(each) for each in grid]))]
        near = (max(least - 0.005, 0.0), least + 0.005)
        found = minimize_scalar(room, bounds=near, method="bounded", options={"xatol": 1e-12})
        return float(found.x), float(found.fun)

    @cached_property
    def _touch(self) -> tuple[float, float]:
        return self._touching(self.corner)

    @cached_property
    def form(self) -> float:
        """Radius (mm) of the root form circle, where the corner's last point cuts."""
        return float(np.abs(self.fillet(np.array([self._touch[0]])))[0])

    def fillet(self, theta: Floats) -> NDArray[np.complex128]:
        """Points that the corner cuts, seen from the middle of a space: there its outline moves along itself.

        With k = z_0/z and alpha the corner's direction, Re((1 - k) p'* p - k a_0 p'* exp(-i alpha)) = 0.
        """
        point, along = self._ellipse(theta, self.corner), -np.sin(theta) + 1j / self._c * np.cos(theta)
        middle = self._touch[1]
        if not self._apart:
            return point * np.exp(1j * middle)
        share = self._cutter[0] / self.teeth
        cosine = (1 - share) * (along.conj() * point).real / (share * self._apart * np.abs(along))
        alpha = np.arccos(cosine) - np.angle(along)
        return (self._apart + point * np.exp(1j * alpha)) * np.exp(-1j * share * (alpha - middle))

    # ------------------------------------------------------------------ how far points are off

    def folded(self, points: Floats) -> tuple[Floats, Floats]:
        """Radius (mm) and angle (rad) from the middle of the nearest tooth of points (n, 3), the twist taken off."""
        rate = math.tan(math.radians(self.gear.helix_angle)) / self.reference
        angle = np.arctan2(points[:, 1], points[:, 0]) - rate * points[:, 2]
        return np.hypot(points[:, 0], points[:, 1]), np.mod(angle + self.pitch / 2, self.pitch) - self.pitch / 2

    def off(self, points: Floats) -> Floats:
        """How far (mm) points (n, 3) on flanks, fillets and tip chamfers are off the exact surface, in the section."""
        radius, angle = self.folded(points)
        angle = np.abs(angle)
        result = np.empty(len(radius))
        deep, high = radius > self.form, radius < self.tip_form
        flank = ~deep & ~high
        result[flank] = self.base * (angle[flank] - self.involute_angle(radius[flank]))
        result[deep] = self._off_fillet(radius[deep] * np.exp(1j * (self.pitch / 2 - angle[deep])))
        result[high] = self._off_chamfer(radius[high], angle[high])
        return np.abs(result)

    def _off_chamfer(self, radius: Floats, angle: Floats) -> Floats:
        """From the line at 45 degrees to the radius through the end of the involute."""
        turned = angle - float(self.involute_angle(np.array(self.tip_form)))
        result: Floats = (radius * np.cos(turned) - self.tip_form - radius * np.sin(turned)) / math.sqrt(2)
        return result

    def _off_fillet(self, points: NDArray[np.complex128]) -> Floats:
        """From the rim of the corner, where it comes nearest; negative where the corner would cut the point away."""
        share, middle = self._cutter[0] / self.teeth, self._touch[1]

        def inside(turn: Floats, points: NDArray[np.complex128]) -> NDArray[np.complex128]:
            corner = (points * np.exp(1j * share * turn) - self._apart) * np.exp(-1j * (middle + turn))
            corner -= self.root - self._apart - self.corner
            return corner.real + 1j * self._c * corner.imag  # a circle

        if not self._apart:
            nearest = inside(np.zeros(len(points)), points)
        else:
            turns = np.linspace(-2.0, 2.0, 800)
            step = turns[1] - turns[0]
            best = turns[np.argmin(np.abs(inside(turns[:, None], points)), axis=0)]
            low, high = best - step, best + step
            for _ in range(50):
                one, other = low + (high - low) / 3, high - (high - low) / 3
                first = np.abs(inside(one, points)) < np.abs(inside(other, points))
                low, high = np.where(first, low, one), np.where(first, other, high)
            nearest = inside((low + high) / 2, points)
        if not self.corner:
            return np.abs(nearest)
        stretched = np.abs(nearest.real + 1j * self._c * nearest.imag) / np.abs(nearest)  # of a step across the ellipse
        result: Floats = (np.abs(nearest) - self.corner) / stretched
        return result

    # ------------------------------------------------------------------ volumes

    @property
    def volume(self) -> float:
        """Volume of the whole ring (mm³): annulus and teeth over the height that the end cones leave, less the bolt holes."""
        body = self.gear.body
        around = self._moment(np.array([body.rim_diameter / 2, self.root]))
        holes = body.bolt_holes * math.pi * body.bolt_diameter**2 / 4 * self.gear.face_width
        return 2 * math.pi * float(around[0] - around[1]) + self.teeth * self._tooth(self._moment) - holes

    @property
    def inertia(self) -> float:
        """Moment of the whole ring about its axis (mm⁵), without end chamfers."""
        body, width = self.gear.body, self.gear.face_width

        def moment(radius: Floats) -> Floats:
            return width * radius**4 / 4

        around = moment(np.array([body.rim_diameter / 2, self.root]))
        hole = math.pi * body.bolt_diameter**2 / 4 * (body.bolt_diameter**2 / 8 + body.bolt_circle**2 / 4) * width
        return 2 * math.pi * float(around[0] - around[1]) + self.teeth * self._tooth(moment) - body.bolt_holes * hole

    @property
    def _face(self) -> tuple[float, float]:
        """Radius (mm) where the end cones begin, and their slope."""
        slope = math.tan(math.radians(self.gear.body.end_chamfer_angle))
        return self.tip + self.gear.body.end_chamfer * slope, slope

    def _moment(self, radius: Floats) -> Floats:
        """Integral from 0 of R dR times the height (mm) that both end cones leave there."""
        face, slope = self._face
        whole = self.gear.face_width * radius**2 / 2
        if not self.gear.body.end_chamfer:
            return np.asarray(whole)
        below = np.minimum(radius, face)
        return np.asarray(whole - 2 * (face * below**2 / 2 - below**3 / 3) / slope)

    def _tooth(self, moment: Callable[[Floats], Floats]) -> float:
        """Integral over one tooth of what `moment` is the integral of, by parts: 2 [psi G] - 2 int G dpsi."""
        theta = self._touch[0]

        def fillet(s: Floats) -> tuple[Floats, Floats]:
            points = self.fillet(theta * np.asarray(s))
            return np.abs(points), self.pitch / 2 - np.angle(points)

        def involute(s: Floats) -> tuple[Floats, Floats]:
            first, last = (math.sqrt(radius**2 - self.base**2) for radius in (self.form, self.tip_form))
            radius = np.hypot(self.base, first + np.asarray(s) * (last - first))
            return radius, self.involute_angle(radius)

        def chamfer(s: Floats) -> tuple[Floats, Floats]:
            start = self.tip_form
            run = (start - math.sqrt(2 * self.tip**2 - start**2)) / 2 * np.asarray(s)
            angle = float(self.involute_angle(np.array(start)))
            return np.hypot(start - run, run), angle - np.arctan2(run, start - run)

        curves = [fillet, involute, *([chamfer] if self.gear.body.tip_chamfer else [])]
        total = sum(self._along(curve, moment) for curve in curves)
        (first,), (start,) = curves[0](np.array([0.0]))
        (last,), (end,) = curves[-1](np.array([1.0]))
        edges = moment(np.array([first, last]))
        return float(2 * start * edges[0] - 2 * end * edges[1] + 2 * total)

    def _along(self, curve: _Curve, moment: Callable[[Floats], Floats]) -> float:
        """Integral of G dpsi along a curve, root to tip, parted where it enters the cone."""
        slope = Chebyshev.interpolate(lambda s: curve(s)[1], 60, domain=[0, 1]).deriv()
        breaks = [0.0, 1.0]
        face = self._face[0]
        radii = [float(curve(np.array([s]))[0][0]) for s in breaks]
        if self.gear.body.end_chamfer and radii[1] < face < radii[0]:
            breaks.insert(1, brentq(lambda s: float(curve(np.array([s]))[0][0]) - face, 0.0, 1.0, xtol=1e-15))
        total = 0.0
        for low, high in pairwise(breaks):
            s = (low + high) / 2 + _NODES * (high - low) / 2
            total += float((_WEIGHTS * moment(curve(s)[0]) * slope(s)).sum()) * (high - low) / 2
        return total


_Curve = Callable[[Floats], tuple[Floats, Floats]]


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
