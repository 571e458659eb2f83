"""The rating of many variants at once is that of one: every safety, load factor and temperature of random pairs to 1e-9."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from gearcad import Load, Material, PerGear
from gearcad.rating import RatingOptions
from gearcad.rating.strength import rate_strength
from gearcad.sizing import ISO_54_I, SizedPair, SizeTask
from gearcad.sizing.geometry import ManyPairs, distance_for, shift_sum_at
from gearcad.sizing.rating import Rated, rate_many
from gearcad.sizing.search import LIMITS

SAME = 1e-9
"""The same formulas in another order: 1e-13 is usual."""

SPUR_TO_STEEP = (0.0, 8.0, 15.0, 22.0, 30.0)


@dataclass(frozen=True)
class Case:
    """Materials (name, hardness) and options."""

    materials: tuple[tuple[str, float | None], tuple[str, float | None]]
    options: dict[str, Any]


EH = ("Eh MQ", None)
CASES = {
    "case hardened": Case((EH, EH), {"life": 20000.0}),
    "2019, fine grade": Case(
        (("V MQ", 300.0), ("V MQ", 230.0)), {"life": 2000.0, "accuracy_grade": 4, "standard": "ISO 6336:2019"}
    ),
    "DIN, soft wheel": Case((EH, ("V MQ", 280.0)), {"life": 100.0, "accuracy_grade": 8, "standard": "DIN 3990:1987"}),
    "shaft given": Case(
        (("GGG MQ", 250.0), ("GGG MQ", 250.0)),
        {
            "accuracy": "ISO 1328-1:2013",
            "mesh_load_factor": 1.2,
            "pinion_offset": 20.0,
            "bearing_span": 120.0,
            "shaft_diameter": 35.0,
            "stiffening": True,
        },
    ),
    "Method C, proven pattern": Case(
        (("NT MQ", 800.0), EH),
        {"life": 9.0, "dynamic_factor": "C", "contact_pattern": "proven", "alpha_deviation_rule": "KISSsoft 2017"},
    ),
    "factors given": Case(
        (("GG MQ", 200.0), ("GG MQ", 200.0)),
        {"life": 1.0, "dynamic_factor": 1.1, "face_load_factor": 1.2, "transverse_load_factor": 1.05},
    ),
    "cycles given": Case(
        (("V ML", 340.0), ("V ML", 210.0)),
        {"load_cycles": (1e6, 5e5), "contacts_per_turn": 2.0, "helix_modification": "crowning", "pitting_permitted": True},
    ),
}


def task_of(case: Case) -> SizeTask:
    materials = PerGear(*(Material(name=name, hardness=hardness) for name, hardness in case.materials))
    load = Load(torque=120.0, speed=450.0, application_factor=1.25)
    return SizeTask(load=load, ratio=3.0, materials=materials, rating=RatingOptions(**case.options))


def random_pairs(task: SizeTask, count: int, seed: int) -> ManyPairs:
    """Those of a count that meet the limits."""
    draw = np.random.default_rng(seed)
    z_1 = draw.integers(10, 45, count).astype(float)
    z_2, module = np.rint(z_1 * draw.uniform(0.9, 6, count)), draw.choice(ISO_54_I[1:13], count).astype(float)
    helix, total = draw.choice(SPUR_TO_STEEP, count), draw.uniform(-0.3, 1.2, count)
    shift = total / 2 + draw.uniform(-0.3, 0.4, count)
    distance = distance_for(total, z_1 + z_2, module, helix, 20.0)
    assert np.allclose(shift_sum_at(distance, z_1 + z_2, module, helix, 20.0), total, atol=1e-12)
    pairs = ManyPairs(
        key=np.arange(count),
        teeth=PerGear(z_1, z_2),
        normal_module=module,
        helix_angle=helix,
        centre_distance=distance,
        shifts=PerGear(shift, total - shift),
        rack=task.rack,
    )
    for met in LIMITS.values():
        pairs = pairs.picked(met(pairs, task))
    return pairs


def rated(task: SizeTask, count: int, seed: int) -> Rated:
    pairs = random_pairs(task, count, seed)
    width = np.maximum(pairs.normal_module * np.random.default_rng(seed + 1).uniform(4, 18, len(pairs.key)), 4.2)[:, None]
    return rate_many(task, pairs, width, np.ones(width.shape, bool), pairs.key[:, None])


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("count", [2, pytest.param(150, marks=pytest.mark.long)])
def test_equal_to_the_rating_of_one(name: str, count: int) -> None:
    task = task_of(CASES[name])
    many = rated(task, count, seed=19)
    assert len(many.order) >= 0.6 * count
    for place in range(len(many.order)):
        sized = SizedPair.of(task, many.picked(np.array([place])))
        one = rate_strength(sized.pair(), task.materials, task.load, task.rating)
        for own, parts in ((sized.flank_safeties, one.flank), (sized.root_safeties, one.root)):
            assert own == pytest.approx([part.safety for part in parts], rel=SAME)
        assert one.load_factors is not None and one.scuffing is not None and one.scuffing.integral is not None
        found = one.load_factors
        product = found.dynamic * found.face_flank * found.transverse_flank * found.mesh_load * found.application
        assert many.load_factors[place] == pytest.approx(product, rel=SAME)
        assert sized.temperature == pytest.approx(one.scuffing.integral.value, rel=SAME)
        assert sized.transverse_contact_ratio == pytest.approx(one.pair.transverse_contact_ratio, rel=SAME)


def test_geometry_equal_to_that_of_one() -> None:
    task = task_of(CASES["case hardened"])
    pairs = random_pairs(task, 6, seed=3)
    for place in range(len(pairs.key)):
        many = pairs.picked(np.array([place]))
        one = SizedPair.of(task, rate_many(task, many, np.array([[30.0]]), np.ones((1, 1), bool), np.zeros((1, 1), int))).pair()
        assert not any(gear.undercut for gear in one.gears)
        assert one.usable_contact_ratio == pytest.approx(many.contact_ratio[0], rel=SAME)
        module = one.pinion.normal_module
        for gear, thickness in zip(one.gears, many.tip_thicknesses, strict=True):
            assert gear.tip_thickness / module == pytest.approx(thickness[0] / module, abs=SAME)
        assert not one.notices or all(notice.code != "fillet-interference" for notice in one.notices)
