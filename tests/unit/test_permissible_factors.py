"""Factors of permissible stress at their knees and limits, and endurance limits by groups, qualities and hardness."""

import math
import re

import numpy as np
import pytest

from gearcad import GeometryError, Material, ParameterError
from gearcad.core.records import PerGear
from gearcad.material import Grade, MaterialGroup, MaterialQuality, grade_of
from gearcad.rating import Edition
from gearcad.rating.factors import (
    cautious_strength,
    cycles_at,
    equivalent_roughness,
    flank_life_factor,
    flank_points,
    flank_roughness_factor,
    flank_size_factor,
    lubricant_factor,
    mean_stress_factor,
    mean_stress_sensitivity,
    notch_sensitivity_factor,
    root_life_factor,
    root_points,
    root_size_factor,
    root_surface_factor,
    speed_factor,
    static_notch_sensitivity_factor,
    static_work_hardening_factor,
    through_hardened_factor,
    transition,
    work_hardening_factor,
)
from gearcad.rating.material_limits import endurance_limits, endurance_limits_of, hardness_scale

G = MaterialGroup
METALS = [group for group in G if group is not G.PLASTIC]
EXACT = 1e-12
"""Relative: the same number by two ways."""

CYCLES = np.logspace(1, 12, 331)
ALL_POINTS = [
    *(flank_points(group, pitting=pitting) for group in METALS for pitting in (False, True)),
    *(root_points(group, long_life=0.92) for group in METALS),
]


def _flank_by_hand(cycles: float) -> float:
    """Z_NT of hardened steel, with the exponents as they are printed in books."""
    if cycles <= 1e5:
        return 1.6
    return (5e7 / cycles) ** 0.0756 if cycles <= 5e7 else max((5e7 / cycles) ** 0.0307, 0.85)


# ---------------------------------------------------------------------- life


def test_life_factors_are_straight_in_log_log() -> None:
    for points in ALL_POINTS:
        x, y = np.log10(points).T
        expected = 10 ** np.interp(np.log10(CYCLES), x, y)
        assert np.all(np.diff(expected) <= 0)
        back = cycles_at(expected, points)
        inside = (points[0][0] < CYCLES) & (points[-1][0] > CYCLES)
        assert back[inside] == pytest.approx(CYCLES[inside], rel=1e-9)
        assert np.all(back[points[-1][0] <= CYCLES] == math.inf)
    for group in METALS:
        for pitting in (False, True):
            x, y = np.log10(flank_points(group, pitting=pitting)).T
            found = flank_life_factor(CYCLES, group, pitting=pitting)
            assert found == pytest.approx(10 ** np.interp(np.log10(CYCLES), x, y), rel=EXACT)
    by_hand = [_flank_by_hand(float(cycles)) for cycles in CYCLES]
    assert flank_life_factor(CYCLES, G.THROUGH_HARDENED) == pytest.approx(by_hand, rel=2e-3)  # 0.0756 of 0.07563


@pytest.mark.parametrize(
    ("group", "flank", "root"),
    [
        ("St", (1e5, 1.6), (1e4, 2.5)),
        ("V (cast)", (1e5, 1.6), (1e4, 2.5)),
        ("GGG", (1e5, 1.6), (1e4, 2.5)),
        ("GTS", (1e5, 1.6), (1e4, 2.5)),
        ("Eh", (1e5, 1.6), (1e3, 2.5)),
        ("IF", (1e5, 1.6), (1e3, 2.5)),
        ("GG", (1e5, 1.3), (1e3, 1.6)),
        ("GGG (ferr.)", (1e5, 1.3), (1e3, 1.6)),
        ("NT", (1e5, 1.3), (1e3, 1.6)),
        ("NV", (1e5, 1.3), (1e3, 1.6)),
        ("NV (nitrocar.)", (1e5, 1.1), (1e3, 1.1)),
    ],
)
def test_static_life_factors(group: str, flank: tuple[float, float], root: tuple[float, float]) -> None:
    of = MaterialGroup(group)
    assert flank_points(of)[0] == flank
    assert root_points(of)[0] == root
    assert flank_life_factor(0.0, of) == flank_life_factor(flank[0], of) == pytest.approx(flank[1], rel=EXACT)
    assert root_life_factor(1.0, of) == pytest.approx(root[1], rel=EXACT)
    assert root_life_factor(3e6, of) == pytest.approx(1, rel=EXACT)
    assert root_life_factor(1e13, of) == pytest.approx(0.85, rel=EXACT)


def test_some_pitting_permitted_counts_for_steel_only() -> None:
    assert flank_points(G.CASE_HARDENED, pitting=True) == ((6e5, 1.6), (1e7, 1.3), (1e9, 1.0), (1e10, 0.85))
    assert flank_points(G.NITRIDED, pitting=True) == flank_points(G.NITRIDED)


def test_long_life_from_085_to_1() -> None:
    assert flank_life_factor(1e11, G.CASE_HARDENED, long_life=1.0) == 1
    assert cycles_at(1.0, flank_points(G.CASE_HARDENED, long_life=1.0)) == math.inf
    assert cycles_at(1.0 + 1e-9, flank_points(G.CASE_HARDENED, long_life=1.0)) == pytest.approx(5e7, rel=1e-6)
    assert cycles_at(np.array([1.7, 1.6, 0.85, 0.5]), flank_points(G.CASE_HARDENED)).tolist() == pytest.approx(
        [0, 1e5, math.inf, math.inf]
    )
    for wrong in (0.84, 1.01, math.nan):
        with pytest.raises(ParameterError, match="long_life"):
            root_life_factor(1e6, G.CASE_HARDENED, long_life=wrong)


def test_factors_go_from_static_to_endurance_as_the_standards_exponents_have_it() -> None:
    """0.3705 = 1/lg 500 and 0.2791 of DIN 3990-11, 4.1.2, are rounded; some pitting has a corner of its own at 1e7."""
    plain, pitting = flank_points(G.CASE_HARDENED), flank_points(G.CASE_HARDENED, pitting=True)
    cycles = np.array([1.0, 1e5, 3e6, 5e7, 1e9, 1e11])
    expected = [1.1, 1.1, 0.9 * (1.1 / 0.9) ** (0.3705 * math.log10(5e7 / 3e6)), 0.9, 0.9, 0.9]
    assert transition(cycles, 1.1, 0.9, plain) == pytest.approx(expected, rel=1e-4)
    assert transition(1e8, 1.1, 0.9, pitting) == pytest.approx(0.9 * (1.1 / 0.9) ** (0.2791 * math.log10(1e9 / 1e8)), rel=1e-5)
    limit = transition(CYCLES, 1.1, 0.9, plain) * flank_life_factor(CYCLES, G.CASE_HARDENED)
    corners = np.log10([(1e5, 1.76), (5e7, 0.9), (1e10, 0.765)]).T
    assert limit == pytest.approx(10 ** np.interp(np.log10(CYCLES), *corners), rel=EXACT)


# ---------------------------------------------------------------------- flank


def test_film_factors_are_clamped_and_continuous() -> None:
    limits = np.linspace(500, 1800, 27_001)
    for values, ends in (
        (lubricant_factor(limits, 220.0), (0.83 + 0.68 / (1.2 + 134 / 220) ** 2, 0.91 + 0.36 / (1.2 + 134 / 220) ** 2)),
        (speed_factor(limits, 4.0), (0.85 + 0.3 / math.sqrt(8.8), 0.93 + 0.14 / math.sqrt(8.8))),
        (flank_roughness_factor(limits, 6.0, 10.0), (0.5**0.15, 0.5**0.08)),
    ):
        assert (values[0], values[-1]) == pytest.approx(ends, rel=EXACT)
        assert values[limits <= 849] == pytest.approx(ends[0], rel=EXACT)
        assert values[limits >= 1201] == pytest.approx(ends[1], rel=EXACT)
        assert np.abs(np.diff(values)).max() < 3e-5  # over 0.05 MPa
    assert flank_roughness_factor(1500.0, 3.0, 10.0) == 1
    assert lubricant_factor(1500.0, 134 / 0.8) == pytest.approx(1, rel=EXACT)  # 1.2 + 0.8 is 2
    assert speed_factor(1500.0, 10.0) == pytest.approx(1, rel=EXACT)  # 0.8 + 3.2 is 4


def test_work_hardening() -> None:
    assert work_hardening_factor(np.array([100.0, 130, 300, 470, 600]), 3.0) == pytest.approx([1.2, 1.2, 1.1, 1, 1])
    assert work_hardening_factor(130.0, 6.0) == pytest.approx(1.2 * 0.5**0.15, rel=EXACT)
    assert work_hardening_factor(400.0, 16.0) == 1  # a rough pinion wears the wheel
    assert static_work_hardening_factor(np.array([100.0, 300, 500])) == pytest.approx([1.05, 1.025, 1.0])
    assert equivalent_roughness(4.0, 4.0, 10.0, 150.0, 10.0) == pytest.approx(4, rel=EXACT)
    assert equivalent_roughness(np.array([0.5, 60.0]), 4.0, 10.0, 150.0, 10.0).tolist() == [3, 16]
    ratio = np.array([1.0, 1.19, 1.2, 1.5, 1.7, 1.71, 3.0])
    expected = [1, 1, 1 + 4 * 0.002486, 1 + 4 * 0.00518, 1 + 4 * 0.006976, 1 + 4 * 0.00698, 1 + 4 * 0.00698]
    assert through_hardened_factor(200 * ratio, 200.0, 5.0) == pytest.approx(expected, rel=EXACT)
    assert through_hardened_factor(400.0, 200.0, 50.0) == pytest.approx(1 + 19 * 0.00698, rel=EXACT)


def test_flank_size_is_of_din_only() -> None:
    modules = np.array([1.0, 7.5, 10, 12, 30, 50])
    assert flank_size_factor(modules, G.CASE_HARDENED, Edition.ISO_2006).tolist() == [1] * 6
    assert flank_size_factor(modules, G.THROUGH_HARDENED, Edition.DIN_1987).tolist() == [1] * 6
    assert flank_size_factor(modules, G.SURFACE_HARDENED, Edition.DIN_1987) == pytest.approx([1, 1, 1, 0.99, 0.9, 0.9])
    nitrided = flank_size_factor(modules, G.NITROCARBURISED, Edition.DIN_1987)
    assert nitrided == pytest.approx([1, 1, 0.97, 0.948, 0.75, 0.75])


# ---------------------------------------------------------------------- root


def test_root_size() -> None:
    """1 up to 5 mm, without a jump, and least at 30, 25 and 25 mm."""
    modules = np.linspace(0.3, 60, 5971)
    for group, slope, end, least in [("St", 0.006, 30, 0.85), ("NV", 0.01, 25, 0.8), ("GGG (ferr.)", 0.015, 25, 0.7)]:
        expected = 1 - slope * (np.clip(modules, 5, end) - 5)
        assert root_size_factor(modules, MaterialGroup(group)) == pytest.approx(expected, rel=EXACT)
        assert expected[-1] == pytest.approx(least, rel=EXACT)


def test_rough_fillets_are_weaker() -> None:
    """They fall from 1 µm on, and beyond the 40 µm of the standard; below 1 µm the standard has another number."""
    roughness = np.linspace(1, 80, 500)
    for group, smooth in [("V", 1.12), ("Eh", 1.12), ("GTS", 1.12), ("St (cast)", 1.07), ("NT", 1.025), ("GG", 1.025)]:
        of = MaterialGroup(group)
        assert np.all(np.diff(root_surface_factor(roughness, of)) < 0)
        assert root_surface_factor(0.999, of) == root_surface_factor(0.0, of) == smooth
        assert root_surface_factor(1.0, of) == pytest.approx(smooth, abs=0.014)


def test_notch_sensitivity() -> None:
    """1 at q_s = 2.5 whatever the material; falls or rises with strength on either side of it; stays beyond the table."""
    for group in METALS:
        assert notch_sensitivity_factor(2.5, group, 450.0) == pytest.approx(1, rel=EXACT)
    assert notch_sensitivity_factor(4.0, G.NITRIDED) == pytest.approx((1 + math.sqrt(0.1809)) / (1 + math.sqrt(0.1206)))
    strengths = np.linspace(400, 1100, 71)
    blunt, sharp = ([notch_sensitivity_factor(q_s, G.THROUGH_HARDENED, each) for each in strengths] for q_s in (1.5, 4.0))
    assert np.all(np.diff(blunt) >= 0)
    assert np.all(np.diff(sharp) <= 0)
    assert blunt[:11] == [blunt[0]] * 11
    assert sharp[-11:] == [sharp[-1]] * 11
    middle = math.sqrt(0.2 * 9 * 0.0129), math.sqrt(1.2 * 0.0129)  # rho' half way from 600 to 800 MPa
    assert notch_sensitivity_factor(4.0, G.NODULAR_IRON, 700.0) == pytest.approx((1 + middle[0]) / (1 + middle[1]))
    assert cautious_strength(4.0, G.THROUGH_HARDENED) == 1000
    assert cautious_strength(1.5, G.STRUCTURAL_STEEL) == 300
    assert cautious_strength(1.5, G.CASE_HARDENED) is None
    for group, name in ((G.THROUGH_HARDENED_CARBON, "yield_strength"), (G.GREY_IRON, "tensile_strength")):
        with pytest.raises(ParameterError, match=re.escape(f"{name} is missing: must be given for {group.value}")):
            notch_sensitivity_factor(2.0, group)


def test_static_notch_sensitivity() -> None:
    """1 at Y_S = 2 whatever the material."""
    for group in METALS:
        assert static_notch_sensitivity_factor(2.0, group, 500.0) == pytest.approx(1, rel=EXACT)
    at_3 = {"Eh": 1.44, "NT": 1.2, "St (cast)": 1.07, "V (cast)": 1.07, "GG": 1}
    at_3["St"] = (1 + 0.93 * 2) / 1.93  # at 200 MPa
    at_3["V"] = (1 + 0.82 * 2 * (300 / 200) ** 0.25) / (1 + 0.82 * (300 / 200) ** 0.25)
    for group, expected in at_3.items():
        assert static_notch_sensitivity_factor(3.0, MaterialGroup(group), 200.0) == pytest.approx(expected, rel=EXACT)


def test_mean_stress() -> None:
    """R = 0 is one way; alternating with M = 0.3 is 1/(1 + 0.7/1.3)."""
    assert mean_stress_factor(np.array([0.5, 0, -1.0]), 0.3) == pytest.approx([1, 1, 1.3 / 2], rel=EXACT)
    assert mean_stress_sensitivity(G.CASE_HARDENED, 2.0) == pytest.approx(0.5)
    assert mean_stress_sensitivity(G.CASE_HARDENED, 2.0, static=True) == 0.7
    assert mean_stress_sensitivity(G.CASE_HARDENED, 2.0, shot_peened=True) == 0.4
    assert mean_stress_sensitivity(G.NITRIDED, 2.0) == mean_stress_sensitivity(G.NITRIDED, 2.0, static=True) == 0.3
    assert mean_stress_sensitivity(G.THROUGH_HARDENED_CAST, 2.0, static=True) == 0.6
    for iron in (G.GREY_IRON, G.NODULAR_IRON, G.FERRITIC_NODULAR_IRON, G.MALLEABLE_IRON):
        with pytest.raises(ParameterError, match="must be a steel"):
            mean_stress_sensitivity(iron, 2.0)


# ---------------------------------------------------------------------- numbers and arrays


def test_numbers_give_numbers_and_arrays_broadcast() -> None:
    row, column = np.array([800.0, 1000, 1500]), np.array([[100.0], [320.0]])
    table = lubricant_factor(row, column)
    assert table.shape == (2, 3)
    assert type(lubricant_factor(1000.0, 320.0)) is float
    assert table[1, 1] == lubricant_factor(1000.0, 320.0)
    assert type(flank_life_factor(np.float64(1e6), G.NITRIDED)) is float
    assert flank_roughness_factor(1000.0, np.array([3.0, 6.0]), 10.0).shape == (2,)
    assert transition(1e6, row, 1.0, flank_points(G.NITRIDED)).shape == (3,)
    assert math.isnan(root_life_factor(math.nan, G.NITRIDED))


GRADES = [Grade(group, quality) for group in METALS for quality in MaterialQuality]

# Coefficients worked out by hand at the ends of ranges (ISO 6336-5:2016, table 1); Eh MQ and NT MQ are printed by themselves.
TABLE = [
    ("St MQ", 110, 300.0, 119.05),
    ("St ME", 210, 569.2, 228.06),
    ("St (cast) ML", 140, 269.04, 105.82),
    ("GTS ME", 175, 500.275, 198.525),
    ("GGG MQ", 250, 569.5, 206.5),
    ("GGG (ferr.) MQ", 250, 569.5, 206.5),
    ("GG ME", 275, 524.875, 108.0),
    ("V (carbon) MQ", 200, 545.0, 211.0),
    ("V MQ", 300, 766.9, 314.5),
    ("V ME", 390, 1123.07, 370.62),
    ("V (cast carbon) ML", 130, 408.03, 146.12),
    ("V (cast) ME", 360, 842.0, 314.16),
    ("Eh ML", 600, 1300.0, 312.0),
    ("Eh MQ", None, 1500.0, 425.0),
    ("Eh ME", 720, 1650.0, 525.0),
    ("IF ML", 485, 960.9, 223.925),
    ("IF MQ", 615, 1214.715, 368.66),
    ("NT MQ", None, 1250.0, 420.0),
    ("NV ME", 450, 1217.0, 432.0),
    ("NV (nitrocar.) ML", 300, 650.0, 224.0),
    ("NV (nitrocar.) MQ", 650, 950.15, 387.85),
]


@pytest.mark.parametrize(("name", "hardness", "contact", "root"), TABLE, ids=[row[0] for row in TABLE])
def test_limits_of_grades(name: str, hardness: float | None, contact: float, root: float) -> None:
    found = endurance_limits(Material(name=name, hardness=hardness))
    assert (found.contact, found.root) == pytest.approx((contact, root), rel=1e-12)
    assert found.verify == ("sigma_Hlim", "sigma_Flim")
    assert name in found.contact_source


LINES = """
St: 110-210 110-210 110-210: 1 190 1 190 1.52 250: 0.455 69 0.455 69 0.386 147
St (cast): 140-210 140-210 140-210: 0.986 131 0.986 131 1.143 237: 0.313 62 0.313 62 0.254 137
GTS: 135-250 135-250 175-250: 1.371 143 1.371 143 1.333 267: 0.345 77 0.345 77 0.403 128
GGG: 175-300 175-300 200-300: 1.434 211 1.434 211 1.5 250: 0.35 119 0.35 119 0.38 134
GG: 150-240 150-240 175-275: 1.033 132 1.033 132 1.465 122: 0.256 8 0.256 8 0.2 53
V: 200-360 200-360 200-390: 1.313 188 1.313 373 2.213 260: 0.423 104 0.425 187 0.358 231
V (cast carbon): 130-215 130-215 130-215: 0.831 300 0.831 300 0.951 345: 0.224 117 0.224 117 0.286 167
V (cast): 200-360 200-360 200-360: 1.276 298 1.276 298 1.35 356: 0.364 161 0.364 161 0.356 186
Eh: 600-800 660-800 660-800: 0 1300 0 1500 0 1650: 0 312 0 425 0 525
NT: 650-900 650-900 650-900: 0 1125 0 1250 0 1450: 0 270 0 420 0 468
NV: 450-650 450-650 450-650: 0 788 0 998 0 1217: 0 258 0 363 0 432
"""
"""ISO 6336-5:2016, table 1: hardness of ML, MQ and ME; A and B of the contact, and of the root, of each. Groups of one line."""


@pytest.mark.parametrize("row", LINES.strip().splitlines(), ids=lambda row: row.split(":")[0])
def test_lines_hold_over_their_ranges_and_no_further(row: str) -> None:
    group, ranges, contact, root = (part.split() for part in row.split(":"))
    for place, (quality, both) in enumerate(zip(("ML", "MQ", "ME"), ranges, strict=True)):
        name, (least, most) = f"{' '.join(group)} {quality}", (float(end) for end in both.split("-"))
        for hardness in (least, most):
            found = endurance_limits(Material(name=name, hardness=hardness))
            lines = [[float(each) for each in line[2 * place : 2 * place + 2]] for line in (contact, root)]
            expected = [slope * hardness + constant for slope, constant in lines]
            assert [found.contact, found.root] == pytest.approx(expected, rel=1e-12)
        for hardness in (least - 0.1, most + 0.1):
            with pytest.raises(ParameterError, match=rf"must be from {least:g} to {most:g} H"):
                endurance_limits(Material(name=name, hardness=hardness))


def test_a_plastic_has_no_factors_of_metals() -> None:
    with pytest.raises(GeometryError, match=r"^material\.group = 'plastic': must be a metal"):
        flank_points(G.PLASTIC)


def test_names_stand_for_grades() -> None:
    assert [grade_of(str(grade)) for grade in GRADES] == GRADES
    assert [grade_of(name) for name in ("steel", "Eh", "eh MQ", "Eh MX", "EhMQ", "MQ Eh", "18CrNiMo7-6 Eh MQ")] == [None] * 7
    made = Material(name="GGG (ferr.) ML")
    assert (made.group, made.quality) == (MaterialGroup.FERRITIC_NODULAR_IRON, MaterialQuality.MODEST)
    with pytest.raises(GeometryError, match=r"group = 'V': must be Eh, or left out, with the name Eh MQ"):
        Material(name="Eh MQ", group=MaterialGroup.THROUGH_HARDENED)


def test_better_quality_endures_no_less() -> None:
    """At hardnesses that all qualities of a group know."""
    for group in METALS:
        for hardness in range(100, 900, 5):
            found = []
            for quality in MaterialQuality:
                try:
                    found.append(endurance_limits(Material(group=group, quality=quality, hardness=hardness)))
                except ParameterError:
                    break
            if len(found) == len(MaterialQuality):
                contacts, roots = [each.contact or 0 for each in found], [each.root or 0 for each in found]
                assert contacts == sorted(contacts), (group, hardness)
                assert roots == sorted(roots), (group, hardness)


def test_given_limits_win() -> None:
    found = endurance_limits(Material(name="Eh MQ", hardness=300.0, contact_endurance_limit=1400.0, root_endurance_limit=400.0))
    assert (found.contact, found.root, found.verify) == (1400.0, 400.0, ())
    half = endurance_limits(Material(name="Eh MQ", root_endurance_limit=430.0))
    assert (half.contact, half.root, half.verify) == (1500.0, 430.0, ("sigma_Hlim",))


@pytest.mark.parametrize(
    ("material", "lacking"), [(Material(), "group"), (Material(group=MaterialGroup.CASE_HARDENED), "quality")]
)
def test_unknown_limits_say_why(material: Material, lacking: str) -> None:
    found = endurance_limits(material)
    assert (found.contact, found.root) == (None, None)
    assert f"no {lacking}" in found.root_source


def test_core_of_case_hardened_steel() -> None:
    roots = [endurance_limits(Material(name="Eh MQ", core_hardness=core)).root for core in (25.0, 29.9, 30.0, 40.0)]
    assert roots == [425.0, 425.0, 500.0, 500.0]
    assert endurance_limits(Material(name="Eh ME", core_hardness=20.0)).root == 525.0
    with pytest.raises(ParameterError, match=r"material\.core_hardness = 24 HRC: must be at least 25 HRC for Eh MQ"):
        endurance_limits(Material(name="Eh MQ", core_hardness=24.0))


def test_hardness_out_of_range_names_it() -> None:
    with pytest.raises(ParameterError) as caught:
        endurance_limits(Material(name="Eh MQ", hardness=500.0))
    expected = "material.hardness = 500 HV: must be from 660 to 800 HV, for which ISO 6336-5:2016 has limits of Eh MQ"
    assert str(caught.value) == expected
    with pytest.raises(ParameterError, match=r"material\.hardness is missing: must be given, from 200 to 360 HV"):
        endurance_limits(Material(name="V MQ"))
    with pytest.raises(ParameterError, match=r"from 115 to 215 HV"):
        endurance_limits(Material(name="V (carbon) MQ", hardness=220.0, contact_endurance_limit=500.0))
    with pytest.raises(ParameterError, match=r"wheel\.material\.hardness = 700 HV"):
        endurance_limits_of(PerGear(Material(name="Eh MQ"), Material(name="V MQ", hardness=700.0)))
    assert {hardness_scale(group) for group in (MaterialGroup.GREY_IRON, MaterialGroup.NODULAR_IRON)} == {"HBW"}
