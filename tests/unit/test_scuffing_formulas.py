"""Scuffing temperatures against formulas that were not derived from the same code, and against printed numbers."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from support.scuffing import EH, Factors, pair, scuffed

from gearcad import FlankModification, Gear, GearPair, Material, ParameterError
from gearcad.core import symbols
from gearcad.core.records import PerGear, Role
from gearcad.material import MaterialGroup
from gearcad.rating import RatingOptions
from gearcad.rating.options import OilType
from gearcad.rating.scuffing import Risk, flash_risk, integral_risk
from gearcad.rating.scuffing_temperatures import (
    Oil,
    SlidingMesh,
    approach_factor,
    contact_ratio_factor,
    helical_load_factor,
    kinematic_viscosity,
    stage_torque,
    structure_factor,
    thermo_elastic_factor,
    tip_relief_factor,
    usual_viscosity_100,
)

EXACT = 1e-12
HELICAL, SPUR = pair(), pair((16, 24), module=4.5, shifts=(0.1817, 0.1715), helix=0.0, width=14.0)
RING = pair((20, -60), shifts=(0.2, 0.2), helix=0.0)


@pytest.mark.parametrize("gears", [HELICAL, SPUR, RING])
def test_flash_is_that_of_blok(gears: GearPair) -> None:
    """1.11 mu w |sqrt(v1) - sqrt(v2)|/(B_M sqrt(2 b_H)) of Hertz's band at each place, from radii and speeds alone.

    The standard rounds 1.11/(2 sqrt(2/pi))^0.5 = 0.621 to 0.51 x 1.22, and takes v_t at the working pitch circle with an
    X_alpha_beta that belongs to the reference circle: both are taken off.
    """
    found = scuffed(gears).flash
    assert found is not None
    lean, a_t = (math.radians(each) for each in (gears.pinion.base_helix_angle, gears.pinion.transverse_pressure_angle))
    along = (found.path.places + 1) * gears.path_of_contact.C
    turning = 2 * math.pi * 1500 / 60
    rolled = [turning * along / 1000, turning / gears.gear_ratio * (gears.base_tangent.length - along) / 1000]
    radius = along * (gears.base_tangent.length - along) / gears.base_tangent.length / math.cos(lean)
    load = found.path.shares * found.specific_load / math.cos(a_t)
    band = np.sqrt(8 * load * radius / (math.pi * 206000 / 0.91))
    heat = 1.11 * found.friction * load * np.abs(np.sqrt(rolled[0]) - np.sqrt(rolled[1])) / np.sqrt(2 * band)
    blok = heat * math.sqrt(1000) / math.sqrt(50 * 3.8) * found.approach_factor
    a_wt = math.radians(gears.working_transverse_pressure_angle)
    rounding = 0.51 * 1.22 * math.sqrt(math.cos(a_t) / math.cos(a_wt)) / (1.11 / math.sqrt(2 * math.sqrt(8 / math.pi)))
    assert found.flash == pytest.approx(rounding * blok, rel=1e-3, abs=1e-9)


@pytest.mark.parametrize(("stage", "torque"), [(5, 94.1), (8, 239.3), (12, 534.5)])
def test_test_gears_have_the_mean_flash_temperature_of_the_test(stage: int, torque: float) -> None:
    """FZG gears A (ISO 14635-1) at 8.3 m/s and 90 °C: 0.2 T_1T K, which (96) of ISO/TR 13989-2 was fitted to.

    It grows as T, our friction and heat as T^0.95, so they can agree to a tenth; Ra 0.4 µm is in the middle of the test's.
    """
    shared = {"normal_module": 4.5, "face_width": 20.0, "flank_roughness": 2.4}
    test = GearPair(
        pinion=Gear(teeth=16, profile_shift=0.8532, tip_diameter=88.77, **shared),
        wheel=Gear(teeth=24, profile_shift=-0.5, tip_diameter=112.5, **shared),
        centre_distance=91.5,
    )
    alone = Factors(1.0, 1.0, 1.0, 1.0, 1.0)
    oil = {"oil_viscosity_40": 100.0, "oil_viscosity_100": 11.0, "oil_temperature": 90.0, "scuffing_stage": stage}
    found = scuffed(test, torque=torque, speed=2175, factors=alone, **oil)
    assert stage_torque(stage) == torque
    assert found.integral is not None
    assert found.integral.mean_flash == pytest.approx(0.2 * torque, rel=0.1)


REPORTS = {"w_Bt": 516.8309, "K_Bgamma": 1.2852, "mu_mC": 0.0941, "X_BE": 0.3186, "X_eps": 0.2711, "theta_int": 142.308}
FLASHES = {"mu_m": 0.0764, "X_L": 0.8271, "Gamma_A": -0.3616, "Gamma_E": 0.6184, "theta_flmax": 82.9555, "theta_S": 347.9828}


def test_helical_pair_of_an_independent_program() -> None:
    """21/42 teeth at 68 mm, by a program written from the same equations elsewhere, which knows no FZG torques."""
    gears = pair(shifts=(0.5, 0.0002))
    document = scuffed(replace(gears, centre_distance=68.0)).to_dict()
    for name, value in REPORTS.items():
        assert document["integral"][name] == pytest.approx(value, rel=5e-4)
    for name, value in FLASHES.items():
        assert document["flash"][name] == pytest.approx(value, rel=5e-4)
    # its trapezoids have 400 steps, and theta_intS has 3.726 FZG² in place of the torque of the test
    assert document["flash"]["theta_flm"] == pytest.approx(31.224, rel=5e-3)
    assert document["integral"]["S_int"] == pytest.approx(2.5427, rel=5e-3)


def test_printed_factors() -> None:
    """Two KISSsoft reports print X_R 0.7746 of Ra 0.6 µm and X_M 50.0; tables 2 and A.1 X_alpha_beta 0.978 and 0.966."""
    found = scuffed(HELICAL).flash
    assert found is not None
    assert found.roughness_factor == pytest.approx(0.7746, abs=5e-5)
    assert thermo_elastic_factor(EH) == pytest.approx(50.0, abs=0.1)
    for helix, printed in ((0.0, 0.978), (20.0, 0.966)):
        across = math.degrees(math.atan(math.tan(math.radians(20)) / math.cos(math.radians(helix))))
        mesh = replace(
            SlidingMesh.of(SPUR, SPUR.total_contact_ratio),
            helix_angle=helix,
            working_pressure_angle=20.0,
            transverse_pressure_angle=across,
        )
        assert mesh.angle_factor == pytest.approx(printed, abs=6e-4)


def test_mean_over_the_path_is_continuous_and_symmetric() -> None:
    """X_eps epsilon_1 changes by nothing where its cases meet, nor where recess and approach are exchanged."""
    places = [(1.0, 0.4), (0.4, 1.0), (0.3, 0.7), (0.55, 0.45), (1.0, 1.0), (1.4, 0.6), (0.6, 1.4)]
    for e_1, e_2 in places:
        near = [contact_ratio_factor(e_1 * change, e_2 * change) for change in (1 - 1e-9, 1 + 1e-9)]
        assert near[0] == pytest.approx(near[1], rel=1e-7)
        assert contact_ratio_factor(e_1, e_2) * e_1 == pytest.approx(contact_ratio_factor(e_2, e_1) * e_2, rel=EXACT)
    # alone on the path the flash falls in proportion to the distance from the pitch point
    assert contact_ratio_factor(0.3, 0.3) == pytest.approx(0.5, rel=EXACT)


def test_integral_temperature_of_many_meshes_is_that_of_each() -> None:
    """Arrays in, arrays out, the same numbers."""
    helices, torques = (0.0, 8.0, 20.0), (20.0, 200.0, 900.0)
    each = [scuffed(pair(helix=helix), torque=torque).integral for helix, torque in zip(helices, torques, strict=True)]
    meshes = [found.mesh for found in each if found is not None]
    names = [field.name for field in fields(SlidingMesh) if field.name != "driver"]
    together = SlidingMesh(**{name: np.array([getattr(mesh, name) for mesh in meshes]) for name in names})
    assert each[0] is not None
    varied = {name: np.array([getattr(found, name) for found in each]) for name in ("specific_load", "speed", "relief")}
    found = replace(each[0], mesh=together, **varied)
    assert found.value == pytest.approx([one.value for one in each if one is not None], rel=EXACT)


def test_factors_at_their_limits() -> None:
    """K_Bgamma, X_Q and X_Ca where they begin and end."""
    assert [helical_load_factor(e) for e in (1.0, 2.0, 2.5, 3.5, 5.0)] == pytest.approx(
        [1, 1, 1 + 0.2 * math.sqrt(1.25), 1.3, 1.3]
    )
    assert [approach_factor(1.0, e) for e in (0.5, 1.5, 2.25, 3.0, 9.0)] == pytest.approx([1, 1, 0.8, 0.6, 0.6])
    assert tip_relief_factor(0.8, 0.6, 0.0) == pytest.approx(1 + 0.06 * 0.8 + 0.02 * 0.64)
    assert tip_relief_factor(0.8, 0.6, 2.0) == tip_relief_factor(0.8, 0.6, 1.0) == pytest.approx(1 + 0.24 * 0.8 + 0.71 * 0.64)
    nitrided = PerGear(Material(group=MaterialGroup.NITRIDED), Material(group=MaterialGroup.NITRIDED))
    assert (structure_factor(EH), structure_factor(nitrided), structure_factor(PerGear(EH.pinion, nitrided.wheel))) == (
        1,
        1.5,
        1,
    )
    assert [integral_risk(each) for each in (0.99, 1.0, 2.0, 2.01)] == [Risk.HIGH, Risk.CRITICAL, Risk.CRITICAL, Risk.LOW]
    assert [flash_risk(each) for each in (-1.0, 0.0, 49.9, 50.0)] == [Risk.HIGH, Risk.CRITICAL, Risk.CRITICAL, Risk.LOW]


def test_oil() -> None:
    """Walther's line goes through both points; data sheets of oils of viscosity index 96 and 97 (Mobilgear 600 XP)."""
    assert kinematic_viscosity(220.0, 19.0, 40.0) == pytest.approx(220.0, rel=EXACT)
    assert kinematic_viscosity(220.0, 19.0, 100.0) == pytest.approx(19.0, rel=EXACT)
    for viscosity_40, viscosity_100 in ((100.0, 11.2), (220.0, 19.0), (460.0, 30.6)):
        assert usual_viscosity_100(viscosity_40) == pytest.approx(viscosity_100, rel=0.015)
    assert usual_viscosity_100(3000.0) == pytest.approx(2 * 64.213, rel=EXACT)
    with pytest.raises(ParameterError, match=r"^oil_viscosity_100.*an oil below 10 mm²/s at 40 °C, here 5 mm²/s"):
        usual_viscosity_100(5.0)
    assert stage_torque(13) == pytest.approx(3.726 * 169)
    assumed = Oil.of(RatingOptions())
    assert (assumed.viscosity_40, assumed.temperature, len(assumed.assumed)) == (220.0, 70.0, 5)
    known = {"oil_viscosity_40": 100.0, "oil_viscosity_100": 11.0, "oil_temperature": 60.0, "oil_density": 880.0}
    assert not Oil.of(RatingOptions(**known, oil_type=OilType.POLYALPHAOLEFIN)).assumed


def test_relief_and_approach() -> None:
    """Tip relief of the wheel lowers the mean flash, and the shock of the approach, until it is what the load asks for."""
    gears = replace(HELICAL, wheel=replace(HELICAL.wheel, modification=FlankModification(tip_relief=10, tip_relief_length=1.5)))
    plain, relieved = (scuffed(each, torque=900).to_dict() for each in (HELICAL, gears))
    assert relieved["integral"]["X_Ca"] > plain["integral"]["X_Ca"]
    assert relieved["integral"]["theta_int"] < plain["integral"]["theta_int"]
    found = scuffed(SPUR, torque=400).flash
    assert found is not None
    first = -found.path.places[0] / found.path.extent
    assert found.approach_factor[0] == pytest.approx(1 + found.relief_wanting / 50 * first**3)
    assert np.all(found.approach_factor[found.path.places >= 0] == 1)


def test_a_pair_of_equal_gears_does_not_know_which_of_them_drives() -> None:
    """Where the wheel drives, all that was before the pitch point is after it: of unequal addenda the shock moves too."""
    equal = pair((30, 30), shifts=(0.2, 0.2))
    both = [scuffed(equal, driver=role).to_dict() for role in Role]
    assert both[0]["integral"]["theta_int"] == pytest.approx(both[1]["integral"]["theta_int"], rel=EXACT)
    assert both[0]["flash"]["theta_B"] == pytest.approx(both[1]["flash"]["theta_B"], rel=1e-9)
    uneven = pair((30, 30), shifts=(-0.3, 0.6))
    mirrored = replace(uneven, pinion=replace(uneven.wheel, helix_angle=20.0), wheel=replace(uneven.pinion, helix_angle=-20.0))
    first, second = scuffed(uneven, torque=900).to_dict(), scuffed(mirrored, torque=900, driver=Role.WHEEL).to_dict()
    assert first["integral"]["X_Q"] == pytest.approx(second["integral"]["X_Q"], rel=EXACT)
    assert first["integral"]["X_Q"] < 1
    assert first["flash"]["theta_B"] == pytest.approx(second["flash"]["theta_B"], rel=1e-9)
    assert scuffed(mirrored, torque=900).to_dict()["integral"]["X_Q"] == pytest.approx(1, rel=EXACT)


def test_every_number_has_a_symbol() -> None:
    """Documents and words name the same things."""
    document = scuffed(HELICAL).to_dict()
    nested = {f"{part}.{name}" for part in ("oil", "integral", "flash") for name in document[part] if name != "path"}
    assert nested | {"risk"} == set(symbols.SCUFFING)
