"""Random pinions and rings near the limits, and whether they overlap where they stand."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from hypothesis import strategies as st
from numpy.typing import ArrayLike

from gearcad import BasicRack, Body, Gear
from gearcad.core.records import Floats, PerGear
from gearcad.geometry import ShaperCutter, ToothProfile, zero_backlash_centre_distance
from gearcad.geometry.gear_data import GearData
from gearcad.geometry.mating import tip_on_form_circle
from gearcad.geometry.pair_data import PairData, shift_sum_limit


def _often(value: Any, rest: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.one_of(st.just(value), rest)


@st.composite
def ring_pair_inputs(draw: st.DrawFn, most_more: int = 240) -> dict[str, Any]:
    """Inputs of a pair with a ring that has at most `most_more` teeth more; lengths in normal modules."""
    pinion = draw(st.integers(9, 60))
    more = st.one_of(st.integers(2, 14), st.integers(6, min(60, most_more)), st.integers(6, most_more))
    ring = max(pinion + draw(more), 24)
    helix, angle = draw(_often(0.0, st.floats(0.01, 35))), draw(_often(20.0, st.sampled_from([14.5, 17.5, 25.0, 30.0])))
    most = shift_sum_limit(teeth=PerGear(pinion, -ring), helix_angle=helix, pressure_angle=angle)
    first, total = draw(st.floats(-0.3, 0.8)), min(draw(st.floats(-1.2, 0.4)), 0.9 * most)
    return {
        "teeth": (pinion, -ring),
        "normal_module": draw(st.sampled_from([0.5, 1.0, 2.0, 5.0])),
        "helix_angle": draw(st.sampled_from([1, -1])) * helix,
        "pressure_angle": angle,
        "profile_shift": (first, total - first),
        "addendum": (draw(_often(1.0, st.floats(0.6, 1.15))), draw(_often(1.0, st.floats(0.5, 1.1)))),
        "root_radius": draw(st.floats(0, 1)),
        "thinning": (draw(_often(0.0, st.floats(0.005, 0.05))), draw(_often(0.0, st.floats(0.005, 0.05)))),
        "tip_chamfer": (draw(_often(0.0, st.floats(0.02, 0.15))), draw(_often(0.0, st.floats(0.02, 0.15)))),
        "cutter_teeth": draw(_often(None, st.integers(12, 60))),
        "corner": draw(st.floats(0.01, 0.15)),
        "closer": draw(_often(0.0, st.floats(0, 0.1))),
        "clear": draw(st.booleans()),
    }


def build_ring_pair(inputs: dict[str, Any]) -> PairData:
    """Both gears at their centre distance, not asked whether they fit; raises GearcadError where there are none.

    "clear" ends the ring's flank on the pinion's root form circle.
    """
    m = inputs["normal_module"]

    def given(index: int) -> dict[str, Any]:
        dedendum = max(inputs["addendum"][index], 1.0) + 0.25
        rack = BasicRack(pressure_angle=inputs["pressure_angle"], addendum=inputs["addendum"][index], dedendum=dedendum)
        rack = replace(rack, root_radius=inputs["root_radius"] * max(rack.full_root_radius(), 0.0))
        return {
            "teeth": inputs["teeth"][index],
            "normal_module": m,
            "face_width": 8 * m,
            "helix_angle": inputs["helix_angle"],
            "profile_shift": inputs["profile_shift"][index],
            "tooth_thinning": inputs["thinning"][index] * m,
            "rack": rack,
            "body": Body(tip_chamfer=inputs["tip_chamfer"][index] * m),
        }

    distance = zero_backlash_centre_distance(
        normal_module=m,
        teeth=PerGear(*inputs["teeth"]),
        helix_angle=inputs["helix_angle"],
        pressure_angle=inputs["pressure_angle"],
        shift_sum=sum(inputs["profile_shift"]),
    )
    distance += inputs["closer"] * m
    pinion, of_ring = Gear(**given(0)), given(1)
    if inputs["clear"]:
        plain = GearData(**of_ring)
        tip = tip_on_form_circle(plain, pinion, distance)
        if tip is not None and tip < plain.standard_tip_diameter:
            of_ring["tip_diameter"] = tip
    few = inputs["cutter_teeth"] is not None and inputs["cutter_teeth"] < -inputs["teeth"][1] - 4
    cutter = ShaperCutter(teeth=inputs["cutter_teeth"] if few else None, tip_radius=inputs["corner"])
    return PairData(pinion=pinion, wheel=Gear(**of_ring, cutter=cutter), centre_distance=distance)


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
