"""K_Hbeta from the load along the face width of solid bodies, beside that of Method C."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad import Gear, GearPair, Load, Material
from gearcad.check.run import load_distribution
from gearcad.check.task import check_task
from gearcad.core.errors import ParameterError
from gearcad.geometry import FlankModification
from gearcad.mounting import Mounting
from gearcad.rating import RatingOptions
from gearcad.rating.load_factors import LoadFactors

EH = Material(group="Eh", contact_endurance_limit=1500.0)  # type: ignore[arg-type]
SPUR = GearPair(
    pinion=Gear(teeth=20, normal_module=3.0, face_width=30.0), wheel=Gear(teeth=45, normal_module=3.0, face_width=30.0)
)
LOAD = Load(torque=150.0, speed=1500.0)


def test_needs_what_a_rating_needs() -> None:
    with pytest.raises(ParameterError, match="torque"):
        load_distribution(check_task(SPUR, EH, replace(LOAD, torque=0.0)))
    with pytest.raises(ParameterError, match="contact_endurance_limit"):
        load_distribution(check_task(SPUR, Material(group="V"), LOAD))  # type: ignore[arg-type]


@pytest.mark.long
def test_a_misaligned_spur_pair_beside_method_c() -> None:
    """Method C: 1.54, of springs of 16.2 N/(mm·µm). The bodies: 1.95, because they are stiffer against a tilt.

    Under an even load the mesh of these bodies has 20.8 N/(mm·µm), against c_gamma_alpha 19.1, of which Method C takes 0.85.
    What bodies twist is part of that, but moves all of the width alike: against a tilt there is 1.28 times as much, 26.5
    N/(mm·µm), by the slope of the load over the face width. The ends of an even load carry 3.5 % more besides.
    """
    found, by_method_c = load_distribution(check_task(SPUR, EH, LOAD)), LoadFactors.of(SPUR, EH, LOAD)
    off, mean, c = (by_method_c.details[each] for each in ("F_betay", "F_m_b", "c_gamma_beta"))
    assert isinstance(off, float) and isinstance(mean, float) and isinstance(c, float)
    assert abs(found.misalignment) == pytest.approx(off, rel=1e-12)
    step = found.across[1] - found.across[0]
    force = 1000 * found.torque / (SPUR.pinion.base_diameter / 2)
    assert found.load.sum() * step == pytest.approx(force, rel=1e-6)
    assert by_method_c.face_flank == pytest.approx(1.541, abs=0.001)
    slope = abs(np.polyfit(found.across, found.load, 1)[0]) * 30 / off
    across = math.cos(math.radians(20))  # F_m is at the reference circle, the load along the line of action
    assert slope == pytest.approx(26.5, rel=0.02)
    assert found.face_load_factor == pytest.approx(1.035 * (1 + off * slope * across / (2 * mean)), rel=0.06)
    assert found.face_load_factor == pytest.approx(1.945, rel=0.01)


@pytest.mark.long
def test_flanks_and_mounting_change_it() -> None:
    """The gap grows towards larger z: the low end carries; crowning helps; far off, the end carries all, whatever the model."""
    aside = load_distribution(check_task(SPUR, EH, LOAD, mounting=Mounting(misalignment=20.0)))
    assert aside.misalignment == pytest.approx(17.0)  # 3 µm run in
    assert aside.load[:30].sum() > 2 * aside.load[30:].sum()
    mirrored = load_distribution(check_task(SPUR, EH, replace(LOAD, torque=-150.0), mounting=Mounting(misalignment=20.0)))
    assert mirrored.face_load_factor == pytest.approx(aside.face_load_factor, rel=1e-9)
    crowned = replace(SPUR, pinion=replace(SPUR.pinion, modification=FlankModification(lead_crowning=8.0)))
    assert (
        load_distribution(check_task(crowned, EH, LOAD)).face_load_factor
        < 0.9 * load_distribution(check_task(SPUR, EH, LOAD)).face_load_factor
    )
    given = RatingOptions(dynamic_factor=1.0, mesh_load_factor=1.5)
    far = load_distribution(check_task(SPUR, EH, LOAD, rating=given, mounting=Mounting(misalignment=900.0)))
    assert far.torque == 225.0
    assert far.face_load_factor > 15
