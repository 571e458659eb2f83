"""Ratings of random pairs against a rating written apart, as arrays of variants, and by the laws of safeties."""

import random
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.plain_rating import PlainGear, PlainPair, plain_rating
from support.specs import figures, rate_document

from gearcad import Gear, GearcadError, GearPair, Load, Material, PerGear
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating, rate_strength
from gearcad.sizing import ISO_54_I, SizedPair, SizeTask
from gearcad.sizing.geometry import ManyPairs, distance_for, shift_sum_at
from gearcad.sizing.rating import Rated, rate_many
from gearcad.sizing.search import LIMITS

SAME = 1e-9
"""Relative: the same equations, solved by other steps."""

SYMBOLS = (
    "K_v K_Hbeta K_Fbeta K_Halpha K_Falpha Z_H Z_E Z_eps Z_beta Z_B Z_D Z_L Z_v Z_R Z_W Z_NT sigma_H0 sigma_H sigma_HG S_H"
)
SYMBOLS += " Y_F Y_S Y_beta Y_delta_relT Y_RrelT Y_X Y_NT sigma_F0 sigma_F sigma_FG S_F N"

GROUPS = ("Eh", "Eh"), ("Eh", "Eh"), ("V", "V"), ("IF", "IF"), ("NT", "NT"), ("NV", "NV"), ("Eh", "V"), ("NT", "V"), ("IF", "V")
PLACES = {"a": 0.8, "b": -0.8, "c": 1.33, "d": -0.6, "e": -1.0}
"""K' of figure 13 of ISO 6336-1, without stiffening."""


def _material(draw: random.Random, group: str) -> tuple[dict[str, Any], dict[str, float]]:
    """A material of a spec, MQ, and what it bears by ISO 6336-5."""
    table: dict[str, Any] = {"name": f"{group} MQ"}
    if group in ("V", "IF"):
        table["hardness"] = hardness = draw.randint(200, 360) if group == "V" else draw.randint(500, 570)
        if group == "IF":
            return table, {"sigma_Hlim": 0.541 * hardness + 882, "sigma_Flim": 0.138 * hardness + 290}
        table["yield_strength"] = strength = draw.randint(500, 1000)
        limits = {"sigma_Hlim": 1.313 * hardness + 373, "sigma_Flim": 0.425 * hardness + 187}
        return table, limits | {"strength": strength, "HB": 0.95 * hardness}
    contact, root = {"Eh": (1500, 425), "NT": (1250, 420), "NV": (998, 363)}[group]
    return table, {"sigma_Hlim": contact, "sigma_Flim": root}


def _drawn(draw: random.Random) -> tuple[PlainPair, dict[str, dict[str, Any]]]:
    """A pair in both languages: teeth, module, helix, widths, bores, grades, roughness, oil, shaft and speed at random."""
    m, beta = draw.choice((1.5, 2.5, 4.0, 6.0, 8.0)), draw.choice((0.0, 0.0, 9.5, 17.0, 27.0))
    z = (first := draw.randint(18, 35), round(first * draw.uniform(1.05, 5)))
    width = round(m * first * draw.uniform(0.2, 1.1), 1)
    gears, tables = [], {}
    for role, teeth, group, b in zip(("pinion", "wheel"), z, draw.choice(GROUPS), (width, width - 0.5 * m), strict=True):
        table, limits = _material(draw, group)
        values = {
            "x": draw.choice((-0.05, 0.1, 0.35)),
            "b": b,
            "bore": draw.choice((0.0, 0.3 * m * teeth)),
            "grade": draw.randint(6, 9),
            "Rz": draw.choice((2.0, 4.8)),
            "Rz_root": draw.choice((8.0, 20.0)),
        }
        gears.append(PlainGear(z=teeth, group=group, **values, **limits))
        keys = ("profile_shift", "face_width", "body.bore", "accuracy_grade", "flank_roughness", "root_roughness")
        tables[role] = {"teeth": teeth} | dict(zip(keys, values.values(), strict=True))
        tables[f"{role}.material"] = table
    n = round(10 ** draw.uniform(1.5, 4.2), 1)
    place, span, modification = draw.choice("abcde"), 4 * width, draw.choice(("none", "none", "crowning", "end relief"))
    shaft = draw.choice((None, (span, 0.2 * span, 0.7 * m * first, PLACES[place])))
    load = {"torque": m**3 * first**2 * draw.uniform(0.0005, 0.02), "speed": n, "application_factor": draw.choice((1.0, 1.5))}
    rating = {"life": 6e8 * z[1] / z[0] / (60 * n), "mesh_load_factor": draw.choice((1.0, 1.1)), "oil_viscosity_40": 150.0}
    rating |= {"helix_modification": modification}
    if shaft is not None:
        names = ("bearing_span", "pinion_offset", "shaft_diameter")
        rating |= {"bearing_arrangement": place} | dict(zip(names, shaft[:3], strict=True))
    plain = PlainPair(
        gears=(gears[0], gears[1]), m=m, beta=beta, T=load["torque"], n=n, life=rating["life"], K_A=load["application_factor"],
        K_gamma=rating["mesh_load_factor"], nu_40=150.0, modification=modification, shaft=shaft,
    )  # fmt: skip
    return plain, {"pair": {"normal_module": m, "helix_angle": beta}, **tables, "load": load, "rating": rating}


def _compare(seed: int, folder: Path) -> None:
    plain, tables = _drawn(random.Random(seed))
    document, expected = rate_document(tables, folder), plain_rating(plain)
    document |= {"S_H": document["safety"]["flank"], "S_F": document["safety"]["root"]}
    for symbol in SYMBOLS.split():
        found, value = figures(document, symbol), expected[symbol]
        values = value if isinstance(value, list) else [value] * len(found)
        assert found
        assert found == pytest.approx(values, rel=SAME), (seed, symbol)


@pytest.mark.parametrize("seed", range(8))
def test_rating_of_random_pairs(seed: int, tmp_path: Path) -> None:
    _compare(seed, tmp_path)


@pytest.mark.long
def test_rating_of_many_random_pairs(tmp_path: Path) -> None:
    for seed in range(8, 308):
        _compare(seed, tmp_path)


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
