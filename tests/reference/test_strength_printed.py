"""Permissible stresses and safeties of full ratings against printed calculations of two pairs.

Both are in the tests of a public thesis project (semesterthesis, ISO 6336:2019), which cites FVA Workbench and STplus. Stresses
are printed to 0.1 MPa, of inputs that are printed to four digits.
"""

from __future__ import annotations

import pytest
from support.published import Published

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating, rate_strength

PRINTED = 2.0
"""MPa, as the source compares them: its pitch line velocity and hardness values are rounded."""

SOURCE = "FVA Workbench, helical 25/40, as quoted by github tkuhn39/semesterthesis"

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
    published("sigma_HP", flank.permissible_stress, 1135.4, PRINTED, SOURCE)
    published("S_H at 1087.2 MPa", flank.strength / 1087.2, 1.044, 0.003, SOURCE)
    for key, printed in {"Z_NT": 0.85, "Z_L": 1.047, "Z_v": 0.995, "Z_R": 0.854}.items():
        published(key, flank.factors[key], printed, 0.002, SOURCE)
    assert flank.safety * flank.stress == pytest.approx(flank.strength, rel=1e-12)


def test_root_of_a_helical_pair(helical: StrengthRating, published: Published) -> None:
    root = helical.root.pinion
    assert helical.nominal.roots.pinion.section.notch_parameter == pytest.approx(2.072, abs=0.01)
    published("sigma_FP", root.permissible_stress, 714.1, PRINTED, SOURCE)
    published("S_F at 313.9 MPa", root.strength / 313.9, 2.275, 0.02, SOURCE)
    for key, printed in {"Y_NT": 0.85, "Y_delta_relT": 0.996, "Y_RrelT": 0.915}.items():
        published(key, root.factors[key], printed, 0.001, SOURCE)


def test_root_of_a_spur_pair(published: Published) -> None:
    """kst-E, 51/52, m_n 1, b 15: the profile shift is not printed, but q_s = 2.56 is."""
    pinion, wheel = (Gear(teeth=z, normal_module=1, face_width=b, profile_shift=0.31) for z, b in ((51, 17), (52, 15)))
    material = Material(group="Eh", contact_endurance_limit=1500.0, root_endurance_limit=430.0)
    options = RatingOptions(load_cycles=3e6, required_safety_root=1.0)
    rating = rate_strength(GearPair(pinion=pinion, wheel=wheel), material, Load(torque=20.0, speed=3000.0), options)
    assert rating.nominal.roots.pinion.section.notch_parameter == pytest.approx(2.56, abs=0.01)
    published("sigma_FP", rating.root.pinion.permissible_stress, 823.2, PRINTED, SPUR_SOURCE)
    published("S_F at 180.1 MPa", rating.root.pinion.strength / 180.1, 4.571, 0.03, SPUR_SOURCE)
    assert rating.load_factors is not None
    height = rating.load_factors.details["N_F"]
    published("K_Fbeta at K_Hbeta = 1.19", 1.19**height, 1.16, 0.005, SPUR_SOURCE)
