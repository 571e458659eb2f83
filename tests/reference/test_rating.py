"""Ratings of pairs and rings against values worked out from the standards' formulas elsewhere."""

import math
from dataclasses import replace
from typing import Any

import pytest
from support.cases import half_unit, pair_of, rated, rating_case

from gearcad import BasicRack, Body, Gear, GearPair, Load, Material, rate
from gearcad.geometry import ShaperCutter
from gearcad.rating import Edition, Rating, VirtualGear, contact_at
from gearcad.rating.contact_stress import contact_ratio_factor
from gearcad.rating.root_section import load_point, ring_section, root_section, substitute_radius
from gearcad.rating.root_stress import form_factor
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


PRINTED = 6e-4
"""Relative: four or more digits."""

RING_FORMULA = 1e-9
"""Relative, of formulas evaluated elsewhere."""

SEEN = 1e-3
"""Relative, of curvatures from neighbouring points there."""

STEEL = Material()

THESIS_RING = Gear(
    teeth=-70,
    normal_module=2.8,
    face_width=14.0,
    profile_shift=-1.2025,
    cutter=ShaperCutter(teeth=25, tip_radius=0.15),
    body=Body(rim_diameter=240.0),
)
THESIS = GearPair(
    pinion=Gear(teeth=22, normal_module=2.8, face_width=16.0, profile_shift=0.5), wheel=THESIS_RING, centre_distance=-69.0
)
"""Rim 3 of a planet and the ring that stands still of a master's thesis."""


def test_hertz_along_the_path_of_an_internal_pair() -> None:
    """One pair of teeth carries 5374.6 N on 14 mm."""
    expected = {"A": (9.263, 1221.9), "B": (16.100, 926.9), "C": (18.588, 862.6), "D": (24.344, 753.8), "E": (33.608, 641.5)}
    for point, distance in THESIS.path_of_contact._asdict().items():
        contact = contact_at(THESIS, STEEL, distance=distance, force=5374.6)
        assert (contact.radius, contact.peak_pressure) == pytest.approx(expected[point], rel=PRINTED / 10)


def test_pitch_point_of_an_internal_pair() -> None:
    """All of a torque is on one pair there; a pair of the same radii, both convex, would have R = 9.70 mm."""
    rating = rate(THESIS, Load(torque=5374.6 * THESIS.pinion.base_diameter / 2000)).nominal
    assert rating.pitch_point.peak_pressure == pytest.approx(862.6, rel=PRINTED / 10)
    assert rating.to_dict()["rho_C"] == pytest.approx(18.588, rel=PRINTED / 10)


Z80 = Gear(teeth=-80, normal_module=2.0, face_width=14.0, cutter=ShaperCutter(teeth=30, tip_radius=0.3))

SECTIONS = [
    (
        THESIS_RING,
        1.494,
        (8.670899295885024, 0.52156705143141),
        (0.3076103945766891, 8.3114922499587, 3.835356515692559, 0.12941158229861013, 0.9059329117208689, 24.119766285765845),
    ),
    (
        Z80,
        1.7,
        (5.528582948800044, 0.7177909999209667),
        (0.39922734552364336, 5.456589620969806, 2.701332851396659, 0.7352617109695181, 1.0936528064924185, 19.274320196200385),
    ),
]
"""Ring, contact ratio; chord, radius on the generated fillet; rho_fPv/m_n, s_Fn, h_Fe, rho_F, Y_F, alpha_Fen by formula."""


@pytest.mark.parametrize("ring, contact_ratio, exact, formula", SECTIONS)
def test_root_sections_of_rings(ring: Gear, contact_ratio: float, exact: tuple[float, ...], formula: tuple[float, ...]) -> None:
    virtual = VirtualGear.of(ring)
    load = load_point(virtual, contact_ratio)
    generated = root_section(ring, virtual, load)
    assert generated.chord == pytest.approx(exact[0], rel=1e-6)
    assert generated.fillet_radius == pytest.approx(exact[1], rel=SEEN)
    assert ring.cutter.teeth is not None
    radius = substitute_radius(ring, ring.cutter.teeth)
    section = ring_section(ring, virtual, load, radius)
    assert section is not None
    found = (
        radius / ring.normal_module,
        section.chord,
        section.moment_arm,
        section.fillet_radius,
        form_factor(section, load, virtual),
        load.load_angle,
    )
    assert found == pytest.approx(formula, rel=RING_FORMULA)
