"""Permissible stresses and safeties of full ratings against printed calculations of two pairs.

Both are in the tests of a public thesis project (semesterthesis, ISO 6336:2019), which cites FVA Workbench and STplus. Stresses
are printed to 0.1 MPa, of inputs that are printed to four digits.
"""

from __future__ import annotations

import pytest

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating, rate_strength

PRINTED = 2.0
"""MPa, as the source compares them: its pitch line velocity and hardness values are rounded."""


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


def test_flank_of_a_helical_pair(helical: StrengthRating) -> None:
    flank = helical.flank.pinion
    assert flank.permissible_stress == pytest.approx(1135.4, abs=PRINTED)
    assert flank.strength / 1087.2 == pytest.approx(1.044, abs=0.003)
    printed = {"Z_NT": 0.85, "Z_L": 1.047, "Z_v": 0.995, "Z_R": 0.854}
    assert {key: flank.factors[key] for key in printed} == pytest.approx(printed, abs=0.002)
    assert flank.safety * flank.stress == pytest.approx(flank.strength, rel=1e-12)


def test_root_of_a_helical_pair(helical: StrengthRating) -> None:
    root = helical.root.pinion
    assert helical.nominal.roots.pinion.section.notch_parameter == pytest.approx(2.072, abs=0.01)
    assert root.permissible_stress == pytest.approx(714.1, abs=PRINTED)
    assert root.strength / 313.9 == pytest.approx(2.275, abs=0.02)
    printed = {"Y_NT": 0.85, "Y_delta_relT": 0.996, "Y_RrelT": 0.915}
    assert {key: root.factors[key] for key in printed} == pytest.approx(printed, abs=0.001)


def test_root_of_a_spur_pair() -> None:
    """kst-E, 51/52, m_n 1, b 15: the profile shift is not printed, but q_s = 2.56 is."""
    pinion, wheel = (Gear(teeth=z, normal_module=1, face_width=b, profile_shift=0.31) for z, b in ((51, 17), (52, 15)))
    material = Material(group="Eh", contact_endurance_limit=1500.0, root_endurance_limit=430.0)
    options = RatingOptions(load_cycles=3e6, required_safety_root=1.0)
    rating = rate_strength(GearPair(pinion=pinion, wheel=wheel), material, Load(torque=20.0, speed=3000.0), options)
    assert rating.nominal.roots.pinion.section.notch_parameter == pytest.approx(2.56, abs=0.01)
    assert rating.root.pinion.permissible_stress == pytest.approx(823.2, abs=PRINTED)
    assert rating.root.pinion.strength / 180.1 == pytest.approx(4.571, abs=0.03)
    assert rating.load_factors is not None
    height = rating.load_factors.details["N_F"]
    assert 1.19**height == pytest.approx(1.16, abs=0.005)  # K_Fbeta by the printed K_Hbeta
