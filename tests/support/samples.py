"""Gears, gears with modified flanks and rings that between them show every feature and every corner of an outline."""

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcad import ISO53_D, BasicRack, Body, Gear, GearcadError, GeometryError
from gearcad.geometry import ShaperCutter
from gearcad.geometry.gear_data import LEAST_RIM, least_rim_diameter
from gearcad.geometry.modification import FlankModification
from support.modified import roll_ends

SAMPLES: dict[str, Gear] = {
    "spur": Gear(teeth=30, normal_module=2.0, face_width=10),
    "helical": Gear(teeth=13, normal_module=2.5, face_width=18.3, helix_angle=28, profile_shift=0.107, tooth_thinning=0.08),
    "left hand": Gear(teeth=44, normal_module=2.5, face_width=15.1, helix_angle=-28, profile_shift=-0.378),
    "many teeth": Gear(teeth=300, normal_module=0.5, face_width=5, profile_shift=0.3),
    "undercut": Gear(teeth=8, normal_module=1.0, face_width=5),
    "deeply undercut": Gear(teeth=8, normal_module=3.0, face_width=10, profile_shift=-0.15, rack=ISO53_D),
    "barely undercut": Gear(teeth=17, normal_module=4.0, face_width=10),
    "few teeth": Gear(teeth=6, normal_module=2.0, face_width=30, helix_angle=35, profile_shift=0.4),
    "three teeth": Gear(teeth=3, normal_module=2.0, face_width=20, helix_angle=60, profile_shift=0.1),
    "full radius": Gear(teeth=24, normal_module=3.0, face_width=10, rack=BasicRack(root_radius="full")),
    "sharp tool": Gear(teeth=24, normal_module=3.0, face_width=10, rack=BasicRack(root_radius=0.0)),
    "sharp tool, undercut": Gear(teeth=10, normal_module=3.0, face_width=10, rack=BasicRack(root_radius=0.0)),
    "nearly sharp tool": Gear(teeth=24, normal_module=3.0, face_width=10, rack=BasicRack(root_radius=1e-4)),
    "high shift": Gear(teeth=40, normal_module=1.0, face_width=10, profile_shift=1.4, rack=BasicRack(addendum=0.8)),
    "shift beyond dedendum": Gear(
        teeth=60, normal_module=1.0, face_width=10, profile_shift=1.5, rack=BasicRack(addendum=0.7, dedendum=1.1)
    ),
    "14.5 degrees": Gear(teeth=20, normal_module=1.0, face_width=10, rack=BasicRack(pressure_angle=14.5)),
    "30 degrees": Gear(
        teeth=20,
        normal_module=1.0,
        face_width=10,
        rack=BasicRack(pressure_angle=30, dedendum=1.0, addendum=0.8, root_radius=0.2),
    ),
    "chamfered": Gear(teeth=30, normal_module=2.0, face_width=10, body=Body(tip_chamfer=0.3)),
    "shallow root above base circle": Gear(teeth=80, normal_module=1.0, face_width=10, root_diameter=78.0),
    "tiny": Gear(teeth=20, normal_module=0.1, face_width=1),
    "huge": Gear(teeth=20, normal_module=20, face_width=100, helix_angle=10),
}


_KEYED = {"bore": 12, "keyway_width": 4, "keyway_depth": 1.5, "hub_diameter": 20, "hub_length": 3, "hub_side": "both"}
_PLAIN = {"teeth": 14, "normal_module": 2.0, "face_width": 12.2, "profile_shift": 0.2}

GEARS: dict[str, Gear] = {
    "spur": Gear(teeth=18, normal_module=2.0, face_width=10),
    "right hand": Gear(teeth=13, normal_module=2.5, face_width=18.3, helix_angle=28, profile_shift=0.107, tooth_thinning=0.08),
    "left hand": Gear(teeth=18, normal_module=2.5, face_width=15.1, helix_angle=-28, profile_shift=-0.378),
    "undercut": Gear(teeth=8, normal_module=2.0, face_width=10, helix_angle=15),
    "chamfered": Gear(**_PLAIN, helix_angle=25, body=Body(**_KEYED, end_chamfer=1.2, tip_chamfer=0.3)),
    "chamfered, spur": Gear(**_PLAIN, body=Body(end_chamfer=1.2)),
    "chamfered to the root": Gear(**_PLAIN, helix_angle=-17, body=Body(**_KEYED, end_chamfer=5.2, tip_chamfer=0.2)),
}

AMOUNTS = {
    "tip_relief": 30.0,
    "root_relief": 20.0,
    "profile_crowning": 6.0,
    "pressure_angle_modification": -7.0,
    "lead_crowning": 8.0,
    "end_relief": 15.0,
    "helix_angle_modification": 9.0,
    "twist": 12.0,
}
"""Of each modification (µm)."""


def modified(gear: Gear, *names: str, **others: object) -> Gear:
    """The gear with the modifications of these names, by default all, over a part of its flanks that is no round share."""
    first, last = roll_ends(gear)
    lengths = {
        "tip_relief_length": 0.37 * (last - first),
        "root_relief_length": 0.23 * (last - first),
        "end_relief_length": 0.18 * gear.face_width,
    }
    amounts = {name: AMOUNTS[name] for name in names or AMOUNTS}
    return replace(gear, modification=FlankModification(**{**lengths, **amounts, **others}))


def random_gear(seed: int) -> Gear:
    """A gear with random modifications, the same one each time; amounts grow with the module."""
    rng = np.random.default_rng(seed)
    while True:
        try:
            return _draw(rng)
        except GeometryError:
            continue


def _draw(rng: np.random.Generator) -> Gear:
    module = float(rng.choice([0.5, 2.0, 6.0]))
    body = {}
    if rng.random() < 0.5:
        body = {"end_chamfer": module * rng.uniform(0.1, 1.5), "end_chamfer_angle": rng.uniform(15, 65)}
    if rng.random() < 0.3:
        body["tip_chamfer"] = module * rng.uniform(0.05, 0.2)
    gear = Gear(
        teeth=int(rng.choice([7, 12, 20, 41])),
        normal_module=module,
        face_width=module * rng.uniform(1, 12),
        helix_angle=float(rng.choice([0, rng.uniform(-40, 40)])),
        profile_shift=rng.uniform(-0.1, 0.4),
        rack=BasicRack(root_radius=rng.uniform(0, 0.4)),
        body=Body(**body),
    )
    first, last = roll_ends(gear)
    shapes = {f"{name}_shape": rng.choice(["linear", "parabolic"]) for name in ("tip_relief", "root_relief", "end_relief")}
    lengths = {
        "tip_relief_length": rng.uniform(0.1, 1) * (last - first),
        "root_relief_length": rng.uniform(0.1, 1) * (last - first),
        "end_relief_length": rng.uniform(0.02, 0.5) * gear.face_width,
    }
    chosen = [name for name in AMOUNTS if rng.random() < 0.6]
    amounts = {name: module * rng.uniform(0 if name.endswith("relief") else -6, 12) for name in chosen}
    return replace(gear, modification=FlankModification(**shapes, **lengths, **amounts))


def crossed(amounts: Iterable[str]) -> list[Any]:
    """Every gear with every amount, as parameters "name", "amount": every amount once by default, the others long."""
    return [
        pytest.param(name, amount, id=f"{name}-{amount}", marks=() if column % len(GEARS) == row else pytest.mark.long)
        for row, name in enumerate(GEARS)
        for column, amount in enumerate(amounts)
    ]


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
