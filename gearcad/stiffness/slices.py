"""From one pair of teeth to the mesh: all pairs in contact side by side, helical ones as thin slices.

Slices are springs between the two gears that know nothing of each other. A slice at height y of a helical pair touches at
s + y tan beta_b on the line of action, so over the width of a line the single stiffness k(s) is integrated, exactly.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gearcad.arrays import Floats
from gearcad.geometry import GearPair

__all__ = ["MeshCurves", "SinglePair", "Slices"]


_NODES = 129
"""Places on the path of contact between which the single pair's compliances are cubic splines: right to 1e-8."""


@dataclass(frozen=True)
class SinglePair:
    """Compliances of one pair of teeth per face width, in mm·µm/N, at places (n,) from T1 on the line of action (mm).

    `parts` sum up to the secant compliance; the tangent compliance is `tangent_less` smaller.
    """

    lengths: Floats
    parts: Mapping[str, Floats]
    tangent_less: float = 0.0

    @property
    def stiffness(self) -> Floats:
        """k (n,) in N/(mm·µm)."""
        result: Floats = 1 / np.sum(list(self.parts.values()), axis=0)
        return result

    @property
    def tangent_stiffness(self) -> Floats:
        """dF/ddelta (n,) in N/(mm·µm)."""
        result: Floats = 1 / (1 / self.stiffness - self.tangent_less)
        return result


class MeshCurves(NamedTuple):
    """What MeshCycle wants of all pairs together, under its names there."""

    roll_angle: Floats
    mesh_stiffness: Floats
    tangent_stiffness: Floats
    pairs: tuple[int, ...]
    load_share: Floats
    compliance_parts: dict[str, Floats]
    single_stiffness: float


@dataclass(frozen=True)
class Slices:
    """The zone of contact of a pair: usable path times common width."""

    pair: GearPair

    @cached_property
    def path(self) -> tuple[float, float]:
        """First and last contact (mm from T1) on involutes of both gears."""
        return self.pair.usable_path

    @property
    def pitch(self) -> float:
        """Transverse base pitch (mm)."""
        return self.pair.pinion.transverse_base_pitch

    @property
    def width(self) -> float:
        """Common face width (mm)."""
        return self.pair.common_width.width

    @property
    def reach(self) -> float:
        """How far a line of contact leans along the line of action over the common width (mm)."""
        return self.width * math.tan(math.radians(abs(self.pair.pinion.base_helix_angle)))

    @cached_property
    def lengths(self) -> Floats:
        """Places (n,) on the path where a single pair is wanted (mm from T1)."""
        return np.linspace(*self.path, _NODES)

    def curves(self, single: SinglePair, count: int) -> MeshCurves:
        """The mesh over one base pitch, in about `count` positions."""
        places, active = self._positions(count)
        first, last = self.path[0] - self.reach / 2, self.path[1] + self.reach / 2
        pairs = range(math.ceil((first - places[-1]) / self.pitch), math.floor((last - places[0]) / self.pitch) + 1)
        # Which pairs touch is that of the middle of each piece: at its ends a spur pair would be in doubt.
        at = np.stack(
            [np.where(self._inside(active + pair * self.pitch), places + pair * self.pitch, np.nan) for pair in pairs]
        )
        stiffness = self._over_width(single.stiffness, at)
        total = stiffness.sum(0)
        squared = single.stiffness**2
        parts = {name: self._over_width(squared * part, at).sum(0) / total**2 for name, part in single.parts.items()}
        used = stiffness.max(1) > 0
        roll = np.degrees((places - self.pair.path_of_contact.C) / (self.pair.pinion.base_diameter / 2))
        alone = self._over_width(single.stiffness, np.linspace(first, last, 4 * _NODES)[None])
        return MeshCurves(
            roll_angle=roll,
            mesh_stiffness=total,
            tangent_stiffness=self._over_width(single.tangent_stiffness, at).sum(0),
            pairs=tuple(pair for pair, touches in zip(pairs, used, strict=True) if touches),
            load_share=(stiffness / total)[used].T,
            compliance_parts=parts,
            single_stiffness=float(alone.max()),
        )

    def _inside(self, places: Floats) -> NDArray[np.bool_]:
        first, last = self.path
        found: NDArray[np.bool_] = (places > first - self.reach / 2) & (places < last + self.reach / 2)
        return found

    def _positions(self, count: int) -> tuple[Floats, Floats]:
        """Places (n,) of the middle pair over a base pitch, each piece between jumps or bends with both its ends; middles."""
        centre, pitch = self.pair.path_of_contact.C, self.pitch
        start = centre - pitch / 2
        corners = [end + lean * self.reach / 2 for end in self.path for lean in (-1, 1)]
        inner = {round(float(np.mod(corner - start, pitch)), 12) for corner in corners}
        edges = np.array(sorted({0.0, pitch} | {place for place in inner if 1e-9 * pitch < place < (1 - 1e-9) * pitch}))
        places, middles = [], []
        for low, high in pairwise(edges.tolist()):
            # Odd numbers, for Simpson's rule.
            number = 2 * max(2, round(count * (high - low) / pitch / 2)) + 1
            places.append(start + np.linspace(low, high, number))
            middles.append(np.full(number, start + (low + high) / 2))
        return np.concatenate(places), np.concatenate(middles)

    def _over_width(self, values: Floats, at: Floats) -> Floats:
        """The integral over the width of what has `values` at `lengths`, for lines with their middle `at` (nan: none)."""
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(self.lengths, values)
        first, last = self.path
        touching = np.isfinite(at)
        place = np.where(touching, at, first)
        if self.reach == 0:
            found = spline(np.clip(place, first, last)) * self.width
        else:
            ends = (np.clip(place + side * self.reach / 2, first, last) for side in (1, -1))
            upper, lower = map(spline.antiderivative(), ends)
            found = (upper - lower) * self.width / self.reach
        result: Floats = np.where(touching, found, 0.0)
        return result
