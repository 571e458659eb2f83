"""K_v of ISO 6336-1, Method B: its equations, what of them the load changes, and the tolerances that go into it."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.cases import STEEL
from support.commands import read_json
from support.published import Published
from support.specs import TEMPLATES

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear
from gearcad.designs import read_spec
from gearcad.geometry import FlankModification
from gearcad.material import MaterialGroup
from gearcad.rating import Accuracy, DynamicFactor, RatingOptions, RunningIn, running_in_alpha
from gearcad.rating.load_factor_formulas import running_factors
from gearcad.rating.tolerances import flank_tolerances

EXACT = 1e-12
"""Relative: the same quantity by two formulas."""

METHOD_B = DynamicFactor(
    teeth=20,
    total_contact_ratio=1.6,
    single_stiffness=14.0,
    mesh_stiffness=20.0,
    reduced_mass=0.02,
    specific_load=400.0,
    pitch_deviation=8.0,
    profile_deviation=6.0,
)


def test_method_b() -> None:
    """By hand: B_p = 0.28, B_f = 0.21, B_k = 1; n_E1 = 30000/(20 pi) sqrt(1000) = 15098.7 rpm."""
    resonance = METHOD_B.resonance_speed
    assert resonance == pytest.approx(30000 / (20 * math.pi) * math.sqrt(1000))
    below, main, above = 1.1955, 2.061, 0.2303 + 0.125 * math.sin(-0.4 * math.pi) + 0.875
    speeds = resonance * np.array([0.0, 0.5, 0.86, 1.149, 1.325, 1.5, 3.0])
    assert METHOD_B.values(speeds) == pytest.approx([1, below, main, main, (main + above) / 2, above, above])
    relieved = replace(METHOD_B, tip_relief=400 / 14)
    assert relieved.values(0.9 * resonance) == pytest.approx(main - 0.9)
    light = replace(METHOD_B, specific_load=25.0)
    rising, also_rising, flat, also_flat = light.values(resonance * np.array([0.67, 0.674, 0.676, 0.68]))  # from 0.675 on: main
    assert rising < also_rising < flat == also_flat


def test_running_factors() -> None:
    """Table 8: nearly continuous at a contact ratio of 2, where the printed constants change."""
    low, high = running_factors(2.0), running_factors(2.0 + 1e-9)
    assert high == pytest.approx(low, abs=0.07)
    assert running_factors(1.4).c_v7 == 0.75 == running_factors(1.5 + 1e-9).c_v7
    assert running_factors(2.5 + 1e-9).c_v7 == 1.0 == pytest.approx(running_factors(2.5).c_v7)


# ---------------------------------------------------------------------- the load

LIGHT = GearPair(
    pinion=Gear(teeth=30, normal_module=2.0, face_width=20.0), wheel=Gear(teeth=61, normal_module=2.0, face_width=25.0)
)
"""8 N·m are 2000 * 8/(60 * 20) = 13.33 N/mm; 1 m/s is 318.3 rpm."""

INERTIAS = PerGear(2e-4, 4e-3)


def test_low_load_softens_the_mesh() -> None:
    """c' and c_gamma fall with the fourth root below 100 N/mm (90), so n_E1 with the eighth; B_p and B_f with the fourth."""
    light, heavy = (DynamicFactor.of(LIGHT, STEEL, Load(torque=torque), INERTIAS) for torque in (8.0, 80.0))
    assert heavy.specific_load == pytest.approx(10 * light.specific_load) == pytest.approx(400 / 3)
    factor = (40 / 3 / 100) ** 0.25
    assert light.resonance_speed / heavy.resonance_speed == pytest.approx(math.sqrt(factor), rel=EXACT)
    assert math.sqrt(factor) == pytest.approx(5865 / 7545, rel=1e-4)
    for soft, stiff in zip(light.effects(0.0)[:2], heavy.effects(0.0)[:2], strict=True):
        assert soft / stiff == pytest.approx(10 * factor, rel=EXACT)


def test_resonance_speed_of_the_alm_starter() -> None:
    """94.07 N/mm: it was 37,624 rpm with the stiffness of high loads; the inertias are those of the solids."""
    design = read_spec(TEMPLATES / "alm-18-161.toml")
    found = DynamicFactor.of(design.pair, STEEL, design.load, PerGear(6.8607e-6, 0.024773))
    assert found.resonance_speed == pytest.approx(37338, abs=1)


# ---------------------------------------------------------------------- other programs

PUBLIC: dict[str, dict[str, Any]] = {
    case["id"]: case for case in read_json(Path(__file__).parents[1] / "data" / "rating_public.json")
}
"""What reports of other programs print."""


def printed(name: str) -> dict[str, Any]:
    """Printed values of a case, with their tolerance."""
    return {each["quantity"]: pytest.approx(each["value"], abs=each["tol"]) for each in PUBLIC[name]["expected"]}


def test_stiffness_and_resonance_of_another_program(published: Published) -> None:
    """Its wheel is a body of the pinion's form, u² times as heavy along the line of action."""
    given, expected = PUBLIC["helical_25_40_fva"]["inputs"], PUBLIC["helical_25_40_fva"]["expected"]
    pinion, wheel = (
        Gear(teeth=teeth, normal_module=2.0, helix_angle=helix, face_width=26.0, rack=BasicRack(dedendum=1.3, root_radius=0.3))
        for teeth, helix in ((25, 20.0), (40, -20.0))
    )
    middle = (given["tip_diameter_1_mm"] + given["root_diameter_1_mm"]) / 2
    mass = math.pi / 8 * 1e-9 * given["density_kg_m3"] * middle**4 / pinion.base_diameter**2
    masses = (mass, mass * 1.6**2)
    inertias = [each * 26 * (gear.base_diameter / 2000) ** 2 for each, gear in zip(masses, (pinion, wheel), strict=True)]
    load = Load(torque=given["tangential_force_n"] * pinion.reference_diameter / 2000)
    found = DynamicFactor.of(GearPair(pinion=pinion, wheel=wheel), STEEL, load, PerGear(*inertias))
    values = (found.single_stiffness, found.mesh_stiffness, found.reduced_mass, found.resonance_speed)
    for value, of in zip(values, expected, strict=True):
        published(
            of["quantity"],
            value,
            of["value"],
            of["tol"],
            "FVA Workbench, helical 25/40, as quoted by github tkuhn39/semesterthesis",
        )


def test_running_in_of_another_program() -> None:
    soft, iron, hard = RunningIn
    assert {
        "y_alpha V sigma_Hlim 1500, f_pb 7.7": float(running_in_alpha(7.7, soft, 3.0, 1500.0)),
        "y_alpha same, f_pb 120, v 15 (cap f_pb 40)": float(running_in_alpha(120.0, soft, 15.0, 1500.0)),
        "y_alpha GG, f_pb 10": float(running_in_alpha(10.0, iron, 3.0)),
        "y_alpha Eh, f_pb 10": float(running_in_alpha(10.0, hard, 3.0)),
    } == printed("formula_anchors")


# ---------------------------------------------------------------------- running in

COARSE = RatingOptions(accuracy_grade=12)
"""f_pt = 61 µm for both gears: d over 50 to 125 mm, m_n up to 2 mm."""

FIRST = 61 * math.cos(math.radians(20))
"""f_pb (µm) of both gears."""


@pytest.mark.parametrize(
    ("group", "worn"),
    [
        # At 4, 8 and 12 m/s.
        ("Eh", (3.0, 3.0, 3.0)),
        ("IF", (3.0, 3.0, 3.0)),
        ("NT", (3.0, 3.0, 3.0)),
        ("NV", (3.0, 3.0, 3.0)),
        ("GG", (0.275 * FIRST, 0.275 * FIRST, 11.0)),
        ("GGG (ferr.)", (0.275 * FIRST, 0.275 * FIRST, 11.0)),
        ("St", (160 / 300 * FIRST, 160 / 300 * FIRST, 6400 / 300)),
        ("V", (160 / 300 * FIRST, 160 / 300 * FIRST, 6400 / 300)),
        ("GGG", (160 / 300 * FIRST, 160 / 300 * FIRST, 6400 / 300)),
        ("GTS", (160 / 300 * FIRST, 160 / 300 * FIRST, 6400 / 300)),
    ],
)
def test_groups_run_in_at_their_speeds(group: str, worn: tuple[float, float, float]) -> None:
    """y_alpha has its caps: 3 µm for hard flanks, and by speed for the others."""
    material = Material(group=group, contact_endurance_limit=300.0)  # type: ignore[arg-type]
    found = DynamicFactor.of(LIGHT, material, Load(torque=80.0), INERTIAS, COARSE)
    assert found.pitch_deviation == pytest.approx(FIRST, rel=EXACT)
    speeds = np.array([4.0, 8.0, 12.0]) * 60_000 / (math.pi * 60)
    unit = found.single_stiffness / found.specific_load
    assert found.effects(speeds)[0] == pytest.approx(unit * (FIRST - np.array(worn)), rel=EXACT)
    assert found.warnings == ()


def test_caps_by_speed() -> None:
    soft, iron, hard = ([float(running_in_alpha(100.0, kind, v, 400.0)) for v in (5.0, 10.0, 10.1)] for kind in RunningIn)
    expected = [*(40.0, 32.0, 16.0), *(27.5, 22.0, 11.0), *(3.0, 3.0, 3.0)]
    assert [*soft, *iron, *hard] == pytest.approx(expected, rel=EXACT)


def test_no_more_wears_off_than_there_is() -> None:
    assert running_in_alpha(10.0, RunningIn.THROUGH_HARDENED, [1.0, 20.0], 120.0).tolist() == [10.0, 10.0]


def test_a_material_without_group_wears_least_and_is_told() -> None:
    plain, hard = (
        DynamicFactor.of(LIGHT, material, Load(torque=80.0), INERTIAS)
        for material in (STEEL, Material(group=MaterialGroup.CASE_HARDENED))
    )
    assert replace(plain, notices=()) == hard
    assert "the material has no group" in plain.warnings[0]


def test_through_hardened_flanks_need_their_endurance_limit() -> None:
    with pytest.raises(ParameterError, match=r"material\.contact_endurance_limit is missing: must be given for material"):
        DynamicFactor.of(LIGHT, Material(group="V"), Load(torque=80.0), INERTIAS)  # type: ignore[arg-type]


def test_tip_relief_counts_in_fine_grades_only() -> None:
    """From grade 6 on B_k is 1; in finer ones C_a is that of design, or what running in makes of it."""
    relieved = replace(
        LIGHT,
        **{
            name: replace(getattr(LIGHT, name), modification=FlankModification(tip_relief=relief, tip_relief_length=1.0))
            for name, relief in (("pinion", 20.0), ("wheel", 12.0))
        },
    )
    hard = Material(group="Eh", contact_endurance_limit=1500.0)  # type: ignore[arg-type]
    run_in = (1500 / 97 - 18.45) ** 2 / 18 + 1.5
    for pair, grade, relief in ((relieved, 6, 0.0), (relieved, 5, 12.0), (LIGHT, 5, run_in), (LIGHT, 6, 0.0)):
        found = DynamicFactor.of(pair, hard, Load(torque=80.0), INERTIAS, RatingOptions(accuracy_grade=grade))
        unit = found.single_stiffness / found.specific_load
        assert found.effects(0.0)[2] == pytest.approx(abs(1 - unit * relief), rel=EXACT)


# ---------------------------------------------------------------------- tolerances


def test_flank_tolerances_of_2013() -> None:
    """(5) to (8) by hand for d = 100 mm, m_n = 2.5 mm: 6.1, 19.45, 5.1, 6.375; a class more is the square root of 2 more."""
    fifth, ninth = (flank_tolerances(each, 100.0, 2.5, Accuracy.ISO_2013) for each in (5, 9))
    assert fifth == (6.0, 19.0, 5.0, 6.5)
    assert ninth == (24.0, 78.0, 20.0, 26.0)
    assert flank_tolerances(6, 120.0, 3.0, Accuracy.ISO_2013).single_pitch == printed("iso1328_2013_class6")["f_pT_um"]
    with pytest.raises(ParameterError, match="accuracy_grade"):
        flank_tolerances(12, 100.0, 2.5, Accuracy.ISO_2013)


def test_flank_tolerances_of_1995() -> None:
    """Tables 1 and 2 for d over 50 to 125 mm: f_pt of m over 2 to 3.5 mm, grades 0 to 12; the rest of grades 5 and 6."""
    found = [flank_tolerances(grade, 125.0, 3.5) for grade in range(13)]
    assert [each.single_pitch for each in found] == [1.0, 1.5, 2.1, 2.9, 4.1, 6.0, 8.5, 12, 17, 23, 33, 47, 66]
    assert found[5] == (6.0, 19.0, 5.0, 6.0)
    assert found[6] == (8.5, 27.0, 7.0, 8.5)
    assert flank_tolerances(5, 50.001, 2.001) == found[5] != flank_tolerances(5, 125.001, 3.5)
    with pytest.raises(ParameterError, match=r"normal_module = 0.4 mm: must be a number at least 0.5 mm"):
        flank_tolerances(5, 50.0, 0.4)
