"""A rack is rated as the limit of wheels of ever more teeth; its tooth is drawn once more."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from gearcad import BasicRack, Gear, GearPair, GeometryError, Load, Material, Rack, RackPair, rate
from gearcad.rating import rate_rack
from gearcad.rating.nominal_rating import rack_contact_at

STEEL, LOAD = Material(), Load(torque=200.0)


def _pair(helix: float = 0.0, **rack: Any) -> RackPair:
    pinion = Gear(teeth=24, normal_module=3.0, face_width=30.0, helix_angle=helix, profile_shift=0.1)
    return RackPair(
        pinion=pinion, rack=Rack(teeth=20, normal_module=3.0, face_width=28.0, helix_angle=-helix, height=25.0, **rack)
    )


def _numbers(document: dict[str, Any], wheel: str) -> np.ndarray:
    """All that a wheel and a rack have in common, in order."""
    pair = [value for value in document.values() if isinstance(value, float)]
    gears = [document[name][key] for name in ("pinion", wheel) for key in sorted(document["pinion"]) if key != "d_en"]
    return np.array([*pair, *gears])


@pytest.mark.parametrize("helix", [0.0, 6.0, 20.0])
def test_a_rack_is_the_limit_of_large_wheels(helix: float) -> None:
    """What differs goes as 1/z_2 and its square: extrapolated from 500, 1000 and 2000 teeth it is gone."""
    pair = _pair(helix)
    limit = _numbers(rate_rack(pair, STEEL, LOAD).to_dict(), "rack")
    off, transverse = [], 3 / math.cos(math.radians(helix))
    for teeth in (500, 1000, 2000):
        wheel = replace(pair.pinion, teeth=teeth, face_width=28.0, helix_angle=-helix, profile_shift=0.0)
        mate = GearPair(pinion=pair.pinion, wheel=wheel, centre_distance=(24 + teeth) * transverse / 2 + 0.3)
        off.append(_numbers(rate(mate, LOAD).nominal.to_dict(), "wheel") / limit - 1)
    assert np.abs(off[2]).max() < 0.02
    assert np.abs(8 * off[2] - 6 * off[1] + off[0]).max() / 3 < 2e-4  # the third order of rho_F


def test_section_of_a_rack_from_its_outline() -> None:
    """Chord, arm and radius where the drawn tooth leans by 30 degrees; the force goes through B, square to the flank."""
    pair = _pair()
    fillet = pair.rack.profile.curves[1]
    (x, y) = fillet.points(np.linspace(0, 1, 20001)).T
    lean = np.degrees(np.arctan2(np.gradient(x), np.gradient(y)))
    at = int(np.argmin(np.abs(lean - 30)))
    path = pair.path_of_contact
    angle = math.radians(20)
    height = pair.pitch_line_height + (path.C - path.B) * math.sin(angle)
    meets = height - pair.rack.profile.half_thickness(height) * math.tan(angle)
    section = rate_rack(pair, STEEL, LOAD).roots.wheel.section
    assert section.chord == pytest.approx(-2 * x[at], rel=1e-4)
    assert section.moment_arm == pytest.approx(meets - y[at], rel=1e-4)
    assert section.fillet_radius == pytest.approx(0.38 * 3)


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_contact_with_a_plane_flank(helix: float) -> None:
    """sigma_H0 is Hertz of a cylinder on a plane at the pitch point, r_b tan alpha_t across the transverse section."""
    pair = _pair(helix)
    flank = rate_rack(pair, STEEL, LOAD).flank
    a_t = math.atan(math.tan(math.radians(20)) / math.cos(math.radians(helix)))
    beta_b = math.asin(math.sin(math.radians(helix)) * math.cos(math.radians(20)))
    base = 36 / math.cos(math.radians(helix)) * math.cos(a_t)
    radius, force = base * math.tan(a_t) / math.cos(beta_b), 200e3 / base / math.cos(beta_b)
    peak = math.sqrt(force * math.cos(beta_b) / 28 * 206000 / (2 * (1 - 0.09)) / (math.pi * radius))
    assert flank.nominal_stress == pytest.approx(peak * flank.contact_ratio_factor * flank.helix_angle_factor, rel=1e-11)
    contact = rack_contact_at(pair, STEEL, distance=pair.path_of_contact.C, force=force)
    assert contact.peak_pressure == pytest.approx(peak, rel=1e-11)


def test_what_is_said_and_refused_of_racks() -> None:
    rating = rate(_pair(), LOAD, material=STEEL).nominal
    assert [notice.code for notice in rating.notices] == ["rack-as-wheel"]
    assert rating.to_dict()["verify"] == ["q_prime"]
    with pytest.raises(GeometryError, match=r"^rack\.rack\.root_radius = 0: must be above 0 for a rating: stress has no limit"):
        rate(_pair(rack=BasicRack(root_radius=0.0)), LOAD)
    with pytest.raises(ValueError, match=r"^load\.torque is missing: must be given"):
        rate(_pair())
    with pytest.raises(
        ValueError, match=r"^mounting = .*: is not an input of a rack and pinion; permitted: material, load, rating"
    ):
        rate(_pair(), LOAD, mounting=None)
