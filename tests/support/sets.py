"""Planetary sets by their numbers of teeth, unchecked, and the train of the Alm thesis."""

from __future__ import annotations

from typing import Any

from gearcad.geometry import Gear, GearPair
from gearcad.planetary import Central, PairStage, PlanetaryTrain, Rim
from gearcad.planetary.train_data import TrainData


def gear(teeth: int, module: float = 1.0, shift: float = 0.0, helix: float = 0.0, width: float = 14.0) -> Gear:
    return Gear(teeth=teeth, normal_module=module, profile_shift=shift, helix_angle=helix, face_width=width)


def unchecked_set(a: int, rim: int, rim_2: int, b: int, *, stepped: bool = True, **fields: Any) -> TrainData:
    """Centrals a and b with their rims and the carrier c; nothing need fit, for what teeth alone decide."""
    rims = (Rim(name="rim", gear=gear(rim)), Rim(name="rim_2", gear=gear(rim_2)))[: 2 if stepped else 1]
    centrals = (Central(name="a", gear=gear(a), meshes="rim"), Central(name="b", gear=gear(b), meshes=rims[-1].name))
    roles = {"planets": 1, "input": "a", "output": "b"} | fields
    return TrainData(centrals=centrals, rims=rims, **roles)


def stage(name: str, pinion: tuple[str, int], wheel: tuple[str, int]) -> PairStage:
    """A stage between two shafts, by their names and teeth."""
    pair = GearPair(pinion=gear(pinion[1]), wheel=gear(wheel[1]))
    return PairStage(name=name, pair=pair, pinion=pinion[0], wheel=wheel[0])


def alm_train(*, in_phase: bool = False, **fields: Any) -> PlanetaryTrain:
    """The train of the Alm thesis, shifts of the rings from its centre distance; or its variant with planets in phase.

    `fields` replace those of the train; without stages the carrier is the input.
    """
    teeth, module, shifts = (
        ((-75, 24, 21, -72), (2.7, 2.6), (-0.16, 0.1, 0.5, -1.6794))
        if in_phase
        else ((-70, 22, 21, -72), (2.8, 2.6), (-1.2025, 0.5, 0.5, -1.6794))
    )
    ring_4, rim_3, rim_3p, ring_5 = (gear(z, module[i > 1], shifts[i]) for i, z in enumerate(teeth))
    pair = GearPair(pinion=gear(18, 1.5, 0.3), wheel=gear(161, 1.5, 0.2), centre_distance=135.0)
    given = {
        "planets": 3,
        "centre_distance": 69.0,
        "centrals": (Central(name="ring_4", gear=ring_4, meshes="rim_3"), Central(name="ring_5", gear=ring_5, meshes="rim_3p")),
        "rims": (Rim(name="rim_3", gear=rim_3), Rim(name="rim_3p", gear=rim_3p, axial_position=20.0)),
        "fixed": "ring_4",
        "output": "ring_5",
        "stages": (PairStage(name="pre_stage", pair=pair, pinion="pinion_1", wheel="carrier"),),
    } | fields
    return PlanetaryTrain(**({"input": "pinion_1" if given["stages"] else "carrier"} | given))
