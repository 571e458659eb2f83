"""The helical pair 13/44 of the Chalmers/Volvo thesis (2017): table 2, appendix 4, equations 4.1-4.3, and its errors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.cases import case, diameters, half_unit, volvo_pair
from support.published import Published

from gearcad import BasicRack, Gear, GearPair, GeometryError

DIAMETER = 1e-9
"""mm: what the project promises for diameters, lengths and centre distances."""

RATIO = 1e-9
"""What the project promises for contact ratios and for angles in degrees."""

PAIR = case("s001_pair")["verified"]
CONTACT = case("s001_forces_contact")["verified"]
SCREW = case("s001_eq4_3")["verified"]


@pytest.fixture(scope="module")
def pair() -> GearPair:
    return volvo_pair()


def _gear_diameters(pair: GearPair) -> dict[str, float]:
    found = diameters(pair)
    for number, gear in enumerate((pair.pinion, pair.wheel), start=1):
        found |= {
            f"d_Ff{number}": gear.form_diameter,
            f"d_SAP{number}": pair.active_root_diameters[number - 1],
        }
    return found


def test_diameters(pair: GearPair) -> None:
    found = _gear_diameters(pair)
    assert found == pytest.approx({name: PAIR[name] for name in found}, abs=DIAMETER, rel=0)


def test_lengths(pair: GearPair) -> None:
    path = pair.path_of_contact
    found = {
        "mt": pair.pinion.transverse_module,
        "a_d": pair.reference_centre_distance,
        "pbt": pair.pinion.transverse_base_pitch,
        "g_alpha": path.E - path.A,
    }
    assert found == pytest.approx({name: PAIR[name] for name in found}, abs=DIAMETER, rel=0)
    assert list(pair.tip_clearances) == pytest.approx(PAIR["tip_clearance_mm"], abs=DIAMETER, rel=0)


def test_angles_shifts_and_ratios(pair: GearPair) -> None:
    found = {
        "alpha_t": pair.pinion.transverse_pressure_angle,
        "alpha_wt": pair.working_transverse_pressure_angle,
        "beta_b": pair.pinion.base_helix_angle,
        "sumx": pair.profile_shift_sum,
        "sumx_a": pair.zero_backlash_shift_sum,
        "y": (pair.centre_distance - pair.reference_centre_distance) / pair.pinion.normal_module,
        "k_full": pair.tip_alteration,
        "eps_alpha": pair.transverse_contact_ratio,
        "eps_beta_b15p1": pair.overlap_ratio,
        "eps_gamma": pair.total_contact_ratio,
        "eps_alpha_limited_by_dFf1": pair.usable_contact_ratio,
        "M2_Nm": 220 * pair.gear_ratio,
    }
    assert found == pytest.approx({name: PAIR[name] for name in found}, abs=RATIO, rel=0)


def test_without_tip_alteration(pair: GearPair) -> None:
    plain = replace(pair, pinion=replace(pair.pinion, tip_alteration=0.0), wheel=replace(pair.wheel, tip_alteration=0.0))
    tips = [plain.pinion.tip_diameter, plain.wheel.tip_diameter]
    assert tips == pytest.approx(PAIR["da_without_k"], abs=DIAMETER, rel=0)
    assert plain.transverse_contact_ratio == pytest.approx(PAIR["eps_alpha_without_k"], abs=RATIO, rel=0)


@pytest.mark.parametrize("name", case("s001_pair")["expected_printed"])
def test_printed_to_its_digits(pair: GearPair, name: str, published: Published) -> None:
    printed = case("s001_pair")["expected_printed"][name]
    found = {
        "rb1": pair.pinion.base_diameter / 2,
        "rb2": pair.wheel.base_diameter / 2,
        "alpha_wt": pair.working_transverse_pressure_angle,
        "beta_b": pair.pinion.base_helix_angle,
        "M2": 220 * pair.gear_ratio,
    }[name]
    published(name, found, printed, half_unit(printed), case("s001_pair")["source"])


def test_printed_shifts_overlap_by_rounding_only() -> None:
    unthinned = {"root_radii": (0.38, 0.32), "thinning": (0.0, 0.0)}
    derived = replace(volvo_pair(**unthinned), centre_distance=None)
    assert derived.centre_distance == pytest.approx(PAIR["a_zero_backlash_for_printed_x"], abs=DIAMETER, rel=0)
    # dj = 2 tan(alpha_wt) da for a small change of the centre distance
    expected = -2 * math.tan(math.radians(PAIR["alpha_wt"])) * (PAIR["a_zero_backlash_for_printed_x"] - 80)
    assert expected == pytest.approx(-1.7e-6, abs=5e-8)
    assert volvo_pair(**unthinned).circumferential_backlash == pytest.approx(expected, abs=1e-11, rel=0)


def test_thinning_becomes_backlash(pair: GearPair) -> None:
    # Thinner normal teeth open the working circle by (t1 + t2)/cos(beta) d_w/d; the printed shifts take 1.7e-6 mm of it.
    expected = 0.24 / math.cos(math.radians(28)) * PAIR["dw1"] / PAIR["d1"]
    assert pair.circumferential_backlash == pytest.approx(expected, abs=2e-6, rel=0)
    assert pair.normal_backlash == pytest.approx(
        pair.circumferential_backlash * math.cos(math.radians(PAIR["alpha_wt"])) * math.cos(math.radians(PAIR["beta_b"])),
        abs=DIAMETER,
    )


def test_the_wheels_tip_reaches_the_pinions_fillet(pair: GearPair) -> None:
    assert PAIR["fillet_interference_pinion"]
    (warning,) = pair.warnings
    assert "fillet interference" in warning
    assert "34.1388" in warning
    assert "34.1784" in warning


def test_twist_and_lead(pair: GearPair) -> None:
    gears = (pair.pinion, pair.wheel)
    twists = [math.radians(gear.twist) for gear in gears]
    assert twists == pytest.approx(SCREW["phi_total_rad"], rel=1e-12)
    assert [twist / 10 for twist in twists] == pytest.approx(SCREW["phi_step_rad"], rel=1e-12)
    assert [gear.lead for gear in gears] == pytest.approx(SCREW["lead_mm"], abs=DIAMETER, rel=0)


def test_ruled_loft_of_the_thesis_is_off(pair: GearPair) -> None:
    # A straight piece between sections turned by phi lies R (1 - cos(phi/2)) inside the tip cylinder.
    errors = [gear.tip_diameter / 2 * (1 - math.cos(math.radians(gear.twist) / 20)) for gear in (pair.pinion, pair.wheel)]
    assert errors == pytest.approx(SCREW["ruled_loft_radial_error_at_tip_mm"], rel=1e-9)


# ---------------------------------------------------------------------- contact


def _phases(pair: GearPair, phases: list[float]) -> np.ndarray:
    """Roll angles (deg) at which the leading end of a line has come `phases` (mm) along the path from A."""
    path = pair.path_of_contact
    reach = pair.common_width.width * math.tan(math.radians(pair.pinion.base_helix_angle))
    return np.degrees((path.A + np.array(phases) - reach / 2 - path.C) / (pair.pinion.base_diameter / 2))


@pytest.mark.parametrize("shortened", [True, False])
def test_contact_lines(pair: GearPair, shortened: bool) -> None:
    expected = CONTACT["contact_lines_with_k" if shortened else "contact_lines_without_k"]
    if not shortened:
        pair = replace(pair, pinion=replace(pair.pinion, tip_alteration=0.0), wheel=replace(pair.wheel, tip_alteration=0.0))
    lengths = pair.contact_line_lengths
    assert lengths.minimum == pytest.approx(expected["min_mm"], abs=DIAMETER, rel=0)
    assert lengths.maximum == pytest.approx(expected["max_mm"], abs=DIAMETER, rel=0)
    assert lengths.mean == pytest.approx(expected["mean_formula_eps_alpha_b_over_cos"], abs=DIAMETER, rel=0)
    at_phases = pair.contact_line_length(_phases(pair, expected["phase_mm"]))
    assert at_phases == pytest.approx(expected["sum_L_at_phase"], abs=DIAMETER, rel=0)


def test_radii_of_curvature_at_the_pitch_point(pair: GearPair, published: Published) -> None:
    path = pair.path_of_contact
    whole = pair.centre_distance * math.sin(math.radians(pair.working_transverse_pressure_angle))
    transverse = [path.C, whole - path.C]
    normal = [radius / math.cos(math.radians(pair.pinion.base_helix_angle)) for radius in transverse]
    assert transverse == pytest.approx(CONTACT["rho_t"], abs=DIAMETER, rel=0)
    assert normal == pytest.approx(CONTACT["rho_n"], abs=DIAMETER, rel=0)
    printed = case("s001_forces_contact")["expected_printed"]
    for section, radii in (("rho_t", transverse), ("rho_n", normal)):
        for number, (found, text) in enumerate(zip(radii, printed[section], strict=True), start=1):
            published(f"{section}{number}", found, text, half_unit("0.01"), case("s001_forces_contact")["source"])


def test_one_whole_line(pair: GearPair, published: Published) -> None:
    whole = pair.common_width.width / math.cos(math.radians(pair.pinion.base_helix_angle))
    assert whole == pytest.approx(CONTACT["L_full"], abs=DIAMETER, rel=0)
    printed = case("s001_forces_contact")["expected_printed"]["L_long"]
    published("L_long", whole, printed, half_unit(printed), case("s001_forces_contact")["source"])


def test_printed_contact_lines_are_impossible(pair: GearPair) -> None:
    printed = case("s001_forces_contact")["expected_printed"]
    lengths = pair.contact_line_lengths
    whole = lengths.mean / pair.transverse_contact_ratio
    assert not lengths.minimum <= float(printed["L_tot"]) <= lengths.maximum
    # Two lines are in contact, one of them whole: the short one lies between what is left of least and greatest.
    assert not lengths.minimum - whole <= float(printed["L_short"]) <= lengths.maximum - whole


def test_printed_normal_force_is_wrong(pair: GearPair) -> None:
    force = 220e3 / (pair.pinion.base_diameter / 2 * math.cos(math.radians(pair.pinion.base_helix_angle)))
    assert force == pytest.approx(CONTACT["FN_tot"], rel=1e-12)
    assert abs(force - float(case("s001_forces_contact")["expected_printed"]["FN_tot"])) > 10


# ---------------------------------------------------------------------- the tool


def test_tool_tip_of_the_pinion_is_refused_without_thinning() -> None:
    with pytest.raises(GeometryError) as caught:
        Gear(
            teeth=13, normal_module=2.5, face_width=18.3, helix_angle=28, profile_shift=0.107, rack=BasicRack(root_radius=0.48)
        )
    assert caught.value.parameter == "rack.root_radius"
    # 1.1797765 mm; the pinion's feasible limit with 0.08 mm of thinning is 1.2369025 mm
    assert "at most 0.4719 (full radius)" in str(caught.value)
    limit = BasicRack().full_root_radius() * 2.5
    assert limit == pytest.approx(case("s001_gear1_profile")["verified"]["tool"]["rho_max_mm"], abs=DIAMETER, rel=0)
    thinned = BasicRack().full_root_radius(thinning=0.08 / 2.5) * 2.5
    assert thinned == pytest.approx(case("s001_gear1_profile_thin")["verified"]["tool"]["rho_max_mm"], abs=DIAMETER, rel=0)
