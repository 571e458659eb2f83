"""Gears with modified flanks that between them show every feature of a body and every modification."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcad import BasicRack, Body, Gear, GeometryError
from gearcad.geometry.modification import FlankModification
from support.modified import roll_ends

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
