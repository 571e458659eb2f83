"""Where the parts of a train are drawn: how high, how far along the axis, and on which side its members come out.

In inches of paper; x runs along the axis, y away from it. Radii are to scale where that leaves room to see every part;
widths are not.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

from gearcad.geometry import GearPair
from gearcad.planetary import PlanetaryTrain, Rim
from gearcad.plots.planetary.parts import placed_stages, role_of

__all__ = ["CLEAR", "Places"]

_SET_HEIGHT, _HEIGHT = 2.4, 3.4
"""Of the set, and of it with the stages, where radii are to scale."""

CLEAR = 0.3
"""Least distance of a pitch point from the axis and from a pin."""

_APART = 0.1
"""Least distance between radii that differ."""

_WIDEST, _NARROWEST = 0.6, 0.24
"""Drawn widths of teeth."""

_BETWEEN = (0.3, 0.6)
"""Least and greatest distance of the rims of a stepped planet."""


class Places:
    """Places of the parts of a train."""

    def __init__(self, train: PlanetaryTrain) -> None:
        self.train = train
        self.radii = {(rim.name, sign): self._radius(rim, sign) for rim in train.rims for sign in (1, -1)}
        """Of the working circles of rims (mm), on the outer side of the train (1) and on the inner one."""

    def _radius(self, rim: Rim, sign: int) -> float:
        """In the mesh on that side, or in the one that there is: where two are, they may differ."""
        meshes = [mesh for mesh in self.train.meshes if mesh.rim is rim]
        mesh = next((mesh for mesh in meshes if mesh.central.gear.internal == (sign > 0)), meshes[0])
        return abs(mesh.pair.working_pitch_diameters.pick(mesh.rim_role)) / 2

    @cached_property
    def scale(self) -> float:
        """Inches per mm of radius."""
        reach = self._distance + max(self.radii.values())
        stages = [abs(stage.pair.centre_distance) + _smaller_radius(stage.pair) for stage in self.train.stages]
        return min(_SET_HEIGHT / reach, _HEIGHT / max([reach, *stages]))

    @cached_property
    def _heights(self) -> dict[float, float]:
        """Drawn heights of axis, pin and pitch points by their distance from the axis (mm)."""
        knots = sorted({0.0, self._distance, *(self._distance_of(*each) for each in self.radii)})
        heights = [0.0]
        for low, high in pairwise(knots):
            least = CLEAR if {low, high} & {0.0, self._distance} else _APART
            heights.append(heights[-1] + max(self.scale * (high - low), least))
        axis = heights[knots.index(0.0)]
        return {knot: height - axis for knot, height in zip(knots, heights, strict=True)}

    @property
    def pin(self) -> float:
        """Height of the pin."""
        return self._heights[self._distance]

    def pitch(self, rim: str, sign: int) -> float:
        """Height of the working circle of a rim on its outer (1) or inner side."""
        return self._heights[self._distance_of(rim, sign)]

    def _distance_of(self, rim: str, sign: int) -> float:
        return round(self._distance + sign * self.radii[rim, sign], 9)

    @property
    def _distance(self) -> float:
        return float(self.train.centre_distance)

    # ------------------------------------------------------------------ along the axis

    @cached_property
    def rims(self) -> dict[str, tuple[float, float]]:
        """From where to where along the axis rims are drawn, from left to right."""
        rims = sorted(self.train.rims, key=lambda rim: rim.axial_position + rim.gear.face_width / 2)
        first, start, found = rims[0], 0.0, {}
        for rim in rims:
            if rim is not first:
                gap = rim.axial_position - first.axial_position - first.gear.face_width
                start += min(max(_WIDEST * gap / self._widest, _BETWEEN[0]), _BETWEEN[1])
            found[rim.name] = (start, start := start + self._width(rim.gear.face_width))
        return found

    @cached_property
    def centrals(self) -> dict[str, tuple[float, float]]:
        """The same of centrals: middle by middle with their rims, or half by half where both would be in one place."""
        bars = {}
        for central, half in zip(self.train.centrals, (0.25, 0.75), strict=True):
            left, right = self.rims[central.meshes]
            middle = left + (half if self._halved else 0.5) * (right - left)
            width = 0.4 * (right - left) if self._halved else self._width(central.gear.face_width)
            bars[central.name] = (middle - width / 2, middle + width / 2)
        return bars

    @property
    def _halved(self) -> bool:
        first, second = self.train.centrals
        return not self.train.stepped and first.gear.internal == second.gear.internal

    @cached_property
    def _widest(self) -> float:
        return max(gear.face_width for part in (self.train.centrals, self.train.rims) for gear in (each.gear for each in part))

    def _width(self, width: float) -> float:
        return min(max(_WIDEST * width / self._widest, _NARROWEST), _WIDEST)

    # ------------------------------------------------------------------ who comes out where

    def held_ring(self, name: str) -> bool:
        """Whether a member is a ring that does not turn: it stands on the ground and needs no shaft."""
        return name == self.train.fixed and any(each.name == name and each.gear.internal for each in self.train.centrals)

    @cached_property
    def sides(self) -> dict[str, int]:
        """On which side members come out (-1: left): inputs left where that can be, centrals of two planes on their own."""
        roles, wanted, found = self._roles(), {"input": -1, "output": 1}, {}
        first, second = (sum(bar) for bar in self.centrals.values())
        for central, own in zip(self.train.centrals, (first - second, second - first), strict=True):
            free = wanted.get(roles[central.name], 1 if central.gear.internal else -1)
            found[central.name] = free if abs(own) < 1e-9 else -1 if own < 0 else 1
        taken = {side for name, side in found.items() if not self.held_ring(name)}
        side = wanted.get(roles[self.train.carrier.name], -1)
        return found | {self.train.carrier.name: -side if side in taken and -side not in taken else side}

    def _roles(self) -> dict[str, str]:
        """What members are to the train, by themselves or by the stages on them."""
        roles = {name: role_of(self.train, name) for name in self.train.members}
        for _, inner, outer in reversed(placed_stages(self.train)):
            roles[inner] = roles.get(inner) or role_of(self.train, inner) or roles.get(outer) or role_of(self.train, outer)
        return roles


def _smaller_radius(pair: GearPair) -> float:
    return min(abs(gear.reference_diameter) for gear in pair.gears) / 2
