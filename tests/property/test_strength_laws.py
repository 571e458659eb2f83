"""Laws of safeties: more torque, more life or a coarser grade never make a pair safer; over random pairs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from gearcad import Gear, GearcadError, GearPair, Load, Material
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating, rate_strength

ROUNDING = 1e-9
"""Relative."""

MATERIALS = (
    Material(name="Eh MQ"),
    Material(name="V MQ", hardness=280.0, yield_strength=700.0),
    Material(name="NT MQ"),
    Material(name="GG MQ", hardness=200.0, tensile_strength=250.0),
    Material(name="IF ME", hardness=560.0),
)


def case(random: np.random.Generator) -> tuple[GearPair, Material, Load, RatingOptions]:
    """A pair that exists and is rated, external or with a ring, above 100 N/mm: below that N_S of K_v falls with the load."""
    while True:
        module, helix = random.uniform(1, 8), random.choice([0.0, random.uniform(5, 28)])
        first, second = int(random.integers(17, 40)), int(random.integers(20, 120))
        ring = random.random() < 0.2
        width = module * random.uniform(6, 15)
        try:
            pinion = Gear(teeth=first, normal_module=module, face_width=width, helix_angle=helix)
            teeth, hand = (-first - second, helix) if ring else (second, -helix)
            pair = GearPair(pinion=pinion, wheel=Gear(teeth=teeth, normal_module=module, face_width=width, helix_angle=hand))
            if not 1.05 < pair.transverse_contact_ratio < 1.95:
                continue
            torque = random.uniform(150, 600) * width * pinion.reference_diameter / 2000
            load = Load(torque=torque, speed=random.uniform(50, 6000), application_factor=random.uniform(1, 1.75))
            options = RatingOptions(life=10 ** random.uniform(0, 5), accuracy_grade=int(random.integers(5, 10)))
            material = MATERIALS[random.integers(len(MATERIALS))]
            rate_strength(pair, material, load, options)
        except GearcadError:
            continue
        return pair, material, load, options


def safeties(rating: StrengthRating) -> np.ndarray:
    """Of all four parts."""
    found = [part.safety for _, part in rating.every]
    assert None not in found, rating.not_judged
    return np.array(found)


def check(count: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    for _ in range(count):
        pair, material, load, options = case(random)
        rating = rate_strength(pair, material, load, options)
        own, factor = safeties(rating), random.uniform(1.01, 2)
        heavier = rate_strength(pair, material, replace(load, torque=factor * load.torque), options)
        assert (safeties(heavier) < own).all()
        longer = rate_strength(pair, material, load, replace(options, life=factor * options.life))
        assert (safeties(longer) <= own * (1 + ROUNDING)).all()
        coarser = rate_strength(pair, material, load, replace(options, accuracy_grade=options.accuracy_grade + 1))
        assert (safeties(coarser) <= own * (1 + ROUNDING)).all()
        limit = rating.permissible_torque
        assert limit is not None
        least = rate_strength(pair, material, replace(load, torque=limit), options)
        surplus = [part.safety / part.required for _, part in least.every]
        assert min(surplus) == pytest.approx(1, rel=1e-7)


def test_laws_hold() -> None:
    check(8, seed=19)


@pytest.mark.long
def test_laws_hold_for_many() -> None:
    check(1000, seed=6336)
