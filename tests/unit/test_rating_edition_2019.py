"""What the edition of 2019 changes, each by hand, and what it says of itself; clauses and what is to be verified."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from support.ratings import STEEL, sample_pair

from gearcad import FlankModification, Gear, GearPair, Load, RackPair
from gearcad.geometry import Rack
from gearcad.rating import Edition, RatingOptions, rate, rate_rack
from gearcad.rating.editions import load_distribution_factor, modification_factor, relieved
from gearcad.rating.factors import citations, to_verify
from gearcad.rating.root_stress import deep_tooth_factor

LOAD = Load(torque=350.0)
NEW, OLD = RatingOptions(standard=Edition.ISO_2019), RatingOptions(standard=Edition.ISO_2006)
EXACT = 1e-12


def test_load_distribution() -> None:
    """f_eps by eps_alphan and eps_beta; the same of numbers and arrays."""
    ratio = np.array([1.5, 2.2, 1.5, 2.2, 1.5, 2.2])
    overlap = np.array([0, 0, 0.5, 0.5, 1.4, 1.4])
    expected = [1, 0.7, math.sqrt(0.5 + 0.5 / 1.5), math.sqrt(0.25 + 0.5 / 2.2), math.sqrt(1 / 1.5), math.sqrt(1 / 2.2)]
    assert load_distribution_factor(ratio, overlap) == pytest.approx(expected, rel=EXACT)
    assert [load_distribution_factor(float(a), float(b)) for a, b in zip(ratio, overlap, strict=True)] == pytest.approx(
        expected
    )


@pytest.mark.parametrize("helix", [0.0, 15.0])
def test_what_changes_and_what_does_not(helix: float) -> None:
    pair = sample_pair(helix)
    new, old = rate(pair, STEEL, LOAD, NEW), rate(pair, STEEL, LOAD, OLD)
    raised = 1.07 if helix else 1.2
    for role in ("pinion", "wheel"):
        one, other = getattr(new.roots, role), getattr(old.roots, role)
        ratio = pair.transverse_contact_ratio / math.cos(math.radians(pair.pinion.base_helix_angle)) ** 2
        f_eps = load_distribution_factor(ratio, pair.overlap_ratio)
        assert one.form_factor == pytest.approx(other.form_factor * f_eps, rel=EXACT)
        lean = math.cos(math.radians(helix)) ** 3
        assert one.helix_angle_factor == pytest.approx(other.helix_angle_factor / lean, rel=EXACT)
        assert one.nominal_stress == pytest.approx(other.nominal_stress * f_eps / lean, rel=EXACT)
        contact = getattr(old.flank.contact_factors, role) * raised
        assert getattr(new.flank.contact_factors, role) == pytest.approx(contact, rel=EXACT)
    assert new.flank.nominal_stress == old.flank.nominal_stress
    assert new.stiffness == old.stiffness
    assert new.verify == ("Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT")
    assert not old.verify
    assert {notice.code for notice in new.notices} - {notice.code for notice in old.notices} == {
        "edition-2019-to-verify",
        "profile-not-modified",
    }


def test_profiles_that_are_taken_back_need_no_more() -> None:
    relief = FlankModification(tip_relief=20.0, tip_relief_length=2.0)
    pair = sample_pair(15.0)
    both = GearPair(
        pinion=replace(pair.pinion, modification=relief),
        wheel=replace(pair.wheel, modification=relief),
        centre_distance=pair.centre_distance,
    )
    assert rate(both, STEEL, LOAD, NEW).flank == rate(pair, STEEL, LOAD, OLD).flank
    root = FlankModification(root_relief=20.0, root_relief_length=2.0)
    assert relieved(replace(relief, root_relief=20.0, root_relief_length=2.0))
    assert relieved(FlankModification(profile_crowning=5.0))
    assert not relieved(relief)
    assert not relieved(relief, root)  # both where contact ends
    assert not relieved(FlankModification(lead_crowning=9.0), FlankModification(lead_crowning=9.0))
    assert modification_factor(0.0, modified=True) == modification_factor(20.0, modified=True) == 1
    assert modification_factor(np.array([0, 20.0]), modified=False).tolist() == [1.2, 1.07]


def test_deep_teeth_are_not_relieved_twice() -> None:
    assert deep_tooth_factor(2.4, 4, Edition.ISO_2006) == pytest.approx(2.366 - 0.666 * 2.4)
    assert deep_tooth_factor(2.4, 4, Edition.ISO_2019) == 1


def test_rings_and_racks() -> None:
    ring = Gear(teeth=-70, normal_module=2.8, face_width=14.0)
    pinion = Gear(teeth=22, normal_module=2.8, face_width=16.0)
    internal = rate(GearPair(pinion=pinion, wheel=ring), STEEL, LOAD, NEW)
    assert internal.flank.contact_factors.wheel == 1
    assert internal.verify == ("q_prime", "Z_D", "wheel.Y_B", "Z_B", "Y_F", "Y_beta", "Y_DT")
    rack = RackPair(pinion=pinion, rack=Rack(normal_module=2.8, face_width=14.0, teeth=20, height=20.0))
    new, old = rate_rack(rack, STEEL, LOAD, NEW), rate_rack(rack, STEEL, LOAD, OLD)
    assert new.flank.contact_factors.pinion == pytest.approx(1.2 * old.flank.contact_factors.pinion, rel=EXACT)
    assert "Y_F" in new.verify


def test_clauses_and_what_is_to_be_verified() -> None:
    assert citations(Edition.ISO_2006)["Z_NT"] == "ISO 6336-2:2006, clause 11"
    assert citations(Edition.ISO_2006)["Y_M"] == "ISO 6336-3:2006, annex B"
    assert citations(Edition.ISO_2019)["Y_beta"] == "ISO 6336-3:2019"
    assert citations(Edition.DIN_1987)["Z_X"] == "DIN 3990-2:1987"
    assert citations(Edition.DIN_1987)["Z_H"] == "ISO 6336-2:2006, clause 6.1"
    assert to_verify(Edition.ISO_2006) == {}
    assert set(to_verify(Edition.ISO_2006, internal=True)) == {"Z_D"}
    assert set(to_verify(Edition.ISO_2019)) == {"Z_B", "Z_D", "Y_F", "Y_beta", "Y_DT"}
    limited = to_verify(Edition.DIN_1987, limited_flank=True, limited_root=True)
    assert set(limited) == {"Z_L", "Z_v", "Z_R", "Z_W", "Z_X", "Y_delta_relT", "Y_RrelT", "Y_X"}
    for edition in Edition:
        assert set(to_verify(edition, internal=True, limited_flank=True, limited_root=True)) <= set(citations(edition))
