"""K_v of ISO 6336-1, Method B: its equations, what of them the load changes, and the tolerances that go into it."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.ratings import STEEL

from gearcad import Gear, GearPair, Load
from gearcad.errors import ParameterError
from gearcad.rating import DynamicFactor
from gearcad.rating.dynamic_factor import SpeedRange, running_factors
from gearcad.rating.iso1328 import flank_tolerances
from gearcad.spec import read_spec

TEMPLATES = Path(__file__).parents[2] / "templates"

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
    ranges = [METHOD_B.range_at(speed) for speed in speeds[[1, 2, 4, 6]]]
    assert ranges == [SpeedRange.SUBCRITICAL, SpeedRange.MAIN_RESONANCE, SpeedRange.INTERMEDIATE, SpeedRange.SUPERCRITICAL]
    relieved = replace(METHOD_B, tip_relief=400 / 14)
    assert relieved.values(0.9 * resonance) == pytest.approx(main - 0.9)
    light = replace(METHOD_B, specific_load=25.0)
    assert light.range_at(0.67 * resonance) is SpeedRange.SUBCRITICAL
    assert light.range_at(0.68 * resonance) is SpeedRange.MAIN_RESONANCE


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
"""8 N·m are 2000 * 8/(60 * 20) = 13.33 N/mm."""


def test_low_load_softens_the_mesh() -> None:
    """c' and c_gamma fall with the fourth root below 100 N/mm (90), so n_E1 with the eighth; B_p and B_f with the fourth."""
    light, heavy = (DynamicFactor.of(LIGHT, STEEL, Load(torque=torque), (2e-4, 4e-3), 6) for torque in (8.0, 80.0))
    assert heavy.specific_load == pytest.approx(10 * light.specific_load) == pytest.approx(400 / 3)
    factor = (40 / 3 / 100) ** 0.25
    assert light.resonance_speed / heavy.resonance_speed == pytest.approx(math.sqrt(factor), rel=EXACT)
    assert math.sqrt(factor) == pytest.approx(5865 / 7545, rel=1e-4)
    for soft, stiff in zip(light.effects[:2], heavy.effects[:2], strict=True):
        assert soft / stiff == pytest.approx(10 * factor, rel=EXACT)


def test_resonance_speed_of_the_alm_starter() -> None:
    """94.07 N/mm: it was 37,624 rpm with the stiffness of high loads; the inertias are those of the solids."""
    design = read_spec(TEMPLATES / "alm-18-161.toml")
    pair, load = design.loaded_pair("", "")
    found = DynamicFactor.of(pair, STEEL, load, (6.8607e-6, 0.024773), 6)
    assert found.resonance_speed == pytest.approx(37338, abs=1)


# ---------------------------------------------------------------------- tolerances


def test_flank_tolerances() -> None:
    """ISO 1328-1:2013, (5) to (8) by hand for d = 100 mm, m_n = 2.5 mm; a class more is the square root of 2 more."""
    fifth, ninth = (flank_tolerances(each, 100.0, 2.5) for each in (5, 9))
    assert fifth == pytest.approx((6.1, 0.2 + 5.5 + 1.75 + 12, 5.1, 6.375))
    assert np.array(ninth) == pytest.approx(4 * np.array(fifth))
    with pytest.raises(ParameterError, match="tolerance_class"):
        flank_tolerances(12, 100.0, 2.5)
