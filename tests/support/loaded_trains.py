"""Trains whose meshes carry something: the Alm thesis's set of two rings, and a sun, planets and a ring."""

from __future__ import annotations

from typing import Any

from gearcad.geometry import Body, Gear, GearPair
from gearcad.planetary import Carrier, Central, PairStage, PlanetaryTrain, Rim


def alm_set(*, rim_diameter: float | None = 240.0, **changes: Any) -> PlanetaryTrain:
    """Two rings on a stepped planet: m 2.8 mm 22/-70 and m 2.6 mm 21/-72 at 69 mm (x of ring 5 is -1.6794)."""
    body = Body(rim_diameter=rim_diameter)
    third = Gear(name="rim_3", teeth=22, normal_module=2.8, profile_shift=0.5, face_width=16)
    fourth = Gear(name="ring_4", teeth=-70, normal_module=2.8, profile_shift=-1.2025, face_width=14, body=body)
    stepped = Gear(name="rim_3p", teeth=21, normal_module=2.6, profile_shift=0.5, face_width=16)
    fifth = Gear(name="ring_5", teeth=-72, normal_module=2.6, profile_shift=-1.6794, face_width=14, body=body)
    given: dict[str, Any] = {
        "planets": 3,
        "centrals": (
            Central(name="ring_4", gear=fourth, meshes="rim_3"),
            Central(name="ring_5", gear=fifth, meshes="rim_3p"),
        ),
        "rims": (Rim(name="rim_3", gear=third), Rim(name="rim_3p", gear=stepped, axial_position=20)),
        "input": "carrier",
        "output": "ring_5",
        "fixed": "ring_4",
        "centre_distance": 69.0,
    }
    return PlanetaryTrain(**given | changes)


def pre_stage() -> PairStage:
    """That of the Alm thesis, m 1.5 mm 18/161 at 135 mm, before the carrier."""
    pinion = Gear(name="pinion_1", teeth=18, normal_module=1.5, profile_shift=0.3422, face_width=15)
    wheel = Gear(name="gear_2", teeth=161, normal_module=1.5, profile_shift=0.1682, face_width=10)
    pair = GearPair(pinion=pinion, wheel=wheel, centre_distance=135.0, name="pre_stage")
    return PairStage(name="pre_stage", pair=pair, pinion="pinion_1", wheel="carrier", angle=30.0)


def simple_set(
    sun: int = 24, planet: int = 21, *, helix_angle: float = 0.0, rim_diameter: float | None = None, **changes: Any
) -> PlanetaryTrain:
    """Sun, three planets (or four, where only these fit) and ring of m_n 2 mm without backlash: x 0.3, 0.2 and -0.7."""

    def gear(name: str, teeth: int, shift: float, helix: float, body: Body) -> Gear:
        return Gear(name=name, teeth=teeth, normal_module=2, profile_shift=shift, face_width=20, helix_angle=helix, body=body)

    ring = gear("ring", -(sun + 2 * planet), -0.7, -helix_angle, Body(rim_diameter=rim_diameter))
    given: dict[str, Any] = {
        "planets": 4 if 2 * (sun + planet) % 3 else 3,
        "centrals": (
            Central(name="sun", gear=gear("sun", sun, 0.3, helix_angle, Body()), meshes="planet"),
            Central(name="ring", gear=ring, meshes="planet"),
        ),
        "rims": (Rim(name="planet", gear=gear("planet", planet, 0.2, -helix_angle, Body())),),
        "carrier": Carrier(),
        "input": "sun",
        "output": "carrier",
        "fixed": "ring",
    }
    return PlanetaryTrain(**given | changes)
