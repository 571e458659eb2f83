"""Rings that between them show every feature and every corner of a ring's outline, and external gears cut by a shaper."""

from __future__ import annotations

import math

import numpy as np

from gearcad import BasicRack, Body, FlankModification, Gear, GearcadError
from gearcad.geometry import ShaperCutter
from gearcad.geometry.gear_data import LEAST_RIM, least_rim_diameter

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


def random_ring(rng: np.random.Generator) -> Gear:
    """A ring anywhere in what is promised: teeth, cutters, rims down to the thinnest, bolt holes, chamfers."""
    while True:
        try:
            return _drawn(rng)
        except GearcadError:
            continue


def _drawn(rng: np.random.Generator) -> Gear:
    module, teeth = float(rng.choice([0.01, 0.25, 1, 3, 20, 200])), int(rng.choice([10, 12, 18, 30, 45, 60, 100, 150, 300]))
    cutter = ShaperCutter(teeth=max(5, int(teeth * rng.uniform(0.2, 0.6))), profile_shift=float(rng.uniform(-0.2, 0.3)))
    teeth_only = {
        "teeth": -teeth,
        "normal_module": module,
        "face_width": module * float(rng.choice([0.1, 2, 10, 25])),
        "helix_angle": float(rng.choice([0, rng.uniform(-45, 45), rng.uniform(-70, 70)])),
        "profile_shift": float(rng.uniform(-1.2, 0.6)),
        "tooth_thinning": module * float(rng.choice([0, rng.uniform(0, 0.1)])),
        "rack": BasicRack(
            addendum=float(rng.choice([1.0, 0.6, 0.8])),
            root_radius="full" if rng.random() < 0.3 else float(rng.uniform(0.01, 0.45)),
        ),
        "cutter": cutter if rng.random() < 0.5 else ShaperCutter(),
    }
    plain = Gear(**teeth_only)
    body: dict[str, float | int] = {}
    rim = body["rim_diameter"] = least_rim_diameter(plain) * float(rng.choice([1, 1.001, 1.05, 1.3])) + module * float(
        rng.choice([0, 0, 3, 8])
    )
    wall = LEAST_RIM * module
    room = (rim + plain.root_diameter) / 2 - 2 * wall
    if room > wall / 10 and rng.random() < 0.6:
        hole = body["bolt_diameter"] = room * float(rng.choice([1 - 1e-9, 0.5, 0.1]))
        least, most = 2 * wall + hole - plain.root_diameter, rim - 2 * wall - hole
        circle = body["bolt_circle"] = least + (most - least) * float(rng.choice([0, 0.5, 1, rng.random()]))
        fitting = math.floor(math.pi / math.asin((hole + wall) / circle))
        body["bolt_holes"] = int(rng.choice([1, 2, 3, 6, min(fitting, 1000)]))
    if rng.random() < 0.6:
        body |= {"end_chamfer": module * float(rng.uniform(0.1, 4)), "end_chamfer_angle": float(rng.uniform(5, 80))}
    if rng.random() < 0.3:
        body["tip_chamfer"] = module * float(rng.uniform(0.02, 0.3))
    return Gear(**teeth_only, body=Body(**body))
