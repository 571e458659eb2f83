"""Mesh stiffness in closed form against values computed independently of this code, and against another program's teeth."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from support.stiffness import THESIS_LOAD, stiffness_case, thesis_pair

from gearcad import BasicRack, Gear, GearPair, Load, Material
from gearcad.contact.shared.bodies import BodyModel
from gearcad.core.records import PerGear, Role
from gearcad.rating.tooth_stiffness import mesh_stiffness_alpha, mesh_stiffness_beta
from gearcad.stiffness import MethodB, PotentialEnergy, WeberBanaschek

COMPONENT, MEAN = 1e-7, 1e-4
"""Relative, as the reference states them: compliances at a position, mean, greatest and least of the mesh."""

STEEL = Material()
POSITIONS: list[dict[str, Any]] = stiffness_case("s000_12_components")["verified"]["positions"]


@pytest.mark.parametrize("place", range(5))
@pytest.mark.parametrize(("role", "key"), [(Role.PINION, "gear1"), (Role.WHEEL, "gear2")])
def test_compliances_of_a_tooth(place: int, role: Role, key: str) -> None:
    expected = POSITIONS[place][key]
    at = np.array([POSITIONS[place]["s1"]])
    energy, weber = (method(pair=thesis_pair(), material=STEEL) for method in (PotentialEnergy, WeberBanaschek))
    load = energy.teeth.pick(role).load_at(energy.curvatures(at).pick(role))
    assert load.x[0] == pytest.approx(expected["x_c"], rel=1e-12)
    assert load.h[0] == pytest.approx(expected["h_c"], rel=1e-11)
    assert load.angle[0] == pytest.approx(expected["load_angle_rad"], rel=1e-9)
    parts = {name: part[0] / 10 for name, part in energy.tooth_parts(role, load).items()}  # 10 mm wide
    for name, symbol in (("bending", "inv_kb"), ("shear", "inv_ks"), ("axial", "inv_ka")):
        assert parts[name] == pytest.approx(expected["fillet"][symbol], rel=COMPONENT)
    assert parts["foundation"] == pytest.approx(expected["sainsot"]["inv_kf"], rel=COMPONENT)
    beam = {name: part[0] / 10 for name, part in weber.tooth_parts(role, load).items()}
    assert beam["bending"] + beam["shear"] + beam["axial"] == pytest.approx(expected["WB_root"]["w_bend_per_N"], rel=COMPONENT)
    assert beam["foundation"] == pytest.approx(expected["WB_root"]["w_found_per_N"], rel=COMPONENT)


@pytest.mark.parametrize("place", range(5))
def test_compliance_of_a_contact(place: int) -> None:
    at, expected = np.array([POSITIONS[place]["s1"]]), POSITIONS[place]["WB_hertz"]["w_per_N"]
    weber = WeberBanaschek(pair=thesis_pair()).single(at, THESIS_LOAD)
    assert weber.parts["contact"][0] / 1e4 == pytest.approx(expected, rel=COMPONENT)  # mm·µm/N per 10 mm
    energy = PotentialEnergy(pair=thesis_pair()).single(at, THESIS_LOAD)
    whatever_load = stiffness_case("s000_12_components")["verified"]["inv_kh"]
    assert energy.parts["contact"][0] / 1e4 == pytest.approx(whatever_load, rel=COMPONENT)


@pytest.mark.parametrize(("method", "key"), [(PotentialEnergy, "fillet+sainsot"), (WeberBanaschek, "WB_root")])
def test_mesh(method: Any, key: str) -> None:
    expected = stiffness_case("s000_12_mesh")["verified"][key]
    cycle = method(pair=thesis_pair(), material=STEEL)(THESIS_LOAD)
    assert 1000 * cycle.mean == pytest.approx(expected["mean"], rel=MEAN)
    assert 1000 * cycle.maximum == pytest.approx(expected["max"], rel=MEAN)
    assert 1000 * cycle.minimum == pytest.approx(expected["min"], rel=MEAN)
    assert 1000 * cycle.pitch_point == pytest.approx(expected["k_pitch"], rel=MEAN)
    assert 1000 * cycle.single_stiffness == pytest.approx(expected["k_single_max"], rel=MEAN)


def test_method_b() -> None:
    """The reference rounds the contact ratio to 1.573; with it the formulas give its digits."""
    expected = stiffness_case("s000_12_iso6336")["verified"]
    cycle = MethodB(pair=thesis_pair(), material=STEEL)(THESIS_LOAD)
    low = expected["light_load_factor"]
    assert cycle.single_stiffness == pytest.approx(10 * low * expected["c_prime"], rel=1e-9)
    ratio = thesis_pair().transverse_contact_ratio
    exact = mesh_stiffness_alpha(expected["c_prime"], ratio)
    assert mesh_stiffness_alpha(expected["c_prime"], 1.573) == pytest.approx(expected["c_gamma_alpha"], rel=1e-9)
    assert cycle.tangent_per_width == pytest.approx(low * exact, rel=1e-9)
    assert cycle.secant_per_width == pytest.approx(low * mesh_stiffness_beta(exact), rel=1e-9)
    assert 10 * mesh_stiffness_beta(expected["c_gamma_alpha"]) * 1000 == pytest.approx(
        expected["c_gamma_beta_times_b"], rel=1e-9
    )


ROSS = {
    20: (6266.013, 1943.363, 78837.31),
    40: (9795.435, 2156.034, 65649.59),
    60: (11386.663, 2232.952, 62229.22),
    62: (11497.942, 2238.030, 62022.00),
}
"""k_b, k_s, k_a (N/µm) of a tooth at the pressure angle of 20 deg: gear element of ROSS 2.3.0, m 2, b 20, x 0."""


@pytest.mark.parametrize("teeth", sorted(ROSS))
def test_another_programs_teeth(teeth: int) -> None:
    """ROSS integrates the same energies with scipy's quad along its own involute and trochoid."""
    # Its tool's tip is round for the whole of the clearance.
    rack = BasicRack(root_radius=0.25 / (1 - math.sin(math.radians(20))))
    gear = Gear(teeth=teeth, normal_module=2.0, face_width=20.0, rack=rack)
    method = PotentialEnergy(pair=GearPair(pinion=gear, wheel=gear), body=BodyModel(inner_diameters=PerGear(20.0, 20.0)))
    load = method.teeth.pinion.load_at(np.array([gear.base_diameter / 2 * math.tan(math.radians(20))]))
    parts = method.tooth_parts(Role.PINION, load)
    found = [20 / (1000 * parts[name][0]) for name in ("bending", "shear", "axial")]
    assert found == pytest.approx(ROSS[teeth], rel=2.6e-7)  # half a unit of the last printed digit


def test_load_without_torque() -> None:
    with pytest.raises(ValueError, match=r"load\.torque = 0 N·m: must not be 0"):
        PotentialEnergy(pair=thesis_pair())(Load(torque=0.0))
