"""Ratings against values worked out from the standards' formulas elsewhere, and against a worked example of ISO."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from support.cases import half_unit
from support.ratings import pair_of, rated, rating_case

from gearcad import BasicRack, GearPair
from gearcad.rating import Edition, Rating
from gearcad.rating.contact_stress import contact_ratio_factor
from gearcad.rating.tooth_stiffness import mesh_stiffness_alpha, mesh_stiffness_beta

FORMULA = 1e-11
"""Relative: the same formulas evaluated twice; a swapped index changes c'_th by 7e-4."""

CANCELLED = 1e-11
"""Of k, in normal modules: a small difference of lengths that are good to 1e-13 of themselves."""

RATED = ["helical_unequal_widths_19_47", "helical_z12_51_beta22", "volvo_13_44_rating", "alm_18_161_rating"]


def _assert_all(expected: dict[str, Any], found: dict[str, Any]) -> None:
    """Every expected value is found, and nothing is left over that nobody compared."""
    assert set(found) == set(expected)
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=FORMULA, abs=CANCELLED if name == "k" else 0), name


# ---------------------------------------------------------------------- tables of values


def _places(pair: GearPair) -> dict[str, float]:
    return {f"T1{point}": place for point, place in pair.path_of_contact._asdict().items()}


def _geometry(pair: GearPair) -> dict[str, float]:
    """The "geo" of a case."""
    plain = [replace(gear, tooth_thinning=0.0) for gear in (pair.pinion, pair.wheel)]
    return {
        "zn1": pair.pinion.virtual_teeth,
        "zn2": pair.wheel.virtual_teeth,
        "a": pair.centre_distance,
        "a_from_x": GearPair(pinion=plain[0], wheel=plain[1]).centre_distance,
        "sumx_from_a": pair.zero_backlash_shift_sum,
        "awt_deg": pair.working_transverse_pressure_angle,
        "da1": pair.pinion.tip_diameter,
        "da2": pair.wheel.tip_diameter,
        "eps_a": pair.transverse_contact_ratio,
        "eps_b": pair.overlap_ratio,
        "eps_g": pair.total_contact_ratio,
        "k": pair.pinion.tip_alteration,
        "d1": pair.pinion.reference_diameter,
        "d2": pair.wheel.reference_diameter,
        **_places(pair),
    }


def _stiffness(pair: GearPair, rating: Rating) -> dict[str, float]:
    values, width = rating.to_dict(), pair.common_width.width
    plain = "q_prime c_th c_prime c_gamma_alpha c_gamma_beta low_load_factor c_prime_lowload c_gamma_alpha_lowload".split()
    return {name: values[name] for name in plain} | {
        "b_common_mm": width,
        "k_single_N_per_mm": values["c_prime"] * width * 1000,
        "k_mesh_mean_N_per_mm": values["c_gamma_alpha"] * width * 1000,
        "k_single_lowload_N_per_mm": values["c_prime_lowload"] * width * 1000,
        "k_mesh_mean_lowload_N_per_mm": values["c_gamma_alpha_lowload"] * width * 1000,
    }


@pytest.mark.parametrize("short", [False, True])
@pytest.mark.parametrize("name", ["volvo_13_44_iso6336_stiffness", "fzg_c_iso6336_stiffness"])
def test_stiffness_and_its_geometry(name: str, short: bool) -> None:
    (expected,) = (value for key, value in rating_case(name)["expected"].items() if key.endswith("k=0") != short)
    for dedendum, key in ((1.25, "CB=0.975 (hfP*=1.25, ISO 53 A/B/C)"), (1.2, "CB=1.0 (hfP*=1.20)")):
        pair = pair_of(name, rack=BasicRack(dedendum=dedendum), short=short)
        rating = rated(pair, name)
        _assert_all(expected[key], _stiffness(pair, rating))
        assert rating.tangential_force == pytest.approx(expected["Ft"], rel=FORMULA)
        assert rating.specific_load == pytest.approx(expected["KA_Ft_over_b"], rel=FORMULA)
        _assert_all(expected["geo"], _geometry(pair))


def _root(values: dict[str, float]) -> dict[str, float]:
    """The root values of one gear under the names of the helical cases."""
    units = {
        "h_Fe": "_mm",
        "s_Fn": "_mm",
        "rho_F": "_mm",
        "d_en": "_mm",
        "alpha_Fen": "_deg",
        "theta": "_deg",
        "sigma_F0": "_MPa",
    }
    found = {name + units.get(name, ""): values[name] for name in ("Y_F", "Y_S", "Y_beta", *units)}
    return found | {"width_used_mm": values["b"]}


@pytest.mark.parametrize("name", RATED)
def test_rating(name: str) -> None:
    pair = pair_of(name)
    values = rated(pair, name).to_dict()
    din = rated(pair, name, Edition.DIN_1987).to_dict()
    plain = "q_prime c_th c_prime c_gamma_alpha c_gamma_beta Z_H Z_E Z_eps Z_B Z_D".split()
    expected = rating_case(name)["expected"]
    _assert_all(
        {**expected, "pinion": 0, "wheel": 0},
        {symbol: values[symbol] for symbol in plain}
        | {
            "a_mm": pair.centre_distance,
            "alpha_wt_deg": pair.working_transverse_pressure_angle,
            "k": pair.pinion.tip_alteration,
            "da_mm": [pair.pinion.tip_diameter, pair.wheel.tip_diameter],
            "eps_alpha": pair.transverse_contact_ratio,
            "eps_beta": pair.overlap_ratio,
            "Ft_N": values["F_t"],
            "Z_beta_ISO2006_corr2008": values["Z_beta"],
            "Z_beta_DIN3990": din["Z_beta"],
            "sigma_H0_MPa_Zbeta_2008": values["sigma_H0"],
            "sigma_H0_MPa_Zbeta_DIN": din["sigma_H0"],
            "pinion": 0,
            "wheel": 0,
        },
    )
    for owner in ("pinion", "wheel"):
        _assert_all(expected[owner], _root(values[owner]))
        assert din[owner] == {**values[owner], "sigma_H": din[owner]["sigma_H"]}


def test_rating_of_the_fzg_gears() -> None:
    pair = pair_of("fzg_c14_rating")
    rating = rated(pair, "fzg_c14_rating")
    values = rating.to_dict()
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    plain = "q_prime c_th C_B C_R c_prime c_gamma_alpha Z_H Z_E Z_eps Z_B Z_D".split()
    both = {"Y_F": "", "Y_S": "", "h_Fe": "", "s_Fn": "", "rho_F": "", "alpha_Fen": "_deg", "d_en": "", "sigma_F0": "_MPa"}
    expected = dict(rating_case("fzg_c14_rating")["expected"])
    # The listed half width does not carry the listed pressure: 2 P/(pi p_0) is 199.5448 µm, as here, not 199.5665 µm.
    listed = expected.pop("half_width_at_pitch_point_um")
    carrying = 2e3 * values["F_bn"] / 14 / (math.pi * expected["p0_at_pitch_point_MPa"])
    assert values["b_H"] * 1e3 == pytest.approx(carrying, rel=FORMULA)
    assert listed / carrying - 1 == pytest.approx(1.08987e-4, abs=1e-9)
    _assert_all(
        expected,
        {symbol: values[symbol] for symbol in plain}
        | {f"{symbol}{unit}": [values[owner][symbol] for owner in ("pinion", "wheel")] for symbol, unit in both.items()}
        | _places(pair)
        | {
            "alpha_wt_deg": pair.working_transverse_pressure_angle,
            "eps_alpha": pair.transverse_contact_ratio,
            "eps_beta": pair.overlap_ratio,
            "da1_mm": pair.pinion.tip_diameter,
            "da2_mm": pair.wheel.tip_diameter,
            "T1T2": whole,
            "Ft_N": values["F_t"],
            "Z_beta_2006_sqrt_cos": rated(pair, "fzg_c14_rating", Edition.DIN_1987).flank.helix_angle_factor,
            "Z_beta_2008_inv_sqrt_cos": values["Z_beta"],
            "sigma_H0_MPa_Zbeta2008": values["sigma_H0"],
            "sigma_H0_MPa_Zbeta2006": rated(pair, "fzg_c14_rating", Edition.DIN_1987).flank.nominal_stress,
            "Y_beta": values["pinion"]["Y_beta"],
            "p0_at_pitch_point_MPa": values["p_0"],
        },
    )


# ---------------------------------------------------------------------- ISO/TR 6336-30


def test_example_1_of_iso_tr_6336_30() -> None:
    name = "iso_tr_6336_30_example_1"
    pair = pair_of(name)
    values = rated(pair, name).to_dict() | {"z_n1": pair.pinion.virtual_teeth, "z_n2": pair.wheel.virtual_teeth}
    printed = dict(rating_case(name)["expected_printed"])
    alpha, beta, stress = (float(printed.pop(symbol)) for symbol in ("c_gamma_alpha", "c_gamma_beta", "sigma_H0"))
    for symbol, text in printed.items():
        assert values[symbol] == pytest.approx(float(text), abs=1.01 * half_unit(text), rel=0), symbol
    # Its contact ratio, not quoted, follows from c_gamma_alpha; then sigma_H0 and c_gamma_beta come out as printed.
    ratio = (alpha / float(printed["c_prime"]) - 0.25) / 0.75
    assert ratio == pytest.approx(1.54909, abs=5e-6)
    assert mesh_stiffness_alpha(values["c_prime"], ratio) == pytest.approx(alpha, abs=1e-5)
    assert mesh_stiffness_beta(alpha) == pytest.approx(beta, abs=5e-6)
    here = contact_ratio_factor(pair.transverse_contact_ratio, pair.overlap_ratio)
    assert values["sigma_H0"] * contact_ratio_factor(ratio, pair.overlap_ratio) / here == pytest.approx(stress, abs=1e-3)
