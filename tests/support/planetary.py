"""Trains to look at, and whether their gears overlap where a pose puts them: exact outlines, no formula of meshing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gearcad import Gear, GearPair
from gearcad.geometry.helix import twist
from gearcad.per_gear import PerGear
from gearcad.planetary import Central, GearPlace, PairStage, PlanetaryTrain, Rim, TrainPose
from support.clearance import Placed, least_gap
from support.ring_mesh import RingMesh

__all__ = ["clearance", "gear", "simple_train", "stage_clearance", "thesis_train", "train_clearance"]


def gear(teeth: int, module: float, shift: float = 0.0, **given: float) -> Gear:
    """A gear 20 mm wide."""
    return Gear(**{"teeth": teeth, "normal_module": module, "profile_shift": shift, "face_width": 20.0, **given})


def simple_train(
    teeth: tuple[int, int, int],
    shifts: tuple[float, float, float],
    planets: int,
    *,
    gears: tuple[Gear, Gear, Gear] | None = None,
    **given: object,
) -> PlanetaryTrain:
    """Sun, planet and ring (type A), of module 2 or as given: the ring is fixed, the sun drives."""
    sun, planet, ring = gears or (gear(z, 2.0, x) for z, x in zip(teeth, shifts, strict=True))
    return PlanetaryTrain(
        **{
            "planets": planets,
            "centrals": (Central(name="sun", gear=sun, meshes="planet"), Central(name="ring", gear=ring, meshes="planet")),
            "rims": (Rim(name="planet", gear=planet),),
            "fixed": "ring",
            "input": "sun",
            "output": "carrier",
            **given,
        }
    )


def clearance(first: Gear, second: Gear, places: tuple[GearPlace, GearPlace], height: float) -> float:
    """Least angle (rad of the other gear, or mm along circles in a ring) between two gears in the plane at `height` (mm)."""
    turns = [math.radians(p.rotation) + twist(g, height - p.height) for g, p in zip((first, second), places, strict=True)]
    one, two = places
    towards = math.atan2(two.y - one.y, two.x - one.x)
    distance = math.hypot(two.y - one.y, two.x - one.x)
    if second.internal:
        first, second, towards, turns = second, first, towards + math.pi, turns[::-1]
    if first.internal:
        own, ring = (np.array([turn - towards]) for turn in turns[::-1])
        return float(RingMesh(second, first, distance).standing(own, ring, np.zeros(1))[0])
    a, b = Placed(first.profile, turns[0] - towards, 0.0), Placed(second.profile, turns[1] - towards, distance)
    return min(least_gap(*both, side) for both in ((a, b), (b, a)) for side in (1, -1))


def train_clearance(train: PlanetaryTrain, pose: TrainPose, turned: dict[str, float] | None = None) -> float:
    """Least clearance of all meshes with the planets at both ends and the middle of their common widths.

    `turned` (degrees) turns members on.
    """
    least = math.inf
    for mesh in train.meshes:
        central, rim = mesh.central, mesh.rim
        bottom = pose.heights[central.name], pose.heights[rim.name]
        extra = (turned or {}).get(central.name, 0.0)
        own = GearPlace(pose.rotations[central.name] + extra, 0.0, 0.0, bottom[0])
        low, high = max(bottom), min(bottom[0] + central.gear.face_width, bottom[1] + rim.gear.face_width)
        heights = (low, (low + high) / 2, high) if central.gear.helix_angle else (low,)
        for planet in pose.planets:
            place = GearPlace(planet.rotations[rim.name], planet.x, planet.y, bottom[1])
            least = min(least, *(clearance(central.gear, rim.gear, (own, place), z) for z in heights))
    return least


def stage_clearance(stage: PairStage, places: PerGear[GearPlace]) -> float:
    """Least clearance of a stage at both ends of the common width."""
    pinion, wheel = stage.pair.gears
    low = max(place.height for place in places)
    high = min(place.height + gear.face_width for place, gear in zip(places, stage.pair.gears, strict=True))
    return min(clearance(pinion, wheel, tuple(places), z) for z in (low, high))  # type: ignore[arg-type]


def thesis_train(**given: object) -> PlanetaryTrain:
    """The train of the Alm thesis, the profile shift of ring 5 as its 69 mm ask for."""
    thin = {"tooth_thinning": 0.03}
    rims = (
        Rim(name="rim_3", gear=gear(22, 2.8, 0.5, **thin)),
        Rim(name="rim_3p", gear=gear(21, 2.6, 0.5, **thin), axial_position=30.0),
    )
    centrals = (
        Central(name="ring_4", gear=gear(-70, 2.8, -1.2025, **thin), meshes="rim_3"),
        Central(name="ring_5", gear=gear(-72, 2.6, -1.6794, **thin), meshes="rim_3p"),
    )
    pair = GearPair(pinion=gear(18, 1.5, **thin), wheel=gear(161, 1.5, **thin), centre_distance=135.0)
    train = PlanetaryTrain(
        planets=3,
        centrals=centrals,
        rims=rims,
        fixed="ring_4",
        input="pinion_1",
        output="ring_5",
        centre_distance=69.0,
        stages=(PairStage(name="stage", pair=pair, pinion="pinion_1", wheel="carrier", angle=25.0, axial_position=60.0),),
    )
    return replace(train, **given)
