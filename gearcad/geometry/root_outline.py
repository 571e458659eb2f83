"""Outline of a root that a tool cuts before the flank is finished: with protuberance, stock, and a wheel that ends above it.

The space between two teeth is the union of what each tool cuts. From the root circle the outline is the trochoid of the
pre-cutting tool's tip, perhaps the involute of its protuberance's flank, perhaps what the tip of the finishing wheel leaves,
and then the finished involute. Lengths in mm, angles in radians, radii are magnitudes; those of a ring fall from root to tip.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from gearcad.core.records import Floats
from gearcad.geometry.curves import CurveKind, Fillet, FilletChain, FlankTrace, Involute, RootCurve, WheelArc
from gearcad.geometry.cutter_flank import CutterFlank
from gearcad.geometry.fillets import FilletTool, ShaperTip, ToolTip
from gearcad.geometry.involute import involute_at_roll, root_between

ROUNDING = 1e-9
"""Length (mm) of a difference of stock and protuberance that counts as none."""

_SAMPLES = 65
"""Places at which curves are compared before a crossing is found."""


class FlankInvolute(NamedTuple):
    """Involute of a flank: base radius (mm) and half tooth angle there (rad); on an `internal` tooth that grows outwards."""

    base_radius: float
    base_half_angle: float
    internal: bool = False

    def half_angle(self, radius: Floats | float) -> Floats:
        """Return half tooth angle (rad) at radii (mm); inside the base circle that of the base circle."""
        clipped = np.maximum(np.asarray(radius, float), self.base_radius)
        turned = involute_at_roll(np.sqrt((clipped - self.base_radius) * (clipped + self.base_radius)) / self.base_radius)
        angle: Floats = self.base_half_angle + turned if self.internal else self.base_half_angle - turned
        return angle

    def roll(self, radius: float) -> float:
        """Return the roll angle (rad) at a radius (mm)."""
        return math.sqrt(max((radius - self.base_radius) * (radius + self.base_radius), 0.0)) / self.base_radius

    def piece(self, first: float, last: float) -> Involute:
        """Return the curve between two radii (mm), as a part of the fillet."""
        rolls = self.roll(first), self.roll(last)
        return Involute(self.base_radius, self.base_half_angle, *rolls, internal=self.internal, kind=CurveKind.FILLET)


class RootOutline(NamedTuple):
    """Pieces of a root, root circle first, the radius (mm) at which the flank begins, and whether it begins at a corner.

    `wheel` says whether the last piece is what the finishing wheel leaves, so that the flank above it is finished.
    """

    pieces: tuple[RootCurve, ...]
    form_radius: float
    corner: bool
    wheel: bool = False

    @property
    def curve(self) -> Fillet | FilletChain | RootCurve:
        """All pieces as one curve."""
        return self.pieces[0] if len(self.pieces) == 1 else FilletChain(self.pieces)


class OutlineFault(Exception):
    """A root that the tools cannot leave; `what` is wrong with which input."""

    def __init__(self, what: str) -> None:
        super().__init__(what)
        self.what = what


@dataclass(frozen=True)
class RootTools:
    """A pre-cutting tool in the space of one gear: `tool`, half the pitch (rad), and whether the gear is a ring.

    `straight` is the straight flank of a cutter's protuberance.
    """

    tool: FilletTool
    half_pitch: float
    internal: bool
    straight: CutterFlank | None = None

    @property
    def _side(self) -> float:
        return -1.0 if self.internal else 1.0

    def _half_angle(self, theta: float) -> tuple[float, float]:
        radius, angle = self.tool.cut(theta)
        return float(radius), self.half_pitch - float(angle)

    # ------------------------------------------------------------------ up to a flank that runs down to the root

    def root_below(self, flank: FlankInvolute, bulge: float) -> RootOutline:
        """Return the root up to a flank from which the tip of the tool stands out by `bulge` (mm, normal section, at least 0).

        Raises OutlineFault where the tip arc ends before it meets the flank, and nothing known goes on from there.
        """
        if self.straight is not None:
            return self._shaped(flank, bulge)
        if bulge <= ROUNDING:
            return self._plain(flank)
        crossing = self._crossing(flank)
        steep = self._protuberance_flank()
        if steep is None:
            if crossing is None:
                raise OutlineFault("protuberance_angle")
            return self._crossed(crossing)
        start = self._start_of(steep)
        if crossing is not None and self._side * self._half_angle(crossing)[0] <= self._side * start.radius:
            return self._crossed(crossing)
        end = self._meeting(steep.flank, flank, start.radius, steep.last)
        pieces = (Fillet(self.tool, start.theta, self.half_pitch), steep.flank.piece(start.radius, end))
        return RootOutline(pieces, end, corner=True)

    def _plain(self, flank: FlankInvolute) -> RootOutline:
        """Return the root of a tool whose tip arc touches the flank, or undercuts it."""
        tool = self.tool
        if tool.undercuts(flank.base_radius, self._sine) and (theta := self._crossing(flank, self._tangent)) is not None:
            return self._crossed(theta)
        radius = tool.form_radius(flank.base_radius, self._sine)
        return RootOutline((Fillet(tool, self._tangent, self.half_pitch),), radius, corner=False)

    def _crossed(self, theta: float) -> RootOutline:
        return RootOutline((Fillet(self.tool, theta, self.half_pitch),), self._half_angle(theta)[0], corner=True)

    @property
    def _tangent(self) -> float:
        assert isinstance(self.tool, ToolTip | ShaperTip)
        return self.tool.tangent_angle

    @property
    def _sine(self) -> float:
        return self.tool.sine if isinstance(self.tool, ToolTip) else 0.0

    def _crossing(self, flank: FlankInvolute, last: float | None = None) -> float | None:
        """Return theta at which the trochoid leaves the flank towards the tip; None where it does not by the end of the arc."""
        end = self.tool.last_angle if last is None else last

        def excess(theta: float) -> float:
            radius, half = self._half_angle(theta)
            return half - float(flank.half_angle(radius))

        start = 0.0
        if not self.internal and self._half_angle(0.0)[0] < flank.base_radius:
            start = float(self.tool.theta_at(flank.base_radius, end)[0])
        if excess(end) <= 0:
            return None
        places = np.linspace(start, end, _SAMPLES)
        deeper = [theta for theta in (*places.tolist(), min(self._tangent, end)) if excess(theta) < 0]
        if not deeper:  # the curves meet by less than rounding
            return start if last is not None else min(self._tangent, end)
        return root_between(excess, max(deeper), end, xtol=1e-15, rtol=8.9e-16)

    # ------------------------------------------------------------------ the flank of a protuberance

    def _protuberance_flank(self) -> _SteepFlank | None:
        cut = self.tool.protuberance_flank(self.half_pitch) if isinstance(self.tool, ToolTip) else None
        if cut is None:
            return None
        flank = FlankInvolute(cut.base_radius, cut.base_half_angle)
        first = cut.base_radius * math.hypot(1.0, cut.first) if cut.first > 0 else None
        return _SteepFlank(flank, first, cut.base_radius * math.hypot(1.0, cut.last))

    def _start_of(self, steep: _SteepFlank) -> _Start:
        """Return where the flank of the protuberance takes over from the tip arc."""
        end = self.tool.last_angle
        if steep.first is not None:
            return _Start(end, steep.first)
        theta = self._crossing(steep.flank, end)
        theta = end if theta is None else theta
        return _Start(theta, self._half_angle(theta)[0])

    @staticmethod
    def _meeting(steep: FlankInvolute, flank: FlankInvolute, first: float, last: float) -> float:
        """Return the radius (mm) between two others at which the flank of the protuberance meets a flank."""

        def excess(radius: float) -> float:
            return float(steep.half_angle(radius) - flank.half_angle(radius))

        if excess(first) >= 0:
            return first
        if excess(last) <= 0:
            return last
        return root_between(excess, first, last, xtol=1e-15, rtol=8.9e-16)

    def _shaped(self, flank: FlankInvolute, bulge: float) -> RootOutline:
        """Return the root that a cutter with a protuberance leaves, whose straight flank may cut further up than its corner."""
        straight = self.straight
        assert straight is not None
        trace = FlankTrace(straight, straight.last, self.half_pitch, first=min(straight.first, straight.last))
        radii, halves = trace.polar(np.linspace(0.0, 1.0, _SAMPLES))
        deeper = np.flatnonzero((halves - flank.half_angle(radii)) * radii < -ROUNDING)
        if not len(deeper):
            if bulge <= ROUNDING:
                return self._plain(flank)
            if (crossing := self._crossing(flank)) is None:
                raise OutlineFault("protuberance")
            return self._crossed(crossing)
        last = int(deeper[-1])
        rising = self._side * np.diff(radii[: last + 2]) > 0
        if straight.first > 0:
            raise OutlineFault("protuberance")
        if last == _SAMPLES - 1 or not bool(np.all(rising)):
            raise OutlineFault("protuberance_angle")

        def excess(s: float) -> float:
            radius, half = trace.polar(s)
            return float(half - flank.half_angle(radius))

        low, s = last / (_SAMPLES - 1), (last + 1) / (_SAMPLES - 1)
        if excess(s) > 0:  # else they meet there by less than rounding
            s = root_between(excess, low, s, xtol=1e-15, rtol=8.9e-16)
        radius = float(trace.polar(s)[0])
        if not self.internal and radius < flank.base_radius:
            raise OutlineFault("protuberance_angle")
        end = replace(trace, last=s * straight.last)
        return RootOutline((Fillet(self.tool, self.tool.last_angle, self.half_pitch), end), radius, corner=True)

    # ------------------------------------------------------------------ a wheel that ends above the root

    def finished(
        self, before: FlankInvolute, after: FlankInvolute, bulges: tuple[float, float], wheel: Wheel | None
    ) -> RootOutline:
        """Return the root up to the finished flank `after`, where `before` was the flank that the tool cut.

        `bulges` (mm): how far the tip of the tool stands out of the finished flank, and of its own. The `wheel` ends on a
        circle; without one it runs free. Raises OutlineFault for stock that a wheel must end in, and for a wheel that reaches
        the root.
        """
        if wheel is None:
            if bulges[0] < -ROUNDING:
                raise OutlineFault("end_diameter")
            return self.root_below(after, bulges[0])
        cut, end = self.root_below(before, bulges[1]), wheel.end_radius
        trace = wheel.trace(after, self.half_pitch)
        if self._standing(cut, before, end) <= float(after.half_angle(end)) and bulges[0] >= -ROUNDING:
            if min(self._above(cut, before, trace)) < -ROUNDING / end:
                raise OutlineFault("reaches")
            return self.root_below(after, bulges[0])
        return self._stepped(cut, before, trace, end)

    def _standing(self, cut: RootOutline, before: FlankInvolute, radius: float) -> float:
        """Return the half angle (rad) of the pre-cut tooth at a radius (mm); infinite inside its root circle."""
        root = self._half_angle(0.0)[0]
        if self._side * radius < self._side * root:
            return math.inf
        if self._side * radius <= self._side * cut.form_radius:
            curve = cut.curve
            return float(curve.half_angle(np.array([radius]))[0])
        return float(before.half_angle(radius))

    def _above(self, cut: RootOutline, before: FlankInvolute, trace: RootCurve) -> list[float]:
        """Return by how much (rad) the wheel's tip stays off the pre-cut tooth, along it."""
        radii, halves = trace.polar(np.linspace(0.0, 1.0, _SAMPLES))
        pairs = zip(radii.tolist(), halves.tolist(), strict=True)
        return [half - self._standing(cut, before, radius) for radius, half in pairs]

    def _stepped(self, cut: RootOutline, before: FlankInvolute, trace: RootCurve, end: float) -> RootOutline:
        """Return the root with the step that a wheel leaves which ends at a radius (mm)."""
        off = self._above(cut, before, trace)
        inside = [gap < 0 for gap in off]
        if not any(inside) or inside[0] or inside.count(True) != len(inside) - inside.index(True):
            raise OutlineFault("reaches")

        def excess(s: float) -> float:
            radius, half = trace.polar(s)
            return float(half) - self._standing(cut, before, float(radius))

        low = (inside.index(True) - 1) / (_SAMPLES - 1)
        s = root_between(excess, low, low + 1 / (_SAMPLES - 1), xtol=1e-15, rtol=8.9e-16)
        meets = float(trace.polar(s)[0])
        if abs(meets - self._half_angle(0.0)[0]) < ROUNDING * meets:  # the wheel is as deep as the root
            raise OutlineFault("reaches")
        return RootOutline((*self._below(cut, before, meets), _from(trace, s)), end, corner=False, wheel=True)

    def _below(self, cut: RootOutline, before: FlankInvolute, radius: float) -> tuple[RootCurve, ...]:
        """Return the pieces of the pre-cut tooth from the root circle to a radius (mm)."""
        found: list[RootCurve] = []
        for piece in cut.pieces:
            if self._side * float(piece.polar(1.0)[0]) >= self._side * radius:
                return (*found, self._ended(piece, radius))
            found.append(piece)
        return (*found, before.piece(cut.form_radius, radius))

    def _ended(self, piece: RootCurve, radius: float) -> RootCurve:
        if isinstance(piece, Fillet):
            return replace(piece, last=float(self.tool.theta_at(radius, piece.last)[0]))
        if isinstance(piece, FlankTrace):
            return replace(piece, last=float(piece.flank.way_at(radius, piece.first, piece.last)[0]))
        assert isinstance(piece, Involute)
        return replace(piece, last=math.sqrt((radius - piece.base_radius) * (radius + piece.base_radius)) / piece.base_radius)


class _SteepFlank(NamedTuple):
    """Involute of a protuberance's flank, and the radii (mm) of its ends; the first is None where the tip arc cuts it off."""

    flank: FlankInvolute
    first: float | None
    last: float


class _Start(NamedTuple):
    """theta of the tip arc, and radius (mm), at which the flank of a protuberance takes over."""

    theta: float
    radius: float


def _from(trace: RootCurve, s: float) -> RootCurve:
    """Return the part of a wheel's trace from a parameter on."""
    if isinstance(trace, Fillet):
        return replace(trace, first=float(trace.theta(s)))
    assert isinstance(trace, WheelArc)
    return replace(trace, first=trace.first + s * (trace.last - trace.first))


@dataclass(frozen=True)
class Wheel:
    """Finishing wheel: radius (mm) of the circle at which its flank ends, and `tip_radius` (mm) of its rounded tip.

    `rolling` is the rack whose tip generates the step (its tip radius is that of the wheel); None for a form wheel, whose tip
    is an arc in the transverse section, as is assumed.
    """

    end_radius: float
    tip_radius: float
    rolling: ToolTip | None = None

    def trace(self, flank: FlankInvolute, half_pitch: float) -> RootCurve:
        """Return what the whole rounding of the wheel's tip cuts, its deepest point first, up to the flank."""
        if self.rolling is not None:
            return Fillet(self.rolling, self.rolling.tangent_angle, half_pitch)
        roll, half = flank.roll(self.end_radius), float(flank.half_angle(self.end_radius))
        heading = flank.base_half_angle + roll - math.pi if flank.internal else flank.base_half_angle - roll
        across = heading + math.pi / 2  # out of the tooth, into the space
        x = self.end_radius * math.cos(half) + self.tip_radius * math.cos(across)
        y = self.end_radius * math.sin(half) + self.tip_radius * math.sin(across)
        deepest = math.atan2(y, x) + (0.0 if flank.internal else math.pi)
        last = across + math.pi
        first = last + math.remainder(deepest - last, 2 * math.pi)
        return WheelArc(x, y, self.tip_radius, first, last)
