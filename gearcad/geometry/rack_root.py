"""Curves of the tooth of a rack, and the root that a tool cuts before the flank is finished, perhaps with a grinding notch.

A rack is cut and finished by tools with the profile of a space, so all of it is straight lines and arcs in the normal section.
Lengths in mm, angles in radians. Points are those of the left half of a tooth, which is centred on x = 0 with its tip up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, at_least, at_most
from gearcad.core.records import Floats
from gearcad.geometry.curves import PlaneCurve
from gearcad.geometry.involute import root_between
from gearcad.geometry.root_outline import ROUNDING


class RackCurveKind(Enum):
    """Kind of a piece of the outline; the value is its name in files."""

    ROOT = "root land"
    FILLET = "fillet"
    FLANK = "flank"
    CHAMFER = "tip chamfer"
    TIP = "tip land"


class RackCurve(PlaneCurve, Protocol):
    """A piece of the outline of the left half of a tooth, root side first."""

    @property
    def kind(self) -> RackCurveKind: ...


@dataclass(frozen=True)
class Straight:
    """A land, a flank, a chamfer, or what the flank of a protuberance cuts, between two points (mm)."""

    kind: RackCurveKind
    start: tuple[float, float]
    end: tuple[float, float]

    def points(self, s: ArrayLike) -> Floats:
        s = np.asarray(s, float)[..., None]
        points: Floats = (1 - s) * np.array(self.start) + s * np.array(self.end)
        return points

    def direction(self, s: ArrayLike) -> Floats:
        (x, y), (to_x, to_y) = self.start, self.end
        return np.full(np.shape(s), math.atan2(to_y - y, to_x - x))

    def half_thickness(self, height: Floats) -> Floats:
        """Return half the transverse tooth thickness (mm) at heights (mm)."""
        (x, y), (to_x, to_y) = self.start, self.end
        along: Floats = -(x + (to_x - x) * (height - y) / (to_y - y))
        return along


@dataclass(frozen=True)
class FilletArc:
    """The fillet: a circle about (`x`, `y`) in the normal section (mm), between angles from its lowest point (rad).

    `stretch` is 1/cos beta, by which the transverse section is wider.
    """

    x: float
    y: float
    radius: float
    last: float
    stretch: float
    kind: RackCurveKind = RackCurveKind.FILLET
    first: float = 0.0

    def points(self, s: ArrayLike) -> Floats:
        theta = self._theta(s)
        return np.stack([(self.x + self.radius * np.sin(theta)) * self.stretch, self.y - self.radius * np.cos(theta)], -1)

    def direction(self, s: ArrayLike) -> Floats:
        theta = self._theta(s)
        return np.arctan2(np.sin(theta), np.cos(theta) * self.stretch)

    def half_thickness(self, height: Floats) -> Floats:
        """Return half the transverse tooth thickness (mm) at heights (mm)."""
        below = np.clip(self.y - height, -self.radius, self.radius)
        along: Floats = -(self.x + np.sqrt((self.radius - below) * (self.radius + below))) * self.stretch
        return along

    def _theta(self, s: ArrayLike) -> Floats:
        return self.first + np.asarray(s, float) * (self.last - self.first)


class RackRoot(NamedTuple):
    """Pieces of a root, root land first, and the depth (mm) below the reference line at which the flank begins.

    `corner`: it begins at a corner. `wheel` says whether the last piece is what the finishing wheel leaves.
    """

    pieces: tuple[FilletArc | Straight, ...]
    form_depth: float
    corner: bool
    wheel: bool = False

    def half_thickness(self, height: Floats) -> Floats:
        """Return half the transverse tooth thickness (mm) at heights (mm) below the flank."""
        half = np.full(np.shape(height), np.nan)
        for piece in reversed(self.pieces):
            below = height <= float(piece.points(1.0)[1])
            half = np.where(below | np.isnan(half), piece.half_thickness(height), half)
        return half


class RackRamp(NamedTuple):
    """Ramp of a semi-topping tool: the height (mm) at which it leaves the finished flank, its slope (normal section)."""

    start: float
    slope: float


@dataclass(frozen=True, kw_only=True)
class RackTools:
    """Pre-cutting tool of a rack, in the normal section: half the finished tooth's thickness, `depth` and tip radius (mm).

    `angle` of the flanks, `steep` of the flank of the protuberance (rad), `stock` and `protuberance` (mm) normal to the flank.
    """

    half_thickness: float
    half_pitch: float
    angle: float
    depth: float
    radius: float
    stock: float
    protuberance: float
    steep: float | None
    stretch: float

    def flank(self, height: float, outside: float = 0.0) -> float:
        """Return half the tooth (mm) at a height (mm) between flanks that stand `outside` the finished ones (mm, normal)."""
        return self.half_thickness + outside / math.cos(self.angle) - height * math.tan(self.angle)

    @property
    def centre(self) -> float:
        """Distance (mm) of the middle of the tip arc from the middle of the tooth."""
        return self.flank(self.radius - self.depth, self.stock - self.protuberance + self.radius)

    def ramp(self, angle: float, height: float) -> RackRamp:
        """Return the ramp of an angle (rad) that begins on the tool's flank at a height (mm) over the reference line."""
        slope, steeper = math.tan(angle), math.tan(angle) - math.tan(self.angle)
        return RackRamp(height + self.stock / math.cos(self.angle) / steeper if steeper > 0 else math.inf, slope)

    def below(self, outside: float) -> RackRoot:
        """Return the root up to flanks that stand `outside` the finished ones (mm): 0, or the stock.

        With the distance b of the tip arc beyond that flank they meet at theta = pi/2 - alpha + arccos(1 - b/rho), or later on
        the flank of the protuberance.
        """
        beyond, tangent = self.protuberance - self.stock + outside, math.pi / 2 - self.angle
        u, v, rho = self.centre, self.radius - self.depth, self.radius
        if beyond <= ROUNDING:
            form = self.depth - rho * (1 - math.sin(self.angle))
            return RackRoot((self._arc(tangent),) if rho else (), form, corner=False)
        assert self.steep is not None
        last, slope = math.pi / 2 - self.steep, math.tan(self.steep)
        meets = tangent + 2 * math.asin(math.sqrt(beyond / rho / 2)) if beyond < 2 * rho else math.inf
        if meets <= last:
            return RackRoot((self._arc(meets),), rho * math.cos(meets) - v, corner=True)
        start = (u - rho * math.sin(last), v - rho * math.cos(last))
        height = (self.flank(0.0, outside) - start[0] - start[1] * slope) / (math.tan(self.angle) - slope)
        end = (self.flank(height, outside), height)
        straight = self._straight(start, end)
        return RackRoot((self._arc(last), straight) if rho else (straight,), -height, corner=True)

    def finished(self, end_depth: float | None, wheel_radius: float) -> RackRoot:
        """Return the root under the finished flank, which a wheel with a tip radius (mm) ends at a depth (mm); None runs free.

        Raises GeometryError for stock that the wheel must end in, and for a wheel that reaches the root.
        """
        left = self.protuberance - self.stock
        if end_depth is None:
            if left < -ROUNDING:
                permitted = (
                    f"must be given: the tool leaves {-left:.6g} mm of stock at the root, and the wheel must end above it"
                )
                raise GeometryError("finishing.end_depth", None, permitted, "mm")
            return self.below(0.0)
        cut, wheel = self.below(self.stock), self._wheel(-end_depth, wheel_radius)
        standing = self._standing(cut, -end_depth)
        if standing <= self.flank(-end_depth) + ROUNDING and left >= -ROUNDING:
            if min(self._gaps(cut, wheel)) < -ROUNDING:
                raise self._reaching(end_depth)
            return self.below(0.0)
        inside = [gap < 0 for gap in self._gaps(cut, wheel)]
        if inside[0] and wheel_radius * (1 - math.sin(self.angle)) <= -left:
            least = -left / (1 - math.sin(self.angle))
            permitted = f"must be above {at_least(least)} mm: the rounding of the wheel ends in the stock that is left"
            raise GeometryError("finishing.wheel_tip_radius", wheel_radius, permitted, "mm")
        if not any(inside) or inside[0] or inside.count(True) != len(inside) - inside.index(True):
            raise self._reaching(end_depth)

        def excess(theta: float) -> float:
            return self._gap(cut, wheel, theta)

        step = wheel.last / (_PLACES - 1)
        low = (inside.index(True) - 1) * step
        first = root_between(excess, low, low + step, xtol=1e-15, rtol=8.9e-16)
        height = wheel.y - wheel.radius * math.cos(first)
        pieces = (*self._up_to(cut, height), replace(wheel, first=first))
        return RackRoot(pieces, end_depth, corner=False, wheel=True)

    # ------------------------------------------------------------------ pieces

    def _arc(self, last: float) -> FilletArc:
        return FilletArc(-self.centre, self.radius - self.depth, self.radius, last, self.stretch)

    def _straight(
        self, start: tuple[float, float], end: tuple[float, float], kind: RackCurveKind = RackCurveKind.FILLET
    ) -> Straight:
        (u, v), (to_u, to_v) = start, end
        return Straight(kind, (-u * self.stretch, v), (-to_u * self.stretch, to_v))

    def _wheel(self, height: float, radius: float) -> FilletArc:
        """Return the rounding of a wheel's tip, which touches the finished flank at a height (mm)."""
        u = self.flank(height) + radius * math.cos(self.angle)
        if u > self.half_pitch:
            room = self.half_pitch - self.flank(height)
            most = room / math.cos(self.angle)
            permitted = f"must be at most {at_most(max(most, 0.0))} mm, the full radius between the flanks there"
            raise GeometryError("finishing.wheel_tip_radius", radius, permitted, "mm")
        y = height + radius * math.sin(self.angle)
        return FilletArc(-u, y, radius, math.pi / 2 - self.angle, self.stretch)

    def _standing(self, cut: RackRoot, height: float) -> float:
        """Return half the pre-cut tooth (mm, normal section) at a height (mm); infinite below its root."""
        if height < -self.depth:
            return math.inf
        if height >= -cut.form_depth:
            return self.flank(height, self.stock)
        return float(cut.half_thickness(np.asarray(height))) / self.stretch

    def _gap(self, cut: RackRoot, wheel: FilletArc, theta: float) -> float:
        """Return by how much (mm) the wheel's rounding stays off the pre-cut tooth at an angle (rad)."""
        height = wheel.y - wheel.radius * math.cos(theta)
        return -(wheel.x + wheel.radius * math.sin(theta)) - self._standing(cut, height)

    def _gaps(self, cut: RackRoot, wheel: FilletArc) -> list[float]:
        return [self._gap(cut, wheel, theta) for theta in np.linspace(0.0, wheel.last, _PLACES).tolist()]

    def _up_to(self, cut: RackRoot, height: float) -> tuple[FilletArc | Straight, ...]:
        """Return the pieces of the pre-cut tooth from its root to a height (mm)."""
        found: list[FilletArc | Straight] = []
        for piece in cut.pieces:
            if float(piece.points(1.0)[1]) >= height:
                if isinstance(piece, FilletArc):
                    cosine = (piece.y - height) / piece.radius
                    return (*found, replace(piece, last=math.acos(min(max(cosine, -1.0), 1.0))))
                return (*found, replace(piece, end=(-float(piece.half_thickness(np.asarray(height))), height)))
            found.append(piece)
        start = (self.flank(-cut.form_depth, self.stock), -cut.form_depth)
        return (*found, self._straight(start, (self.flank(height, self.stock), height)))

    @staticmethod
    def _reaching(end_depth: float) -> GeometryError:
        permitted = "must be nearer to the tip: the rounding of the wheel reaches into the root that is cut before"
        return GeometryError("finishing.end_depth", end_depth, permitted, "mm")


_PLACES = 65
"""Places along the rounding of a wheel that are compared with the pre-cut tooth."""


def check_rack_tools(tools: RackTools, module: float) -> None:
    """Raise GeometryError unless the tool that cuts before finishing can exist."""
    angle, space = tools.angle, tools.half_pitch - tools.half_thickness
    most = space * math.cos(angle)
    if tools.stock >= most:
        permitted = f"must be below {at_most(most)} mm: no space is left between the teeth that are cut before"
        raise GeometryError("premachining.stock", tools.stock, permitted, "mm")
    if tools.steep is not None and not _LEAST_STEEP <= tools.steep < angle:
        permitted = f"must be at least 1 and below {math.degrees(angle):.6g} deg, the pressure angle, on a rack"
        raise GeometryError("premachining.protuberance_angle", math.degrees(tools.steep), permitted, "deg")
    over = tools.centre - tools.half_pitch
    if over <= 0:
        return
    most = tools.radius - over * math.cos(angle) / (1 - math.sin(angle))
    if most > 0:
        permitted = f"must be at most {at_most(most / module, 4)} (full radius) for this addendum, protuberance and stock"
        raise GeometryError("premachining.tool_tip_radius", tools.radius / module, permitted)
    sharp = over - tools.radius * (1 - math.sin(angle)) / math.cos(angle)
    most = (tools.depth - sharp / math.tan(angle)) / module
    permitted = f"must be at most {at_most(most, 4)}, where the flanks of the tool meet"
    raise GeometryError("premachining.tool_addendum", tools.depth / module, permitted)


_LEAST_STEEP = math.radians(1.0) * (1 - 1e-12)
"""Least angle (rad) of the flank of a protuberance on a rack, whose walls are not upright."""


def check_rack_ramp(ramp: RackRamp, angle: float, form_depth: float, tip: float, height: float) -> None:
    """Raise GeometryError unless a ramp begins between the root form line and the tip (mm); `height` is as it was given."""
    if ramp.slope <= math.tan(angle):
        permitted = f"must be above {math.degrees(angle):.6g} deg, the pressure angle"
        raise GeometryError("premachining.semi_topping.angle", math.degrees(math.atan(ramp.slope)), permitted, "deg")
    after = height - ramp.start
    if not -form_depth < ramp.start < tip:
        least, most = at_least(max(after - form_depth, 0.0)), at_most(tip + after)
        permitted = f"must be above {least} and below {most} mm: the ramp leaves some flank, and reaches the finished tips"
        raise GeometryError("premachining.semi_topping.height", height, permitted, "mm")
