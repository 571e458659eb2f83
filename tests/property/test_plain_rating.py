"""Every factor of a rating, of pairs at random, against a rating that is written a second time."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from support.plain_rating import PlainGear, PlainPair, plain_rating
from support.specs import figures, rate_document

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
