"""Gears of plastic by VDI 2736-2, against the printed report of a pair, and against closed forms."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from support.specs import TEMPLATES

from gearcad import Load, Material
from gearcad.core.records import PerGear, Verdict
from gearcad.core.shelf_tables import ShelfName
from gearcad.designs import PairDesign, read_spec
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating, rate_strength

FILE = Path(__file__).parents[1] / "data" / "plastics.json"
CASE: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))["case"]

TORQUE = CASE["inputs"]["power_W"] / (2250 * 2 * math.pi / 60)
"""N·m: 2250 rpm is what power, velocity and working pitch circle of the report give; its torque is rounded to two digits."""


@pytest.fixture(scope="module")
def design() -> PairDesign:
    found = read_spec(TEMPLATES / "plastic-51-52.toml")
    assert isinstance(found, PairDesign)
    return found


def rated(
    design: PairDesign, material: Material | None = None, load: dict[str, Any] | None = None, **options: Any
) -> StrengthRating:
    """Rate the pair with another wheel's material, changes of the load, and changes of the options."""
    assert design.load is not None
    assert design.rating is not None
    materials = PerGear(design.materials.pinion, material or design.materials.wheel)
    return rate_strength(design.pair, materials, replace(design.load, **(load or {})), replace(design.rating, **options))


def test_starter_is_the_given_case(design: PairDesign) -> None:
    given, load, options = CASE["inputs"], design.load, design.rating
    assert load is not None
    assert options is not None
    for at, (gear, material) in enumerate(zip(design.pair.gears, design.materials, strict=True)):
        assert [gear.teeth, gear.profile_shift, gear.face_width] == [
            given[key][at] for key in ("teeth", "profile_shift", "face_width")
        ]
        assert gear.tip_form_diameter == given["usable_tip_diameter"][at]
        assert [gear.rack.dedendum, gear.rack.root_radius] == [given["tool_addendum"][at], given["tool_tip_radius"][at]]
        assert [material.youngs_modulus, material.poisson_ratio] == [given["E"][at], given["nu"][at]]
    assert design.materials.wheel.wear_coefficient == given["k_w"]
    assert load.torque == pytest.approx(TORQUE, abs=5e-4)
    assert [load.ambient_temperature, load.duty] == [given["ambient"], given["ED"]]
    assert [load.housing_resistance, load.housing_area] == [given["R_lambda_G"], given["A_G"]]
    assert options.friction == given["friction"]
    assert list(options.load_cycles or ()) == given["cycles"]  # type: ignore[arg-type]


def test_printed_digits_of_the_report(design: PairDesign) -> None:
    expected, within = CASE["expected"], CASE["tolerance"]
    found = rated(design, load={"torque": TORQUE}).to_dict()["plastic"]
    assert found["eps_1"] == pytest.approx(expected["eps_1"], abs=within["eps"])
    assert found["eps_2"] == pytest.approx(expected["eps_2"], abs=within["eps"])
    assert found["H_V"] == pytest.approx(expected["H_V"], abs=within["H_V"])
    assert found["sigma_H"] == pytest.approx(expected["sigma_H"], abs=within["sigma_H"])
    assert found["l_Fl"]["pinion"] == pytest.approx(expected["l_Fl_1"], abs=within["l_Fl"])
    for part in ("flank", "root"):
        assert list(found["temperature"][part].values()) == pytest.approx([expected["theta"]] * 2, abs=within["theta"])
    assert found["F_t"] == pytest.approx(CASE["inputs"]["tangential_force_N"], abs=0.05)
    assert found["v_t"] == pytest.approx(CASE["inputs"]["pitch_velocity"], abs=5e-4)
    assert found["P"] == pytest.approx(CASE["inputs"]["power_W"], rel=1e-12)


def test_wear_is_the_volume_of_archard_over_the_flanks(design: PairDesign) -> None:
    """k_w times friction work over mu, on all flanks of the wheel; friction work is P H_V mu in the time of the cycles."""
    result = rated(design)
    found = result.to_dict()["plastic"]
    turns = 13.24e6
    seconds = turns / (design.load.speed * 51 / 52 / 60)  # type: ignore[union-attr]
    volume = 1e-6 * found["P"] * found["H_V"] * seconds
    area = 15 * 52 * found["l_Fl"]["wheel"]
    assert found["wear"] == {
        "wheel": {"mean": pytest.approx(1000 * volume / area, rel=1e-12), "permitted": 100.0, "permitted_local": 200.0}
    }
    assert result.proofs["wear of the wheel"].verdict is Verdict.PASSED
    longer = rated(design, load_cycles=[3.5e7, 3.5e7])
    assert longer.proofs["wear of the wheel"].verdict is Verdict.FAILED
    assert longer.verdict == "strength NOT passed: wear of the wheel; not judged: flank of the wheel, root of the wheel"


def test_deformation_and_static_load(design: PairDesign) -> None:
    steel, plastic = design.materials
    found = rated(design, replace(plastic, yield_strength=60.0), {"application_factor": 1.5})
    document = found.to_dict()["plastic"]
    assert document["deformation"] == pytest.approx(7.5 * document["F_t"] / 15 * (1 / 210000 + 1 / 4156), rel=1e-12)
    assert document["unconfirmed"]["permitted_deformation"] == 0.1
    assert document["static"]["wheel"]["permitted"] == pytest.approx(80.0)
    assert document["static"]["wheel"]["sigma_Fmax"] == pytest.approx(document["sigma_F"]["wheel"], rel=1e-12)
    assert found.proofs["static load of the wheel"].verdict is Verdict.FAILED
    assert "lambda_zul" in found.verify
    assert not steel.plastic


def test_limits_that_are_given_are_judged_once_by_y_st(design: PairDesign) -> None:
    """S_F = sigma_FlimN Y_St/sigma_F with Y_St 2, against a required 2; S_H against a required 1.4."""
    plastic = replace(design.materials.wheel, root_endurance_limit=80.0, contact_endurance_limit=100.0)
    found = rated(design, plastic)
    document = found.to_dict()
    root, flank = document["plastic"]["sigma_F"]["wheel"], document["plastic"]["sigma_H"]
    assert document["safety"]["root"]["wheel"] == pytest.approx(160 / root, rel=1e-12)
    assert document["safety"]["flank"]["wheel"] == pytest.approx(100 / flank, rel=1e-12)
    assert document["required"]["root"] == {"pinion": 1.4, "wheel": 2.0}
    assert document["required"]["flank"] == {"pinion": 1.0, "wheel": 1.4}
    assert document["not_judged"] == {}
    assert found.verdict == "strength NOT passed: flank of the wheel"
    # stress is proportional to the torque at roots, to its square root on flanks
    assert document["permissible_torque"]["root"]["wheel"] == pytest.approx(7.846 * 160 / root / 2, rel=1e-9)
    assert document["permissible_torque"]["flank"]["wheel"] == pytest.approx(7.846 * (100 / flank / 1.4) ** 2, rel=1e-9)


def test_heat_coefficients_go_by_materials_and_lubrication(design: PairDesign) -> None:
    """theta - theta_0 over the power of friction is k_theta/(b z_1 (v_t m_n)^0.75), of an open housing."""
    open_air = {"ambient_temperature": 20.0, "housing_area": None, "housing_resistance": None, "duty": 0.5}
    both = PerGear(replace(design.materials.wheel, name="POM"), replace(design.materials.wheel, name="POM"))
    assert design.load is not None
    for materials, lubrication, friction, flank, root in (
        (design.materials, "grease", 0.09, 6300.0, 895.0),
        (both, "dry", 0.28, 9000.0, 2148.0),
        (both, "oil", 0.04, 0.0, 0.0),
    ):
        load = replace(design.load, **open_air, lubrication=lubrication, torque=0.1)
        found = rate_strength(design.pair, materials, load, RatingOptions(load_cycles=1e6)).to_dict()
        plastic = found["plastic"]
        assert plastic["mu"] == friction
        heat = plastic["P"] * friction * plastic["H_V"] * 0.5**0.64 / (15 * 51 * plastic["v_t"] ** 0.75)
        assert plastic["temperature"]["flank"]["wheel"] - 20 == pytest.approx(heat * flank, rel=1e-9)
        assert plastic["temperature"]["root"]["wheel"] - 20 == pytest.approx(heat * root, rel=1e-9)
        assert ("k_theta" in found["verify"]) is bool(flank)
        assert ("mu" in found["verify"]) is (lubrication != "oil")


ROWS = """name,quantity,temperature,cycles,value,unit,source
mine,E,20,,3000,MPa,tests
mine,E,120,,1000,MPa,tests
mine,nu,,,0.35,,tests
mine,sigma_Flim,20,1e5,60,MPa,tests
mine,sigma_Flim,20,1e7,40,MPa,tests
mine,sigma_Flim,120,1e5,30,MPa,tests
mine,sigma_Flim,120,1e7,20,MPa,tests
mine,friction,20,,0.10,,tests
mine,friction,120,,0.30,,tests
mine,k_w,,,2e-6,mm3/(N m),tests
guess,E,,,3000,MPa,tests
guess,root_endurance_limit,,,100,MPa,recalled: a fit
"""


@pytest.fixture
def table(tmp_path: Path) -> Path:
    (tmp_path / "materials.csv").write_text(ROWS, encoding="utf-8")
    return tmp_path


def test_properties_at_the_temperature_that_friction_and_they_settle_at(design: PairDesign, table: Path) -> None:
    """theta = theta_0 + c mu(theta) with mu linear in theta has a closed form; a halved tolerance moves nothing."""
    mine = Material(name=ShelfName.of("mine", table), group="plastic")  # type: ignore[arg-type]
    assert [mine.youngs_modulus, mine.poisson_ratio] == [pytest.approx(3000 - 20 * 3), 0.35]  # at 23 °C
    load = {"ambient_temperature": 50.0, "torque": 2.0}
    found = rated(design, mine, load, friction=None, load_cycles=1e6)
    plastic = found.to_dict()["plastic"]
    slope = 0.2 / 100
    rise = plastic["P"] * plastic["H_V"] * 0.06 / 0.01
    theta = (50 + rise * (0.10 - 20 * slope)) / (1 - rise * slope)
    assert plastic["temperature"]["flank"]["wheel"] == pytest.approx(theta, abs=1e-8)
    assert plastic["mu"] == pytest.approx(0.10 + slope * (theta - 20), abs=1e-10)
    share = (theta - 20) / 100
    assert plastic["E"]["wheel"] == pytest.approx(3000 - 2000 * share, rel=1e-9)
    assert plastic["sigma_FlimN"]["wheel"] == pytest.approx(50 + (25 - 50) * share, rel=1e-9)  # middle of 1e5 and 1e7 in logs
    assert plastic["k_w"]["wheel"] == 2e-6
    assert found.root.wheel.safety == pytest.approx(2 * plastic["sigma_FlimN"]["wheel"] / plastic["sigma_F"]["wheel"])
    task = found.plastic
    assert task is not None
    finer = replace(task, tolerance=task.tolerance / 2).temperatures
    assert finer is not None
    assert finer.flank == pytest.approx(plastic["temperature"]["flank"]["wheel"], abs=1e-9)
    # with more torque the root is hotter and bears less: the permissible torque is below that of a root that stays as it is
    given = {"friction": None, "load_cycles": 1e6, "required_safety_root": 3.0}
    part = rated(design, mine, load, **given).root.wheel
    torque = part.permissible_torque
    assert torque is not None
    assert part.safety is not None
    assert 2.0 < torque < 2.0 * part.safety / 3.0
    assert rated(design, mine, load | {"torque": torque}, **given).root.wheel.safety == pytest.approx(3.0, rel=1e-9)


def test_what_a_table_lacks_is_not_judged_and_names_the_quantity(design: PairDesign, table: Path) -> None:
    mine = Material(name=ShelfName.of("mine", table), group="plastic")  # type: ignore[arg-type]
    found = rated(design, mine, {"torque": 2.0}, load_cycles=1e6)
    assert found.strength is Verdict.NOT_JUDGED
    assert found.not_judged["flank of the wheel"].startswith("contact_endurance_limit of mine is not known")
    hot = rated(design, mine, {"ambient_temperature": 130.0}, load_cycles=1e6)
    assert hot.not_judged["root of the wheel"].startswith(
        "root_endurance_limit of mine in materials.csv is known from 20 to 120 °C"
    )
    assert hot.to_dict()["plastic"]["sigma_H"] is None
    many = rated(design, mine, {"torque": 2.0}, load_cycles=1e9)
    assert "known from 1e+05 to 1e+07 load cycles, and not for 1e+09" in many.not_judged["root of the wheel"]
    unknown = rated(design, mine, {"torque": 2.0, "ambient_temperature": None}, load_cycles=1e6)
    assert "the ambient temperature is not given" in unknown.not_judged["root of the wheel"]


def test_what_rests_on_memory_is_a_figure_and_no_verdict(design: PairDesign, table: Path) -> None:
    guess = Material(name=ShelfName.of("guess", table), group="plastic", contact_endurance_limit=200.0)  # type: ignore[arg-type]
    found = rated(design, guess)
    document = found.to_dict()
    assert document["safety"]["root"]["wheel"] is None
    assert document["plastic"]["unconfirmed"]["S_F"] == {"wheel": pytest.approx(200 / document["plastic"]["sigma_F"]["wheel"])}
    assert "sigma_FlimN" in document["unconfirmed"]
    assert document["not_judged"] == {"root of the wheel": "sigma_FlimN of guess is as recalled: confirm it"}
    assert found.root.wheel.verdict is Verdict.NOT_JUDGED
    assert found.flank.wheel.verdict is Verdict.PASSED


def test_pinion_of_steel_is_rated_as_before(design: PairDesign) -> None:
    """Its root by ISO 6336-3 with K_A alone."""
    found = rated(design)
    nominal = found.nominal.roots.pinion.nominal_stress
    assert found.root.pinion.stress == pytest.approx(nominal, rel=1e-12)
    assert found.flank.pinion.verdict is Verdict.PASSED
    assert found.scuffing is None


def test_rings_and_racks_with_plastic_are_not_judged() -> None:
    ring = read_spec(TEMPLATES / "ring-22-70.toml")
    assert isinstance(ring, PairDesign)
    plastic = Material(group="plastic", youngs_modulus=3000.0)  # type: ignore[arg-type]
    found = rate_strength(ring.pair, plastic, Load(torque=20.0, speed=100.0))
    assert found.plastic is None
    assert set(found.not_judged.values()) == {
        "gears of plastic are rated by VDI 2736-2 in external pairs, not with a rack or a ring"
    }
