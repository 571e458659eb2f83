"""Mesh stiffness of internal pairs: strain energy against contact of the same bodies, and its virtual spur gears."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gearcad import Body, Gear, GearPair, Load, Material, stiffness
from gearcad.contact.plane.pair import plane_pair
from gearcad.geometry import ShaperCutter
from gearcad.stiffness import CLOSED_FORMS, StrainEnergy

LOAD = Load(torque=50.0)


def _pair(helix: float) -> GearPair:
    return GearPair(
        pinion=Gear(teeth=24, normal_module=2.0, face_width=16.0, helix_angle=helix),
        wheel=Gear(
            teeth=-70,
            normal_module=2.0,
            face_width=16.0,
            helix_angle=helix,
            profile_shift=-0.3,
            cutter=ShaperCutter(teeth=30, tip_radius=0.2),
            body=Body(rim_diameter=170.0),
        ),
    )


def test_strain_energy_of_a_ring_is_what_its_contact_stores() -> None:
    """Away from the tips one pair's approach is its strain energy's and 1/(2 pi E*), though no pressure is solved for."""
    pair = _pair(0.0)
    energy, contact = StrainEnergy(pair=pair), plane_pair(pair, Material())
    lengths = np.linspace(*pair.usable_path, 7)[2:5]
    single = energy.single(lengths, LOAD)
    per_width = 2000 * 50 / pair.pinion.base_diameter / 16
    modulus = 206000 / (1 - 0.09) / 2
    for angle, compliance in zip(contact.roll_angle(lengths).tolist(), (1 / single.stiffness).tolist(), strict=True):
        found = contact.solve(angle, 50.0, single=True).approach - contact.rigid_approach(angle, single=True)
        assert 1000 * found / per_width == pytest.approx(compliance + 1000 / (2 * math.pi * modulus), rel=6e-4)


def test_virtual_rings_of_a_nearly_spur_ring() -> None:
    """Two spur rings of whole numbers of teeth stand for the virtual one: next to no helix, next to no difference."""
    lengths = np.linspace(*_pair(0.0).usable_path, 7)[1:-1]
    spur, helical = (StrainEnergy(pair=_pair(helix)).single(lengths, LOAD) for helix in (0.0, 0.5))
    for part in ("pinion", "wheel"):
        assert helical.parts[part] == pytest.approx(spur.parts[part], rel=2e-3)


def test_methods_without_an_internal_form_say_why() -> None:
    found = stiffness(_pair(0.0), LOAD, methods=CLOSED_FORMS)
    assert [cycle.method for cycle in found.cycles] == ["iso6336"]
    said = "wheel.teeth = -70: must be above 0 for {}: {}"
    expected = {
        "potential-energy": "Sainsot's elastic ring lies inside the teeth, held at its bore, not outside them",
        "weber-banaschek": "its beam and half-plane are those of teeth that stand out from their body",
    }
    assert found.left_out == {name: said.format(name, why) for name, why in expected.items()}
    flexibility = 0.04723 + 0.15551 / 24 + 0.00193 * 0.3 + 0.00182 * 0.3**2
    assert found.cycles[0].single_stiffness == pytest.approx(0.8 * 0.975 / flexibility * 16, rel=1e-12)
