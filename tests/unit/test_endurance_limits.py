"""ISO 6336-5: limits of groups, qualities and hardness, which win where they are given, and what is refused."""

from __future__ import annotations

import pytest

from gearcad import GeometryError, Material, ParameterError
from gearcad.core.records import PerGear
from gearcad.material import Grade, MaterialGroup, MaterialQuality, grade_of
from gearcad.rating.material_limits import endurance_limits, endurance_limits_of, hardness_scale

GRADES = [Grade(group, quality) for group in MaterialGroup for quality in MaterialQuality]

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


def test_names_stand_for_grades() -> None:
    assert [grade_of(str(grade)) for grade in GRADES] == GRADES
    assert [grade_of(name) for name in ("steel", "Eh", "eh MQ", "Eh MX", "EhMQ", "MQ Eh", "18CrNiMo7-6 Eh MQ")] == [None] * 7
    made = Material(name="GGG (ferr.) ML")
    assert (made.group, made.quality) == (MaterialGroup.FERRITIC_NODULAR_IRON, MaterialQuality.MODEST)
    with pytest.raises(GeometryError, match=r"group = 'V': must be Eh, or left out, with the name Eh MQ"):
        Material(name="Eh MQ", group=MaterialGroup.THROUGH_HARDENED)


def test_better_quality_endures_no_less() -> None:
    """At hardnesses that all qualities of a group know."""
    for group in MaterialGroup:
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
