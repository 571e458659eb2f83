"""Ratings, permissible stresses and safeties against values that standards, reports and public programs print."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from support.cases import half_unit, rating_case
from support.published import Published
from support.specs import figures, rate_document

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.material import MaterialGroup
from gearcad.material import MaterialGroup as G
from gearcad.rating import RatingOptions
from gearcad.rating.factors import (
    flank_life_factor,
    flank_points,
    flank_roughness_factor,
    lubricant_factor,
    mesh_radius,
    notch_sensitivity_factor,
    root_points,
    root_size_factor,
    root_surface_factor,
    speed_factor,
)
from gearcad.rating.strength import StrengthRating, rate_strength
from gearcad.rating.strength.duty import damage_sum, permissible_cycles, safety_at_failure

_PRINTED = json.loads((Path(__file__).parents[1] / "data" / "rating_printed.json").read_text(encoding="utf-8"))
_CASES = {entry["id"]: entry for entry in _PRINTED["cases"]}


@pytest.mark.parametrize("name", _CASES)
def test_printed_figures(name: str, tmp_path: Path, published: Published) -> None:
    case = _CASES[name]
    document = rate_document(case["spec"], tmp_path)
    document |= {"S_H": document["safety"]["flank"], "S_F": document["safety"]["root"]}
    allowed = case.get("tolerance", {})
    for symbol, printed in case["printed"].items():
        found = figures(document, symbol)
        texts = printed if isinstance(printed, list) else [printed] * len(found)
        assert found
        for role, value, text in zip(("",) if len(found) == 1 else (" pinion", " wheel"), found, texts, strict=True):
            if text is not None:
                within = allowed.get(symbol, half_unit(text)) * (1 + 1e-9)
                published(f"{symbol}{role}", value, text, within, case["source"], name)


# ---------------------------------------------------------------------- plain formulas of our own


FORMULA = 1e-10
"""Relative: the same formulas evaluated twice."""

OF_BOTH = {"q_prime": "q_prime", "c_th": "c_th", "c_prime": "c_prime", "c_gamma_alpha": "c_gamma_alpha", "Z_H": "Z_H"}
OF_BOTH |= {"Z_E": "Z_E", "Z_eps": "Z_eps", "Z_B": "Z_B", "Z_D": "Z_D", "sigma_H0_MPa_Zbeta_2008": "sigma_H0"}
OF_EACH = {"Y_F": "Y_F", "Y_S": "Y_S", "Y_beta": "Y_beta", "sigma_F0_MPa": "sigma_F0"}


@pytest.mark.parametrize(
    "name", ["helical_unequal_widths_19_47", "helical_z12_51_beta22", "volvo_13_44_rating", "alm_18_161_rating"]
)
def test_nominal_values_by_way_of_a_spec(name: str, tmp_path: Path) -> None:
    given, expected = rating_case(name)["inputs"], rating_case(name)["expected"]
    common = {"normal_module": given["m_n_mm"], "helix_angle": given["beta_deg"]}
    distance = {"centre_distance": given["a_mm"]} if isinstance(given["a_mm"], float | int) else {}
    gears = {
        role: {"teeth": given["z"][place], "profile_shift": given["x"][place], "face_width": given["b_mm"][place]}
        for place, role in enumerate(("pinion", "wheel"))
    }
    steel = {"youngs_modulus": given["E_MPa"]}
    document = rate_document(
        {"pair": common | distance, **gears, "material": steel, "load": {"torque": given["T1_Nm"]}}, tmp_path
    )["nominal"]
    assert [document[ours] for ours in OF_BOTH.values()] == pytest.approx([expected[key] for key in OF_BOTH], rel=FORMULA)
    for role in gears:
        found, values = document[role], expected[role]
        assert [found[ours] for ours in OF_EACH.values()] == pytest.approx([values[key] for key in OF_EACH], rel=FORMULA)


# ---------------------------------------------------------------------- load spectra

PRINTED_DIGITS = 0.018
"""Relative, of load cycles: those of two or three digits, by stresses of four and torques of three."""


def test_annex_c_of_iso_6336_6(published: Published) -> None:
    # Its S-N line has the influence factors of endurance throughout, and goes on above 1.6 sigma_Hlim: bins 3 to 7 lie there.
    given = _PRINTED["spectrum"]
    cycles, stresses, permissible, damages = np.array(given["bins"]).T
    borne = given["limit"] * given["Z_L"] * given["Z_v"] * given["Z_R"]
    curve = [(reached, factor * borne) for reached, factor in flank_points(MaterialGroup.CASE_HARDENED)]
    found = permissible_cycles(stresses, curve)
    assert (stresses > 1.6 * borne).sum() == 5
    assert found == pytest.approx(permissible, rel=PRINTED_DIGITS)
    assert cycles / found == pytest.approx(damages, rel=PRINTED_DIGITS)
    published("damage sum of 42 bins", damage_sum(cycles, stresses, curve), f"{damages.sum():.4f}", 0.0015, given["source"])
    # With its S-N line, the static strength is not reached before 1e4 cycles.
    (_, static), *rest = curve
    slope = np.log(1.6) / np.log(500)
    longer = [(1e4, static * 10**slope), *rest]
    assert damages.sum() == pytest.approx(1, abs=0.001)
    published("safety at a damage of 1", safety_at_failure(cycles, stresses, longer), "1", 2e-4, given["source"])


# A helical pair 25/40 of an FVA Workbench report, case-hardened: sigma_Hlim 1500 MPa, ISO VG 318, 8.33 m/s, Rz 18 and 36 µm.
RHO_RED = mesh_radius(49.617, 79.387, math.tan(math.radians(21.173)))
Z_L, Z_V = lubricant_factor(1500.0, 318.0), speed_factor(1500.0, 8.33)
Z_R = flank_roughness_factor(1500.0, 18.0, RHO_RED)
Y_DREL, Y_RREL = notch_sensitivity_factor(2.072, G.CASE_HARDENED), root_surface_factor(36.0, G.CASE_HARDENED)

# A spur pair 51/52 of a STplus report, kst-E, case-hardened: q_s 2.56, Rz 20 µm, sigma_FE 860 MPa.
SPUR = (notch_sensitivity_factor(2.56, G.CASE_HARDENED), root_surface_factor(20.0, G.CASE_HARDENED))

PRINTED = {
    "rho_red, 25/40": (RHO_RED, 5.91, 0.02),
    "Z_R, 25/40": (Z_R, 0.854, 0.002),
    "Z_L, 25/40": (Z_L, 1.047, 0.002),
    "Z_v, 25/40": (Z_V, 0.995, 0.002),
    "sigma_HP, 25/40": (1500 * 0.85 * Z_L * Z_V * Z_R, 1135.4, 2.0),
    "Y_RrelT, 25/40": (Y_RREL, 0.915, 0.001),
    "Y_delta_relT, 25/40": (Y_DREL, 0.996, 0.001),
    "sigma_FP, 25/40": (922 * 0.85 * Y_DREL * Y_RREL, 714.1, 2.0),
    "Y_delta_relT, 51/52": (SPUR[0], 1.001, 0.001),
    "Y_RrelT, 51/52": (SPUR[1], 0.957, 0.001),
    "sigma_FP, 51/52": (860 * SPUR[0] * SPUR[1], 823.2, 2.0),
    "Y_RrelT, FZG H701": (root_surface_factor(20.0, G.CASE_HARDENED), 0.957, 0.0006),
    "Z_NT at 4.5e7, KISSsoft": (flank_life_factor(4.5e7, G.CASE_HARDENED), 1.008, 0.0006),
    "Z_NT at 9e7, KISSsoft": (flank_life_factor(9e7, G.CASE_HARDENED), 0.982, 0.0006),
    "Z_NT at 4.186e7, KISSsoft": (flank_life_factor(4.186e7, G.CASE_HARDENED), 1.0135, 0.0001),
    "Y_X, Eh, 10 mm": (root_size_factor(10.0, G.CASE_HARDENED), 0.95, 1e-9),
    "Y_X, Eh, 30 mm": (root_size_factor(30.0, G.CASE_HARDENED), 0.8, 1e-9),
    "Y_X, V, 10 mm": (root_size_factor(10.0, G.THROUGH_HARDENED), 0.97, 1e-9),
    "Y_X, V, 45 mm": (root_size_factor(45.0, G.THROUGH_HARDENED), 0.85, 1e-9),
    "Y_X, GG, 10 mm": (root_size_factor(10.0, G.GREY_IRON), 0.925, 1e-9),
    "Y_X, GG, 30 mm": (root_size_factor(30.0, G.GREY_IRON), 0.7, 1e-9),
    "Y_RrelT, V, Rz 10": (root_surface_factor(10.0, G.THROUGH_HARDENED), 1.00164, 2e-5),
    "Y_RrelT, St, Rz 10": (root_surface_factor(10.0, G.STRUCTURAL_STEEL), 1.001, 1e-5),
    "Y_RrelT, NT, Rz 10": (root_surface_factor(10.0, G.NITRIDING_STEEL), 0.99436, 1e-5),
}

SOURCE = "FVA Workbench, STplus and KISSsoft reports and rounded worked examples, as quoted in public"


@pytest.mark.parametrize("name", PRINTED)
def test_printed_values(name: str, published: Published) -> None:
    found, printed, tolerance = PRINTED[name]
    published(name, found, printed, tolerance, SOURCE)


@pytest.mark.parametrize(
    ("name", "points", "per_torque", "printed", "tolerance"),
    [
        ("flank, Eh", flank_points(G.CASE_HARDENED), 2, 6.61, 0.01),
        ("flank, NV (nitrided)", flank_points(G.NITRIDED), 2, 5.709, 0.01),
        ("flank, NV (nitrocarburised)", flank_points(G.NITROCARBURISED), 2, 15.715, 0.01),
        ("root, Eh", root_points(G.CASE_HARDENED), 1, 8.738, 0.002),
        ("root, V", root_points(G.THROUGH_HARDENED), 1, 6.225, 0.002),
        ("root, NV (nitrided)", root_points(G.NITRIDED), 1, 17.035, 0.002),
        ("root, NV (nitrocarburised)", root_points(G.NITROCARBURISED), 1, 84.003, 0.02),
    ],
)
def test_exponents_of_limited_life(
    name: str, points: tuple, per_torque: int, printed: float, tolerance: float, published: Published
) -> None:
    """ISO 6336-6 prints the exponents of torque; sigma_H goes with the square root of it."""
    (first, static), (last, endurance), *_ = points
    exponent = math.log(last / first) / math.log(static / endurance) / per_torque
    published(f"exponent of limited life, {name}", exponent, printed, tolerance, "ISO 6336-6:2006")


STRENGTH_PRINTED = 2.0
"""MPa, as the source compares them: its pitch line velocity and hardness values are rounded."""

STRENGTH_SOURCE = "FVA Workbench, helical 25/40, as quoted by github tkuhn39/semesterthesis"

SPUR_SOURCE = "STplus, kst-E 51/52, as quoted by github tkuhn39/semesterthesis"


@pytest.fixture(scope="module")
def helical() -> StrengthRating:
    """25/40, m_n 2, 20 degrees, Eh, after 10^10 load cycles; the tool's tip radius is that of the printed q_s = 2.072."""
    rack = BasicRack(dedendum=1.3, root_radius=0.275)
    pinion, wheel = (
        Gear(
            teeth=teeth,
            normal_module=2,
            face_width=26,
            helix_angle=helix,
            rack=rack,
            tip_diameter=tip,
            flank_roughness=18.0,
            root_roughness=36.0,
        )
        for teeth, helix, tip in ((25, 20.0, 57.209), (40, -20.0, 89.134))
    )
    pair = GearPair(pinion=pinion, wheel=wheel, centre_distance=69.172)
    material = Material(group="Eh", contact_endurance_limit=1500.0, root_endurance_limit=461.0)
    options = RatingOptions(load_cycles=1e10, oil_viscosity_40=318.0, required_safety_root=1.0)
    return rate_strength(pair, material, Load(torque=150.0, speed=3000.0), options)


def test_flank_of_a_helical_pair(helical: StrengthRating, published: Published) -> None:
    flank = helical.flank.pinion
    published("sigma_HP", flank.permissible_stress, 1135.4, STRENGTH_PRINTED, STRENGTH_SOURCE)
    published("S_H at 1087.2 MPa", flank.strength / 1087.2, 1.044, 0.003, STRENGTH_SOURCE)
    for key, printed in {"Z_NT": 0.85, "Z_L": 1.047, "Z_v": 0.995, "Z_R": 0.854}.items():
        published(key, flank.factors[key], printed, 0.002, STRENGTH_SOURCE)
    assert flank.safety * flank.stress == pytest.approx(flank.strength, rel=1e-12)


def test_root_of_a_helical_pair(helical: StrengthRating, published: Published) -> None:
    root = helical.root.pinion
    assert helical.nominal.roots.pinion.section.notch_parameter == pytest.approx(2.072, abs=0.01)
    published("sigma_FP", root.permissible_stress, 714.1, STRENGTH_PRINTED, STRENGTH_SOURCE)
    published("S_F at 313.9 MPa", root.strength / 313.9, 2.275, 0.02, STRENGTH_SOURCE)
    for key, printed in {"Y_NT": 0.85, "Y_delta_relT": 0.996, "Y_RrelT": 0.915}.items():
        published(key, root.factors[key], printed, 0.001, STRENGTH_SOURCE)


def test_root_of_a_spur_pair(published: Published) -> None:
    """kst-E, 51/52, m_n 1, b 15: the profile shift is not printed, but q_s = 2.56 is."""
    pinion, wheel = (Gear(teeth=z, normal_module=1, face_width=b, profile_shift=0.31) for z, b in ((51, 17), (52, 15)))
    material = Material(group="Eh", contact_endurance_limit=1500.0, root_endurance_limit=430.0)
    options = RatingOptions(load_cycles=3e6, required_safety_root=1.0)
    rating = rate_strength(GearPair(pinion=pinion, wheel=wheel), material, Load(torque=20.0, speed=3000.0), options)
    assert rating.nominal.roots.pinion.section.notch_parameter == pytest.approx(2.56, abs=0.01)
    published("sigma_FP", rating.root.pinion.permissible_stress, 823.2, STRENGTH_PRINTED, SPUR_SOURCE)
    published("S_F at 180.1 MPa", rating.root.pinion.strength / 180.1, 4.571, 0.03, SPUR_SOURCE)
    assert rating.load_factors is not None
    height = rating.load_factors.details["N_F"]
    published("K_Fbeta at K_Hbeta = 1.19", 1.19**height, 1.16, 0.005, SPUR_SOURCE)
