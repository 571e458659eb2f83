"""Rings that between them show every feature and every corner of a ring's outline, and external gears cut by a shaper."""

from __future__ import annotations

from gearcad import BasicRack, Body, FlankModification, Gear
from gearcad.geometry import ShaperCutter

__all__ = ["RINGS", "SHAPED"]

_BOLTED = Body(rim_diameter=150.0, bolt_circle=138.0, bolt_holes=6, bolt_diameter=6.0)
_RELIEF = FlankModification(tip_relief=20, tip_relief_length=2.0, root_relief=10, root_relief_length=1.5, lead_crowning=8)

RINGS: dict[str, Gear] = {
    "form root": Gear(teeth=-60, normal_module=2, face_width=12, body=_BOLTED),
    "shaped": Gear(
        teeth=-70,
        normal_module=2.8,
        face_width=14,
        profile_shift=-1.2025,
        cutter=ShaperCutter(teeth=25, tip_radius=0.15),
        body=Body(rim_diameter=240.0),
    ),
    "shaped, helical": Gear(
        teeth=-75,
        normal_module=2.7,
        face_width=20,
        helix_angle=15,
        profile_shift=-0.16,
        cutter=ShaperCutter(teeth=27, profile_shift=0.1, tip_radius=0.25),
        body=Body(rim_diameter=228.0),
    ),
    "left hand, chamfered": Gear(
        teeth=-48,
        normal_module=2,
        face_width=16,
        helix_angle=-30,
        profile_shift=-0.2,
        rack=BasicRack(root_radius=0.25),
        body=Body(rim_diameter=130.0, tip_chamfer=0.3),
    ),
    "full radius": Gear(
        teeth=-40, normal_module=3, face_width=10, rack=BasicRack(root_radius="full"), body=Body(rim_diameter=140.0)
    ),
    "sharp cutter": Gear(
        teeth=-50, normal_module=3, face_width=10, cutter=ShaperCutter(teeth=25, tip_radius=0.0), body=Body(rim_diameter=170.0)
    ),
    "thinned": Gear(
        teeth=-100,
        normal_module=3,
        face_width=30,
        tooth_thinning=0.12,
        cutter=ShaperCutter(teeth=34, profile_shift=-0.05, tip_radius=0.2),
        body=Body(rim_diameter=330.0),
    ),
    "many teeth": Gear(teeth=-300, normal_module=0.5, face_width=5, helix_angle=10, body=Body(rim_diameter=160.0)),
    "few teeth": Gear(
        teeth=-12,
        normal_module=2,
        face_width=20,
        helix_angle=30,
        profile_shift=-0.3,
        rack=BasicRack(addendum=0.5),
        body=Body(rim_diameter=40.0),
    ),
    "tiny": Gear(teeth=-40, normal_module=0.05, face_width=1, body=Body(rim_diameter=2.4)),
    "modified": Gear(
        teeth=-60,
        normal_module=2,
        face_width=12,
        helix_angle=12,
        cutter=ShaperCutter(teeth=22, tip_radius=0.2),
        modification=_RELIEF,
        body=Body(rim_diameter=140.0),
    ),
}

SHAPED: dict[str, Gear] = {
    "spur": Gear(teeth=30, normal_module=2, face_width=10, cutter=ShaperCutter(teeth=25, tip_radius=0.2)),
    "helical": Gear(
        teeth=24,
        normal_module=2,
        face_width=10,
        helix_angle=-20,
        cutter=ShaperCutter(teeth=34, profile_shift=0.1, tip_radius=0.25),
    ),
    "undercut": Gear(teeth=9, normal_module=2, face_width=10, cutter=ShaperCutter(teeth=40, tip_radius=0.2)),
}
